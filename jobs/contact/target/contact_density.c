#include "jobs/contact/target/contact_density.h"
#include <math.h>
#include <stdlib.h>

/* A density that is being summed. */
struct summing {
    const struct contact_answer *answer;
    size_t at, load, bins;
    double width;               /* of a bin */
    double base_area, area;     /* by edges: of the base, and of what has been added */
    struct estimate *estimates; /* room: by bin, as the next two */
    double *bound, *bound_error;
    double *expected; /* share of each bin, no less than what the base shows */
    struct contact_density *out;
};

/* A change of the density: sum weights[states] * density of a component, times the scale. */
struct change {
    enum role role;
    double scale;
    int weights[DENSITY_STATES_MOST];
};

/* --- components --- */

static size_t last_level(const struct target_component *component) {
    return component_case(component)->level_count - 1;
}

static double area_of(const struct summing *summing, enum role role, size_t model, size_t level) {
    const struct target_component *component = summing->answer->of[role];
    return contact_tally_mean(
               component_tally(component), MEASURE_EDGES,
               contact_case_cell(component_case(component), model, level, summing->load))
        .value;
}

/* Returns the mean share of the area in a cell of the tally, which may be outside the bins. */
static double share_of(const struct summing *summing, enum role role, size_t model, size_t level,
                       size_t bin) {
    const struct target_component *component = summing->answer->of[role];
    const struct contact_case *one_case = component_case(component);
    const struct contact_tally *tally = component_tally(component);
    size_t cell = contact_case_cell(one_case, model, level, summing->load);
    double solved =
        (double)(tally->realisations - contact_tally_valueless(tally, MEASURE_NODES, cell));
    double count = (double)tally->pressures
                       .count[contact_tally_pressure_cell(tally, model, level, summing->at) + bin];
    return count / (double)CONTACT_AREA_PARTS / solved /
           (double)grid_points(&one_case->levels[level].grid);
}

/* --- the base and the cell --- */

static void add_base(struct summing *summing) {
    const struct target_component *base = summing->answer->of[ROLE_BASE];
    struct contact_sum *sum = &summing->out->sum;
    contact_tally_pressure_shares(component_tally(base), 0, 0, summing->at, summing->estimates);
    for (size_t b = 0; b < summing->bins; b++) {
        struct estimate share = summing->estimates[b];
        sum->value[b] = sum->base[b] = share.value / summing->width;
        sum->variance[ROLE_BASE][b] =
            component_variance(base, share.standard_error / summing->width);
        summing->expected[b] = share.value + share.standard_error;
    }
    summing->area = summing->base_area = area_of(summing, ROLE_BASE, 0, 0);
    summing->out->below = share_of(summing, ROLE_BASE, 0, 0, 0);
    summing->out->above = share_of(summing, ROLE_BASE, 0, 0, summing->bins + 1);
}

/* The bound of the cell is from the change between the two longest cells, as that of measures. A
 * change may vanish in a bin where its sign changes: the bound is that of any bin near. */
static void bound_cell(struct summing *summing) {
    const struct target_component *base = summing->answer->of[ROLE_BASE],
                                  *cell = summing->answer->of[ROLE_CELL];
    struct contact_sum *sum = &summing->out->sum;
    if (cell == NULL)
        return;
    contact_tally_pressure_shares(component_tally(cell), 0, 0, summing->at, summing->estimates);
    for (size_t b = 0; b < summing->bins; b++) {
        double change = sum->base[b] - summing->estimates[b].value / summing->width;
        double other = summing->estimates[b].standard_error / summing->width;
        double variance = sum->variance[ROLE_BASE][b] / (double)base->done + other * other;
        sum->cell[b] = CELL_SHARE * sqrt(fmax(0, change * change - variance));
        sum->variance[ROLE_CELL][b] = CELL_SHARE * CELL_SHARE * component_variance(cell, other);
    }
    contact_errors_near_bins(summing->bins, sum->cell);
}

/* --- changes --- */

/* Adds a state of a component to a change. */
static void weigh(const struct summing *summing, struct change *change, size_t model, size_t level,
                  int weight) {
    const struct contact_case *one_case = component_case(summing->answer->of[change->role]);
    change->weights[density_state(one_case, model, level)] += weight;
}

/* Adds the model that is asked for less the cheap one, on a level. */
static void weigh_models(const struct summing *summing, struct change *change, size_t level,
                         int weight) {
    weigh(summing, change, 1, level, weight);
    weigh(summing, change, 0, level, -weight);
}

