/* The error "generation" of non-Gaussian surfaces. Beside some realisations the surface is also
 * made by alternative generators (surface_paths.h), and pressed on a half-space on a coarse mesh,
 * as the own one is. The error is estimated from the changes in these pairs.
 *
 * The interval is such that they take less than a tenth of the case's time, but for the first ones
 * of a small study. Gaussian surfaces have one generator, and no such error. */
#include "jobs/contact/companion/companion.h"
#include "jobs/surface/surface_paths.h"
#include <stdlib.h>
#include <string.h>

/* Time for these surfaces, over that of the case without. */
static const double TIME_SHARE = 0.08;
/* Series: the own surface, then one for each path. The fact is log2 of eps_h over that after longer
 * iterations. */
enum { OWN, ALTERNATIVE, SERIES = ALTERNATIVE + SURFACE_PATHS, HALVINGS = 0 };

struct generation {
    const struct companion_plan *plan;
    struct surface_paths *paths; /* owned, as all below */
    struct coarse_solver *halfspace;
    double rms_height; /* of the surfaces */
    double *z;         /* heights on the coarse mesh */
};

/* --- the plan --- */

static double generation_bytes(const struct contact_case *one_case,
                               const struct companion_plan *plan) {
    const struct grid *grid = &plan->level.grid;
    return surface_paths_bytes(&one_case->surface) + 8 * (double)grid_points(grid) +
           coarse_solver_bytes(grid);
}

/* Returns the CPU seconds of the own surface and the others, generated and pressed. */
static double generation_seconds(const struct contact_case *one_case,
                                 const struct companion_plan *plan) {
    return surface_paths_seconds(&one_case->surface) +
           SERIES * coarse_solver_seconds(one_case, &plan->level.grid);
}

static bool generation_plan(const struct contact_case *one_case, struct companion_plan *out) {
    if (!surface_paths_apply(&one_case->surface))
        return false;
    out->level = coarse_level(one_case);
    out->series = SERIES;
    for (size_t path = 0; path < SURFACE_PATHS; path++)
        out->pairs[out->pair_count++] = (struct companion_pair){.of = ALTERNATIVE + path};
    out->fact_count = 1;
    out->due = subset_each(subset_interval(generation_seconds(one_case, out),
                                           TIME_SHARE * contact_case_least_seconds(one_case), 1));
    return true;
}

/* --- the surfaces --- */

static int generation_create(void *workspace, const struct contact_case *one_case,
                             const struct companion_plan *plan, const struct moments *moments,
                             struct error *err) {
    struct generation *generation = workspace;
    const struct grid *grid = &plan->level.grid;
    generation->plan = plan;
    generation->rms_height = moments->rms_height;
    int status = surface_paths_create(&generation->paths, &one_case->surface, err);
    if (status == 0)
        status =
            coarse_solver_create(&generation->halfspace, one_case, grid, INFINITY, moments, err);
    if (status != 0)
        return status;
    generation->z = array_create(grid_points(grid), sizeof *generation->z);
    return generation->z != NULL
               ? 0
               : error_memory(err, grid_points(grid) * sizeof *generation->z, "a surface");
}

static void generation_clear(void *workspace) {
    struct generation *generation = workspace;
    surface_paths_destroy(&generation->paths);
    coarse_solver_destroy(&generation->halfspace);
    free(generation->z);
}

static int press(struct generation *generation, const double *z,
                 const struct contact_case *one_case, double *series,
                 const struct contact_stopper *stopper, struct error *err) {
    int status = contact_level_sample(&generation->plan->level, &one_case->surface,
                                      generation->rms_height, z, generation->z, err);
    return status != 0
               ? status
               : coarse_solver_press(generation->halfspace, generation->z, series, stopper, err);
}

/* Presses the own surface, or copies the values of the probe, which has pressed it on the same mesh
 * if it was due. */
static int press_own(struct generation *generation, const struct contact_surface *surface,
                     struct contact_tally *tally, double *series,
                     const struct contact_stopper *stopper, struct error *err) {
    const struct contact_case *one_case = tally->one_case;
    if (!subset_has(&one_case->companions[COMPANION_PROBE].due, surface->key.realisation))
        return press(generation, surface->z, one_case, series, stopper, err);
    memcpy(series, contact_tally_series(tally, COMPANION_PROBE, 0, 0),
           MEASURE_PAIRED * one_case->load_count * sizeof *series);
    return 0;
}

