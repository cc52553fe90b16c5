/* Protects: large results and published cases are stored packed, and read as they were handed in;
 * those that an older program stored as they are, too; damaged ones are refused by name. */
#include "schema/result/bytes/curve_bytes.h"
#include "schema/store/store.h"
#include "schema/study/study_reader.h"
#include "tests/support/fake_kind.h"
#include "tests/support/sample_result.h"
#include "tests/support/sql.h"
#include <stdio.h>
#include <stdlib.h>

enum { LARGE = 50000, SMALL = 500 };
static unsigned char large[LARGE];

/* A store with one study of ten realisations, of which a block of so many bytes is done. */
static struct store *store_with(const char *path, size_t size, char id[STUDY_ID_SIZE]) {
    static const char TEXT[] = "{\"name\":\"n\",\"kind\":\"boxes\",\"realisations\":10,\"seconds\":"
                               "0.01,\"box\":{\"width\":1}}";
    static const char *const NAMES[] = {"a"};
    static const double scalars[10];
    struct store *store = NULL;
    struct study *study = NULL;
    struct fault_list faults = {0};
    struct claim claim = {.worker = "w", .count = 1};
    struct claimed_job job = {0};
    size_t count = 0;
    bool first, done;
    assert_int_equal(store_open(&store, path, NULL, NULL), 0);
    assert_int_equal(study_read(&study, TEXT, strlen(TEXT), NULL, FAKE_KINDS, 0, &faults, NULL), 0);
    assert_int_equal(store_submit(store, study, NULL, id, NULL, NULL), 0);
    study_destroy(&study);
    assert_int_equal(store_claim(store, &claim, &job, &count, NULL), 0);
    assert_true(count == 1 && job.first == 0 && job.count == 10);
    const struct block_result result = {.count = 10,
                                        .scalar_count = 1,
                                        .names = NAMES,
                                        .scalars = scalars,
                                        .data = large,
                                        .size = size,
                                        .seconds = 1,
                                        .cpu_seconds = 1};
    assert_int_equal(store_complete(store, job.id, job.token, &result, &first, &done, NULL), 0);
    claimed_job_clear(&job);
    return store;
}

static int compare_block(void *context, const struct block_result *result, struct error *err) {
    const size_t *size = context;
    (void)err;
    assert_int_equal(result->size, *size);
    assert_memory_equal(result->data, large, *size);
    return 0;
}

static int read_blocks(struct store *store, const char *id, size_t size, struct error *err) {
    *err = (struct error){0};
    return store_results(store, id, 0, compare_block, &size, err);
}

static int fill(void **state) {
    (void)state;
    for (size_t a = 0; a < LARGE; a++)
        large[a] = (unsigned char)(a / 100);
    return 0;
}

static void large_blocks_are_packed(void **state) {
    (void)state;
    char id[STUDY_ID_SIZE];
    struct error err;
    struct store *store = store_with("large.db", LARGE, id);
    assert_int_equal(read_blocks(store, id, LARGE, &err), 0);
    assert_true(sql_integer("large.db", "SELECT length(data) FROM result") < LARGE / 10);
    store_close(&store);
    store = store_with("small.db", SMALL, id);
    assert_int_equal(read_blocks(store, id, SMALL, &err), 0);
    assert_int_equal(sql_integer("small.db", "SELECT length(data) FROM result"), SMALL);
    store_close(&store);
}

/* With a checksum and without. */
static void what_older_programs_stored_is_read(void **state) {
    (void)state;
    char id[STUDY_ID_SIZE];
    struct error err;
    struct store *store = store_with("raw.db", LARGE, id);
    sqlite3 *db = sql_open("raw.db");
    sqlite3_stmt *change = NULL;
    assert_int_equal(
        sqlite3_prepare_v2(db, "UPDATE result SET data = ?, seal = NULL", -1, &change, NULL),
        SQLITE_OK);
    sqlite3_bind_blob(change, 1, large, LARGE, SQLITE_STATIC);
    assert_int_equal(sqlite3_step(change), SQLITE_DONE);
    sqlite3_finalize(change);
    sqlite3_close(db);
    assert_int_equal(read_blocks(store, id, LARGE, &err), 0);
    store_close(&store);
}

