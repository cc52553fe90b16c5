#include "server/command/map/press/press_face.h"

int press_face_check(const struct press_block *blocks, size_t count, struct error *err) {
    const char *name = blocks->current_areas ? "areas current" : "gap-direction normal";
    bool stretches = false;
    if (!blocks->current_areas && !blocks->normal_gaps)
        return 0;
    for (size_t m = 0; m < count; m++)
        stretches = stretches || blocks[m].model->stretches;
    if (!stretches)
        return error_set(err, ERROR_INPUT,
                         "--%s belongs to --model full, which presses the rough face itself", name);
    if (blocks->kinematics == KINEMATICS_SMALL)
        return error_set(err, ERROR_INPUT,
                         "--%s is of the face as it stands under load, which --kinematics small "
                         "leaves as it was",
                         name);
    return 0;
}
