#include "jobs/target.h"
#include "schema/json/json.h"
#include "schema/result/total.h"
#include <gsl/gsl_cdf.h>
#include <math.h>
#include <string.h>

/* Most growth of a component in one round, as variances are estimates: after few realisations, and
 * after more. */
static const double GROWTH_FEW = 2, GROWTH_MOST = 4;
enum { FEW = 24 };
static const double GROWTH_LEAST = 1.25; /* keeps rounds few */
static const double MARGIN = 1.05;       /* above what is needed, for the same reason */
static const double REALISATIONS_MOST = 1e7;

static const double CONFIDENCE = 0.95;      /* unless given */
static const double STATISTICAL_PART = 0.5; /* of the error asked for, as is assumed */
enum { ROUNDS_MOST = 40, STEPS = 60, BISECTIONS = 50 };
static const double SCALE_MOST = 1e30;

static const struct choice QUANTITIES[] = {{"contact_area", TARGET_CONTACT_AREA},
                                           {"mean_gap", TARGET_MEAN_GAP},
                                           {"summit_density", TARGET_SUMMIT_DENSITY},
                                           {"summit_height_pdf", TARGET_SUMMIT_HEIGHT_PDF},
                                           {"summit_curvature_pdf", TARGET_SUMMIT_CURVATURE_PDF},
                                           {0}};

static const struct parameter ROWS[] = {
    {.path = "/target/error",
     .type = PARAMETER_NUMBER,
     .minimum = 1e-5,
     .maximum = 0.5,
     .later = true,
     .example_json = "0.01",
     .help =
         "in place of realisations: a relative error. Of contact it is of every point of the "
         "curve, all sources together, and what the study does not name (levels, length_ratio, "
         "block_height, realisations) is chosen for it; of statistics it is the statistical error "
         "alone, and realisations are chosen"},
    {.path = "/target/confidence",
     .type = PARAMETER_NUMBER,
     .minimum = 0.5,
     .maximum = 0.9999,
     .later = true,
     .example_json = "0.99",
     .help = "probability with which a point is within the error; 0.95 unless given"},
    {.path = "/target/quantity",
     .type = PARAMETER_CHOICE,
     .choices = QUANTITIES,
     .later = true,
     .example_json = "\"mean_gap\"",
     .help = "whose error is asked for: of contact the curve contact_area (unless given) or "
             "mean_gap; of "
             "statistics summit_density (unless given), or the curve summit_height_pdf or "
             "summit_curvature_pdf, by norm"},
    {.path = "/target/max_seconds",
     .type = PARAMETER_NUMBER,
     .minimum = 0,
     .maximum = 1e12,
     .above_minimum = true,
     .later = true,
     .unit = "s",
     .example_json = "3600",
     .help = "CPU seconds of a case, as estimated, beyond which no round goes; without limit "
             "unless given"},
};
const struct parameter_table TARGET_PARAMETERS = {"target", ROWS, sizeof ROWS / sizeof *ROWS};

int target_read(struct target *out, const cJSON *parameters,
                const struct parameter_table *const *tables, enum target_quantity first,
                enum target_quantity last, struct fault_list *faults, struct error *err) {
    struct values *values = NULL;
    int status = values_create(&values, parameters, tables, faults, err);
    if (status != 0)
        return status;
    double confidence = values_number(values, "/target/confidence");
    double most = values_number(values, "/target/max_seconds");
    int quantity = values_choice(values, "/target/quantity");
    *out = (struct target){.error = values_number(values, "/target/error"),
                           .confidence = isnan(confidence) ? CONFIDENCE : confidence,
                           .quantity =
                               quantity == TARGET_UNNAMED ? first : (enum target_quantity)quantity,
                           .max_seconds = isnan(most) ? INFINITY : most};
    if (isnan(out->error))
        values_fault(values, "/target/error", "missing: a number in [1e-05, 0.5]");
    if (out->quantity < first || out->quantity > last)
        values_fault(values, "/target/quantity",
                     "\"%s\" is not of this kind; it has \"%s\" to \"%s\"",
                     target_quantity_name(out->quantity), target_quantity_name(first),
                     target_quantity_name(last));
    status = values_status(values, err);
    values_destroy(&values);
    return status;
}

static bool is_choice(const cJSON *value, const char *choice) {
    if (cJSON_GetArraySize(value) == 1)
        value = value->child;
    return choice != NULL && cJSON_IsString(value) && strcmp(value->valuestring, choice) == 0;
}

