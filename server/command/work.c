/* `rugo work`: claims and runs jobs of a local store or of a server. */
#include "server/command/command.h"
#include "server/command/options.h"
#include "worker/worker.h"
#include <stdlib.h>

struct work_options {
    const char *database, *server, *token_file;
    unsigned threads, lease_s;
    bool drain;
};

static bool options_check(const struct work_options *options) {
    if (options->database && options->server)
        return usage_error("work", "--db and --server exclude each other");
    if (options->token_file && !options->server)
        return usage_error("work", "--token-file goes with --server");
    if (options->lease_s && options->server)
        return usage_error("work", "--lease goes with --db; a server has its own");
    return true;
}

static int work(const struct work_options *options, const char *token, struct error *err) {
    const char *database = options->database ? options->database : "rugo.db";
    struct worker_options worker = {
        .source = {.database = options->server ? NULL : database,
                   .url = options->server,
                   .token = token,
                   .lease_ms = 1000 * (int64_t)options->lease_s},
        .threads = options->threads,
        .drain = options->drain,
        .stop = &stop_requested,
    };
    signals_catch();
    int status = workers_run(&worker, err);
    /* without --drain being told to stop is how a worker ends */
    return status == ERROR_STOPPED && !options->drain ? 0 : status;
}

int command_work(int argc, char **argv) {
    struct work_options options = {.threads = processors()};
    struct option_row rows[] = {{"db", OPTION_TEXT, &options.database},
                                {"server", OPTION_TEXT, &options.server},
                                {"token-file", OPTION_TEXT, &options.token_file},
                                {"workers", OPTION_COUNT, &options.threads},
                                {"lease", OPTION_COUNT, &options.lease_s},
                                {"drain", OPTION_FLAG, &options.drain},
                                {0}};
    struct error err = {0};
    char *token = NULL;
    if (!options_parse(argc, argv, rows, 0, 0, NULL) || !options_check(&options))
        return EXIT_USAGE;
    int status = options.server ? token_read(options.token_file, &token, &err) : 0;
    status = status ? status : work(&options, token, &err);
    free(token);
    return status ? command_fail(argv[0], &err) : EXIT_DONE;
}
