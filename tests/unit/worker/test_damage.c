/* Protects: no damage of what is stored changes a result silently. A case whose stored values are
 * changed, by a bit anywhere, reads as before, since it is merged anew or does not depend on them,
 * or is refused with a reason. */
#include "jobs/runner.h"
#include "tests/support/effort.h"
#include "tests/support/seed.h"
#include "tests/unit/worker/damaged_store.h"
#include "worker/link/source.h"

struct outcome {
    unsigned same, refused;
};

/* Reads both cases of a damaged store. */
static void read_damaged(const char *path, const char *what, struct outcome *outcome) {
    for (int64_t c = 0; c < CASES; c++) {
        struct error err;
        char *text = case_text(path, whole.study, c, &err);
        if (text == NULL && err.text[0] == '\0')
            fail_msg("%s: case %d is refused without a word", what, (int)c);
        if (text != NULL && strcmp(text, whole.cases[c]) != 0)
            fail_msg("%s: case %d has changed", what, (int)c);
        outcome->same += text != NULL;
        outcome->refused += text == NULL;
        free(text);
    }
}

/* --- a bit of a value --- */

/* merged: of a store whose cases are not published, and which must merge them. */
static const struct place {
    const char *table, *column;
    bool merged;
} PLACES[] = {
    {"result", "data", true},
    {"result", "scalars", true},
    {"result", "seal", true},
    {"result", "names_id", true},
    {"scalar_names", "names", true},
    {"job", "first", true},
    {"job", "count", true},
    {"job", "case_number", true},
    {"result", "data", false},
    {"published", "document", false},
    {"published", "report", false},
    {"published", "seal", false},
    {"published", "curves_seal", false},
    {"published", "revision", false},
    {"curve", "data", false},
    {"curve", "quantity", false},
    {"curve", "case_number", false},
    {"point", "y", false},
    {"scalar", "value", false},
    {"study_case", "parameters", false},
    {"study_case", "seal", false},
    {"study_case", "revision", false},
};
enum { PLACE_COUNT = sizeof PLACES / sizeof *PLACES, FLIPS_EACH = 2, FILE_FLIPS = 40 };

/* Flips a bit of the value in a row. */
static void flip_value(sqlite3 *db, const struct place *place, int64_t row, uint64_t bit) {
    char sql[200];
    sqlite3_stmt *read = NULL, *write = NULL;
    bool rowless = strcmp(place->table, "point") == 0 || strcmp(place->table, "scalar") == 0 ||
                   strcmp(place->table, "study_case") == 0;
    snprintf(sql, sizeof sql, "SELECT %s, %s FROM %s WHERE %s IS NOT NULL LIMIT 1 OFFSET %lld",
             place->column, rowless ? "0" : "rowid", place->table, place->column, (long long)row);
    assert_int_equal(sqlite3_prepare_v2(db, sql, -1, &read, NULL), SQLITE_OK);
    assert_int_equal(sqlite3_step(read), SQLITE_ROW);
    int type = sqlite3_column_type(read, 0);
    int64_t id = sqlite3_column_int64(read, 1), integer = sqlite3_column_int64(read, 0);
    double number = sqlite3_column_double(read, 0);
    int size = sqlite3_column_bytes(read, 0);
    unsigned char *bytes = calloc(1, (size_t)size + 1);
    assert_non_null(bytes);
    if (size > 0)
        memcpy(bytes, sqlite3_column_blob(read, 0), (size_t)size);
    sqlite3_finalize(read);
    if (rowless)
        snprintf(sql, sizeof sql, "UPDATE %s SET %s = ?1 WHERE %s IS ?2", place->table,
                 place->column, place->column);
    else
        snprintf(sql, sizeof sql, "UPDATE %s SET %s = ?1 WHERE rowid = %lld", place->table,
                 place->column, (long long)id);
    assert_int_equal(sqlite3_prepare_v2(db, sql, -1, &write, NULL), SQLITE_OK);
    unsigned char *copy = malloc((size_t)size + 1);
    assert_non_null(copy);
    memcpy(copy, bytes, (size_t)size + 1);
    if (type == SQLITE_TEXT || type == SQLITE_BLOB) {
        assert_true(size > 0);
        bytes[bit / 8 % (uint64_t)size] ^= (unsigned char)(1u << (bit % 8));
    }
    uint64_t bits;
    memcpy(&bits, &number, sizeof bits);
    double flipped;
    bits ^= UINT64_C(1) << (bit % 64);
    memcpy(&flipped, &bits, sizeof flipped);
    if (type == SQLITE_INTEGER) {
        sqlite3_bind_int64(write, 1, integer ^ (int64_t)(UINT64_C(1) << (bit % 62)));
        sqlite3_bind_int64(write, 2, integer);
    } else if (type == SQLITE_FLOAT) {
        sqlite3_bind_double(write, 1, flipped);
        sqlite3_bind_double(write, 2, number);
    } else if (type == SQLITE_TEXT) {
        sqlite3_bind_text(write, 1, (const char *)bytes, size, SQLITE_STATIC);
        sqlite3_bind_text(write, 2, (const char *)copy, size, SQLITE_STATIC);
    } else {
        sqlite3_bind_blob(write, 1, bytes, size, SQLITE_STATIC);
        sqlite3_bind_blob(write, 2, copy, size, SQLITE_STATIC);
    }
    if (sqlite3_step(write) != SQLITE_DONE)
        fail_msg("%s: %s", sql, sqlite3_errmsg(db));
    if (sqlite3_changes(db) == 0)
        fail_msg("%s changed nothing", sql);
    sqlite3_finalize(write);
    free(bytes);
    free(copy);
}

