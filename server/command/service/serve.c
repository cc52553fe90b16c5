/* `rugo serve`: the HTTP service, with workers of its own if wanted. */
#include "schema/hex.h"
#include "server/command/command.h"
#include "server/command/service/supervisor.h"
#include "server/http/http.h"
#include "server/http/waiting_room.h"
#include "worker/clock.h"
#include "worker/log.h"
#include "worker/quiet_thread.h"
#include "worker/worker.h"
#include <arpa/inet.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

struct options {
    const char *database, *listen, *token_file;
    const char **hosts, **shares;
    unsigned workers, lease_s, connections, deadline_s, map_mib;
    int64_t per_address; /* -1: not given */
    int log_level;
    const char *tls_certificate, *tls_key;
    bool insecure, convert;
};
#define AT(member) offsetof(struct options, member)
static const struct option_row OPTIONS[] = {
    {"db", 0, OPTION_TEXT, 0, 0, AT(database), "FILE", DATABASE, "the store"},
    {"listen", 0, OPTION_TEXT, 0, 0, AT(listen), "ADDR:PORT", "127.0.0.1:8080",
     "where to listen; port 0 picks a free one, a port alone is of 127.0.0.1"},
    {"token-file", 0, OPTION_TEXT, 0, 0, AT(token_file), "FILE", NULL,
     "tokens, mode 600, a role:name:token or its digest a line (see rugo token); needed beyond "
     "loopback"},
    {"workers", 0, OPTION_COUNT, 0, WORKERS_MOST, AT(workers), "N", "0",
     "run jobs in this process too, on N threads"},
    {"lease", 0, OPTION_COUNT, 1, SECONDS_MOST, AT(lease_s), "SECONDS", "60",
     "how long a silent worker keeps its job"},
    {"connections", 0, OPTION_COUNT, 1, 1000000, AT(connections), "N", "2048",
     "most connections at a time, beside a reserve for workers and probes"},
    {"per-address", 0, OPTION_INDEX, 0, 0, AT(per_address), "N", NULL,
     "most connections of one address beyond this machine, a quarter of all unless given; 0: no "
     "limit, as behind a proxy on another machine"},
    {"deadline", 0, OPTION_COUNT, 1, SECONDS_MOST, AT(deadline_s), "SECONDS", "30",
     "most time for one request"},
    {"map-size", 0, OPTION_COUNT, 0, 4096, AT(map_mib), "MIB", "64",
     "largest file of a map to characterise, which may take 16 times as much memory; 0: none"},
    {"convert", 0, OPTION_FLAG, 0, 0, AT(convert), NULL, NULL,
     "have Gwyddion convert files of peers in formats that are not read here"},
    {"share", 0, OPTION_LIST, 0, 0, AT(shares), "NAME=WEIGHT", NULL,
     "of the workers' time that the studies of a name have beside others; 1 until it is set"},
    {"log-level", 0, OPTION_CHOICE, 0, 0, AT(log_level), LOG_LEVELS, "info", LOG_LEVEL_HELP},
    {"allow-host", 0, OPTION_LIST, 0, 0, AT(hosts), "NAME", NULL,
     "a name of this server that its certificate does not have"},
    {"tls-cert", 0, OPTION_TEXT, 0, 0, AT(tls_certificate), "FILE", NULL,
     "speak TLS: the certificate with its chain, PEM; SIGHUP reads it again"},
    {"tls-key", 0, OPTION_TEXT, 0, 0, AT(tls_key), "FILE", NULL, "its key, PEM, mode 600"},
    {"insecure", 0, OPTION_FLAG, 0, 0, AT(insecure), NULL, NULL,
     "listen beyond loopback without TLS, such as behind a proxy that has it"},
    {0}};

struct serve {
    const struct options *options;
    char address[INET6_ADDRSTRLEN];
    uint16_t port;
    struct service service;
    struct http *http;
    struct certificate *certificate; /* NULL: plain HTTP */
};

