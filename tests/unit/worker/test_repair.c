/* Protects: `rugo verify` finds what is damaged in a store, and `rugo repair` restores it: with
 * what is computed anew the results are byte for byte what they were. */
#include "tests/support/effort.h"
#include "tests/support/seed.h"
#include "tests/unit/worker/damaged_store.h"
#include "worker/publish/verify.h"

/* What verify says, a line a flaw. */
struct told {
    char text[4096];
    unsigned of[FLAW_KINDS];
};

static int note_flaw(void *context, const struct flaw *flaw, struct error *err) {
    (void)err;
    struct told *told = context;
    size_t used = strlen(told->text);
    snprintf(told->text + used, sizeof told->text - used, "%lld %llu+%llu %s\n",
             (long long)flaw->case_number, (unsigned long long)flaw->first,
             (unsigned long long)flaw->count, flaw->text);
    told->of[flaw->kind]++;
    return 0;
}

/* Returns the number of flaws. */
static uint64_t verify(const char *path, struct told *told, struct error *err) {
    const struct verification verification = {.found = note_flaw, .context = told};
    struct store_options options = {.read_only = true};
    struct verify_report report = {0};
    struct store *store = NULL;
    *told = (struct told){{0}, {0}};
    *err = (struct error){0};
    if (store_open(&store, path, &options, err) != 0)
        return 1;
    int status = verify_store(store, &verification, false, &report, err);
    store_close(&store);
    return report.counts.flaws + (status != 0);
}

static int repair_reported(const char *path, struct repair_report *report, struct error *err) {
    struct told told = {{0}, {0}};
    const struct verification verification = {.found = note_flaw, .context = &told};
    struct store_options options = {.existing = true};
    struct store *store = NULL;
    *report = (struct repair_report){0};
    int status = store_open(&store, path, &options, err);
    if (status == 0)
        status = store_take_alone(store, err);
    if (status == 0)
        status = repair_store(store, &verification, report, err);
    store_close(&store);
    return status;
}

static int repair(const char *path, struct error *err) {
    struct repair_report report;
    return repair_reported(path, &report, err);
}

static void check_same(const char *path, const char *what) {
    for (int64_t c = 0; c < CASES; c++) {
        struct error err;
        char *text = case_text(path, whole.study, c, &err);
        if (text == NULL)
            fail_msg("%s: case %d: %s", what, (int)c, err.text);
        else if (strcmp(text, whole.cases[c]) != 0)
            fail_msg("%s: case %d has changed", what, (int)c);
        free(text);
    }
}

/* A case of four blocks in another form of results is given up whole, and all of them are counted;
 * where the form is this program's, it is the damaged block alone. So it is with a target,
 * whose components are repaired by another build. */
static void results_given_up_are_counted(void **state) {
    (void)state;
    static const char TARGET[] =
        "{\"name\":\"t\",\"kind\":\"statistics\",\"seed\":5,\"target\":{\"error\":0.1},\"surface\":"
        "{"
        "\"dimension\":1,\"hurst\":0.8,\"wavelength_ratio\":4,\"length_ratio\":4}}";
    static const char DAMAGE[] = "; UPDATE result SET seal = seal + 1 WHERE job_id = (SELECT "
                                 "min(id) FROM job WHERE case_number = 1)";
    static const struct {
        const char *sql;
        bool target;
        uint64_t blocks;
    } REPAIRS[] = {{"UPDATE study SET program = 'other'", false, 1},
                   {"UPDATE study SET edition = 1", false, 4},
                   {"UPDATE study SET program = 'other'", true, 1}};
    for (size_t c = 0; c < sizeof REPAIRS / sizeof *REPAIRS; c++) {
        struct fixture fixture;
        struct error err = {0};
        struct repair_report report;
        char sql[300];
        fixture_open(&fixture);
        fixture_submit(&fixture, REPAIRS[c].target ? TARGET : SMALL_STUDY, 6, NULL, 0);
        store_close(&fixture.store);
        if (REPAIRS[c].target)
            sql_change(fixture.database, "UPDATE study_case SET block = 6");
        work_off(fixture.database);
        assert_true(
            sql_integer(fixture.database, "SELECT count(*) FROM job WHERE case_number = 1") >= 4);
        snprintf(sql, sizeof sql, "%s%s", REPAIRS[c].sql, DAMAGE);
        sql_change(fixture.database, sql);
        if (repair_reported(fixture.database, &report, &err) != 0)
            fail_msg("%s", err.text);
        assert_int_equal(report.blocks, REPAIRS[c].blocks);
        remove_store(fixture.database);
    }
}

