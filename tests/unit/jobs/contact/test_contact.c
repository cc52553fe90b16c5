/* The kind "contact" from parameters to curves: any split into blocks and any order of merging
 * gives the same document. Foreign and damaged results are refused whole. Means, errors and paired
 * differences are those that the realisations themselves give. */
#include "core/statistics/uncertainty/richardson.h"
#include "jobs/kind.h"
#include "jobs/merger.h"
#include "jobs/runner.h"
#include "schema/json/json.h"
#include "schema/result/bytes/bytes.h"
#include "tests/support/effort.h"
#include "tests/support/merging.h"
#include "tests/support/seed.h"
#include <limits.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { REALISATIONS = 12, SEED = 5, CASE = 2 };
static const double EDGE_ORDER = 2;

static const char LEVELS[] = /* three levels, two models */
    "{\"surface\": {\"dimension\": 1, \"hurst\": 0.8, \"wavelength_ratio\": 4, \"length_ratio\": 2,"
    " \"points_per_wavelength\": 8},"
    " \"contact\": {\"model\": [\"layered\", \"halfspace\"], \"levels\": [2, 4, 8],"
    " \"pressures\": {\"values\": [0.01, 0.1, 0.3]}, \"pressure_pdf\": {\"at\": [0.1, 0.3],"
    " \"bins\": [0.2, 1, 8]}}}";
static const char SURFACE[] =
    "{\"surface\": {\"hurst\": 0.4, \"wavelength_ratio\": 2, \"length_ratio\": 2,"
    " \"points_per_wavelength\": 4, \"heights\": {\"distribution\": \"weibull_max\", \"shape\": "
    "2}},"
    " \"contact\": {\"cell_error\": \"none\", \"pressures\": {\"to\": 0.2, \"steps\": 2}}}";
/* The last load is beyond full contact: no stiffness there. */
static const char FULL[] = "{\"surface\": {\"dimension\": 1, \"hurst\": 0.8, \"wavelength_ratio\": "
                           "2, \"length_ratio\": 1},"
                           " \"contact\": {\"pressures\": {\"values\": [1e-7, 0.2, 50]}}}";
/* Three models, and a slope at which the one on the true geometry finds no answer to some loads in
 * its time.
 * Errors of cells are for studies that are cheaper. */
static const char STEEP[] =
    "{\"surface\": {\"dimension\": 1, \"hurst\": 0.8, \"wavelength_ratio\": 2, \"length_ratio\":"
    " 2, \"points_per_wavelength\": 4, \"rms_slope\": 1.6}, \"contact\": {\"model\":"
    " [\"full\", \"halfspace\", \"layered\"], \"levels\": [2, 4], \"block_height\": {\"lengths\":"
    " 1}, \"cell_error\": \"none\", \"time_limit\": 0.05, \"pressures\": {\"to\": 0.5, \"steps\": "
    "3}}}";
/* The flat is dragged at finite strain. */
static const char SLIDING[] =
    "{\"surface\": {\"dimension\": 1, \"hurst\": 0.8, \"wavelength_ratio\": 4, \"length_ratio\": 2,"
    " \"points_per_wavelength\": 4, \"rms_slope\": 0.1}, \"contact\": {\"model\": \"full\", "
    "\"friction\":"
    " 0.3, \"slip\": {\"to\": [0.6], \"steps\": 12}, \"pressures\": {\"values\": [0.1]}}}";
/* Sub-maps are pressed beside a measured surface. */
static const char LIKE[] =
    "{\"surface\": {\"dimension\": 1, \"hurst\": 0.8, \"wavelength_ratio\": 4, \"length_ratio\": 4,"
    " \"points_per_wavelength\": 4, \"rms_slope\": 0.1, \"like\": {\"file\": \"x\", \"sha256\":"
    " \"00112233445566778899aabbccddeeff00112233445566778899aabbccddeeff\", \"spacing\": 0.25,"
    " \"points\": [30], \"detrend\": \"plane\", \"contact_loads\": [0.1, 0.2], \"contact_scale\": "
    "0.1,"
    " \"contact_areas\": [0.2, 0.4], \"contact_gaps\": [0.5, 0.2]}},"
    " \"contact\": {\"pressures\": {\"values\": [0.1, 0.2]}}}";
