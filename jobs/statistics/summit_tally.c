#include "jobs/statistics/summit_tally.h"
#include <stdlib.h>
#include <string.h>

int summit_tally_create(struct summit_tally *out, const struct statistics_case *one_case,
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

void summit_tally_clear(struct summit_tally *tally) {
    tally_clear(&tally->height);
    tally_clear(&tally->below);
    tally_clear(&tally->equivalent);
    tally_clear(&tally->joint);
    tally_sums_clear(&tally->curvature);
    *tally = (struct summit_tally){0};
}

double summit_tally_bytes(const struct statistics_case *one_case) {
    size_t heights = cells_of(&one_case->height), curvatures = cells_of(&one_case->equivalent);
    return tally_bytes(2 * heights + curvatures + heights * curvatures) + tally_sums_bytes(heights);
}

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

void summit_counts_zero(struct summit_counts *counts, const struct summit_tally *tally) {
    memset(counts->height, 0, tally->height.size * sizeof *counts->height);
    memset(counts->equivalent, 0, tally->equivalent.size * sizeof *counts->equivalent);
    memset(counts->curvature, 0, tally->height.size * sizeof *counts->curvature);
}

void histogram_tally_add(struct tally *cells, struct tally *below, const uint64_t *count,
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

void summit_tally_add(struct summit_tally *tally, const struct statistics_case *one_case,
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
    /* the marginals come from the joint counts */
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

void summit_tally_put(struct bytes *bytes, const struct summit_tally *tally) {
    tally_total_put(bytes, &tally->total);
    tally_put(bytes, &tally->height);
    tally_put(bytes, &tally->below);
    tally_put(bytes, &tally->equivalent);
    tally_put(bytes, &tally->joint);
    tally_sums_put(bytes, &tally->curvature);
}

void summit_tally_get(struct byte_reader *reader, struct summit_tally *tally) {
    tally_total_get(reader, &tally->total);
    tally_get(reader, &tally->height);
    tally_get(reader, &tally->below);
    tally_get(reader, &tally->equivalent);
    tally_get(reader, &tally->joint);
    tally_sums_get(reader, &tally->curvature);
}

bool histogram_tally_adds_up(const struct tally *tally, const struct tally_total *total) {
    fixed_point sum = 0;
    for (size_t cell = 0; cell < tally->size; cell++) {
        sum += tally->count[cell];
        if (tally->some[cell] > total->realisations)
            return false;
    }
    return sum == total->sum;
}

bool summit_tally_adds_up(const struct summit_tally *tally) {
    return histogram_tally_adds_up(&tally->height, &tally->total) &&
           histogram_tally_adds_up(&tally->equivalent, &tally->total) &&
           histogram_tally_adds_up(&tally->joint, &tally->total);
}

void summit_tally_merge(struct summit_tally *into, const struct summit_tally *from) {
    tally_total_merge(&into->total, &from->total);
    tally_merge(&into->height, &from->height);
    tally_merge(&into->below, &from->below);
    tally_merge(&into->equivalent, &from->equivalent);
    tally_merge(&into->joint, &from->joint);
    tally_sums_merge(&into->curvature, &from->curvature);
}
