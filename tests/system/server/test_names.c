/* Protects: names and reasons of an older store, or of a peer, that hold control characters reach
 * neither a terminal nor a picture as such. */
#include "tests/support/check.h"
#include "tests/support/process.h"
#include "tests/support/small_studies.h"
#include <sqlite3.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* What a terminal would obey, in the name of a study, a worker, a host and a reason. */
#define EVIL "'x' || char(27) || '[2J' || char(155) || '31m' || char(1, 7, 8, 13, 127) || 'y<&'"

static void spoil(const char *path) {
    sqlite3 *db = NULL;
    assert_int_equal(sqlite3_open(path, &db), SQLITE_OK);
    if (sqlite3_exec(
            db,
            "UPDATE study SET name = " EVIL "; UPDATE job SET worker = " EVIL ", host = " EVIL
            "; UPDATE job SET state = 'failed', error = " EVIL
            " WHERE id = (SELECT min(id) FROM job); UPDATE study SET jobs_done = jobs_done "
            "- 1, jobs_failed = 1, state = 'failed'",
            NULL, NULL, NULL) != SQLITE_OK)
        fail_msg("%s", sqlite3_errmsg(db));
    sqlite3_close(db);
}

/* Nothing but lines of shown characters, some of them of the name. */
static void check_plain(const char *path, bool named) {
    char *text = slurp(path);
    for (const unsigned char *at = (const unsigned char *)text; *at != '\0'; at++)
        if ((*at < ' ' && *at != '\n') || *at == 0x7f || (*at == 0xc2 && at[1] < 0xa0))
            fail_msg("%s holds byte %#x: %.200s", path, *at, text);
    if (named && strstr(text, "[2J") == NULL)
        fail_msg("%s does not tell the name", path);
    free(text);
}

static void nothing_is_obeyed(void **state) {
    (void)state;
    static const struct question {
        const char *arguments[8];
        bool named;
    } QUESTIONS[] = {
        {{"status", "--db", "names.db", NULL}, true},
        {{"status", "--db", "names.db", "ID", NULL}, true},
        {{"table", "--db", "names.db", "ID", NULL}, true},
        {{"report", "--db", "names.db", "ID", NULL}, false},
        {{"curves", "--db", "names.db", "ID", "--format", "table", NULL}, true},
        {{"plot", "--db", "names.db", "ID", "--quantity", "psd", NULL}, true},
        {{"prune", "--db", "names.db", "--older-than", "1", NULL}, false},
        {{"show", "--db", "names.db", "no\033[2J", NULL}, false},
    };
    char id[20] = "";
    spit("one.json", ONE_CASE);
    assert_int_equal(run_rugo("run", (const char *[]){"run", "--db", "names.db", "one.json", NULL}),
                     0);
    char *list =
        (run_rugo("list", (const char *[]){"status", "--db", "names.db", NULL}), slurp("list.out"));
    const char *line = strchr(list, '\n');
    assert_non_null(line);
    assert_int_equal(sscanf(line + 1, "%17s", id), 1);
    free(list);
    spoil("names.db");
    for (size_t q = 0; q < sizeof QUESTIONS / sizeof *QUESTIONS; q++) {
        const char *arguments[8] = {NULL};
        for (size_t a = 0; QUESTIONS[q].arguments[a] != NULL; a++)
            arguments[a] =
                strcmp(QUESTIONS[q].arguments[a], "ID") == 0 ? id : QUESTIONS[q].arguments[a];
        (void)run_rugo("asked", arguments);
        check_plain("asked.out", QUESTIONS[q].named);
        check_plain("asked.err", false);
    }
    remove("names.db");
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(nothing_is_obeyed)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
