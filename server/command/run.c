/* `rugo run`: a study from submission to table in one process; goes on where an earlier run of the
 * same study stopped. */
#include "jobs/kind.h"
#include "schema/result/view.h"
#include "server/command/access.h"
#include "server/command/command.h"
#include "server/show/output.h"
#include "server/show/progress.h"
#include "server/show/summary.h"
#include "worker/publish.h"
#include "worker/worker.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A run that was killed is started again soon: its blocks need not wait for the usual minute.
 */
enum { LEASE_MS = 20000, REPORT_MS = 1000 /* for the bar */ };

struct options {
    const char *database, *folder;
    const char **sets;
    unsigned threads;
};
#define AT(member) offsetof(struct options, member)
static const struct option_row OPTIONS[] = {
    {"db", 0, OPTION_TEXT, 0, 0, AT(database), "FILE", DATABASE, "the local store"},
    {"workers", 0, OPTION_COUNT, 0, WORKERS_MOST, AT(threads), "N", "0",
     "threads; 0: as many as processors"},
    {"set", 0, OPTION_LIST, 0, 0, AT(sets), "PATH=VALUE", NULL, SET_HELP},
    {"out", 0, OPTION_TEXT, 0, 0, AT(folder), "DIR", NULL,
     "write curves.json, curves.csv and an SVG a quantity"},
    {0}};

struct run {
    const char *file, *database, *folder;
    const char *const *sets;
    unsigned threads;
    struct store *store;
    char id[STUDY_ID_SIZE];
    struct fault_list faults;
};

/* The same study in the same store is the same run: its text is its key. */
static int submit(struct run *run, struct error *err) {
    char *key = NULL;
    struct study *study = NULL;
    bool existing = false;
    int status = study_file_read(&study, run->file, run->sets, &run->faults, err);
    if (status == 0 && asprintf(&key, "run %s", study->source) < 0) {
        key = NULL;
        status = error_memory(err, strlen(study->source), "a study's key");
    }
    if (status == 0)
        status = store_open(&run->store, run->database, NULL, err);
    if (status == 0)
        status = store_submit(run->store, study, key, run->id, &existing, err);
    study_destroy(&study);
    free(key);
    return status;
}

/* Works until the study has ended; with others at work on it, waits for them too. */
static int work(struct run *run, struct error *err) {
    struct study_progress progress = {
        .store = run->store, .study = run->id, .bar = {.command = "run"}};
    struct worker_options options = {
        .source = {.database = run->database,
                   .study = run->id,
                   .lease_ms = LEASE_MS,
                   .report_ms = REPORT_MS},
        .threads = run->threads,
        .drain = true,
        .stop = &stop_requested,
        .tick = progress_tick,
        .context = &progress,
        .quiet = true,
    };
    int status = workers_run(&options, err);
    if (progress.bar.shown) { /* as it is at the end */
        progress.bar.next_ms = progress.bar.next_ms > 0 ? 1 : 0;
        progress_tick(&progress);
    }
    progress_end(&progress.bar);
    return status;
}

static int check_end(struct run *run, const struct study_status *now, struct error *err) {
    struct failure *failures = NULL;
    size_t count = 0;
    if (strcmp(now->state, "cancelled") == 0)
        return error_set(err, ERROR_STATE, "study %s was cancelled; rugo retry --db %s %s goes on",
                         run->id, run->database, run->id);
    if (now->jobs_failed + now->cases_failed == 0)
        return 0;
    int status = store_failures(run->store, run->id, &failures, &count, err);
    const char *reason = count > 0 ? failures[count - 1].reason : "?"; /* jobs follow cases */
    if (status == 0 && now->jobs_failed > 0)
        status = error_set(err, ERROR_STATE,
                           "study %s: jobs failed: %llu (%.200s); rugo retry --db %s %s queues "
                           "them again",
                           run->id, (unsigned long long)now->jobs_failed, reason, run->database,
                           run->id);
    else if (status == 0)
        status =
            error_set(err, ERROR_STATE, "study %s: cases that cannot be published: %llu (%.300s)",
                      run->id, (unsigned long long)now->cases_failed, reason);
    failures_free(failures, count);
    return status;
}

