/* `rugo work`: claims and runs jobs of a local store or of a server. */
#include "server/command.h"
#include "server/options.h"
#include "worker/worker.h"

#include <stdlib.h>

struct work_options {
    const char *database, *server, *token_file;
    unsigned threads;
    bool drain;
};

static bool options_read(int argc, char **argv, struct work_options *options) {
    *options = (struct work_options){.threads = processors()};
    const struct option_row rows[] = {
        {"db", OPTION_TEXT, &options->database},
        {"server", OPTION_TEXT, &options->server},
        {"token-file", OPTION_TEXT, &options->token_file},
        {"workers", OPTION_COUNT, &options->threads},
        {"drain", OPTION_FLAG, &options->drain},
        {0},
    };
    const char *none[1];
    if (!options_parse(argc, argv, rows, 0, 0, none)) {
        return false;
    }
    if (options->database && options->server) {
        return usage_error("work", "--db and --server exclude each other");
    }
    if (options->token_file && !options->server) {
        return usage_error("work", "--token-file goes with --server");
    }
    return true;
}

static int work(const struct work_options *options, const char *token, struct error *err) {
    struct worker_options worker = {
        .source = {.database = options->database, .url = options->server, .token = token},
        .threads = options->threads,
        .drain = options->drain,
        .stop = &stop_requested,
    };
    if (!options->server && !options->database) {
        worker.source.database = "rugo.db";
    }
    signals_catch();
    int status = workers_run(&worker, err);
    /* without --drain being told to stop is how a worker ends */
    return status == ERROR_STOPPED && !options->drain ? 0 : status;
}

int command_work(int argc, char **argv) {
    struct work_options options;
    struct error err = {0};
    char *token = NULL;
    if (!options_read(argc, argv, &options)) {
        return EXIT_USAGE;
    }
    int status = options.server ? token_read(options.token_file, &token, &err) : 0;
    status = status ? status : work(&options, token, &err);
    free(token);
    return status ? command_fail("work", &err) : EXIT_DONE;
}
