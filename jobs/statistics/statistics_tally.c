#include "jobs/statistics/statistics_tally.h"
#include <string.h>

struct group_place statistics_group_place(const struct statistics_case *one_case) {
    size_t heights = cells_of(&one_case->height), curvatures = cells_of(&one_case->equivalent);
    struct group_place out = {.counts = heights};
    for (size_t side = 0; side < statistics_case_sides(one_case); side++) {
        out.summit[side] = out.counts;
        out.equivalent[side] = out.counts + heights;
        out.counts += heights + curvatures;
        out.curvature[side] = out.sums;
        out.sums += heights;
    }
    return out;
}

int statistics_tally_create(struct statistics_tally *out, const struct statistics_case *one_case,
                            const struct moments *moments, const struct spectra_sizes *sizes,
                            struct error *err) {
    size_t heights = cells_of(&one_case->height);
    double third = one_case->surface.dimension == 2 ? sqrt(3) : 1;
    struct group_place place = statistics_group_place(one_case);
    *out = (struct statistics_tally){
        .one_case = one_case,
        .scales = {.height = 1 / sqrt(moments->m0), .curvature = -third / sqrt(moments->m4)},
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
        status = statistics_groups_create(&out->groups, place.counts, place.sums, err);
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
    struct group_place place = statistics_group_place(one_case);
    double sides = (double)statistics_case_sides(one_case);
    return tally_bytes(2 * cells_of(&one_case->height)) + sides * summit_tally_bytes(one_case) +
           summit_counts_bytes(one_case) + statistics_groups_bytes(place.counts, place.sums);
}

void statistics_tally_add(struct statistics_tally *tally, uint64_t realisation, size_t n,
                          const struct summit_list summits[]) {
    const struct statistics_case *one_case = tally->one_case;
    struct group_place place = statistics_group_place(one_case);
    struct summit_counts *counts = &tally->counts;
    size_t heights = tally->height.size, group = group_of(realisation);
    tally_total_add(&tally->points, n);
    tally->groups.realisations[group]++;
    histogram_tally_add(&tally->height, &tally->height_below, counts->height, n);
    statistics_groups_count(&tally->groups, group, place.height, heights, counts->height);
    memset(counts->height, 0, heights * sizeof *counts->height);
    for (size_t side = 0; side < tally->sides; side++) {
        struct summit_tally *to = &tally->summits[side];
        summit_tally_add(to, one_case, &tally->scales, &summits[side], counts);
        statistics_groups_count(&tally->groups, group, place.summit[side], heights, counts->height);
        statistics_groups_count(&tally->groups, group, place.equivalent[side], to->equivalent.size,
                                counts->equivalent);
        statistics_groups_sum(&tally->groups, group, place.curvature[side], heights,
                              counts->curvature);
        summit_counts_zero(counts, to);
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
    struct group_place place = statistics_group_place(tally->one_case);
    size_t heights = tally->height.size;
    bool fit = statistics_groups_realisations_fit(groups, tally->points.realisations) &&
               statistics_groups_count_fits(groups, place.height, heights, tally->height.count);
    for (size_t side = 0; side < tally->sides && fit; side++) {
        const struct summit_tally *of = &tally->summits[side];
        fit = statistics_groups_count_fits(groups, place.summit[side], heights, of->height.count) &&
              statistics_groups_count_fits(groups, place.equivalent[side], of->equivalent.size,
                                           of->equivalent.count) &&
              statistics_groups_sum_fits(groups, place.curvature[side], heights, of->curvature.sum);
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
