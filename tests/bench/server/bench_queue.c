/* The queue: claim and complete with a result of 4 KB, in a queue of 100 000 jobs, at 8 keep-alive
 * connections over HTTP, job by job and many at once as workers do. In the same run, for
 * comparison: a bare writer thread with group commit, and a probe of the disk's fdatasync.
 *
 * The results are real ones (the server checks what it takes): one tiny profile's block is computed
 * once and handed in for every job. The clients send texts made beforehand and look for three
 * fields in the answers, so that on few processors it is the server that is measured. */
#include "server/http/writer.h"
#include "tests/support/http_load.h"
#include "tests/support/queue_load.h"
#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

enum { JOBS = 100000, CLIENTS = 8, PROBES = 400, SECONDS = 6 };

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

static bool one_job(const struct bench_client *client, int socket_file) {
    static _Thread_local char answer[LOAD_ANSWER], body[32 << 10];
    if (load_post(socket_file, "/v1/jobs/claim",
                  "{\"worker\":\"bench\",\"kinds\":[\"statistics\"]}", answer) != 200)
        return false;
    char path[64];
    snprintf(path, sizeof path, "/v1/jobs/%lld/complete", atoll(load_behind(answer, "\"id\":")));
    snprintf(body, sizeof body, "{\"token\":\"%.32s\",\"first\":%lld,%s",
             load_behind(answer, "\"token\":\""), atoll(load_behind(answer, "\"first\":")),
             client->body);
    int status = load_post(socket_file, path, body, answer);
    if (status != 200)
        fprintf(stderr, "bench_queue: %s\n", status < 0 ? "no answer" : answer);
    return status == 200;
}

/* Claims as many as fill a few seconds, and hands all their results in together, as `rugo work`
 * does; returns how many. */
static size_t many_jobs(const struct bench_client *client, int socket_file) {
    static _Thread_local char answer[LOAD_ANSWER], body[LOAD_REQUEST];
    if (load_post(socket_file, "/v1/jobs/claim",
                  "{\"worker\":\"bench\",\"kinds\":[\"statistics\"],\"count\":100,\"seconds\":5}",
                  answer) != 200)
        return 0;
    size_t used = (size_t)snprintf(body, sizeof body, "{\"reports\":["), count = 0;
    for (const char *at = strstr(answer, "{\"id\":"); at != NULL && used + (32 << 10) < sizeof body;
         at = strstr(at + 1, "{\"id\":"), count++)
        used += (size_t)snprintf(body + used, sizeof body - used,
                                 "%s{\"verb\":\"complete\",\"job\":%lld,\"token\":\"%.32s\","
                                 "\"first\":%lld,%s",
                                 count > 0 ? "," : "", atoll(load_behind(at, "\"id\":")),
                                 load_behind(at, "\"token\":\""),
                                 atoll(load_behind(at, "\"first\":")), client->body);
    snprintf(body + used, sizeof body - used, "]}");
    int status = load_post(socket_file, "/v1/jobs/report", body, answer);
    if (status != 200 || strstr(answer, "\"detail\"") != NULL) {
        fprintf(stderr, "bench_queue: %s\n", status < 0 ? "no answer" : answer);
        return 0;
    }
    return count;
}

static void *remote_thread(void *context) {
    struct bench_client *client = context;
    int socket_file = load_connect(client->port);
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

/* The latency is that of a job among those at once. */
static void *batch_thread(void *context) {
    struct bench_client *client = context;
    int socket_file = load_connect(client->port);
    double start = seconds();
    for (size_t count; start < client->until && (count = many_jobs(client, socket_file)) > 0;) {
        double end = seconds();
        for (size_t n = 0; n < count; n++)
            client->latencies[client->count++] = (end - start) / (double)count;
        start = end;
    }
    if (socket_file >= 0)
        close(socket_file);
    return NULL;
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

static double cpu_us(const struct timeval *time) {
    return 1e6 * (double)time->tv_sec + (double)time->tv_usec;
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
        struct rusage before = {0}, after = {0};
        getrusage(RUSAGE_SELF, &before);
        size_t jobs = run_clients("bare writer thread, 8 clients", bare_thread, &model, latencies);
        getrusage(RUSAGE_SELF, &after);
        double kernel = cpu_us(&after.ru_stime) - cpu_us(&before.ru_stime);
        printf("%-46s %8.0f us of CPU a job, %.0f of them in the kernel\n", "  its process",
               (cpu_us(&after.ru_utime) - cpu_us(&before.ru_utime) + kernel) / (double)jobs,
               kernel / (double)jobs);
        writer_destroy(&model.writer);
    }
    store_close(&store);
    return status;
}

static int bench_http(const char *database, const char *name, void *(*thread)(void *),
                      const struct block_result *result, double *latencies, struct error *err) {
    pid_t server = 0;
    char *body = load_body(result);
    int status = body ? queue_create(database, JOBS, err) : error_memory(err, 0, "a message");
    if (!status) {
        struct bench_client model = {.port = load_serve(database, &server), .body = body};
        size_t jobs = run_clients(name, thread, &model, latencies);
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
        status = bench_http("http.db", "over HTTP, 8 connections, job by job", remote_thread,
                            &result, latencies, &err);
    if (!status)
        status = bench_http("batch.db", "over HTTP, 8 connections, as rugo work", batch_thread,
                            &result, latencies, &err);
    if (!status)
        probe_disk();
    else
        fprintf(stderr, "bench_queue: %s\n", err.text);
    block_result_clear(&result);
    free(latencies);
    return status ? 1 : 0;
}