static int generation_solve(void *workspace, const struct contact_surface *surface,
                            struct contact_tally *tally, struct companion_tally *out,
                            const struct contact_stopper *stopper, struct error *err) {
    struct generation *generation = workspace;
    const struct contact_case *one_case = tally->one_case;
    if (surface->report == NULL)
        return 0;
    int status =
        press_own(generation, surface, tally, companion_series(one_case, out, OWN), stopper, err);
    for (enum surface_path path = 0; path < SURFACE_PATHS && status == 0; path++) {
        struct surface_report report;
        const double *z;
        status = surface_paths_make(generation->paths, path, surface->key, surface->report, &z,
                                    &report, err);
        if (status == 0 && path == PATH_LONGER && report.eps_h > 0 && surface->report->eps_h > 0)
            out->facts[HALVINGS] = log2(surface->report->eps_h / report.eps_h);
        if (status == 0)
            status =
                press(generation, z, one_case,
                      companion_series(one_case, out, ALTERNATIVE + (size_t)path), stopper, err);
    }
    return status;
}

/* --- the error --- */

/* Extrapolates the change by longer iterations to half of eps_h (surface_paths_drift). Only the
 * part beyond its standard error is multiplied, as a statistical error does not grow with the
 * iterations. */
static struct estimate drift_of(const struct contact_tally *tally, enum contact_measure measure,
                                size_t load) {
    struct estimate longer = contact_tally_several(
        contact_tally_pair(tally, COMPANION_GENERATION, PATH_LONGER, measure, load));
    double factor =
        surface_paths_drift(contact_tally_fact(tally, COMPANION_GENERATION, HALVINGS).value);
    double seen = fabs(longer.value), beyond = factor * fmax(0, seen - longer.standard_error);
    if (isnan(longer.value) || seen >= beyond)
        return (struct estimate){seen, longer.standard_error};
    return (struct estimate){beyond, factor * longer.standard_error};
}

/* Returns the bound at one load, relative to the own surfaces of the pairs. */
static struct estimate bound_of(const struct contact_tally *tally, enum contact_measure measure,
                                size_t load) {
    double own =
        fabs(contact_tally_companion(tally, COMPANION_GENERATION, OWN, measure, load).value);
    struct estimate other = contact_tally_several(
        contact_tally_pair(tally, COMPANION_GENERATION, PATH_OTHER, measure, load));
    struct estimate drift = drift_of(tally, measure, load);
    return (struct estimate){(fabs(other.value) + drift.value) / own,
                             hypot(other.standard_error, drift.standard_error) / own};
}

static bool generation_applies(const struct contact_case *one_case, size_t model) {
    (void)model;
    return surface_paths_apply(&one_case->surface);
}

/* The relative change of a half-space on a coarse mesh stands for that of other models and meshes.
 * As the sign of the error is not known, the bound is on both sides. */
static bool generation_errors(const struct contact_tally *tally, enum contact_measure measure,
                              size_t model, struct contact_error *out) {
    const struct contact_case *one_case = tally->one_case;
    size_t n = one_case->load_count, finest = one_case->level_count - 1;
    bool any = false;
    if (!contact_case_has(one_case, COMPANION_GENERATION))
        return false;
    for (size_t k = 0; k < n; k++) {
        struct estimate own = bound_of(tally, measure, k);
        out[k] = (struct contact_error){
            .value = own.value, .standard_error = own.standard_error, .order = NAN};
    }
    for (size_t k = 0; k < n; k++)
        for (size_t other = 0; other < n; other++)
            if (contact_error_near(one_case->loads, k, other))
                out[k].bound = fmax(out[k].bound, out[other].value);
    for (size_t k = 0; k < n; k++) {
        double y = fabs(contact_mean(tally, measure, model, finest, k).value);
        bool known = !isnan(out[k].value * y);
        out[k].value = known ? 0 : (double)NAN;
        out[k].bound = known ? out[k].bound * y : (double)NAN;
        out[k].standard_error *= y;
        any = any || known;
    }
    return any;
}

COMPANION_DEFINE(GENERATION, "surfaces by alternative generators", "/contact/generation_error",
                 ERROR_GENERATION, generation_plan, struct generation, generation_create,
                 generation_clear, generation_bytes, generation_seconds, generation_solve,
                 generation_applies, generation_errors, NULL)
