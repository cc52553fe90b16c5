#include "jobs/pairs.h"
#include "jobs/estimate.h"
#include "jobs/realisations.h"
#include "jobs/tally.h"
#include "schema/result/difference.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* One of the two cases. */
struct side {
    const struct job_merger *merger; /* borrowed */
    size_t all;                      /* its realisations */
    size_t *position;                /* owned: index among all of each in common */
    double *x, *weight;              /* owned: scratch, a value a realisation in common */
    double *scratch;                 /* owned: 2 * all */
};
struct pairs {
    struct side a, b;
    size_t count;     /* realisations in common */
    struct error err; /* of the first failure of a call back; code 0: none */
};

static void side_clear(struct side *side) {
    free(side->position);
    free(side->x);
    free(side->weight);
    free(side->scratch);
}

static int side_create(struct side *side, const struct job_merger *merger, size_t most,
                       struct error *err) {
    size_t all = (size_t)merger_realisations(merger)->count;
    *side = (struct side){.merger = merger,
                          .all = all,
                          .position = array_create(most, sizeof *side->position),
                          .x = array_create(most, sizeof *side->x),
                          .weight = array_create(most, sizeof *side->weight),
                          .scratch = array_create(2 * all, sizeof *side->scratch)};
    if (side->position != NULL && side->x != NULL && side->weight != NULL && side->scratch != NULL)
        return 0;
    return error_memory(err, 2 * all * sizeof(double), "pairs of realisations");
}

/* The position in a walk through all realisations of a set. */
struct walk {
    const struct realisations *set;
    size_t block, position;
    uint64_t within;
};

static bool walk_at(const struct walk *walk, uint64_t *realisation) {
    if (walk->block == walk->set->block_count)
        return false;
    *realisation = walk->set->blocks[walk->block].first + walk->within;
    return true;
}

static void walk_on(struct walk *walk) {
    walk->position++;
    if (++walk->within == walk->set->blocks[walk->block].count) {
        walk->block++;
        walk->within = 0;
    }
}

static void find_common(struct pairs *pairs) {
    struct walk a = {.set = merger_realisations(pairs->a.merger)};
    struct walk b = {.set = merger_realisations(pairs->b.merger)};
    uint64_t one, other;
    while (walk_at(&a, &one) && walk_at(&b, &other)) {
        if (one == other) {
            pairs->a.position[pairs->count] = a.position;
            pairs->b.position[pairs->count++] = b.position;
        }
        bool first = one <= other, second = other <= one;
        if (first)
            walk_on(&a);
        if (second)
            walk_on(&b);
    }
}

/* --- call backs of difference_make --- */

static void set_value(const struct pairs *pairs, bool weighed, struct paired_value *out) {
    const struct estimate_column a = {pairs->a.x, weighed ? pairs->a.weight : NULL};
    const struct estimate_column b = {pairs->b.x, weighed ? pairs->b.weight : NULL};
    struct pair_estimate estimate = estimate_pairs(pairs->count, &a, &b);
    *out = (struct paired_value){.value = estimate.value,
                                 .standard_error = estimate.standard_error,
                                 .deviation = estimate.deviation,
                                 .pairs = estimate.pairs,
                                 .lacking = pairs->count - estimate.pairs};
}

static bool take_point(const struct pairs *pairs, struct side *side, const struct curve *curve,
                       size_t at) {
    struct point_values values;
    if (!merger_point(side->merger, curve, at, &values))
        return false;
    for (size_t r = 0; r < pairs->count; r++)
        side->x[r] = values.values[side->position[r] * values.stride];
    return true;
}

/* Compares by groups, which are pairs where both cases have the same realisations. Points with
 * something counted in too few groups take the error of independent cases, which is known even
 * where nothing was counted. */
