/* Merging and publishing a case of one realisation: CPU time, beside what its kind says that it
 * costs (study_cost.case_seconds), by bins, loads, models and levels. Medians of 9 cases. */
#include "jobs/kind.h"
#include "jobs/runner.h"
#include "tests/support/timing.h"
#include "worker/link/source.h"
#include "worker/publish/aggregate.h"
#include "worker/publish/publish.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

enum { CASES = 9 };
static const char STATISTICS[] =
    "{\"name\":\"s\",\"kind\":\"statistics\",\"realisations\":1,\"surface\":{\"dimension\":%d,"
    "\"hurst\":[0.1,0.2,0.3,0.4,0.5,0.6,0.7,0.8,0.9],\"wavelength_ratio\":4,\"length_ratio\":2},"
    "\"statistics\":{\"bins\":{\"height\":[-4,8,%d],\"curvature\":[-16,0,%d]}}}";
static const char CONTACT[] =
    "{\"name\":\"c\",\"kind\":\"contact\",\"realisations\":1,\"surface\":{\"dimension\":1,"
    "\"hurst\":[0.1,0.2,0.3,0.4,0.5,0.6,0.7,0.8,0.9],\"wavelength_ratio\":4,\"length_ratio\":2},"
    "\"contact\":{\"model\":%s,\"levels\":%s,\"pressures\":{\"to\":0.1,\"steps\":%d}}}";

static int by_size(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Claims a job, runs it, hands it in, and publishes its case, of which it is the only one. */
static int run_case(struct source *source, struct store *store, double *ms, struct error *err) {
    struct claimed_job job = {0};
    struct job_runner *runner = NULL;
    struct block_result result = {0};
    struct report report = {.verb = REPORT_COMPLETE, .job = &job, .result = &result};
    size_t count = 0;
    bool due = false;
    int status = source_claim(source, &(struct wish){.count = 1}, &job, &count, &due, err);
    if (status == 0)
        status = runner_create(&runner, kind_find(job.kind), job.parameters, NULL, job.seed,
                               job.case_number, err);
    if (status == 0)
        status = runner_run(runner, job.first, job.count, NULL, &result, err);
    double start = cpu_ms();
    if (status == 0)
        status = source_report(source, &report, 1, &due, err);
    if (status == 0 && due)
        status = publish_due(store, NULL, NULL, NULL, err);
    *ms = cpu_ms() - start;
    runner_destroy(&runner);
    block_result_clear(&result);
    claimed_job_clear(&job);
    return status;
}

static int bench(const char *text, const char *what, struct error *err) {
    struct source_options options = {.database = "publishing.db", .worker = "bench"};
    struct fault_list faults = {0};
    struct study *study = NULL;
    struct store *store = NULL;
    struct source *source = NULL;
    char id[STUDY_ID_SIZE];
    double ms[CASES] = {0}, told = 0;
    bool existing;
    int status = kind_read_study(&study, text, strlen(text), NULL, &faults, err);
    if (status == 0)
        status = store_open(&store, options.database, &(struct store_options){0}, err);
    if (status == 0)
        status = store_submit(store, study, NULL, id, &existing, err);
    if (status == 0)
        status = source_create(&source, &options, err);
    for (size_t c = 0; c < CASES && status == 0; c++) {
        status = run_case(source, store, &ms[c], err);
        told = 1e3 * study->cases[c].cost.case_seconds;
    }
    qsort(ms, CASES, sizeof *ms, by_size);
    if (status == 0)
        printf("%-44s %6.2f ms, told %6.2f ms\n", what, ms[CASES / 2], told);
    source_destroy(&source);
    store_close(&store);
    study_destroy(&study);
    fault_list_clear(&faults);
    unlink(options.database);
    return status;
}

int main(void) {
    static const int BINS[] = {30, 240, 960}, LOADS[] = {3, 30, 100};
    static const char *const MODELS[] = {"[\"halfspace\"]", "[\"halfspace\",\"layered\"]"};
    static const char *const LEVELS[] = {"[8]", "[4,8]"};
    struct error err = {0};
    char text[1024], what[128];
    int status = 0;
    puts("publishing a case: CPU time, median of 9 cases");
    for (int n = 0; n < 6 && status == 0; n++) {
        snprintf(text, sizeof text, STATISTICS, 1 + n / 3, BINS[n % 3], BINS[n % 3] * 2 / 3);
        snprintf(what, sizeof what, "statistics, dimension %d, %d bins", 1 + n / 3, BINS[n % 3]);
        status = bench(text, what, &err);
    }
    for (int n = 0; n < 9 && status == 0; n++) {
        const char *models = MODELS[n / 3 > 0], *levels = LEVELS[n / 3 > 1];
        snprintf(text, sizeof text, CONTACT, models, levels, LOADS[n % 3]);
        snprintf(what, sizeof what, "contact, %s, %s, %d loads", n / 3 > 0 ? "two models" : "one",
                 n / 3 > 1 ? "two levels" : "one", LOADS[n % 3]);
        status = bench(text, what, &err);
    }
    if (status != 0)
        fprintf(stderr, "bench_publishing: %s\n", err.text);
    return status != 0;
}
