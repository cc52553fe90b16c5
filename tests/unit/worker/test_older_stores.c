/* Protects: stores that people have, of versions 1, 3, 17, 18 and 20 and of two layouts before
 * them. Those of versions 1 and 3, left in the midst of work, open with this program, which goes on
 * where they were. They end with the rows of a fresh run: of cases that this program publishes,
 * names, abscissae, counts and curves without a model are the same bit for bit; curves of contact
 * and all scalars are to four digits, but for those whose definition or tolerance changed
 * (check_study). Statistics that were published before are not compared. Of version 17 the
 * published ordinates are read as they are in its rows, to twelve digits; of version 18 keys get
 * their owners, and of version 20 they know studies that were extended. All but the first layout,
 * which is refused with a word, have no flaw of structure once they were opened.
 * tests/fixtures/stores/README.md says how the fixtures were made. */
#include "tests/support/sql.h"
#include "tests/unit/worker/small_study.h"
#include "worker/publish/aggregate.h"
#include "worker/publish/verify.h"
#include "worker/worker.h"

enum { STUDIES = 5, ROWS_MOST = 1 << 20 };

static char *read_file(const char *name) {
    char path[512];
    const char *source = getenv("RUGO_SOURCE");
    snprintf(path, sizeof path, "%s/tests/fixtures/stores/%s", source != NULL ? source : ".", name);
    FILE *file = fopen(path, "rb");
    if (file == NULL)
        fail_msg("no fixture %s", path);
    char *text = calloc(1, ROWS_MOST);
    assert_non_null(text);
    assert_true(fread(text, 1, ROWS_MOST - 1, file) < ROWS_MOST - 1);
    fclose(file);
    return text;
}

/* Makes a database out of the text of one. */
static void load(const char *fixture, const char *path) {
    sqlite3 *db = NULL;
    char *text = read_file(fixture);
    assert_int_equal(sqlite3_open(path, &db), SQLITE_OK);
    if (sqlite3_exec(db, text, NULL, NULL, NULL) != SQLITE_OK)
        fail_msg("%s: %s", fixture, sqlite3_errmsg(db));
    sqlite3_close(db);
    free(text);
}

/* The rows of one text column, a line each; the caller frees. */
static char *rows_of(const char *path, const char *sql, const char *study) {
    sqlite3 *db = NULL;
    sqlite3_stmt *row = NULL;
    char *text = calloc(1, ROWS_MOST);
    size_t used = 0;
    assert_non_null(text);
    assert_int_equal(sqlite3_open_v2(path, &db, SQLITE_OPEN_READONLY, NULL), SQLITE_OK);
    if (sqlite3_prepare_v2(db, sql, -1, &row, NULL) != SQLITE_OK)
        fail_msg("%s: %s", sql, sqlite3_errmsg(db));
    sqlite3_bind_text(row, 1, study, -1, SQLITE_STATIC);
    while (sqlite3_step(row) == SQLITE_ROW && used < ROWS_MOST)
        used += (size_t)snprintf(text + used, ROWS_MOST - used, "%s\n",
                                 (const char *)sqlite3_column_text(row, 0));
    sqlite3_finalize(row);
    sqlite3_close(db);
    assert_true(used < ROWS_MOST);
    return text;
}

static void work_off(const char *database) {
    struct worker_options options = {
        .source = {.database = database, .worker = "new"}, .threads = 1, .drain = 1};
    struct error err = {0};
    if (workers_run(&options, &err) != 0)
        fail_msg("%s", err.text);
}

/* Runs the study in a store of its own; with independent cases, as the programs of before knew no
 * others. */
static void run_fresh(struct fixture *fresh, const char *source) {
    char *text = NULL;
    assert_true(asprintf(&text, "{\"random\":\"independent\",%s", source + 1) > 0);
    fixture_open(fresh);
    fixture_submit(fresh, text, 100, NULL, 0);
    work_off(fresh->database);
    free(text);
}