/* Realisations, and how many orders of blocks of them are tried: cells of other
 * lengths and steep surfaces take long. */
enum { STEEP_REALISATIONS = 5 };
static const struct {
    const char *study;
    uint64_t count;
    int trials;
} STUDIES[] = {{LEVELS, REALISATIONS, 2},
               {SURFACE, REALISATIONS, 3},
               {FULL, REALISATIONS, 1},
               {STEEP, STEEP_REALISATIONS, 2},
               {LIKE, REALISATIONS, 3}};
enum { STUDY_COUNT = 5 };

static const struct job_kind *kind(void) {
    return kind_find("contact");
}

static cJSON *parse(const char *text) {
    cJSON *parameters = cJSON_Parse(text);
    assert_non_null(parameters);
    return parameters;
}

static struct job_shared *shared_of(const char *study) {
    struct job_shared *shared = NULL;
    struct error err = {0};
    cJSON *parameters = parse(study);
    if (job_shared_create(&shared, kind(), parameters, &err) != 0)
        fail_msg("%s", err.text);
    cJSON_Delete(parameters);
    return shared;
}

/* shared: NULL for a runner with its own. */
static struct job_runner *runner_of(const char *study, const struct job_shared *shared) {
    struct job_runner *runner = NULL;
    struct error err = {0};
    cJSON *parameters = parse(study);
    if (runner_create(&runner, kind(), parameters, shared, SEED, CASE, &err) != 0)
        fail_msg("%s", err.text);
    cJSON_Delete(parameters);
    return runner;
}

static struct job_merger *merger_of(const char *study) {
    struct job_merger *merger = NULL;
    struct error err = {0};
    cJSON *parameters = parse(study);
    if (merger_create(&merger, kind(), parameters, &err) != 0)
        fail_msg("%s", err.text);
    cJSON_Delete(parameters);
    return merger;
}

/* The document of realisations 0 .. count - 1. */
static cJSON *document_of(const char *study, uint64_t count) {
    struct job_runner *runner = runner_of(study, NULL);
    struct job_merger *merger = merger_of(study);
    struct block_result result = run(runner, 0, count);
    merge(merger, &result);
    cJSON *document = curves_of(merger);
    block_result_clear(&result);
    merger_destroy(&merger);
    runner_destroy(&runner);
    return document;
}

static bool text_is(const cJSON *object, const char *key, const char *text) {
    const cJSON *value = json_at(object, key);
    return cJSON_IsString(value) && strcmp(value->valuestring, text) == 0;
}

static const cJSON *curve_of(const cJSON *document, const char *quantity, const char *series,
                             const char *model, double level) {
    const cJSON *curve;
    cJSON_ArrayForEach(curve, json_at(document, "/curves")) {
        if (text_is(curve, "/quantity", quantity) && text_is(curve, "/series", series) &&
            text_is(curve, "/model", model) && json_at(curve, "/level")->valuedouble == level)
            return curve;
    }
    fail_msg("no curve %s of %s, %s, %g", quantity, series, model, level);
    return NULL;
}

static double at(const cJSON *curve, const char *key, int point) {
    const cJSON *value = cJSON_GetArrayItem(json_at(curve, key), point);
    assert_non_null(value);
    return cJSON_IsNumber(value) ? value->valuedouble : NAN;
}

/* Random blocks, run by several runners on one shared part, merged in random order: the same text.
 */
