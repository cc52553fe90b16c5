/* A store in the test's own folder, with one small study: a few profiles, done in milliseconds. */
#ifndef RUGO_TESTS_UNIT_WORKER_SMALL_STUDY_H
#define RUGO_TESTS_UNIT_WORKER_SMALL_STUDY_H

#include "jobs/kind.h"
#include "schema/store/store.h"
#include "schema/study/fault.h"
#include "tests/support/check.h"
#include "tests/support/sql.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

/* Two cases (H 0.2 and 0.8) of profiles of 64 points, and few bins. */
static const char SMALL_STUDY[] =
    "{\"name\":\"small\",\"kind\":\"statistics\",\"seed\":7,\"realisations\":24,\"surface\":{"
    "\"dimension\":1,\"hurst\":[0.2,0.8],\"wavelength_ratio\":4,\"length_ratio\":4,"
    "\"points_per_wavelength\":4},\"statistics\":{\"bins\":{\"height\":[-4,8,24],\"curvature\":"
    "[-16,0,16]}}}";

#define RUNNING_JOBS "FROM job WHERE state = 'running'"

struct fixture {
    char database[32];
    struct store *store;
    char study[STUDY_ID_SIZE];
};

/* A fresh store; fails the test where it cannot be had. */
static inline void fixture_open(struct fixture *fixture) {
    struct error err = {0};
    *fixture = (struct fixture){.database = "store-XXXXXX"};
    int file = mkstemp(fixture->database);
    assert_true(file >= 0);
    close(file);
    unlink(fixture->database);
    struct store_options options = {0};
    if (store_open(&fixture->store, fixture->database, &options, &err) != 0) {
        fail_msg("%s", err.text);
    }
}

/* Queues a study in jobs of `block` realisations, as nothing is known of the seconds that these
 * take. parameters (may be NULL) replaces the value at a key of every case's "surface", behind the
 * back of the study reader. */
static inline void fixture_submit(struct fixture *fixture, const char *text, uint64_t block,
                                  const char *key, double value) {
    struct error err = {0};
    struct fault_list faults = {0};
    struct study *study = NULL;
    bool existing = false;
    if (kind_read_study(&study, text, strlen(text), NULL, &faults, &err) != 0) {
        fail_msg("%s (%s)", err.text, faults.count ? faults.faults[0].detail : "");
    }
    for (size_t c = 0; c < study->case_count; c++) {
        study->cases[c].block = block;
        study->cases[c].cost.seconds = 0;
        if (key) {
            cJSON *surface = cJSON_GetObjectItem(study->cases[c].parameters, "surface");
            cJSON_ReplaceItemInObject(surface, key, cJSON_CreateNumber(value));
        }
    }
    if (store_submit(fixture->store, study, NULL, fixture->study, &existing, &err) != 0) {
        fail_msg("%s", err.text);
    }
    study_destroy(&study);
    fault_list_clear(&faults);
}

static inline struct study_status fixture_status(struct fixture *fixture) {
    struct study_status status = {0};
    struct error err = {0};
    if (store_status(fixture->store, fixture->study, &status, &err) != 0) {
        fail_msg("%s", err.text);
    }
    return status;
}

/* Waits until heartbeats have renewed the lease of every job that runs; the moment at which the
 * last of them would have run out else. */
static inline int64_t fixture_await_renewals(const struct fixture *fixture) {
    int64_t first = sql_integer(fixture->database, "SELECT max(lease_until) " RUNNING_JOBS);
    for (int tries = 0;
         sql_integer(fixture->database, "SELECT min(lease_until) " RUNNING_JOBS) <= first;
         tries++) {
        assert_true(tries < 6000);
        nanosleep(&(struct timespec){.tv_nsec = 10000000}, NULL);
    }
    return first;
}

static inline void fixture_close(struct fixture *fixture) {
    store_close(&fixture->store);
    unlink(fixture->database);
}

#endif
