#include "jobs/contact/contact_errors.h"
#include "core/statistics/uncertainty/richardson.h"
#include "jobs/contact/companion/companion.h"
#include "jobs/contact/quantity/quantity.h"
#include <math.h>

/* A solution is within so many times the solver's tolerance of the exact one. */
static const double TOLERANCES_MOST = 1000;
/* Of WRONG times the tolerance of the nodes in contact the solver finds the wrong side at most: 0.1
 * to 1.5 were measured at tolerances of 1e-5 to 1e-3. They do so at random, which is counted by
 * SPREAD deviations. A share of so many nodes has an effect of so many times as much on counts, of
 * a part of it on areas by edges and gaps, and that of so many patches on patches. Open nodes are
 * closed within some tolerances of the RMS height, however small their gaps. Flows go
 * with the cube of gaps, and through few nodes. Measured by
 * tests/validation/jobs/test_contact_errors.c, test_random_contacts.c and
 * test_quantity_errors.c. */
static const double WRONG = 2, SPREAD = 3;
static const double COUNTED_PART = 3, SMOOTH_PART = 0.3, SMOOTH_TOLERANCES = 5, PATCHES_PART = 1;
static const double OPEN_TOLERANCES = 3, FLOW_PART = 45;
/* Nodes of a realisation that a count of those that slide may be off by, beside what its change
 * from mesh to mesh shows. */
static const double HALF_NODE = 0.5;

static const struct contact_error UNKNOWN = {NAN, NAN, NAN, NAN, NAN};

static size_t finest_of(const struct contact_case *one_case) {
    return one_case->level_count - 1;
}

/* Returns how many values a measure has: of loads, or of points of sliding. */
static size_t values_of(const struct contact_tally *tally, enum contact_measure measure) {
    return contact_case_values(tally->one_case, measure_row(measure)->by);
}

static struct estimate finest_mean(const struct contact_tally *tally, enum contact_measure measure,
                                   size_t model, size_t load) {
    return contact_mean(tally, measure, model, finest_of(tally->one_case), load);
}

/* --- the mesh --- */

/* Returns the spacing of a level over that of the next finer one. */
static double refinement(const struct contact_case *one_case, size_t level) {
    return (double)one_case->levels[level + 1].grid.nx / (double)one_case->levels[level].grid.nx;
}

/* Changes of a value between levels; `change` gives that from a level to the next coarser one. */
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
    return value != 0 ? (fabs(error->value) + error->bound) / fabs(value) : 0;
}

/* A change between levels vanishes at a load where the error changes sign. Where no order is
 * observed, the bound is at least that of the neighbouring loads, relative to the values. */