static void any_split_and_order(void **state) {
    (void)state;
    uint64_t seed = seed_of_now();
    for (int s = 0; s < STUDY_COUNT; s++) {
        const char *study = STUDIES[s].study;
        const uint64_t all = 1 + (STUDIES[s].count - 1) / case_step();
        struct job_shared *shared = shared_of(study);
        struct job_runner *runners[] = {runner_of(study, shared), runner_of(study, shared)};
        cJSON *whole = document_of(study, all);
        char *expected = cJSON_PrintUnformatted(whole);
        cJSON_Delete(whole);
        for (int trial = 0; trial < STUDIES[s].trials; trial += (int)case_step()) {
            struct job_merger *merger = merger_of(study);
            struct block_result parts[REALISATIONS];
            size_t count = 0;
            for (uint64_t first = 0; first < all;) {
                uint64_t size = 1 + next_word(&seed) % 5;
                size = first + size <= all ? size : all - first;
                parts[count] = run(runners[count % 2], first, size);
                count++;
                first += size;
            }
            for (size_t left = count; left > 0; left--) {
                size_t pick = (size_t)(next_word(&seed) % left);
                merge(merger, &parts[pick]);
                block_result_clear(&parts[pick]);
                parts[pick] = parts[left - 1];
            }
            char *got = text_of(merger);
            assert_string_equal(got, expected);
            free(got);
            merger_destroy(&merger);
        }
        free(expected);
        runner_destroy(&runners[0]);
        runner_destroy(&runners[1]);
        job_shared_destroy(&shared);
    }
}

/* Another case's, another kind's, twice the same, damaged, cut: refused, and nothing is added. */
static void foreign_and_damaged(void **state) {
    (void)state;
    struct job_runner *runner = runner_of(LEVELS, NULL), *other = runner_of(FULL, NULL);
    struct job_merger *merger = merger_of(LEVELS);
    struct block_result good = run(runner, 3, 2), next = run(runner, 7, 2);
    struct block_result foreign = run(other, 0, 2);
    merge(merger, &good);
    char *before = text_of(merger);
    assert_refused(merger, &good, "realisation 3 is there already");
    assert_refused(merger, &foreign, "other parameters");
    struct block_result bad = next;
    bad.count = 1;
    assert_refused(merger, &bad, "scalars beside it");
    bad = good;
    bad.first = 7; /* its scalars, with the accumulators of others */
    bad.data = next.data;
    bad.size = next.size;
    assert_refused(merger, &bad, "scalars beside it");
    bad = next;
    bad.scalar_count--;
    assert_refused(merger, &bad, "scalars a realisation");
    assert_damaged_are_refused(merger, &next, 200);
    char *after = text_of(merger);
    assert_string_equal(after, before);
    merge(merger, &next);
    free(before);
    free(after);
    block_result_clear(&good);
    block_result_clear(&next);
    block_result_clear(&foreign);
    merger_destroy(&merger);
    runner_destroy(&runner);
    runner_destroy(&other);
}

static void merge_and_show(const struct block_result *block) {
    struct job_merger *merger = merger_of(FULL);
    merge(merger, block);
    cJSON_Delete(curves_of(merger));
    merger_destroy(&merger);
}

/* Changed bytes under a checksum made anew: taken or refused, but never a crash, a read past the
 * end or an overflow (run under sanitizers). */
