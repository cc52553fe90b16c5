/* Results as the JSON trees that people get, for tests that look into those. */
#ifndef RUGO_TESTS_SUPPORT_RESULT_TREE_H
#define RUGO_TESTS_SUPPORT_RESULT_TREE_H

#include "jobs/merger.h"
#include "schema/result/report.h"
#include "schema/result/result_json.h"
#include "tests/support/check.h"
#include <stdlib.h>

static inline cJSON *tree_of_text(FILE *file, bool done, char **text) {
    assert_true(done);
    assert_int_equal(fclose(file), 0);
    cJSON *tree = cJSON_Parse(*text);
    assert_non_null(tree);
    free(*text);
    return tree;
}

static inline cJSON *result_tree(const struct case_result *result) {
    char *text = NULL;
    size_t size = 0;
    FILE *file = open_memstream(&text, &size);
    assert_non_null(file);
    return tree_of_text(file, result_print(file, result), &text);
}

static inline cJSON *study_tree(const struct study_result *study) {
    char *text = NULL;
    size_t size = 0;
    FILE *file = open_memstream(&text, &size);
    assert_non_null(file);
    return tree_of_text(file, study_print(file, study), &text);
}

static inline cJSON *report_tree(const struct study_report *report) {
    char *text = NULL;
    size_t size = 0;
    FILE *file = open_memstream(&text, &size);
    assert_non_null(file);
    return tree_of_text(file, study_report_print(file, report), &text);
}

/* What a merger holds, as a tree; parameters (may be NULL): with the theories that are made on
 * demand. */
static inline int merger_tree(const struct job_merger *merger, const struct job_kind *kind,
                              const cJSON *parameters, cJSON **out, struct error *err) {
    struct case_result result = {0};
    int status = merger_result(merger, &result, err);
    if (status == 0 && parameters != NULL)
        status = merger_complete(kind, parameters, &result, err);
    if (status == 0)
        *out = result_tree(&result);
    result_clear(&result);
    return status;
}

#endif