static void check_same_rows(const char *path, const char *study, const struct fixture *fresh,
                            int from, const char *columns, const char *rest) {
    char *sql = NULL;
    assert_true(asprintf(&sql,
                         "SELECT json_array(\"case\", %s WHERE study = ? AND \"case\" >= %d%s",
                         columns, from, rest) > 0);
    char *old = rows_of(path, sql, study), *new = rows_of(fresh->database, sql, fresh->study);
    assert_true(from > 0 || *new != 0);
    assert_string_equal(old, new);
    free(old);
    free(new);
    free(sql);
}

/* Cases from this one on are compared with a fresh run. Statistics that were published before stay
 * as they were: pits are counted beside summits since, and rare ones have other errors. */
static void check_study(const char *path, const struct study_status *about, int from) {
    struct fixture fresh;
    char *source = rows_of(path,
                           "SELECT source FROM study_source JOIN study ON study.id = study_id "
                           "WHERE public = ?",
                           about->id);
    assert_string_equal(about->state, "done");
    assert_int_equal(about->cases_failed, 0);
    assert_int_equal(about->random, RANDOM_INDEPENDENT);
    run_fresh(&fresh, source);
    /* Areas by edges followed another law, and pressures beside edges by none. Contact was solved
     * by other steps to the same tolerance, so that four digits are the same; stiffness, an
     * energy's slope, has a wider one. */
    check_same_rows(path, about->id, &fresh, from,
                    "quantity, series, x, iif(model IS NULL, y, printf('%.4g', y)), "
                    "iif(model IS NULL, standard_error, printf('%.4g', standard_error)), x2, "
                    "model, kinematics, level, pressure, valueless) FROM curve_points",
                    " AND NOT (quantity = 'contact_area' AND series = 'edges') AND quantity NOT "
                    "IN ('contact_pressure_pdf', 'stiffness', 'iterations', 'work') ORDER BY 1");
    /* Fits are of areas by edges, and were once over the loads of each realisation's own; and
     * values at the last load were means of scalars, other than now in their last digits. */
    check_same_rows(
        path, about->id, &fresh, from,
        "scalar, printf('%.4g', value), printf('%.4g', standard_error), theory) FROM "
        "case_scalars",
        " AND scalar NOT LIKE '%kappa%' AND scalar NOT LIKE 'power_law%' AND scalar NOT LIKE "
        "'erf_%' AND scalar NOT "
        "LIKE '%_last' AND scalar NOT IN ('iterations', 'violation') ORDER BY 1");
    check_same_rows(path, about->id, &fresh, 0, "state, realisations_done) FROM case_progress",
                    " ORDER BY 1");
    fixture_close(&fresh);
    free(source);
}

/* What an older program left unfinished in another format is given up, and computed anew. */
static void retry_failed(struct store *store, const char *path) {
    struct study_status *list = NULL;
    struct error err = {0};
    size_t count = 0;
    uint64_t retried = 0;
    work_off(path);
    assert_int_equal(store_list(store, "", 10, &list, &count, &err), 0);
    for (size_t s = 0; s < count; s++) {
        if (list[s].cases_failed > 0)
            assert_int_equal(store_retry(store, list[s].id, 0, &retried, &err), 0);
        study_status_clear(&list[s]);
    }
    free(list);
    work_off(path);
}

static void check_ended(struct store *store, const char *study) {
    struct study_status now;
    assert_int_equal(store_status(store, study, &now, NULL), 0);
    assert_string_equal(now.state, "done");
    study_status_clear(&now);
}

