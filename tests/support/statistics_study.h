/* Small studies of statistics, run block by block, and their results as the trees that people
 * get. */
#ifndef RUGO_TESTS_SUPPORT_STATISTICS_STUDY_H
#define RUGO_TESTS_SUPPORT_STATISTICS_STUDY_H

#include "jobs/kind.h"
#include "jobs/merger.h"
#include "jobs/runner.h"
#include "schema/json/json.h"
#include "tests/support/merging.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { REALISATIONS = 24, STUDY_SEED = 5, STUDY_CASE = 2 };

static const char GAUSSIAN[] =
    "{\"surface\": {\"hurst\": 0.8, \"wavelength_ratio\": 4, \"length_ratio\": 2,"
    " \"points_per_wavelength\": 4, \"rms_slope\": 0.1},"
    " \"statistics\": {\"bins\": {\"height\": [0, 2, 10], \"curvature\": [-9, -1, 16]}}}";
static const char WEIBULL[] =
    "{\"surface\": {\"hurst\": 0.4, \"wavelength_ratio\": 4, \"length_ratio\": 2,"
    " \"points_per_wavelength\": 4, \"heights\": {\"distribution\": \"weibull_max\", \"shape\": 2,"
    " \"keep\": \"heights\"}}, \"statistics\": {\"summits\": \"five_point\"}}";
static const char PROFILE[] =
    "{\"surface\": {\"dimension\": 1, \"hurst\": 0.6, \"wavelength_ratio\": 16},"
    " \"statistics\": {\"summits\": \"refined\"}}";
static const char LEVELS[] =
    "{\"surface\": {\"hurst\": 0.8, \"wavelength_ratio\": 4, \"length_ratio\": 2,"
    " \"points_per_wavelength\": 4}, \"statistics\": {\"levels\": [2]}}";
static const char *const STUDIES[] = {GAUSSIAN, WEIBULL, PROFILE, LEVELS};
enum { STUDY_COUNT = 4 };

static inline const struct job_kind *statistics_kind(void) {
    return kind_find("statistics");
}

static inline cJSON *parse(const char *text) {
    cJSON *parameters = cJSON_Parse(text);
    assert_non_null(parameters);
    return parameters;
}

static inline struct job_runner *runner_of(const char *study) {
    struct job_runner *runner = NULL;
    struct error err = {0};
    cJSON *parameters = parse(study);
    if (runner_create(&runner, statistics_kind(), parameters, NULL, STUDY_SEED, STUDY_CASE, &err) !=
        0)
        fail_msg("%s", err.text);
    cJSON_Delete(parameters);
    return runner;
}

static inline struct job_merger *merger_of(const char *study) {
    struct job_merger *merger = NULL;
    struct error err = {0};
    cJSON *parameters = parse(study);
    if (merger_create(&merger, statistics_kind(), parameters, &err) != 0)
        fail_msg("%s", err.text);
    cJSON_Delete(parameters);
    return merger;
}

static inline const cJSON *curve_of(const cJSON *document, const char *quantity) {
    const cJSON *curve;
    cJSON_ArrayForEach(curve, json_at(document, "/curves")) {
        if (strcmp(json_at(curve, "/quantity")->valuestring, quantity) == 0)
            return curve;
    }
    fail_msg("no curve %s", quantity);
    return NULL;
}

static inline double at(const cJSON *curve, const char *key, int point) {
    const cJSON *value = cJSON_GetArrayItem(json_at(curve, key), point);
    assert_non_null(value);
    return cJSON_IsNumber(value) ? value->valuedouble : NAN;
}

static inline double scalar(const cJSON *document, const char *name, const char *what) {
    char pointer[100];
    snprintf(pointer, sizeof pointer, "/scalars/%s/%s", name, what);
    const cJSON *value = json_at(document, pointer);
    return cJSON_IsNumber(value) ? value->valuedouble : NAN;
}

#endif