#define BLOCK "(SELECT id FROM job WHERE case_number = 1 AND first = 6)"

static const struct damage {
    const char *sql;
    enum flaw_kind kind; /* reported among others */
} DAMAGES[] = {
    {"UPDATE result SET data = zeroblob(length(data)) WHERE job_id = " BLOCK, FLAW_BLOCK},
    {"UPDATE result SET data = x'' WHERE job_id = " BLOCK, FLAW_BLOCK},
    {"UPDATE result SET scalars = replace(scalars, '1', '2') WHERE job_id = " BLOCK, FLAW_BLOCK},
    {"UPDATE result SET seal = seal + 1 WHERE job_id = " BLOCK, FLAW_BLOCK},
    {"UPDATE result SET names_id = 77 WHERE job_id = " BLOCK, FLAW_BLOCK},
    {"UPDATE scalar_names SET names = replace(names, 'skewness', 'skewnexx')", FLAW_BLOCK},
    {"DELETE FROM result WHERE job_id = " BLOCK, FLAW_BLOCK},
    {"DELETE FROM result", FLAW_BLOCK},
    {"UPDATE job SET state = 'waiting' WHERE id = " BLOCK, FLAW_BLOCK},
    {"UPDATE job SET first = 8 WHERE id = " BLOCK, FLAW_COVER},
    {"UPDATE job SET count = 4096 WHERE id = " BLOCK, FLAW_COVER},
    {"UPDATE job SET case_number = 9 WHERE id = " BLOCK, FLAW_COVER},
    {"UPDATE job SET case_number = 0 WHERE id = " BLOCK, FLAW_COVER},
    {"PRAGMA foreign_keys = ON; DELETE FROM job WHERE id = " BLOCK, FLAW_COVER},
    {"PRAGMA foreign_keys = ON; DELETE FROM job", FLAW_COVER},
    {"PRAGMA foreign_keys = OFF; DELETE FROM job WHERE id = " BLOCK, FLAW_REFERENCE},
    {"PRAGMA foreign_keys = OFF; DELETE FROM curve WHERE case_number = 1", FLAW_REFERENCE},
    {"UPDATE study_case SET parameters = replace(parameters, '0.8', '0.9')", FLAW_CASE},
    {"UPDATE study_case SET parameters = '{}' WHERE number = 1", FLAW_CASE},
    {"UPDATE study_case SET seal = 0", FLAW_CASE},
    {"UPDATE study SET seed = '8'", FLAW_CASE},
    {"UPDATE study SET random = 'independent'", FLAW_CASE},
    {"UPDATE published SET document = replace(document, '0.', '1.') WHERE case_number = 1",
     FLAW_PUBLISHED},
    {"UPDATE published SET report = '{}'", FLAW_PUBLISHED},
    {"UPDATE published SET seal = 1", FLAW_PUBLISHED},
    {"DELETE FROM published WHERE case_number = 0", FLAW_PUBLISHED},
    {"UPDATE published SET revision = 1", FLAW_PUBLISHED},
    {"UPDATE curve SET data = zeroblob(64) WHERE id = 4", FLAW_PUBLISHED},
    {"UPDATE curve SET quantity = 'colour' WHERE id = 4", FLAW_PUBLISHED},
    {"PRAGMA foreign_keys = ON; DELETE FROM curve WHERE id = 4", FLAW_PUBLISHED},
    {"UPDATE point SET y = y * 2 WHERE curve_id = 4", FLAW_PUBLISHED},
    {"UPDATE scalar SET value = value + 1", FLAW_PUBLISHED},
    {"DELETE FROM point WHERE curve_id = 5 AND number = 1", FLAW_PUBLISHED},
    {"UPDATE study SET jobs_done = 3", FLAW_COUNTER},
    {"UPDATE study SET jobs_waiting = 3, jobs = jobs + 3", FLAW_COUNTER},
    {"UPDATE study SET realisations_done = 3", FLAW_COUNTER},
    {"UPDATE study SET realisations_failed = 3", FLAW_COUNTER},
    {"UPDATE study SET realisations_waiting = 3", FLAW_COUNTER},
    {"UPDATE study_case SET realisations_done = 0", FLAW_COUNTER},
    {"UPDATE study_case SET jobs_left = 2", FLAW_COUNTER},
};
enum { DAMAGE_COUNT = sizeof DAMAGES / sizeof *DAMAGES };

