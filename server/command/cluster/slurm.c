/* `rugo slurm`: a study on the nodes of a Slurm cluster, from a login node. The server is a child
 * of this process, the pilots are one array of jobs, and the study is followed in the store. */
#include "server/command/cluster/pilots.h"
#include "server/command/cluster/slurm_inside.h"
#include "server/command/cluster/slurm_jobs.h"
#include "server/command/cluster/slurm_server.h"
#include "server/command/command.h"
#include "server/command/study/local_study.h"
#include "server/command/study/watch.h"
#include "server/show/output.h"
#include "server/show/summary/progress.h"
#include "worker/clock.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    LOOK_MS = 10000,    /* between two looks at the pilots */
    LEAVE_MS = 45000,   /* how long cancelled pilots may take to hand in */
    PUBLISH_MS = 60000, /* how long cases may be computed and not published */
    RESTARTS_MOST = 3,  /* of the server */
};

struct options {
    const char *folder, *database, *listen, *inside;
    struct result_folder out;
    const char **sets;
    unsigned nodes, lease_s;
    bool print;
    struct pilot_options pilot;
};
#define AT(member) offsetof(struct options, member)
static const struct option_row OPTIONS[] = {
    {"nodes", 0, OPTION_COUNT, 1, 100000, AT(nodes), "N", "1", "pilots, one on a node each"},
    PILOT_ROWS(struct options),
    {"set", 0, OPTION_LIST, 0, 0, AT(sets), "PATH=VALUE", NULL, SET_HELP},
    {"out", 'o', OPTION_TEXT, 0, 0, AT(out.path), "DIR", NULL,
     "write study.json, curves.json, curves.csv and an SVG a quantity"},
    REPLACE_ROW(AT(out.replace)),
    {"dir", 0, OPTION_TEXT, 0, 0, AT(folder), "DIR", "rugo-slurm",
     "work folder, which the nodes see too: script, logs, secrets"},
    {"db", 0, OPTION_TEXT, 0, 0, AT(database), "FILE", NULL,
     "the store, best on a disk of this machine (rugo.db in the work folder)"},
    {"listen", 0, OPTION_TEXT, 0, 0, AT(listen), "ADDR", NULL,
     "where nodes reach this machine (its name's address, or that of its first interface)"},
    {"lease", 0, OPTION_COUNT, 1, SECONDS_MOST, AT(lease_s), "SECONDS", "60",
     "how long a silent pilot keeps its jobs"},
    {"inside", 0, OPTION_TEXT, 0, 0, AT(inside), "TIME", NULL,
     "run this command, and with it the server, in a job of its own with this limit of time"},
    {"print", 0, OPTION_FLAG, 0, 0, AT(print), NULL, NULL,
     "print the batch script, which stays in the work folder, and stop"},
    {0}};

struct slurm_run {
    const struct options *options;
    struct slurm_folder folder;
    char database[PATH_MAX];
    struct pilots pilots;
    struct slurm_server server;
    unsigned restarts;
    struct store *store;
    char id[STUDY_ID_SIZE];
    struct fault_list faults;
    struct study_progress progress;
    /* of the study, at the last look */
    uint64_t waiting, done;
    uint64_t done_at_submission; /* realisations, when pilots were submitted last */
    bool submitted;
    unsigned lonely;    /* looks in a row at which work waited and there was no pilot */
    int64_t publish_ms; /* when all that is computed ought to be published */
    struct slurm_count count;
};

static void tell(struct slurm_run *run, const struct slurm_count *count) {
    if (count->waiting == run->count.waiting && count->running == run->count.running)
        return;
    progress_end(&run->progress.bar);
    fprintf(stderr, "rugo slurm: pilots: %u running, %u waiting\n", count->running, count->waiting);
}

/* Submits the pilots that are missing, at first or where pilots ended that had got on with the
 * study, such as at their limit of time. Pilots that end without having done anything are not
 * followed by more.
 */
