#include "jobs/statistics/statistics_levels.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

struct statistics_case statistics_level_case(const struct statistics_case *one_case, size_t level) {
    struct statistics_case out = *one_case;
    struct grid *grid = &out.surface.grid;
    grid->nx /= one_case->strides[level];
    grid->ny = grid_is_profile(grid) ? 1 : grid->ny / one_case->strides[level];
    out.level_count = 0;
    return out;
}

/* --- the tallies --- */

int statistics_levels_create(struct statistics_levels *out, const struct statistics_case *one_case,
                             const struct moments *moments, const struct spectra_sizes *sizes,
                             struct error *err) {
    static const struct spectra_sizes NONE = {0, 0, 0, 0};
    *out = (struct statistics_levels){0};
    int status = statistics_tally_create(&out->own, one_case, moments, sizes, err);
    for (size_t l = 0; l < one_case->level_count && status == 0; l++) {
        out->cases[l] = statistics_level_case(one_case, l);
        status = statistics_tally_create(&out->tallies[l], &out->cases[l], moments, &NONE, err);
        out->count += status == 0;
    }
    for (size_t l = 0; one_case->level_count > 0 && l <= one_case->level_count && status == 0; l++)
        status = statistics_groups_create(&out->moments[l], SIDES, LEVEL_SUMS, err);
    if (status != 0)
        statistics_levels_clear(out);
    return status;
}

void statistics_levels_clear(struct statistics_levels *levels) {
    statistics_tally_clear(&levels->own);
    for (size_t l = 0; l < levels->count; l++)
        statistics_tally_clear(&levels->tallies[l]);
    for (size_t l = 0; l <= STATISTICS_LEVELS_MOST; l++)
        statistics_groups_clear(&levels->moments[l]);
    *levels = (struct statistics_levels){0};
}

void statistics_levels_put(struct bytes *bytes, const struct statistics_levels *levels) {
    statistics_tally_put(bytes, &levels->own);
    for (size_t l = 0; l < levels->count; l++)
        statistics_tally_put(bytes, &levels->tallies[l]);
    for (size_t l = 0; levels->count > 0 && l <= levels->count; l++)
        statistics_groups_put(bytes, &levels->moments[l]);
}

void statistics_levels_get(struct byte_reader *reader, struct statistics_levels *levels) {
    statistics_tally_get(reader, &levels->own);
    for (size_t l = 0; l < levels->count && !reader->failed; l++)
        statistics_tally_get(reader, &levels->tallies[l]);
    for (size_t l = 0; levels->count > 0 && l <= levels->count && !reader->failed; l++)
        statistics_groups_get(reader, &levels->moments[l]);
}

/* Whether groups count the summits of a tally. */
static bool moments_fit(const struct statistics_groups *moments,
                        const struct statistics_tally *tally) {
    bool fit = statistics_groups_realisations_fit(moments, tally->points.realisations);
    for (size_t side = 0; side < tally->sides && fit; side++) {
        fixed_point all = 0;
        for (size_t g = 0; g < GROUPS; g++)
            all += moments->count[g * moments->counts + side];
        fit = all == tally->summits[side].total.sum;
    }
    return fit;
}

bool statistics_levels_add_up(const struct statistics_levels *levels) {
    bool fit = statistics_tally_adds_up(&levels->own);
    for (size_t l = 0; l < levels->count && fit; l++)
        fit = statistics_tally_adds_up(&levels->tallies[l]) &&
              levels->tallies[l].points.realisations == levels->own.points.realisations &&
              moments_fit(&levels->moments[l + 1], &levels->tallies[l]);
    return fit && (levels->count == 0 || moments_fit(&levels->moments[0], &levels->own));
}

void statistics_levels_merge(struct statistics_levels *into, const struct statistics_levels *from) {
    statistics_tally_merge(&into->own, &from->own);
    for (size_t l = 0; l < into->count; l++)
        statistics_tally_merge(&into->tallies[l], &from->tallies[l]);
    for (size_t l = 0; into->count > 0 && l <= into->count; l++)
        statistics_groups_merge(&into->moments[l], &from->moments[l]);
}

double statistics_levels_bytes(const struct statistics_case *one_case) {
    double bytes = 0;
    for (size_t l = 0; l < one_case->level_count; l++) {
        const struct statistics_case coarse = statistics_level_case(one_case, l);
        const struct grid *grid = &coarse.surface.grid;
        bytes +=
            2 * statistics_groups_bytes(SIDES, LEVEL_SUMS) + statistics_tally_bytes(&coarse) +
            (double)grid_points(grid) * sizeof(double) +
            summit_finder_bytes(grid, coarse.stencil, coarse.curvature, grid->nx / 2, grid->ny / 2);
    }
    return bytes;
}

/* --- measuring --- */

struct level_workspace {
    struct statistics_case one_case; /* borrows */
    size_t stride;
    struct summit_finder *finder; /* owned, as all below */
    struct summit_list summits[SIDES];
    double *z;
};
struct levels_workspace {
    struct grid grid; /* of the surfaces */
    size_t count;
    struct level_workspace levels[STATISTICS_LEVELS_MOST];
};