/* A byte of the packed block is changed; of a second one the size that it says to have. */
static void damaged_blocks_are_refused(void **state) {
    (void)state;
    static const char *const CHANGES[] = {
        "UPDATE result SET data = CAST(substr(data, 1, 60) || x'00' || substr(data, 62) AS BLOB)",
        "UPDATE result SET data = CAST(substr(data, 1, 8) || x'ff' || substr(data, 10) AS BLOB)",
        "UPDATE result SET data = substr(data, 1, length(data) - 5)"};
    for (int sealed = 0; sealed < 2; sealed++)
        for (size_t c = 0; c < sizeof CHANGES / sizeof *CHANGES; c++) {
            char id[STUDY_ID_SIZE], path[40];
            struct error err;
            snprintf(path, sizeof path, "damaged-%d-%zu.db", sealed, c);
            struct store *store = store_with(path, LARGE, id);
            sql_change(path, CHANGES[c]);
            if (!sealed)
                sql_change(path, "UPDATE result SET seal = NULL");
            assert_int_equal(read_blocks(store, id, LARGE, &err), ERROR_INPUT);
            assert_non_null(strstr(err.text, "the stored result of realisations 0 to 9"));
            store_close(&store);
        }
}

/* Curves of one quantity one after the other, as many as share bytes, and others between. */
static void make_result(struct case_result *out, size_t each) {
    static double x[50], y[50], error[50];
    static const char *const QUANTITIES[] = {"area", "gap", "area"};
    for (size_t a = 0; a < 50; a++) {
        x[a] = 0.1 * (double)a;
        y[a] = 1 / (1 + x[a]);
        error[a] = 0.01 * y[a];
    }
    *out = (struct case_result){.realisations = 10};
    for (size_t q = 0; q < 3; q++)
        for (size_t a = 0; a < each; a++) {
            struct curve curve = curve_named(QUANTITIES[q], "load", "A/A0");
            curve.series = a % 2 == 0 ? "edges" : "nodes";
            curve.level = (double)(1 + a);
            curve_set_points(&curve, 50, x, y, error);
            assert_int_equal(result_add_curve(out, &curve, NULL), 0);
        }
}

static unsigned char *bytes_of(const struct case_result *result, size_t *size) {
    unsigned char *data = NULL;
    assert_int_equal(curves_encode(result->curves, result->curve_count, &data, size, NULL), 0);
    return data;
}

static void published_curves_share_bytes(void **state) {
    (void)state;
    enum { EACH = 12 };
    char id[STUDY_ID_SIZE];
    struct case_result result, again = {0};
    struct case_info info;
    struct published_part all = {0}, gap = {.quantity = "gap"};
    bool found = false;
    struct store *store = store_with("curves.db", SMALL, id);
    make_result(&result, EACH);
    assert_int_equal(store_case(store, id, 0, &info, NULL), 0);
    assert_int_equal(store_publish(store, id, 0, info.revision, &result, NULL), 0);
    assert_int_equal(store_published(store, id, 0, info.revision, &all, &again, &found, NULL), 0);
    assert_true(found);
    size_t before = 0, after = 0;
    unsigned char *was = bytes_of(&result, &before), *is = bytes_of(&again, &after);
    assert_int_equal(after, before);
    assert_memory_equal(is, was, before);
    free(is);
    free(was);
    result_clear(&again);
    assert_int_equal(store_published(store, id, 0, info.revision, &gap, &again, &found, NULL), 0);
    assert_true(found && again.curve_count == EACH);
    for (size_t a = 0; a < EACH; a++)
        assert_true(strcmp(again.curves[a].quantity, "gap") == 0 &&
                    fabs(again.curves[a].level - (double)(1 + a)) <= 0);
    result_clear(&again);
    assert_int_equal(sql_integer("curves.db", "SELECT count(*) FROM curve"), 3 * EACH);
    assert_int_equal(sql_integer("curves.db", "SELECT count(data) FROM curve"), 3);
    assert_true(sql_integer("curves.db", "SELECT sum(length(data)) FROM curve") <
                (int64_t)before / 5);
    assert_int_equal(sql_integer("curves.db", "SELECT typeof(report) = 'blob' FROM published"), 1);
    struct case_report report = {0};
    assert_int_equal(store_published_report(store, id, 0, info.revision, &report, &found, NULL), 0);
    assert_true(found && report.curve_count == 3 * EACH);
    case_report_clear(&report);
    /* without the bytes of a group nothing is found, nor with those of another that are fewer */
    sql_change("curves.db", "UPDATE curve SET data = NULL WHERE quantity = 'gap'");
    assert_int_equal(store_published(store, id, 0, info.revision, &gap, &again, &found, NULL), 0);
    assert_false(found);
    struct due_case due;
    assert_true(store_found_damage(store, &due));
    case_info_clear(&info);
    result_clear(&result);
    store_close(&store);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(large_blocks_are_packed),
        cmocka_unit_test(what_older_programs_stored_is_read),
        cmocka_unit_test(damaged_blocks_are_refused),
        cmocka_unit_test(published_curves_share_bytes),
    };
    return cmocka_run_group_tests(tests, fill, NULL);
}
