/* `rugo serve`: the HTTP service, with workers of its own if wanted. */
#include "server/command/command.h"
#include "server/http/http.h"
#include "worker/log.h"
#include "worker/worker.h"
#include <arpa/inet.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/random.h>
#include <time.h>

struct options {
    const char *database, *listen, *token_file;
    const char **hosts, **shares;
    unsigned workers, lease_s, connections, per_address, deadline_s;
};
#define AT(member) offsetof(struct options, member)
static const struct option_row OPTIONS[] = {
    {"db", 0, OPTION_TEXT, 0, 0, AT(database), "FILE", DATABASE, "the store"},
    {"listen", 0, OPTION_TEXT, 0, 0, AT(listen), "ADDR:PORT", "127.0.0.1:8080",
     "where to listen; port 0 picks a free one"},
    {"token-file", 0, OPTION_TEXT, 0, 0, AT(token_file), "FILE", NULL,
     "tokens, role:token or role:name:token a line (read, submit, work, admin); needed beyond "
     "loopback"},
    {"workers", 0, OPTION_COUNT, 0, WORKERS_MOST, AT(workers), "N", "0",
     "run jobs in this process too, on N threads"},
    {"lease", 0, OPTION_COUNT, 1, SECONDS_MOST, AT(lease_s), "SECONDS", "60",
     "how long a silent worker keeps its job"},
    {"connections", 0, OPTION_COUNT, 1, 1000000, AT(connections), "N", "256",
     "most connections at a time"},
    {"per-address", 0, OPTION_COUNT, 0, 1000000, AT(per_address), "N", "0",
     "most connections of one address; 0: no limit"},
    {"deadline", 0, OPTION_COUNT, 1, SECONDS_MOST, AT(deadline_s), "SECONDS", "30",
     "most time for one request"},
    {"share", 0, OPTION_LIST, 0, 0, AT(shares), "NAME=WEIGHT", NULL,
     "of the workers' time that the studies of a name have beside others; 1 until it is set"},
    {"allow-host", 0, OPTION_LIST, 0, 0, AT(hosts), "NAME", NULL, "another name of this server"},
    {0}};

struct serve {
    const struct options *options;
    char address[INET6_ADDRSTRLEN];
    uint16_t port;
    struct service service;
    struct http *http;
};

/* Reads "127.0.0.1:8080" or "[::1]:8080". */
static int read_listen(struct serve *serve, struct error *err) {
    const char *text = serve->options->listen, *colon = strrchr(text, ':');
    char *end = NULL;
    unsigned long port = colon != NULL ? strtoul(colon + 1, &end, 10) : 65536;
    size_t length = colon != NULL ? (size_t)(colon - text) : 0;
    bool brackets = length > 2 && text[0] == '[' && text[length - 1] == ']';
    size_t width = length - 2 * brackets;
    if (colon == NULL || end == colon + 1 || *end != '\0' || port > 65535 || width == 0 ||
        width >= sizeof serve->address)
        return error_set(err, ERROR_INPUT,
                         "--listen %.60s is not ADDRESS:PORT, e.g. 127.0.0.1:8080 or [::1]:8080",
                         text);
    memcpy(serve->address, text + brackets, width);
    serve->address[width] = 0;
    serve->port = (uint16_t)port;
    return 0;
}

static bool is_loopback(const char *address) {
    return strncmp(address, "127.", 4) == 0 || strcmp(address, "::1") == 0;
}

static int read_tokens(struct serve *serve, struct error *err) {
    if (serve->options->token_file != NULL)
        return tokens_read(&serve->service.tokens, serve->options->token_file, err);
    if (is_loopback(serve->address))
        return 0;
    return error_set(
        err, ERROR_INPUT,
        "--listen %s is not a loopback address: beyond this machine tokens are needed, "
        "see --token-file",
        serve->options->listen);
}

/* --- workers of its own --- */

struct local_workers {
    struct serve *serve;
    pthread_t thread;
    bool started;
    char url[96], token[TOKEN_SIZE];
};

static void *local_workers_thread(void *context) {
    struct local_workers *workers = context;
    struct error err = {0};
    struct worker_options options = {
        .source = {.url = workers->url,
                   .token = workers->serve->service.tokens != NULL ? workers->token : NULL},
        .threads = workers->serve->options->workers,
        .stop = &stop_requested,
    };
    int status = workers_run(&options, &err);
    if (status != 0 && status != ERROR_STOPPED)
        log_line(LEVEL_ERROR, NULL, "workers: %s", err.text);
    return NULL;
}

