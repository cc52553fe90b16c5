/* The queue: claim and complete with a result of 4 KB, in a queue of 100 000 jobs, at 8 keep-alive
 * connections over HTTP, beside a bare writer thread with group commit and a probe of the disk's
 * fdatasync, all in one run.
 *
 * The results are real ones (the server checks what it takes): one tiny profile's block is computed
 * once and handed in for every job. The clients send texts made beforehand and look for three
 * fields in the answers, so that on few processors it is the server that is measured. */
#include "server/http/writer.h"
#include "tests/support/queue_load.h"
#include "worker/wire.h"
#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/tcp.h>
#include <pthread.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

enum { JOBS = 100000, CLIENTS = 8, PROBES = 400, SECONDS = 6, ANSWER_MOST = 16384 };

static void probe_disk(void) {
    char page[4096] = {0};
    double latencies[PROBES], start = seconds();
    size_t n = 0;
    int file = open("probe", O_WRONLY | O_CREAT | O_TRUNC, 0666);
    for (; file >= 0 && n < PROBES; n++) {
        double before = seconds();
        if (write(file, page, sizeof page) != (ssize_t)sizeof page || fdatasync(file))
            break;
        latencies[n] = seconds() - before;
    }
    if (file >= 0)
        close(file);
    print_rate("fdatasync of 4 KB", seconds() - start, latencies, n);
}

struct bench_client {
    struct writer *writer; /* of the bare loop */
    struct block_result block;
    struct claimed_job job;
    uint16_t port; /* over HTTP */
    const char *body;
    double until, *latencies; /* room for JOBS */
    size_t count;
};

/* --- the bare writer --- */

static int bare_claim(struct store *store, void *context, struct error *err) {
    struct bench_client *client = context;
    struct claim claim = {.worker = "bench", .host = "bench", .count = 1};
    size_t found = 0;
    int status = store_claim(store, &claim, &client->job, &found, err);
    return status ? status : found ? 0 : ERROR_ABSENT;
}

static int bare_complete(struct store *store, void *context, struct error *err) {
    struct bench_client *client = context;
    bool first, done;
    client->block.first = client->job.first;
    return store_complete(store, client->job.id, client->job.token, &client->block, &first, &done,
                          err);
}

/* As the server does: the text of the result is made before the writer is asked. */
static int bare_job(struct bench_client *client, struct error *err) {
    struct block_text text = {0};
    int status = writer_do(client->writer, bare_claim, client, err);
    if (!status)
        status = block_text_create(&text, &client->block, err);
    client->block.text = &text;
    if (!status)
        status = writer_do(client->writer, bare_complete, client, err);
    block_text_clear(&text);
    claimed_job_clear(&client->job);
    return status;
}

static void *bare_thread(void *context) {
    struct bench_client *client = context;
    struct error err;
    double start = seconds();
    while (start < client->until && bare_job(client, &err) == 0) {
        double end = seconds();
        client->latencies[client->count++] = end - start;
        start = end;
    }
    return NULL;
}

/* --- over HTTP --- */

