/* Protects: stores that people have. The migrations 001 to 021 are never edited, which their hashes
 * say, and none is left out. A new store, which runs none of them, has the layout that they make,
 * to the letter. A lease of a store of version 14, made here by its migrations, is kept; stores
 * that programs of other versions left are in tests/unit/worker/test_older_stores.c. */
#include "schema/store/store.h"
#include "tests/support/check.h"
#include "tests/support/sql.h"
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* A file of the project as it is in the tree; the caller frees. NULL when there is none. */
static char *read_source(const char *name, size_t *size) {
    char path[512];
    const char *source = getenv("RUGO_SOURCE");
    snprintf(path, sizeof path, "%s/%s", source != NULL ? source : ".", name);
    FILE *file = fopen(path, "rb");
    if (file == NULL)
        return NULL;
    enum { MOST = 1 << 20 };
    char *text = malloc(MOST);
    assert_non_null(text);
    *size = fread(text, 1, MOST - 1, file);
    text[*size] = 0;
    fclose(file);
    return text;
}

/* FNV-1a of 64 bits. */
static uint64_t hash_of(const char *text, size_t size) {
    uint64_t hash = 0xcbf29ce484222325u;
    for (size_t i = 0; i < size; i++)
        hash = (hash ^ (unsigned char)text[i]) * 0x100000001b3u;
    return hash;
}

/* Whoever has to change a table writes a new migration: stores of these versions exist. */
static void released_migrations_are_frozen(void **state) {
    (void)state;
    static const struct {
        const char *name;
        uint64_t hash;
    } FROZEN[] = {{"schema/store/migrations/001.sql", 0xcf5a6eed7acfb57au},
                  {"schema/store/migrations/002.sql", 0xd8f023bf731441d3u},
                  {"schema/store/migrations/003.sql", 0xd3606d69b5e99841u},
                  {"schema/store/migrations/004.sql", 0x65a059156daafa6fu},
                  {"schema/store/migrations/005.sql", 0xd323a4efa3489637u},
                  {"schema/store/migrations/006.sql", 0x9a89fdf526d611cau},
                  {"schema/store/migrations/007.sql", 0xcd64f16d5e3429ceu},
                  {"schema/store/migrations/008.sql", 0xfce3dfd9844fee0du},
                  {"schema/store/migrations/009.sql", 0xf1d3635a8bbe9885u},
                  {"schema/store/migrations/010.sql", 0xae4e92da6ff3d2c9u},
                  {"schema/store/migrations/011.sql", 0xfd1ef60cd56112aau},
                  {"schema/store/migrations/012.sql", 0x13877ee471321076u},
                  {"schema/store/migrations/013.sql", 0x2fdb199e1e71779fu},
                  {"schema/store/migrations/014.sql", 0x883758ebd0e18cd7u},
                  {"schema/store/migrations/015.sql", 0x2325eccfabc89770u},
                  {"schema/store/migrations/016.sql", 0xf8c22b61193d5927u},
                  {"schema/store/migrations/017.sql", 0x893a503a44ca46e9u},
                  {"schema/store/migrations/018.sql", 0x700e65bfd079ccaau},
                  {"schema/store/migrations/019.sql", 0x2197356827624959u},
                  {"schema/store/migrations/020.sql", 0xdede4df9fec957c9u},
                  {"schema/store/migrations/021.sql", 0x13b1312be2caa58cu}};
    for (size_t f = 0; f < sizeof FROZEN / sizeof *FROZEN; f++) {
        size_t size = 0;
        char *text = read_source(FROZEN[f].name, &size);
        assert_non_null(text);
        if (hash_of(text, size) != FROZEN[f].hash)
            fail_msg("%s is %#" PRIx64 ": a migration that was released was edited", FROZEN[f].name,
                     hash_of(text, size));
        free(text);
    }
}

