#include "jobs/statistics/statistics_tally.h"
#include <stdlib.h>
#include <string.h>

static void summit_tally_clear(struct summit_tally *tally) {
    tally_clear(&tally->height);
    tally_clear(&tally->below);
    tally_clear(&tally->equivalent);
    tally_clear(&tally->joint);
    tally_sums_clear(&tally->curvature);
    *tally = (struct summit_tally){0};
}

static int summit_tally_create(struct summit_tally *out, const struct statistics_case *one_case,
                               struct error *err) {
    size_t heights = cells_of(&one_case->height), curvatures = cells_of(&one_case->equivalent);
    *out = (struct summit_tally){0};
    int status = tally_create(&out->height, heights, heights, err);
    if (status == 0)
        status = tally_create(&out->below, heights - 1, heights - 1, err);
    if (status == 0)
        status = tally_create(&out->equivalent, curvatures, curvatures, err);
    if (status == 0)
        status = tally_create(&out->joint, heights * curvatures, curvatures, err);
    if (status == 0)
        status = tally_sums_create(&out->curvature, heights, err);
    if (status != 0)
        summit_tally_clear(out);
    return status;
}

static double summit_tally_bytes(const struct statistics_case *one_case) {
    size_t heights = cells_of(&one_case->height), curvatures = cells_of(&one_case->equivalent);
    return tally_bytes(2 * heights + curvatures + heights * curvatures) + tally_sums_bytes(heights);
}

/* Adds one realisation's counts of the cells of a histogram, n_r of its `things`, and those below
 * each edge (NULL: not wanted). */
static void histogram_tally_add(struct tally *cells, struct tally *below, const uint64_t *count,
                                uint64_t things) {
    uint64_t sum = 0;
    for (size_t a = 0; a < cells->size; a++) {
        if (count[a] > 0)
            tally_add(cells, a, count[a], things);
        sum += count[a];
        if (below != NULL && sum > 0 && a < below->size)
            tally_add(below, a, sum, things);
    }
}

/* Adds the summits of a realisation. Leaves its counts by height and by t1, and its curvatures, in
 * `counts` for the caller, who zeroes them (summit_counts_zero). */
static void summit_tally_add(struct summit_tally *tally, const struct statistics_case *one_case,
                             const struct summit_scales *scales, const struct summit_list *summits,
                             struct summit_counts *counts) {
    size_t columns = tally->equivalent.size, touched = 0;
    double third = one_case->surface.dimension == 2 ? sqrt(3) : 1;
    tally_total_add(&tally->total, summits->count);
    for (size_t a = 0; a < summits->count; a++) {
        double t1 = scales->curvature * summits->summits[a].curvature;
        size_t zb = bins_find(&one_case->height, scales->height * summits->summits[a].height);
        size_t cell = zb * columns + bins_find(&one_case->equivalent, t1);
        if (counts->joint[cell]++ == 0)
            counts->touched[touched++] = cell;
        counts->curvature[zb] -= t1 / third;
    }
    /* marginal counts are sums of the joint counts */
    for (size_t a = 0; a < touched; a++) {
        size_t cell = counts->touched[a];
        counts->height[cell / columns] += counts->joint[cell];
        counts->equivalent[cell % columns] += counts->joint[cell];
        tally_add(&tally->joint, cell, counts->joint[cell], summits->count);
        counts->joint[cell] = 0;
    }
    for (size_t zb = 0; zb < tally->height.size; zb++)
        if (counts->height[zb] > 0)
            tally_sums_add(&tally->curvature, zb, counts->curvature[zb], counts->height[zb]);
    histogram_tally_add(&tally->height, &tally->below, counts->height, summits->count);
    histogram_tally_add(&tally->equivalent, NULL, counts->equivalent, summits->count);
}

static void summit_tally_put(struct bytes *bytes, const struct summit_tally *tally) {
    tally_total_put(bytes, &tally->total);
    tally_put(bytes, &tally->height);
    tally_put(bytes, &tally->below);
    tally_put(bytes, &tally->equivalent);
    tally_put(bytes, &tally->joint);
    tally_sums_put(bytes, &tally->curvature);
}

