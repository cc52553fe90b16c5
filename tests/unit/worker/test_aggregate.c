/* Curves and report of a study: complete, partial, filtered, empty. */
#include "jobs/merger.h"
#include "jobs/runner.h"
#include "tests/support/result_tree.h"
#include "tests/support/sql.h"
#include "tests/unit/worker/small_study.h"
#include "worker/link/source.h"
#include "worker/publish/aggregate.h"
#include "worker/publish/publish.h"
#include "worker/worker.h"

#include <math.h>

static int read_curves(struct fixture *fixture, const char *study, int64_t case_number,
                       const char *quantity, cJSON **out, struct error *err) {
    const struct result_filter filter = {
        .case_number = case_number, .part = {.quantity = quantity}, .complete = true};
    struct study_result result = {0};
    int status = aggregate_study(fixture->store, study, &filter, &result, err);
    if (status == 0)
        *out = study_tree(&result);
    study_result_clear(&result);
    return status;
}

static cJSON *curves(struct fixture *fixture, int64_t case_number, const char *quantity) {
    struct error err = {0};
    cJSON *document = NULL;
    if (read_curves(fixture, fixture->study, case_number, quantity, &document, &err) != 0)
        fail_msg("%s", err.text);
    return document;
}

static cJSON *report_of(struct fixture *fixture) {
    struct error err = {0};
    struct study_report report = {0};
    if (aggregate_report(fixture->store, fixture->study, &report, &err) != 0)
        fail_msg("%s", err.text);
    cJSON *tree = report_tree(&report);
    study_report_clear(&report);
    return tree;
}

static double number_at(const cJSON *document, const char *pointer) {
    const cJSON *value = json_at(document, pointer);
    if (!cJSON_IsNumber(value)) {
        fail_msg("no number at %s", pointer);
    }
    return value->valuedouble;
}

static void run_all(struct fixture *fixture) {
    struct worker_options options = {
        .source = {.database = fixture->database, .worker = "test"},
        .threads = 1,
        .drain = 1,
    };
    struct error err = {0};
    if (workers_run(&options, &err) != 0) {
        fail_msg("%s", err.text);
    }
}

/* Runs one job of the queue by hand. */
static void run_one(struct fixture *fixture) {
    struct error err = {0};
    struct source *source = NULL;
    struct source_options options = {.database = fixture->database, .worker = "one"};
    struct claimed_job job = {0};
    struct job_runner *runner = NULL;
    struct block_result result = {0};
    size_t count = 0;
    bool due = false;
    assert_int_equal(source_create(&source, &options, &err), 0);
    assert_int_equal(source_claim(source, &(struct wish){.count = 1}, &job, &count, &due, &err), 0);
    assert_int_equal(count, 1);
    const struct job_kind *kind = kind_find(job.kind);
    assert_int_equal(
        runner_create(&runner, kind, job.parameters, NULL, job.seed, job.case_number, &err), 0);
    assert_int_equal(runner_run(runner, job.first, job.count, NULL, &result, &err), 0);
    struct report report = {.verb = REPORT_COMPLETE, .job = &job, .result = &result};
    assert_int_equal(source_report(source, &report, 1, &due, &err), 0);
    assert_int_equal(report.status, 0);
    if (due)
        assert_int_equal(publish_due(fixture->store, NULL, NULL, NULL, &err), 0);
    runner_destroy(&runner);
    block_result_clear(&result);
    claimed_job_clear(&job);
    source_destroy(&source);
}