/* The files of the tree and the versions of the program are the same list. */
static void every_migration_is_linked_in(void **state) {
    (void)state;
    struct store *store = NULL;
    int64_t files = 0;
    for (bool found = true; found; files += found) {
        char name[64];
        size_t size = 0;
        snprintf(name, sizeof name, "schema/store/migrations/%03d.sql", (int)files + 1);
        char *text = read_source(name, &size);
        found = text != NULL;
        free(text);
    }
    assert_true(files >= 1);
    assert_int_equal(store_open(&store, "new.db", NULL, NULL), 0);
    store_close(&store);
    assert_int_equal(sql_integer("new.db", "PRAGMA user_version"), files);
}

/* Runs statements on a file that this program does not have open. */
static void execute(sqlite3 *db, const char *sql) {
    char *why = NULL;
    if (sqlite3_exec(db, sql, NULL, NULL, &why) != SQLITE_OK)
        fail_msg("%s", why);
}

/* Runs a migration of the tree. Returns whether there is one of this number. */
static bool run_migration(sqlite3 *db, int number) {
    char name[64];
    size_t size = 0;
    snprintf(name, sizeof name, "schema/store/migrations/%03d.sql", number);
    char *text = read_source(name, &size);
    if (text != NULL)
        execute(db, text);
    free(text);
    return text != NULL;
}

static void print_value(FILE *file, sqlite3_stmt *row, int column) {
    const char *text = (const char *)sqlite3_column_text(row, column);
    bool quoted = sqlite3_column_type(row, column) == SQLITE_TEXT;
    fprintf(file, quoted ? "'%s'" : "%s", text != NULL ? text : "NULL");
}

static void print_rows(FILE *file, sqlite3 *db, const char *table) {
    sqlite3_stmt *row = NULL;
    char sql[128];
    snprintf(sql, sizeof sql, "SELECT * FROM \"%s\"", table);
    assert_int_equal(sqlite3_prepare_v2(db, sql, -1, &row, NULL), SQLITE_OK);
    while (sqlite3_step(row) == SQLITE_ROW) {
        fprintf(file, "INSERT INTO %s VALUES (", table);
        for (int c = 0; c < sqlite3_column_count(row); c++) {
            fputs(c > 0 ? ", " : "", file);
            print_value(file, row, c);
        }
        fputs(");\n", file);
    }
    sqlite3_finalize(row);
}

/* Gives the statements that make a database, in the order in which it was made; the caller frees.
 */
static char *statements_of(sqlite3 *db) {
    static const char *const OBJECTS[] = {"", " AND type = 'table'"};
    char *text = NULL;
    size_t size = 0;
    FILE *file = open_memstream(&text, &size);
    assert_non_null(file);
    for (int rows = 0; rows < 2; rows++) {
        sqlite3_stmt *object = NULL;
        char sql[160];
        snprintf(sql, sizeof sql,
                 "SELECT name, sql FROM sqlite_schema WHERE name NOT LIKE 'sqlite_%%'%s ORDER BY "
                 "rowid",
                 OBJECTS[rows]);
        assert_int_equal(sqlite3_prepare_v2(db, sql, -1, &object, NULL), SQLITE_OK);
        while (sqlite3_step(object) == SQLITE_ROW)
            if (rows == 0)
                fprintf(file, "%s;\n", (const char *)sqlite3_column_text(object, 1));
            else
                print_rows(file, db, (const char *)sqlite3_column_text(object, 0));
        sqlite3_finalize(object);
    }
    assert_int_equal(fclose(file), 0);
    return text;
}

static void no_digest(sqlite3_context *context, int count, sqlite3_value **values) {
    (void)count;
    sqlite3_result_value(context, values[0]);
}

/* Tables, indices and views of a new store, and its rows, are those that the migrations make of an
 * empty file, to the letter. */
