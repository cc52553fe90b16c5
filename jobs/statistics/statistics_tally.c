#include "jobs/statistics/statistics_tally.h"
#include <stdlib.h>
#include <string.h>

static size_t cells_of(const struct bins *bins) {
    return bins->count + 2;
}

int statistics_tally_create(struct statistics_tally *out, const struct statistics_case *one_case,
                            const struct moments *moments, size_t densities, size_t correlations,
                            struct error *err) {
    size_t heights = cells_of(&one_case->height), curvatures = cells_of(&one_case->equivalent);
    size_t joint = heights * curvatures;
    double third = one_case->surface.dimension == 2 ? sqrt(3) : 1;
    *out = (struct statistics_tally){
        .one_case = one_case,
        .height_scale = 1 / sqrt(moments->m0),
        .curvature_scale = -third / sqrt(moments->m4),
        .count = array_create(joint + heights + curvatures, sizeof *out->count),
        .touched = array_create(joint, sizeof *out->touched),
        .bin_curvature = array_create(heights, sizeof(double))};
    int status = 0;
    if (out->count == NULL || out->touched == NULL || out->bin_curvature == NULL)
        status = error_memory(err, 16 * joint, "a tally");
    struct tally *const tallies[] = {&out->height,       &out->height_below, &out->summit,
                                     &out->summit_below, &out->equivalent,   &out->joint};
    const size_t sizes[] = {heights, heights - 1, heights, heights - 1, curvatures, joint};
    for (size_t a = 0; a < sizeof sizes / sizeof *sizes && status == 0; a++)
        status = tally_create(tallies[a], sizes[a], err);
    if (status == 0)
        status = tally_sums_create(&out->curvature, heights, err);
    if (status == 0 && densities > 0)
        status = tally_sums_create(&out->density, densities, err);
    if (status == 0 && correlations > 0)
        status = tally_sums_create(&out->correlation, correlations, err);
    if (status != 0)
        statistics_tally_clear(out);
    return status;
}

void statistics_tally_clear(struct statistics_tally *tally) {
    tally_clear(&tally->height);
    tally_clear(&tally->height_below);
    tally_clear(&tally->summit);
    tally_clear(&tally->summit_below);
    tally_clear(&tally->equivalent);
    tally_clear(&tally->joint);
    tally_sums_clear(&tally->curvature);
    tally_sums_clear(&tally->density);
    tally_sums_clear(&tally->correlation);
    free(tally->count);
    free(tally->touched);
    free(tally->bin_curvature);
    *tally = (struct statistics_tally){0};
}

double statistics_tally_bytes(const struct statistics_case *one_case) {
    size_t heights = cells_of(&one_case->height), curvatures = cells_of(&one_case->equivalent);
    size_t joint = heights * curvatures;
    return tally_bytes(4 * heights + curvatures + joint) + tally_sums_bytes(heights) +
           16.0 * (double)joint;
}

/* Adds one realisation's cell counts, and clears them. */
static void add_cells(struct tally *cells, struct tally *below, uint64_t *count, uint64_t things) {
    uint64_t sum = 0;
    for (size_t a = 0; a < cells->size; a++) {
        if (count[a] > 0)
            tally_add(cells, a, count[a], things);
        sum += count[a];
        if (below != NULL && sum > 0 && a < below->size)
            tally_add(below, a, sum, things);
        count[a] = 0;
    }
}

void statistics_tally_heights(struct statistics_tally *tally, size_t n, const double *z) {
    tally_total_add(&tally->points, n);
    histogram_add(&tally->one_case->height, n, z, tally->height_scale, tally->count);
    add_cells(&tally->height, &tally->height_below, tally->count, n);
}

