#include "jobs/contact/contact_generation.h"
#include "jobs/contact/contact_probe.h"
#include "jobs/contact/contact_sample.h"
#include <math.h>
#include <stdlib.h>

/* Of the time that the case takes without: what goes into these surfaces. */
static const double TIME_SHARE = 0.08;

struct contact_generation {
    const struct contact_case *one_case;
    struct surface_paths *paths; /* owned, as all below */
    struct contact_coarse *halfspace;
    double *z; /* heights on the coarse mesh */
};

/* --- the choice --- */

/* Of the own surface and of the others, all found and pressed. */
static double surface_seconds(const struct contact_case *one_case) {
    return surface_paths_seconds(&one_case->surface) +
           (1 + SURFACE_PATHS) * contact_coarse_seconds(one_case, &one_case->paths.level.grid);
}

void contact_generation_choose(struct contact_case *one_case) {
    if (!surface_paths_apply(&one_case->surface))
        return;
    one_case->paths.level = contact_probe_level(one_case);
    one_case->paths.interval = contact_probe_interval(
        surface_seconds(one_case), TIME_SHARE * contact_case_least_seconds(one_case), 1);
}

/* --- the surfaces --- */

static int generation_fill(struct contact_generation *generation, const struct moments *moments,
                           struct error *err) {
    const struct contact_case *one_case = generation->one_case;
    const struct grid *grid = &one_case->paths.level.grid;
    int status = surface_paths_create(&generation->paths, &one_case->surface, err);
    if (status == 0)
        status =
            contact_coarse_create(&generation->halfspace, one_case, grid, INFINITY, moments, err);
    if (status != 0)
        return status;
    generation->z = array_create(grid_points(grid), sizeof *generation->z);
    return generation->z != NULL
               ? 0
               : error_memory(err, grid_points(grid) * sizeof *generation->z, "a surface");
}

int contact_generation_create(struct contact_generation **out, const struct contact_case *one_case,
                              const struct moments *moments, struct error *err) {
    *out = NULL;
    if (!contact_case_has_paths(one_case))
        return 0;
    struct contact_generation *generation = array_create(1, sizeof *generation);
    if (generation == NULL)
        return error_memory(err, sizeof *generation, "surfaces found in other ways");
    generation->one_case = one_case;
    int status = generation_fill(generation, moments, err);
    if (status != 0)
        contact_generation_destroy(&generation);
    *out = generation;
    return status;
}

void contact_generation_destroy(struct contact_generation **generation) {
    struct contact_generation *gone = *generation;
    if (gone == NULL)
        return;
    surface_paths_destroy(&gone->paths);
    contact_coarse_destroy(&gone->halfspace);
    free(gone->z);
    free(gone);
    *generation = NULL;
}

static int press(struct contact_generation *generation, const double *z, size_t series,
                 struct contact_tally *tally, const struct contact_stopper *stopper,
                 struct error *err) {
    const struct contact_case *one_case = generation->one_case;
    int status = contact_level_sample(one_case, &one_case->paths.level, z, generation->z, err);
    return status != 0 ? status
                       : contact_coarse_solve(generation->halfspace, generation->z,
                                              contact_case_path_cell(one_case, series, 0), tally,
                                              stopper, err);
}

/* The probe has pressed the own surface in the same way already, where it did. */
static int press_own(struct contact_generation *generation, const struct contact_surface *surface,
                     struct contact_tally *tally, const struct contact_stopper *stopper,
                     struct error *err) {
    const struct contact_case *one_case = generation->one_case;
    if (!contact_probe_due(one_case, surface->key.realisation))
        return press(generation, surface->z, PATHS_OWN, tally, stopper, err);
    contact_coarse_copy(one_case, contact_case_probe_cell(one_case, 0, 0),
                        contact_case_path_cell(one_case, PATHS_OWN, 0), tally);
    return 0;
}

static int press_path(struct contact_generation *generation, const struct contact_surface *surface,
                      enum surface_path path, struct contact_tally *tally,
                      const struct contact_stopper *stopper, struct error *err) {
    struct surface_report report;
    const double *z;
    int status = surface_paths_make(generation->paths, path, surface->key, surface->report, &z,
                                    &report, err);
    if (status != 0)
        return status;
    if (path == PATH_LONGER && report.eps_h > 0 && surface->report->eps_h > 0)
        tally->halvings = log2(surface->report->eps_h / report.eps_h);
    return press(generation, z, PATHS_FOUND + (size_t)path, tally, stopper, err);
}

int contact_generation_solve(struct contact_generation *generation,
                             const struct contact_surface *surface, struct contact_tally *tally,
                             const struct contact_stopper *stopper, struct error *err) {
    if (surface->report == NULL ||
        !contact_probe_turn(generation->one_case->paths.interval, surface->key.realisation))
        return 0;
    struct error reason = {0};
    int status = press_own(generation, surface, tally, stopper, &reason);
    for (enum surface_path path = 0; path < SURFACE_PATHS && status == 0; path++)
        status = press_path(generation, surface, path, tally, stopper, &reason);
    /* no surface: its cells stay empty */
    return status == 0 || status == ERROR_NUMERIC ? 0 : error_set(err, status, "%s", reason.text);
}

double contact_generation_bytes(const struct contact_case *one_case) {
    const struct grid *grid = &one_case->paths.level.grid;
    return contact_case_has_paths(one_case)
               ? surface_paths_bytes(&one_case->surface) + 8 * (double)grid_points(grid) +
                     contact_coarse_bytes(grid)
               : 0;
}

double contact_generation_seconds(const struct contact_case *one_case) {
    return contact_case_has_paths(one_case)
               ? surface_seconds(one_case) / (double)one_case->paths.interval
               : 0;
}
