#include "jobs/statistics/statistics_groups.h"
#include <stdlib.h>

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