static int64_t rows_of(sqlite3 *db, const struct place *place) {
    char sql[80];
    sqlite3_stmt *row = NULL;
    snprintf(sql, sizeof sql, "SELECT count(%s) FROM %s", place->column, place->table);
    assert_int_equal(sqlite3_prepare_v2(db, sql, -1, &row, NULL), SQLITE_OK);
    assert_int_equal(sqlite3_step(row), SQLITE_ROW);
    int64_t count = sqlite3_column_int64(row, 0);
    sqlite3_finalize(row);
    assert_true(count > 0);
    return count;
}

static void damage(const struct place *place, uint64_t *random, struct outcome *outcome) {
    sqlite3 *db = NULL;
    char what[120];
    copy_file("whole.db", "damaged.db");
    if (place->merged)
        sql_change("damaged.db", "DELETE FROM published");
    assert_int_equal(sqlite3_open("damaged.db", &db), SQLITE_OK);
    int64_t row = (int64_t)(next_word(random) % (uint64_t)rows_of(db, place));
    uint64_t bit = next_word(random) >> 16;
    flip_value(db, place, row, bit);
    sqlite3_close(db);
    snprintf(what, sizeof what, "%s.%s, row %lld, bit %llu", place->table, place->column,
             (long long)row, (unsigned long long)bit);
    read_damaged("damaged.db", what, outcome);
    remove_store("damaged.db");
}

static void no_changed_value_changes_a_result(void **state) {
    (void)state;
    struct outcome outcome = {0};
    uint64_t random = seed_of_now();
    for (size_t p = 0; p < PLACE_COUNT; p++)
        for (size_t n = 0; n < FLIPS_EACH * effort(); n++)
            damage(&PLACES[p], &random, &outcome);
    print_message("%u cases read as before, %u refused\n", outcome.same, outcome.refused);
    assert_true(outcome.same > outcome.refused);
    assert_true(outcome.refused > 0);
}

/* --- a bit of the file --- */

static void no_changed_bit_of_the_file_changes_a_result(void **state) {
    (void)state;
    struct outcome outcome = {0};
    uint64_t random = seed_of_now();
    for (size_t n = 0; n < FILE_FLIPS * effort(); n++) {
        char what[80];
        copy_file("whole.db", "damaged.db");
        flip_file_bit("damaged.db", &random, what, sizeof what);
        read_damaged("damaged.db", what, &outcome);
        remove_store("damaged.db");
    }
    print_message("%u cases read as before, %u refused\n", outcome.same, outcome.refused);
    assert_true(outcome.same > 0);
}

/* --- before anything ran --- */