static bool is_address(const char *text) {
    unsigned char bytes[sizeof(struct in6_addr)];
    return inet_pton(AF_INET, text, bytes) == 1 || inet_pton(AF_INET6, text, bytes) == 1;
}

/* Reads "127.0.0.1:8080" or "[::1]:8080". A port alone, and "localhost", are of 127.0.0.1. */
static int read_listen(struct serve *serve, struct error *err) {
    static const char LOOPBACK[] = "127.0.0.1", NAME[] = "localhost";
    const char *text = serve->options->listen, *colon = strrchr(text, ':');
    const char *digits = colon != NULL ? colon + 1 : text;
    size_t length = colon != NULL ? (size_t)(colon - text) : 0;
    bool local = length == 0 || (length == strlen(NAME) && strncmp(text, NAME, length) == 0);
    bool brackets = length > 2 && text[0] == '[' && text[length - 1] == ']';
    size_t width = local ? strlen(LOOPBACK) : length - 2 * brackets;
    char *end = NULL;
    unsigned long port = *digits >= '0' && *digits <= '9' ? strtoul(digits, &end, 10) : 65536;
    bool fits = port <= 65535 && *end == '\0' && width < sizeof serve->address;
    if (fits)
        snprintf(serve->address, sizeof serve->address, "%.*s", (int)width,
                 local ? LOOPBACK : text + brackets);
    if (!fits || !is_address(serve->address))
        return error_set(err, ERROR_INPUT,
                         "--listen %.60s is not ADDRESS:PORT, e.g. 127.0.0.1:8080 or [::1]:8080",
                         text);
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

static int read_certificate(struct serve *serve, struct error *err) {
    const char *certificate = serve->options->tls_certificate, *key = serve->options->tls_key;
    if ((certificate == NULL) != (key == NULL))
        return error_set(err, ERROR_INPUT, "--tls-cert and --tls-key go together");
    if (certificate != NULL)
        return certificate_open(&serve->certificate, certificate, key, err);
    if (is_loopback(serve->address) || serve->options->insecure)
        return 0;
    return error_set(err, ERROR_INPUT,
                     "--listen %s without TLS would take tokens in clear text beyond this machine: "
                     "see --tls-cert and rugo certificate, or --insecure behind a proxy with TLS",
                     serve->options->listen);
}

/* --- workers of its own --- */

enum {
    WORKERS_GRACE_MS = 700, /* how long a realisation may go on after a stop */
    /* What a stop of the server takes at most, without workers and with some: these hand in first
     * what they have, and may find the disk busy. */
    PATIENCE_MS = 1600,
    WORKERS_PATIENCE_MS = 8000,
};

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
                   .token = workers->serve->service.tokens != NULL ? workers->token : NULL,
                   .trust = {.own = true}},
        .threads = workers->serve->options->workers,
        .grace_ms = WORKERS_GRACE_MS,
        .stop = &stop_requested,
    };
    int status = workers_run(&options, &err);
    if (status != 0 && status != ERROR_STOPPED)
        log_line(LEVEL_ERROR, NULL, "workers: %s", err.text);
    return NULL;
}

static void print_url(const struct serve *serve, char *url, size_t size) {
    bool v6 = strchr(serve->address, ':') != NULL;
    snprintf(url, size, "http%s://%s%s%s:%u", serve->certificate != NULL ? "s" : "", v6 ? "[" : "",
             serve->address, v6 ? "]" : "", http_port(serve->http));
}

static int local_workers_start(struct local_workers *workers, struct error *err) {
    struct serve *serve = workers->serve;
    if (serve->options->workers == 0)
        return 0;
    print_url(serve, workers->url, sizeof workers->url);
    if (quiet_thread_start(&workers->thread, local_workers_thread, workers) != 0)
        return error_set(err, ERROR_SYSTEM, "cannot start the workers");
    workers->started = true;
    return 0;
}