static void document_has_the_form_of_the_contract(void **state) {
    (void)state;
    struct fixture fixture;
    fixture_open(&fixture);
    fixture_submit(&fixture, SMALL_STUDY, 6, NULL, 0);
    run_all(&fixture);
    cJSON *document = curves(&fixture, -1, NULL);
    assert_string_equal(cJSON_GetStringValue(json_at(document, "/study")), fixture.study);
    assert_string_equal(cJSON_GetStringValue(json_at(document, "/name")), "small");
    assert_string_equal(cJSON_GetStringValue(json_at(document, "/kind")), "statistics");
    assert_string_equal(cJSON_GetStringValue(json_at(document, "/state")), "done");
    assert_int_equal(cJSON_GetArraySize(json_at(document, "/cases")), 2);
    assert_true(number_at(document, "/cases/1/case") == 1);
    assert_true(number_at(document, "/cases/1/realisations") == 24);
    /* pointers as keys, their slashes escaped in a pointer to them */
    assert_true(number_at(document, "/cases/1/parameters/~1surface~1hurst") == 0.8);
    assert_true(number_at(document, "/cases/0/parameters/~1surface~1length_ratio") == 4);
    assert_true(number_at(document, "/cases/0/scalars/nayak_alpha/value") > 1);
    assert_true(cJSON_GetArraySize(json_at(document, "/cases/0/curves")) > 3);
    cJSON_Delete(document);
    fixture_close(&fixture);
}

/* Published curves are what merging gives: a cache must not change a digit. */
static void published_equals_merged(void **state) {
    (void)state;
    struct fixture fixture;
    fixture_open(&fixture);
    fixture_submit(&fixture, SMALL_STUDY, 6, NULL, 0);
    run_all(&fixture);
    struct case_info info = {0};
    struct error err = {0};
    assert_int_equal(store_case(fixture.store, fixture.study, 0, &info, &err), 0);
    const struct published_part all = {0};
    struct case_result published = {0};
    bool found = false;
    assert_int_equal(store_published(fixture.store, fixture.study, 0, info.revision, &all,
                                     &published, &found, &err),
                     0);
    assert_true(found);
    struct fixture fresh;
    fixture_open(&fresh);
    fixture_submit(&fresh, SMALL_STUDY, 24, NULL, 0);
    run_one(&fresh); /* all of case 0 */
    assert_int_equal(result_set_parameters(&published, info.parameters, &err), 0);
    cJSON *merged = curves(&fresh, 0, NULL);
    struct aggregate aggregate;
    assert_int_equal(aggregate_begin(fixture.store, fixture.study, &aggregate, &err), 0);
    assert_int_equal(merger_complete(aggregate.kind, info.parameters, &published, &err), 0);
    cJSON *tree = result_tree(&published);
    char *text = json_print(json_at(merged, "/cases/0")), *cached = json_print(tree);
    assert_string_equal(text, cached);
    free(text);
    free(cached);
    cJSON_Delete(tree);
    cJSON_Delete(merged);
    result_clear(&published);
    aggregate_end(&aggregate);
    case_info_clear(&info);
    fixture_close(&fresh);
    fixture_close(&fixture);
}

/* A study that runs shows what is there, and says how far it is. */
static void partial_curves_say_how_far(void **state) {
    (void)state;
    struct fixture fixture;
    fixture_open(&fixture);
    fixture_submit(&fixture, SMALL_STUDY, 6, NULL, 0);
    run_one(&fixture);
    cJSON *document = curves(&fixture, -1, NULL);
    assert_true(number_at(document, "/cases/0/realisations") == 6);
    assert_true(number_at(document, "/cases/1/realisations") == 0);
    cJSON_Delete(document);
    run_one(&fixture);
    document = curves(&fixture, 0, NULL);
    assert_true(number_at(document, "/cases/0/realisations") == 12);
    cJSON_Delete(document);
    fixture_close(&fixture);
}

static void filters_choose(void **state) {
    (void)state;
    struct fixture fixture;
    struct error err = {0};
    fixture_open(&fixture);
    fixture_submit(&fixture, SMALL_STUDY, 24, NULL, 0);
    cJSON *document = curves(&fixture, -1, "summit_height_pdf"); /* nothing ran: no error */
    cJSON_Delete(document);
    run_all(&fixture);
    document = curves(&fixture, 1, "summit_height_pdf");
    assert_int_equal(cJSON_GetArraySize(json_at(document, "/cases")), 1);
    assert_true(number_at(document, "/cases/0/case") == 1);
    const cJSON *curve;
    cJSON_ArrayForEach(curve, json_at(document, "/cases/0/curves")) {
        assert_string_equal(cJSON_GetStringValue(cJSON_GetObjectItem(curve, "quantity")),
                            "summit_height_pdf");
    }
    cJSON_Delete(document);
    document = NULL;
    assert_int_equal(read_curves(&fixture, fixture.study, -1, "contact_area", &document, &err),
                     ERROR_INPUT);
    assert_non_null(strstr(err.text, "contact_area"));
    assert_non_null(strstr(err.text, "summit_height_pdf")); /* says what there is */
    assert_int_equal(read_curves(&fixture, fixture.study, 2, NULL, &document, &err), ERROR_ABSENT);
    assert_int_equal(read_curves(&fixture, "0000000000000000", -1, NULL, &document, &err),
                     ERROR_ABSENT);
    assert_null(document);
    fixture_close(&fixture);
}