static void malicious(void **state) {
    (void)state;
    uint64_t seed = seed_of_now();
    struct job_runner *runner = runner_of(FULL, NULL);
    struct job_merger *merger = merger_of(FULL);
    struct block_result good = run(runner, 0, 2);
    unsigned char *copy = malloc(good.size);
    assert_non_null(copy);
    const uint64_t trials = cases_of(5000);
    size_t taken = 0;
    for (uint64_t trial = 0; trial < trials; trial++) {
        struct block_result bad = good;
        memcpy(copy, good.data, good.size);
        bad.data = copy;
        bad.size = trial % 2 ? good.size : 8 + (size_t)(next_word(&seed) % (good.size - 8));
        for (uint64_t change = next_word(&seed) % 4; change > 0; change--)
            copy[next_word(&seed) % good.size] = (unsigned char)(next_word(&seed) >> 13);
        uint64_t hash = hash_bytes(HASH_START, bad.size - 8, copy);
        for (size_t a = 0; a < 8; a++)
            copy[bad.size - 8 + a] = (unsigned char)(hash >> (8 * a));
        struct error err = {0};
        int status = merger_fits(merger, &bad, &err);
        assert_true(status == 0 || status == ERROR_INPUT);
        if (status == 0)
            merge_and_show(&bad);
        taken += status == 0;
    }
    assert_true(taken > trials / 16); /* the unchanged ones at least: their checksum is right */
    free(copy);
    block_result_clear(&good);
    merger_destroy(&merger);
    runner_destroy(&runner);
}

enum { LEVEL_COUNT = 3 };
static const double POINTS[LEVEL_COUNT] = {2, 4, 8};

/* Areas by edges of each realisation by itself, at one load. */
static void each_realisation(int point, double layered[LEVEL_COUNT][REALISATIONS],
                             double half[LEVEL_COUNT][REALISATIONS]) {
    struct job_runner *runner = runner_of(LEVELS, NULL);
    for (uint64_t r = 0; r < REALISATIONS; r++) {
        struct job_merger *single = merger_of(LEVELS);
        struct block_result result = run(runner, r, 1);
        merge(single, &result);
        cJSON *document = curves_of(single);
        for (size_t l = 0; l < LEVEL_COUNT; l++) {
            const cJSON *one = curve_of(document, "contact_area", "edges", "layered", POINTS[l]);
            const cJSON *other =
                curve_of(document, "contact_area", "edges", "halfspace", POINTS[l]);
            layered[l][r] = at(one, "/y", point);
            half[l][r] = at(other, "/y", point);
            assert_true(isnan(at(one, "/standard_error", point)));
            assert_true(isnan(at(other, "/standard_error", point)));
        }
        cJSON_Delete(document);
        block_result_clear(&result);
        merger_destroy(&single);
    }
    runner_destroy(&runner);
}

static double mean_of(const double *y, double *standard_error) {
    double sum = 0, squares = 0, n = REALISATIONS;
    for (size_t r = 0; r < REALISATIONS; r++)
        sum += y[r];
    for (size_t r = 0; r < REALISATIONS; r++)
        squares += (y[r] - sum / n) * (y[r] - sum / n);
    *standard_error = sqrt(squares / (n - 1) / n);
    return sum / n;
}

static void assert_near(double value, double expected, double tolerance) {
    if (!(fabs(value - expected) <= tolerance))
        fail_msg("%.17g, expected %.17g within %g", value, expected, tolerance);
}

/* Mean change from one level to the next finer one, over realisations. */
static double change_of(const double *fine, const double *coarse, double *standard_error) {
    double change[REALISATIONS];
    for (size_t r = 0; r < REALISATIONS; r++)
        change[r] = fine[r] - coarse[r];
    return mean_of(change, standard_error);
}

/* Means, errors of the mesh and of the model against the realisations one by one. 1e-10: rounding
 * of squares that cancel. Where no order is seen the bound may be that of another load. */