/* Makes a token of this run alone, for the workers in this process. */
static int local_workers_token(struct local_workers *workers, struct error *err) {
    struct tokens *tokens = workers->serve->service.tokens;
    if (tokens == NULL || workers->serve->options->workers == 0)
        return 0;
    int status = hex_random(workers->token, TOKEN_SIZE - 1, err);
    if (status == 0)
        tokens_set_own(tokens, ROLE_READ | ROLE_WORK, workers->token);
    return status;
}

/* --- the service --- */

static int change_nothing(struct store *store, void *context, struct error *err) {
    (void)store;
    (void)context;
    (void)err;
    return 0;
}

/* The writer commits, or says why not: in both cases it is not stuck. */
static void touch_writer(void *writer) {
    (void)writer_do(writer, change_nothing, NULL, NULL);
}

/* A quarter leaves room for others, and holds the workers of a machine with many processors. */
static unsigned share_of_address(const struct options *options) {
    if (options->per_address < 0)
        return options->connections / 4 + 1;
    return options->per_address < UINT_MAX ? (unsigned)options->per_address : UINT_MAX;
}

static atomic_int reload_requested; /* set by SIGHUP */

static void on_hangup(int number) {
    (void)number;
    reload_requested = 1;
}

/* Tokens need no reload: their file is looked at with every request. */
static void reload(struct serve *serve) {
    struct error err = {0};
    char fingerprint[FINGERPRINT_SIZE];
    if (serve->certificate == NULL)
        return;
    if (certificate_reload(serve->certificate, &err) != 0) {
        log_line(LEVEL_ERROR, NULL, "the certificate stays as it was: %s", err.text);
        return;
    }
    certificate_fingerprint(serve->certificate, fingerprint);
    log_line(LEVEL_INFO, NULL, "certificate read again, fingerprint %s", fingerprint);
}

static void wait_for_end(struct serve *serve) {
    enum { LOOKS_PER_S = 10 };
    struct timespec pause = {0, 1000000000 / LOOKS_PER_S};
    for (unsigned n = 0; stop_requested == 0; n++) {
        nanosleep(&pause, NULL); /* a signal ends it early */
        if (serve->service.tokens != NULL && n % LOOKS_PER_S == 0)
            tokens_look(serve->service.tokens);
        if (atomic_exchange(&reload_requested, 0) != 0)
            reload(serve);
    }
}

static void announce(const struct serve *serve) {
    char url[96], fingerprint[FINGERPRINT_SIZE] = "";
    print_url(serve, url, sizeof url);
    if (serve->certificate != NULL)
        certificate_fingerprint(serve->certificate, fingerprint);
    printf("listening on %s\n%s%s%s", url, *fingerprint != '\0' ? "fingerprint " : "", fingerprint,
           *fingerprint != '\0' ? "\n" : "");
    fflush(stdout);
    log_line(LEVEL_INFO, NULL, "listening on %s, database %s%s%s", url, serve->options->database,
             *fingerprint != '\0' ? ", fingerprint " : "", fingerprint);
    supervisor_tell("READY=1");
}

/* Sets the weights of owners, which the store keeps. */
static int set_shares(struct serve *serve, struct error *err) {
    int status = 0;
    for (const char **share = serve->options->shares; status == 0 && *share != NULL; share++) {
        char name[OWNER_SIZE + 1], *end = NULL;
        const char *equals = strchr(*share, '=');
        size_t length = strcspn(*share, "=");
        const char *digits = equals != NULL ? equals + 1 : "";
        double weight = strtod(digits, &end);
        snprintf(name, sizeof name, "%.*s", length < sizeof name ? (int)length : OWNER_SIZE,
                 *share);
        if (!token_name_is_good(name) || *digits == '\0' || *end != '\0' ||
            strspn(digits, "+-.0123456789eE") != strlen(digits))
            return error_set(err, ERROR_INPUT,
                             "--share %.80s is not NAME=WEIGHT, where a name has 1 to %d letters, "
                             "digits, . _ @ or -",
                             *share, OWNER_SIZE - 1);
        status = store_share(serve->service.store, name, weight, err);
    }
    return status;
}

