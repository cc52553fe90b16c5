/* Studies of surfaces like patches of known surfaces, run in one process. Include after check.h. */
#ifndef RUGO_TESTS_SUPPORT_LIKE_PATCH_H
#define RUGO_TESTS_SUPPORT_LIKE_PATCH_H

#include "jobs/like/like_fit.h"
#include "jobs/merger.h"
#include "jobs/runner.h"
#include "jobs/surface/realisation_map.h"
#include "jobs/surface/surface_case.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Parameters with these members of "surface", and with the rest behind it. */
static inline cJSON *like_parameters_of(const char *surface, const char *rest) {
    char text[2000];
    snprintf(text, sizeof text, "{\"surface\": {%s}%s}", surface, rest);
    cJSON *parameters = cJSON_Parse(text);
    assert_non_null(parameters);
    return parameters;
}

static inline void like_run(const char *kind, const cJSON *parameters, uint64_t seed, uint64_t n,
                            struct case_result *out) {
    struct job_runner *runner = NULL;
    struct job_merger *merger = NULL;
    struct block_result block = {0};
    struct error err = {0};
    *out = (struct case_result){0};
    if (runner_create(&runner, kind_find(kind), parameters, NULL, seed, 0, &err) != 0 ||
        runner_run(runner, 0, n, NULL, &block, &err) != 0 ||
        merger_create(&merger, kind_find(kind), parameters, &err) != 0 ||
        merger_add(merger, &block, &err) != 0 || merger_result(merger, out, &err) != 0)
        fail_msg("%s", err.text);
    block_result_clear(&block);
    merger_destroy(&merger);
    runner_destroy(&runner);
}

/* Cuts the patch of side by side points at the origin out of the realisation of a surface with
 * these members, whose cell has at least twice the sides. The caller clears the map. */
static inline struct height_map like_patch_of(const char *surface, size_t side,
                                              struct random_key key) {
    cJSON *truth = like_parameters_of(surface, "");
    struct surface_case one = {0};
    struct height_map map = {.xy_unit = "m", .z_unit = "m"};
    struct surface_report report;
    struct error err = {0};
    double *z = NULL;
    if (surface_case_read(&one, truth, NULL, &err) != 0 ||
        realisation_surface(&one, key, &z, &report, &err) != 0)
        fail_msg("%s", err.text);
    assert_int_equal(height_map_shape(&map, side, side, grid_dx(&one.grid), &err), 0);
    map.z = calloc(side * side, sizeof *map.z);
    assert_true(map.z != NULL && one.grid.nx >= 2 * side);
    for (size_t j = 0; j < side && z != NULL; j++)
        memcpy(map.z + j * side, z + j * one.grid.nx, side * sizeof *z);
    free(z);
    surface_case_clear(&one);
    cJSON_Delete(truth);
    return map;
}

#define LIKE_PATCH_DIGEST "00112233445566778899aabbccddeeff00112233445566778899aabbccddeeff"

#endif
