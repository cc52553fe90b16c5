/* `rugo work`: claims and runs jobs of a local store or of a server. */
#include "server/command/access.h"
#include "server/command/command.h"
#include "server/command/token_file.h"
#include "worker/worker.h"
#include <stdlib.h>

struct options {
    struct access_options place;
    unsigned threads, lease_s;
    bool drain;
};
#define AT(member) offsetof(struct options, member)
static const struct option_row OPTIONS[] = {
    ACCESS_ROWS(struct options),
    {"workers", 0, OPTION_COUNT, 0, WORKERS_MOST, AT(threads), "N", "0",
     "threads; 0: as many as processors"},
    {"drain", 0, OPTION_FLAG, 0, 0, AT(drain), NULL, NULL, "end when the queue is empty"},
    {"lease", 0, OPTION_COUNT, 1, SECONDS_MOST, AT(lease_s), "SECONDS", NULL,
     "how long this worker may be silent, with --db (60)"},
    {0}};

static int work(const struct options *options, const char *token, struct error *err) {
    const struct access_options *place = &options->place;
    const char *database = place->database != NULL ? place->database : DATABASE;
    struct worker_options worker = {
        .source = {.database = place->server != NULL ? NULL : database,
                   .url = place->server,
                   .token = token,
                   .lease_ms = 1000 * (int64_t)options->lease_s},
        .threads = options->threads > 0 ? options->threads : processors(),
        .drain = options->drain,
        .stop = &stop_requested,
    };
    signals_catch();
    int status = workers_run(&worker, err);
    /* without --drain being told to stop is how a worker ends */
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
