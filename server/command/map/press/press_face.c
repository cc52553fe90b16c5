#include "server/command/map/press/press_face.h"
#include "core/full/full.h"

static bool any_stretches(const struct press_block *blocks, size_t count) {
    bool stretches = false;
    for (size_t m = 0; m < count; m++)
        stretches = stretches || blocks[m].model->stretches;
    return stretches;
}

static bool any_has_elements(const struct press_block *blocks, size_t count) {
    bool elements = false;
    for (size_t m = 0; m < count; m++)
        elements = elements || blocks[m].model->elements;
    return elements;
}

int press_face_check(const struct press_block *blocks, size_t count, struct error *err) {
    const char *name = blocks->current_areas ? "areas current" : "gap-direction normal";
    if (!blocks->current_areas && !blocks->normal_gaps)
        return 0;
    if (!any_stretches(blocks, count))
        return error_set(err, ERROR_INPUT,
                         "--%s belongs to --model full, which presses the rough face itself", name);
    if (blocks->kinematics == KINEMATICS_SMALL)
        return error_set(err, ERROR_INPUT,
                         "--%s is of the face as it stands under load, which --kinematics small "
                         "leaves as it was",
                         name);
    return 0;
}

int press_options_check(const struct press_block *blocks, size_t count, struct error *err) {
    const bool stretches = any_stretches(blocks, count);
    if (!stretches && blocks->kinematics != FULL_DEFAULTS.kinematics)
        return error_set(err, ERROR_INPUT, "--kinematics %s belongs to --model full",
                         choice_name(KINEMATICS_CHOICES, (int)blocks->kinematics));
    if (!stretches && blocks->transition != FULL_DEFAULTS.transition)
        return error_set(err, ERROR_INPUT,
                         "--transition-depth %g belongs to --model full, whose columns of elements "
                         "widen",
                         blocks->transition);
    if (blocks->weighting == GAP_DUAL && !any_has_elements(blocks, count))
        return error_set(err, ERROR_INPUT,
                         "--gap-weighting dual belongs to models with meshes, layered and full");
    if (blocks->angle != 0 && !(blocks->friction > 0))
        return error_set(err, ERROR_INPUT,
                         "--direction y is that of the tangential load, which --friction gives");
    return 0;
}
