/* A cluster: 1000 workers, each with its connection, at one server, with jobs of about 5 s; they
 * claim, send heartbeats and hand in real results, but compute nothing. All are simulated by one
 * thread, whose own delays count as the server's. Printed: the processor time of the server, how
 * long claims take, and heartbeats whose answer comes a second late or reports a lost lease. */
#include "tests/support/http_load.h"
#include "tests/support/queue_load.h"
#include <errno.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>

enum { WORKERS = 1000, JOBS = 100000, ANSWER = 16 << 10, REQUEST = 32 << 10 };
static const double JOB_SECONDS = 5, BEAT_SECONDS = 5, RAMP_SECONDS = 6, SECONDS = 20;

enum stage { REST, CLAIM, WORK, BEAT, REPORT };
struct simulated {
    enum stage stage;
    double until, beat, sent; /* end of the rest or job; next heartbeat; last request */
    long long job, first;
    char token[33];
    size_t have;
    char answer[ANSWER];
};
struct figures {
    double claims[JOBS];
    size_t claim_count, jobs, beats, late, lost, empty;
    bool counting;
};
struct cluster {
    struct simulated workers[WORKERS];
    struct pollfd peers[WORKERS];
    struct figures figures;
    const char *body; /* of a result, without its opening brace, token and first */
};

static bool send_to(struct cluster *cluster, size_t w, enum stage stage, const char *path,
                    const char *body) {
    static char request[REQUEST];
    struct simulated *worker = &cluster->workers[w];
    int size = snprintf(request, sizeof request,
                        "POST %s HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Type: application/json\r\n"
                        "Content-Length: %zu\r\n\r\n%s",
                        path, strlen(body), body);
    worker->stage = stage;
    worker->sent = seconds();
    worker->have = 0;
    return send(cluster->peers[w].fd, request, (size_t)size, MSG_NOSIGNAL) == size;
}

static bool claim(struct cluster *cluster, size_t w) {
    char body[128];
    snprintf(body, sizeof body, "{\"worker\":\"w%zu\",\"sequence\":true,\"count\":1,\"threads\":1}",
             w);
    return send_to(cluster, w, CLAIM, "/v1/jobs/claim", body);
}

static bool beat(struct cluster *cluster, size_t w) {
    char body[192];
    const struct simulated *worker = &cluster->workers[w];
    snprintf(body, sizeof body,
             "{\"reports\":[{\"verb\":\"heartbeat\",\"job\":%lld,\"token\":\"%s\",\"done\":0}]}",
             worker->job, worker->token);
    return send_to(cluster, w, BEAT, "/v1/jobs/report", body);
}

static bool report(struct cluster *cluster, size_t w) {
    static char body[REQUEST];
    const struct simulated *worker = &cluster->workers[w];
    snprintf(
        body, sizeof body,
        "{\"reports\":[{\"verb\":\"complete\",\"job\":%lld,\"token\":\"%s\",\"first\":%lld,%s]}",
        worker->job, worker->token, worker->first, cluster->body);
    return send_to(cluster, w, REPORT, "/v1/jobs/report", body);
}

/* A job, or none: then the worker rests for a second. */
static void begin_job(struct cluster *cluster, struct simulated *worker, int status, double now) {
    struct figures *figures = &cluster->figures;
    if (figures->counting && figures->claim_count < JOBS)
        figures->claims[figures->claim_count++] = now - worker->sent;
    if (status != 200) {
        figures->empty += figures->counting;
        worker->stage = REST;
        worker->until = now + 1;
        return;
    }
    worker->stage = WORK;
    worker->job = atoll(load_behind(worker->answer, "\"id\":"));
    worker->first = atoll(load_behind(worker->answer, "\"first\":"));
    snprintf(worker->token, sizeof worker->token, "%.32s",
             load_behind(worker->answer, "\"token\":\""));
    worker->until = now + JOB_SECONDS * (0.7 + 0.006 * (double)(worker->job * 37 % 100));
    worker->beat = now + BEAT_SECONDS;
}

/* A whole answer has come. */
static bool take_answer(struct cluster *cluster, size_t w) {
    struct simulated *worker = &cluster->workers[w];
    struct figures *figures = &cluster->figures;
    double now = seconds();
    bool refused = strstr(worker->answer, "\"detail\"") != NULL;
    switch (worker->stage) {
    case CLAIM:
        begin_job(cluster, worker, atoi(worker->answer + 9), now);
        return true;
    case BEAT:
        figures->beats += figures->counting;
        figures->late += figures->counting && now - worker->beat > 1;
        figures->lost += refused;
        worker->beat = now + BEAT_SECONDS;
        worker->stage = WORK;
        return true;
    default:
        figures->jobs += figures->counting;
        figures->lost += refused;
        return claim(cluster, w);
    }
}