static void a_store_of_version_1_goes_on(void **state) {
    (void)state;
    static const int PUBLISHED[STUDIES] = {1, 0, 1}; /* cases of statistics */
    static const char *const STATES[STUDIES] = {"done", "done", "running", "cancelled", "failed"};
    struct store *store = NULL;
    struct study_status *list = NULL;
    struct error err = {0};
    size_t count = 0;
    uint64_t retried = 0;
    load("version-1.sql", "old.db");
    if (store_open(&store, "old.db", NULL, &err) != 0)
        fail_msg("%s", err.text);
    assert_int_equal(store_list(store, "", 10, &list, &count, &err), 0);
    assert_int_equal(count, STUDIES);
    for (size_t s = 0; s < count; s++) {
        assert_string_equal(list[s].state, STATES[s]);
        if (s >= 3)
            assert_int_equal(store_retry(store, list[s].id, 0, &retried, &err), 0);
    }
    work_off("old.db");
    for (size_t s = 0; s < count; s++) {
        if (s >= 3) /* what was done of it is in another format, and was computed anew at once */
            check_ended(store, list[s].id);
        study_status_clear(&list[s]);
    }
    free(list);
    retry_failed(store, "old.db");
    assert_int_equal(store_list(store, "", 10, &list, &count, &err), 0);
    for (size_t s = 0; s < count; s++) {
        check_study("old.db", &list[s], PUBLISHED[s]);
        study_status_clear(&list[s]);
    }
    free(list);
    store_close(&store);
}

/* What older programs did not count: the processor time of their jobs, in the counters and in the
 * published report of a case. */
static void check_clock_stands_in(struct store *store, const char *study) {
    struct study_report report = {0};
    struct error err = {0};
    if (aggregate_report(store, study, &report, &err) != 0)
        fail_msg("%s", err.text);
    assert_string_equal(report.random, "independent");
    for (size_t c = 0; c < report.case_count; c++) {
        const struct case_report *one = &report.cases[c];
        assert_true(one->time.seconds > 0 && one->curve_count > 0);
        assert_int_equal(one->time.jobs_without_cpu, one->jobs);
        assert_true(fabs(one->time.cpu_seconds - one->time.seconds) <= 0);
        for (size_t a = 0; a < one->curve_count; a++)
            assert_true(one->curves[a].seconds > 0 &&
                        fabs(one->curves[a].cpu_seconds - one->curves[a].seconds) <= 0);
    }
    study_report_clear(&report);
}

/* A sweep that was half done with a surface of its own for each case ends with just these. */
static void a_store_of_version_3_goes_on(void **state) {
    (void)state;
    struct store *store = NULL;
    struct study_status *list = NULL;
    struct error err = {0};
    size_t count = 0;
    load("version-3.sql", "third.db");
    if (store_open(&store, "third.db", NULL, &err) != 0)
        fail_msg("%s", err.text);
    retry_failed(store, "third.db");
    assert_int_equal(store_list(store, "", 10, &list, &count, &err), 0);
    assert_int_equal(count, 2);
    check_clock_stands_in(store, list[0].id);
    for (size_t s = 0; s < count; s++) {
        check_study("third.db", &list[s], s == 0 ? 2 : 1); /* cases published before */
        study_status_clear(&list[s]);
    }
    free(list);
    store_close(&store);
}

/* Its tables lack columns that curves got later: what it published stays, and what this program
 * publishes finds its columns. */
static void an_early_layout_is_mended(void **state) {
    (void)state;
    static const char points[] =
        "SELECT count(*) || ' ' || count(y) FROM curve_points WHERE ?1 IS NULL";
    static const char cases[] = "SELECT state FROM case_progress WHERE ?1 IS NULL";
    struct store *store = NULL;
    struct error err = {0};
    load("early-layout.sql", "early.db");
    for (int again = 0; again < 2; again++) {
        if (store_open(&store, "early.db", NULL, &err) != 0)
            fail_msg("%s", err.text);
        char *kept = rows_of("early.db", points, NULL),
             *progress = rows_of("early.db", cases, NULL);
        assert_string_equal(kept, "45 44\n");
        assert_string_equal(progress, "published\n");
        free(kept);
        free(progress);
        sql_change("early.db", "DELETE FROM curve; DELETE FROM point; DELETE FROM published; "
                               "UPDATE study_case SET settled = 0");
        retry_failed(store, "early.db");
        store_close(&store);
    }
}