static void against_each_realisation(void **state) {
    (void)state;
    const int point = 1;
    double layered[LEVEL_COUNT][REALISATIONS], half[LEVEL_COUNT][REALISATIONS];
    double standard_error, unused;
    each_realisation(point, layered, half);
    cJSON *document = document_of(LEVELS, REALISATIONS);
    const cJSON *curve = curve_of(document, "contact_area", "edges", "layered", 8);
    assert_near(at(curve, "/y", point), mean_of(layered[2], &standard_error), 1e-12);
    assert_near(at(curve, "/standard_error", point), standard_error, 1e-10);
    assert_null(json_at(curve, "/model_error")); /* it is the most complete model */
    struct mesh_changes changes = {change_of(layered[2], layered[1], &standard_error),
                                   change_of(layered[1], layered[0], &unused), 2, 2};
    struct mesh_error mesh = mesh_error(&changes, EDGE_ORDER);
    assert_near(at(curve, "/discretisation_error", point), mesh.error, 1e-10);
    assert_true(at(curve, "/discretisation_bound", point) >= mesh.bound * (1 - 1e-9));
    assert_near(at(curve, "/discretisation_standard_error", point), mesh.weight * standard_error,
                1e-10);
    /* models are compared at their limits */
    double difference[LEVEL_COUNT][REALISATIONS], paired;
    for (size_t l = 0; l < LEVEL_COUNT; l++)
        for (size_t r = 0; r < REALISATIONS; r++)
            difference[l][r] = half[l][r] - layered[l][r];
    changes = (struct mesh_changes){change_of(difference[2], difference[1], &unused),
                                    change_of(difference[1], difference[0], &unused), 2, 2};
    mesh = mesh_error(&changes, EDGE_ORDER);
    curve = curve_of(document, "contact_area", "edges", "halfspace", 8);
    assert_near(at(curve, "/model_error", point), mean_of(difference[2], &paired) - mesh.error,
                1e-10);
    assert_true(at(curve, "/model_bound", point) >= mesh.bound * (1 - 1e-9));
    assert_true(at(curve, "/model_error_standard_error", point) >= paired);
    curve = curve_of(document, "contact_area", "edges", "layered", 4);
    assert_true(cJSON_IsNull(json_at(curve, "/discretisation_error")));
    cJSON_Delete(document);
}

/* Each realisation and level that the model full did not bring to the last load has a note, which
 * names the kinematics and the load reached, in the study's units; notes of other realisations, or
 * too few, are refused. */
static void failures_are_told(void **state) {
    (void)state;
    struct job_runner *runner = runner_of(STEEP, NULL);
    struct job_merger *merger = merger_of(STEEP);
    struct block_result result = run(runner, 0, STEEP_REALISATIONS), moved = result;
    moved.first = STEEP_REALISATIONS;
    assert_refused(merger, &moved, "does not belong to the scalars");
    merge(merger, &result);
    cJSON *document = curves_of(merger);
    double valueless = 0;
    for (double level = 2; level <= 4; level += 2)
        valueless +=
            at(curve_of(document, "contact_area", "nodes", "full", level), "/valueless", 2);
    assert_true(valueless > 0);
    assert_near(json_at(document, "/notes/count")->valuedouble, valueless, 0);
    const char *text =
        cJSON_GetStringValue(json_at(json_at(document, "/notes/kept")->child, "/text"));
    double level, load, reached, pressure, highest;
    assert_int_equal(sscanf(text,
                            "model full (hencky), level %lf: load %lf, reached %lf: contact on the "
                            "true geometry under a mean pressure of %lf E* was reached up to %lf",
                            &level, &load, &reached, &pressure, &highest),
                     5);
    assert_near(pressure, load * 1.6, 1e-4); /* RMS slope 1.6 */
    assert_near(highest, reached * 1.6, 1e-3);
    assert_true(reached < load);
    cJSON_Delete(document);
    document = document_of(LEVELS, 1);
    assert_null(json_at(document, "/notes"));
    cJSON_Delete(document);
    block_result_clear(&result);
    merger_destroy(&merger);
    runner_destroy(&runner);
}

