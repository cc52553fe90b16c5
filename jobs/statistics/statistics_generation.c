#include "jobs/statistics/statistics_generation.h"
#include "core/statistics/surface_pass.h"
#include "jobs/surface_paths.h"
#include <stdlib.h>

/* Of the first realisations more are measured again than of the later ones. */
enum { FIRST = 32, FIRST_INTERVAL = 8, INTERVAL = 64 };

struct statistics_generation {
    const struct statistics_case *one_case;
    struct moments moments;
    struct summit_finder *finder;
    struct surface_paths *paths; /* owned, as the lists */
    struct summit_list summits[SIDES];
};

bool statistics_generation_applies(const struct statistics_case *one_case) {
    return surface_paths_apply(&one_case->surface);
}

static bool is_due(uint64_t realisation) {
    return realisation % (realisation < FIRST ? FIRST_INTERVAL : INTERVAL) == 0;
}

int statistics_generation_create(struct statistics_generation **out,
                                 const struct statistics_case *one_case,
                                 const struct moments *moments, struct summit_finder *finder,
                                 struct error *err) {
    *out = NULL;
    if (!statistics_generation_applies(one_case))
        return 0;
    struct statistics_generation *generation = array_create(1, sizeof *generation);
    if (generation == NULL)
        return error_memory(err, sizeof *generation, "other surfaces");
    generation->one_case = one_case;
    generation->moments = *moments;
    generation->finder = finder;
    int status = surface_paths_create(&generation->paths, &one_case->surface, err);
    if (status != 0)
        statistics_generation_destroy(&generation);
    *out = generation;
    return status;
}

void statistics_generation_destroy(struct statistics_generation **generation) {
    struct statistics_generation *gone = *generation;
    if (gone == NULL)
        return;
    surface_paths_destroy(&gone->paths);
    for (size_t side = 0; side < SIDES; side++)
        summit_list_clear(&gone->summits[side]);
    free(gone);
    *generation = NULL;
}

/* Puts the scalars of the surface of this path from `first` on. */
static int measure(struct statistics_generation *generation, struct random_key key,
                   enum surface_path path, const struct surface_report *own, double *first,
                   struct error *err) {
    const struct grid *grid = &generation->one_case->surface.grid;
    struct surface_report report;
    struct roughness roughness;
    double scalars[SCALAR_COUNT];
    const struct surface_pass pass = {.finder = generation->finder,
                                      .summits = &generation->summits[SIDE_SUMMITS],
                                      .pits = &generation->summits[SIDE_PITS]};
    const double *z;
    int status = surface_paths_make(generation->paths, path, key, own, &z, &report, err);
    if (status == 0)
        status = surface_pass_run(&pass, grid, z, err);
    if (status != 0)
        return status;
    roughness_measure(grid, z, &roughness);
    statistics_scalars_measure(generation->one_case, &generation->moments,
                               &(struct realisation_measures){&roughness, &generation->moments,
                                                              generation->summits, &report},
                               scalars);
    for (size_t a = 0; a < GENERATION_COUNT; a++)
        first[a] = scalars[GENERATION_OWN[a]];
    return 0;
}

int statistics_generation_measure(struct statistics_generation *generation, struct random_key key,
                                  const struct surface_report *own, double scalars[SCALAR_COUNT],
                                  struct error *err) {
    if (generation == NULL || !is_due(key.realisation))
        return 0;
    int status = measure(generation, key, PATH_OTHER, own, scalars + SCALAR_OTHER, err);
    return status != 0 ? status
                       : measure(generation, key, PATH_LONGER, own, scalars + SCALAR_LONGER, err);
}

double statistics_generation_bytes(const struct statistics_case *one_case) {
    return statistics_generation_applies(one_case) ? surface_paths_bytes(&one_case->surface) : 0;
}

double statistics_generation_seconds(const struct statistics_case *one_case) {
    return statistics_generation_applies(one_case)
               ? surface_paths_seconds(&one_case->surface) / INTERVAL
               : 0;
}
