#include "jobs/contact/contact_measure.h"
#include "core/contact/stretch.h"
#include "core/statistics/fit.h"
#include "jobs/contact/case/contact_case.h"
#include "jobs/contact/quantity/quantity.h"
#include <math.h>
#include <stdio.h>

/* Areas as they are under load need a surface with a scale, and a strain of the face that is that
 * of one material (F22.6). */
static bool has_stretched(const struct contact_case *one_case) {
    return one_case->edges && contact_case_has_scale(one_case) &&
           !contact_case_is_coated(one_case) && !one_case->two_faces;
}

static double stretched(const struct measure_context *context, double edges, double open) {
    return context->free_space ? stretch_free(edges, open) : stretch_first_order(edges, open);
}

static bool never_shown(const struct contact_case *one_case, size_t model) {
    (void)one_case, (void)model;
    return false;
}

static bool never_kept(const struct contact_case *one_case) {
    (void)one_case;
    return false;
}

static const struct measure NO_MEASURE = {.shown = never_shown, .kept = never_kept};

/* One row a measure, in the order of their curves in a result:
 *
 *     name, shown, kept, value,
 *     quantity, series, label, theories, order, solver, field, load, cell, values, over
 *
 * Words are those of measure.h without their first part. Shown is a condition on `one_case`
 * and `model`, kept one on `one_case`; the value is made of the variables of contact_measure. Fits
 * have theirs from all loads together. Areas by edges are kept even where they are not shown, since
 * fits need them. */
/* clang-format off */
#define LIST(ROW)                                                                                  \
    ROW(EDGES, one_case->edges, true, stretch_fraction(area.edges, open_now) / face,               \
        "contact_area", "edges", "A/A0", AREA, 2, SMOOTH, PRESSURE, FALLS, SAME, ALL, AREA)        \
    ROW(EDGES_STRETCHED, has_stretched(one_case) && !contact_case_stretches(one_case, model),      \
        has_stretched(one_case),                                                                   \
        context->scaled ? stretched(context, area.edges, pressed->open_stretch) / face             \
                        : (double)NAN,                                                             \
        "contact_area", "edges_stretched", "A/A0", NONE,                                           \
        2, SMOOTH, PRESSURE, FALLS, SAME, SOME, AREA)                                              \
    ROW(NODES, one_case->nodes, one_case->nodes, share * area.nodes,                                 \
        "contact_area", "nodes", "A/A0", AREA, 1, COUNTED, PRESSURE, FALLS, SAME, ALL, AREA)       \
    ROW(NODES_LOWER, one_case->nodes, false, share * area.lower,                                     \
        "contact_area", "nodes_lower", "A/A0", AREA,                                               \
        1, COUNTED, PRESSURE, FALLS, SAME, SOME, AREA)                                             \
    ROW(NODES_UPPER, one_case->nodes, false, share * area.upper,                                     \
        "contact_area", "nodes_upper", "A/A0", AREA,                                               \
        1, COUNTED, PRESSURE, FALLS, SAME, SOME, AREA)                                             \
    ROW(EDGES_UNKNOWN, false, false, share * area.edges_unknown,                                     \
        "contact_area", "edges_unknown", "A/A0", NONE, 1, COUNTED, PRESSURE, FALLS, SAME, SOME,    \
        AREA)                                                                                      \
    ROW(PERIMETER, one_case->perimeter, one_case->perimeter,                                       \
        stretch_fraction(area.perimeter, open_now) / face,                                         \
        "contact_area", "perimeter", "A/A0", AREA, 1, COUNTED, PRESSURE, FALLS, SAME, SOME, AREA)  \
    ROW(GAP, true, true, area.mean_gap / context->rms_height,                                      \
        "mean_gap", "", "mean gap/sqrt(m0)", GAP, 2, GAP, GAP, STAYS, SAME, ALL, HEIGHT)        \
    ROW(STIFFNESS, one_case->stiffness, true,                                                      \
        measure_stiffness(context, state->stiffness),                      \
        "stiffness", "", "K sqrt(m0)/(E* h'_rms)", NONE,                                           \
        2, STIFFNESS, GAP, FALLS, SAME, REPORTED, STIFFNESS)                                         \
    ROW(PATCHES, true, false, (double)patches.count,                                               \
        "patch_count", "cell", "patches", NONE, 1, PATCHES, PRESSURE, STAYS, GROWS, SOME, ONE)     \
    ROW(PATCH_MEAN, true, false, share * patches.mean / context->points,                             \
        "patch_mean_area", "", "mean patch", NONE,                                                 \
        1, PATCHES, PRESSURE, FALLS, SHRINKS, SOME, AREA)                                          \
    ROW(PATCH_LARGEST, true, false, share * (double)patches.largest / context->points,               \
        "patch_largest_area", "", "largest patch/cell", NONE,                                      \
        1, PATCHES, PRESSURE, FALLS, UNLIMITED, SOME, AREA)                                        \
    ROW(KAPPA, false, false, NAN,                                                                  \
        NULL, "", NULL, NONE, 2, SMOOTH, PRESSURE, STAYS, SAME, SOME, ONE)                         \
    ROW(POWER_LAW_A, false, false, NAN,                                                            \
        NULL, "", NULL, NONE, 2, SMOOTH, PRESSURE, STAYS, SAME, SOME, ONE)                         \
    ROW(POWER_LAW_B, false, false, NAN,                                                            \
        NULL, "", NULL, NONE, 2, SMOOTH, PRESSURE, STAYS, SAME, SOME, ONE)                         \
    ROW(ERF_KAPPA  , false, false, NAN,                                                            \
        NULL, "", NULL, NONE, 2, SMOOTH, PRESSURE, STAYS, SAME, SOME, ONE)                         \
    ROW(ITERATIONS, true, false, (double)state->iterations,                                        \
        "iterations", "", "iterations", NONE, 1, COUNTED, NONE, STAYS, SAME, ALL, ONE)             \
    ROW(WORK, true, false, state->work / context->points,                                          \
        "work", "", "points x transforms", NONE, 1, COUNTED, NONE, STAYS, POINT, SOME, ONE)        \
    ROW(VIOLATION, false, false, state->violation,                                                 \
        NULL, "", NULL, NONE, 1, COUNTED, NONE, STAYS, SAME, SOME, ONE)                            \
    ROW(PENETRATION, false, false, state->penetration,                                             \
        NULL, "", NULL, NONE, 1, COUNTED, NONE, STAYS, SAME, SOME, ONE)
