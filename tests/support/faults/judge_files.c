/* What faults must not leave behind: a damaged store, rows that count twice, files, processes. */
#include "tests/support/check.h"
#include "tests/support/faults/world.h"
#include <dirent.h>
#include <errno.h>
#include <sqlite3.h>
#include <stdio.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

/* Each question has no row in a sound store; a row says what is wrong. */
static const char *const QUESTIONS[] = {
    "SELECT integrity_check FROM pragma_integrity_check WHERE integrity_check <> 'ok'",
    "SELECT \"table\" || ' refers to what is not there' FROM pragma_foreign_key_check",
    "SELECT 'job ' || id || ' is ' || state FROM job WHERE state <> 'done'",
    "SELECT 'job ' || id || ' has no result' FROM job WHERE id NOT IN (SELECT job_id FROM result)",
    "SELECT 'realisations of jobs ' || a.id || ' and ' || b.id || ' overlap' FROM job a JOIN job b "
    "ON a.study_id = b.study_id AND a.case_number = b.case_number AND a.id < b.id "
    "WHERE a.first < b.first + b.count AND b.first < a.first + a.count",
    "SELECT s.name || ', case ' || j.case_number || ', has ' || sum(j.count) || ' of ' || "
    "s.realisations || ' realisations' FROM study s JOIN job j ON j.study_id = s.id "
    "GROUP BY s.id, j.case_number HAVING sum(j.count) <> s.realisations",
    "SELECT name || ' counts ' || realisations_done || ' realisations as done' FROM study "
    "WHERE realisations_done <> cases * realisations",
    "SELECT s.name || ' misses cases' FROM study s "
    "WHERE (SELECT count(*) FROM published p WHERE p.study_id = s.id) <> s.cases",
};

/* Where nobody was killed. */
static const char QUESTION_OF_LEASES[] =
    "SELECT 'job ' || id || ' was lost ' || losses || ' times' FROM job WHERE losses > 0";

static void ask(struct world *world, sqlite3 *db, const char *question) {
    sqlite3_stmt *statement = NULL;
    if (sqlite3_prepare_v2(db, question, -1, &statement, NULL) != SQLITE_OK)
        fail_msg("%s: %s", question, sqlite3_errmsg(db));
    int step = SQLITE_ROW;
    for (int rows = 0; rows < 5 && (step = sqlite3_step(statement)) == SQLITE_ROW; rows++)
        world_lose(&world->tally->damaged, "%s", (const char *)sqlite3_column_text(statement, 0));
    if (step != SQLITE_ROW && step != SQLITE_DONE)
        world_lose(&world->tally->damaged, "%s", sqlite3_errmsg(db));
    sqlite3_finalize(statement);
}

static void check_store(struct world *world) {
    sqlite3 *db = NULL;
    assert_int_equal(sqlite3_open("store/rugo.db", &db), SQLITE_OK);
    for (size_t q = 0; q < sizeof QUESTIONS / sizeof *QUESTIONS; q++)
        ask(world, db, QUESTIONS[q]);
    if (world->options.long_model)
        ask(world, db, QUESTION_OF_LEASES);
    sqlite3_close(db);
}

void world_judge_snapshot(struct world *world, const struct actor *actor, bool promised) {
    char file[2 * WORLD_NAME];
    sqlite3 *db = NULL;
    snprintf(file, sizeof file, "%s.db", actor->name);
    if (access(file, F_OK) == 0) {
        assert_int_equal(sqlite3_open(file, &db), SQLITE_OK);
        ask(world, db, QUESTIONS[0]);
        sqlite3_close(db);
        unlink(file);
    } else if (promised) {
        world_lose(&world->tally->lost, "%s ended well and left no file", actor->name);
    }
}

/* A folder in which nothing may be but one file, or nothing. */
static void check_folder(struct world *world, const char *path, const char *but) {
    DIR *folder = opendir(path);
    assert_non_null(folder);
    for (const struct dirent *entry; (entry = readdir(folder)) != NULL;)
        if (strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0 &&
            strcmp(entry->d_name, but) != 0)
            world_lose(&world->tally->leftovers, "%s/%s", path, entry->d_name);
    closedir(folder);
}

/* Nor may parts of copies lie beside them; hidden ones neither. */
static void check_copies(struct world *world) {
    DIR *folder = opendir(".");
    assert_non_null(folder);
    for (const struct dirent *entry; (entry = readdir(folder)) != NULL;)
        if (strstr(entry->d_name, ".db") != NULL && strstr(entry->d_name, "snapshot") != NULL)
            world_lose(&world->tally->leftovers, "%s", entry->d_name);
    closedir(folder);
}

/* Children of killed processes would have become the test's own. */
static void check_processes(struct world *world) {
    pid_t left = waitpid(-1, NULL, WNOHANG);
    if (left != -1 || errno != ECHILD)
        world_lose(&world->tally->leftovers, "process %d", (int)left);
}

void world_judge_files(struct world *world) {
    check_folder(world, "store", "rugo.db");
    check_folder(world, "scratch", "");
    check_copies(world);
    check_store(world);
    if (run_rugo("verify", (const char *[]){"verify", "--db", "store/rugo.db", NULL}) != 0)
        world_lose(&world->tally->damaged, "rugo verify finds fault: see verify.out, verify.err");
    check_processes(world);
    long most = world->options.server_kb != 0 ? world->options.server_kb : 256 * 1024;
    if (world->server_kb > most)
        world_lose(&world->tally->leftovers, "the server took %ld KiB of memory, %ld are allowed",
                   world->server_kb, most);
}
