#include "jobs/statistics/statistics_groups.h"
#include <stdlib.h>
#include <string.h>

int summit_counts_create(struct summit_counts *out, const struct statistics_case *one_case,
                         struct error *err) {
    size_t heights = cells_of(&one_case->height), curvatures = cells_of(&one_case->equivalent);
    size_t joint = heights * curvatures;
    *out = (struct summit_counts){
        .joint = array_create(joint, sizeof *out->joint),
        .touched = array_create(joint, sizeof *out->touched),
        .height = array_create(heights, sizeof *out->height),
        .equivalent = array_create(curvatures, sizeof *out->equivalent),
        .curvature = array_create(heights, sizeof *out->curvature),
    };
    if (out->joint != NULL && out->touched != NULL && out->height != NULL &&
        out->equivalent != NULL && out->curvature != NULL)
        return 0;
    summit_counts_clear(out);
    return error_memory(err, (size_t)summit_counts_bytes(one_case), "counts of summits");
}

void summit_counts_clear(struct summit_counts *counts) {
    free(counts->joint);
    free(counts->touched);
    free(counts->height);
    free(counts->equivalent);
    free(counts->curvature);
    *counts = (struct summit_counts){0};
}

double summit_counts_bytes(const struct statistics_case *one_case) {
    size_t heights = cells_of(&one_case->height), curvatures = cells_of(&one_case->equivalent);
    return 16.0 * (double)(heights * curvatures + heights) + 8.0 * (double)curvatures;
}

struct summit_scales summit_scales(const struct statistics_case *one_case,
                                   const struct moments *moments) {
    double third = one_case->surface.dimension == 2 ? sqrt(3) : 1;
    return (struct summit_scales){1 / sqrt(moments->m0), -third / sqrt(moments->m4)};
}

void summit_counts_fill(struct summit_counts *counts, const struct statistics_case *one_case,
                        const struct summit_scales *scales, const struct summit_list *summits) {
    double third = one_case->surface.dimension == 2 ? sqrt(3) : 1;
    for (size_t a = 0; a < summits->count; a++) {
        double t1 = scales->curvature * summits->summits[a].curvature;
        size_t zb = bins_find(&one_case->height, scales->height * summits->summits[a].height);
        counts->height[zb]++;
        counts->equivalent[bins_find(&one_case->equivalent, t1)]++;
        counts->curvature[zb] -= t1 / third;
    }
}

void summit_counts_zero(struct summit_counts *counts, const struct statistics_case *one_case) {
    size_t heights = cells_of(&one_case->height);
    memset(counts->height, 0, heights * sizeof *counts->height);
    memset(counts->equivalent, 0, cells_of(&one_case->equivalent) * sizeof *counts->equivalent);
    memset(counts->curvature, 0, heights * sizeof *counts->curvature);
}

int statistics_groups_create(struct statistics_groups *out, size_t counts, size_t sums,
                             struct error *err) {
    *out = (struct statistics_groups){.counts = counts,
                                      .sums = sums,
                                      .count = array_create(GROUPS * counts, sizeof *out->count),
                                      .sum = array_create(GROUPS * sums, sizeof *out->sum)};
    if (out->count != NULL && out->sum != NULL)
        return 0;
    statistics_groups_clear(out);
    return error_memory(err, (size_t)statistics_groups_bytes(counts, sums), "groups");
}

void statistics_groups_clear(struct statistics_groups *groups) {
    free(groups->count);
    free(groups->sum);
    *groups = (struct statistics_groups){0};
}

double statistics_groups_bytes(size_t counts, size_t sums) {
    return GROUPS * ((double)counts * sizeof(uint64_t) + (double)sums * sizeof(struct exact_sum));
}

void statistics_groups_count(struct statistics_groups *groups, size_t group, size_t at, size_t n,
                             const uint64_t *count) {
    uint64_t *to = groups->count + group * groups->counts + at;
    for (size_t a = 0; a < n; a++)
        to[a] += count[a];
}

void statistics_groups_sum(struct statistics_groups *groups, size_t group, size_t at, size_t n,
                           const double *values) {
    struct exact_sum *to = groups->sum + group * groups->sums + at;
    for (size_t a = 0; a < n; a++)
        if (values[a] != 0)
            exact_sum_add(&to[a], values[a]);
}

