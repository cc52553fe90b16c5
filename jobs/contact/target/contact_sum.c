#include "jobs/contact/target/contact_sum.h"
#include "jobs/contact/companion/companion_law.h"
#include "jobs/contact/contact_measure.h"
#include "schema/result/total.h"
#include <math.h>
#include <stdlib.h>

/* --- the components --- */

double contact_heights_cell(const struct heights *heights) {
    static const double KURTOSIS = 9, ROUNDING = 1e-9;
    struct height_moments moments;
    if (heights_moments(heights, &moments, NULL) != 0)
        return (double)NAN;
    return moments.kurtosis > KURTOSIS + ROUNDING
               ? HEIGHTS_CELL * (moments.kurtosis - 1) / (KURTOSIS - 1)
               : HEIGHTS_CELL;
}

/* Returns a bound of the error of an iterated profile of this cell by its heights; 0 for others,
 * which have no such error. */
static double heights_bound(const struct target_component *base, double value, size_t load) {
    const struct surface_case *surface = &component_case(base)->surface;
    if (surface->dimension != 1 || !surface_is_iterated(&surface->options))
        return 0;
    double area = contact_tally_mean(component_tally(base), MEASURE_EDGES, load).value;
    return contact_heights_cell(&surface->options.heights) /
           (surface->grid.lx * sqrt(area)) /* lambda_s is 1 */ * fabs(value);
}

static double factor_of(const struct target_component *component, enum contact_measure measure) {
    return measure_factor(measure_row(measure)->cell,
                          surface_case_waves(&component_case(component)->surface));
}

/* Returns a mean on the coarsest level by the cheap model, per longest wave. */
static struct estimate mean_of(const struct target_component *component,
                               enum contact_measure measure, size_t load) {
    struct estimate mean = contact_tally_mean(component_tally(component), measure, load);
    double factor = factor_of(component, measure);
    return (struct estimate){factor * mean.value, factor * mean.standard_error};
}

/* Adds the base. The bound of the cell is from the square of the change between cells less that of
 * its standard error; the latter widens the interval of the sum. */
static void add_base(const struct contact_answer *answer, enum contact_measure measure,
                     struct contact_sum *sum) {
    const struct target_component *base = answer->of[ROLE_BASE], *cell = answer->of[ROLE_CELL];
    for (size_t k = 0; k < answer->loads; k++) {
        struct estimate mean = mean_of(base, measure, k);
        sum->value[k] = sum->base[k] = mean.value;
        sum->variance[ROLE_BASE][k] = component_variance(base, mean.standard_error);
        if (cell == NULL)
            continue;
        struct estimate other = mean_of(cell, measure, k);
        double change = mean.value - other.value;
        double standard_error = hypot(mean.standard_error, other.standard_error);
        sum->length[k] =
            fmax(CELL_SHARE * sqrt(fmax(0, change * change - standard_error * standard_error)),
                 heights_bound(base, mean.value, k));
        sum->length_standard_error[k] = CELL_SHARE * standard_error;
        sum->cell[k] = sum->length[k];
        sum->variance[ROLE_CELL][k] =
            CELL_SHARE * CELL_SHARE * component_variance(cell, other.standard_error);
    }
}

void contact_sum_bound_added(const struct contact_answer *answer, enum role role, double share,
                             double added, size_t point, struct contact_sum *sum) {
    const struct surface_case *own = &component_case(answer->of[role])->surface;
    if (own->length_ratio < component_case(answer->of[ROLE_BASE])->surface.length_ratio)
        sum->cell[point] =
            hypot(sum->cell[point],
                  fmin(1, share / pow(surface_case_shorter(own), own->dimension)) * added);
}

/* Adds the changes of the cheap model from a level on: to the next one, or with a limit to that.
 * They are relative to the value on the coarsest level, and scaled by the base. As they are
 * correlated, their standard errors add up at most. */