/* What must be true of any solution, and what full contact leaves without a value. */
static void curves_make_sense(void **state) {
    (void)state;
    cJSON *document = document_of(FULL, 3);
    const cJSON *area = curve_of(document, "contact_area", "edges", "halfspace", 8);
    const cJSON *low = curve_of(document, "contact_area", "nodes_lower", "halfspace", 8);
    const cJSON *high = curve_of(document, "contact_area", "nodes_upper", "halfspace", 8);
    for (int k = 0; k < 3; k++) {
        assert_true(at(low, "/y", k) <= at(area, "/y", k));
        assert_true(at(area, "/y", k) <= at(high, "/y", k));
    }
    assert_true(at(area, "/y", 0) > 0 && at(area, "/y", 0) < 0.2);
    assert_near(at(area, "/y", 2), 1, 1e-12);
    const cJSON *gap = curve_of(document, "mean_gap", "", "halfspace", 8);
    assert_true(at(gap, "/y", 0) > at(gap, "/y", 1));
    assert_near(at(gap, "/y", 2), 0, 1e-8);
    const cJSON *stiffness = curve_of(document, "stiffness", "", "halfspace", 8);
    assert_true(at(stiffness, "/y", 0) > 0 && at(stiffness, "/y", 0) < at(stiffness, "/y", 1));
    assert_true(isnan(at(stiffness, "/y", 2)));
    assert_near(at(stiffness, "/valueless", 1), 0, 0);
    assert_near(at(stiffness, "/valueless", 2), 3, 0);
    const cJSON *pressures = curve_of(document, "contact_pressure_pdf", "", "halfspace", 8);
    assert_near(json_at(pressures, "/pressure")->valuedouble, 50, 0);
    assert_near(json_at(pressures, "/overflow")->valuedouble, 3 * 16, 0); /* all points */
    assert_true(text_is(json_at(document, "/curves")->child, "/series", "edges"));
    cJSON_Delete(document);
}

/* The histogram of pressures adds up to the area in contact, to the 2^-20 of a point. */
static void pressures_are_those_in_contact(void **state) {
    (void)state;
    cJSON *document = document_of(LEVELS, 5);
    const cJSON *pressures = curve_of(document, "contact_pressure_pdf", "", "layered", 8);
    const cJSON *edges = curve_of(document, "contact_area", "edges", "layered", 8);
    double outside = json_at(pressures, "/underflow")->valuedouble +
                     json_at(pressures, "/overflow")->valuedouble;
    double share = outside / (5 * 64);
    for (int b = 0; b < 8; b++)
        share += at(pressures, "/y", b) * 0.1;
    assert_true(outside > 0);
    assert_near(share, at(edges, "/y", 1), 1e-7);
    cJSON_Delete(document);
}

/* Before any result there are curves too, all of them empty of values. */
static void no_realisation_yet(void **state) {
    (void)state;
    struct job_merger *merger = merger_of(LEVELS);
    cJSON *document = curves_of(merger);
    assert_true(json_at(document, "/realisations")->valuedouble == 0);
    const cJSON *curve = curve_of(document, "contact_area", "edges", "layered", 8);
    assert_true(isnan(at(curve, "/y", 0)) && isnan(at(curve, "/discretisation_error", 0)));
    cJSON_Delete(document);
    merger_destroy(&merger);
}

struct questions {
    int asked, most;
};

/* Stops at the question after so many: one before a realisation, one a load. */
static int stop_after(void *context, double done) {
    struct questions *questions = context;
    (void)done;
    return ++questions->asked > questions->most;
}

/* What a job reported: how often it moved, and within a realisation. */
struct reported {
    double done;
    int moves, within;
};

static int take_report(void *context, double done) {
    struct reported *reported = context;
    assert_true(done >= reported->done && done <= 2);
    reported->moves += done > reported->done;
    reported->within += done > reported->done && done != floor(done);
    reported->done = done;
    return 0;
}