static void summit_tally_get(struct byte_reader *reader, struct summit_tally *tally) {
    tally_total_get(reader, &tally->total);
    tally_get(reader, &tally->height);
    tally_get(reader, &tally->below);
    tally_get(reader, &tally->equivalent);
    tally_get(reader, &tally->joint);
    tally_sums_get(reader, &tally->curvature);
}

/* Returns whether every thing of a histogram is in one of its cells. */
static bool histogram_tally_adds_up(const struct tally *tally, const struct tally_total *total) {
    fixed_point sum = 0;
    for (size_t cell = 0; cell < tally->size; cell++) {
        sum += tally->count[cell];
        if (tally->some[cell] > total->realisations)
            return false;
    }
    return sum == total->sum;
}

static bool summit_tally_adds_up(const struct summit_tally *tally) {
    return histogram_tally_adds_up(&tally->height, &tally->total) &&
           histogram_tally_adds_up(&tally->equivalent, &tally->total) &&
           histogram_tally_adds_up(&tally->joint, &tally->total);
}

static void summit_tally_merge(struct summit_tally *into, const struct summit_tally *from) {
    tally_total_merge(&into->total, &from->total);
    tally_merge(&into->height, &from->height);
    tally_merge(&into->below, &from->below);
    tally_merge(&into->equivalent, &from->equivalent);
    tally_merge(&into->joint, &from->joint);
    tally_sums_merge(&into->curvature, &from->curvature);
}

int statistics_tally_create(struct statistics_tally *out, const struct statistics_case *one_case,
                            const struct moments *moments, const struct spectra_sizes *sizes,
                            struct error *err) {
    size_t heights = cells_of(&one_case->height);
    struct group_offsets offset = statistics_group_offsets(one_case);
    *out = (struct statistics_tally){.one_case = one_case,
                                     .scales = summit_scales(one_case, moments),
                                     .sides = statistics_case_sides(one_case)};
    int status = summit_counts_create(&out->counts, one_case, err);
    if (status == 0)
        status = tally_create(&out->height, heights, heights, err);
    if (status == 0)
        status = tally_create(&out->height_below, heights - 1, heights - 1, err);
    for (size_t side = 0; side < out->sides && status == 0; side++)
        status = summit_tally_create(&out->summits[side], one_case, err);
    const struct {
        size_t size;
        struct tally_sums *sums;
    } SPECTRA[] = {{sizes->densities, &out->density},
                   {sizes->correlations, &out->correlation},
                   {sizes->density_changes, &out->density_change},
                   {sizes->correlation_changes, &out->correlation_change}};
    for (size_t a = 0; a < sizeof SPECTRA / sizeof *SPECTRA && status == 0; a++)
        if (SPECTRA[a].size > 0)
            status = tally_sums_create(SPECTRA[a].sums, SPECTRA[a].size, err);
    if (status == 0)
        status = statistics_groups_create(&out->groups, offset.counts, offset.sums, err);
    if (status != 0)
        statistics_tally_clear(out);
    return status;
}

void statistics_tally_clear(struct statistics_tally *tally) {
    tally_clear(&tally->height);
    tally_clear(&tally->height_below);
    for (size_t side = 0; side < SIDES; side++)
        summit_tally_clear(&tally->summits[side]);
    tally_sums_clear(&tally->density);
    tally_sums_clear(&tally->correlation);
    tally_sums_clear(&tally->density_change);
    tally_sums_clear(&tally->correlation_change);
    statistics_groups_clear(&tally->groups);
    summit_counts_clear(&tally->counts);
    *tally = (struct statistics_tally){0};
}

double statistics_tally_bytes(const struct statistics_case *one_case) {
    struct group_offsets offset = statistics_group_offsets(one_case);
    double sides = (double)statistics_case_sides(one_case);
    return tally_bytes(2 * cells_of(&one_case->height)) + sides * summit_tally_bytes(one_case) +
           summit_counts_bytes(one_case) + statistics_groups_bytes(offset.counts, offset.sums);
}