static int level_create(struct level_workspace *level, const struct statistics_case *one_case,
                        size_t l, size_t mode_x, size_t mode_y, struct error *err) {
    level->one_case = statistics_level_case(one_case, l);
    level->stride = one_case->strides[l];
    const struct grid *grid = &level->one_case.surface.grid;
    size_t most_x = grid->nx / 2, most_y = grid->ny / 2;
    level->z = array_create(grid_points(grid), sizeof *level->z);
    if (level->z == NULL)
        return error_memory(err, grid_points(grid) * sizeof *level->z, "a coarser surface");
    return summit_finder_create(&level->finder, grid, one_case->stencil, one_case->curvature,
                                mode_x < most_x ? mode_x : most_x,
                                mode_y < most_y ? mode_y : most_y, err);
}

int levels_workspace_create(struct levels_workspace **out, const struct statistics_case *one_case,
                            size_t mode_x, size_t mode_y, struct error *err) {
    *out = NULL;
    if (one_case->level_count == 0)
        return 0;
    struct levels_workspace *workspace = array_create(1, sizeof *workspace);
    if (workspace == NULL)
        return error_memory(err, sizeof *workspace, "mesh levels");
    workspace->grid = one_case->surface.grid;
    workspace->count = one_case->level_count;
    int status = 0;
    for (size_t l = 0; l < workspace->count && status == 0; l++)
        status = level_create(&workspace->levels[l], one_case, l, mode_x, mode_y, err);
    if (status != 0)
        levels_workspace_destroy(&workspace);
    *out = workspace;
    return status;
}

void levels_workspace_destroy(struct levels_workspace **workspace) {
    struct levels_workspace *gone = *workspace;
    if (gone == NULL)
        return;
    for (size_t l = 0; l < gone->count; l++) {
        struct level_workspace *level = &gone->levels[l];
        summit_finder_destroy(&level->finder);
        for (size_t side = 0; side < SIDES; side++)
            summit_list_clear(&level->summits[side]);
        free(level->z);
    }
    free(gone);
    *workspace = NULL;
}

static void sample(const struct grid *from, const double *z, size_t stride, const struct grid *to,
                   double *out) {
    for (size_t j = 0; j < to->ny; j++)
        for (size_t i = 0; i < to->nx; i++)
            out[j * to->nx + i] = z[j * stride * from->nx + i * stride];
}

static void add_moments(struct statistics_groups *moments, const struct statistics_tally *tally,
                        uint64_t realisation, const struct summit_list summits[], double lowest,
                        double highest) {
    double third = tally->one_case->surface.dimension == 2 ? sqrt(3) : 1, sums[LEVEL_SUMS] = {0};
    uint64_t counts[SIDES] = {0};
    size_t group = group_of(realisation);
    for (size_t side = 0; side < tally->sides; side++) {
        double *of = sums + side * SUMS_OF_SIDE;
        counts[side] = summits[side].count;
        for (size_t a = 0; a < summits[side].count; a++) {
            double height = summits[side].summits[a].height * tally->scales.height;
            of[SUM_HEIGHT] += height;
            of[SUM_SQUARE] += height * height;
            of[SUM_CUBE] += height * height * height;
            of[SUM_FOURTH] += height * height * height * height;
            of[SUM_CURVATURE] -=
                summits[side].summits[a].curvature * tally->scales.curvature / third;
        }
    }
    sums[SUM_LOWEST] = lowest * tally->scales.height;
    sums[SUM_HIGHEST] = highest * tally->scales.height;
    moments->realisations[group]++;
    statistics_groups_count(moments, group, 0, SIDES, counts);
    statistics_groups_sum(moments, group, 0, LEVEL_SUMS, sums);
}

/* Measures the surface on one level, as the own grid is. */
static int level_add(struct level_workspace *level, const struct grid *from, uint64_t realisation,
                     const double *z, struct statistics_tally *tally,
                     struct statistics_groups *moments, struct error *err) {
    const struct grid *grid = &level->one_case.surface.grid;
    struct height_sums sums;
    const struct surface_pass pass = {.finder = level->finder,
                                      .bins = &level->one_case.height,
                                      .scale = tally->scales.height,
                                      .counts = tally->counts.height,
                                      .sums = &sums,
                                      .summits = &level->summits[SIDE_SUMMITS],
                                      .pits = &level->summits[SIDE_PITS]};
    sample(from, z, level->stride, grid, level->z);
    int status = surface_pass_run(&pass, grid, level->z, err);
    if (status == 0 && statistics_case_symmetric(&level->one_case))
        status = summit_list_append(&level->summits[SIDE_SUMMITS], &level->summits[SIDE_PITS], err);
    if (status != 0)
        return status;
    statistics_tally_add(tally, realisation, grid_points(grid), level->summits);
    add_moments(moments, tally, realisation, level->summits, sums.lowest, sums.highest);
    return 0;
}

int levels_workspace_add(struct levels_workspace *workspace, uint64_t realisation, const double *z,
                         const struct summit_list own[], struct statistics_levels *levels,
                         struct error *err) {
    int status = 0;
    if (workspace == NULL)
        return 0;
    double lowest = z[0], highest = z[0];
    for (size_t i = 1; i < grid_points(&workspace->grid); i++) {
        lowest = z[i] < lowest ? z[i] : lowest;
        highest = z[i] > highest ? z[i] : highest;
    }
    add_moments(&levels->moments[0], &levels->own, realisation, own, lowest, highest);
    for (size_t l = 0; l < workspace->count && status == 0; l++)
        status = level_add(&workspace->levels[l], &workspace->grid, realisation, z,
                           &levels->tallies[l], &levels->moments[l + 1], err);
    return status;
}
