#include "worker/publish/comparison.h"
#include "jobs/pairs.h"
#include "jobs/units.h"
#include "schema/result/result_json.h"
#include "worker/publish/aggregate.h"
#include <stdio.h>
#include <stdlib.h>

/* One of the two cases. */
struct compared {
    struct job_merger *merger; /* owned */
    struct case_result result; /* owned */
};

static void compared_clear(struct compared *compared) {
    merger_destroy(&compared->merger);
    result_clear(&compared->result);
}

/* The answer to a target is computed from several cases, whose realisations are no pairs. */
static int refuse_target(struct store *store, const char *study, uint64_t case_number,
                         struct error *err) {
    struct component *components = NULL;
    size_t count = 0;
    int status = store_components(store, study, case_number, &components, &count, err);
    components_free(components, count);
    return status != 0 || count == 0
               ? status
               : error_set(err, ERROR_INPUT,
                           "case %llu asks for an error, and has no realisations of its own to "
                           "compare",
                           (unsigned long long)case_number);
}

static int read_case(struct store *store, const struct aggregate *aggregate, uint64_t case_number,
                     const char *quantity, struct compared *out, struct error *err) {
    struct case_info info = {0};
    int status = store_case(store, aggregate->about.id, case_number, &info, err);
    if (status != 0)
        return status;
    status = refuse_target(store, aggregate->about.id, case_number, err);
    if (status == 0 && info.realisations_done == 0)
        status = error_set(err, ERROR_STATE, "case %llu has no realisations yet",
                           (unsigned long long)case_number);
    if (status == 0)
        status =
            aggregate_merge(store, aggregate, case_number, &info, &out->merger, &out->result, err);
    if (status == 0)
        status = result_set_parameters(&out->result, info.parameters, err);
    if (status == 0)
        units_set(&out->result);
    out->result.case_number = case_number;
    if (status == 0 && quantity != NULL && result_curve(&out->result, quantity) == NULL)
        status = quantity_absent(&out->result, quantity, err);
    result_keep(&out->result, quantity, false);
    case_info_clear(&info);
    return status;
}

/* Puts a remark on the realisations before that on missing curves. */
static int add_remark(const struct compared *a, const struct compared *b, bool common,
                      struct case_result *out, struct error *err) {
    uint64_t one = a->result.realisations, other = b->result.realisations;
    const char *rest = out->remark != NULL ? out->remark : "", *more = *rest != '\0' ? "; " : "";
    char *text = NULL;
    int length = 0;
    if (!common)
        length = asprintf(&text, "the cases are independent: errors are not those of pairs%s%s",
                          more, rest);
    else if (out->realisations < one || out->realisations < other)
        length = asprintf(&text, "%llu realisations in common of %llu and %llu%s%s",
                          (unsigned long long)out->realisations, (unsigned long long)one,
                          (unsigned long long)other, more, rest);
    else
        return 0;
    out->remark = length >= 0 ? result_text(out, text) : NULL;
    if (length >= 0)
        free(text);
    return out->remark != NULL ? 0 : error_memory(err, 0, "a remark");
}

static int subtract(const struct compared *a, const struct compared *b, bool common,
                    const char *quantity, struct case_result *out, struct error *err) {
    int status = pairs_difference(a->merger, &a->result, b->merger, &b->result, common, out, err);
    if (status == 0 && quantity != NULL && out->curve_count == 0)
        status = error_set(err, ERROR_INPUT, "cases %llu and %llu cannot be compared: %.300s",
                           (unsigned long long)a->result.case_number,
                           (unsigned long long)b->result.case_number, out->remark);
    return status != 0 ? status : add_remark(a, b, common, out, err);
}

static int make(struct store *store, const struct aggregate *aggregate,
                const struct comparison *comparison, struct study_result *out, struct error *err) {
    bool common = aggregate->about.random == RANDOM_COMMON;
    struct compared a = {0}, b = {0};
    out->cases = array_create(1, sizeof *out->cases);
    int status = aggregate_head(store, aggregate, out, err);
    if (status == 0 && out->cases == NULL)
        status = error_memory(err, sizeof *out->cases, "a difference");
    if (status != 0)
        return status;
    out->case_count = 1;
    status = read_case(store, aggregate, comparison->minuend, comparison->quantity, &a, err);
    if (status == 0)
        status = read_case(store, aggregate, comparison->subtrahend, comparison->quantity, &b, err);
    if (status == 0)
        status = subtract(&a, &b, common, comparison->quantity, &out->cases[0], err);
    compared_clear(&a);
    compared_clear(&b);
    return status;
}

int comparison_make(struct store *store, const char *study, const struct comparison *comparison,
                    struct study_result *out, struct error *err) {
    struct aggregate aggregate;
    struct study_result result = {0};
    if (comparison->minuend == comparison->subtrahend)
        return error_set(err, ERROR_INPUT, "case %llu less itself is nothing: name two cases",
                         (unsigned long long)comparison->minuend);
    int status = aggregate_begin(store, study, &aggregate, err);
    if (status != 0)
        return status;
    status = make(store, &aggregate, comparison, &result, err);
    aggregate_end(&aggregate);
    if (status != 0)
        study_result_clear(&result);
    else
        *out = result;
    return status;
}
