/* The queue against its length and its users: us of a claim among 10 000, 100 000 and a million
 * waiting jobs, with the exponents fitted to them, which are about 0. 16 processes on one file, as
 * of `work --db`, neither see it busy nor wait long. */
#include "tests/support/growth.h"
#include "tests/support/queue_load.h"
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

enum { CLAIMS = 4000, BATCH = 200, PROCESSES = 16, SECONDS = 8, LENGTHS = 3, LENGTH_LEAST = 10000 };
enum row { SUBMIT, CLAIM, CLAIM_RUNNING, ROWS };
static const char *const NAMES[ROWS] = {"submit, the study of them", "claim, a job",
                                        "claim, a job, with 4000 that run"};

static int claim(struct store *store, struct claimed_job *job, struct error *err) {
    struct claim claim = {.worker = "bench", .host = "bench", .count = 1};
    size_t found = 0;
    int status = store_claim(store, &claim, job, &found, err);
    return status ? status : found ? 0 : error_set(err, ERROR_ABSENT, "no job waits");
}

/* --- growth --- */

/* CLAIMS claims, BATCH a commit; microseconds each. */
static int time_claims(struct store *store, double *us, struct error *err) {
    struct claimed_job job;
    int status = 0;
    double start = seconds();
    for (int n = 0; !status && n < CLAIMS; n += BATCH) {
        status = store_begin(store, err);
        for (int b = 0; !status && b < BATCH; b++) {
            status = claim(store, &job, err);
            if (!status)
                claimed_job_clear(&job);
        }
        if (!status)
            status = store_commit(store, err);
    }
    *us = 1e6 * (seconds() - start) / CLAIMS;
    return status;
}

/* Fills column n of the rows. */
static int measure(unsigned jobs, double us[ROWS][LENGTHS], size_t n, struct error *err) {
    struct store *store = NULL;
    double start = seconds();
    int status = queue_create("growth.db", jobs, err);
    us[SUBMIT][n] = 1e6 * (seconds() - start);
    if (!status)
        status = store_open(&store, "growth.db", NULL, err);
    /* the running jobs of the first claims stay: they grow too */
    if (!status)
        status = time_claims(store, &us[CLAIM][n], err);
    if (!status)
        status = time_claims(store, &us[CLAIM_RUNNING][n], err);
    store_close(&store);
    unlink("growth.db");
    return status;
}

static int bench_growth(struct error *err) {
    double lengths[LENGTHS], us[ROWS][LENGTHS];
    int status = 0;
    unsigned jobs = LENGTH_LEAST;
    for (size_t n = 0; !status && n < LENGTHS; n++, jobs *= 10) {
        lengths[n] = jobs;
        status = measure(jobs, us, n, err);
    }
    if (status)
        return status;
    growth_print_head("jobs that wait", lengths, LENGTHS, "");
    for (int row = 0; row < ROWS; row++) {
        growth_print_row(NAMES[row], lengths, us[row], LENGTHS);
        printf("\n");
    }
    printf("\n");
    return 0;
}

/* --- many processes --- */

struct process_report {
    size_t jobs;
    double longest; /* s, of one claim or completion */
    char fault[256];
};

/* Claims and completes for SECONDS. */
static int work(const struct block_result *result, struct process_report *report,
                struct error *err) {
    struct store *store = NULL;
    struct block_result block = *result;
    int status = store_open(&store, "many.db", NULL, err);
    double until = seconds() + SECONDS, start = seconds();
    while (!status && start < until) {
        struct claimed_job job;
        bool first, done;
        status = claim(store, &job, err);
        double middle = seconds();
        block.first = job.first;
        if (!status)
            status = store_complete(store, job.id, job.token, &block, &first, &done, err);
        double end = seconds(), longer = fmax(middle - start, end - middle);
        if (status)
            break;
        claimed_job_clear(&job);
        report->longest = fmax(report->longest, longer);
        report->jobs++;
        start = end;
    }
    store_close(&store);
    return status;
}

static int bench_processes(const struct block_result *result, struct error *err) {
    struct process_report *reports = mmap(NULL, PROCESSES * sizeof *reports, PROT_READ | PROT_WRITE,
                                          MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (reports == MAP_FAILED)
        return error_memory(err, PROCESSES * sizeof *reports, "reports");
    int status = queue_create("many.db", 200000, err);
    double longest = 0;
    size_t jobs = 0, faults = 0;
    fflush(stdout);
    for (int p = 0; !status && p < PROCESSES; p++)
        if (fork() == 0) {
            struct error error = {0};
            if (work(result, &reports[p], &error))
                snprintf(reports[p].fault, sizeof reports[p].fault, "%.255s", error.text);
            _exit(0);
        }
    while (wait(NULL) > 0)
        continue;
    for (int p = 0; p < PROCESSES; p++) {
        jobs += reports[p].jobs;
        longest = fmax(longest, reports[p].longest);
        if (*reports[p].fault && ++faults)
            printf("a process failed: %s\n", reports[p].fault);
    }
    printf("%d processes on one file, no group commit: %.0f a second, longest wait %.0f ms, %zu "
           "errors\n",
           PROCESSES, (double)jobs / SECONDS, 1e3 * longest, faults);
    munmap(reports, PROCESSES * sizeof *reports);
    return status;
}

int main(void) {
    struct error err = {0};
    struct block_result result = {0};
    int status = queue_compute(&result, &err);
    if (!status)
        status = bench_growth(&err);
    if (!status)
        status = bench_processes(&result, &err);
    if (status)
        fprintf(stderr, "bench_queue_growth: %s\n", err.text);
    block_result_clear(&result);
    return status ? 1 : 0;
}
