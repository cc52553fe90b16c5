/* `rugo work`: claims and runs jobs of a local store or of a server. */
#include "jobs/allotment.h"
#include "server/command/access/access.h"
#include "server/command/command.h"
#include "server/command/service/supervisor.h"
#include "server/command/service/token_file.h"
#include "worker/clock.h"
#include "worker/log.h"
#include "worker/worker.h"
#include <stdlib.h>

struct options {
    struct access_options place;
    unsigned threads, lease_s, idle_s;
    bool drain;
    const char *name;
    int log_level;
};
#define AT(member) offsetof(struct options, member)
static const struct option_row OPTIONS[] = {
    ACCESS_ROWS(struct options),
    {"workers", 0, OPTION_COUNT, 0, WORKERS_MOST, AT(threads), "N", "0",
     "threads; 0: as many processors as are allotted"},
    {"drain", 0, OPTION_FLAG, 0, 0, AT(drain), NULL, NULL, "end when the queue is empty"},
    {"idle-exit", 0, OPTION_COUNT, 1, SECONDS_MOST, AT(idle_s), "SECONDS", NULL,
     "end when no job has run for so long, also where nobody answers"},
    {"lease", 0, OPTION_COUNT, 1, SECONDS_MOST, AT(lease_s), "SECONDS", NULL,
     "how long this worker may be silent, with --db (60)"},
    {"name", 0, OPTION_TEXT, 0, 0, AT(name), "NAME", NULL,
     "what lists and logs call this worker; its host and process number without"},
    {"log-level", 0, OPTION_CHOICE, 0, 0, AT(log_level), LOG_LEVELS, "info", LOG_LEVEL_HELP},
    {0}};

/* What was reported to whoever supervises this process. */
struct told {
    bool ready, stopping;
    int64_t alive_ms; /* clock_ms of the last report */
};

static int tell(void *context) {
    struct told *told = context;
    int64_t interval_ms = supervisor_interval_ms(), now_ms = clock_ms();
    bool stopping = stop_requested != 0; /* may change at any time */
    if (!told->ready)
        supervisor_tell("READY=1");
    if (stopping && !told->stopping)
        supervisor_tell("STOPPING=1");
    if (interval_ms > 0 && (!told->ready || now_ms - told->alive_ms >= interval_ms)) {
        supervisor_tell("WATCHDOG=1");
        told->alive_ms = now_ms;
    }
    told->ready = true;
    told->stopping = stopping;
    return 0;
}

static int work(const struct options *options, const char *token, struct error *err) {
    const struct access_options *place = &options->place;
    const char *database = place->database != NULL ? place->database : DATABASE;
    struct told told = {0};
    int64_t left_s = allotment_seconds();
    struct worker_options worker = {
        .source = {.database = place->server != NULL ? NULL : database,
                   .url = place->server,
                   .token = token,
                   .worker = options->name,
                   .trust = access_trust(place),
                   .lease_ms = 1000 * (int64_t)options->lease_s},
        .threads = options->threads > 0 ? options->threads : allotment_threads(),
        .drain = options->drain,
        .idle_s = options->idle_s,
        .until_ms = left_s > 0 ? clock_ms() + 1000 * left_s : 0,
        .stop = &stop_requested,
        .tick = tell,
        .context = &told,
    };
    signals_catch();
    log_set_least((enum log_level)options->log_level);
    int status = workers_run(&worker, err);
    if (!told.stopping)
        supervisor_tell("STOPPING=1");
    /* without --drain a worker ends when it is asked to stop */
    return status == ERROR_STOPPED && !options->drain ? 0 : status;
}

static int run(const void *values, const char *const *arguments) {
    (void)arguments;
    const struct options *options = values;
    struct error err = {0};
    char *token = NULL;
    if (access_options_check("work", &options->place) != 0)
        return EXIT_USAGE;
    if (options->lease_s > 0 && options->place.server != NULL)
        return usage_error("work", "--lease goes with --db; a server has its own");
    int status = options->place.server != NULL
                     ? token_read(options->place.token_file, ROLE_WORK, &token, &err)
                     : 0;
    if (status == 0)
        status = work(options, token, &err);
    free(token);
    return status == 0 ? EXIT_DONE : command_fail("work", &err);
}

const struct command COMMAND_WORK = {
    .name = "work",
    .arguments = "",
    .summary = "claim and run jobs of a store or a server",
    .options = OPTIONS,
    .options_size = sizeof(struct options),
    .run = run,
};