static void damage_is_found_and_mended(void **state) {
    (void)state;
    struct error err = {0};
    struct told told;
    assert_true(verify("whole.db", &told, &err) == 0);
    assert_string_equal(told.text, "");
    for (size_t d = 0; d < DAMAGE_COUNT; d += case_step()) {
        const char *what = DAMAGES[d].sql;
        copy_file("whole.db", "damaged.db");
        sql_change("damaged.db", what);
        if (verify("damaged.db", &told, &err) == 0)
            fail_msg("%s: is not found", what);
        if (told.of[DAMAGES[d].kind] == 0)
            fail_msg("%s: is found as: %s", what, told.text);
        if (repair("damaged.db", &err) != 0)
            fail_msg("%s: %s", what, err.text);
        work_off("damaged.db");
        if (verify("damaged.db", &told, &err) != 0)
            fail_msg("%s: still there: %s%s", what, told.text, err.text);
        check_same("damaged.db", what);
        remove_store("damaged.db");
    }
}

/* A bit anywhere in the file: what verify says is whole reads as before, and what is repaired, too;
 * what cannot be is refused with a word. */
static void a_changed_bit_of_the_file_is_found(void **state) {
    (void)state;
    uint64_t random = seed_of_now();
    unsigned found = 0, mended = 0, refused = 0;
    for (size_t n = 0; n < 12 * effort(); n++) {
        struct error err = {0};
        struct told told;
        char what[80];
        copy_file("whole.db", "damaged.db");
        flip_file_bit("damaged.db", &random, what, sizeof what);
        bool flawed = verify("damaged.db", &told, &err) > 0;
        found += flawed;
        if (!flawed) {
            check_same("damaged.db", what);
        } else if (repair("damaged.db", &err) != 0) {
            assert_true(err.text[0] != '\0');
            refused++;
        } else if (verify("damaged.db", &told, &err) == 0) {
            work_off("damaged.db");
            check_same("damaged.db", what);
            mended++;
        }
        remove_store("damaged.db");
    }
    print_message("%u found, %u mended, %u refused\n", found, mended, refused);
    assert_true(found > 0);
}

/* A character of a study's document, whether it is JSON still or not. Nothing else has it, so that
 * repair leaves it, and says so. */
static void a_changed_document_is_found(void **state) {
    (void)state;
    static const char *const CHANGES[] = {
        "UPDATE study_source SET source = replace(source, '\"hurst\":', '\"hurst\"=')",
        "UPDATE study_source SET source = replace(source, '\"realisations\":24', "
        "'\"realisations\":25')",
        "UPDATE study_source SET seal = NULL, source = substr(source, 2)"};
    for (size_t c = 0; c < sizeof CHANGES / sizeof *CHANGES; c++) {
        struct error err = {0};
        struct told told;
        copy_file("whole.db", "damaged.db");
        sql_change("damaged.db", CHANGES[c]);
        for (int again = 0; again < 2; again++) {
            if (verify("damaged.db", &told, &err) == 0)
                fail_msg("%s: is not found", CHANGES[c]);
            assert_non_null(strstr(told.text, "its document does not match its checksum"));
            assert_int_equal(repair("damaged.db", &err), 0);
        }
        remove_store("damaged.db");
    }
}