void statistics_tally_summits(struct statistics_tally *tally, const struct summit_list *summits) {
    const struct bins *height = &tally->one_case->height,
                      *equivalent = &tally->one_case->equivalent;
    size_t columns = tally->equivalent.size, touched = 0;
    double third = tally->one_case->surface.dimension == 2 ? sqrt(3) : 1;
    tally_total_add(&tally->summits, summits->count);
    for (size_t a = 0; a < summits->count; a++) {
        double t1 = tally->curvature_scale * summits->summits[a].curvature;
        size_t zb = bins_find(height, tally->height_scale * summits->summits[a].height);
        size_t cell = zb * columns + bins_find(equivalent, t1);
        if (tally->count[cell]++ == 0)
            tally->touched[touched++] = cell;
        tally->bin_curvature[zb] -= t1 / third;
    }
    /* the marginals come from the joint counts */
    uint64_t *marginal = tally->count + tally->joint.size;
    for (size_t a = 0; a < touched; a++) {
        size_t cell = tally->touched[a];
        marginal[cell / columns] += tally->count[cell];
        tally_add(&tally->joint, cell, tally->count[cell], summits->count);
        marginal[tally->summit.size + cell % columns] += tally->count[cell];
        tally->count[cell] = 0;
    }
    for (size_t zb = 0; zb < tally->summit.size; zb++) {
        if (marginal[zb] > 0)
            tally_sums_add(&tally->curvature, zb, tally->bin_curvature[zb], marginal[zb]);
        tally->bin_curvature[zb] = 0;
    }
    add_cells(&tally->summit, &tally->summit_below, marginal, summits->count);
    add_cells(&tally->equivalent, NULL, marginal + tally->summit.size, summits->count);
}

void statistics_tally_put(struct bytes *bytes, const struct statistics_tally *tally) {
    bytes_put_unsigned(bytes, tally->density.size);
    bytes_put_unsigned(bytes, tally->correlation.size);
    tally_total_put(bytes, &tally->points);
    tally_total_put(bytes, &tally->summits);
    tally_put(bytes, &tally->height);
    tally_put(bytes, &tally->height_below);
    tally_put(bytes, &tally->summit);
    tally_put(bytes, &tally->summit_below);
    tally_put(bytes, &tally->equivalent);
    tally_put(bytes, &tally->joint);
    tally_sums_put(bytes, &tally->curvature);
    tally_sums_put(bytes, &tally->density);
    tally_sums_put(bytes, &tally->correlation);
}

void statistics_tally_get(struct byte_reader *reader, struct statistics_tally *tally) {
    if (bytes_get_unsigned(reader) != tally->density.size ||
        bytes_get_unsigned(reader) != tally->correlation.size) {
        reader->failed = true;
        return;
    }
    tally_total_get(reader, &tally->points);
    tally_total_get(reader, &tally->summits);
    tally_get(reader, &tally->height);
    tally_get(reader, &tally->height_below);
    tally_get(reader, &tally->summit);
    tally_get(reader, &tally->summit_below);
    tally_get(reader, &tally->equivalent);
    tally_get(reader, &tally->joint);
    tally_sums_get(reader, &tally->curvature);
    tally_sums_get(reader, &tally->density);
    tally_sums_get(reader, &tally->correlation);
}

/* Returns whether every thing of a histogram is in one of its cells. */
static bool adds_up(const struct tally *tally, const struct tally_total *total) {
    fixed_point sum = 0;
    for (size_t cell = 0; cell < tally->size; cell++)
        sum += tally->count[cell];
    return sum == total->sum;
}

bool statistics_tally_adds_up(const struct statistics_tally *tally) {
    return tally->points.realisations == tally->summits.realisations &&
           adds_up(&tally->height, &tally->points) && adds_up(&tally->summit, &tally->summits) &&
           adds_up(&tally->equivalent, &tally->summits) && adds_up(&tally->joint, &tally->summits);
}

void statistics_tally_merge(struct statistics_tally *into, const struct statistics_tally *from) {
    tally_total_merge(&into->points, &from->points);
    tally_total_merge(&into->summits, &from->summits);
    tally_merge(&into->height, &from->height);
    tally_merge(&into->height_below, &from->height_below);
    tally_merge(&into->summit, &from->summit);
    tally_merge(&into->summit_below, &from->summit_below);
    tally_merge(&into->equivalent, &from->equivalent);
    tally_merge(&into->joint, &from->joint);
    tally_sums_merge(&into->curvature, &from->curvature);
    tally_sums_merge(&into->density, &from->density);
    tally_sums_merge(&into->correlation, &from->correlation);
}
