/* A merger for the test of the life cycle: what a job kind does with the stored blocks of a case.
 */
#ifndef RUGO_TESTS_UNIT_SCHEMA_LIFE_MERGE_H
#define RUGO_TESTS_UNIT_SCHEMA_LIFE_MERGE_H

#include "schema/result/result.h"
#include "schema/store/store.h"
#include "tests/support/check.h"
#include "tests/support/life_model.h"

struct life_sum {
    double value, *first, *count; /* LIFE_MOST each */
    size_t blocks;
    uint64_t realisations;
};

static inline int add_block(void *context, const struct block_result *block, struct error *err) {
    struct life_sum *sum = context;
    (void)err;
    assert_true(sum->blocks < LIFE_MOST);
    for (uint64_t r = 0; r < block->count; r++)
        sum->value += block->scalars[2 * r];
    sum->realisations += block->count;
    sum->first[sum->blocks] = (double)block->first;
    sum->count[sum->blocks++] = (double)block->count;
    return 0;
}

/* The merged results of a case, as its kind would make them: one scalar, one curve. */
static inline void merge(struct store *store, const struct due_case *due, struct case_result *out) {
    struct life_sum sum = {.first = result_numbers(out, LIFE_MOST),
                           .count = result_numbers(out, LIFE_MOST)};
    double *errors = result_numbers(out, LIFE_MOST);
    assert_true(sum.first != NULL && sum.count != NULL && errors != NULL);
    assert_int_equal(store_results(store, due->study, due->case_number, add_block, &sum, NULL), 0);
    const struct scalar scalar = scalar_named("sum", sum.value, (double)sum.realisations, NAN);
    struct curve curve = curve_named("blocks", "first", "count");
    curve_set_points(&curve, sum.blocks, sum.first, sum.count, errors);
    assert_int_equal(result_add_scalar(out, &scalar, NULL), 0);
    assert_int_equal(result_add_curve(out, &curve, NULL), 0);
    out->realisations = sum.realisations;
}

#endif
