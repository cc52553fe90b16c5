/* Protects: stores that people have. A migration that was released is never edited, none is left
 * out, and a store of every earlier version opens, is brought up to date and reads as before. */
#include "schema/store/store.h"
#include "tests/support/check.h"
#include <inttypes.h>
#include <sqlite3.h>
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

static int64_t integer_of(const char *path, const char *sql) {
    sqlite3 *db = NULL;
    sqlite3_stmt *row = NULL;
    assert_int_equal(sqlite3_open_v2(path, &db, SQLITE_OPEN_READONLY, NULL), SQLITE_OK);
    if (sqlite3_prepare_v2(db, sql, -1, &row, NULL) != SQLITE_OK)
        fail_msg("%s: %s", sql, sqlite3_errmsg(db));
    assert_int_equal(sqlite3_step(row), SQLITE_ROW);
    int64_t value = sqlite3_column_int64(row, 0);
    sqlite3_finalize(row);
    sqlite3_close(db);
    return value;
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
                  {"schema/store/migrations/013.sql", 0x2fdb199e1e71779fu}};
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
    assert_int_equal(integer_of("new.db", "PRAGMA user_version"), files);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(released_migrations_are_frozen),
        cmocka_unit_test(every_migration_is_linked_in),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
