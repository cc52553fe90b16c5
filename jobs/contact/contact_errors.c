#include "jobs/contact/contact_errors.h"
#include "core/statistics/richardson.h"
#include "jobs/contact/contact_cell_errors.h"
#include "jobs/contact/contact_generation_errors.h"
#include "jobs/contact/contact_mean.h"
#include <math.h>

/* The block's share of a value is that of a half-space on a coarse mesh; for other models and
 * meshes it holds within this part of itself. */
static const double BLOCK_MARGIN = 0.25;
/* An answer is within so many times the solver's tolerance of the exact one: what varies smoothly
 * with the forces, and what counts points, one of which may fall on either side. Measured by
 * tests/validation/jobs/test_contact_errors.c. */
static const double SMOOTH_TOLERANCES = 100, COUNTED_TOLERANCES = 1000;

static const struct contact_error UNKNOWN = {NAN, NAN, NAN, NAN, NAN};

static size_t finest_of(const struct contact_case *one_case) {
    return one_case->level_count - 1;
}

static struct estimate finest_mean(const struct contact_tally *tally, enum contact_measure measure,
                                   size_t model, size_t load) {
    return contact_mean(tally, measure, model, finest_of(tally->one_case), load);
}

/* --- the mesh --- */

/* The order in which a measure converges on rough profiles and surfaces. */
static double known_order(enum contact_measure measure) {
    switch (measure) {
    case MEASURE_EDGES:
    case MEASURE_EDGES_STRETCHED:
    case MEASURE_KAPPA:
    case MEASURE_POWER_LAW_A:
    case MEASURE_POWER_LAW_B:
    case MEASURE_GAP:
    case MEASURE_STIFFNESS:
        return 2;
    default:
        return 1;
    }
}

/* Returns h of a level over that of the next finer one. */
static double refinement(const struct contact_case *one_case, size_t level) {
    return (double)one_case->levels[level + 1].grid.nx / (double)one_case->levels[level].grid.nx;
}

/* Changes of a value whose change between a level and the next coarser one is `change`. */
struct level_changes {
    struct mesh_changes of;
    double standard_error; /* of the finest change */
};
typedef struct estimate change_at(const struct contact_tally *tally, enum contact_measure measure,
                                  size_t model, size_t level, size_t load);

static struct level_changes changes_of(const struct contact_tally *tally,
                                       enum contact_measure measure, size_t model, size_t load,
                                       change_at *change) {
    const struct contact_case *one_case = tally->one_case;
    size_t finest = finest_of(one_case);
    struct estimate fine = change(tally, measure, model, finest, load);
    struct level_changes out = {.of = {.fine = fine.value,
                                       .coarse = NAN,
                                       .fine_ratio = refinement(one_case, finest - 1),
                                       .coarse_ratio = NAN},
                                .standard_error = fine.standard_error};
    if (finest > 1) {
        out.of.coarse = change(tally, measure, model, finest - 1, load).value;
        out.of.coarse_ratio = refinement(one_case, finest - 2);
    }
    return out;
}

static double size_of(const struct contact_error *error, double value) {
    return (fabs(error->value) + error->bound) / fabs(value);
}

/* A change between levels may vanish by chance at a load where the error changes sign: where no
 * order is seen, the bound is at least that of the neighbouring loads, relative to the values. */
static void spread_bounds(const struct contact_tally *tally, enum contact_measure measure,
                          size_t model, struct contact_error *out) {
    size_t n = tally->one_case->load_count;
    double before = 0, own = size_of(&out[0], finest_mean(tally, measure, model, 0).value);
    for (size_t k = 0; k < n; k++) {
        double y = finest_mean(tally, measure, model, k).value;
        double next =
            k + 1 < n ? size_of(&out[k + 1], finest_mean(tally, measure, model, k + 1).value) : 0;
        double most = fmax(before, next);
        if (isnan(out[k].order) && most > own)
            out[k].bound = most * fabs(y) - fabs(out[k].value);
        before = own;
        own = next;
    }
}

/* What the finest level errs by, from its change and the one before, at every load. */
static void limit_errors(const struct contact_tally *tally, enum contact_measure measure,
                         size_t model, change_at *change, struct contact_error *out) {
    for (size_t k = 0; k < tally->one_case->load_count; k++) {
        struct level_changes changes = changes_of(tally, measure, model, k, change);
        struct mesh_error error = mesh_error(&changes.of, known_order(measure));
        out[k] = (struct contact_error){.value = isnan(error.bound) ? (double)NAN : error.error,
                                        .bound = error.bound,
                                        .standard_error = error.weight * changes.standard_error,
                                        .bound_chance = error.weight * changes.standard_error,
                                        .order = error.order};
    }
    spread_bounds(tally, measure, model, out);
}

static double mesh_floor(const struct contact_case *one_case, enum contact_measure measure,
                         size_t model) {
    const struct contact_model *of = one_case->models[model];
    return of->mesh_floor != NULL
               ? of->mesh_floor(one_case->surface.dimension, measure, one_case->transition_depth)
               : 0;
}