static void add_levels(const struct contact_answer *answer, enum contact_measure measure,
                       enum role role, size_t from, const struct contact_error *limit,
                       struct contact_sum *sum) {
    const struct target_component *mesh = answer->of[role];
    const struct contact_tally *tally = component_tally(mesh);
    size_t levels = limit != NULL ? component_case(mesh)->level_count : from + 2;
    for (size_t k = 0; k < answer->loads; k++) {
        double scale = sum->base[k] / contact_tally_mean(tally, measure, k).value;
        double standard_error = 0, added = 0;
        for (size_t l = from + 1; l < levels; l++) {
            struct estimate change = contact_tally_level(tally, measure, 0, l, k);
            added += change.value;
            standard_error += change.standard_error;
        }
        if (limit != NULL && !answer->named_mesh) {
            added -= limit[k].value;
            sum->mesh[k] = scale * limit[k].bound;
            sum->mesh_standard_error[k] = scale * limit[k].bound_standard_error;
            standard_error += limit[k].standard_error;
        } else if (limit != NULL) {
            sum->mesh[k] = scale * (fabs(limit[k].value) + limit[k].bound);
        }
        sum->value[k] += scale * added;
        sum->variance[role][k] = component_variance(mesh, scale * standard_error);
        contact_sum_bound_added(answer, role, LEVELS_CELL, scale * added, k, sum);
    }
}

/* Returns the value at a load over that of the cheap model, the first of the two, on the finest
 * level of a component. Values on short cells are higher: what is added from cells of another
 * length, or another mesh, is taken as a share of the value there. */
static double share_scale(const struct contact_sum *sum, const struct target_component *component,
                          enum contact_measure measure, size_t load) {
    const struct contact_case *one_case = component_case(component);
    size_t cell = contact_case_cell(one_case, 0, one_case->level_count - 1, load);
    return sum->value[load] / contact_tally_mean(component_tally(component), measure, cell).value;
}

/* Subtracts the error of the cheap model at a load. */
static void take_off(const struct contact_answer *answer, enum role role, double cell_share,
                     double scale, const struct contact_error *cheap, size_t load,
                     struct contact_sum *sum) {
    sum->value[load] -= scale * cheap->value;
    sum->model[load] += fabs(scale) * cheap->bound;
    sum->model_standard_error[load] += fabs(scale) * cheap->bound_standard_error;
    contact_sum_bound_added(answer, role, cell_share, scale * cheap->value, load, sum);
    sum->variance[role][load] = component_variance(answer->of[role], scale * cheap->standard_error);
}

/* Adds the model that is asked for less the cheap one: on one mesh and from there to the limit, or
 * directly in the limit. room: an entry for each load. */
static void add_models(const struct contact_answer *answer, enum contact_measure measure,
                       struct contact_error *room, struct contact_sum *sum) {
    const struct target_component *model = answer->of[ROLE_MODEL];
    const struct target_component *mesh = answer->of[ROLE_MODEL_MESH];
    bool limit = mesh == NULL && !answer->named_mesh &&
                 contact_errors(component_tally(model), measure, 0, ERROR_MODEL, room);
    for (size_t k = 0; k < answer->loads; k++) {
        double scale = share_scale(sum, model, measure, k);
        struct estimate cheap = contact_tally_model(component_tally(model), measure, 0, k);
        const struct contact_error on_mesh = {.value = cheap.value,
                                              .standard_error = cheap.standard_error};
        take_off(answer, ROLE_MODEL, MODELS_CELL, scale, limit ? &room[k] : &on_mesh, k, sum);
    }
    if (mesh == NULL || !contact_errors_model_change(component_tally(mesh), measure, 0, room))
        return;
    for (size_t k = 0; k < answer->loads; k++)
        take_off(answer, ROLE_MODEL_MESH, LEVELS_CELL, share_scale(sum, mesh, measure, k), &room[k],
                 k, sum);
}

/* Sets the error of the named mesh in the model that is asked for, which is reported beside the
 * answer. */
static void set_named_mesh(const struct contact_answer *answer, enum contact_measure measure,
                           struct contact_error *error, struct contact_sum *sum) {
    const struct target_component *model = answer->of[ROLE_MODEL];
    if (model != NULL &&
        contact_errors(component_tally(model), measure, 1, ERROR_DISCRETISATION, error))
        for (size_t k = 0; k < answer->loads; k++)
            sum->mesh[k] = factor_of(model, measure) * (fabs(error[k].value) + error[k].bound);
}

