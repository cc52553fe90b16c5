#include "jobs/statistics/statistics_target.h"
#include "jobs/merger.h"
#include "jobs/statistics/statistics_case.h"
#include "jobs/target.h"
#include <math.h>
#include <stdlib.h>

enum { REALISATIONS_FIRST = 32 };
/* Of the scatter that the cost model tells of a case, that of its densities bin by bin. */
static const double DENSITY_SHARE = 0.03, CURVE_SHARE = 0.4;

static int read_target(struct target *out, const cJSON *parameters, struct fault_list *faults,
                       struct error *err) {
    return target_read(out, parameters, STATISTICS_TABLES, TARGET_SUMMIT_DENSITY,
                       TARGET_SUMMIT_CURVATURE_PDF, faults, err);
}

int statistics_target_expand(const cJSON *document, struct study_case *one,
                             struct fault_list *faults, struct error *err) {
    struct target target;
    size_t before = faults->count;
    (void)document;
    int status = read_target(&target, one->parameters, faults, err);
    if (status != 0)
        return status == ERROR_INPUT && faults->count > before ? 0 : status;
    double share = target.quantity == TARGET_SUMMIT_DENSITY ? DENSITY_SHARE : CURVE_SHARE;
    cJSON *parameters = cJSON_Duplicate(one->parameters, true);
    one->components = array_create(1, sizeof *one->components);
    if (parameters == NULL || one->components == NULL) {
        cJSON_Delete(parameters);
        return error_memory(err, sizeof *one->components, "a component");
    }
    cJSON_DeleteItemFromObjectCaseSensitive(parameters, "target");
    one->components[0] = (struct study_case){.parameters = parameters,
                                             .realisations = REALISATIONS_FIRST,
                                             .role = "base",
                                             .share = share};
    one->component_count = 1;
    return 0;
}

/* Standard error of a scalar, or of a curve by norm, over its size. */
static double relative_error(const struct case_result *result, enum target_quantity quantity) {
    const char *name = target_quantity_name(quantity);
    if (quantity == TARGET_SUMMIT_DENSITY) {
        const struct scalar *scalar = result_scalar(result, name);
        return scalar != NULL ? scalar->standard_error / fabs(scalar->value) : (double)NAN;
    }
    const struct curve *curve = result_curve(result, name);
    double error = 0, size = 0;
    for (size_t k = 0; curve != NULL && k < curve->n; k++) {
        if (isnan(curve->standard_error[k]))
            continue;
        error += curve->standard_error[k] * curve->standard_error[k];
        size += curve->y[k] * curve->y[k];
    }
    return sqrt(error / size);
}

int statistics_target_answer(const cJSON *parameters, size_t count,
                             const struct target_component *components, uint64_t *wanted,
                             struct case_result *out, struct error *err) {
    struct target target;
    if (count != 1)
        return error_set(err, ERROR_INPUT, "%zu components of a target; statistics have one",
                         count);
    wanted[0] = components[0].done;
    int status = read_target(&target, parameters, NULL, err);
    if (status != 0 || components[0].done == 0)
        return status;
    status = merger_result(components[0].merger, out, err);
    if (status != 0)
        return status;
    double error = relative_error(out, target.quantity), standard_error;
    double multiplier, quantile;
    const double variance = error * error * (double)components[0].done;
    const struct target_part part = {components[0].done, 1, components[0].seconds, &variance};
    const struct target_plan plan = {&target, 1, &target.error, &multiplier, &quantile};
    double reached = target_quantile(&target, 1, &part, 0, &standard_error) * standard_error;
    target_allot(&plan, 1, &part, wanted);
    status = target_add_scalar(out, "error_asked", target.error, err);
    if (status == 0)
        status = target_add_scalar(out, "error_reached", reached, err);
    return status != 0 ? status : target_add_scalar(out, "error_chance", reached, err);
}