/* Adds to bounds what no finer level takes off the meshes of a model, or of two that a difference
 * is of. */
static void add_floors(const struct contact_tally *tally, enum contact_measure measure,
                       size_t model, bool difference, struct contact_error *out) {
    const struct contact_case *one_case = tally->one_case;
    double share = mesh_floor(one_case, measure, model);
    if (difference)
        share += mesh_floor(one_case, measure, contact_case_complete(one_case));
    for (size_t k = 0; k < one_case->load_count; k++)
        out[k].bound += share * fabs(finest_mean(tally, measure, model, k).value);
}

static bool mesh_errors(const struct contact_tally *tally, enum contact_measure measure,
                        size_t model, struct contact_error *out) {
    if (tally->one_case->level_count < 2)
        return false;
    limit_errors(tally, measure, model, contact_tally_level, out);
    add_floors(tally, measure, model, false, out);
    return true;
}

/* --- the model --- */

static bool has_difference(const struct contact_tally *tally, size_t model) {
    return model != contact_case_complete(tally->one_case) && tally->one_case->level_count > 1;
}

/* The limit is what a difference is on the finest level less what that errs by. */
static void take_limit(struct estimate difference, struct contact_error *error) {
    error->value = difference.value - error->value;
    error->standard_error = hypot(difference.standard_error, error->standard_error);
}

/* The difference in the limit of the levels: it holds none of the meshes' own errors, but a bound
 * of what these leave of it. */
static bool model_errors(const struct contact_tally *tally, enum contact_measure measure,
                         size_t model, struct contact_error *out) {
    if (!has_difference(tally, model))
        return false;
    limit_errors(tally, measure, model, contact_tally_model_level, out);
    for (size_t k = 0; k < tally->one_case->load_count; k++)
        take_limit(contact_tally_model(tally, measure, model, k), &out[k]);
    add_floors(tally, measure, model, true, out);
    return true;
}

bool contact_errors_model_change(const struct contact_tally *tally, enum contact_measure measure,
                                 size_t model, struct contact_error *out) {
    const struct contact_case *one_case = tally->one_case;
    if (!has_difference(tally, model))
        return false;
    limit_errors(tally, measure, model, contact_tally_model_level, out);
    for (size_t k = 0; k < one_case->load_count; k++) {
        struct estimate all = {0};
        for (size_t l = 1; l < one_case->level_count; l++) {
            struct estimate change = contact_tally_model_level(tally, measure, model, l, k);
            all.value += change.value;
            all.standard_error += change.standard_error; /* they may go together */
        }
        take_limit(all, &out[k]);
    }
    add_floors(tally, measure, model, true, out);
    return true;
}

/* --- block, solver, missing realisations --- */

static bool block_errors(const struct contact_tally *tally, enum contact_measure measure,
                         size_t model, struct contact_error *out) {
    const struct contact_case *one_case = tally->one_case;
    double bound = contact_case_block_bound(one_case, model);
    for (size_t k = 0; k < one_case->load_count; k++) {
        double y = finest_mean(tally, measure, model, k).value;
        if (bound <= CONTACT_BLOCK_LOW) { /* as good as infinitely high */
            out[k] = (struct contact_error){.value = 0 * y, .bound = bound * fabs(y), .order = NAN};
            continue;
        }
        struct estimate change = contact_tally_block(tally, measure, model, k);
        double cell =
            contact_tally_mean(tally, measure, contact_case_probe_cell(one_case, model + 1, k))
                .value;
        double scale = cell != 0 ? y / cell : (double)NAN;
        out[k] = (struct contact_error){.value = scale * change.value,
                                        .bound = BLOCK_MARGIN * fabs(scale * change.value),
                                        .standard_error = fabs(scale) * change.standard_error,
                                        .order = NAN};
    }
    return true;
}

static bool solver_errors(const struct contact_tally *tally, enum contact_measure measure,
                          size_t model, struct contact_error *out) {
    const struct contact_case *one_case = tally->one_case;
    bool smooth = measure == MEASURE_EDGES || measure == MEASURE_EDGES_STRETCHED ||
                  measure == MEASURE_GAP || measure == MEASURE_KAPPA ||
                  measure == MEASURE_POWER_LAW_A || measure == MEASURE_POWER_LAW_B;
    double share = one_case->tolerance * (smooth ? SMOOTH_TOLERANCES : COUNTED_TOLERANCES);
    for (size_t k = 0; k < one_case->load_count; k++) {
        double y = finest_mean(tally, measure, model, k).value;
        out[k] = (struct contact_error){.value = 0 * y, .bound = share * fabs(y), .order = NAN};
    }
    return true;
}