static int look_at_pilots(struct slurm_run *run, struct error *err) {
    struct slurm_count count;
    struct error away = {0};
    if (slurm_jobs_count(run->pilots.name, &count, &away) != 0) {
        fprintf(stderr, "rugo slurm: %s; asked again\n", away.text);
        return run->submitted ? 0 : (*err = away, away.code);
    }
    tell(run, &count);
    run->count = count;
    unsigned there = count.waiting + count.running, wanted = run->options->nodes;
    bool lack = there < wanted && run->waiting > 0;
    run->lonely = lack && there == 0 ? run->lonely + 1 : 0;
    if (lack && (!run->submitted || run->done > run->done_at_submission)) {
        run->submitted = true;
        run->done_at_submission = run->done;
        run->lonely = 0;
        return slurm_jobs_submit(run->pilots.script, wanted - there, err);
    }
    if (run->lonely > 1)
        return error_set(err, ERROR_SYSTEM,
                         "work waits and no pilot is left, see %.200s/pilot-*.log; the same "
                         "command goes on",
                         run->folder.path);
    return 0;
}

/* A server that ended by itself is started again, a few times. */
static int look_at_server(struct slurm_run *run, struct error *err) {
    if (!slurm_server_has_ended(&run->server))
        return 0;
    if (run->restarts++ >= RESTARTS_MOST)
        return error_set(err, ERROR_SYSTEM, "the server ended %d times; see %.300s/server.log",
                         RESTARTS_MOST + 1, run->folder.path);
    fprintf(stderr, "rugo slurm: the server ended; started again\n");
    return slurm_server_start(&run->server, err);
}

/* Looks at the study; *ended where nothing of it is left to compute or publish. */
static int look_at_study(struct slurm_run *run, bool *ended, struct error *err) {
    static const char *const ENDS[] = {"done", "failed", "cancelled"};
    struct study_status now = {0};
    int status = store_status(run->store, run->id, &now, err);
    *ended = false;
    if (status != 0)
        return status;
    run->waiting = now.jobs_waiting;
    run->done = now.realisations_done;
    for (size_t e = 0; e < sizeof ENDS / sizeof *ENDS; e++)
        *ended = *ended || strcmp(now.state, ENDS[e]) == 0;
    if (now.jobs_waiting + now.jobs_running > 0)
        run->publish_ms = clock_ms() + PUBLISH_MS;
    else if (clock_ms() >= run->publish_ms)
        *ended = true; /* what keeps the cases from being published is reported at the end */
    study_status_clear(&now);
    return 0;
}

/* Follows the study to its end. */
static int follow(struct slurm_run *run, struct error *err) {
    int64_t look_ms = 0;
    bool ended = false;
    int status = look_at_study(run, &ended, err);
    while (status == 0 && !ended) {
        (void)progress_tick(&run->progress);
        if (clock_ms() >= look_ms) {
            status = look_at_pilots(run, err);
            look_ms = clock_ms() + LOOK_MS;
        }
        if (status == 0)
            status = look_at_server(run, err);
        if (status == 0 && !watch_pause())
            status = error_set(err, ERROR_STOPPED, "stopped");
        if (status == 0)
            status = look_at_study(run, &ended, err);
    }
    progress_end(&run->progress.bar);
    return status;
}

/* Ends the pilots, and after an interruption waits until they have handed in what they did. */
static void end_pilots(struct slurm_run *run, bool wait) {
    struct error err = {0};
    struct slurm_count count = {.left = 1};
    if (slurm_jobs_cancel(run->pilots.name, 0, &err) != 0) {
        fprintf(stderr, "rugo slurm: %s; scancel --name=%s ends the pilots\n", err.text,
                run->pilots.name);
        return;
    }
    if (wait)
        fprintf(stderr, "rugo slurm: pilots are cancelled, and hand in what they have done\n");
    for (int64_t until_ms = clock_ms() + LEAVE_MS; wait && count.left > 0;) {
        const struct timespec pause = {1, 0};
        nanosleep(&pause, NULL);
        if (slurm_jobs_count(run->pilots.name, &count, &err) != 0 || clock_ms() >= until_ms)
            return;
    }
}

static int compute(struct slurm_run *run, struct error *err) {
    run->publish_ms = clock_ms() + PUBLISH_MS;
    run->progress =
        (struct study_progress){.store = run->store, .study = run->id, .bar = {.command = "slurm"}};
    run->server = (struct slurm_server){.folder = &run->folder,
                                        .database = run->database,
                                        .address = run->options->listen,
                                        .lease_s = run->options->lease_s};
    int status = slurm_server_start(&run->server, err);
    if (status != 0)
        return status;
    status = follow(run, err);
    end_pilots(run, status != 0);
    slurm_server_stop(&run->server);
    slurm_folder_forget(&run->folder);
    return status;
}