/* Estimates a change into the room. */
static void estimate_change(struct summing *summing, const struct change *change) {
    const struct target_component *component = summing->answer->of[change->role];
    double scale = change->scale / summing->width;
    contact_densities_difference(&component_tally(component)->densities, summing->at,
                                 change->weights, summing->expected, summing->estimates);
    for (size_t b = 0; b < summing->bins; b++) {
        summing->estimates[b].value *= scale;
        summing->estimates[b].standard_error *= fabs(scale);
    }
}

/* Adds the change of the area, and of what is outside the bins. */
static void add_areas(struct summing *summing, const struct change *change) {
    const struct contact_case *one_case = component_case(summing->answer->of[change->role]);
    for (size_t m = 0; m < one_case->model_count; m++)
        for (size_t l = 0; l < one_case->level_count; l++) {
            double times = change->scale * change->weights[density_state(one_case, m, l)];
            if (times == 0)
                continue;
            summing->area += times * area_of(summing, change->role, m, l);
            summing->out->below += times * share_of(summing, change->role, m, l, 0);
            summing->out->above += times * share_of(summing, change->role, m, l, summing->bins + 1);
        }
}

/* Adds a change. cell_share: LEVELS_CELL or MODELS_CELL, of the largest change of any bin near. */
static void add_change(struct summing *summing, const struct change *change, double cell_share) {
    const struct target_component *component = summing->answer->of[change->role];
    struct contact_sum *sum = &summing->out->sum;
    estimate_change(summing, change);
    for (size_t b = 0; b < summing->bins; b++) {
        struct estimate added = summing->estimates[b];
        sum->value[b] += added.value;
        sum->variance[change->role][b] = component_variance(component, added.standard_error);
        summing->bound[b] = fabs(added.value);
    }
    contact_errors_near_bins(summing->bins, summing->bound);
    for (size_t b = 0; b < summing->bins; b++)
        contact_sum_bound_added(summing->answer, change->role, cell_share, summing->bound[b], b,
                                sum);
    add_areas(summing, change);
}

/* Bounds what finer levels would change, by the change from the next coarser level to the finest,
 * into the room. */
static void bound_levels(struct summing *summing, const struct change *finest) {
    estimate_change(summing, finest);
    contact_errors_bins(component_case(summing->answer->of[finest->role]), summing->estimates,
                        summing->bound, summing->bound_error);
}

/* --- levels --- */

/* Adds the changes of the cheap model from one level of a component to another. */
static void add_level(struct summing *summing, enum role role, size_t from, size_t to) {
    struct change change = {.role = role,
                            .scale = summing->base_area / area_of(summing, role, 0, 0)};
    weigh(summing, &change, 0, to, 1);
    weigh(summing, &change, 0, from, -1);
    add_change(summing, &change, LEVELS_CELL);
}

static void add_levels(struct summing *summing) {
    const struct contact_answer *answer = summing->answer;
    const enum role last = contact_sum_mesh(answer);
    if (answer->of[last] == NULL)
        return;
    const size_t finest = last_level(answer->of[last]);
    if (last == ROLE_FINE)
        add_level(summing, ROLE_MESH, 0, 1);
    add_level(summing, last, last == ROLE_FINE ? 1 : 0, finest);
    struct change step = {.role = last, .scale = summing->base_area / area_of(summing, last, 0, 0)};
    weigh(summing, &step, 0, finest, 1);
    weigh(summing, &step, 0, finest - 1, -1);
    bound_levels(summing, &step);
    for (size_t b = 0; b < summing->bins; b++) {
        summing->out->sum.mesh[b] = summing->bound[b];
        summing->out->sum.mesh_standard_error[b] = summing->bound_error[b];
    }
}

/* --- models --- */

/* Adds the bound of what finer levels would change of the difference of the models, and of what
 * they would not. */
static void bound_models(struct summing *summing, enum role role, double scale) {
    const struct target_component *component = summing->answer->of[role];
    const struct contact_case *one_case = component_case(component);
    struct contact_sum *sum = &summing->out->sum;
    struct change step = {.role = role, .scale = scale};
    weigh_models(summing, &step, last_level(component), 1);
    weigh_models(summing, &step, last_level(component) - 1, -1);
    bound_levels(summing, &step);
    double left = contact_errors_mesh_floor(one_case, MEASURE_NODES, 0) +
                  contact_errors_mesh_floor(one_case, MEASURE_NODES, 1);
    for (size_t b = 0; b < summing->bins; b++) {
        sum->model[b] += summing->bound[b] + left * fabs(sum->value[b]);
        sum->model_standard_error[b] += summing->bound_error[b];
    }
}

/* Adds the model that is asked for less the cheap one on the finest level of "model", and the
 * change of that to the finest level of "model_mesh". */
