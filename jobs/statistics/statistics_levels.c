#include "jobs/statistics/statistics_levels.h"
#include "core/statistics/uncertainty/richardson.h"
#include "jobs/estimate.h"
#include "jobs/statistics/statistics_draws.h"
#include "jobs/statistics/statistics_scalars.h"
#include "jobs/statistics/summit_heights.h"
#include "jobs/surface/other_law.h"
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

static bool levels_have_pairs(const struct statistics_levels *levels) {
    return levels->pairs[PAIR_OWN].counts > 0;
}

static bool levels_have_draws(const struct statistics_levels *levels) {
    return levels->draws[PAIR_OWN].counts > 0;
}

static int pairs_create(struct statistics_levels *out, const struct statistics_case *one_case,
                        struct error *err) {
    struct group_offsets offset = statistics_group_offsets(one_case);
    int status = 0;
    for (size_t a = 0; a < PAIR_SURFACES && status == 0; a++)
        status = statistics_groups_create(&out->pairs[a], offset.counts, offset.sums, err);
    return status;
}

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
    if (status == 0 && other_law_applies(&one_case->surface))
        status = pairs_create(out, one_case, err);
    if (status == 0)
        status = statistics_draws_sums(out->draws, one_case, err);
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
    for (size_t a = 0; a < PAIR_SURFACES; a++) {
        statistics_groups_clear(&levels->pairs[a]);
        statistics_groups_clear(&levels->draws[a]);
    }
    *levels = (struct statistics_levels){0};
}

void statistics_levels_put(struct bytes *bytes, const struct statistics_levels *levels) {
    statistics_tally_put(bytes, &levels->own);
    for (size_t l = 0; l < levels->count; l++)
        statistics_tally_put(bytes, &levels->tallies[l]);
    for (size_t l = 0; levels->count > 0 && l <= levels->count; l++)
        statistics_groups_put(bytes, &levels->moments[l]);
    for (size_t a = 0; levels_have_pairs(levels) && a < PAIR_SURFACES; a++)
        statistics_groups_put(bytes, &levels->pairs[a]);
    for (size_t a = 0; levels_have_draws(levels) && a < PAIR_SURFACES; a++)
        statistics_groups_put(bytes, &levels->draws[a]);
}

void statistics_levels_get(struct byte_reader *reader, struct statistics_levels *levels) {
    statistics_tally_get(reader, &levels->own);
    for (size_t l = 0; l < levels->count && !reader->failed; l++)
        statistics_tally_get(reader, &levels->tallies[l]);
    for (size_t l = 0; levels->count > 0 && l <= levels->count && !reader->failed; l++)
        statistics_groups_get(reader, &levels->moments[l]);
    for (size_t a = 0; levels_have_pairs(levels) && a < PAIR_SURFACES; a++)
        statistics_groups_get(reader, &levels->pairs[a]);
    for (size_t a = 0; levels_have_draws(levels) && a < PAIR_SURFACES && !reader->failed; a++)
        statistics_groups_get(reader, &levels->draws[a]);
}

/* Returns whether groups count the summits of a tally. */
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
    bool fit = statistics_tally_adds_up(&levels->own) &&
               statistics_law_fits(levels->pairs, &levels->own) &&
               statistics_draws_fit(levels->draws, (uint64_t)levels->own.points.realisations);
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
    for (size_t a = 0; levels_have_pairs(into) && a < PAIR_SURFACES; a++)
        statistics_groups_merge(&into->pairs[a], &from->pairs[a]);
    for (size_t a = 0; levels_have_draws(into) && a < PAIR_SURFACES; a++)
        statistics_groups_merge(&into->draws[a], &from->draws[a]);
}

