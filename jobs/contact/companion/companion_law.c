/* The law difference of heights that are not Gaussian. Beside some realisations the surface is also
 * made under the other law, from the same random numbers, and both are pressed on a half-space on a
 * coarse mesh, each in units of its own slope and height. The relative difference of these pairs
 * stands for that of other models and meshes.
 *
 * The interval is such that they take less than a tenth of the case's time or a millisecond a
 * realisation, but for the first ones of a small study. */
#include "jobs/contact/companion/companion_law.h"
#include "jobs/contact/companion/companion.h"
#include "jobs/contact/companion/companion_own.h"
#include "jobs/surface/other_law.h"
#include <stdlib.h>

/* Time for these surfaces, over that of the case without, and CPU seconds a realisation that they
 * may take in any case. */
static const double TIME_SHARE = 0.08, TIME_FLOOR = 1e-3;
/* Series: the surface of the case, and that of the other law. */
enum { OWN, OTHER, SERIES };

struct law {
    const struct companion_plan *plan;
    struct other_law *law; /* owned, as all below */
    struct coarse_solver *own, *other;
    double rms_height; /* of the surfaces of the case */
    double *z;         /* heights on the coarse mesh */
};

/* --- the plan --- */

static double law_bytes(const struct contact_case *one_case, const struct companion_plan *plan) {
    const struct grid *grid = &plan->level.grid;
    return other_law_bytes(&one_case->surface) + 8 * (double)grid_points(grid) +
           SERIES * coarse_solver_bytes(one_case, grid);
}

/* Returns the CPU seconds of both surfaces, one generated and both pressed. */
static double law_seconds(const struct contact_case *one_case, const struct companion_plan *plan) {
    return other_law_seconds(&one_case->surface) +
           SERIES * coarse_solver_seconds(one_case, &plan->level.grid);
}

static bool law_plan(const struct contact_case *one_case, struct companion_plan *out) {
    if (!other_law_applies(&one_case->surface))
        return false;
    out->level = coarse_level(one_case);
    out->series = SERIES;
    out->pairs[out->pair_count++] = (struct companion_pair){.of = OTHER, .less = OWN};
    double allowed = fmax(TIME_SHARE * contact_case_least_seconds(one_case), TIME_FLOOR);
    double planned = other_law_seconds(&one_case->surface) +
                     SERIES * coarse_solver_planned_seconds(one_case, &out->level.grid);
    out->due = subset_each(subset_interval(planned, allowed, 1));
    return true;
}

/* --- the surfaces --- */

static int law_create(void *workspace, const struct contact_case *one_case,
                      const struct companion_plan *plan, const struct moments *moments,
                      struct error *err) {
    struct law *law = workspace;
    const struct grid *grid = &plan->level.grid;
    law->plan = plan;
    law->rms_height = moments->rms_height;
    int status = other_law_create(&law->law, &one_case->surface, err);
    if (status != 0 || other_law_surface(law->law) == NULL)
        return status;
    status = coarse_solver_create(&law->own, one_case, grid, INFINITY, moments, err);
    if (status == 0)
        status = coarse_solver_create(&law->other, one_case, grid, INFINITY,
                                      other_law_moments(law->law), err);
    if (status != 0)
        return status;
    law->z = array_create(grid_points(grid), sizeof *law->z);
    return law->z != NULL ? 0 : error_memory(err, grid_points(grid) * sizeof *law->z, "a surface");
}

static void law_clear(void *workspace) {
    struct law *law = workspace;
    other_law_destroy(&law->law);
    coarse_solver_destroy(&law->own);
    coarse_solver_destroy(&law->other);
    free(law->z);
}

static int press_other(struct law *law, const struct contact_surface *surface, double *series,
                       const struct contact_stopper *stopper, struct error *err) {
    struct surface_report report;
    const double *z;
    other_law_set_stop(law->law, stopper->stop, stopper->context);
    int status = other_law_make(law->law, surface->key, &z, &report, err);
    if (status == 0)
        status = contact_level_sample(
            &law->plan->level, other_law_surface(law->law),
            &(struct level_source){other_law_moments(law->law)->rms_height, surface->key}, z,
            law->z, err);
    return status != 0 ? status : coarse_solver_press(law->other, law->z, series, stopper, err);
}

static int law_solve(void *workspace, const struct contact_surface *surface,
                     struct contact_tally *tally, struct companion_tally *out,
                     const struct contact_stopper *stopper, struct error *err) {
    struct law *law = workspace;
    const struct contact_case *one_case = tally->one_case;
    if (other_law_surface(law->law) == NULL)
        return 0;
    const struct companion_own own = {law->own, &law->plan->level, law->rms_height, law->z};
    int status = companion_press_own(&own, surface, tally, companion_series(one_case, out, OWN),
                                     stopper, err);
    return status != 0
               ? status
               : press_other(law, surface, companion_series(one_case, out, OTHER), stopper, err);
}

/* --- the difference --- */

bool companion_law_difference(const struct contact_tally *tally, enum contact_measure measure,
                              size_t model, struct estimate *out) {
    const struct contact_case *one_case = tally->one_case;
    size_t finest = one_case->level_count - 1;
    bool any = false;
    if (measure >= MEASURE_PAIRED || !contact_case_has(one_case, COMPANION_LAW))
        return false;
    for (size_t k = 0; k < contact_case_values(one_case, measure_row(measure)->by); k++) {
        const uint64_t pairs = contact_tally_pairs(tally, COMPANION_LAW, 0, measure, k);
        struct estimate pair =
            estimate_of_few(contact_tally_pair(tally, COMPANION_LAW, 0, measure, k), pairs);
        double factor = contact_mean(tally, measure, model, finest, k).value /
                        contact_tally_companion(tally, COMPANION_LAW, OWN, measure, k).value;
        out[k] = (struct estimate){factor * pair.value, fabs(factor) * pair.standard_error};
        any = any || isfinite(out[k].value);
    }
    return any;
}

COMPANION_DEFINE(LAW, "surfaces of the other law", "/contact/law_difference", ERROR_SOURCES,
                 law_plan, struct law, law_create, law_clear, law_bytes, law_seconds, law_solve,
                 NULL, NULL, NULL)
