/* What the benches of the queue share: a queue of many tiny jobs, and a real result for each. */
#ifndef RUGO_TESTS_SUPPORT_QUEUE_LOAD_H
#define RUGO_TESTS_SUPPORT_QUEUE_LOAD_H

#include "jobs/kind.h"
#include "jobs/runner.h"
#include "schema/store/store.h"
#include "schema/study/fault.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static inline double seconds(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static inline int by_value(const void *a, const void *b) {
    const double *x = a, *y = b;
    return (*x > *y) - (*x < *y);
}

/* Sorts the latencies. */
static inline void print_rate(const char *name, double elapsed, double *latencies, size_t n) {
    if (n == 0) {
        printf("%-46s nothing done\n", name);
        return;
    }
    qsort(latencies, n, sizeof *latencies, by_value);
    printf("%-46s %8.0f a second   p50 %6.2f ms   p99 %6.2f ms   most %6.2f ms\n", name,
           (double)n / elapsed, 1e3 * latencies[n / 2], 1e3 * latencies[n * 99 / 100],
           1e3 * latencies[n - 1]);
}

/* Small surfaces, whose results come to about 4 KB. */
static inline struct study *queue_study(unsigned jobs, struct error *err) {
    struct study *study = NULL;
    struct fault_list faults = {0};
    char text[512];
    snprintf(text, sizeof text,
             "{\"name\":\"queue\",\"kind\":\"statistics\",\"seed\":1,\"realisations\":%u,"
             "\"surface\":{\"hurst\":0.8,\"wavelength_ratio\":8,\"length_ratio\":16},"
             "\"statistics\":{\"bins\":{\"height\":[-4,6,42],\"curvature\":[-12,0,27]}}}",
             jobs);
    if (kind_read_study(&study, text, strlen(text), NULL, &faults, err) == 0)
        study->cases[0].block = 1; /* a job a realisation */
    fault_list_clear(&faults);
    return study;
}

static inline int queue_submit(struct store *store, unsigned jobs, struct error *err) {
    char id[STUDY_ID_SIZE];
    struct study *study = queue_study(jobs, err);
    int status = study ? store_submit(store, study, NULL, id, NULL, err) : err->code;
    study_destroy(&study);
    return status;
}

static inline int queue_create(const char *database, unsigned jobs, struct error *err) {
    struct store *store = NULL;
    int status = store_open(&store, database, NULL, err);
    if (!status)
        status = queue_submit(store, jobs, err);
    store_close(&store);
    return status;
}

/* The block of realisation 0: what every job of the queue has to compute. */
static inline int queue_compute(struct block_result *result, struct error *err) {
    struct job_runner *runner = NULL;
    const struct job_kind *kind = kind_find("statistics");
    struct study *study = queue_study(1, err);
    int status = study ? runner_create(&runner, kind, study->cases[0].parameters, NULL, 1, 0, err)
                       : err->code;
    if (!status)
        status = runner_run(runner, 0, 1, NULL, result, err);
    if (runner)
        runner_destroy(&runner);
    study_destroy(&study);
    return status;
}

#endif