/* Every error the report states is the one that the curves beside it give. */
static void report_agrees_with_the_curves(void **state) {
    (void)state;
    struct fixture fixture;
    fixture_open(&fixture);
    fixture_submit(&fixture, SMALL_STUDY, 6, NULL, 0);
    run_all(&fixture);
    cJSON *report = report_of(&fixture);
    cJSON *document = curves(&fixture, 0, NULL);
    const char *name = cJSON_GetStringValue(json_at(report, "/cases/0/main_curve"));
    assert_non_null(name);
    double error = 0, size = 0;
    const cJSON *curve;
    cJSON_ArrayForEach(curve, json_at(document, "/cases/0/curves")) {
        if (strcmp(cJSON_GetStringValue(cJSON_GetObjectItem(curve, "quantity")), name) != 0) {
            continue;
        }
        const cJSON *y = cJSON_GetObjectItem(curve, "y")->child;
        const cJSON *e = cJSON_GetObjectItem(curve, "standard_error")->child;
        for (; y && e; y = y->next, e = e->next) {
            if (cJSON_IsNumber(y) && cJSON_IsNumber(e)) {
                error += e->valuedouble * e->valuedouble;
                size += y->valuedouble * y->valuedouble;
            }
        }
        break;
    }
    /* the same sums in the same order: equal up to the rounding of one square root */
    double stated = number_at(report, "/cases/0/statistical_error");
    assert_true(fabs(stated - sqrt(error / size)) <= 1e-14);
    assert_true(stated > 0 && stated < 1);
    assert_null(cJSON_GetObjectItem(json_at(report, "/cases/0"), "model_error"));
    /* without levels the effect of the grid on summits is not known: there is no total */
    assert_true(cJSON_IsNull(json_at(report, "/cases/0/discretisation_error")));
    assert_true(cJSON_IsNull(json_at(report, "/cases/0/total_error")));
    assert_true(number_at(report, "/cases/1/realisations") == 24);
    double cost = number_at(report, "/cases/0/cpu_seconds");
    assert_true(cost > 0 && number_at(report, "/cases/0/seconds") > 0);
    assert_true(fabs(number_at(report, "/cases/0/seconds_to_halve_error") - 3 * cost) <= 0);
    assert_true(fabs(number_at(report, "/cpu_seconds") - cost -
                     number_at(report, "/cases/1/cpu_seconds")) <= 1e-12);
    assert_true(number_at(report, "/jobs_without_cpu") == 0);
    assert_string_equal(cJSON_GetStringValue(json_at(report, "/random")), "common");
    assert_true(number_at(report, "/cases/0/scalars/summit_density/statistical_error") > 0);
    cJSON_Delete(document);
    cJSON_Delete(report);
    fixture_close(&fixture);
}

/* Nothing ran yet: no errors to state, nothing divided by zero. */
static void report_of_an_empty_study_is_null(void **state) {
    (void)state;
    struct fixture fixture;
    fixture_open(&fixture);
    fixture_submit(&fixture, SMALL_STUDY, 6, NULL, 0);
    cJSON *report = report_of(&fixture);
    assert_true(number_at(report, "/cases/0/realisations") == 0);
    assert_true(cJSON_IsNull(json_at(report, "/cases/0/statistical_error")));
    assert_true(cJSON_IsNull(json_at(report, "/cases/0/seconds_per_realisation")));
    assert_true(cJSON_IsNull(json_at(report, "/cases/0/seconds_to_halve_error")));
    cJSON_Delete(report);
    fixture_close(&fixture);
}