void target_refuse(const cJSON *document, const struct parameter_table *const *tables,
                   struct fault_list *faults) {
    const struct parameter *row;
    for (size_t p = 0; (row = parameter_row(tables, p)) != NULL; p++) {
        const cJSON *value = json_at(document, row->path);
        if (row->target_refusal == NULL || value == NULL || is_choice(value, row->target_choice))
            continue;
        if (row->target_choice != NULL)
            fault_add(faults, row->path, "%s; leave it out, or take \"%s\"", row->target_refusal,
                      row->target_choice);
        else
            fault_add(faults, row->path, "%s; leave it out", row->target_refusal);
    }
}

const char *target_quantity_name(enum target_quantity quantity) {
    return choice_name(QUANTITIES, (int)quantity);
}

double target_quantile(const struct target *target, size_t count, const struct target_part *parts,
                       size_t point, double *standard_error) {
    double variances[TARGET_PARTS_MOST], realisations[TARGET_PARTS_MOST], variance = 0;
    for (size_t a = 0; a < count; a++) {
        realisations[a] = (double)parts[a].done;
        variances[a] = parts[a].variance[point] / realisations[a];
        variance += variances[a];
    }
    *standard_error = sqrt(variance);
    if (!isfinite(variance) || variance <= 0)
        return isnan(variance) ? (double)NAN : 0;
    return gsl_cdf_tdist_Pinv((1 + target->confidence) / 2,
                              total_freedom(count, variances, realisations));
}

/* A search for the plan of least work. */
struct search {
    const struct target_plan *plan;
    size_t count;
    const struct target_part *parts;
    const double *numbers;
};

/* Returns the variance of one realisation of a part over the variance allowed at a point; 0 where
 * the point is left out. */
static double relative_variance(const struct search *search, size_t part, size_t point) {
    double ratio = search->plan->quantiles[point] / search->plan->allowed[point];
    double relative = search->parts[part].variance[point] * ratio * ratio;
    return isfinite(relative) ? relative : 0;
}

/* Returns the sum of V/N over what is allowed at a point. N of a part is `scale` times its number,
 * and at least what is done. */
static double sum_at(const struct search *search, double scale, size_t point) {
    double sum = 0;
    for (size_t a = 0; a < search->count; a++) {
        double variance = relative_variance(search, a, point);
        if (variance > 0)
            sum += variance / fmax((double)search->parts[a].done, scale * search->numbers[a]);
    }
    return sum;
}

static bool suffices(const struct search *search, double scale) {
    for (size_t k = 0; k < search->plan->points; k++)
        if (sum_at(search, scale, k) > 1)
            return false;
    return true;
}

/* Returns the least scale at which the numbers suffice; they suffice for every larger one. */
static double least_scale(const struct search *search) {
    double low = 0, high = 1;
    if (suffices(search, 0))
        return 0;
    while (high < SCALE_MOST && !suffices(search, high))
        high *= 2;
    for (int step = 0; step < BISECTIONS; step++) {
        double middle = (low + high) / 2;
        *(suffices(search, middle) ? &high : &low) = middle;
    }
    return high;
}

/* Each step multiplies the multiplier of a point by its sum, which is smaller where more is done
 * than the point needs. Then all numbers are scaled to what the hardest point needs. */
static double least_work(const struct target_plan *plan, size_t count,
                         const struct target_part *parts, double *needed) {
    double scale = 0, lacking = 0;
    const struct search search = {plan, count, parts, needed};
    for (size_t k = 0; k < plan->points; k++)
        plan->multipliers[k] = 1;
    for (int step = 0; step < STEPS; step++) {
        for (size_t a = 0; a < count; a++) {
            double sum = 0;
            for (size_t k = 0; k < plan->points; k++)
                sum += plan->multipliers[k] * relative_variance(&search, a, k);
            needed[a] = sqrt(sum / parts[a].work);
        }
        scale = least_scale(&search);
        for (size_t k = 0; k < plan->points; k++)
            plan->multipliers[k] *= sum_at(&search, scale, k);
    }
    for (size_t a = 0; a < count; a++) {
        needed[a] = fmax((double)parts[a].done, scale * needed[a]);
        lacking += parts[a].work * (needed[a] - (double)parts[a].done);
    }
    return lacking;
}

double target_least_work(const struct target_plan *plan, size_t count,
                         const struct target_part *parts, double *needed) {
    for (size_t k = 0; k < plan->points; k++)
        plan->quantiles[k] = gsl_cdf_ugaussian_Pinv((1 + plan->target->confidence) / 2);
    return least_work(plan, count, parts, needed);
}

