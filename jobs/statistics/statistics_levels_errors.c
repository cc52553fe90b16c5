/* From changes between levels to the discretisation error of curves and scalars. */
#include "core/statistics/richardson.h"
#include "jobs/estimate.h"
#include "jobs/statistics/statistics_levels.h"
#include "jobs/statistics/statistics_pairs.h"
#include "jobs/statistics/statistics_scalars.h"
#include "jobs/statistics/summit_heights.h"
#include <math.h>
#include <string.h>

/* What is counted and measured at summits of a grid has errors of this order in its spacing (F8.3);
 * extremes of points have, too. */
static const double ORDER = 2;

/* Of a level over the next finer one. */
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

/* The error of what is `of[0]` on the own grid and of[l + 1] on level l. least: its standard error
 * where too few groups tell of it. */
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
    bool rare = of[0].telling < TALLY_RARE || of[1].telling < TALLY_RARE;
    double chance = rare ? M_SQRT2 * least : fine.standard_error;
    return (struct level_error){.value = isnan(mesh.bound) ? (double)NAN : mesh.error,
                                .bound = mesh.bound,
                                .standard_error = mesh.weight * chance};
}

/* --- curves --- */

/* Rows of an error of a curve, in the result's arena. */
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

/* Heights of points have no error: more of them tell the same. */
static bool is_of_heights(const struct curve *curve) {
    return strcmp(curve->quantity, "height_pdf") == 0 || strcmp(curve->quantity, "height_cdf") == 0;
}

static bool is_of_levels(const struct statistics_levels *levels, const struct curve *curve) {
    struct point_groups groups;
    return levels->count > 0 && curve->columns == 0 &&
           statistics_point_groups(&levels->own, curve, 0, &groups);
}

static int curve_errors(const struct statistics_levels *levels, struct curve *curve,
                        struct case_result *out, struct error *err) {
    struct point_groups of[3];
    double *room;
    int status = curve_room(out, curve, &room, err);
    for (size_t a = 0; a < curve->n && status == 0; a++) {
        for (size_t l = 0; l < 3 && l <= levels->count; l++)
            statistics_point_groups(l == 0 ? &levels->own : &levels->tallies[l - 1], curve, a,
                                    &of[l]);
        struct level_error error = error_of(levels, of, curve->standard_error[a]);
        room[a] = error.value;
        room[curve->n + a] = error.bound;
        room[2 * curve->n + a] = error.standard_error;
    }
    return status;
}

/* --- the joint density --- */

/* Of the grids by their tallies, the own one first. Summits that a coarser grid sees elsewhere move
 * from cell to cell, so that little is gained by pairs, whose sums by groups would be many: the
 * standard error is that of grids that do not go together, which is no less. */
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

static int tell_curve(const struct statistics_levels *levels, struct curve *curve,
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

/* Powers of the heights of a side's summits of a group, about a height. */
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

/* Over all groups. */
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
    *out = (struct point_groups){.telling = 0};
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
        out->telling += out->things[g] > 0;
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

/* Numbers are told per cell, per area, or half of summits and pits together: all in proportion. */
static void tell_by_levels(const struct statistics_levels *levels, struct case_result *out,
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

/* A constant of all surfaces of an exact spectrum: what differences find less what is prescribed.
 */
static void tell_exactly(struct case_result *out, size_t at, bool exact) {
    struct scalar *scalar = scalar_at(out, at);
    if (scalar == NULL || isnan(scalar->value))
        return;
    double error = scalar->value - scalar->theory;
    scalar->errors[ERROR_DISCRETISATION] = (struct scalar_error){
        .applies = true, .known = exact && !isnan(error), .value = exact ? error : 0};
}

static void tell_scalars(const struct statistics_levels *levels, struct case_result *out) {
    static const enum mean OF_SIDE[SIDE_SCALARS] = {MEAN_NUMBER,   MEAN_NUMBER,   MEAN_NUMBER,
                                                    MEAN_HEIGHT,   MEAN_VARIANCE, MEAN_SKEWNESS,
                                                    MEAN_KURTOSIS, MEAN_CURVATURE};
    static const size_t BY_DIFFERENCES[] = {SCALAR_RMS_SLOPE, SCALAR_RMS_CURVATURE,
                                            SCALAR_M2_DIFFERENCE, SCALAR_M4_DIFFERENCE,
                                            SCALAR_NAYAK_ALPHA_DIFFERENCE};
    const struct statistics_case *one_case = levels->own.one_case;
    for (size_t side = 0; side < levels->own.sides; side++)
        for (size_t a = 0; a < SIDE_SCALARS; a++)
            tell_by_levels(levels, out, (side == SIDE_PITS ? SCALAR_PITS : SCALAR_SUMMITS) + a,
                           side, OF_SIDE[a]);
    tell_by_levels(levels, out, SCALAR_LOWEST, 0, MEAN_LOWEST);
    tell_by_levels(levels, out, SCALAR_HIGHEST, 0, MEAN_HIGHEST);
    for (size_t a = 0; a < sizeof BY_DIFFERENCES / sizeof *BY_DIFFERENCES; a++)
        tell_exactly(out, BY_DIFFERENCES[a], surface_case_exact(&one_case->surface));
}

int statistics_levels_errors(const struct statistics_levels *levels, struct case_result *out,
                             struct error *err) {
    int status = 0;
    for (size_t a = 0; a < out->curve_count && status == 0; a++)
        status = tell_curve(levels, &out->curves[a], out, err);
    if (status == 0)
        tell_scalars(levels, out);
    return status;
}