static void add_models(struct summing *summing) {
    const struct contact_answer *answer = summing->answer;
    const struct target_component *model = answer->of[ROLE_MODEL],
                                  *mesh = answer->of[ROLE_MODEL_MESH];
    if (model == NULL)
        return;
    struct change change = {.role = ROLE_MODEL,
                            .scale =
                                summing->area / area_of(summing, ROLE_MODEL, 0, last_level(model))};
    weigh_models(summing, &change, last_level(model), 1);
    add_change(summing, &change, MODELS_CELL);
    if (mesh == NULL && !answer->named_mesh && last_level(model) > 0)
        bound_models(summing, ROLE_MODEL, change.scale);
    if (mesh == NULL)
        return;
    struct change further = {.role = ROLE_MODEL_MESH,
                             .scale = summing->area /
                                      area_of(summing, ROLE_MODEL_MESH, 0, last_level(mesh))};
    weigh_models(summing, &further, last_level(mesh), 1);
    weigh_models(summing, &further, 0, -1);
    add_change(summing, &further, LEVELS_CELL);
    bound_models(summing, ROLE_MODEL_MESH, further.scale);
}

/* The error of a named mesh, reported beside the answer, is that of the model that is asked for. */
static void bound_named_mesh(struct summing *summing) {
    const struct contact_answer *answer = summing->answer;
    const struct target_component *model = answer->of[ROLE_MODEL];
    if (!answer->named_mesh || model == NULL || last_level(model) == 0)
        return;
    struct change step = {.role = ROLE_MODEL,
                          .scale =
                              summing->area / area_of(summing, ROLE_MODEL, 1, last_level(model))};
    weigh(summing, &step, 1, last_level(model), 1);
    weigh(summing, &step, 1, last_level(model) - 1, -1);
    bound_levels(summing, &step);
    double left = contact_errors_mesh_floor(component_case(model), MEASURE_NODES, 1);
    for (size_t b = 0; b < summing->bins; b++)
        summing->out->sum.mesh[b] = summing->bound[b] + left * fabs(summing->out->sum.value[b]);
}

/* --- together --- */

/* Bounds what the tolerance of the solver changes: nodes that fall into a bin near. */
static void bound_solver(struct summing *summing) {
    struct contact_sum *sum = &summing->out->sum;
    const struct contact_case *base = component_case(summing->answer->of[ROLE_BASE]);
    const struct solver_counts of = {.tolerance = base->tolerance};
    for (size_t b = 0; b < summing->bins; b++)
        sum->solver[b] = contact_errors_solver(SOLVER_BINNED, &of, sum->value[b]);
    contact_errors_near_bins(summing->bins, sum->solver);
}

/* Sets the bounds by the effect of those of the area on the density; that of the cell where its own
 * change is less. */
static void bound_by_area(struct summing *summing, const struct contact_sum *area) {
    struct contact_density *out = summing->out;
    const double all = fabs(area->value[summing->load]);
    for (size_t b = 0; b < summing->bins; b++) {
        double by = contact_errors_sensitivity(summing->bins, out->x, out->sum.value, b) / all;
        out->sum.cell[b] = fmax(out->sum.cell[b], by * area->cell[summing->load]);
        double stretch = contact_errors_stretch(summing->bins, out->x, out->sum.value, b) / all;
        out->sum.law[b] = stretch * area->law[summing->load];
        out->sum.law_standard_error[b] = fabs(stretch) * area->law_standard_error[summing->load];
    }
}

int contact_density_create(const struct contact_answer *answer, const struct contact_sum *area,
                           size_t at, struct contact_density *out, struct error *err) {
    const struct bins *bins = &answer->one_case->pressure;
    const size_t n = bins->count;
    *out = (struct contact_density){0};
    struct estimate *estimates = result_room(answer->result, n, sizeof *estimates);
    double *room = result_numbers(answer->result, 4 * n);
    int status = contact_sum_room(answer, n, &out->sum, err);
    if (status == 0 && (estimates == NULL || room == NULL))
        status = error_memory(err, 4 * n * sizeof *room, "a density");
    if (status != 0)
        return status;
    struct summing summing = {.answer = answer,
                              .at = at,
                              .load = answer->one_case->pdf_loads[at],
                              .bins = n,
                              .width = bins_width(bins),
                              .estimates = estimates,
                              .bound = room + n,
                              .bound_error = room + 2 * n,
                              .expected = room + 3 * n,
                              .out = out};
    for (size_t b = 0; b < n; b++)
        room[b] = bins_centre(bins, b);
    out->x = room;
    add_base(&summing);
    bound_cell(&summing);
    add_levels(&summing);
    add_models(&summing);
    bound_named_mesh(&summing);
    bound_solver(&summing);
    bound_by_area(&summing, area);
    contact_sum_finish(answer, &out->sum);
    return 0;
}