/* Sets the law difference as a share of the value. It is estimated on the longest cells that have
 * enough surfaces of the other law. room: an entry for each load. */
static void set_law(const struct contact_answer *answer, enum contact_measure measure,
                    struct estimate *room, struct contact_sum *sum) {
    bool known = false;
    for (size_t a = answer->length_count; a > 0 && !known; a--) {
        const struct contact_tally *tally = component_tally(answer->lengths[a - 1]);
        known = companion_law_difference(tally, measure, 0, room);
        for (size_t k = 0; k < answer->loads && known; k++) {
            double factor = sum->value[k] / contact_tally_mean(tally, measure, k).value;
            sum->law[k] = factor * room[k].value;
            sum->law_standard_error[k] = fabs(factor) * room[k].standard_error;
        }
    }
    for (size_t k = 0; k < answer->loads && !known; k++)
        sum->law[k] = sum->law_standard_error[k] = NAN;
}

static int add_all(const struct contact_answer *answer, enum contact_measure measure,
                   struct contact_sum *sum, struct error *err) {
    struct contact_error *error = array_create(answer->loads, sizeof *error);
    struct estimate *difference = result_room(answer->result, answer->loads, sizeof *difference);
    if (error == NULL || difference == NULL) {
        free(error);
        return error_memory(err, answer->loads * sizeof *error, "errors of a sum");
    }
    add_base(answer, measure, sum);
    if (contact_errors(component_tally(answer->of[ROLE_BASE]), measure, 0, ERROR_SOLVER, error))
        for (size_t k = 0; k < answer->loads; k++)
            sum->solver[k] = factor_of(answer->of[ROLE_BASE], measure) * error[k].bound;
    enum role last = contact_sum_mesh(answer);
    if (answer->of[last] != NULL && contact_errors(component_tally(answer->of[last]), measure, 0,
                                                   ERROR_DISCRETISATION, error)) {
        if (last == ROLE_FINE)
            add_levels(answer, measure, ROLE_MESH, 0, NULL, sum);
        add_levels(answer, measure, last, last == ROLE_FINE ? 1 : 0, error, sum);
    }
    if (answer->of[ROLE_MODEL] != NULL)
        add_models(answer, measure, error, sum);
    if (answer->named_mesh)
        set_named_mesh(answer, measure, error, sum);
    set_law(answer, measure, difference, sum);
    free(error);
    return 0;
}

/* --- the sum --- */

int contact_sum_room(const struct contact_answer *answer, size_t points, struct contact_sum *out,
                     struct error *err) {
    size_t n = points;
    double **const arrays[] = {&out->base,
                               &out->value,
                               &out->standard_error,
                               &out->width,
                               &out->effective,
                               &out->mesh,
                               &out->cell,
                               &out->model,
                               &out->solver,
                               &out->length,
                               &out->length_standard_error,
                               &out->law,
                               &out->law_standard_error,
                               &out->mesh_standard_error,
                               &out->model_standard_error};
    const size_t own = sizeof arrays / sizeof *arrays;
    double *room = result_numbers(answer->result, (own + ROLES) * n);
    if (room == NULL)
        return error_memory(err, (own + ROLES) * n * sizeof *room, "a sum");
    for (size_t a = 0; a < own; a++)
        *arrays[a] = room + a * n;
    for (size_t a = 0; a < ROLES; a++)
        out->variance[a] = room + (own + a) * n;
    out->points = n;
    return 0;
}

double contact_sum_work(const struct target_component *component) {
    const struct contact_case *one_case = component_case(component);
    double sum = 0;
    for (size_t m = 0; m < one_case->model_count; m++)
        for (size_t l = 0; l < one_case->level_count; l++)
            for (size_t k = 0; k < one_case->load_count; k++)
                sum += contact_tally_total(component_tally(component), MEASURE_WORK,
                                           contact_case_cell(one_case, m, l, k)) *
                       (double)grid_points(&one_case->levels[l].grid);
    return sum / (double)component->done;
}

