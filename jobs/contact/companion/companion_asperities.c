/* Theories of asperities by the summits that are counted on each surface of a case (FORMULAS.md,
 * F13.7): areas without a solver, beside those with one. They are no error of the case. Summits of
 * the two finest levels estimate what the grid changes. */
#include "core/contact/counted_asperities.h"
#include "core/statistics/uncertainty/richardson.h"
#include "jobs/contact/companion/companion.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Series: each theory on the finest level, then each on the next one. */
enum { GRIDS_MOST = 2 };
/* CPU seconds of a theory at one load, for a summit (bench_contact). */
static const double SUMMIT_SECONDS = 1e-7;
/* A point in so many is a summit at 8 points a shortest wave, or more. */
static const double POINTS_OF_SUMMIT = 60;

struct asperities {
    double rms_height, rms_slope;
    struct counted_asperities *of[GRIDS_MOST]; /* owned, as the next */
    double *z;                                 /* on the finest level */
};

/* Returns how many grids summits are counted on. */
static size_t grids_of(const struct contact_case *one_case) {
    return one_case->level_count > 1 ? 2 : 1;
}

static const struct contact_level *level_of(const struct contact_case *one_case, size_t grid) {
    return &one_case->levels[one_case->level_count - 1 - grid];
}

/* --- the plan --- */

static bool asperities_plan(const struct contact_case *one_case, struct companion_plan *out) {
    if (!one_case->asperities || one_case->surface.dimension != 2)
        return false;
    out->level = *contact_case_finest(one_case);
    out->due = (struct subset){.interval = 1};
    out->series = COUNTED_THEORIES * grids_of(one_case);
    for (size_t t = 0; grids_of(one_case) > 1 && t < COUNTED_THEORIES; t++)
        out->pairs[out->pair_count++] =
            (struct companion_pair){.of = t, .less = COUNTED_THEORIES + t};
    return true;
}

static double asperities_bytes(const struct contact_case *one_case,
                               const struct companion_plan *plan) {
    double bytes = 8 * (double)grid_points(&plan->level.grid);
    for (size_t g = 0; g < grids_of(one_case); g++)
        bytes += counted_asperities_bytes(&level_of(one_case, g)->grid);
    return bytes;
}

static double asperities_seconds(const struct contact_case *one_case,
                                 const struct companion_plan *plan) {
    return SUMMIT_SECONDS * (double)(plan->series * one_case->load_count) *
           (double)grid_points(&plan->level.grid) / POINTS_OF_SUMMIT;
}

/* --- the surfaces --- */

static int asperities_create(void *workspace, const struct contact_case *one_case,
                             const struct companion_plan *plan, const struct moments *moments,
                             struct error *err) {
    struct asperities *asperities = workspace;
    size_t points = grid_points(&plan->level.grid);
    int status = 0;
    asperities->rms_height = moments->rms_height;
    asperities->rms_slope = moments->rms_slope;
    for (size_t g = 0; g < grids_of(one_case) && status == 0; g++)
        status =
            counted_asperities_create(&asperities->of[g], &level_of(one_case, g)->grid, false, err);
    if (status != 0)
        return status;
    asperities->z = array_create(points, sizeof *asperities->z);
    return asperities->z != NULL ? 0 : error_memory(err, points * sizeof(double), "a surface");
}

static void asperities_clear(void *workspace) {
    struct asperities *asperities = workspace;
    for (size_t g = 0; g < GRIDS_MOST; g++)
        counted_asperities_destroy(&asperities->of[g]);
    free(asperities->z);
}

static void press(const struct contact_case *one_case, const struct counted_asperities *asperities,
                  enum counted_theory theory, double *series) {
    for (size_t k = 0; k < one_case->load_count; k++)
        series[MEASURE_EDGES * contact_case_slots(one_case) + k] =
            counted_asperities_area(asperities, theory, one_case->loads[k]);
}

static int asperities_solve(void *workspace, const struct contact_surface *surface,
                            struct contact_tally *tally, struct companion_tally *out,
                            const struct contact_stopper *stopper, struct error *err) {
    struct asperities *asperities = workspace;
    const struct contact_case *one_case = tally->one_case;
    const struct level_source source = {asperities->rms_height, surface->key};
    int status = 0;
    for (size_t g = 0; g < grids_of(one_case) && status == 0; g++) {
        if (stopper->stop(stopper->context) != 0)
            return error_set(err, ERROR_STOPPED, "stopped at the summits of a surface");
        status = contact_level_sample(level_of(one_case, g), &one_case->surface, &source,
                                      surface->z, asperities->z, err);
        if (status == 0)
            status = counted_asperities_take(asperities->of[g], asperities->z,
                                             asperities->rms_height, asperities->rms_slope, err);
        for (size_t t = 0; t < COUNTED_THEORIES && status == 0; t++)
            press(one_case, asperities->of[g], (enum counted_theory)t,
                  companion_series(one_case, out, g * COUNTED_THEORIES + t));
    }
    return status;
}

