/* Blocks that mergers take or refuse, for tests of kinds of jobs. */
#ifndef RUGO_TESTS_SUPPORT_MERGING_H
#define RUGO_TESTS_SUPPORT_MERGING_H

#include "jobs/merger.h"
#include "jobs/runner.h"
#include "tests/support/result_tree.h"
#include <stdlib.h>
#include <string.h>

static inline struct block_result run(struct job_runner *runner, uint64_t first, uint64_t count) {
    struct block_result result = {0};
    struct error err = {0};
    if (runner_run(runner, first, count, NULL, &result, &err) != 0)
        fail_msg("%s", err.text);
    return result;
}

static inline void merge(struct job_merger *merger, const struct block_result *result) {
    struct error err = {0};
    if (merger_add(merger, result, &err) != 0)
        fail_msg("%s", err.text);
}

static inline cJSON *curves_of(struct job_merger *merger) {
    cJSON *document = NULL;
    struct error err = {0};
    if (merger_tree(merger, NULL, NULL, &document, &err) != 0)
        fail_msg("%s", err.text);
    return document;
}

static inline char *text_of(struct job_merger *merger) {
    cJSON *document = curves_of(merger);
    char *text = cJSON_PrintUnformatted(document);
    assert_non_null(text);
    cJSON_Delete(document);
    return text;
}

static inline void assert_refused(struct job_merger *merger, const struct block_result *result,
                                  const char *words) {
    struct error err = {0};
    int status = merger_add(merger, result, &err);
    if (status != ERROR_INPUT || strstr(err.text, words) == NULL)
        fail_msg("'%s' expected, but status %d, '%s'", words, status, err.text);
}

/* The block is refused cut short at about `cuts` sizes, and with one of its bits changed, of about
 * 800 of them; it is as it was afterwards. */
static inline void assert_damaged_are_refused(struct job_merger *merger,
                                              const struct block_result *next, size_t cuts) {
    struct block_result bad = *next;
    unsigned char *data = (unsigned char *)next->data;
    for (bad.size = 0; bad.size < next->size; bad.size += 1 + next->size / cuts)
        assert_refused(merger, &bad, "the partial result");
    for (size_t bit = 0; bit < 8 * next->size; bit += 1 + next->size / 97) {
        data[bit / 8] ^= (unsigned char)(1u << (bit % 8));
        assert_refused(merger, next, "the partial result");
        data[bit / 8] ^= (unsigned char)(1u << (bit % 8));
    }
}

#endif
