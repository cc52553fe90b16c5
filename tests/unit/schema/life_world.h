/* A store and the model of it, for the test of their life cycle: the files, the handles, the
 * commits that fail. */
#ifndef RUGO_TESTS_UNIT_SCHEMA_LIFE_WORLD_H
#define RUGO_TESTS_UNIT_SCHEMA_LIFE_WORLD_H

#include "schema/store/store.h"
#include "tests/support/check.h"
#include "tests/support/life_model.h"
#include "tests/support/seed.h"
#include "tests/support/store_files.h"
#include <sqlite3.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { HOLDS = 64, PATH_SIZE = 64 };

/* A lease as a worker remembers it, also one that the store has forgotten. */
struct hold {
    int job, number;
    char token[TOKEN_SIZE];
};

struct world {
    uint64_t random;
    int sequence;
    struct life life;
    int64_t now_ms;
    struct store *handles[2]; /* as two processes have the file open */
    char ids[LIFE_STUDIES][STUDY_ID_SIZE];
    struct hold holds[HOLDS];
    int hold_count, leases;
    /* while publishing */
    int last_offered, stop_after;
    bool transient, racing, mark_pending;
    struct {
        int study, case_number;
        int64_t revision;
    } mark;
};

static char folder[PATH_SIZE]; /* of this program's stores: in memory where that can be had */
static char path[PATH_SIZE + 16], empty_path[PATH_SIZE + 16];

/* Counts down at each commit, and fails the one that finds 1. Set for every handle that opens. */
static int commits_to_failure;
static inline int fail_commit(void *context) {
    (void)context;
    return commits_to_failure > 0 && --commits_to_failure == 0;
}

static inline int watch_commits(sqlite3 *db, const char **message, const void *routines) {
    (void)message;
    (void)routines;
    sqlite3_commit_hook(db, fail_commit, NULL);
    return SQLITE_OK;
}

static inline int below(struct world *world, int n) {
    return (int)(next_word(&world->random) % (uint64_t)n);
}

static inline void expect(const struct world *world, const char *what, int found, int expected) {
    if (found != expected)
        fail_msg("sequence %d, %s: %d instead of %d", world->sequence, what, found, expected);
}

/* --- files --- */

static inline int64_t world_clock(void *context) {
    return ((struct world *)context)->now_ms;
}

static inline void open_handle(struct world *world, int h) {
    struct store_options options = {
        .existing = true, .lease_ms = LIFE_LEASE_MS, .now_ms = world_clock, .context = world};
    struct error err = {0};
    if (store_open(&world->handles[h], path, &options, &err) != 0)
        fail_msg("sequence %d: %s", world->sequence, err.text);
}

static inline struct store *any_handle(struct world *world) {
    int h = below(world, 2);
    if (world->handles[h] == NULL)
        open_handle(world, h);
    return world->handles[h];
}

static inline void close_handles(struct world *world) {
    for (int h = 0; h < 2; h++)
        store_close(&world->handles[h]);
}

static inline void remove_files(void) {
    static const char *const ENDINGS[] = {"", "-wal", "-shm", ".copy", ".copy-wal"};
    char name[PATH_SIZE + 32];
    for (size_t e = 0; e < sizeof ENDINGS / sizeof *ENDINGS; e++) {
        snprintf(name, sizeof name, "%s%s", path, ENDINGS[e]);
        unlink(name);
        snprintf(name, sizeof name, "%s%s", empty_path, ENDINGS[e]);
        unlink(name);
    }
    rmdir(folder);
}

static inline int setup(void **state) {
    (void)state;
    struct store *store = NULL;
    snprintf(folder, sizeof folder, "/dev/shm/rugo-life-XXXXXX");
    if (mkdtemp(folder) == NULL) {
        snprintf(folder, sizeof folder, "life-XXXXXX");
        if (mkdtemp(folder) == NULL)
            return -1;
    }
    snprintf(path, sizeof path, "%s/life.db", folder);
    snprintf(empty_path, sizeof empty_path, "%s/empty.db", folder);
    int status = store_open(&store, empty_path, NULL, NULL);
    store_close(&store);
    return status != 0 || sqlite3_auto_extension((void (*)(void))watch_commits) != SQLITE_OK;
}

static inline int teardown(void **state) {
    (void)state;
    sqlite3_reset_auto_extension();
    remove_files();
    return 0;
}

#endif