/* --- curves --- */

/* Of each theory its series, and the theory of the same name of a Gaussian surface. */
static const struct name {
    const char *series, *gaussian, *translated;
} NAMES[COUNTED_THEORIES] = {[COUNTED_GW] = {"gw_counted", "gw_mccool", "gw_translation"},
                             [COUNTED_BGT] = {"bgt_counted", "bgt", "bgt_translation"}};

/* Takes the theories of the same name over from the curve of contact areas, as far as it has any.
 */
static void add_theories(const struct name *name, const struct case_result *result,
                         struct curve *curve) {
    const struct curve *area = result_curve(result, "contact_area");
    for (size_t t = 0; area != NULL && t < area->theory_count; t++)
        if (strcmp(area->theories[t].name, name->gaussian) == 0 ||
            strcmp(area->theories[t].name, name->translated) == 0)
            curve->theories[curve->theory_count++] = area->theories[t];
}

/* Adds the error of the grid by the change from the next level, of second order (F8.3). */
static int add_discretisation(const struct contact_tally *tally, size_t theory, struct curve *curve,
                              struct case_result *out, struct error *err) {
    const struct contact_case *one_case = tally->one_case;
    size_t n = one_case->load_count;
    curve->errors[ERROR_DISCRETISATION].applies = true;
    if (grids_of(one_case) < 2)
        return 0;
    double *value = result_numbers(out, 3 * n);
    if (value == NULL)
        return error_memory(err, 3 * n * sizeof *value, "errors");
    double *bound = value + n, *standard_error = bound + n;
    for (size_t k = 0; k < n; k++) {
        struct estimate change =
            contact_tally_pair(tally, COMPANION_ASPERITIES, theory, MEASURE_EDGES, k);
        const struct mesh_changes changes = {.fine = change.value,
                                             .coarse = NAN,
                                             .fine_ratio = level_of(one_case, 0)->points /
                                                           level_of(one_case, 1)->points,
                                             .coarse_ratio = NAN};
        const struct mesh_error error = mesh_error(&changes, 2);
        value[k] = isnan(error.bound) ? (double)NAN : error.error;
        bound[k] = error.bound;
        standard_error[k] = error.weight * change.standard_error;
    }
    curve->errors[ERROR_DISCRETISATION] = (struct curve_error){.applies = true,
                                                               .value = value,
                                                               .bound = bound,
                                                               .standard_error = standard_error,
                                                               .order = NAN};
    return 0;
}

static int add_curve(const struct contact_tally *tally, size_t theory, struct case_result *out,
                     struct error *err) {
    const struct contact_case *one_case = tally->one_case;
    size_t n = one_case->load_count;
    double *x = result_numbers(out, 3 * n);
    if (x == NULL)
        return error_memory(err, 3 * n * sizeof *x, "curves");
    double *y = x + n, *standard_error = y + n;
    for (size_t k = 0; k < n; k++) {
        const struct estimate mean =
            contact_tally_companion(tally, COMPANION_ASPERITIES, theory, MEASURE_EDGES, k);
        x[k] = one_case->loads[k];
        y[k] = mean.value;
        standard_error[k] = mean.standard_error;
    }
    struct curve curve = curve_named("asperity_area", "p/(E* h'_rms)", "A/A0 of counted summits");
    curve.series = NAMES[theory].series;
    curve_set_points(&curve, n, x, y, standard_error);
    add_theories(&NAMES[theory], out, &curve);
    int status = add_discretisation(tally, theory, &curve, out, err);
    return status == 0 ? result_add_curve(out, &curve, err) : status;
}

static int asperities_curves(const struct contact_tally *tally, struct case_result *out,
                             struct error *err) {
    int status = 0;
    for (size_t t = 0; t < COUNTED_THEORIES && status == 0; t++)
        status = add_curve(tally, t, out, err);
    return status;
}

COMPANION_DEFINE(ASPERITIES, "counted summits", NULL, ERROR_SOURCES, asperities_plan,
                 struct asperities, asperities_create, asperities_clear, asperities_bytes,
                 asperities_seconds, asperities_solve, NULL, NULL, asperities_curves)
