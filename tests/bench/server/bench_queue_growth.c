/* The queue against its length and its users: a claim among 10 000, 100 000 and a million waiting
 * jobs takes equally long. 16 processes on one file, as of `work --db`, neither see it busy nor
 * wait long. */
#include "tests/support/queue_load.h"
#include <math.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

enum { CLAIMS = 4000, BATCH = 200, PROCESSES = 16, SECONDS = 8 };

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

static int bench_growth(unsigned jobs, struct error *err) {
    struct store *store = NULL;
    double submit = seconds(), us[3] = {0};
    int status = queue_create("growth.db", jobs, err);
    submit = seconds() - submit;
    if (!status)
        status = store_open(&store, "growth.db", NULL, err);
    /* the running jobs of the first rounds stay: they grow too */
    for (int round = 0; !status && round < 2; round++)
        status = time_claims(store, &us[round], err);
    store_close(&store);
    if (!status)
        printf("%8u jobs: submitted in %5.2f s; a claim takes %5.1f us, with %d running %5.1f us\n",
               jobs, submit, us[0], CLAIMS, us[1]);
    unlink("growth.db");
    return status;
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
    for (unsigned jobs = 10000; !status && jobs <= 1000000; jobs *= 10)
        status = bench_growth(jobs, &err);
    if (!status)
        status = bench_processes(&result, &err);
    if (status)
        fprintf(stderr, "bench_queue_growth: %s\n", err.text);
    block_result_clear(&result);
    return status ? 1 : 0;
}