static bool missing_errors(const struct contact_tally *tally, enum contact_measure measure,
                           size_t model, struct contact_error *out) {
    const struct contact_case *one_case = tally->one_case;
    size_t finest = finest_of(one_case);
    bool any = false;
    for (size_t k = 0; k < one_case->load_count; k++) {
        size_t cell = contact_case_cell(one_case, model, finest, k);
        double missing = (double)contact_tally_valueless(tally, measure, cell);
        double share = missing / (double)tally->realisations;
        out[k] = missing > 0 ? UNKNOWN : (struct contact_error){.order = NAN};
        size_t control = contact_mean_control(tally, measure, model, finest, k);
        if (control < one_case->model_count) {
            struct estimate pairs = contact_tally_model(tally, measure, control, k);
            double deviation = pairs.standard_error * sqrt((double)tally->realisations - missing);
            out[k] = (struct contact_error){.bound = share * MISSING_DEVIATIONS * deviation,
                                            .order = NAN};
        }
        any = any || missing == 0 || !isnan(out[k].value);
    }
    return any;
}

/* --- all --- */

typedef bool errors_of(const struct contact_tally *tally, enum contact_measure measure,
                       size_t model, struct contact_error *out);

bool contact_errors(const struct contact_tally *tally, enum contact_measure measure, size_t model,
                    enum error_source source, struct contact_error *out) {
    static errors_of *const SOURCES[ERROR_SOURCES] = {
        [ERROR_DISCRETISATION] = mesh_errors, [ERROR_CELL] = contact_cell_errors,
        [ERROR_BLOCK] = block_errors,         [ERROR_MODEL] = model_errors,
        [ERROR_SOLVER] = solver_errors,       [ERROR_GENERATION] = contact_generation_errors,
        [ERROR_MISSING] = missing_errors,
    };
    return SOURCES[source] != NULL &&
           contact_error_applies(tally, measure, model, finest_of(tally->one_case), source) &&
           SOURCES[source](tally, measure, model, out);
}

/* A model that leaves out finite slopes errs by them, unless the surface has no lengths of its own:
 * then it is the limit of small slopes that is asked for, or another model that stands in the same
 * case. */
static bool model_applies(const struct contact_case *one_case, size_t model) {
    bool complete = true;
    for (size_t m = 0; CONTACT_MODELS[m] != NULL; m++)
        complete = complete && one_case->models[model]->rank >= CONTACT_MODELS[m]->rank;
    return model != contact_case_complete(one_case) ||
           (!complete && contact_case_has_scale(one_case));
}

bool contact_error_applies(const struct contact_tally *tally, enum contact_measure measure,
                           size_t model, size_t level, enum error_source source) {
    const struct contact_case *one_case = tally->one_case;
    bool missing = false;
    if (measure >= MEASURE_PAIRED)
        return false;
    switch (source) {
    case ERROR_BLOCK:
        return isfinite(one_case->blocks[model].height);
    case ERROR_MODEL:
        return model_applies(one_case, model);
    case ERROR_MISSING:
        for (size_t k = 0; k < one_case->load_count; k++)
            missing = missing ||
                      contact_tally_valueless(tally, measure,
                                              contact_case_cell(one_case, model, level, k)) > 0;
        return missing && one_case->models[model]->may_fail;
    case ERROR_GENERATION:
        return surface_paths_apply(&one_case->surface);
    default:
        return true;
    }
}

/* --- pressures --- */

/* As nodes fall into bins by chance, the change of one between levels may vanish: the bound is that
 * of any bin so near. */
enum { BINS_NEAR = 2 };

/* Standard error of a share of the area that whole nodes make up, each where it is by chance
 * (Poisson). */
static double chance_of_nodes(const struct contact_tally *tally, size_t model, size_t at,
                              double share) {
    const struct contact_case *one_case = tally->one_case;
    size_t level = finest_of(one_case);
    size_t cell = contact_case_cell(one_case, model, level, one_case->pdf_loads[at]);
    double solved =
        (double)(tally->realisations - contact_tally_valueless(tally, MEASURE_NODES, cell));
    return sqrt(share / (solved * (double)grid_points(&one_case->levels[level].grid)));
}

bool contact_errors_pressures(const struct contact_tally *tally, size_t model, size_t at,
                              const struct estimate *shares, struct estimate *coarse, double *bound,
                              double *standard_error) {
    const struct contact_case *one_case = tally->one_case;
    size_t finest = finest_of(one_case), n = one_case->pressure.count;
    if (finest == 0)
        return false;
    double width = bins_width(&one_case->pressure), before[BINS_NEAR] = {0};
    double floor_share = mesh_floor(one_case, MEASURE_NODES, model);
    contact_tally_pressure_shares(tally, model, finest - 1, at, coarse);
    for (size_t b = 0; b < n; b++) {
        struct mesh_changes changes = {.coarse = NAN,
                                       .fine_ratio = refinement(one_case, finest - 1)};
        changes.fine = (shares[b].value - coarse[b].value) / width;
        bound[b] = mesh_error(&changes, 1).bound + floor_share * shares[b].value / width;
        standard_error[b] = chance_of_nodes(tally, model, at, shares[b].value) / width;
    }
    for (size_t b = 0; b < n; b++) {
        double own = bound[b];
        for (size_t a = 0; a < BINS_NEAR && !isnan(own); a++) {
            double next = b + a + 1 < n ? bound[b + a + 1] : 0;
            bound[b] = fmax(bound[b], fmax(before[a], next));
        }
        before[1] = before[0];
        before[0] = own;
    }
    return true;
}
