/* The error of surfaces like a measured patch by what the patch leaves open (FORMULAS.md, F18.47).
 * Beside the first realisations a surface of drawn parameters is made from the same random numbers,
 * and both are pressed on a half-space on a coarse mesh, by the same pressures. Lengths and loads
 * are in the units of the case for both: its slope and height are parameters that the patch leaves
 * open. The relative difference of these pairs stands for that of other models and meshes. */
#include "jobs/contact/companion/companion.h"
#include "jobs/contact/companion/companion_own.h"
#include "jobs/like/like_draw.h"
#include "jobs/like/like_hold.h"
#include <stdlib.h>

/* Series: the surface of the case, and that of the drawn parameters. */
enum { OWN, DRAWN, SERIES };

struct patch {
    const struct companion_plan *plan;
    struct like_draw *draw; /* owned, as all below */
    struct coarse_solver *halfspace;
    double rms_height; /* of the surfaces of the case */
    double *z;         /* heights on the coarse mesh */
};

/* --- the plan --- */

static bool patch_plan(const struct contact_case *one_case, struct companion_plan *out) {
    if (!like_draw_applies(&one_case->like))
        return false;
    out->level = coarse_level(one_case);
    out->series = SERIES;
    out->pairs[out->pair_count++] = (struct companion_pair){.of = DRAWN, .less = OWN};
    out->due = like_draw_due();
    return true;
}

static double patch_bytes(const struct contact_case *one_case, const struct companion_plan *plan) {
    const struct grid *grid = &plan->level.grid;
    return like_draw_bytes(&one_case->like, &one_case->surface) + 8 * (double)grid_points(grid) +
           coarse_solver_bytes(one_case, grid);
}

static double patch_seconds(const struct contact_case *one_case,
                            const struct companion_plan *plan) {
    return like_draw_seconds(&one_case->like, &one_case->surface) +
           SERIES * coarse_solver_seconds(one_case, &plan->level.grid);
}

/* --- the surfaces --- */

static int patch_create(void *workspace, const struct contact_case *one_case,
                        const struct companion_plan *plan, const struct moments *moments,
                        struct error *err) {
    struct patch *patch = workspace;
    const struct grid *grid = &plan->level.grid;
    patch->plan = plan;
    patch->rms_height = moments->rms_height;
    int status = like_draw_create(&patch->draw, &one_case->like, &one_case->surface, err);
    if (status == 0)
        status = coarse_solver_create(&patch->halfspace, one_case, grid, INFINITY, moments, err);
    if (status != 0)
        return status;
    patch->z = array_create(grid_points(grid), sizeof *patch->z);
    return patch->z != NULL ? 0
                            : error_memory(err, grid_points(grid) * sizeof *patch->z, "a surface");
}

static void patch_clear(void *workspace) {
    struct patch *patch = workspace;
    like_draw_destroy(&patch->draw);
    coarse_solver_destroy(&patch->halfspace);
    free(patch->z);
}

/* A drawn surface may have shorter waves than the case: without values where the coarse mesh does
 * not hold them. */
static int press_drawn(struct patch *patch, const struct contact_surface *surface, double *series,
                       const struct contact_stopper *stopper, struct error *err) {
    const struct contact_level *level = &patch->plan->level;
    struct error reason = {0};
    struct like_drawn drawn;
    like_draw_set_stop(patch->draw, stopper->stop, stopper->context);
    int status = like_draw_make(patch->draw, surface->key, false, &drawn, &reason);
    if (status == ERROR_INPUT || status == ERROR_NUMERIC)
        return 0;
    if (status != 0)
        return error_set(err, status, "%s", reason.text);
    if (level->stride == 0 &&
        !surface_band_fits(surface_case_sampled_band(drawn.surface), &level->grid))
        return 0;
    const struct level_source source = {drawn.moments.rms_height, surface->key};
    status = contact_level_sample(level, drawn.surface, &source, drawn.z, patch->z, err);
    return status != 0 ? status
                       : coarse_solver_press(patch->halfspace, patch->z, series, stopper, err);
}

static int patch_solve(void *workspace, const struct contact_surface *surface,
                       struct contact_tally *tally, struct companion_tally *out,
                       const struct contact_stopper *stopper, struct error *err) {
    struct patch *patch = workspace;
    const struct companion_own own = {patch->halfspace, &patch->plan->level, patch->rms_height,
                                      patch->z};
    int status = companion_press_own(&own, surface, tally,
                                     companion_series(tally->one_case, out, OWN), stopper, err);
    return status != 0 ? status
                       : press_drawn(patch, surface, companion_series(tally->one_case, out, DRAWN),
                                     stopper, err);
}

/* --- the error --- */

static bool patch_applies(const struct contact_case *one_case, size_t model) {
    (void)model;
    return like_draw_applies(&one_case->like) || one_case->like.hold;
}

/* Of surfaces that hold the patch realisations are the draws. */
static bool held_errors(const struct contact_tally *tally, enum contact_measure measure,
                        size_t model, struct contact_error *out) {
    const struct contact_case *one_case = tally->one_case;
    const size_t finest = one_case->level_count - 1;
    bool any = false;
    for (size_t k = 0; k < contact_case_values(one_case, measure_row(measure)->by); k++) {
        const struct estimate mean = contact_mean(tally, measure, model, finest, k);
        const size_t cell = contact_case_cell(one_case, model, finest, k);
        const size_t n =
            (size_t)(tally->realisations - contact_tally_valueless(tally, measure, cell));
        const struct like_error error = like_hold_error(mean.standard_error * sqrt((double)n), n);
        out[k] = (struct contact_error){.value = error.value,
                                        .bound = error.bound,
                                        .standard_error = error.standard_error,
                                        .order = NAN};
        any = any || isfinite(out[k].value);
    }
    return any;
}

static bool patch_errors(const struct contact_tally *tally, enum contact_measure measure,
                         size_t model, struct contact_error *out) {
    const struct contact_case *one_case = tally->one_case;
    const size_t finest = one_case->level_count - 1;
    bool any = false;
    if (one_case->like.hold)
        return held_errors(tally, measure, model, out);
    if (!contact_case_has(one_case, COMPANION_PATCH))
        return false;
    for (size_t k = 0; k < contact_case_values(one_case, measure_row(measure)->by); k++) {
        const struct estimate pair = contact_tally_pair(tally, COMPANION_PATCH, 0, measure, k);
        const uint64_t n = contact_tally_pairs(tally, COMPANION_PATCH, 0, measure, k);
        const double factor =
            contact_mean(tally, measure, model, finest, k).value /
            contact_tally_companion(tally, COMPANION_PATCH, OWN, measure, k).value;
        const struct like_error error =
            like_draw_error(pair.value, pair.standard_error * sqrt((double)n), (size_t)n);
        out[k] = (struct contact_error){.value = factor * error.value,
                                        .bound = fabs(factor) * error.bound,
                                        .standard_error = fabs(factor) * error.standard_error,
                                        .order = NAN};
        any = any || isfinite(out[k].value);
    }
    return any;
}

COMPANION_DEFINE(PATCH, "surfaces of drawn parameters", NULL, ERROR_PATCH, patch_plan, struct patch,
                 patch_create, patch_clear, patch_bytes, patch_seconds, patch_solve, patch_applies,
                 patch_errors, NULL)
