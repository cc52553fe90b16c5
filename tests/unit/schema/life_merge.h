/* A merger for the test of the life cycle: what a job kind does with the stored blocks of a case.
 */
#ifndef RUGO_TESTS_UNIT_SCHEMA_LIFE_MERGE_H
#define RUGO_TESTS_UNIT_SCHEMA_LIFE_MERGE_H

#include "schema/store/store.h"
#include "tests/support/check.h"

struct sum {
    double value;
    int64_t realisations;
    cJSON *first, *count;
};

static inline int add_block(void *context, const struct block_result *block, struct error *err) {
    struct sum *sum = context;
    (void)err;
    for (uint64_t r = 0; r < block->count; r++)
        sum->value += block->scalars[2 * r];
    sum->realisations += (int64_t)block->count;
    cJSON_AddItemToArray(sum->first, cJSON_CreateNumber((double)block->first));
    cJSON_AddItemToArray(sum->count, cJSON_CreateNumber((double)block->count));
    return 0;
}

/* The merged results of a case, as its kind would make them: one scalar, one curve. */
static inline cJSON *merge(struct store *store, const struct due_case *due) {
    struct sum sum = {.first = cJSON_CreateArray(), .count = cJSON_CreateArray()};
    cJSON *document = cJSON_CreateObject(), *curve = cJSON_CreateObject();
    assert_int_equal(store_results(store, due->study, due->case_number, add_block, &sum, NULL), 0);
    cJSON *scalar = cJSON_AddObjectToObject(cJSON_AddObjectToObject(document, "scalars"), "sum");
    cJSON_AddNumberToObject(scalar, "value", sum.value);
    cJSON_AddNumberToObject(scalar, "standard_error", (double)sum.realisations);
    cJSON_AddStringToObject(curve, "quantity", "blocks");
    cJSON_AddStringToObject(curve, "series", "");
    cJSON_AddItemToObject(curve, "x", sum.first);
    cJSON_AddItemToObject(curve, "y", sum.count);
    cJSON_AddItemToArray(cJSON_AddArrayToObject(document, "curves"), curve);
    cJSON_AddNumberToObject(document, "realisations", (double)sum.realisations);
    return document;
}

#endif