static bool read_from(struct cluster *cluster, size_t w) {
    struct simulated *worker = &cluster->workers[w];
    ssize_t got = recv(cluster->peers[w].fd, worker->answer + worker->have,
                       ANSWER - 1 - worker->have, MSG_DONTWAIT);
    if (got <= 0)
        return got < 0 && (errno == EAGAIN || errno == EINTR);
    worker->have += (size_t)got;
    worker->answer[worker->have] = '\0';
    const char *end = strstr(worker->answer, "\r\n\r\n");
    const char *length = strstr(worker->answer, "Content-Length: ");
    size_t wanted = length != NULL ? strtoul(length + 16, NULL, 10) : 0;
    if (end == NULL || (size_t)(end + 4 - worker->answer) + wanted > worker->have)
        return true;
    return take_answer(cluster, w);
}

/* What is due by time. */
static bool go_on(struct cluster *cluster, size_t w, double now) {
    const struct simulated *worker = &cluster->workers[w];
    if (worker->stage == REST && now >= worker->until)
        return claim(cluster, w);
    if (worker->stage == WORK && now >= worker->until)
        return report(cluster, w);
    if (worker->stage == WORK && now >= worker->beat)
        return beat(cluster, w);
    return true;
}

static bool run_until(struct cluster *cluster, double until) {
    for (double now = seconds(); now < until; now = seconds()) {
        if (poll(cluster->peers, WORKERS, 2) < 0)
            return false;
        for (size_t w = 0; w < WORKERS; w++)
            if ((cluster->peers[w].revents != 0 && !read_from(cluster, w)) ||
                !go_on(cluster, w, seconds()))
                return false;
    }
    return true;
}

/* Seconds of processor time of a process so far. */
static double cpu_seconds(pid_t pid) {
    char path[64], text[1024] = "";
    unsigned long user = 0, kernel = 0;
    snprintf(path, sizeof path, "/proc/%ld/stat", (long)pid);
    FILE *file = fopen(path, "r");
    const char *at =
        file != NULL && fgets(text, sizeof text, file) != NULL ? strrchr(text, ')') : NULL;
    if (at != NULL)
        (void)sscanf(at + 2, "%*c %*d %*d %*d %*d %*d %*u %*u %*u %*u %*u %lu %lu", &user, &kernel);
    if (file != NULL)
        fclose(file);
    return (double)(user + kernel) / (double)sysconf(_SC_CLK_TCK);
}

static bool bench(struct cluster *cluster, uint16_t port, pid_t server) {
    double start = seconds();
    for (size_t w = 0; w < WORKERS; w++) {
        cluster->peers[w] = (struct pollfd){.fd = load_connect(port), .events = POLLIN};
        cluster->workers[w].until = start + RAMP_SECONDS * (double)w / WORKERS;
        if (cluster->peers[w].fd < 0)
            return false;
    }
    if (!run_until(cluster, start + RAMP_SECONDS + 2))
        return false;
    cluster->figures.counting = true;
    double cpu = cpu_seconds(server), from = seconds(), own = (double)clock() / CLOCKS_PER_SEC;
    bool good = run_until(cluster, from + SECONDS);
    double elapsed = seconds() - from;
    struct figures *figures = &cluster->figures;
    print_rate("claims of 1000 workers", elapsed, figures->claims, figures->claim_count);
    printf(
        "jobs handed in %zu, heartbeats %zu: late %zu, leases lost %zu; claims without a job %zu\n",
        figures->jobs, figures->beats, figures->late, figures->lost, figures->empty);
    printf("its server took %.2f processors; the simulation %.2f\n",
           (cpu_seconds(server) - cpu) / elapsed,
           ((double)clock() / CLOCKS_PER_SEC - own) / elapsed);
    return good;
}

int main(void) {
    struct error err = {0};
    struct block_result result = {0};
    struct cluster *cluster = calloc(1, sizeof *cluster);
    pid_t server = 0;
    int status = cluster != NULL ? queue_compute(&result, &err) : ERROR_MEMORY;
    char *body = status == 0 ? load_body(&result) : NULL;
    if (status == 0)
        status = queue_create("cluster.db", JOBS, &err);
    if (status == 0 && body != NULL) {
        cluster->body = body;
        uint16_t port = load_serve("cluster.db", &server);
        status = bench(cluster, port, server) ? 0 : ERROR_SYSTEM;
        kill(server, SIGTERM);
        waitpid(server, NULL, 0);
    }
    if (status != 0)
        fprintf(stderr, "bench_cluster: %s\n", err.code != 0 ? err.text : "the server hung up");
    free(body);
    block_result_clear(&result);
    free(cluster);
    return status != 0;
}
