/* Pauses: how long others wait while one study of very many jobs is submitted, run, published,
 * cancelled, deleted. A process of its own changes and reads another study of the same file all the
 * time, and keeps the longest wait. The jobs are of a test kind that throws needles. RUGO_JOBS=n:
 * so many, a hundred a case; 100 000 by default. */
#include "server/show/table/contents.h"
#include "tests/support/needle_study.h"
#include "tests/support/queue_load.h"
#include "worker/publish/publish.h"
#include "worker/publish/verify.h"
#include <math.h>
#include <signal.h>
#include <stdatomic.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#define LIST(KIND) KIND(NEEDLE_KIND)
JOB_KIND_TABLE(LIST)

enum { BATCH = 100, OF_CASE = 100 };
static const char DATABASE[] = "pauses.db";

/* Shared with the process that watches. */
struct watch {
    _Atomic double write, read; /* the longest wait since they were set to 0, s */
    char study[STUDY_ID_SIZE];
};

/* Writes and reads until it is killed. */
static void watch_on(struct watch *watch) {
    struct store *store = NULL;
    struct study_status status = {0};
    struct error err = {0};
    int failed = store_open(&store, DATABASE, NULL, &err);
    while (failed == 0) {
        double start = seconds();
        failed = store_probe(store, &err);
        double middle = seconds();
        if (failed == 0)
            failed = store_status(store, watch->study, &status, &err);
        study_status_clear(&status);
        double end = seconds();
        atomic_store(&watch->write, fmax(atomic_load(&watch->write), middle - start));
        atomic_store(&watch->read, fmax(atomic_load(&watch->read), end - middle));
        nanosleep(&(struct timespec){.tv_nsec = 1000000}, NULL);
    }
    printf("the watcher failed: %s\n", err.text);
}

struct pauses {
    struct store *store;
    struct watch *watch;
    struct study *study;
    char id[STUDY_ID_SIZE];
    unsigned jobs;
};

static int run_one(const struct claimed_job *job, struct block_result *out, struct error *err) {
    static struct job_runner *runner;
    static uint64_t case_number = UINT64_MAX;
    int status = 0;
    if (job->case_number != case_number) {
        if (runner != NULL)
            runner_destroy(&runner);
        status = runner_create(&runner, &NEEDLE_KIND, job->parameters, NULL, job->seed,
                               job->sequence, err);
        case_number = job->case_number;
    }
    return status != 0 ? status : runner_run(runner, job->first, job->count, NULL, out, err);
}

/* Claims, runs and completes a batch of jobs, as a worker does. */
static int run_batch(struct pauses *pauses, size_t *done, struct error *err) {
    const struct claim claim = {
        .worker = "bench", .host = "bench", .study = pauses->id, .count = BATCH};
    struct claimed_job jobs[BATCH] = {0};
    struct block_result results[BATCH] = {0};
    size_t count = 0;
    bool first, last;
    int status = store_claim(pauses->store, &claim, jobs, &count, err);
    for (size_t n = 0; status == 0 && n < count; n++)
        status = run_one(&jobs[n], &results[n], err);
    if (status == 0)
        status = store_begin(pauses->store, err);
    for (size_t n = 0; status == 0 && n < count; n++)
        status = store_complete(pauses->store, jobs[n].id, jobs[n].token, &results[n], &first,
                                &last, err);
    if (status == 0)
        status = store_commit(pauses->store, err);
    for (size_t n = 0; n < count; n++) {
        block_result_clear(&results[n]);
        claimed_job_clear(&jobs[n]);
    }
    *done += count;
    return status != 0 ? status : count == 0 ? error_set(err, ERROR_ABSENT, "no job waits") : 0;
}

static int submit(struct pauses *pauses, struct error *err) {
    return store_submit(pauses->store, pauses->study, NULL, pauses->id, NULL, err);
}

static int run_half(struct pauses *pauses, struct error *err) {
    int status = 0;
    for (size_t done = 0; status == 0 && done < pauses->jobs / 2;)
        status = run_batch(pauses, &done, err);
    return status;
}

static int publish(struct pauses *pauses, struct error *err) {
    return publish_due(pauses->store, NULL, NULL, NULL, err);
}

static int cancel(struct pauses *pauses, struct error *err) {
    return store_cancel(pauses->store, pauses->id, err);
}

static int retry(struct pauses *pauses, struct error *err) {
    uint64_t count;
    return store_retry(pauses->store, pauses->id, pauses->study->edition, &count, err);
}

static int extend(struct pauses *pauses, struct error *err) {
    uint64_t jobs;
    return store_extend(pauses->store, pauses->id, OF_CASE + 1, pauses->study->edition, &jobs, err);
}