/* A damaged case is not computed, and does not stand before others. */
static void a_damaged_case_is_not_computed(void **state) {
    (void)state;
    struct fixture fixture;
    struct error err = {0};
    struct failure *failures = NULL;
    size_t count = 0;
    fixture_open(&fixture);
    fixture_submit(&fixture, SMALL_STUDY, 6, NULL, 0);
    sql_change(fixture.database, "UPDATE study_case SET parameters = replace(parameters, '0.2', "
                                 "'0.3') WHERE number = 0");
    work_off(fixture.database);
    struct study_status status = fixture_status(&fixture);
    assert_string_equal(status.state, "failed");
    assert_int_equal(status.realisations_done, 24);
    assert_int_equal(status.realisations_failed, 24);
    study_status_clear(&status);
    assert_int_equal(store_failures(fixture.store, fixture.study, &failures, &count, &err), 0);
    assert_int_equal(count, 1);
    assert_int_equal(failures[0].case_number, 0);
    assert_non_null(strstr(failures[0].reason, "are damaged"));
    failures_free(failures, count);
    char *text = case_text(fixture.database, fixture.study, 1, &err);
    assert_non_null(text);
    assert_string_equal(text, whole.cases[1]);
    free(text);
    fixture_close(&fixture);
}

/* --- before it is stored --- */

/* A local worker stores no result that could not be merged; the job goes on once it is right. */
static void an_unfit_result_is_not_stored(void **state) {
    (void)state;
    struct fixture fixture;
    struct error err = {0};
    struct source *source = NULL;
    struct claimed_job job = {0};
    struct job_runner *runner = NULL;
    struct block_result block = {0};
    size_t found = 0;
    bool due = false;
    fixture_open(&fixture);
    fixture_submit(&fixture, SMALL_STUDY, 24, NULL, 0);
    struct source_options options = {.database = fixture.database, .worker = "one"};
    assert_int_equal(source_create(&source, &options, &err), 0);
    assert_int_equal(source_claim(source, &(struct wish){.count = 1}, &job, &found, &due, &err), 0);
    assert_int_equal(found, 1);
    const struct job_kind *kind = kind_find(job.kind);
    assert_int_equal(
        runner_create(&runner, kind, job.parameters, NULL, job.seed, job.sequence, &err), 0);
    assert_int_equal(runner_run(runner, job.first, job.count, NULL, &block, &err), 0);
    const double *scalars = block.scalars;
    double *others = calloc(block.scalar_count * block.count, sizeof *others);
    assert_non_null(others);
    for (size_t a = 0; a < block.scalar_count * block.count; a++)
        others[a] = scalars[a] + 1;
    block.scalars = others;
    struct report report = {.verb = REPORT_COMPLETE, .job = &job, .result = &block};
    assert_int_equal(source_report(source, &report, 1, &due, &err), 0);
    assert_int_equal(report.status, ERROR_INPUT);
    assert_non_null(strstr(report.err.text, "does not belong"));
    block.scalars = scalars;
    report = (struct report){
        .verb = REPORT_FAIL, .job = &job, .reason = "the result was refused", .permanent = true};
    assert_int_equal(source_report(source, &report, 1, &due, &err), 0);
    assert_int_equal(report.status, 0);
    struct study_status status = fixture_status(&fixture);
    assert_true(status.jobs_done == 0 && status.jobs_failed == 1);
    study_status_clear(&status);
    claimed_job_clear(&job);
    uint64_t again = 0;
    assert_int_equal(store_retry(fixture.store, fixture.study, 0, &again, &err), 0);
    assert_true(again > 0);
    work_off(fixture.database);
    status = fixture_status(&fixture);
    assert_string_equal(status.state, "done");
    study_status_clear(&status);
    free(others);
    block_result_clear(&block);
    runner_destroy(&runner);
    source_destroy(&source);
    fixture_close(&fixture);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_changed_value_changes_a_result),
        cmocka_unit_test(no_changed_bit_of_the_file_changes_a_result),
        cmocka_unit_test(a_damaged_case_is_not_computed),
        cmocka_unit_test(an_unfit_result_is_not_stored),
    };
    return cmocka_run_group_tests(tests, whole_set_up, whole_tear_down);
}