/* A contact study of two cases, of which the tests run the first: both models, three meshes. */
static const char CONTACT_STUDY[] =
    "{\"name\":\"pressed\",\"kind\":\"contact\",\"seed\":5,\"realisations\":3,\"surface\":{"
    "\"dimension\":1,\"hurst\":[0.8,0.5],\"wavelength_ratio\":4,\"length_ratio\":2},\"contact\":{"
    "\"model\":[\"halfspace\",\"layered\"],\"levels\":[4,8,16],\"pressures\":{\"to\":0.2,"
    "\"steps\":4}}}";

/* An entry of the report's list of curves; the first one of these. */
static const cJSON *reported(const cJSON *report, const char *quantity, const char *series,
                             const char *model, double level) {
    const cJSON *curve;
    cJSON_ArrayForEach(curve, json_at(report, "/cases/0/curves")) {
        if (strcmp(cJSON_GetStringValue(json_at(curve, "/quantity")), quantity) == 0 &&
            strcmp(cJSON_GetStringValue(json_at(curve, "/series")), series) == 0 &&
            strcmp(cJSON_GetStringValue(json_at(curve, "/model")), model) == 0 &&
            number_at(curve, "/level") == level) {
            return curve;
        }
    }
    fail_msg("no %s %s %s %g in the report", quantity, series, model, level);
    return NULL;
}

static const cJSON *drawn(const cJSON *document, const char *model, double level) {
    const cJSON *curve;
    cJSON_ArrayForEach(curve, json_at(document, "/cases/0/curves")) {
        if (strcmp(cJSON_GetStringValue(json_at(curve, "/quantity")), "contact_area") == 0 &&
            strcmp(cJSON_GetStringValue(json_at(curve, "/series")), "edges") == 0 &&
            strcmp(cJSON_GetStringValue(json_at(curve, "/model")), model) == 0 &&
            number_at(curve, "/level") == level) {
            return curve;
        }
    }
    fail_msg("no curve %s %g", model, level);
    return NULL;
}

static double at(const cJSON *curve, const char *name, int k) {
    char place[64];
    snprintf(place, sizeof place, "/%s/%d", name, k);
    return number_at(curve, place);
}

/* The discretisation error of the curve: its deviation from the limit of the finest one, within the
 * bound of that. */
static double mesh_deviation(const cJSON *curve, const cJSON *finest) {
    double above = 0, below = 0;
    for (int k = 0; k < 4; k++) {
        double limit = at(finest, "y", k) - at(finest, "discretisation_error", k);
        double size = fabs(at(curve, "y", k) - limit) + at(finest, "discretisation_bound", k);
        above += size * size;
        below += limit * limit;
    }
    return sqrt(above / below);
}

/* The model error of the finest curve. */
static double model_deviation(const cJSON *finest) {
    double above = 0, below = 0;
    for (int k = 0; k < 4; k++) {
        above += pow(fabs(at(finest, "model_error", k)) + at(finest, "model_bound", k), 2);
        below += pow(at(finest, "y", k), 2);
    }
    return sqrt(above / below);
}

/* With the cell's, all sources are known of a series of levels: the total is of all of them. */
static void check_total(const cJSON *entry) {
    static const char *const SOURCES[] = {
        "/discretisation_error", "/cell_error",    "/block_error", "/model_error",
        "/solver_error",         "/missing_error", "/patch_error"};
    double sum = 0;
    assert_true(cJSON_IsNumber(json_at(entry, "/cell_error")));
    for (size_t s = 0; s < sizeof SOURCES / sizeof *SOURCES; s++)
        if (json_at(entry, SOURCES[s]) != NULL)
            sum += number_at(entry, SOURCES[s]);
    double total = hypot(number_at(entry, "/statistical_error"), sum);
    assert_true(fabs(number_at(entry, "/total_error") / total - 1) <= 1e-9);
}

