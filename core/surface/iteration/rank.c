/* Rank ordering by distribution, exact for every input.
 *
 * 1. The range of the keys is divided into equal cells and the keys in each are counted: the exact
 * distribution at the cell edges. 2. Neighbouring cells are joined to buckets of a few hundred
 * keys. 3. The keys are copied to their buckets in order of index, so that the position in a bucket
 * stands for the index, which is not stored. 4. Each bucket, now within the first-level cache, is
 * ordered by a counting sort on finer cells and an insertion sort, and every key is replaced by the
 * value of its rank. 5. The values are collected again in order of index.
 *
 * All maps from key to cell are rounded expressions that rise with the key, so that cells never
 * contradict a comparison. Equal keys share a cell, and every step keeps their order. A bucket that
 * is too large, or whose keys crowd in a few fine cells, is merge-sorted: the worst case is n log
 * n.
 *
 * Memory: 18 bytes a key and some tables (ranker_bytes). */
#include "core/surface/iteration/rank.h"
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum {
    CELLS_MOST = 65536,  /* a cell number fits 16 bits */
    KEYS_A_CELL = 128,   /* on average */
    KEYS_A_BUCKET = 512, /* a bucket is closed when it holds so many */
    BUCKETS_AIM = 2048,  /* more write streams than this miss the second-level cache */
    KEYS_FAST = 4096,    /* larger buckets are merge-sorted */
    FINE_A_KEY = 2,      /* fine cells a key: most hold one key or none */
    SHIFTS_A_KEY = 8,    /* beyond this, merging replaces insertion */
};
/* Factor that keeps a product below the number of cells whatever the rounding. */
static const double JUST_BELOW_ONE = 1 - 0x1p-40;

struct ranker {
    size_t n;
    size_t cells;
    double *dealt;    /* n keys in bucket order; after step 4 the ranked values */
    uint16_t *cell;   /* cell of key i */
    uint32_t *order;  /* n: within a bucket, position of the p-th smallest key */
    uint32_t *spare;  /* n: merge space */
    uint32_t *start;  /* cells: count of a cell; later first position of a bucket */
    uint32_t *cursor; /* cells: next position of a bucket */
    uint32_t *first;  /* cells + 1: first cell of a bucket */
    uint16_t *bucket; /* cells: bucket of a cell */
    double *rising;   /* KEYS_FAST: keys of one bucket in order */
    uint32_t *fine;   /* KEYS_FAST: fine cell of a key */
    uint32_t *count;  /* FINE_A_KEY * KEYS_FAST + 1 */
    /* the map from key to cell: (key - lowest) * scale */
    double lowest, scale;
    size_t buckets;
};

static size_t cells_for(size_t n) {
    size_t cells = n / KEYS_A_CELL;
    if (cells < 1)
        cells = 1;
    return cells < CELLS_MOST ? cells : CELLS_MOST;
}

size_t ranker_bytes(size_t n) {
    size_t cells = cells_for(n);
    return sizeof(struct ranker) + n * (sizeof(double) + sizeof(uint16_t)) +
           cells * (3 * sizeof(uint32_t) + sizeof(uint16_t)) +
           KEYS_FAST * (sizeof(double) + (2 + FINE_A_KEY) * sizeof(uint32_t));
}

