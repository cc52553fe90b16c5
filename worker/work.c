/* `rugo work`: claims and runs jobs of a local store or of a server. */
#include "server/command.h"
#include "worker/worker.h"

#include <errno.h>
#include <getopt.h>
#include <limits.h>
#include <sched.h>
#include <stdio.h>
#include <stdlib.h>

struct work_options {
    const char *database, *server, *token_file;
    unsigned threads;
    bool drain;
};

/* As many as the processors that this process may use. */
static unsigned threads_default(void) {
    cpu_set_t set;
    CPU_ZERO(&set);
    int count = sched_getaffinity(0, sizeof set, &set) == 0 ? CPU_COUNT(&set) : 1;
    return count > 0 ? (unsigned)count : 1;
}

static bool read_threads(const char *text, unsigned *threads) {
    char *end = NULL;
    errno = 0;
    unsigned long count = strtoul(text, &end, 10);
    if (errno || end == text || *end || text[0] == '-' || count < 1 || count > UINT_MAX) {
        return false;
    }
    *threads = (unsigned)count;
    return true;
}

static bool usage(const char *text) {
    fprintf(stderr, "rugo work: %s; see rugo work --help\n", text);
    return false;
}

static bool options_check(const struct work_options *options) {
    if (options->database && options->server) {
        return usage("--db and --server exclude each other");
    }
    if (options->token_file && !options->server) {
        return usage("--token-file goes with --server");
    }
    return true;
}

static bool options_read(int argc, char **argv, struct work_options *options) {
    static const struct option names[] = {
        {"db", required_argument, NULL, 'd'},
        {"server", required_argument, NULL, 's'},
        {"token-file", required_argument, NULL, 't'},
        {"workers", required_argument, NULL, 'w'},
        {"drain", no_argument, NULL, 'e'},
        {NULL, 0, NULL, 0},
    };
    *options = (struct work_options){.threads = threads_default()};
    optind = 1;
    for (int option; (option = getopt_long(argc, argv, "", names, NULL)) != -1;) {
        switch (option) {
        case 'd':
            options->database = optarg;
            break;
        case 's':
            options->server = optarg;
            break;
        case 't':
            options->token_file = optarg;
            break;
        case 'w':
            if (!read_threads(optarg, &options->threads)) {
                return usage("--workers must be a number of at least 1");
            }
            break;
        case 'e':
            options->drain = true;
            break;
        default:
            return usage("wrong options");
        }
    }
    return optind == argc ? options_check(options) : usage("too many arguments");
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
