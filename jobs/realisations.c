#include "jobs/realisations.h"
#include <stdlib.h>
#include <string.h>

void realisations_clear(struct realisations *set) {
    for (size_t b = 0; b < set->block_count; b++)
        free(set->blocks[b].scalars);
    free(set->blocks);
    *set = (struct realisations){.scalar_count = set->scalar_count};
}

/* Returns the index of the first block that starts at or behind `first`. */
static size_t first_block_from(const struct realisations *set, uint64_t first) {
    size_t low = 0, high = set->block_count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (set->blocks[middle].first < first)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

int realisations_check(const struct realisations *set, const struct block_result *result,
                       struct error *err) {
    if (result->scalar_count != set->scalar_count || result->scalars == NULL)
        return error_set(err, ERROR_INPUT, "the result has %zu scalars a realisation, not %zu",
                         result->scalar_count, set->scalar_count);
    if (result->count == 0 || result->first > UINT64_MAX - result->count)
        return error_set(err, ERROR_INPUT, "the result holds no realisation");
    if (set->block_count == 0)
        return 0;
    size_t index = first_block_from(set, result->first);
    const struct realisation_block *next = set->blocks + index;
    if (index < set->block_count && next->first - result->first < result->count)
        return error_set(err, ERROR_INPUT, "realisation %llu is there already",
                         (unsigned long long)next->first);
    if (index > 0 && result->first - next[-1].first < next[-1].count)
        return error_set(err, ERROR_INPUT, "realisation %llu is there already",
                         (unsigned long long)result->first);
    return 0;
}

int realisations_add(struct realisations *set, const struct block_result *result,
                     struct error *err) {
    if (set->block_count == set->capacity) {
        size_t capacity = set->capacity == 0 ? 16 : 2 * set->capacity;
        struct realisation_block *blocks = realloc(set->blocks, capacity * sizeof *blocks);
        if (blocks == NULL)
            return error_memory(err, capacity * sizeof *blocks, "blocks of realisations");
        set->blocks = blocks;
        set->capacity = capacity;
    }
    size_t row = set->scalar_count * sizeof(double);
    double *scalars = array_create((size_t)result->count, row);
    if (scalars == NULL)
        return error_memory(err, (size_t)result->count * row, "scalars of realisations");
    memcpy(scalars, result->scalars, (size_t)result->count * row);
    size_t index = first_block_from(set, result->first);
    memmove(set->blocks + index + 1, set->blocks + index,
            (set->block_count - index) * sizeof *set->blocks);
    set->blocks[index] = (struct realisation_block){result->first, result->count, scalars};
    set->block_count++;
    set->count += result->count;
    return 0;
}

void realisations_column(const struct realisations *set, size_t scalar, double *out) {
    for (size_t b = 0; b < set->block_count; b++)
        for (uint64_t r = 0; r < set->blocks[b].count; r++)
            *out++ = set->blocks[b].scalars[r * set->scalar_count + scalar];
}