int ranker_create(struct ranker **out, size_t n, struct error *err) {
    *out = NULL;
    if (n < 1 || n > UINT32_MAX / 2)
        return error_set(err, ERROR_INPUT, "%zu values to rank; allowed: 1 to %u", n,
                         (unsigned)(UINT32_MAX / 2));
    struct ranker *ranker = array_create(1, sizeof *ranker);
    if (ranker == NULL)
        return error_memory(err, ranker_bytes(n), "ranking");
    size_t cells = cells_for(n);
    ranker->n = n;
    ranker->cells = cells;
    ranker->dealt = array_create(n, sizeof *ranker->dealt);
    ranker->cell = array_create(n, sizeof *ranker->cell);
    ranker->order = array_create(n, sizeof *ranker->order);
    ranker->spare = array_create(n, sizeof *ranker->spare);
    ranker->start = array_create(cells, sizeof *ranker->start);
    ranker->cursor = array_create(cells, sizeof *ranker->cursor);
    ranker->first = array_create(cells + 1, sizeof *ranker->first);
    ranker->bucket = array_create(cells, sizeof *ranker->bucket);
    ranker->rising = array_create(KEYS_FAST, sizeof *ranker->rising);
    ranker->fine = array_create(KEYS_FAST, sizeof *ranker->fine);
    ranker->count = array_create(FINE_A_KEY * KEYS_FAST + 1, sizeof *ranker->count);
    if (ranker->dealt == NULL || ranker->cell == NULL || ranker->order == NULL ||
        ranker->spare == NULL || ranker->start == NULL || ranker->cursor == NULL ||
        ranker->first == NULL || ranker->bucket == NULL || ranker->rising == NULL ||
        ranker->fine == NULL || ranker->count == NULL) {
        ranker_destroy(&ranker);
        return error_memory(err, ranker_bytes(n), "ranking");
    }
    *out = ranker;
    return 0;
}

void ranker_destroy(struct ranker **ranker) {
    if (ranker == NULL || *ranker == NULL)
        return;
    free((*ranker)->dealt);
    free((*ranker)->cell);
    free((*ranker)->order);
    free((*ranker)->spare);
    free((*ranker)->start);
    free((*ranker)->cursor);
    free((*ranker)->first);
    free((*ranker)->bucket);
    free((*ranker)->rising);
    free((*ranker)->fine);
    free((*ranker)->count);
    free(*ranker);
    *ranker = NULL;
}

/* Sets the map from key to cell. Four running extremes, so that none waits for another. */
static int map_set(struct ranker *ranker, const double *key, struct error *err) {
    double low[4] = {key[0], key[0], key[0], key[0]};
    double high[4] = {key[0], key[0], key[0], key[0]};
    double faulty[4] = {0}; /* 0 * key is NaN for a NaN or infinite key, and NaN stays */
    size_t n = ranker->n;
    size_t whole = n - n % 4;
    for (size_t i = 0; i < whole; i += 4)
        for (size_t a = 0; a < 4; a++) {
            double x = key[i + a];
            low[a] = x < low[a] ? x : low[a];
            high[a] = x > high[a] ? x : high[a];
            faulty[a] += 0 * x;
        }
    for (size_t i = whole; i < n; i++) {
        low[0] = key[i] < low[0] ? key[i] : low[0];
        high[0] = key[i] > high[0] ? key[i] : high[0];
        faulty[0] += 0 * key[i];
    }
    if (isnan(faulty[0] + faulty[1] + faulty[2] + faulty[3]))
        return error_set(err, ERROR_NUMERIC, "a value to rank is not finite");
    for (size_t a = 1; a < 4; a++) {
        low[0] = low[a] < low[0] ? low[a] : low[0];
        high[0] = high[a] > high[0] ? high[a] : high[0];
    }
    double scale = (double)ranker->cells * JUST_BELOW_ONE / (high[0] - low[0]);
    /* Equal keys, a denormal range and a range beyond DBL_MAX put all keys into cell 0. */
    bool usable = isfinite(scale) && isfinite(high[0] - low[0]);
    ranker->lowest = usable ? low[0] : 0;
    ranker->scale = usable ? scale : 0;
    return 0;
}

static void cells_count(struct ranker *ranker, const double *key) {
    uint32_t *count = ranker->start;
    uint16_t *cell = ranker->cell;
    double lowest = ranker->lowest;
    double scale = ranker->scale;
    memset(count, 0, ranker->cells * sizeof *count);
    for (size_t i = 0; i < ranker->n; i++) {
        uint16_t c = (uint16_t)(int32_t)((key[i] - lowest) * scale);
        cell[i] = c;
        count[c]++;
    }
}