static void a_new_store_is_what_migrations_make(void **state) {
    (void)state;
    sqlite3 *migrated = NULL, *fresh = NULL;
    struct store *store = NULL;
    int count = 0;
    assert_int_equal(sqlite3_open(":memory:", &migrated), SQLITE_OK);
    sqlite3_create_function(migrated, "lease_digest", 1, SQLITE_UTF8, NULL, no_digest, NULL, NULL);
    while (run_migration(migrated, count + 1))
        count++;
    assert_true(count >= 21);
    assert_int_equal(store_open(&store, "fresh.db", NULL, NULL), 0);
    store_close(&store);
    assert_int_equal(sqlite3_open("fresh.db", &fresh), SQLITE_OK);
    execute(fresh, "DELETE FROM boot"); /* which this machine's start has filled */
    char *wanted = statements_of(migrated), *found = statements_of(fresh);
    if (strcmp(wanted, found) != 0)
        print_error("schema/store/layout.sql is not this:\n%s", wanted);
    assert_true(strlen(wanted) > 1000 && strcmp(wanted, found) == 0);
    free(wanted);
    free(found);
    sqlite3_close(migrated);
    sqlite3_close(fresh);
}

/* Before version 15 the token of a lease was in the store as it is. It becomes a digest there,
 * under which its holder goes on; nothing of it is left in the file. */
static void a_live_lease_outlives_the_digests(void **state) {
    (void)state;
    static const char TOKEN[] = "00112233445566778899aabbccddeeff";
    sqlite3 *db = NULL;
    struct store *store = NULL;
    assert_int_equal(sqlite3_open("plain.db", &db), SQLITE_OK);
    for (int n = 1; n <= 14; n++)
        assert_true(run_migration(db, n));
    execute(db,
            "PRAGMA application_id = 0x5255474f; PRAGMA user_version = 14;"
            "INSERT INTO study (id, public, name, kind, seed, realisations, state, cases, jobs, "
            "jobs_waiting, jobs_running, jobs_done, created) VALUES (1, 's', 's', 'boxes', '1', "
            "30, 'running', 1, 3, 1, 1, 1, '');"
            "INSERT INTO study_case (study_id, number, parameters, estimate, jobs, jobs_left) "
            "VALUES (1, 0, '{}', 0.1, 3, 2);"
            "INSERT INTO job (id, study_id, case_number, first, count, state, token) VALUES (1, "
            "1, 0, 0, 10, 'done', '00112233445566778899aabbccddeeee'), (2, 1, 0, 10, 10, "
            "'running', '00112233445566778899aabbccddeeff'), (3, 1, 0, 20, 10, 'waiting', NULL)");
    assert_int_equal(sqlite3_close(db), SQLITE_OK);
    assert_int_equal(store_open(&store, "plain.db", NULL, NULL), 0);
    assert_int_equal(store_heartbeat(store, 2, TOKEN, 1, NULL), 0);
    assert_int_equal(store_heartbeat(store, 2, "00112233445566778899aabbccddeef0", 1, NULL),
                     ERROR_STATE);
    struct claim claim = {.worker = "w", .count = 1};
    struct claimed_job job = {0};
    size_t count = 0;
    assert_int_equal(store_claim(store, &claim, &job, &count, NULL), 0);
    assert_true(count == 1 && job.id == 3 && job.count == 10); /* as it was cut */
    claimed_job_clear(&job);
    store_close(&store);
    size_t size = 0;
    FILE *file = fopen("plain.db", "rb");
    char *bytes = malloc(1 << 20);
    assert_true(file != NULL && bytes != NULL);
    size = fread(bytes, 1, 1 << 20, file);
    fclose(file);
    assert_true(size > 0 && memmem(bytes, size, "00112233", 8) == NULL);
    free(bytes);
    assert_int_equal(sql_integer("plain.db", "SELECT count(*) FROM job WHERE token IS NULL"), 1);
    assert_int_equal(sql_integer("plain.db", "SELECT realisations_waiting FROM study"), 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(released_migrations_are_frozen),
        cmocka_unit_test(every_migration_is_linked_in),
        cmocka_unit_test(a_new_store_is_what_migrations_make),
        cmocka_unit_test(a_live_lease_outlives_the_digests),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