/* The report of contact: errors of meshes count from the limit of the finest one, those of a model
 * from the limit of the most complete one, and the seconds of all parts add up. */
static void report_tells_levels_and_models_apart(void **state) {
    (void)state;
    struct fixture fixture;
    fixture_open(&fixture);
    fixture_submit(&fixture, CONTACT_STUDY, 3, NULL, 0);
    run_one(&fixture);
    cJSON *report = report_of(&fixture);
    cJSON *document = curves(&fixture, 0, NULL);
    static const char *const MODELS[] = {"halfspace", "layered"};
    static const double LEVELS[] = {4, 8, 16};
    double seconds = 0;
    for (int m = 0; m < 2; m++) {
        for (int l = 0; l < 3; l++) {
            const cJSON *curve = drawn(document, MODELS[m], LEVELS[l]);
            const cJSON *entry = reported(report, "contact_area", "edges", MODELS[m], LEVELS[l]);
            /* the same few operations, of numbers with as many digits: 1e-9 of their size */
            double expected = mesh_deviation(curve, drawn(document, MODELS[m], 16));
            assert_true(fabs(number_at(entry, "/discretisation_error") - expected) <= 1e-9);
            seconds += number_at(entry, "/seconds");
            if (m == 0) {
                expected = model_deviation(drawn(document, "halfspace", 16));
                assert_true(fabs(number_at(entry, "/model_error") - expected) <= 1e-9);
            } else { /* the errors of the others count from it */
                assert_null(cJSON_GetObjectItem(entry, "model_error"));
            }
            check_total(entry);
        }
    }
    assert_true(fabs(seconds / number_at(report, "/cases/0/seconds") - 1) <= 1e-12);
    /* twice the points, and more iterations, take more than twice as long */
    assert_true(
        number_at(reported(report, "contact_area", "edges", "halfspace", 16), "/seconds") >
        2 * number_at(reported(report, "contact_area", "edges", "halfspace", 8), "/seconds"));
    /* the case has those of its main curve */
    const cJSON *entry = reported(report, "contact_area", "edges", "halfspace", 16);
    assert_true(number_at(report, "/cases/0/model_error") == number_at(entry, "/model_error"));
    assert_true(number_at(report, "/cases/0/discretisation_error") ==
                number_at(entry, "/discretisation_error"));
    cJSON_Delete(document);
    cJSON_Delete(report);
    fixture_close(&fixture);
}

/* A case that has not begun has no curves and no scalars, in a study that has begun and in one that
 * has not. Nothing is merged for it, and the whole table of ten thousand comes at once. */
static void cases_not_begun_are_empty(void **state) {
    (void)state;
    struct fixture fixture;
    fixture_open(&fixture);
    fixture_submit(&fixture, CONTACT_STUDY, 3, NULL, 0);
    run_one(&fixture);
    cJSON *document = curves(&fixture, -1, NULL);
    assert_true(cJSON_GetArraySize(json_at(document, "/cases/0/curves")) > 0);
    assert_int_equal(cJSON_GetArraySize(json_at(document, "/cases/1/curves")), 0);
    assert_int_equal(cJSON_GetArraySize(json_at(document, "/cases/1/scalars")), 0);
    assert_true(number_at(document, "/cases/1/realisations") == 0);
    assert_true(number_at(document, "/cases/1/parameters/~1surface~1hurst") == 0.5);
    cJSON *report = report_of(&fixture);
    assert_int_equal(cJSON_GetArraySize(json_at(report, "/cases/1/curves")), 0);
    assert_true(cJSON_IsNull(json_at(report, "/cases/1/main_curve")));
    assert_true(cJSON_IsNull(json_at(report, "/cases/1/statistical_error")));
    cJSON_Delete(document);
    cJSON_Delete(report);
    fixture_close(&fixture);
}

/* Areas, gaps and stiffnesses of single realisations on the finest level, whose means are the
 * curves; loads are found as a person writes them. */
