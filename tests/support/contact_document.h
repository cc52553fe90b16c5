/* Contact studies run in one go, and their curves. */
#ifndef RUGO_TESTS_SUPPORT_CONTACT_DOCUMENT_H
#define RUGO_TESTS_SUPPORT_CONTACT_DOCUMENT_H

#include "jobs/kind.h"
#include "jobs/merger.h"
#include "jobs/runner.h"
#include "schema/json/json.h"
#include "tests/support/result_tree.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

enum { CONTACT_SEED = 11 };

/* The document of so many realisations from the first one on. */
static inline cJSON *solve_from(const char *study, uint64_t first, uint64_t count) {
    const struct job_kind *kind = kind_find("contact");
    struct job_runner *runner = NULL;
    struct job_merger *merger = NULL;
    struct block_result result = {0};
    struct error err = {0};
    cJSON *document = NULL, *parameters = cJSON_Parse(study);
    assert_non_null(parameters);
    if (runner_create(&runner, kind, parameters, NULL, CONTACT_SEED, 0, &err) != 0 ||
        merger_create(&merger, kind, parameters, &err) != 0 ||
        runner_run(runner, first, count, NULL, &result, &err) != 0 ||
        merger_add(merger, &result, &err) != 0 ||
        merger_tree(merger, NULL, NULL, &document, &err) != 0)
        fail_msg("%s: %s", study, err.text);
    block_result_clear(&result);
    runner_destroy(&runner);
    merger_destroy(&merger);
    cJSON_Delete(parameters);
    return document;
}

/* The document of realisations 0 .. count - 1. */
static inline cJSON *solve(const char *study, uint64_t count) {
    return solve_from(study, 0, count);
}

static inline bool text_is(const cJSON *object, const char *key, const char *text) {
    const cJSON *value = json_at(object, key);
    return cJSON_IsString(value) && strcmp(value->valuestring, text) == 0;
}

/* The first curve of that name: finest level. model NULL: a curve of none. */
static inline const cJSON *curve_of(const cJSON *document, const char *quantity, const char *series,
                                    const char *model) {
    const cJSON *curve;
    cJSON_ArrayForEach(curve, json_at(document, "/curves")) {
        if (text_is(curve, "/quantity", quantity) && text_is(curve, "/series", series) &&
            (model == NULL || text_is(curve, "/model", model)))
            return curve;
    }
    fail_msg("no curve %s of %s, %s", quantity, series, model != NULL ? model : "no model");
    return NULL;
}

static inline int points(const cJSON *curve) {
    return cJSON_GetArraySize(json_at(curve, "/x"));
}

static inline double at(const cJSON *curve, const char *key, int point) {
    const cJSON *value = cJSON_GetArrayItem(json_at(curve, key), point);
    return cJSON_IsNumber(value) ? value->valuedouble : NAN;
}

static inline void assert_near(double value, double expected, double tolerance, double load) {
    if (!(fabs(value - expected) <= tolerance))
        fail_msg("%.17g at load %g, expected %.17g within %g", value, load, expected, tolerance);
}

/* The document of realisations 0 .. count - 1 in blocks of `block`, which the caller frees. *bytes:
 * of their results; may be NULL. */
static inline char *in_blocks(const char *study, uint64_t count, uint64_t block, size_t *bytes) {
    const struct job_kind *kind = kind_find("contact");
    struct job_runner *runner = NULL;
    struct job_merger *merger = NULL;
    struct error err = {0};
    cJSON *parameters = cJSON_Parse(study), *document = NULL;
    size_t size = 0;
    assert_non_null(parameters);
    if (runner_create(&runner, kind, parameters, NULL, CONTACT_SEED, 0, &err) != 0 ||
        merger_create(&merger, kind, parameters, &err) != 0)
        fail_msg("%s: %s", study, err.text);
    for (uint64_t first = 0; first < count; first += block) {
        struct block_result result = {0};
        if (runner_run(runner, first, block, NULL, &result, &err) != 0 ||
            merger_add(merger, &result, &err) != 0)
            fail_msg("%s: %s", study, err.text);
        size += result.size;
        block_result_clear(&result);
    }
    if (merger_tree(merger, NULL, NULL, &document, &err) != 0)
        fail_msg("%s: %s", study, err.text);
    char *text = cJSON_PrintUnformatted(document);
    cJSON_Delete(document);
    cJSON_Delete(parameters);
    runner_destroy(&runner);
    merger_destroy(&merger);
    if (bytes != NULL)
        *bytes = size;
    return text;
}

#endif