double statistics_levels_bytes(const struct statistics_case *one_case) {
    struct group_offsets offset = statistics_group_offsets(one_case);
    double bytes = other_law_applies(&one_case->surface)
                       ? PAIR_SURFACES * statistics_groups_bytes(offset.counts, offset.sums)
                       : 0;
    bool wanted = statistics_case_wants_gaussian(one_case);
    for (size_t l = 0; l < one_case->level_count; l++) {
        const struct statistics_case coarse = statistics_level_case(one_case, l);
        const struct grid *grid = &coarse.surface.grid;
        bytes += 2 * statistics_groups_bytes(SIDES, LEVEL_SUMS) + statistics_tally_bytes(&coarse) +
                 (wanted ? 2 : 1) * (double)grid_points(grid) * sizeof(double) +
                 summit_finder_bytes(grid, coarse.stencil, coarse.curvature, grid->nx / 2,
                                     grid->ny / 2, wanted);
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
    double *gaussian; /* where summits are found by it; else NULL */
};
struct levels_workspace {
    struct grid grid; /* of the surfaces */
    size_t count;
    struct level_workspace levels[STATISTICS_LEVELS_MOST];
};

static int level_create(struct level_workspace *level, const struct statistics_case *one_case,
                        size_t l, struct surface_band band, double height, struct error *err) {
    level->one_case = statistics_level_case(one_case, l);
    level->stride = one_case->strides[l];
    const struct grid *grid = &level->one_case.surface.grid;
    size_t points = grid_points(grid), most_x = grid->nx / 2, most_y = grid->ny / 2;
    bool wanted = statistics_case_wants_gaussian(one_case);
    level->z = array_create(points, sizeof *level->z);
    if (wanted)
        level->gaussian = array_create(points, sizeof *level->gaussian);
    if (level->z == NULL || (wanted && level->gaussian == NULL))
        return error_memory(err, points * sizeof *level->z, "a coarser surface");
    int status = summit_finder_create(&level->finder, grid, one_case->stencil, one_case->curvature,
                                      band.x < most_x ? band.x : most_x,
                                      band.y < most_y ? band.y : most_y, err);
    if (status == 0)
        status = statistics_case_translate(one_case, level->finder, height, err);
    if (status == 0)
        summit_finder_gaussian(level->finder, level->gaussian);
    return status;
}

int levels_workspace_create(struct levels_workspace **out, const struct statistics_case *one_case,
                            struct surface_band band, double height, struct error *err) {
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
        status = level_create(&workspace->levels[l], one_case, l, band, height, err);
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
        free(level->gaussian);
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

/* Measures the surface on one level as it is measured on its own grid. */
static int level_add(struct level_workspace *level, const struct grid *from,
                     const struct realisation *realisation, struct statistics_tally *tally,
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
    sample(from, realisation->z, level->stride, grid, level->z);
    if (level->gaussian != NULL)
        sample(from, realisation->gaussian, level->stride, grid, level->gaussian);
    int status = surface_pass_run(&pass, grid, level->z, err);
    if (status == 0 && statistics_case_symmetric(&level->one_case))
        status = summit_list_append(&level->summits[SIDE_SUMMITS], &level->summits[SIDE_PITS], err);
    if (status != 0)
        return status;
    uint64_t number = realisation->key.realisation;
    statistics_tally_add(tally, number, grid_points(grid), level->summits);
    add_moments(moments, tally, number, level->summits, sums.lowest, sums.highest);
    return 0;
}

int levels_workspace_add(struct levels_workspace *workspace, const struct realisation *realisation,
                         const struct summit_list own[], struct statistics_levels *levels,
                         struct error *err) {
    int status = 0;
    if (workspace == NULL)
        return 0;
    const double *z = realisation->z;
    double lowest = z[0], highest = z[0];
    for (size_t i = 1; i < grid_points(&workspace->grid); i++) {
        lowest = z[i] < lowest ? z[i] : lowest;
        highest = z[i] > highest ? z[i] : highest;
    }
    add_moments(&levels->moments[0], &levels->own, realisation->key.realisation, own, lowest,
                highest);
    for (size_t l = 0; l < workspace->count && status == 0; l++)
        status = level_add(&workspace->levels[l], &workspace->grid, realisation,
                           &levels->tallies[l], &levels->moments[l + 1], err);
    return status;
}

/* The discretisation error of curves and scalars, from changes between levels. */

/* The order of the error in the spacing, for counts and measures of summits of a grid (F8.3), and
 * for extremes of points. */
static const double ORDER = 2;

/* Returns the spacing of a level over that of the next finer one. */
static double spacing_ratio(const struct statistics_levels *levels, size_t level) {
    const struct statistics_case *one_case = levels->own.one_case;
    double finer = level > 0 ? (double)one_case->strides[level - 1] : 1;
    return (double)one_case->strides[level] / finer;
}

static struct pair_estimate difference(const struct point_groups *fine,
                                       const struct point_groups *coarse) {
    const struct estimate_groups left = {fine->counted, fine->things};
    const struct estimate_groups right = {coarse->counted, coarse->things};
    return estimate_group_pairs(POINT_GROUPS, &left, &right);
}

/* The error of a value that is of[0] on the own grid and of[l + 1] on level l. least: its standard
 * error, which stands in where too few groups have data. */
struct level_error {
    double value, bound, standard_error;
};
static struct level_error error_of(const struct statistics_levels *levels,
                                   const struct point_groups of[], double least) {
    struct pair_estimate fine = difference(&of[0], &of[1]);
    struct mesh_changes changes = {.fine = fine.value,
                                   .coarse = NAN,
                                   .fine_ratio = spacing_ratio(levels, 0),
                                   .coarse_ratio = NAN};
    if (levels->count > 1) {
        changes.coarse = difference(&of[1], &of[2]).value;
        changes.coarse_ratio = spacing_ratio(levels, 1);
    }
    struct mesh_error mesh = mesh_error(&changes, ORDER);
    bool rare = of[0].informative < TALLY_RARE || of[1].informative < TALLY_RARE;
    double scatter = rare ? M_SQRT2 * least : fine.standard_error;
    return (struct level_error){.value = isnan(mesh.bound) ? (double)NAN : mesh.error,
                                .bound = mesh.bound,
                                .standard_error = mesh.weight * scatter};
}

/* --- curves --- */

/* Makes the arrays of an error of a curve, in the result's arena. */
static int curve_room(struct case_result *out, struct curve *curve, double **room,
                      struct error *err) {
    size_t n = curve_value_count(curve);
    *room = result_numbers(out, 3 * n);
    if (*room == NULL)
        return error_set(err, ERROR_MEMORY, "no memory left for errors");
    curve->errors[ERROR_DISCRETISATION] = (struct curve_error){.applies = true,
                                                               .value = *room,
                                                               .bound = *room + n,
                                                               .standard_error = *room + 2 * n,
                                                               .order = NAN};
    return 0;
}

/* Heights of points have no such error: their distribution does not depend on the spacing. */
static bool is_of_heights(const struct curve *curve) {
    return strcmp(curve->quantity, "height_pdf") == 0 || strcmp(curve->quantity, "height_cdf") == 0;
}

static bool is_of_levels(const struct statistics_levels *levels, const struct curve *curve) {
    struct point_groups groups;
    return levels->count > 0 && curve->columns == 0 &&
           statistics_groups_point(&levels->own.groups, levels->own.one_case, curve, 0, &groups);
}

static int curve_errors(const struct statistics_levels *levels, struct curve *curve,
                        struct case_result *out, struct error *err) {
    struct point_groups of[3];
    double *room;
    int status = curve_room(out, curve, &room, err);
    for (size_t a = 0; a < curve->n && status == 0; a++) {
        for (size_t l = 0; l < 3 && l <= levels->count; l++) {
            const struct statistics_tally *tally = l == 0 ? &levels->own : &levels->tallies[l - 1];
            statistics_groups_point(&tally->groups, tally->one_case, curve, a, &of[l]);
        }
        struct level_error error = error_of(levels, of, curve->standard_error[a]);
        room[a] = error.value;
        room[curve->n + a] = error.bound;
        room[2 * curve->n + a] = error.standard_error;
    }
    return status;
}

/* --- the joint density --- */

/* Uses the tallies of the grids, the own one first. A coarser grid finds summits at other heights,
 * and so in other cells: pairs would gain little, and their sums by groups would be many. The
 * standard error is that of independent grids, which is no smaller. */
static struct level_error joint_error(const struct statistics_levels *levels, size_t side,
                                      size_t cell) {
    struct estimate of[3];
    for (size_t l = 0; l < 3 && l <= levels->count; l++) {
        const struct statistics_tally *tally = l == 0 ? &levels->own : &levels->tallies[l - 1];
        of[l] = tally_share(&tally->summits[side].joint, cell, &tally->summits[side].total);
    }
    bool three = levels->count > 1;
    const struct mesh_changes changes = {.fine = of[0].value - of[1].value,
                                         .coarse = three ? of[1].value - of[2].value : (double)NAN,
                                         .fine_ratio = spacing_ratio(levels, 0),
                                         .coarse_ratio =
                                             three ? spacing_ratio(levels, 1) : (double)NAN};
    struct mesh_error mesh = mesh_error(&changes, ORDER);
    return (struct level_error){
        .value = isnan(mesh.bound) ? (double)NAN : mesh.error,
        .bound = mesh.bound,
        .standard_error = mesh.weight * hypot(of[0].standard_error, of[1].standard_error)};
}

static int joint_errors(const struct statistics_levels *levels, struct curve *curve,
                        struct case_result *out, struct error *err) {
    const struct statistics_case *one_case = levels->own.one_case;
    double area = bins_width(&one_case->height) * bins_width(&one_case->equivalent), *room;
    size_t side = strcmp(curve->series, "pits") == 0 ? SIDE_PITS : SIDE_SUMMITS;
    size_t n = curve->cell_count;
    int status = curve_room(out, curve, &room, err);
    for (size_t a = 0; a < n && status == 0; a++) {
        size_t cell = summit_joint_cell(one_case, curve->cells[a]);
        struct level_error error = joint_error(levels, side, cell);
        room[a] = error.value / area;
        room[n + a] = error.bound / area;
        room[2 * n + a] = error.standard_error / area;
    }
    return status;
}

static int set_curve(const struct statistics_levels *levels, struct curve *curve,
                     struct case_result *out, struct error *err) {
    double *room;
    curve->errors[ERROR_DISCRETISATION].applies = true;
    if (is_of_heights(curve)) /* zeros */
        return curve_room(out, curve, &room, err);
    if (levels->count > 0 && curve->columns > 0)
        return joint_errors(levels, curve, out, err);
    return is_of_levels(levels, curve) ? curve_errors(levels, curve, out, err) : 0;
}

/* --- scalars --- */

static struct scalar *scalar_at(struct case_result *out, size_t at) {
    const char *name = statistics_scalar_name(at);
    for (size_t s = 0; s < out->scalar_count; s++)
        if (strcmp(out->scalars[s].name, name) == 0)
            return &out->scalars[s];
    return NULL;
}

/* What a scalar is the mean of: sums over summits, or over realisations. */
enum mean {
    MEAN_NUMBER,
    MEAN_HEIGHT,
    MEAN_VARIANCE,
    MEAN_SKEWNESS,
    MEAN_KURTOSIS,
    MEAN_CURVATURE,
    MEAN_LOWEST,
    MEAN_HIGHEST
};

static double group_sum(const struct statistics_groups *moments, size_t g, size_t at) {
    return exact_sum_value(&moments->sum[g * moments->sums + at]);
}

/* Returns powers of the heights of a side's summits in a group, about height c. */
static struct height_powers powers_of(const struct statistics_groups *moments, size_t g,
                                      size_t side, double c) {
    const size_t at = side * SUMS_OF_SIDE;
    double n = (double)moments->count[g * moments->counts + side];
    double first = group_sum(moments, g, at + SUM_HEIGHT);
    double second = group_sum(moments, g, at + SUM_SQUARE);
    double third = group_sum(moments, g, at + SUM_CUBE);
    double fourth = group_sum(moments, g, at + SUM_FOURTH);
    return (struct height_powers){
        .number = n,
        .first = first - c * n,
        .second = second - c * (2 * first - c * n),
        .third = third - c * (3 * second - c * (3 * first - c * n)),
        .fourth = fourth - c * (4 * third - c * (6 * second - c * (4 * first - c * n)))};
}

/* Returns the same over all groups. */
static struct height_powers powers_of_all(const struct statistics_groups *moments, size_t side,
                                          double c) {
    struct height_powers all = {0};
    for (size_t g = 0; g < GROUPS; g++) {
        const struct height_powers some = powers_of(moments, g, side, c);
        all.number += some.number;
        all.first += some.first;
        all.second += some.second;
        all.third += some.third;
        all.fourth += some.fourth;
    }
    return all;
}

static void groups_of(const struct statistics_groups *moments, size_t side, enum mean mean,
                      struct point_groups *out) {
    const struct height_powers heights = powers_of_all(moments, side, 0);
    double centre = heights.first / heights.number;
    const struct height_powers all = powers_of_all(moments, side, centre);
    *out = (struct point_groups){.informative = 0};
    for (size_t g = 0; g < GROUPS; g++) {
        double n = (double)moments->count[g * moments->counts + side];
        double realisations = (double)moments->realisations[g];
        const struct height_powers some = powers_of(moments, g, side, centre);
        const double counted[] = {
            [MEAN_NUMBER] = n,
            [MEAN_HEIGHT] = group_sum(moments, g, side * SUMS_OF_SIDE + SUM_HEIGHT),
            [MEAN_VARIANCE] = height_moment_part(HEIGHT_VARIANCE, &all, &some),
            [MEAN_SKEWNESS] = height_moment_part(HEIGHT_SKEWNESS, &all, &some),
            [MEAN_KURTOSIS] = height_moment_part(HEIGHT_KURTOSIS, &all, &some),
            [MEAN_CURVATURE] = group_sum(moments, g, side * SUMS_OF_SIDE + SUM_CURVATURE),
            [MEAN_LOWEST] = group_sum(moments, g, SUM_LOWEST),
            [MEAN_HIGHEST] = group_sum(moments, g, SUM_HIGHEST)};
        bool of_summits = mean >= MEAN_HEIGHT && mean <= MEAN_CURVATURE;
        out->counted[g] = counted[mean];
        out->things[g] = of_summits ? n : realisations;
        out->informative += out->things[g] > 0;
    }
}

static double ratio_of(const struct point_groups *groups) {
    double counted = 0, things = 0;
    for (size_t g = 0; g < GROUPS; g++) {
        counted += groups->counted[g];
        things += groups->things[g];
    }
    return counted / things;
}

/* A number may be reported per cell, per area, or as half of summits and pits together: all are in
 * proportion to the number in groups. */
static void set_by_levels(const struct statistics_levels *levels, struct case_result *out,
                          size_t at, size_t side, enum mean mean) {
    struct scalar *scalar = scalar_at(out, at);
    struct point_groups of[3];
    if (scalar == NULL || isnan(scalar->value))
        return;
    scalar->errors[ERROR_DISCRETISATION].applies = true;
    if (levels->count == 0)
        return;
    for (size_t l = 0; l < 3 && l <= levels->count; l++)
        groups_of(&levels->moments[l], side, mean, &of[l]);
    double unit = mean == MEAN_NUMBER ? scalar->value / ratio_of(&of[0]) : 1;
    struct level_error error = error_of(levels, of, scalar->standard_error / unit);
    scalar->errors[ERROR_DISCRETISATION] =
        (struct scalar_error){.applies = true,
                              .known = !isnan(error.value),
                              .value = error.value * unit,
                              .bound = error.bound * unit,
                              .standard_error = error.standard_error * unit};
}

/* Sets the error of a constant of all surfaces of an exact spectrum: its value by differences less
 * the prescribed one. */
static void set_exactly(struct case_result *out, size_t at, bool exact) {
    struct scalar *scalar = scalar_at(out, at);
    if (scalar == NULL || isnan(scalar->value))
        return;
    double error = scalar->value - scalar->theory;
    scalar->errors[ERROR_DISCRETISATION] = (struct scalar_error){
        .applies = true, .known = exact && !isnan(error), .value = exact ? error : 0};
}

static bool has_exponential_acf(const struct surface_case *surface) {
    return surface->spectrum.type == SPECTRUM_EXPONENTIAL_ACF;
}

/* Returns whether a finer grid would hold waves of the surface that this one does not: moments of
 * the grid's spectrum then depend on the grid. */
static bool waves_beyond_grid(const struct surface_case *surface) {
    return !surface_case_band_limited(surface) || has_exponential_acf(surface) ||
           (surface->counter != NULL && has_exponential_acf(surface->counter));
}

static void set_scalars(const struct statistics_levels *levels, struct case_result *out) {
    static const enum mean OF_SIDE[SIDE_SCALARS] = {MEAN_NUMBER,   MEAN_NUMBER,   MEAN_NUMBER,
                                                    MEAN_HEIGHT,   MEAN_VARIANCE, MEAN_SKEWNESS,
                                                    MEAN_KURTOSIS, MEAN_CURVATURE};
    static const size_t BY_DIFFERENCES[] = {SCALAR_RMS_SLOPE, SCALAR_RMS_CURVATURE,
                                            SCALAR_M2_DIFFERENCE, SCALAR_M4_DIFFERENCE,
                                            SCALAR_NAYAK_ALPHA_DIFFERENCE};
    static const size_t SPECTRAL[] = {SCALAR_M2, SCALAR_M4, SCALAR_NAYAK_ALPHA};
    const struct surface_case *surface = &levels->own.one_case->surface;
    const bool beyond = waves_beyond_grid(surface);
    for (size_t side = 0; side < levels->own.sides; side++)
        for (size_t a = 0; a < SIDE_SCALARS; a++)
            set_by_levels(levels, out, (side == SIDE_PITS ? SCALAR_PITS : SCALAR_SUMMITS) + a, side,
                          OF_SIDE[a]);
    set_by_levels(levels, out, SCALAR_LOWEST, 0, MEAN_LOWEST);
    set_by_levels(levels, out, SCALAR_HIGHEST, 0, MEAN_HIGHEST);
    for (size_t a = 0; a < sizeof BY_DIFFERENCES / sizeof *BY_DIFFERENCES; a++)
        set_exactly(out, BY_DIFFERENCES[a], surface_case_exact(surface) && !beyond);
    for (size_t a = 0; a < sizeof SPECTRAL / sizeof *SPECTRAL && beyond; a++)
        set_exactly(out, SPECTRAL[a], false);
}

int statistics_levels_errors(const struct statistics_levels *levels, struct case_result *out,
                             struct error *err) {
    int status = 0;
    for (size_t a = 0; a < out->curve_count && status == 0; a++)
        status = set_curve(levels, &out->curves[a], out, err);
    if (status == 0)
        set_scalars(levels, out);
    return status;
}