static void realisations_are_told_at_each_load(void **state) {
    (void)state;
    struct fixture fixture;
    fixture_open(&fixture);
    fixture_submit(&fixture, CONTACT_STUDY, 2, NULL, 0);
    run_all(&fixture);
    double count =
        sql_real(fixture.database, "SELECT count(DISTINCT realisation) FROM realisation_points "
                                   "WHERE \"case\" = 1 AND x = 0.15 AND model = 'layered' AND "
                                   "quantity = 'stiffness'");
    assert_true(count ==
                sql_real(fixture.database, "SELECT max(realisation) + 1 FROM realisation_scalars"));
    assert_true(count > 2);
    assert_true(sql_real(fixture.database,
                         "SELECT count(DISTINCT quantity || series || model || \"case\" || "
                         "x) FROM realisation_points WHERE level = 16") == 4 * 2 * 2 * 4);
    assert_true(
        sql_real(fixture.database,
                 "SELECT max(abs(c.y / r.mean - 1)) FROM curve_points c JOIN (SELECT \"case\", "
                 "quantity, series, model, level, x, avg(y) AS mean FROM realisation_points GROUP "
                 "BY 1, 2, 3, 4, 5, 6) r USING (\"case\", quantity, series, model, level, x)") <
        1e-9);
    fixture_close(&fixture);
}

/* Of a block whose first realisation is not 0: those before it are null. */
static void missing_realisations_are_null(void **state) {
    (void)state;
    struct fault_list faults = {0};
    struct error err = {0};
    struct study *study = NULL;
    struct job_runner *runner = NULL;
    struct job_merger *merger = NULL;
    struct block_result block = {0};
    struct case_result result = {0};
    char *text = NULL;
    double value;
    assert_int_equal(
        kind_read_study(&study, CONTACT_STUDY, strlen(CONTACT_STUDY), NULL, &faults, &err), 0);
    const struct job_kind *kind = kind_of(study->kind);
    const cJSON *parameters = study->cases[0].parameters;
    assert_int_equal(runner_create(&runner, kind, parameters, NULL, study->seed, 0, &err), 0);
    assert_int_equal(runner_run(runner, 2, 1, NULL, &block, &err), 0);
    assert_int_equal(merger_create(&merger, kind, parameters, &err), 0);
    assert_int_equal(merger_add(merger, &block, &err), 0);
    assert_int_equal(merger_result(merger, &result, &err), 0);
    const struct point_texts texts = realisation_values(merger);
    const struct curve *gap = result_curve(&result, "mean_gap");
    while (gap->level < 16)
        gap++; /* curves of one quantity follow each other */
    assert_int_equal(texts.make(texts.context, gap, 1, &text, &err), 0);
    assert_int_equal(sscanf(text, "[null,null,%lf]", &value), 1);
    assert_true(fabs(value / gap->y[1] - 1) < 1e-9);
    free(text);
    text = NULL;
    assert_int_equal(
        texts.make(texts.context, result_curve(&result, "patch_count"), 1, &text, &err), 0);
    assert_null(text); /* which no realisation keeps */
    result_clear(&result);
    merger_destroy(&merger);
    block_result_clear(&block);
    runner_destroy(&runner);
    study_destroy(&study);
}

/* Gives the blocks of a case, or of all (-1), the scalars of another program, unpublished. */
static void spoil(struct fixture *fixture, int case_number) {
    char sql[600], *fault = NULL;
    sqlite3 *db = NULL;
    snprintf(
        sql, sizeof sql,
        "INSERT OR IGNORE INTO scalar_names (names) VALUES (json_array('colour'));"
        "UPDATE result SET names_id = (SELECT id FROM scalar_names WHERE names = "
        "json_array('colour')), seal = NULL WHERE job_id IN (SELECT id FROM job WHERE %d IN (-1, "
        "case_number));"
        "DELETE FROM published WHERE %d IN (-1, case_number);"
        "UPDATE study_case SET settled = 0 WHERE %d IN (-1, number);",
        case_number, case_number, case_number);
    assert_int_equal(sqlite3_open(fixture->database, &db), SQLITE_OK);
    if (sqlite3_exec(db, sql, NULL, NULL, &fault) != SQLITE_OK)
        fail_msg("%s", fault);
    sqlite3_close(db);
}