/* Joins cells to buckets. start[] holds the counts of cells on entry, starts of buckets after. */
static void buckets_join(struct ranker *ranker) {
    uint32_t *start = ranker->start;
    uint32_t aim = (uint32_t)(ranker->n / BUCKETS_AIM);
    if (aim < KEYS_A_BUCKET)
        aim = KEYS_A_BUCKET;
    uint32_t total = 0;
    uint32_t held = 0;
    size_t buckets = 0;
    ranker->first[0] = 0;
    for (size_t c = 0; c < ranker->cells; c++) {
        uint32_t count = start[c];
        if (held >= aim) {
            ranker->first[++buckets] = (uint32_t)c;
            total += held;
            held = 0;
        }
        ranker->bucket[c] = (uint16_t)buckets;
        if (held == 0)
            start[buckets] = total;
        held += count;
    }
    ranker->buckets = buckets + 1;
    ranker->first[buckets + 1] = (uint32_t)ranker->cells;
}

static void keys_deal(struct ranker *ranker, const double *key) {
    uint32_t *cursor = ranker->cursor;
    memcpy(cursor, ranker->start, ranker->buckets * sizeof *cursor);
    for (size_t i = 0; i < ranker->n; i++)
        ranker->dealt[cursor[ranker->bucket[ranker->cell[i]]]++] = key[i];
}

static void values_collect(struct ranker *ranker, double *ordered) {
    uint32_t *cursor = ranker->cursor;
    memcpy(cursor, ranker->start, ranker->buckets * sizeof *cursor);
    for (size_t i = 0; i < ranker->n; i++)
        ordered[i] = ranker->dealt[cursor[ranker->bucket[ranker->cell[i]]]++];
}

/* Merges the neighbouring runs from[0..middle) and from[middle..n) of positions into to. */
static void runs_merge(const double *key, const uint32_t *from, size_t middle, size_t n,
                       uint32_t *to) {
    size_t a = 0;
    size_t b = middle;
    for (size_t p = 0; p < n; p++) {
        bool left = b == n || (a < middle && key[from[a]] <= key[from[b]]);
        to[p] = left ? from[a++] : from[b++];
    }
}

/* Sorts positions order[0..n) by their keys, keeping the order of equal ones. */
static void order_merge(const double *key, uint32_t *order, uint32_t *spare, size_t n) {
    uint32_t *from = order;
    uint32_t *to = spare;
    for (size_t width = 1; width < n; width *= 2) {
        bool touched = false;
        for (size_t at = 0; at < n; at += 2 * width) {
            size_t left = n - at < width ? n - at : width;
            size_t both = n - at < 2 * width ? n - at : 2 * width;
            if (left == both || key[from[at + left - 1]] <= key[from[at + left]]) {
                memcpy(to + at, from + at, both * sizeof *to);
            } else {
                runs_merge(key, from + at, left, both, to + at);
                touched = true;
            }
        }
        if (!touched && width == 1) { /* checks whether the keys rise already */
            size_t p = 1;
            while (p < n && key[to[p - 1]] <= key[to[p]])
                p++;
            if (p >= n)
                return;
        }
        uint32_t *swap = from;
        from = to;
        to = swap;
    }
    if (from != order)
        memcpy(order, from, n * sizeof *order);
}

/* Insertion sort of keys that are nearly in order, with their positions. Returns false when it
 * takes too many shifts; then all pairs are still there, and equal keys in order. */
static bool pairs_insert(double *rising, uint32_t *order, size_t n) {
    size_t shifts = SHIFTS_A_KEY * n;
    for (size_t p = 1; p < n; p++) {
        double x = rising[p];
        if (!(x < rising[p - 1]))
            continue;
        uint32_t position = order[p];
        size_t q = p;
        do {
            rising[q] = rising[q - 1];
            order[q] = order[q - 1];
            q--;
        } while (q > 0 && x < rising[q - 1]);
        rising[q] = x;
        order[q] = position;
        if (p - q > shifts)
            return false;
        shifts -= p - q;
    }
    return true;
}