void statistics_groups_merge(struct statistics_groups *into, const struct statistics_groups *from) {
    for (size_t g = 0; g < GROUPS; g++) {
        if (from->realisations[g] == 0)
            continue;
        into->realisations[g] += from->realisations[g];
        statistics_groups_count(into, g, 0, from->counts, from->count + g * from->counts);
        for (size_t a = g * from->sums; a < (g + 1) * from->sums; a++)
            exact_sum_merge(&into->sum[a], &from->sum[a]);
    }
}

/* --- bytes: of each group its realisations; where it has any, its counts and sums --- */

void statistics_groups_put(struct bytes *bytes, const struct statistics_groups *groups) {
    for (size_t g = 0; g < GROUPS; g++) {
        bytes_put_unsigned(bytes, groups->realisations[g]);
        if (groups->realisations[g] == 0)
            continue;
        bytes_put_counts(bytes, groups->counts, groups->count + g * groups->counts);
        for (size_t a = g * groups->sums; a < (g + 1) * groups->sums; a++)
            exact_sum_put(bytes, &groups->sum[a]);
    }
}

void statistics_groups_get(struct byte_reader *reader, struct statistics_groups *groups) {
    for (size_t g = 0; g < GROUPS && !reader->failed; g++) {
        groups->realisations[g] = bytes_get_unsigned(reader);
        if (groups->realisations[g] == 0)
            continue;
        bytes_get_counts(reader, groups->counts, groups->count + g * groups->counts);
        for (size_t a = g * groups->sums; a < (g + 1) * groups->sums && !reader->failed; a++)
            exact_sum_get(reader, &groups->sum[a]);
    }
}

bool statistics_groups_count_fits(const struct statistics_groups *groups, size_t at, size_t n,
                                  const uint64_t *count) {
    for (size_t a = 0; a < n; a++) {
        fixed_point sum = 0;
        for (size_t g = 0; g < GROUPS; g++)
            sum += groups->count[g * groups->counts + at + a];
        if (sum != count[a])
            return false;
    }
    return true;
}

bool statistics_groups_sum_fits(const struct statistics_groups *groups, size_t at, size_t n,
                                const struct exact_sum *sum) {
    for (size_t a = 0; a < n; a++) {
        struct exact_sum all = {0};
        for (size_t g = 0; g < GROUPS; g++)
            exact_sum_merge(&all, &groups->sum[g * groups->sums + at + a]);
        if (all.total != sum[a].total || all.lost != sum[a].lost)
            return false;
    }
    return true;
}

bool statistics_groups_realisations_fit(const struct statistics_groups *groups,
                                        uint64_t realisations) {
    fixed_point sum = 0;
    for (size_t g = 0; g < GROUPS; g++)
        sum += groups->realisations[g];
    return sum == realisations;
}

struct group_offsets statistics_group_offsets(const struct statistics_case *one_case) {
    size_t heights = cells_of(&one_case->height), curvatures = cells_of(&one_case->equivalent);
    struct group_offsets out = {.counts = heights};
    for (size_t side = 0; side < statistics_case_sides(one_case); side++) {
        out.summit[side] = out.counts;
        out.equivalent[side] = out.counts + heights;
        out.counts += heights + curvatures;
        out.curvature[side] = out.sums;
        out.sums += heights;
    }
    return out;
}

void statistics_groups_side(struct statistics_groups *groups,
                            const struct statistics_case *one_case, size_t group, size_t side,
                            const struct summit_counts *counts) {
    struct group_offsets offset = statistics_group_offsets(one_case);
    size_t heights = cells_of(&one_case->height);
    statistics_groups_count(groups, group, offset.summit[side], heights, counts->height);
    statistics_groups_count(groups, group, offset.equivalent[side], cells_of(&one_case->equivalent),
                            counts->equivalent);
    statistics_groups_sum(groups, group, offset.curvature[side], heights, counts->curvature);
}

/* --- points of curves by groups --- */