/* Ends the program where work that cannot be stopped, such as one long step of a merge or of a
 * realisation, outlasts a stop: what was answered is on disk, what was published is due again at
 * the next start, and leases run out. */
static void *last_resort_thread(void *context) {
    const int64_t *patience_ms = context; /* static: the thread may outlast all else */
    for (int64_t now_ms = clock_ms(), until_ms = now_ms + *patience_ms; now_ms < until_ms;
         now_ms = clock_ms()) {
        struct timespec left = {(until_ms - now_ms) / 1000, (until_ms - now_ms) % 1000 * 1000000};
        nanosleep(&left, NULL); /* a signal ends it early */
    }
    log_line(LEVEL_WARNING, NULL, "ended; work that was under way is due again at the next start");
    _exit(EXIT_DONE);
}

static void begin_end(const struct serve *serve) {
    static int64_t alone_ms = PATIENCE_MS, with_workers_ms = WORKERS_PATIENCE_MS;
    pthread_t thread;
    if (quiet_thread_start(&thread, last_resort_thread,
                           serve->options->workers > 0 ? &with_workers_ms : &alone_ms) == 0)
        pthread_detach(thread);
}

/* Whoever supervises this process hears that its writer lives. */
static int watch_until_end(struct serve *serve, struct error *err) {
    struct watchdog watchdog = {.touch = touch_writer, .context = serve->service.writer};
    int status = watchdog_start(&watchdog, err);
    if (status == 0) {
        wait_for_end(serve);
        supervisor_tell("STOPPING=1");
        begin_end(serve);
    }
    watchdog_stop(&watchdog);
    return status;
}

static int serve_run(struct serve *serve, struct error *err) {
    struct local_workers workers = {.serve = serve};
    int status = read_listen(serve, err);
    if (status == 0)
        status = read_tokens(serve, err);
    if (status == 0)
        status = read_certificate(serve, err);
    if (status == 0)
        status = local_workers_token(&workers, err);
    if (status == 0)
        status = service_open(&serve->service, serve->options->database,
                              1000 * (int64_t)serve->options->lease_s, err);
    if (status == 0)
        status = set_shares(serve, err);
    serve->service.convert = serve->options->convert;
    serve->service.map_bytes = (size_t)serve->options->map_mib << 20;
    struct http_options options = {.address = serve->address,
                                   .port = serve->port,
                                   .connections = serve->options->connections,
                                   .per_address = share_of_address(serve->options),
                                   .deadline_s = serve->options->deadline_s,
                                   .hosts = serve->options->hosts,
                                   .certificate = serve->certificate};
    if (status == 0)
        status = http_start(&serve->http, &serve->service, &options, err);
    if (status == 0) {
        announce(serve);
        status = local_workers_start(&workers, err);
    }
    if (status == 0)
        status = watch_until_end(serve, err);
    atomic_store(&serve->service.stopping, true);
    if (serve->service.room != NULL)
        waiting_room_end(serve->service.room);
    if (workers.started)
        pthread_join(workers.thread, NULL); /* hands its jobs back through the server */
    http_stop(&serve->http);
    service_close(&serve->service);
    certificate_close(&serve->certificate);
    if (status == 0)
        log_line(LEVEL_INFO, NULL, "ended");
    return status;
}

static int run(const void *values, const char *const *arguments) {
    (void)arguments;
    struct serve serve = {.options = values};
    struct error err = {0};
    const struct sigaction hangup = {.sa_handler = on_hangup};
    signals_catch();
    sigaction(SIGHUP, &hangup, NULL);
    log_set_least((enum log_level)serve.options->log_level);
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