static int ask_contents(struct pauses *pauses, struct error *err) {
    cJSON *document = NULL;
    int status = contents_document(pauses->store, pauses->id, &document, err);
    cJSON_Delete(document);
    return status;
}

static int ask_status(struct pauses *pauses, struct error *err) {
    struct study_status status = {0};
    int result = store_status(pauses->store, pauses->id, &status, err);
    study_status_clear(&status);
    return result;
}

static int snapshot(struct pauses *pauses, struct error *err) {
    return store_snapshot(pauses->store, "copy.db", NULL, NULL, err);
}

static int no_flaw(void *context, const struct flaw *flaw, struct error *err) {
    (void)context;
    return error_set(err, ERROR_INPUT, "a flaw: %s", flaw->text);
}

static int verify(struct pauses *pauses, struct error *err) {
    const struct verification verification = {.found = no_flaw};
    struct verify_report report = {0};
    return verify_store(pauses->store, &verification, true, &report, err);
}

static int forget(struct pauses *pauses, struct error *err) {
    return store_delete(pauses->store, pauses->id, err);
}

static int purge(struct pauses *pauses, struct error *err) {
    return store_purge(pauses->store, NULL, NULL, err);
}

static int step(struct pauses *pauses, const char *name,
                int (*run)(struct pauses *pauses, struct error *err), struct error *err) {
    double start = seconds();
    atomic_store(&pauses->watch->write, 0);
    atomic_store(&pauses->watch->read, 0);
    int status = run(pauses, err);
    double took = seconds() - start;
    nanosleep(&(struct timespec){.tv_nsec = 50000000}, NULL); /* who waits still has its answer */
    if (status == 0)
        printf("%-28s %9.3f %14.1f %14.1f\n", name, took, 1e3 * atomic_load(&pauses->watch->write),
               1e3 * atomic_load(&pauses->watch->read));
    fflush(stdout);
    return status;
}

static int run_steps(struct pauses *pauses, struct error *err) {
    static const struct {
        const char *name;
        int (*run)(struct pauses *pauses, struct error *err);
    } STEPS[] = {{"submit", submit},
                 {"claim and complete a half", run_half},
                 {"status", ask_status},
                 {"cancel", cancel},
                 {"retry", retry},
                 {"claim and complete the rest", run_half},
                 {"publish", publish},
                 {"contents", ask_contents},
                 {"extend by a realisation", extend},
                 {"cancel what that queued", cancel},
                 {"snapshot", snapshot},
                 {"verify --quick", verify},
                 {"delete", forget},
                 {"purge", purge}};
    int status = 0;
    for (size_t s = 0; status == 0 && s < sizeof STEPS / sizeof *STEPS; s++)
        status = step(pauses, STEPS[s].name, STEPS[s].run, err);
    return status;
}

/* Prepares the other study, and watches while the steps are run. */
static int bench(struct pauses *pauses, struct error *err) {
    struct study *other = needle_study(1, 10, err);
    int status = other != NULL ? store_open(&pauses->store, DATABASE, NULL, err) : ERROR_MEMORY;
    if (status == 0)
        status = store_submit(pauses->store, other, NULL, pauses->watch->study, NULL, err);
    study_destroy(&other);
    pauses->study = status == 0 ? needle_study(pauses->jobs / OF_CASE, OF_CASE, err) : NULL;
    if (pauses->study == NULL)
        return status != 0 ? status : ERROR_MEMORY;
    printf("a study of %u jobs in %u cases\n%-28s %9s %14s %14s\n", pauses->jobs,
           pauses->jobs / OF_CASE, "", "took, s", "write wait, ms", "read wait, ms");
    fflush(stdout);
    pid_t watcher = fork();
    if (watcher == 0) {
        watch_on(pauses->watch);
        _exit(1);
    }
    status = run_steps(pauses, err);
    kill(watcher, SIGKILL);
    waitpid(watcher, NULL, 0);
    return status;
}

int main(void) {
    const char *jobs = getenv("RUGO_JOBS");
    struct error err = {0};
    struct pauses pauses = {.jobs = jobs != NULL ? (unsigned)strtoul(jobs, NULL, 10) : 100000};
    pauses.watch =
        mmap(NULL, sizeof *pauses.watch, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    int status = pauses.watch != MAP_FAILED ? bench(&pauses, &err) : ERROR_MEMORY;
    if (status != 0)
        fprintf(stderr, "bench_pauses: %s\n", err.text);
    store_close(&pauses.store);
    study_destroy(&pauses.study);
    return status != 0;
}