enum shape { SHAPE_DENSITY, SHAPE_CUMULATIVE, SHAPE_CURVATURE };
enum cells { CELLS_POINTS, CELLS_SUMMITS, CELLS_EQUIVALENT };

/* The curves that are ratios of sums by groups. */
static const struct row {
    const char *quantity;
    enum cells cells;
    enum shape shape;
} ROWS[] = {{"height_pdf", CELLS_POINTS, SHAPE_DENSITY},
            {"height_cdf", CELLS_POINTS, SHAPE_CUMULATIVE},
            {"summit_height_pdf", CELLS_SUMMITS, SHAPE_DENSITY},
            {"summit_height_cdf", CELLS_SUMMITS, SHAPE_CUMULATIVE},
            {"summit_mean_curvature", CELLS_SUMMITS, SHAPE_CURVATURE},
            {"summit_curvature_pdf", CELLS_EQUIVALENT, SHAPE_DENSITY}};

static const struct row *row_of(const struct curve *curve) {
    for (size_t a = 0; a < sizeof ROWS / sizeof *ROWS; a++)
        if (strcmp(ROWS[a].quantity, curve->quantity) == 0)
            return &ROWS[a];
    return NULL;
}

/* Returns the counts of cells first to last of a group. offset: of cell 0 in the group. */
static double counted(const struct statistics_groups *groups, size_t g, size_t offset, size_t first,
                      size_t last) {
    const uint64_t *count = groups->count + g * groups->counts + offset;
    double sum = 0;
    for (size_t cell = first; cell <= last; cell++)
        sum += (double)count[cell];
    return sum;
}

/* Fills the share of things of each group in some cells, over a width. */
static void fill_shares(const struct statistics_groups *groups, size_t offset, size_t cells,
                        size_t first, size_t last, double width, struct point_groups *out) {
    for (size_t g = 0; g < GROUPS; g++) {
        double some = counted(groups, g, offset, first, last);
        out->things[g] = counted(groups, g, offset, 0, cells - 1);
        out->counted[g] = some / width;
        out->informative += some > 0 && some < out->things[g];
    }
}

static void fill_curvatures(const struct statistics_groups *groups, size_t offset, size_t sums,
                            size_t cell, struct point_groups *out) {
    for (size_t g = 0; g < GROUPS; g++) {
        out->things[g] = counted(groups, g, offset, cell, cell);
        out->counted[g] = exact_sum_value(&groups->sum[g * groups->sums + sums + cell]);
        out->informative += out->things[g] > 0;
    }
}

static const struct bins *bins_of(const struct statistics_case *one_case, const struct row *row) {
    return row->cells == CELLS_EQUIVALENT ? &one_case->equivalent : &one_case->height;
}

double statistics_curve_width(const struct statistics_case *one_case, const struct curve *curve) {
    const struct row *row = row_of(curve);
    if (row == NULL || row->shape == SHAPE_CURVATURE)
        return 0;
    return row->shape == SHAPE_DENSITY ? bins_width(bins_of(one_case, row)) : 1;
}

bool statistics_groups_point(const struct statistics_groups *groups,
                             const struct statistics_case *one_case, const struct curve *curve,
                             size_t at, struct point_groups *out) {
    const struct row *row = row_of(curve);
    struct group_offsets offset = statistics_group_offsets(one_case);
    size_t side = strcmp(curve->series, "pits") == 0 ? SIDE_PITS : SIDE_SUMMITS;
    if (row == NULL || side >= statistics_case_sides(one_case))
        return false;
    const struct bins *bins = bins_of(one_case, row);
    const size_t offsets[] = {offset.height, offset.summit[side], offset.equivalent[side]};
    size_t first = row->shape == SHAPE_CUMULATIVE ? 0 : at + 1;
    if (at >= bins->count)
        return false;
    *out = (struct point_groups){.informative = 0};
    if (row->shape == SHAPE_CURVATURE)
        fill_curvatures(groups, offsets[row->cells], offset.curvature[side], at + 1, out);
    else
        fill_shares(groups, offsets[row->cells], cells_of(bins), first, at + 1,
                    statistics_curve_width(one_case, curve), out);
    return true;
}