/* A case whose stored results cannot be merged says why, in its own entry; the others are as they
 * would be without it. Asked for alone, or with none beside it that can be had, it is a failure. */
static void a_case_that_cannot_be_merged_is_told(void **state) {
    (void)state;
    struct fixture fixture;
    struct error err = {0};
    cJSON *none = NULL;
    fixture_open(&fixture);
    fixture_submit(&fixture, SMALL_STUDY, 6, NULL, 0);
    run_all(&fixture);
    cJSON *before = curves(&fixture, -1, NULL), *before_report = report_of(&fixture);
    spoil(&fixture, 0);
    cJSON *after = curves(&fixture, -1, NULL), *after_report = report_of(&fixture);
    assert_true(cJSON_Compare(json_at(before, "/cases/1"), json_at(after, "/cases/1"), 1));
    assert_true(
        cJSON_Compare(json_at(before_report, "/cases/1"), json_at(after_report, "/cases/1"), 1));
    assert_null(json_at(after, "/cases/1/error"));
    const cJSON *documents[] = {after, after_report};
    for (int d = 0; d < 2; d++) {
        const char *error = cJSON_GetStringValue(json_at(documents[d], "/cases/0/error"));
        assert_non_null(error);
        assert_non_null(strstr(error, "case 0: "));
        assert_non_null(strstr(error, "scalars"));
        assert_true(number_at(documents[d], "/cases/0/case") == 0);
        assert_true(number_at(documents[d], "/cases/0/realisations") == 24);
        assert_true(number_at(documents[d], "/cases/0/parameters/~1surface~1hurst") == 0.2);
        assert_int_equal(cJSON_GetArraySize(json_at(documents[d], "/cases/0/curves")), 0);
        assert_int_equal(cJSON_GetArraySize(json_at(documents[d], "/cases/0/scalars")), 0);
    }
    assert_true(number_at(after_report, "/cases/0/seconds") > 0);
    assert_int_equal(read_curves(&fixture, fixture.study, 0, NULL, &none, &err), ERROR_INPUT);
    assert_non_null(strstr(err.text, "case 0: "));
    assert_int_equal(read_curves(&fixture, fixture.study, -1, "colour", &none, &err), ERROR_INPUT);
    assert_non_null(strstr(err.text, "no quantity 'colour'"));
    assert_int_equal(read_curves(&fixture, fixture.study, -1, "rms_slop", &none, &err),
                     ERROR_INPUT);
    assert_non_null(strstr(err.text, "(did you mean rms_slope?)"));
    assert_int_equal(read_curves(&fixture, fixture.study, -1, "rms_slope", &none, &err),
                     ERROR_INPUT);
    assert_non_null(strstr(err.text, "rms_slope is a scalar, which has no curve: rugo table "
                                     "--columns rms_slope (over HTTP, /table?columns=rms_slope)"));
    spoil(&fixture, -1);
    assert_int_equal(read_curves(&fixture, fixture.study, -1, NULL, &none, &err), ERROR_INPUT);
    assert_non_null(strstr(err.text, "case 0: "));
    struct study_report report = {0};
    assert_int_equal(aggregate_report(fixture.store, fixture.study, &report, &err), ERROR_INPUT);
    cJSON_Delete(before);
    cJSON_Delete(before_report);
    cJSON_Delete(after);
    cJSON_Delete(after_report);
    fixture_close(&fixture);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(document_has_the_form_of_the_contract),
        cmocka_unit_test(published_equals_merged),
        cmocka_unit_test(partial_curves_say_how_far),
        cmocka_unit_test(filters_choose),
        cmocka_unit_test(report_agrees_with_the_curves),
        cmocka_unit_test(report_of_an_empty_study_is_null),
        cmocka_unit_test(report_tells_levels_and_models_apart),
        cmocka_unit_test(realisations_are_told_at_each_load),
        cmocka_unit_test(missing_realisations_are_null),
        cmocka_unit_test(cases_not_begun_are_empty),
        cmocka_unit_test(a_case_that_cannot_be_merged_is_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