static bool compare_groups(const struct pairs *pairs, const struct curve *minuend, size_t a,
                           const struct curve *subtrahend, size_t b, struct paired_value *out) {
    struct point_groups one, other;
    if (pairs->count != pairs->a.all || pairs->count != pairs->b.all ||
        !merger_groups(pairs->a.merger, minuend, a, &one) ||
        !merger_groups(pairs->b.merger, subtrahend, b, &other))
        return false;
    const struct estimate_groups left = {one.counted, one.things};
    const struct estimate_groups right = {other.counted, other.things};
    struct pair_estimate estimate = estimate_group_pairs(POINT_GROUPS, &left, &right);
    *out = (struct paired_value){.value = estimate.value,
                                 .standard_error = estimate.standard_error,
                                 .deviation = estimate.deviation,
                                 .pairs = pairs->count,
                                 .effective = (double)estimate.pairs};
    if (one.informative < TALLY_RARE || other.informative < TALLY_RARE) {
        out->standard_error = hypot(minuend->standard_error[a], subtrahend->standard_error[b]);
        out->effective = 0;
    }
    return true;
}

static bool point(void *context, const struct curve *minuend, size_t a,
                  const struct curve *subtrahend, size_t b, struct paired_value *out) {
    struct pairs *pairs = context;
    if (!take_point(pairs, &pairs->a, minuend, a) || !take_point(pairs, &pairs->b, subtrahend, b))
        return compare_groups(pairs, minuend, a, subtrahend, b, out);
    set_value(pairs, false, out);
    return true;
}

static int take_scalar(const struct pairs *pairs, struct side *side, size_t scalar,
                       struct error *err) {
    double *values = side->scratch, *weights = side->scratch + side->all;
    int status = merger_scalar(side->merger, scalar, values, weights, err);
    for (size_t r = 0; r < pairs->count && status == 0; r++) {
        side->x[r] = values[side->position[r]];
        side->weight[r] = weights[side->position[r]];
    }
    return status;
}

static bool scalar(void *context, const char *name, struct paired_value *out) {
    struct pairs *pairs = context;
    size_t number;
    if (pairs->err.code != 0 || !merger_find_scalar(pairs->a.merger, name, &number) ||
        take_scalar(pairs, &pairs->a, number, &pairs->err) != 0 ||
        take_scalar(pairs, &pairs->b, number, &pairs->err) != 0)
        return false;
    set_value(pairs, true, out);
    return true;
}

/* --- all --- */

static int make(struct pairs *pairs, const struct case_result *minuend,
                const struct case_result *subtrahend, struct case_result *out, struct error *err) {
    const struct difference_pairs by = {pairs, point, scalar};
    find_common(pairs);
    if (pairs->count == 0)
        return error_set(err, ERROR_INPUT, "cases %llu and %llu have no realisation in common yet",
                         (unsigned long long)minuend->case_number,
                         (unsigned long long)subtrahend->case_number);
    int status = difference_make(minuend, subtrahend, &by, out, err);
    if (status == 0 && pairs->err.code != 0) {
        result_clear(out);
        *err = pairs->err;
        status = err->code;
    }
    out->realisations = pairs->count;
    return status;
}

int pairs_difference(const struct job_merger *minuend, const struct case_result *minuend_result,
                     const struct job_merger *subtrahend,
                     const struct case_result *subtrahend_result, bool common,
                     struct case_result *out, struct error *err) {
    uint64_t a = minuend_result->realisations, b = subtrahend_result->realisations;
    struct pairs pairs = {0};
    if (!common) {
        int status = difference_make(minuend_result, subtrahend_result, NULL, out, err);
        out->realisations = status != 0 ? 0 : a < b ? a : b;
        result_sampled(out, out->realisations);
        return status;
    }
    int status = side_create(&pairs.a, minuend, (size_t)(a < b ? a : b), err);
    if (status == 0)
        status = side_create(&pairs.b, subtrahend, (size_t)(a < b ? a : b), err);
    if (status == 0)
        status = make(&pairs, minuend_result, subtrahend_result, out, err);
    result_sampled(out, out->realisations);
    side_clear(&pairs.a);
    side_clear(&pairs.b);
    return status;
}
