/* `rugo run`: a study from submission to table in one process; goes on where an earlier run of the
 * same study stopped. */
#include "jobs/allotment.h"
#include "server/command/access/access.h"
#include "server/command/command.h"
#include "server/command/study/kept_nodes.h"
#include "server/command/study/local_study.h"
#include "server/show/output.h"
#include "server/show/summary/progress.h"
#include "worker/log.h"
#include "worker/publish/publish.h"
#include "worker/worker.h"

/* A run that was killed is started again soon: its blocks need not wait for the usual minute.
 */
enum { LEASE_MS = 20000, REPORT_MS = 1000 /* for the bar */ };

struct options {
    const char *database;
    struct result_folder folder;
    const char **sets;
    unsigned threads;
    int log_level;
};
#define AT(member) offsetof(struct options, member)
static const struct option_row OPTIONS[] = {
    {"db", 0, OPTION_TEXT, 0, 0, AT(database), "FILE", DATABASE, "the local store"},
    {"workers", 0, OPTION_COUNT, 0, WORKERS_MOST, AT(threads), "N", "0",
     "threads; 0: as many processors as are allotted"},
    {"set", 0, OPTION_LIST, 0, 0, AT(sets), "PATH=VALUE", NULL, SET_HELP},
    {"out", 'o', OPTION_TEXT, 0, 0, AT(folder.path), "DIR", NULL,
     "write study.json, curves.json, curves.csv, an SVG a quantity, and nodes/ of what "
     "/contact/keep names"},
    REPLACE_ROW(AT(folder.replace)),
    {"log-level", 0, OPTION_CHOICE, 0, 0, AT(log_level), LOG_LEVELS, "warning", LOG_LEVEL_HELP},
    {0}};

struct run {
    struct local_submission submission;
    unsigned threads;
    struct store *store;
    char id[STUDY_ID_SIZE];
    struct fault_list faults;
};

/* Works until the study has ended; with others at work on it, waits for them too. */
static int work(struct run *run, struct error *err) {
    struct study_progress progress = {
        .store = run->store, .study = run->id, .bar = {.command = "run"}};
    struct worker_options options = {
        .source = {.database = run->submission.database,
                   .study = run->id,
                   .lease_ms = LEASE_MS,
                   .report_ms = REPORT_MS},
        .threads = run->threads,
        .drain = true,
        .stop = &stop_requested,
        .tick = progress_tick,
        .context = &progress,
    };
    int status = workers_run(&options, err);
    if (progress.bar.shown) { /* as it is at the end */
        progress.bar.next_ms = progress.bar.next_ms > 0 ? 1 : 0;
        progress_tick(&progress);
    }
    progress_end(&progress.bar);
    return status;
}

static int perform(struct run *run, struct error *err) {
    struct study_status now = {0};
    struct publish_counts counts = {0};
    const char *folder = run->submission.folder.path;
    int status = folder != NULL ? output_check(folder, err) : 0;
    if (status == 0)
        status = local_study_submit(&run->store, &run->submission, run->id, &run->faults, err);
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
    study_status_clear(&now);
    if (status != 0)
        return status;
    const struct outcome outcome = {.command = "run",
                                    .store = run->store,
                                    .database = run->submission.database,
                                    .id = run->id,
                                    .folder = run->submission.folder,
                                    .published = &counts};
    status = local_study_present(&outcome, err);
    return status == 0 && folder != NULL ? kept_nodes_write(run->store, run->id, folder, err)
                                         : status;
}

static int run_study(const void *values, const char *const *arguments) {
    const struct options *options = values;
    struct run run = {.submission = {.file = arguments[0],
                                     .database = options->database,
                                     .overrides = options->sets,
                                     .folder = options->folder},
                      .threads = options->threads > 0 ? options->threads : allotment_threads()};
    struct error err = {0};
    signals_catch();
    log_set_least((enum log_level)options->log_level);
    int status = perform(&run, &err);
    int result = command_end("run", status, arguments[0], &run.faults, &err);
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