/* Returns whether the parts have as many realisations as the plan needs at every point, by
 * Student's quantiles, which it leaves in the plan. */
static bool enough_by_student(const struct target_plan *plan, size_t count,
                              const struct target_part *parts) {
    bool enough = true;
    for (size_t k = 0; k < plan->points; k++) {
        double standard_error;
        double *quantile = &plan->quantiles[k];
        *quantile = target_quantile(plan->target, count, parts, k, &standard_error);
        enough = enough && !(*quantile * standard_error > plan->allowed[k]);
    }
    return enough;
}

static uint64_t grown(uint64_t done, double needed) {
    double n = (double)done;
    if (needed <= n)
        return done;
    n = fmin(fmax(ceil(MARGIN * needed), ceil(GROWTH_LEAST * n)),
             (done < FEW ? GROWTH_FEW : GROWTH_MOST) * fmax(n, 1));
    return (uint64_t)fmin(n, REALISATIONS_MOST);
}

void target_hold(const struct target *target, size_t count, const struct target_part *parts,
                 uint64_t *wanted) {
    double most = target->max_seconds;
    double spent = 0, more = 0;
    for (size_t a = 0; a < count; a++) {
        spent += parts[a].seconds * (double)parts[a].done;
        more += parts[a].seconds * (double)(wanted[a] - parts[a].done);
    }
    if (!(spent + more > most))
        return;
    double share = fmax(0, (most - spent) / more);
    for (size_t a = 0; a < count; a++)
        wanted[a] = parts[a].done + (uint64_t)floor(share * (double)(wanted[a] - parts[a].done));
}

void target_allot(const struct target_plan *plan, size_t count, const struct target_part *parts,
                  uint64_t *wanted) {
    double needed[TARGET_PARTS_MOST];
    double lacking = target_least_work(plan, count, parts, needed);
    bool enough = enough_by_student(plan, count, parts);
    if (!enough && !(lacking > 0)) /* Student's quantiles need more than the normal one */
        (void)least_work(plan, count, parts, needed);
    for (size_t a = 0; a < count; a++)
        wanted[a] = enough ? parts[a].done : grown(parts[a].done, needed[a]);
    target_hold(plan->target, count, parts, wanted);
}

int target_add_scalar(struct case_result *result, const char *name, double value,
                      struct error *err) {
    const struct scalar scalar = scalar_named(name, value, NAN, NAN);
    return result_add_scalar(result, &scalar, err);
}

/* Finds the components that start for certain, and sets begun to their indices. */
static size_t expected_parts(const struct study_case *one, struct target_part *parts,
                             double *variance, size_t *begun) {
    size_t count = 0;
    for (size_t a = 0; a < one->component_count && a < TARGET_PARTS_MOST; a++) {
        const struct study_case *component = &one->components[a];
        double scatter = component->share * component->cost.relative_error;
        if (component->realisations == 0)
            continue;
        variance[count] = scatter * scatter;
        parts[count] = (struct target_part){component->realisations, component->cost.seconds,
                                            component->cost.seconds, &variance[count]};
        begun[count++] = a;
    }
    return count;
}

double target_expect(const struct study_case *one, uint64_t *out) {
    const struct target target = {
        .error = json_number_at(one->parameters, "/target/error", 1),
        .confidence = json_number_at(one->parameters, "/target/confidence", CONFIDENCE),
        .max_seconds = json_number_at(one->parameters, "/target/max_seconds", INFINITY)};
    const double allowed = STATISTICAL_PART * target.error;
    double multiplier, quantile;
    const struct target_plan plan = {&target, 1, &allowed, &multiplier, &quantile};
    struct target_part parts[TARGET_PARTS_MOST];
    double variance[TARGET_PARTS_MOST], seconds = 0;
    size_t begun[TARGET_PARTS_MOST], count = expected_parts(one, parts, variance, begun);
    bool grows = count > 0;
    for (size_t n = 0; n < ROUNDS_MOST && grows; n++) {
        uint64_t wanted[TARGET_PARTS_MOST];
        target_allot(&plan, count, parts, wanted);
        grows = false;
        for (size_t a = 0; a < count; a++) {
            grows = grows || wanted[a] > parts[a].done;
            parts[a].done = wanted[a];
        }
    }
    for (size_t a = 0; a < one->component_count && a < TARGET_PARTS_MOST; a++)
        out[a] = 0;
    for (size_t a = 0; a < count; a++) {
        out[begun[a]] = parts[a].done;
        seconds += (double)parts[a].done * parts[a].seconds;
    }
    return seconds;
}