/* What reads only has an older store brought up to date as well. */
static void a_reader_reads_it(void **state) {
    (void)state;
    struct store *store = NULL;
    struct store_options options = {.read_only = true};
    struct error err = {0};
    load("version-1.sql", "read.db");
    if (store_open(&store, "read.db", &options, &err) != 0)
        fail_msg("%s", err.text);
    store_close(&store);
}

static int refuse_structure(void *context, const struct flaw *flaw, struct error *err) {
    (void)context;
    (void)err;
    if (flaw->kind == FLAW_FILE || flaw->kind == FLAW_REFERENCE)
        fail_msg("%s", flaw->text);
    return 0;
}

/* Migrations make of each older store what they make of an empty one. */
static void a_store_brought_up_is_like_a_new_one(void **state) {
    (void)state;
    static const char *const FIXTURES[] = {"version-1.sql",  "version-3.sql",  "version-17.sql",
                                           "version-18.sql", "version-20.sql", "early-layout.sql"};
    for (size_t f = 0; f < sizeof FIXTURES / sizeof *FIXTURES; f++) {
        const struct verification verification = {.found = refuse_structure};
        struct verify_report report = {0};
        struct store *store = NULL;
        struct error err;
        char path[40];
        snprintf(path, sizeof path, "%s.db", FIXTURES[f]);
        load(FIXTURES[f], path);
        assert_int_equal(store_open(&store, path, NULL, &err), 0);
        assert_int_equal(verify_store(store, &verification, true, &report, &err), 0);
        assert_true(report.counts.cases > 0);
        store_close(&store);
    }
}

/* A key that was everybody's is its owner's afterwards. */
static void keys_get_their_owners(void **state) {
    (void)state;
    static const char KEYS[] =
        "SELECT owner || '|' || replace(submit_key, owner || char(31), '') FROM study WHERE "
        "submit_key LIKE owner || char(31) || '%' AND ?1 IS NULL ORDER BY id";
    struct store *store = NULL;
    struct error err;
    load("version-18.sql", "keys.db");
    assert_int_equal(store_open(&store, "keys.db", NULL, &err), 0);
    store_close(&store);
    char *rows = rows_of("keys.db", KEYS, NULL);
    assert_string_equal(rows, "|monday\nanna|tuesday\n");
    free(rows);
}

/* How many realisations were first asked for is not known of an older program's study: its key
 * takes the document with any number of them, as that of a study that was extended since. */
static void a_key_knows_an_older_extended_study(void **state) {
    (void)state;
    static const char GIVEN[] =
        "{\"name\":\"kept\",\"kind\":\"statistics\",\"seed\":1,\"realisations\":4,\"surface\":{"
        "\"hurst\":0.8,\"wavelength_ratio\":4,\"length_ratio\":4,\"points_per_wavelength\":4}}";
    struct store *store = NULL;
    struct study *study = NULL;
    struct fault_list faults = {0};
    struct error err;
    char id[STUDY_ID_SIZE];
    bool existing = false;
    load("version-20.sql", "extended.db");
    assert_int_equal(store_open(&store, "extended.db", NULL, &err), 0);
    assert_int_equal(kind_read_study(&study, GIVEN, strlen(GIVEN), NULL, &faults, &err), 0);
    assert_int_equal(store_submit(store, study, "monday", id, &existing, &err), 0);
    assert_true(existing);
    assert_string_equal(id, "bda1b99f50318778");
    assert_int_equal(store_submit(store, study, "tuesday", id, &existing, &err), ERROR_STATE);
    study_destroy(&study);
    store_close(&store);
}