/* Where the store is; absolute, since messages name it. */
static int find_database(struct slurm_run *run, struct error *err) {
    const char *given = run->options->database;
    if (given == NULL)
        return slurm_folder_file(&run->folder, "rugo.db", run->database, err);
    return snprintf(run->database, sizeof run->database, "%s", given) < PATH_MAX
               ? 0
               : error_set(err, ERROR_INPUT, "--db %.200s...: too long", given);
}

static int submit(struct slurm_run *run, const char *file, struct error *err) {
    const struct local_submission submission = {.database = run->database,
                                                .file = file,
                                                .overrides = run->options->sets,
                                                .folder = run->options->out};
    return local_study_submit(&run->store, &submission, run->id, &run->faults, err);
}

static int perform(struct slurm_run *run, const char *file, struct error *err) {
    struct study_status now = {0};
    struct publish_counts counts = {0};
    store_close(&run->store);
    int status = submit(run, file, err);
    if (status == 0)
        status = store_status(run->store, run->id, &now, err);
    if (status == 0 && now.jobs_waiting + now.jobs_running > 0)
        status = compute(run, err);
    study_status_clear(&now);
    if (status == 0)
        status = publish_due(run->store, NULL, NULL, &counts, err);
    const struct outcome outcome = {.command = "slurm",
                                    .store = run->store,
                                    .database = run->database,
                                    .id = run->id,
                                    .folder = run->options->out,
                                    .published = &counts};
    return status != 0 ? status : local_study_present(&outcome, err);
}

static int prepare(struct slurm_run *run, struct error *err) {
    const struct options *options = run->options;
    int status = options->out.path != NULL ? output_check(options->out.path, err) : 0;
    if (status == 0)
        status = slurm_folder_open(&run->folder, options->folder, err);
    if (status == 0)
        status = find_database(run, err);
    if (status == 0)
        status = pilots_prepare(&run->pilots, &run->folder, run->folder.path, &options->pilot, err);
    return status;
}

/* The command as a job: it is followed, and what became of the study is read from the store. */
static int perform_inside(struct slurm_run *run, const char *file, struct error *err) {
    static const char *const WITHOUT[] = {"inside", "print", NULL};
    const struct inside_command command = {OPTIONS, run->options, file, WITHOUT};
    const struct options *options = run->options;
    struct study_status now = {0};
    struct inside inside;
    int status = inside_prepare(&inside, &run->folder, &run->pilots, &options->pilot,
                                options->inside, &command, err);
    if (status == 0 && options->print)
        return pilots_print(inside.script, err);
    if (status == 0) /* what is wrong with the study is to be reported now */
        status = submit(run, file, err);
    store_close(&run->store);
    slurm_folder_close(&run->folder);
    if (status == 0)
        status = inside_follow(&inside, err);
    if (status == 0)
        status = submit(run, file, err);
    if (status == 0)
        status = store_status(run->store, run->id, &now, err);
    if (status == 0 && now.jobs_waiting + now.jobs_running > 0)
        status = error_set(err, ERROR_STATE,
                           "the job of the server ended before the study, see %.300s; the same "
                           "command goes on",
                           inside.log);
    study_status_clear(&now);
    return status == 0 ? perform(run, file, err) : status;
}

static int run_study(const void *values, const char *const *arguments) {
    const struct options *options = values;
    struct slurm_run run = {.options = options};
    struct error err = {0};
    if (pilot_options_check("slurm", &options->pilot) != 0)
        return EXIT_USAGE;
    if (options->inside != NULL && !script_is_word(options->inside))
        return usage_error("slurm", "--inside takes a time as of sbatch, such as 1-00:00:00");
    signals_catch();
    int status = prepare(&run, &err);
    if (status == 0 && options->inside != NULL)
        status = perform_inside(&run, arguments[0], &err);
    else if (status == 0 && options->print)
        status = pilots_print(run.pilots.script, &err);
    else if (status == 0)
        status = perform(&run, arguments[0], &err);
    int result = command_end("slurm", status, arguments[0], &run.faults, &err);
    store_close(&run.store);
    slurm_folder_close(&run.folder);
    fault_list_clear(&run.faults);
    return result;
}

const struct command COMMAND_SLURM = {
    .name = "slurm",
    .arguments = "STUDY.json",
    .summary = "run a study on the nodes of a Slurm cluster, from a login node",
    .least = 1,
    .most = 1,
    .options = OPTIONS,
    .options_size = sizeof(struct options),
    .run = run_study,
};
