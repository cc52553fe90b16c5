/* The queue: claim and complete with a 4 KB result, at 8 keep-alive connections over HTTP, beside a
 * bare writer thread with group commit and a probe of the disk's fdatasync, all in one run.
 *
 * The results are real ones (the server checks what it takes): one tiny profile's block is computed
 * once and handed in for every job of its case. */
#include "jobs/kind.h"
#include "server/writer.h"
#include "worker/client.h"
#include "worker/kinds.h"
#include "worker/wire.h"
#include <fcntl.h>
#include <math.h>
#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

enum { JOBS = 20000, CLIENTS = 8, PROBES = 200 };

/* JOBS realisations, cut below into jobs of one each. */
_Static_assert(JOBS == 20000, "as in the study");
static const char STUDY[] = "{\"name\":\"queue\",\"kind\":\"statistics\",\"seed\":1,"
                            "\"realisations\":20000,\"surface\":{\"dimension\":1,"
                            "\"hurst\":0.8,\"wavelength_ratio\":2,\"length_ratio\":2,\"points_per_"
                            "wavelength\":4},\"statistics\":{"
                            "\"bins\":{\"height\":[-4,4,40],\"curvature\":[-8,0,20]}}}";

static double seconds(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static int by_value(const void *a, const void *b) {
    const double *x = a, *y = b;
    return (*x > *y) - (*x < *y);
}

static void print_rate(const char *name, double elapsed, double *latencies, size_t n) {
    qsort(latencies, n, sizeof *latencies, by_value);
    printf("%-44s %8.0f a second   p50 %6.2f ms   p99 %6.2f ms\n", name, (double)n / elapsed,
           1e3 * latencies[n / 2], 1e3 * latencies[n * 99 / 100]);
}

static void probe_disk(void) {
    char page[4096] = {0};
    double latencies[PROBES], start = seconds();
    int file = open("probe", O_WRONLY | O_CREAT | O_TRUNC, 0666);
    for (int i = 0; file >= 0 && i < PROBES; i++) {
        double before = seconds();
        if (write(file, page, sizeof page) != (ssize_t)sizeof page || fdatasync(file))
            break;
        latencies[i] = seconds() - before;
    }
    close(file);
    print_rate("fdatasync of 4 KB", seconds() - start, latencies, PROBES);
}

/* --- a queue of JOBS jobs --- */

static int submit(const char *database, struct error *err) {
    struct store *store = NULL;
    struct study *study = NULL;
    struct fault_list faults = {0};
    char id[STUDY_ID_SIZE];
    int status = kinds_read_study(&study, STUDY, strlen(STUDY), NULL, &faults, err);
    if (!status)
        status = store_open(&store, database, NULL, err);
    if (!status) {
        study->cases[0].block = 1;
        status = store_submit(store, study, NULL, id, NULL, err);
    }
    fault_list_clear(&faults);
    study_destroy(&study);
    store_close(&store);
    return status;
}

/* The block of realisation 0 of case 0, seed 1: what every job of the queue has to compute. */
static int compute(struct job_result *result, struct error *err) {
    struct study *study = NULL;
    struct fault_list faults = {0};
    struct job_runner *runner = NULL;
    const struct job_kind *kind = kind_find("statistics");
    int status = kinds_read_study(&study, STUDY, strlen(STUDY), NULL, &faults, err);
    if (!status)
        status = kind->runner_create(&runner, study->cases[0].parameters, 1, 0, err);
    if (!status)
        status = kind->run(runner, 0, 1, NULL, result, err);
    if (runner)
        kind->runner_destroy(&runner);
    fault_list_clear(&faults);
    study_destroy(&study);
    return status;
}

/* --- the bare writer --- */

struct bare {
    struct writer *writer;
    struct block_result block;
    struct claimed_job job;
    double *latencies;
    size_t count;
};

static int bare_claim(struct store *store, void *context, struct error *err) {
    struct bare *bare = context;
    struct claim claim = {.worker = "bench", .host = "bench", .count = 1};
    size_t found = 0;
    int status = store_claim(store, &claim, &bare->job, &found, err);
    return status ? status : found ? 0 : ERROR_ABSENT;
}

static int bare_complete(struct store *store, void *context, struct error *err) {
    struct bare *bare = context;
    bool first, done;
    bare->block.first = bare->job.first;
    return store_complete(store, bare->job.id, bare->job.token, &bare->block, &first, &done, err);
}

static void *bare_thread(void *context) {
    struct bare *bare = context;
    struct error err;
    double start = seconds();
    while (writer_do(bare->writer, bare_claim, bare, &err) == 0 &&
           writer_do(bare->writer, bare_complete, bare, &err) == 0) {
        claimed_job_clear(&bare->job);
        bare->latencies[bare->count++] = seconds() - start;
        start = seconds();
    }
    return NULL;
}

/* --- over HTTP --- */

struct remote {
    const char *url;
    const struct job_result *result;
    double *latencies;
    size_t count;
};

static int one_job(struct client *client, const struct remote *remote, struct error *err) {
    cJSON *answer = NULL;
    struct claimed_job job;
    size_t found = 0;
    struct request claim = {
        .method = "POST", .path = "/v1/jobs/claim", .body = "{\"worker\":\"bench\"}"};
    int status = client_json(client, &claim, &answer, err);
    if (!status && answer)
        status = wire_jobs_read(answer, &job, 1, &found, err);
    cJSON_Delete(answer);
    if (status || !found)
        return status ? status : ERROR_ABSENT;
    char path[64];
    snprintf(path, sizeof path, "/v1/jobs/%lld/complete", (long long)job.id);
    struct job_result result = *remote->result;
    result.first = job.first; /* the same realisation for each: the queue does not mind */
    cJSON *body = wire_result(job.token, kind_find("statistics")->scalars, &result);
    char *text = json_print(body);
    struct request complete = {.method = "POST", .path = path, .body = text};
    answer = NULL;
    status = client_json(client, &complete, &answer, err);
    cJSON_Delete(answer);
    cJSON_Delete(body);
    free(text);
    claimed_job_clear(&job);
    return status;
}

static void *remote_thread(void *context) {
    struct remote *remote = context;
    struct client *client = NULL;
    struct error err = {0};
    int status = client_create(&client, remote->url, NULL, &err);
    while (!status) {
        double start = seconds();
        status = one_job(client, remote, &err);
        if (!status)
            remote->latencies[remote->count++] = seconds() - start;
    }
    if (status != ERROR_ABSENT)
        fprintf(stderr, "bench_queue: %s\n", err.text);
    client_destroy(&client);
    return NULL;
}

static pid_t serve(char *url, size_t size) {
    const char *program = getenv("RUGO");
    pid_t pid = fork();
    if (pid == 0) {
        if (!freopen("serve.out", "w", stdout) || !freopen("/dev/null", "w", stderr))
            _exit(127);
        execl(program ? program : "build/rugo", "rugo", "serve", "--db", "http.db", "--listen",
              "127.0.0.1:0", (char *)NULL);
        _exit(127);
    }
    for (int tries = 0; tries < 500; tries++) {
        char line[128] = "";
        FILE *file = fopen("serve.out", "r");
        bool good =
            file && fgets(line, sizeof line, file) && sscanf(line, "listening on %95s", url) == 1;
        if (file)
            fclose(file);
        if (good)
            break;
        nanosleep(&(struct timespec){0, 10000000}, NULL);
    }
    (void)size;
    return pid;
}

/* Runs CLIENTS threads of one kind, gathers their latencies into the first. */
static double run_threads(void *(*body)(void *), void *contexts, size_t stride) {
    pthread_t threads[CLIENTS];
    double start = seconds();
    for (int c = 0; c < CLIENTS; c++)
        pthread_create(&threads[c], NULL, body, (char *)contexts + (size_t)c * stride);
    for (int c = 0; c < CLIENTS; c++)
        pthread_join(threads[c], NULL);
    return seconds() - start;
}

static int bench_bare(const struct job_result *result, double *latencies, struct error *err) {
    struct store *store = NULL;
    struct writer *writer = NULL;
    struct bare clients[CLIENTS];
    size_t total = 0;
    int status = submit("bare.db", err);
    if (!status)
        status = store_open(&store, "bare.db", NULL, err);
    if (!status)
        status = writer_create(&writer, store, err);
    if (status)
        return status;
    for (int c = 0; c < CLIENTS; c++)
        clients[c] = (struct bare){.writer = writer,
                                   .latencies = latencies + (size_t)c * JOBS,
                                   .block = {.first = 0,
                                             .count = 1,
                                             .scalar_count = result->scalar_count,
                                             .names = kind_find("statistics")->scalars,
                                             .scalars = result->scalars,
                                             .data = result->data,
                                             .size = result->size}};
    double elapsed = run_threads(bare_thread, clients, sizeof *clients);
    for (int c = 0; c < CLIENTS; c++) {
        memmove(latencies + total, clients[c].latencies, clients[c].count * sizeof *latencies);
        total += clients[c].count;
    }
    print_rate("bare writer thread, 8 clients", elapsed, latencies, total);
    writer_destroy(&writer);
    store_close(&store);
    return 0;
}

static int bench_http(const struct job_result *result, double *latencies, struct error *err) {
    char url[96] = "";
    struct remote clients[CLIENTS];
    size_t total = 0;
    int status = submit("http.db", err);
    if (status)
        return status;
    pid_t server = serve(url, sizeof url);
    for (int c = 0; c < CLIENTS; c++)
        clients[c] = (struct remote){url, result, latencies + (size_t)c * JOBS, 0};
    double elapsed = run_threads(remote_thread, clients, sizeof *clients);
    for (int c = 0; c < CLIENTS; c++) {
        memmove(latencies + total, clients[c].latencies, clients[c].count * sizeof *latencies);
        total += clients[c].count;
    }
    print_rate("over HTTP, 8 connections (clients included)", elapsed, latencies, total);
    kill(server, SIGTERM);
    waitpid(server, NULL, 0);
    return 0;
}

int main(void) {
    struct error err = {0};
    struct job_result result = {0};
    double *latencies = calloc((size_t)CLIENTS * JOBS, sizeof *latencies);
    int status = latencies ? client_global_init(&err) : ERROR_MEMORY;
    if (!status)
        status = compute(&result, &err);
    if (!status) {
        printf("%d jobs, claim and complete, a result of %zu bytes and %zu scalars\n", JOBS,
               result.size, result.scalar_count);
        probe_disk();
        status = bench_bare(&result, latencies, &err);
    }
    if (!status)
        status = bench_http(&result, latencies, &err);
    if (!status)
        probe_disk();
    else
        fprintf(stderr, "bench_queue: %s\n", err.text);
    job_result_clear(&result);
    free(latencies);
    return status ? 1 : 0;
}