/* What may pass, such as a full disk, leaves cases without rows in the store: that is not done. */
static int check_published(const struct run *run, const struct study_status *now,
                           const struct publish_counts *counts, struct error *err) {
    if (strcmp(now->state, "running") != 0 || now->jobs_waiting + now->jobs_running > 0)
        return 0;
    return error_set(err, ERROR_SYSTEM,
                     "study %s: cases are computed but not published (%.300s); the same command "
                     "tries again",
                     run->id, counts->postponed > 0 ? counts->reason.text : "?");
}

/* A study that has nothing to tell is no success, whatever became of its jobs. */
static int check_values(const struct run *run, const struct study_status *now, struct error *err) {
    struct valueless valueless = {0};
    int status = store_valueless(run->store, run->id, &valueless, err);
    if (status == 0 && valueless.cases > 0 && valueless.cases == now->cases)
        status = error_set(err, ERROR_NUMERIC, "study %s: no realisation has a value: %.300s",
                           run->id, valueless.note);
    else if (status == 0 && valueless.cases > 0)
        fprintf(stderr,
                "rugo run: no realisation has a value in %llu of %llu cases, such as case %llu: "
                "%.300s\n",
                (unsigned long long)valueless.cases, (unsigned long long)now->cases,
                (unsigned long long)valueless.first, valueless.note);
    valueless_clear(&valueless);
    return status;
}

/* Returns what the table needs: all curves only where files are written. */
static struct result_filter filter_of(const struct run *run, const char *kind) {
    const struct job_kind *found = kind_find(kind);
    const struct result_view *view = found != NULL ? found->view : NULL;
    const char *quantity = view != NULL && view->table != NULL ? view->table->quantity : NULL;
    if (run->folder != NULL)
        return (struct result_filter){.case_number = -1, .complete = true};
    return (struct result_filter){.case_number = -1,
                                  .part = {.quantity = quantity, .scalars_only = quantity == NULL}};
}

static int present(struct run *run, const char *kind, struct error *err) {
    const struct result_filter filter = filter_of(run, kind);
    struct study_result study = {0};
    struct study_report report = {0};
    int status = aggregate_study(run->store, run->id, &filter, &study, err);
    if (status == 0)
        status = aggregate_report(run->store, run->id, &report, err);
    if (status == 0 && run->folder != NULL)
        status = output_write(&study, run->folder, err);
    if (status == 0) {
        summary_of_curves(&study, &report, stdout);
        status = output_flush(err);
    }
    study_result_clear(&study);
    study_report_clear(&report);
    return status;
}

static int perform(struct run *run, struct error *err) {
    struct study_status now = {0};
    struct publish_counts counts = {0};
    int status = run->folder != NULL ? output_prepare(run->folder, err) : 0;
    if (status == 0)
        status = submit(run, err);
    if (status == 0)
        status = store_status(run->store, run->id, &now, err);
    do { /* publishing may queue a round of a case that asks for an error */
        if (status == 0 && now.jobs_waiting + now.jobs_running > 0)
            status = work(run, err);
        if (status == 0)
            status = publish_due(run->store, NULL, NULL, &counts, err);
        study_status_clear(&now);
        if (status == 0)
            status = store_status(run->store, run->id, &now, err);
    } while (status == 0 && now.jobs_waiting > 0);
    if (status != 0)
        return status;
    status = present(run, now.kind, err);
    if (status == 0 || now.cases_failed > 0) /* these are why it cannot be presented */
        status = check_end(run, &now, err);
    if (status == 0)
        status = check_published(run, &now, &counts, err);
    if (status == 0)
        status = check_values(run, &now, err);
    study_status_clear(&now);
    return status;
}

static int run_study(const void *values, const char *const *arguments) {
    const struct options *options = values;
    struct run run = {.file = arguments[0],
                      .database = options->database,
                      .folder = options->folder,
                      .sets = options->sets,
                      .threads = options->threads > 0 ? options->threads : processors()};
    struct error err = {0};
    signals_catch();
    int status = perform(&run, &err);
    int result = status == 0            ? EXIT_DONE
                 : run.faults.count > 0 ? command_fail_faults(run.file, &run.faults)
                                        : command_fail("run", &err);
    store_close(&run.store);
    fault_list_clear(&run.faults);
    return result;
}

const struct command COMMAND_RUN = {
    .name = "run",
    .arguments = "STUDY.json",
    .summary = "run a study here, from submission to table",
    .least = 1,
    .most = 1,
    .options = OPTIONS,
    .options_size = sizeof(struct options),
    .run = run_study,
};