/* Orders the m keys of a bucket of at most KEYS_FAST: rising keys and their positions. */
static void bucket_order_fast(struct ranker *ranker, size_t bucket, const double *key, size_t m) {
    double origin = ranker->first[bucket];
    double width = (double)ranker->first[bucket + 1] - origin;
    size_t cells = FINE_A_KEY * m;
    double stretch = (double)cells * JUST_BELOW_ONE / width;
    uint32_t *count = ranker->count;
    uint32_t *fine = ranker->fine;
    double lowest = ranker->lowest;
    double scale = ranker->scale;
    memset(count, 0, cells * sizeof *count);
    for (size_t p = 0; p < m; p++)
        fine[p] = (uint32_t)(int32_t)(((key[p] - lowest) * scale - origin) * stretch);
    for (size_t p = 0; p < m; p++)
        count[fine[p]]++;
    uint32_t total = 0;
    for (size_t f = 0; f < cells; f++) {
        uint32_t here = count[f];
        count[f] = total;
        total += here;
    }
    for (size_t p = 0; p < m; p++) {
        uint32_t at = count[fine[p]]++;
        ranker->rising[at] = key[p];
        ranker->order[at] = (uint32_t)p;
    }
    if (!pairs_insert(ranker->rising, ranker->order, m)) {
        order_merge(key, ranker->order, ranker->spare, m);
        for (size_t p = 0; p < m; p++)
            ranker->rising[p] = key[ranker->order[p]];
    }
}

static void bucket_order_large(struct ranker *ranker, const double *key, size_t m) {
    for (size_t p = 0; p < m; p++)
        ranker->order[p] = (uint32_t)p;
    order_merge(key, ranker->order, ranker->spare, m);
}

static size_t bucket_count(const struct ranker *ranker, size_t bucket) {
    size_t end = bucket + 1 < ranker->buckets ? ranker->start[bucket + 1] : ranker->n;
    return end - ranker->start[bucket];
}

static int keys_to_buckets(struct ranker *ranker, const double *key, struct error *err) {
    int status = map_set(ranker, key, err);
    if (status != 0)
        return status;
    cells_count(ranker, key);
    buckets_join(ranker);
    keys_deal(ranker, key);
    return 0;
}

int rank_order(struct ranker *ranker, const double *key, const double *sorted, double *ordered,
               struct error *err) {
    int status = keys_to_buckets(ranker, key, err);
    if (status != 0)
        return status;
    for (size_t b = 0; b < ranker->buckets; b++) {
        size_t m = bucket_count(ranker, b);
        double *dealt = ranker->dealt + ranker->start[b];
        const double *value = sorted + ranker->start[b];
        if (m <= KEYS_FAST)
            bucket_order_fast(ranker, b, dealt, m);
        else
            bucket_order_large(ranker, dealt, m);
        for (size_t p = 0; p < m; p++)
            dealt[ranker->order[p]] = value[p];
    }
    values_collect(ranker, ordered);
    return 0;
}

int rank_sort(struct ranker *ranker, double *z, struct error *err) {
    int status = keys_to_buckets(ranker, z, err);
    if (status != 0)
        return status;
    for (size_t b = 0; b < ranker->buckets; b++) {
        size_t m = bucket_count(ranker, b);
        const double *dealt = ranker->dealt + ranker->start[b];
        double *out = z + ranker->start[b];
        if (m <= KEYS_FAST) {
            bucket_order_fast(ranker, b, dealt, m);
            memcpy(out, ranker->rising, m * sizeof *out);
        } else {
            bucket_order_large(ranker, dealt, m);
            for (size_t p = 0; p < m; p++)
                out[p] = dealt[ranker->order[p]];
        }
    }
    return 0;
}