static void print_url(const struct serve *serve, char *url, size_t size) {
    bool v6 = strchr(serve->address, ':') != NULL;
    snprintf(url, size, "http://%s%s%s:%u", v6 ? "[" : "", serve->address, v6 ? "]" : "",
             http_port(serve->http));
}

static int local_workers_start(struct local_workers *workers, struct error *err) {
    struct serve *serve = workers->serve;
    if (serve->options->workers == 0)
        return 0;
    print_url(serve, workers->url, sizeof workers->url);
    if (pthread_create(&workers->thread, NULL, local_workers_thread, workers) != 0)
        return error_set(err, ERROR_SYSTEM, "cannot start the workers");
    workers->started = true;
    return 0;
}

/* Makes a token of this run alone, for the workers in this process. */
static int local_workers_token(struct local_workers *workers, struct error *err) {
    struct tokens *tokens = workers->serve->service.tokens;
    unsigned char bytes[(TOKEN_SIZE - 1) / 2];
    if (tokens == NULL || workers->serve->options->workers == 0)
        return 0;
    if (getrandom(bytes, sizeof bytes, 0) != (ssize_t)sizeof bytes)
        return error_set(err, ERROR_SYSTEM, "no random numbers from the kernel");
    for (size_t i = 0; i < sizeof bytes; i++)
        snprintf(workers->token + 2 * i, 3, "%02x", bytes[i]);
    return tokens_add(tokens, ROLE_READ | ROLE_WORK, workers->token, err);
}

/* --- the service --- */

static void wait_for_end(void) {
    struct timespec pause = {0, 100000000};
    while (stop_requested == 0)
        nanosleep(&pause, NULL); /* a signal ends it early */
}

static void announce(const struct serve *serve) {
    char url[96];
    print_url(serve, url, sizeof url);
    printf("listening on %s\n", url);
    fflush(stdout);
    log_line(LEVEL_INFO, NULL, "listening on %s, database %s", url, serve->options->database);
}

/* Sets the weights of owners, which the store keeps. */
static int set_shares(struct serve *serve, struct error *err) {
    int status = 0;
    for (const char **share = serve->options->shares; status == 0 && *share != NULL; share++) {
        char name[OWNER_SIZE], *end = NULL;
        const char *equals = strchr(*share, '=');
        double weight = equals != NULL ? strtod(equals + 1, &end) : 0;
        if (equals == NULL || equals == *share || equals - *share >= OWNER_SIZE ||
            end == equals + 1 || *end != '\0')
            return error_set(err, ERROR_INPUT, "--share %.80s is not NAME=WEIGHT", *share);
        snprintf(name, sizeof name, "%.*s", (int)(equals - *share), *share);
        status = store_share(serve->service.store, name, weight, err);
    }
    return status;
}

static int serve_run(struct serve *serve, struct error *err) {
    struct local_workers workers = {.serve = serve};
    int status = read_listen(serve, err);
    if (status == 0)
        status = read_tokens(serve, err);
    if (status == 0)
        status = local_workers_token(&workers, err);
    if (status == 0)
        status = service_open(&serve->service, serve->options->database,
                              1000 * (int64_t)serve->options->lease_s, err);
    if (status == 0)
        status = set_shares(serve, err);
    struct http_options options = {.address = serve->address,
                                   .port = serve->port,
                                   .connections = serve->options->connections,
                                   .per_address = serve->options->per_address,
                                   .deadline_s = serve->options->deadline_s,
                                   .hosts = serve->options->hosts};
    if (status == 0)
        status = http_start(&serve->http, &serve->service, &options, err);
    if (status == 0) {
        announce(serve);
        status = local_workers_start(&workers, err);
    }
    if (status == 0)
        wait_for_end();
    atomic_store(&serve->service.stopping, true);
    if (workers.started)
        pthread_join(workers.thread, NULL); /* hands its jobs back through the server */
    http_stop(&serve->http);
    service_close(&serve->service);
    if (status == 0)
        log_line(LEVEL_INFO, NULL, "ended");
    return status;
}

static int run(const void *values, const char *const *arguments) {
    (void)arguments;
    struct serve serve = {.options = values};
    struct error err = {0};
    signals_catch();
    int status = serve_run(&serve, &err);
    return status == 0 ? EXIT_DONE : command_fail("serve", &err);
}

const struct command COMMAND_SERVE = {
    .name = "serve",
    .arguments = "",
    .summary = "the HTTP service",
    .options = OPTIONS,
    .options_size = sizeof(struct options),
    .run = run,
};