void statistics_tally_add(struct statistics_tally *tally, uint64_t realisation, size_t n,
                          const struct summit_list summits[]) {
    const struct statistics_case *one_case = tally->one_case;
    struct group_offsets offset = statistics_group_offsets(one_case);
    struct summit_counts *counts = &tally->counts;
    size_t heights = tally->height.size, group = group_of(realisation);
    tally_total_add(&tally->points, n);
    tally->groups.realisations[group]++;
    histogram_tally_add(&tally->height, &tally->height_below, counts->height, n);
    statistics_groups_count(&tally->groups, group, offset.height, heights, counts->height);
    memset(counts->height, 0, heights * sizeof *counts->height);
    for (size_t side = 0; side < tally->sides; side++) {
        struct summit_tally *to = &tally->summits[side];
        summit_tally_add(to, one_case, &tally->scales, &summits[side], counts);
        statistics_groups_side(&tally->groups, one_case, group, side, counts);
        summit_counts_zero(counts, one_case);
    }
}

void statistics_tally_put(struct bytes *bytes, const struct statistics_tally *tally) {
    bytes_put_unsigned(bytes, tally->density.size);
    bytes_put_unsigned(bytes, tally->correlation.size);
    tally_total_put(bytes, &tally->points);
    tally_put(bytes, &tally->height);
    tally_put(bytes, &tally->height_below);
    for (size_t side = 0; side < tally->sides; side++)
        summit_tally_put(bytes, &tally->summits[side]);
    tally_sums_put(bytes, &tally->density);
    tally_sums_put(bytes, &tally->correlation);
    tally_sums_put(bytes, &tally->density_change);
    tally_sums_put(bytes, &tally->correlation_change);
    statistics_groups_put(bytes, &tally->groups);
}

void statistics_tally_get(struct byte_reader *reader, struct statistics_tally *tally) {
    if (bytes_get_unsigned(reader) != tally->density.size ||
        bytes_get_unsigned(reader) != tally->correlation.size) {
        reader->failed = true;
        return;
    }
    tally_total_get(reader, &tally->points);
    tally_get(reader, &tally->height);
    tally_get(reader, &tally->height_below);
    for (size_t side = 0; side < tally->sides; side++)
        summit_tally_get(reader, &tally->summits[side]);
    tally_sums_get(reader, &tally->density);
    tally_sums_get(reader, &tally->correlation);
    tally_sums_get(reader, &tally->density_change);
    tally_sums_get(reader, &tally->correlation_change);
    statistics_groups_get(reader, &tally->groups);
}

static bool groups_fit(const struct statistics_tally *tally) {
    const struct statistics_groups *groups = &tally->groups;
    struct group_offsets offset = statistics_group_offsets(tally->one_case);
    size_t heights = tally->height.size;
    bool fit = statistics_groups_realisations_fit(groups, tally->points.realisations) &&
               statistics_groups_count_fits(groups, offset.height, heights, tally->height.count);
    for (size_t side = 0; side < tally->sides && fit; side++) {
        const struct summit_tally *of = &tally->summits[side];
        fit =
            statistics_groups_count_fits(groups, offset.summit[side], heights, of->height.count) &&
            statistics_groups_count_fits(groups, offset.equivalent[side], of->equivalent.size,
                                         of->equivalent.count) &&
            statistics_groups_sum_fits(groups, offset.curvature[side], heights, of->curvature.sum);
    }
    return fit;
}

bool statistics_tally_adds_up(const struct statistics_tally *tally) {
    for (size_t side = 0; side < tally->sides; side++)
        if (tally->points.realisations != tally->summits[side].total.realisations ||
            !summit_tally_adds_up(&tally->summits[side]))
            return false;
    return histogram_tally_adds_up(&tally->height, &tally->points) && groups_fit(tally);
}

void statistics_tally_merge(struct statistics_tally *into, const struct statistics_tally *from) {
    tally_total_merge(&into->points, &from->points);
    tally_merge(&into->height, &from->height);
    tally_merge(&into->height_below, &from->height_below);
    for (size_t side = 0; side < into->sides; side++)
        summit_tally_merge(&into->summits[side], &from->summits[side]);
    tally_sums_merge(&into->density, &from->density);
    tally_sums_merge(&into->correlation, &from->correlation);
    tally_sums_merge(&into->density_change, &from->density_change);
    tally_sums_merge(&into->correlation_change, &from->correlation_change);
    statistics_groups_merge(&into->groups, &from->groups);
}