static void spread_bounds(const struct contact_tally *tally, enum contact_measure measure,
                          size_t model, struct contact_error *out) {
    size_t n = values_of(tally, measure);
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

/* Estimates the error of the finest level, from its change and the one before, at every load. */
static void limit_errors(const struct contact_tally *tally, enum contact_measure measure,
                         size_t model, change_at *change, struct contact_error *out) {
    for (size_t k = 0; k < values_of(tally, measure); k++) {
        struct level_changes changes = changes_of(tally, measure, model, k, change);
        struct mesh_error error = mesh_error(&changes.of, measure_row(measure)->order);
        out[k] =
            (struct contact_error){.value = isnan(error.bound) ? (double)NAN : error.error,
                                   .bound = error.bound,
                                   .standard_error = error.weight * changes.standard_error,
                                   .bound_standard_error = error.weight * changes.standard_error,
                                   .order = error.order};
    }
    spread_bounds(tally, measure, model, out);
}

double contact_errors_mesh_floor(const struct contact_case *one_case, enum contact_measure measure,
                                 size_t model) {
    const struct contact_model *of = one_case->models[model];
    const struct grid *grid = &contact_case_finest(one_case)->grid;
    return of->mesh_floor != NULL
               ? of->mesh_floor(one_case->surface.dimension, measure_row(measure)->field,
                                contact_case_transition(one_case, grid))
               : 0;
}

/* Adds to bounds the part that finer levels do not reduce, of a model, or of two for a
 * difference. */
static void add_floors(const struct contact_tally *tally, enum contact_measure measure,
                       size_t model, bool difference, struct contact_error *out) {
    const struct contact_case *one_case = tally->one_case;
    double share = contact_errors_mesh_floor(one_case, measure, model);
    if (difference)
        share += contact_errors_mesh_floor(one_case, measure, contact_case_complete(one_case));
    for (size_t k = 0; k < values_of(tally, measure); k++)
        out[k].bound += share * fabs(finest_mean(tally, measure, model, k).value);
}

/* Returns the measure by which an area by edges may be off where their law does not hold: beside
 * yielded nodes (F21.5), and of what sticks (F14.20). 0: none. */
static size_t unknown_of(const struct contact_case *one_case, enum contact_measure measure) {
    bool by_edges = measure == MEASURE_EDGES || measure == MEASURE_EDGES_STRETCHED ||
                    measure == MEASURE_PERIMETER;
    if (by_edges && measure_is_of(one_case, EDGES_YIELDED))
        return EDGES_YIELDED;
    return (size_t)measure == SLIDING_STICK_BY_EDGES ? SLIDING_STICK_UNKNOWN : 0;
}

static void add_unknown(const struct contact_tally *tally, enum contact_measure measure,
                        size_t model, struct contact_error *out) {
    const size_t unknown = unknown_of(tally->one_case, measure);
    for (size_t k = 0; unknown != 0 && k < values_of(tally, measure); k++)
        out[k].bound += finest_mean(tally, (enum contact_measure)unknown, model, k).value;
}

/* Adds what counts of nodes that slide leave open (F14.17). Where fewer than half a node sticks in
 * the mean, all realisations may be off alike. At the start nothing slid. */
static void add_counted(const struct contact_tally *tally, enum contact_measure measure,
                        size_t model, struct contact_error *out) {
    const struct contact_case *one_case = tally->one_case;
    const struct measure *row = measure_row(measure);
    const struct grid *grid = &contact_case_finest(one_case)->grid;
    const double area = finest_mean(tally, MEASURE_NODES, model, one_case->slip_load).value;
    const double half = HALF_NODE / (area * (double)grid_points(grid));
    const double shared = half / sqrt((double)tally->realisations);
    if (row->by != BY_SLIDING || row->solver != SOLVER_COUNTED)
        return;
    for (size_t k = one_case->slip_pressing ? 0 : 1; k < values_of(tally, measure); k++) {
        bool all = finest_mean(tally, measure, model, k).value < half;
        out[k].bound += all ? half : shared;
    }
}

static bool mesh_errors(const struct contact_tally *tally, enum contact_measure measure,
                        size_t model, struct contact_error *out) {
    if (tally->one_case->level_count < 2)
        return false;
    limit_errors(tally, measure, model, contact_tally_level, out);
    add_floors(tally, measure, model, false, out);
    add_unknown(tally, measure, model, out);
    add_counted(tally, measure, model, out);
    return true;
}

/* --- the model --- */

static bool has_difference(const struct contact_tally *tally, size_t model) {
    return model != contact_case_complete(tally->one_case) && tally->one_case->level_count > 1;
}

/* The limit is the difference on the finest level less its error. */
static void take_limit(struct estimate difference, struct contact_error *error) {
    error->value = difference.value - error->value;
    error->standard_error = hypot(difference.standard_error, error->standard_error);
}

/* Estimates the difference in the limit of the levels. It contains no error of the meshes, but a
 * bound of what these leave of it. */
static bool model_errors(const struct contact_tally *tally, enum contact_measure measure,
                         size_t model, struct contact_error *out) {
    if (!has_difference(tally, model))
        return false;
    limit_errors(tally, measure, model, contact_tally_model_level, out);
    for (size_t k = 0; k < values_of(tally, measure); k++)
        take_limit(contact_tally_model(tally, measure, model, k), &out[k]);
    add_floors(tally, measure, model, true, out);
    if (measure_row(measure)->by == BY_SLIDING)
        add_unknown(tally, measure, contact_case_complete(tally->one_case), out);
    add_counted(tally, measure, model, out);
    return true;
}

bool contact_errors_model_change(const struct contact_tally *tally, enum contact_measure measure,
                                 size_t model, struct contact_error *out) {
    const struct contact_case *one_case = tally->one_case;
    if (!has_difference(tally, model))
        return false;
    limit_errors(tally, measure, model, contact_tally_model_level, out);
    for (size_t k = 0; k < values_of(tally, measure); k++) {
        struct estimate all = {0};
        for (size_t l = 1; l < one_case->level_count; l++) {
            struct estimate change = contact_tally_model_level(tally, measure, model, l, k);
            all.value += change.value;
            all.standard_error += change.standard_error; /* they may be correlated */
        }
        take_limit(all, &out[k]);
    }
    add_floors(tally, measure, model, true, out);
    return true;
}

/* --- solver, missing realisations --- */

double contact_errors_solver(enum measure_solver solver, const struct solver_counts *of,
                             double value) {
    double wrong = WRONG * of->tolerance * of->nodes, most = wrong + SPREAD * sqrt(wrong);
    double smooth = SMOOTH_TOLERANCES * of->tolerance + SMOOTH_PART * most / of->nodes;
    double counted = COUNTED_PART * most / of->nodes;
    const double shares[] = {[SOLVER_SMOOTH] = smooth,
                             [SOLVER_GAP] = smooth,
                             [SOLVER_COUNTED] = counted,
                             [SOLVER_STIFFNESS] = counted,
                             [SOLVER_FLOW] = FLOW_PART / COUNTED_PART * counted,
                             [SOLVER_BINNED] = INFINITY,
                             [SOLVER_PATCHES] = PATCHES_PART * most / of->patches};
    /* fmin ignores the NaN of no nodes */
    double bound = fmin(TOLERANCES_MOST * of->tolerance, shares[solver]) * fabs(value);
    if (solver == SOLVER_STIFFNESS)
        bound *= fmax(1, of->nodes / fmax(1, of->open));
    if (solver == SOLVER_GAP && !isnan(value))
        bound = fmax(bound,
                     OPEN_TOLERANCES * of->tolerance * (of->open + most) / (of->open + of->nodes));
    return bound;
}

static bool solver_errors(const struct contact_tally *tally, enum contact_measure measure,
                          size_t model, struct contact_error *out) {
    const struct contact_case *one_case = tally->one_case;
    const size_t finest = finest_of(one_case);
    const bool slides = measure_row(measure)->by == BY_SLIDING;
    for (size_t i = 0; i < values_of(tally, measure); i++) {
        size_t k = slides ? one_case->slip_load : i;
        size_t cell = contact_case_cell(one_case, model, finest, k);
        double y = finest_mean(tally, measure, model, i).value;
        double solved =
            (double)(tally->realisations - contact_tally_valueless(tally, MEASURE_NODES, cell));
        double points = solved * (double)grid_points(&one_case->levels[finest].grid);
        double area = finest_mean(tally, MEASURE_NODES, model, k).value;
        const struct solver_counts of = {
            .tolerance = one_case->tolerance,
            .nodes = area * points,
            .open = (1 - area) * points,
            .patches = solved * finest_mean(tally, MEASURE_PATCHES, model, k).value};
        double bound = contact_errors_solver(measure_row(measure)->solver, &of, y);
        out[i] = (struct contact_error){.value = 0 * y, .bound = bound, .order = NAN};
    }
    return true;
}

static bool missing_errors(const struct contact_tally *tally, enum contact_measure measure,
                           size_t model, struct contact_error *out) {
    const struct contact_case *one_case = tally->one_case;
    size_t finest = finest_of(one_case);
    bool any = false;
    for (size_t k = 0; k < values_of(tally, measure); k++) {
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

/* A model that neglects finite slopes has an error by them. For a surface without a scale the limit
 * of small slopes is asked for: the error then applies only beside a more complete model of the
 * case. */
static bool model_applies(const struct contact_case *one_case, size_t model) {
    bool complete = true;
    for (size_t m = 0; CONTACT_MODELS[m] != NULL; m++)
        complete = complete && one_case->models[model]->rank >= CONTACT_MODELS[m]->rank;
    return model != contact_case_complete(one_case) ||
           (!complete && contact_case_has_scale(one_case));
}

static bool missing_applies(const struct contact_tally *tally, enum contact_measure measure,
                            size_t model, size_t level) {
    const struct contact_case *one_case = tally->one_case;
    bool missing = false;
    for (size_t k = 0; k < values_of(tally, measure); k++)
        missing = missing || contact_tally_valueless(
                                 tally, measure, contact_case_cell(one_case, model, level, k)) > 0;
    return missing && one_case->models[model]->may_fail;
}

/* --- all --- */

typedef bool errors_of(const struct contact_tally *tally, enum contact_measure measure,
                       size_t model, struct contact_error *out);

/* Companions estimate the errors of the other sources. */
bool contact_errors(const struct contact_tally *tally, enum contact_measure measure, size_t model,
                    enum error_source source, struct contact_error *out) {
    static errors_of *const OWN[ERROR_SOURCES] = {[ERROR_DISCRETISATION] = mesh_errors,
                                                  [ERROR_MODEL] = model_errors,
                                                  [ERROR_SOLVER] = solver_errors,
                                                  [ERROR_MISSING] = missing_errors};
    const struct companion *companion = companion_of(source);
    errors_of *errors = companion != NULL ? companion->errors : OWN[source];
    return errors != NULL &&
           contact_error_applies(tally, measure, model, finest_of(tally->one_case), source) &&
           errors(tally, measure, model, out);
}

bool contact_error_applies(const struct contact_tally *tally, enum contact_measure measure,
                           size_t model, size_t level, enum error_source source) {
    const struct companion *companion = companion_of(source);
    if (measure >= MEASURE_PAIRED)
        return false;
    if (companion != NULL)
        return companion->applies(tally->one_case, model);
    if (source == ERROR_MODEL)
        return model_applies(tally->one_case, model);
    return source != ERROR_MISSING || missing_applies(tally, measure, model, level);
}

/* --- pressures --- */

/* Nodes fall into bins at random, so that the change of one bin between levels may vanish: the
 * bound is that of any bin so near. */
enum { BINS_NEAR = 2 };

void contact_errors_near_bins(size_t n, double *bound) {
    double before[BINS_NEAR] = {0};
    for (size_t b = 0; b < n; b++) {
        double own = bound[b];
        for (size_t a = 0; a < BINS_NEAR && !isnan(own); a++) {
            double next = b + a + 1 < n ? bound[b + a + 1] : 0;
            bound[b] = fmax(bound[b], fmax(before[a], next));
        }
        before[1] = before[0];
        before[0] = own;
    }
}

/* Returns the standard error of a share of the area that consists of whole nodes, each in it at
 * random (Poisson). */
static double error_of_nodes(const struct contact_tally *tally, size_t model, size_t at,
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
    double width = bins_width(&one_case->pressure);
    double floor_share = contact_errors_mesh_floor(one_case, MEASURE_NODES, model);
    contact_tally_pressure_shares(tally, model, finest - 1, at, coarse);
    for (size_t b = 0; b < n; b++) {
        struct mesh_changes changes = {.coarse = NAN,
                                       .fine_ratio = refinement(one_case, finest - 1)};
        changes.fine = (shares[b].value - coarse[b].value) / width;
        bound[b] = mesh_error(&changes, 1).bound + floor_share * shares[b].value / width;
        standard_error[b] = error_of_nodes(tally, model, at, shares[b].value) / width;
    }
    contact_errors_near_bins(n, bound);
    return true;
}

void contact_errors_bins(const struct contact_case *one_case, const struct estimate *change,
                         double *bound, double *standard_error) {
    size_t n = one_case->pressure.count;
    struct mesh_changes changes = {.coarse = NAN,
                                   .fine_ratio = refinement(one_case, finest_of(one_case) - 1)};
    for (size_t b = 0; b < n; b++) {
        changes.fine = change[b].value;
        struct mesh_error error = mesh_error(&changes, 1);
        bound[b] = error.bound;
        standard_error[b] = error.weight * change[b].standard_error;
    }
    contact_errors_near_bins(n, bound);
}

/* Estimates a model less the most complete one on a level, less that on the next coarser one if it
 * is a step. */
static void difference_of_models(const struct contact_tally *tally, size_t model, size_t at,
                                 bool step, const double *expected, struct estimate *out) {
    const struct contact_case *one_case = tally->one_case;
    const size_t complete = contact_case_complete(one_case), finest = finest_of(one_case);
    int weights[DENSITY_STATES_MOST] = {0};
    weights[density_state(one_case, model, finest)] = 1;
    weights[density_state(one_case, complete, finest)] = -1;
    if (step) {
        weights[density_state(one_case, model, finest - 1)] = -1;
        weights[density_state(one_case, complete, finest - 1)] = 1;
    }
    contact_densities_difference(&tally->densities, at, weights, expected, out);
}

bool contact_errors_density_model(const struct contact_tally *tally, size_t model, size_t at,
                                  const struct estimate *shares, struct estimate *room,
                                  double *value, double *bound, double *standard_error) {
    const struct contact_case *one_case = tally->one_case;
    const size_t n = one_case->pressure.count;
    if (tally->densities.states == 0 || !has_difference(tally, model))
        return false;
    const double width = bins_width(&one_case->pressure);
    const double left =
        contact_errors_mesh_floor(one_case, MEASURE_NODES, model) +
        contact_errors_mesh_floor(one_case, MEASURE_NODES, contact_case_complete(one_case));
    double *expected = value; /* until the values are known */
    for (size_t b = 0; b < n; b++)
        expected[b] = shares[b].value + shares[b].standard_error;
    difference_of_models(tally, model, at, true, expected, room);
    contact_errors_bins(one_case, room, bound, standard_error);
    difference_of_models(tally, model, at, false, expected, room);
    for (size_t b = 0; b < n; b++) {
        value[b] = room[b].value / width;
        bound[b] = (bound[b] + left * shares[b].value) / width;
        standard_error[b] = hypot(room[b].standard_error, standard_error[b]) / width;
    }
    return true;
}

/* Returns x times the derivative of y. */
static double steepness(size_t n, const double *x, const double *y, size_t b) {
    size_t left = b > 0 ? b - 1 : b, right = b + 1 < n ? b + 1 : b;
    return right > left ? x[b] * (y[right] - y[left]) / (x[right] - x[left]) : 0;
}

double contact_errors_stretch(size_t n, const double *x, const double *y, size_t b) {
    return 2 * y[b] + steepness(n, x, y, b);
}

double contact_errors_sensitivity(size_t n, const double *x, const double *y, size_t b) {
    return 2 * fabs(y[b]) + fabs(steepness(n, x, y, b));
}