/* A job says how far it is within a realisation: after each load, and each step of a path. */
static void progress_within_realisations(void **state) {
    (void)state;
    static const struct {
        const char *study;
        int within; /* at least */
    } ROWS[] = {{FULL, 2}, {STEEP, 4}, {SLIDING, 12}};
    for (size_t row = 0; row < sizeof ROWS / sizeof *ROWS; row++) {
        struct job_runner *runner = runner_of(ROWS[row].study, NULL);
        struct reported reported = {0};
        const struct job_control control = {take_report, &reported};
        struct block_result result = {0};
        struct error err = {0};
        assert_int_equal(runner_run(runner, 0, 2, &control, &result, &err), 0);
        if (reported.within < ROWS[row].within)
            fail_msg("study %zu reported %d parts of realisations, %d in all", row, reported.within,
                     reported.moves);
        assert_true(reported.done > 1.3);
        block_result_clear(&result);
        runner_destroy(&runner);
    }
}

/* Stops in the midst of the second realisation. */
static void stopping(void **state) {
    (void)state;
    struct job_runner *runner = runner_of(FULL, NULL);
    struct questions questions = {0, INT_MAX};
    const struct job_control control = {stop_after, &questions};
    struct block_result result = {0}, one = {0};
    struct error err = {0};
    assert_int_equal(runner_run(runner, 0, 1, &control, &one, &err), 0);
    questions = (struct questions){0, questions.asked + 2};
    assert_int_equal(runner_run(runner, 0, 9, &control, &result, &err), 0);
    assert_int_equal(questions.asked, questions.most + 1);
    assert_int_equal(result.count, 1); /* nothing of the second is among it */
    assert_int_equal(result.size, one.size);
    assert_memory_equal(result.data, one.data, one.size);
    block_result_clear(&one);
    block_result_clear(&result);
    questions = (struct questions){0, 1};
    result.first = 77;
    assert_int_equal(runner_run(runner, 0, 9, &control, &result, &err), ERROR_STOPPED);
    assert_true(result.first == 77 && result.data == NULL);
    runner_destroy(&runner);
}

static int stop_at_number(void *context, double done) {
    int *left = context;
    (void)done;
    return (*left)-- == 0;
}

/* A load of the model full asks before each iteration of Newton's whether to stop. Wherever it is
 * stopped, the result is the first realisation alone or nothing, and no failure is reported. The
 * same runner gives the whole block afterwards. */
static void stopping_within_a_load(void **state) {
    (void)state;
    struct job_runner *runner = runner_of(STEEP, NULL);
    struct block_result whole = run(runner, 0, 2), first = run(runner, 0, 1), result = {0};
    struct error err = {0};
    int step = 1, firsts = 0;
    for (int number = 0;; number += step, step += 7 * (int)case_step()) {
        int left = number;
        const struct job_control control = {stop_at_number, &left};
        int status = runner_run(runner, 0, 2, &control, &result, &err);
        if (status == 0 && result.count == 2)
            break;
        assert_int_equal(status, firsts > 0 ? 0 : status == 0 ? 0 : ERROR_STOPPED);
        firsts += status == 0;
        assert_true(status == 0 || result.data == NULL);
        assert_true(status != 0 || (result.size == first.size &&
                                    memcmp(result.data, first.data, first.size) == 0));
        block_result_clear(&result);
    }
    assert_true(firsts > 0);
    block_result_clear(&first);
    assert_true(step > 7 * 7); /* far more questions than realisations, levels and loads: 38 */
    assert_int_equal(result.size, whole.size);
    assert_memory_equal(result.data, whole.data, whole.size);
    block_result_clear(&whole);
    block_result_clear(&result);
    runner_destroy(&runner);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(any_split_and_order),
        cmocka_unit_test(foreign_and_damaged),
        cmocka_unit_test(malicious),
        cmocka_unit_test(against_each_realisation),
        cmocka_unit_test(curves_make_sense),
        cmocka_unit_test(pressures_are_those_in_contact),
        cmocka_unit_test(failures_are_told),
        cmocka_unit_test(no_realisation_yet),
        cmocka_unit_test(progress_within_realisations),
        cmocka_unit_test(stopping),
        cmocka_unit_test(stopping_within_a_load),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
