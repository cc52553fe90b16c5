#include "jobs/surface/surface_law.h"
#include "schema/json/field.h"
#include "schema/json/json.h"
#include <math.h>
#include <string.h>

static const char LAW[] = "/surface/heights/law", AMPLITUDES[] = "/surface/amplitudes";

int surface_law_complete(const cJSON *document, cJSON *parameters, struct error *err) {
    const cJSON *law = json_at(parameters, LAW);
    cJSON *surface = cJSON_GetObjectItemCaseSensitive(parameters, "surface");
    bool translated = cJSON_IsString(law) && strcmp(law->valuestring, "translation") == 0;
    const cJSON *heights = json_at(parameters, "/surface/heights/distribution");
    bool gaussian = heights == NULL ||
                    (cJSON_IsString(heights) && strcmp(heights->valuestring, "gaussian") == 0);
    if (!translated || gaussian || json_at(document, AMPLITUDES) != NULL)
        return 0;
    cJSON_DeleteItemFromObjectCaseSensitive(surface, "amplitudes");
    return field_put_text(surface, "amplitudes", "random") ? 0 : error_memory(err, 0, "amplitudes");
}

/* Values of the iteration, for which a translation has no use, count as given where they are not
 * the defaults. */
static void refuse_iteration(const struct surface_options *of, struct values *values) {
    const struct surface_options *usual = &SURFACE_DEFAULTS;
    const struct {
        const char *path;
        bool given;
    } values_of[] = {
        {"/surface/heights/tolerance", of->tolerance != usual->tolerance},
        {"/surface/heights/tolerances/eps_h", of->tolerance_h != 0},
        {"/surface/heights/tolerances/eps_s", of->tolerance_s != 0},
        {"/surface/heights/tolerances/eps_s0", of->tolerance_s0 != 0},
        {"/surface/heights/keep", of->keep != usual->keep},
        {"/surface/heights/iteration", of->iteration != usual->iteration},
        {"/surface/heights/draw", of->draw != usual->draw},
        {"/surface/heights/stall_gain", of->stall_gain != usual->stall_gain},
        {"/surface/heights/stall_iterations", of->stall_iterations != usual->stall_iterations},
        {"/surface/heights/max_iterations", of->max_iterations != usual->max_iterations},
        {"/surface/heights/relaxed_iterations",
         of->relaxed_iterations != usual->relaxed_iterations},
    };
    for (size_t a = 0; a < sizeof values_of / sizeof *values_of; a++) {
        if (values_of[a].given)
            values_fault(values, values_of[a].path,
                         "is of the law \"iterated\": surfaces of the law \"translation\" are not "
                         "iterated; leave it out");
    }
    if (of->amplitudes != AMPLITUDES_RANDOM)
        values_fault(values, AMPLITUDES,
                     "fixed amplitudes are not Gaussian in a cell, which the law \"translation\" "
                     "needs; allowed: random");
}

static void judge(const struct translation *translation, double most, struct values *values) {
    static const double TWO_PI = 6.283185307179586;
    const struct translation_fit *fit = translation_fit(translation);
    if (fit->misfit > most)
        values_fault(values, LAW,
                     "these heights and this spectrum go together only so far: %.3g %% of the "
                     "variance in the band would be at other waves, most of it near waves of %.3g "
                     "lambda_s; allowed: heights less skewed, a spectrum less steep, misfit %.2g, "
                     "or the law \"iterated\"",
                     100 * fit->misfit, TWO_PI / fit->misfit_wave_number,
                     ceil(100 * fit->misfit) / 100);
}

int surface_law_fill(struct translation **out, struct spectrum *spectrum, int dimension,
                     const struct surface_options *options, struct values *values,
                     struct error *err) {
    double misfit = values_number(values, "/surface/heights/misfit");
    struct error reason = {0};
    *out = NULL;
    if (options->law != LAW_TRANSLATION || options->heights.type == HEIGHTS_GAUSSIAN)
        return 0; /* a Gaussian field is its own translation */
    size_t before = values_fault_count(values);
    refuse_iteration(options, values);
    if (values_fault_count(values) != before)
        return 0;
    int status = translation_create(out, spectrum, dimension, &options->heights, &reason);
    if (status == ERROR_INPUT) {
        values_fault(values, LAW, "%s", reason.text);
        return 0;
    }
    if (status != 0)
        return error_set(err, status, "%s", reason.text);
    judge(*out, misfit, values);
    spectrum->translation = *out;
    return 0;
}

void surface_law_estimate(const struct translation *translation, struct study_cost *out) {
    if (translation == NULL)
        return;
    const struct translation_fit *fit = translation_fit(translation);
    out->law_outside = isfinite(fit->outside) ? fit->outside : 0;
    out->law_misfit = fit->misfit;
}