static int connect_to(uint16_t port) {
    struct sockaddr_in address = {
        .sin_family = AF_INET, .sin_port = htons(port), .sin_addr.s_addr = htonl(INADDR_LOOPBACK)};
    int on = 1, socket_file = socket(AF_INET, SOCK_STREAM, 0);
    setsockopt(socket_file, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    if (socket_file >= 0 && connect(socket_file, (struct sockaddr *)&address, sizeof address)) {
        close(socket_file);
        return -1;
    }
    return socket_file;
}

/* One POST on a kept connection; the status, or -1. answer: headers and body. */
static int post(int socket_file, const char *path, const char *body, char answer[ANSWER_MOST]) {
    static _Thread_local char request[4 * ANSWER_MOST];
    int size = snprintf(request, sizeof request,
                        "POST %s HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Type: application/json\r\n"
                        "Content-Length: %zu\r\n\r\n%s",
                        path, strlen(body), body);
    if (size < 0 || (size_t)size >= sizeof request ||
        send(socket_file, request, (size_t)size, MSG_NOSIGNAL) != size)
        return -1;
    for (size_t have = 0; have + 1 < ANSWER_MOST;) {
        ssize_t got = recv(socket_file, answer + have, ANSWER_MOST - 1 - have, 0);
        if (got <= 0)
            return -1;
        have += (size_t)got;
        answer[have] = 0;
        const char *end = strstr(answer, "\r\n\r\n"), *length = strstr(answer, "Content-Length: ");
        size_t wanted = length ? strtoul(length + 16, NULL, 10) : 0;
        if (end && (size_t)(end + 4 - answer) + wanted <= have)
            return atoi(answer + 9);
    }
    return -1;
}

static const char *behind(const char *text, const char *key) {
    const char *at = strstr(text, key);
    return at ? at + strlen(key) : "";
}

static bool one_job(const struct bench_client *client, int socket_file) {
    static _Thread_local char answer[ANSWER_MOST], body[2 * ANSWER_MOST];
    if (post(socket_file, "/v1/jobs/claim", "{\"worker\":\"bench\",\"kinds\":[\"statistics\"]}",
             answer) != 200)
        return false;
    char path[64];
    snprintf(path, sizeof path, "/v1/jobs/%lld/complete", atoll(behind(answer, "\"id\":")));
    snprintf(body, sizeof body, "{\"token\":\"%.32s\",\"first\":%lld,%s",
             behind(answer, "\"token\":\""), atoll(behind(answer, "\"first\":")), client->body);
    int status = post(socket_file, path, body, answer);
    if (status != 200)
        fprintf(stderr, "bench_queue: %s\n", status < 0 ? "no answer" : answer);
    return status == 200;
}

static void *remote_thread(void *context) {
    struct bench_client *client = context;
    int socket_file = connect_to(client->port);
    double start = seconds();
    while (start < client->until && one_job(client, socket_file)) {
        double end = seconds();
        client->latencies[client->count++] = end - start;
        start = end;
    }
    if (socket_file >= 0)
        close(socket_file);
    return NULL;
}

/* The message of a result, without its opening brace, token and first. */
static char *body_text(const struct block_result *result) {
    cJSON *message = wire_result("token", result);
    cJSON_DeleteItemFromObject(message, "token");
    cJSON_DeleteItemFromObject(message, "first");
    char *text = message ? json_print(message) : NULL;
    cJSON_Delete(message);
    if (text)
        memmove(text, text + 1, strlen(text));
    return text;
}

/* Starts the server and waits for its port; 0 when it does not come. */
static uint16_t serve(const char *database, pid_t *pid) {
    const char *program = getenv("RUGO");
    fflush(stdout); /* or the child would print it once more */
    *pid = fork();
    if (*pid == 0) {
        if (freopen("serve.out", "w", stdout) && freopen("/dev/null", "w", stderr))
            execl(program ? program : "build/rugo", "rugo", "serve", "--db", database, "--listen",
                  "127.0.0.1:0", (char *)NULL);
        _exit(127);
    }
    unsigned port = 0;
    for (int tries = 0; tries < 500 && !port; tries++) {
        FILE *file = fopen("serve.out", "r");
        if (!file || fscanf(file, "listening on http://127.0.0.1:%u", &port) != 1)
            port = 0;
        if (file)
            fclose(file);
        nanosleep(&(struct timespec){0, 10000000}, NULL);
    }
    return (uint16_t)port;
}

/* --- both --- */

/* Runs the clients for SECONDS and prints what they did. */
static size_t run_clients(const char *name, void *(*body)(void *), const struct bench_client *model,
                          double *latencies) {
    struct bench_client clients[CLIENTS];
    pthread_t threads[CLIENTS];
    size_t total = 0;
    double start = seconds();
    for (size_t c = 0; c < CLIENTS; c++) {
        clients[c] = *model;
        clients[c].until = start + SECONDS;
        clients[c].latencies = latencies + c * JOBS;
        pthread_create(&threads[c], NULL, body, &clients[c]);
    }
    for (size_t c = 0; c < CLIENTS; c++) {
        pthread_join(threads[c], NULL);
        memmove(latencies + total, clients[c].latencies, clients[c].count * sizeof *latencies);
        total += clients[c].count;
    }
    print_rate(name, seconds() - start, latencies, total);
    return total;
}

static int bench_bare(const struct block_result *result, double *latencies, struct error *err) {
    struct store *store = NULL;
    struct bench_client model = {.block = *result};
    int status = queue_create("bare.db", JOBS, err);
    if (!status)
        status = store_open(&store, "bare.db", NULL, err);
    if (!status)
        status = writer_create(&model.writer, store, err);
    if (!status) {
        run_clients("bare writer thread, 8 clients", bare_thread, &model, latencies);
        writer_destroy(&model.writer);
    }
    store_close(&store);
    return status;
}

static double cpu_us(const struct timeval *time) {
    return 1e6 * (double)time->tv_sec + (double)time->tv_usec;
}

static int bench_http(const struct block_result *result, double *latencies, struct error *err) {
    pid_t server = 0;
    char *body = body_text(result);
    int status = body ? queue_create("http.db", JOBS, err) : error_memory(err, 0, "a message");
    if (!status) {
        struct bench_client model = {.port = serve("http.db", &server), .body = body};
        size_t jobs = run_clients("over HTTP, 8 connections", remote_thread, &model, latencies);
        struct rusage usage = {0};
        kill(server, SIGTERM);
        wait4(server, NULL, 0, &usage);
        printf("%-46s %8.0f us of CPU a job, %.0f of them in the kernel\n", "  its server",
               (cpu_us(&usage.ru_utime) + cpu_us(&usage.ru_stime)) / (double)jobs,
               cpu_us(&usage.ru_stime) / (double)jobs);
    }
    free(body);
    return status;
}

int main(void) {
    struct error err = {0};
    struct block_result result = {0};
    double *latencies = calloc((size_t)CLIENTS * JOBS, sizeof *latencies);
    int status = latencies ? queue_compute(&result, &err) : ERROR_MEMORY;
    if (!status) {
        printf("claim and complete, %zu bytes and %zu scalars a result, queue of %d jobs, %d s\n",
               result.size, result.scalar_count, JOBS, SECONDS);
        probe_disk();
        status = bench_bare(&result, latencies, &err);
    }
    if (!status)
        status = bench_http(&result, latencies, &err);
    if (!status)
        probe_disk();
    else
        fprintf(stderr, "bench_queue: %s\n", err.text);
    block_result_clear(&result);
    free(latencies);
    return status ? 1 : 0;
}