size_t contact_sum_parts(const struct contact_answer *answer, const struct contact_sum *sum,
                         struct target_part parts[ROLES]) {
    size_t count = 0;
    for (size_t a = 0; a < ROLES; a++)
        if (answer->of[a] != NULL)
            parts[count++] = (struct target_part){.done = answer->of[a]->done,
                                                  .work = contact_sum_work(answer->of[a]),
                                                  .seconds = answer->of[a]->seconds,
                                                  .variance = sum->variance[a]};
    return count;
}

double contact_sum_bounds(const struct contact_answer *answer, const struct contact_sum *sum,
                          size_t load) {
    double mesh = answer->named_mesh ? 0 : sum->mesh[load];
    return hypot(hypot(mesh, sum->solver[load]), hypot(sum->cell[load], sum->model[load]));
}

/* Returns the effective realisations at a point of the value alone, to which the cell that the base
 * is compared with adds nothing. */
static double effective_at(const struct contact_answer *answer, const struct contact_sum *sum,
                           size_t point) {
    double variances[ROLES], realisations[ROLES];
    size_t count = 0;
    for (size_t a = 0; a < ROLES; a++) {
        if (answer->of[a] == NULL || a == ROLE_CELL)
            continue;
        realisations[count] = (double)answer->of[a]->done;
        variances[count] = sum->variance[a][point] / realisations[count];
        count++;
    }
    return total_freedom(count, variances, realisations) + 1;
}

/* The interval includes the statistical error of the bound of the cell; the standard error is that
 * of the value alone. */
void contact_sum_finish(const struct contact_answer *answer, struct contact_sum *sum) {
    struct target_part parts[ROLES];
    size_t count = contact_sum_parts(answer, sum, parts);
    for (size_t k = 0; k < sum->points; k++) {
        double all, variance;
        double quantile = target_quantile(&answer->target, count, parts, k, &all);
        sum->width[k] = quantile * all;
        variance = all * all;
        if (answer->of[ROLE_CELL] != NULL)
            variance -= sum->variance[ROLE_CELL][k] / (double)answer->of[ROLE_CELL]->done;
        sum->standard_error[k] = sqrt(fmax(0, variance));
        sum->effective[k] = effective_at(answer, sum, k);
    }
}

int contact_sum_create(const struct contact_answer *answer, enum contact_measure measure,
                       struct contact_sum *out, struct error *err) {
    int status = contact_sum_room(answer, answer->loads, out, err);
    if (status == 0)
        status = add_all(answer, measure, out, err);
    if (status == 0)
        contact_sum_finish(answer, out);
    return status;
}

int contact_sum_quotient(const struct contact_answer *answer, const struct contact_sum *dividend,
                         const struct contact_sum *divisor, struct contact_sum *out,
                         struct error *err) {
    int status = contact_sum_room(answer, answer->loads, out, err);
    if (status != 0)
        return status;
    const double *const of[][2] = {{dividend->standard_error, divisor->standard_error},
                                   {dividend->width, divisor->width},
                                   {dividend->mesh, divisor->mesh},
                                   {dividend->cell, divisor->cell},
                                   {dividend->model, divisor->model},
                                   {dividend->solver, divisor->solver},
                                   {dividend->law_standard_error, divisor->law_standard_error}};
    double *const to[] = {
        out->standard_error,    out->width, out->mesh, out->cell, out->model, out->solver,
        out->law_standard_error};
    for (size_t k = 0; k < answer->loads; k++) {
        double a = dividend->value[k], b = divisor->value[k];
        out->value[k] = a / b;
        out->law[k] = a / b * (dividend->law[k] / a - divisor->law[k] / b);
        out->effective[k] = fmin(dividend->effective[k], divisor->effective[k]);
        for (size_t e = 0; e < sizeof to / sizeof *to; e++)
            to[e][k] = fabs(a / b) * (of[e][0][k] / fabs(a) + of[e][1][k] / fabs(b));
    }
    return 0;
}
