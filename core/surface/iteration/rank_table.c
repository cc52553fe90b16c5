#include "core/surface/iteration/rank_table.h"
#include "core/vectors.h"
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* A table of the most bins fits into the second-level cache. */
enum { KEYS_A_BIN = 16, BINS_LEAST = 1024, BINS_MOST = 16384, TOGETHER = 64 };

/* A height is value + slope * (position in bins). */
struct rank_line {
    double value, slope;
};

struct rank_table {
    size_t n, bins;
    double origin, scale, end; /* position = (key - origin) * scale, limited to [0, end] */
    /* of the keys counted so far, those of each lane apart */
    double lowest[TOGETHER], highest[TOGETHER];
    uint32_t *count;         /* bins */
    struct rank_line *lines; /* bins */
};

static size_t bins_for(size_t n) {
    size_t bins = n / KEYS_A_BIN;
    bins = bins > BINS_LEAST ? bins : BINS_LEAST;
    return bins < BINS_MOST ? bins : BINS_MOST;
}

int rank_table_create(struct rank_table **out, size_t n, struct error *err) {
    struct rank_table *table = array_create(1, sizeof *table);
    if (table == NULL)
        return error_memory(err, sizeof *table, "a table of ranks");
    table->n = n;
    table->bins = bins_for(n);
    table->end = (double)table->bins * (1 - 0x1p-40);
    table->count = array_create(table->bins, sizeof *table->count);
    table->lines = array_create(table->bins, sizeof *table->lines);
    if (table->count == NULL || table->lines == NULL) {
        rank_table_destroy(&table);
        return error_memory(err, (size_t)rank_table_bytes(n), "a table of ranks");
    }
    *out = table;
    return 0;
}

void rank_table_destroy(struct rank_table **table) {
    if (*table == NULL)
        return;
    free((*table)->count);
    free((*table)->lines);
    free(*table);
    *table = NULL;
}

double rank_table_bytes(size_t n) {
    return sizeof(struct rank_table) +
           (double)bins_for(n) * (double)(sizeof(uint32_t) + sizeof(struct rank_line));
}

void rank_table_start(struct rank_table *table, double low, double high) {
    table->origin = low;
    table->scale = table->end / (high - low);
    for (size_t a = 0; a < TOGETHER; a++) {
        table->lowest[a] = INFINITY;
        table->highest[a] = -INFINITY;
    }
    memset(table->count, 0, table->bins * sizeof *table->count);
}

static inline double position_of(double key, double origin, double scale, double end) {
    double position = (key - origin) * scale;
    position = position > 0 ? position : 0; /* NaN, too, becomes 0 */
    return position < end ? position : end;
}

/* Bins of up to TOGETHER keys, which also widen the range of each lane. */
WIDE_VECTORS static void bins_fill(struct rank_table *restrict table, size_t n,
                                   const double *restrict key, int32_t *restrict bin) {
    double origin = table->origin, scale = table->scale, end = table->end;
    for (size_t a = 0; a < n; a++) {
        table->lowest[a] = key[a] < table->lowest[a] ? key[a] : table->lowest[a];
        table->highest[a] = key[a] > table->highest[a] ? key[a] : table->highest[a];
        bin[a] = (int32_t)position_of(key[a], origin, scale, end);
    }
}

void rank_table_count(struct rank_table *table, size_t n, const double *key) {
    uint32_t *count = table->count;
    for (size_t i = 0; i < n; i += TOGETHER) {
        size_t some = n - i < TOGETHER ? n - i : TOGETHER;
        int32_t bin[TOGETHER];
        bins_fill(table, some, key + i, bin);
        for (size_t a = 0; a < some; a++)
            count[bin[a]]++;
    }
}

/* Returns the height at a bin's edge below which `rank` keys lie. */
static double edge_height(const struct rank_table *table, const double *sorted, size_t rank) {
    if (rank == 0)
        return sorted[0];
    if (rank == table->n)
        return sorted[rank - 1];
    return (sorted[rank - 1] + sorted[rank]) / 2;
}

void rank_table_finish(struct rank_table *table, const double *sorted, double *low, double *high) {
    size_t rank = 0;
    double below = edge_height(table, sorted, 0);
    for (size_t b = 0; b < table->bins; b++) {
        rank += table->count[b];
        double above = edge_height(table, sorted, rank);
        double slope = above - below;
        table->lines[b] = (struct rank_line){below - (double)b * slope, slope};
        below = above;
    }
    *low = table->lowest[0];
    *high = table->highest[0];
    for (size_t a = 1; a < TOGETHER; a++) {
        *low = table->lowest[a] < *low ? table->lowest[a] : *low;
        *high = table->highest[a] > *high ? table->highest[a] : *high;
    }
}

/* Positions of up to TOGETHER keys. */
WIDE_VECTORS static void positions_fill(const struct rank_table *restrict table, size_t n,
                                        const double *restrict key, double *restrict position,
                                        int32_t *restrict bin) {
    double origin = table->origin, scale = table->scale, end = table->end;
    for (size_t a = 0; a < n; a++) {
        position[a] = position_of(key[a], origin, scale, end);
        bin[a] = (int32_t)position[a];
    }
}

void rank_table_order(const struct rank_table *table, size_t n, const double *key,
                      double *ordered) {
    for (size_t i = 0; i < n; i += TOGETHER) {
        size_t some = n - i < TOGETHER ? n - i : TOGETHER;
        double position[TOGETHER];
        int32_t bin[TOGETHER];
        positions_fill(table, some, key + i, position, bin);
        for (size_t a = 0; a < some; a++) {
            const struct rank_line *line = &table->lines[bin[a]];
            ordered[i + a] = line->value + line->slope * position[a];
        }
    }
}