/* A bit of the text that says what a table is: the key of names is none any more, which SQLite
 * takes as it is; nothing stored in such a table would be found. */
static void a_changed_layout_is_found(void **state) {
    (void)state;
    static const char *const CHANGES[] = {
        "UPDATE sqlite_schema SET sql = replace(sql, 'PRIMARY', 'QRIMARY') WHERE name = "
        "'scalar_names'",
        "UPDATE sqlite_schema SET sql = replace(sql, 'names TEXT', 'names TEXU') WHERE name = "
        "'scalar_names'",
        "UPDATE sqlite_schema SET sql = replace(sql, 'realisation', 'realisatioo') WHERE name = "
        "'case_progress'"};
    for (size_t c = 0; c < sizeof CHANGES / sizeof *CHANGES; c++) {
        struct error err = {0};
        struct told told;
        char sql[400];
        copy_file("whole.db", "damaged.db");
        snprintf(sql, sizeof sql, "PRAGMA writable_schema = ON; %s", CHANGES[c]);
        sql_change("damaged.db", sql);
        if (verify("damaged.db", &told, &err) == 0)
            fail_msg("%s: is not found", CHANGES[c]);
        if (strstr(told.text, "the layout of") == NULL)
            fail_msg("%s: is found as: %s%s", CHANGES[c], told.text, err.text);
        assert_int_equal(repair("damaged.db", &err), ERROR_INPUT);
        assert_non_null(strstr(err.text, "the file itself is damaged"));
        remove_store("damaged.db");
    }
}

/* Nobody changes a store while it is repaired, and a live one can be looked at. */
static void repair_needs_the_store_alone(void **state) {
    (void)state;
    struct error err = {0};
    struct told told;
    struct store *other = NULL;
    copy_file("whole.db", "shared.db");
    assert_int_equal(store_open(&other, "shared.db", NULL, &err), 0);
    assert_true(verify("shared.db", &told, &err) == 0);
    assert_int_equal(repair("shared.db", &err), ERROR_STATE);
    assert_non_null(strstr(err.text, "another process"));
    store_close(&other);
    assert_int_equal(repair("shared.db", &err), 0);
    check_same("shared.db", "a whole store");
    remove_store("shared.db");
}

/* What an older program stored has no checksum, which is reported, and is added. */
static void what_has_no_checksum_gets_one(void **state) {
    (void)state;
    struct error err = {0};
    struct told told;
    copy_file("whole.db", "older.db");
    sql_change("older.db",
               "UPDATE result SET seal = NULL; UPDATE study_case SET seal = NULL; UPDATE "
               "published SET seal = NULL, rows_seal = NULL, curves_seal = NULL");
    assert_true(verify("older.db", &told, &err) == 0);
    check_same("older.db", "without checksums");
    assert_int_equal(repair("older.db", &err), 0);
    check_same("older.db", "with checksums");
    sql_change("older.db", "UPDATE published SET document = replace(document, '0.', '1.')");
    assert_true(verify("older.db", &told, &err) > 0);
    remove_store("older.db");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(damage_is_found_and_mended),
        cmocka_unit_test(results_given_up_are_counted),
        cmocka_unit_test(a_changed_bit_of_the_file_is_found),
        cmocka_unit_test(a_changed_document_is_found),
        cmocka_unit_test(a_changed_layout_is_found),
        cmocka_unit_test(repair_needs_the_store_alone),
        cmocka_unit_test(what_has_no_checksum_gets_one),
    };
    return cmocka_run_group_tests(tests, whole_set_up, whole_tear_down);
}