#define CONDITIONS(name, shown, kept, ...)                                                         \
    static bool shown_##name(const struct contact_case *one_case, size_t model) {                  \
        (void)one_case, (void)model;                                                               \
        return shown;                                                                              \
    }                                                                                              \
    static bool kept_##name(const struct contact_case *one_case) {                                 \
        (void)one_case;                                                                            \
        return kept;                                                                               \
    }
LIST(CONDITIONS)

#define MEMBERS(name, shown, kept, value, quantity, series, label, theories, order, solver, field, \
                load, cell, values, over)                                                          \
    [MEASURE_##name] = {quantity, series, label, shown_##name, kept_##name, order,                 \
                        THEORIES_##theories, SOLVER_##solver, FIELD_##field,                       \
                        LOAD_##load, CELL_##cell, VALUES_##values, OVER_##over, BY_LOAD},
static const struct measure MEASURES[MEASURE_COUNT] = {LIST(MEMBERS)};
/* clang-format on */

const struct measure *measure_row(size_t measure) {
    const struct measure *own = MEASURES[measure].kept != NULL ? &MEASURES[measure] : NULL;
    if (measure >= MEASURE_QUANTITIES && measure < MEASURE_PAIRED)
        own = quantity_measure(measure - MEASURE_QUANTITIES);
    return own != NULL ? own : &NO_MEASURE;
}

bool measure_is_of(const struct contact_case *one_case, size_t measure) {
    return measure < MEASURE_QUANTITIES || measure >= MEASURE_PAIRED ||
           quantity_is_asked(one_case, measure - MEASURE_QUANTITIES);
}

size_t measure_paired(const struct contact_case *one_case) {
    return MEASURE_QUANTITIES + one_case->asked.measures;
}

#define NAME(name, ...) MEASURE_##name,
#define QUANTITY(n) (enum contact_measure)(MEASURE_QUANTITIES + (n))
#define FOUR(n) QUANTITY(n), QUANTITY((n) + 1), QUANTITY((n) + 2), QUANTITY((n) + 3)
const enum contact_measure MEASURE_CURVES[MEASURE_OWN] = {
    LIST(NAME) FOUR(0), FOUR(4),  FOUR(8),  FOUR(12), FOUR(16),
    FOUR(20),           FOUR(24), FOUR(28), FOUR(32), FOUR(36)};
_Static_assert(QUANTITY_MEASURES_MOST == 40, "measures of quantities without a number above");
_Static_assert(sizeof((enum contact_measure[]){LIST(NAME)}) +
                       QUANTITY_MEASURES_MOST * sizeof *MEASURE_CURVES ==
                   sizeof MEASURE_CURVES,
               "a measure without a row");

int contact_measure(const struct measure_context *context, const struct contact_pressed *pressed,
                    double values[MEASURE_OWN], struct error *err) {
    const struct contact_state *state = &pressed->state;
    double face = 1 + pressed->face_tilt;
    struct contact_area area;
    struct patches patches;
    contact_area(context->area, state, &area);
    double now = stretch_touching(area.nodes, pressed->stretch);
    double share = now * ((1 + pressed->contact_tilt) / face);
    patch_finder_lend(context->finder, state->scratch);
    patches_find(context->finder, state->p, &patches, NULL);
    /* Edges lie within the cells of outer nodes in contact, near which hardly any pressure acts.
     * Within them the face lies on the flat, without slopes. */
    double open_now = stretch_rest(area.nodes, now);
#define VALUE(name, shown, kept, value, ...) values[MEASURE_##name] = value;
    LIST(VALUE)
    return contact_quantities_measure(context->quantities, context, pressed, &area,
                                      values + MEASURE_QUANTITIES, err);
}

double measure_factor(enum measure_cell cell, double cells) {
    const double factors[CELL_KINDS] = {[CELL_SAME] = 1,
                                        [CELL_GROWS] = 1 / cells,
                                        [CELL_SHRINKS] = cells,
                                        [CELL_UNLIMITED] = NAN,
                                        [CELL_POINT] = 1};
    return factors[cell];
}

const char *measure_label(const struct measure *measure, enum measure_unit unit, int dimension,
                          struct case_result *result) {
    const char *of = unit == UNIT_CELL ? "cell" : dimension == 2 ? "lambda_l^2" : "lambda_l";
    const char *joint = unit == UNIT_CELL ? " in the " : " per ";
    char text[96];
    if (measure->cell != CELL_GROWS && measure->cell != CELL_SHRINKS)
        return measure->y_label;
    (void)snprintf(text, sizeof text, "%s%s%s", measure->y_label,
                   measure->cell == CELL_SHRINKS ? "/" : joint, of);
    return result_text(result, text);
}

/* Running sums of least squares. */
struct line_sums {
    double n, x, y, xx, xy;
};

void contact_measure_fits(size_t n, const double *loads, const double *edges, double *fits,
                          size_t stride) {
    double *kappa = fits, *power_law_a = fits + stride, *power_law_b = fits + 2 * stride;
    double *erf_kappa = fits + 3 * stride;
    double products = 0, squares = 0, slope = edges[0] < 1 ? edges[0] / loads[0] : (double)NAN;
    struct line_sums logs = {0};
    for (size_t k = 0; k < n; k++) {
        double x = log(loads[k]), y = edges[k] > 0 ? log(edges[k]) : (double)NAN;
        products += loads[k] * edges[k];
        squares += loads[k] * loads[k];
        logs = (struct line_sums){logs.n + 1, logs.x + x, logs.y + y, logs.xx + x * x,
                                  logs.xy + x * y};
        double power = (logs.n * logs.xy - logs.x * logs.y) / (logs.n * logs.xx - logs.x * logs.x);
        if (!(edges[k] > 0))
            slope = NAN;
        else if (edges[k] < 1)
            slope = fit_erf_near(k + 1, loads, edges, slope);
        kappa[k] = edges[k] > 0 ? measure_limited(products / squares) : (double)NAN;
        power_law_a[k] =
            k > 0 ? measure_limited(exp((logs.y - power * logs.x) / logs.n)) : (double)NAN;
        power_law_b[k] = k > 0 ? measure_limited(power) : (double)NAN;
        erf_kappa[k] = measure_limited(slope);
    }
}