static int refuse_flaw(void *context, const struct flaw *flaw, struct error *err) {
    (void)context;
    (void)err;
    fail_msg("%s", flaw->text);
    return 0;
}

/* The ordinates of the curves, a line each; the caller frees. */
static char *ordinates(const struct case_result *result) {
    char *text = calloc(1, ROWS_MOST);
    size_t used = 0;
    assert_non_null(text);
    for (size_t a = 0; a < result->curve_count; a++)
        for (size_t b = 0; b < result->curves[a].n && used < ROWS_MOST; b++)
            used += (size_t)snprintf(text + used, ROWS_MOST - used, "%s %s %.12g\n",
                                     result->curves[a].quantity, result->curves[a].series,
                                     result->curves[a].y[b]);
    assert_true(used < ROWS_MOST);
    return text;
}

/* Blocks, curves and reports that are not packed, each curve by itself: their checksums match, and
 * they are read as they were published, which the rows of the views have, too. */
static void what_was_not_packed_is_read(void **state) {
    (void)state;
    static const char POINTS[] =
        "SELECT quantity || ' ' || series || ' ' || iif(y IS NULL, 'nan', printf('%.12g', y)) FROM "
        "point JOIN curve ON curve.id = curve_id WHERE ?1 IS NULL ORDER BY curve_id, number";
    const struct verification verification = {.found = refuse_flaw};
    const struct published_part all = {0};
    struct verify_report report = {0};
    struct case_result result = {0};
    struct case_report about = {0};
    struct case_info info;
    struct store *store = NULL;
    struct study_status *list = NULL;
    struct error err = {0};
    size_t count = 0;
    bool found = false;
    load("version-17.sql", "plain.db");
    assert_int_equal(store_open(&store, "plain.db", NULL, &err), 0);
    assert_int_equal(verify_store(store, &verification, true, &report, &err), 0);
    assert_int_equal(report.counts.flaws, 0);
    assert_int_equal(store_list(store, "", 10, &list, &count, &err), 0);
    assert_int_equal(count, 1);
    assert_int_equal(store_case(store, list[0].id, 0, &info, &err), 0);
    assert_int_equal(
        store_published(store, list[0].id, 0, info.revision, &all, &result, &found, &err), 0);
    assert_true(found && result.curve_count > 10);
    char *is = ordinates(&result), *was = rows_of("plain.db", POINTS, NULL);
    assert_string_equal(is, was);
    assert_int_equal(
        store_published_report(store, list[0].id, 0, info.revision, &about, &found, &err), 0);
    assert_true(found && about.curve_count == result.curve_count);
    free(is);
    free(was);
    case_report_clear(&about);
    result_clear(&result);
    case_info_clear(&info);
    study_status_clear(&list[0]);
    free(list);
    store_close(&store);
}

static void the_first_layout_is_refused(void **state) {
    (void)state;
    struct store *store = NULL;
    struct error err = {0};
    load("first-layout.sql", "first.db");
    assert_int_equal(store_open(&store, "first.db", NULL, &err), ERROR_INPUT);
    assert_non_null(strstr(err.text, "database first.db has the first layout"));
    assert_null(store);
    char *source = rows_of("first.db", "SELECT source FROM study WHERE ?1 IS NULL", NULL);
    assert_non_null(strstr(source, "\"name\":\"first\"")); /* where the message says it is */
    free(source);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_store_of_version_1_goes_on),
        cmocka_unit_test(a_store_of_version_3_goes_on),
        cmocka_unit_test(an_early_layout_is_mended),
        cmocka_unit_test(a_reader_reads_it),
        cmocka_unit_test(a_store_brought_up_is_like_a_new_one),
        cmocka_unit_test(keys_get_their_owners),
        cmocka_unit_test(a_key_knows_an_older_extended_study),
        cmocka_unit_test(what_was_not_packed_is_read),
        cmocka_unit_test(the_first_layout_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
