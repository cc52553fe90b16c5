/* Whether a service can do its work, and its figures as Prometheus reads them. */
#include "server/http/health.h"
#include "core/file/memory_file.h"
#include "server/http/service.h"
#include "worker/clock.h"
#include <inttypes.h>
#include <stdio.h>
#include <sys/statvfs.h>

/* The write-ahead log of a busy server, and the checkpoint after it, want some room. */
static const double ROOM_BYTES = 16 << 20;
enum { WRITER_SLOW_MS = 10000 }; /* a commit takes milliseconds, of a long study seconds */

static struct error *next_reason(struct health *health) {
    return &health->reasons[health->count];
}

/* A reason that was written counts. */
static void count_reason(struct health *health, int status) {
    health->count += status != 0;
}

static int check_room(const struct service *service, struct error *err) {
    struct statvfs disk;
    if (statvfs(service->database, &disk) != 0)
        return 0; /* the file is gone, which is reported */
    double room = (double)disk.f_bavail * (double)disk.f_frsize;
    if ((disk.f_flag & ST_RDONLY) != 0)
        return error_set(err, ERROR_SYSTEM, "the disk of database %s is read-only",
                         service->database);
    return room >= ROOM_BYTES
               ? 0
               : error_set(err, ERROR_SYSTEM, "the disk of database %s is full: %.1f MB are free",
                           service->database, 1e-6 * room);
}

static int check_writer(const struct service *service, struct error *err) {
    struct writer_state state;
    writer_state(service->writer, &state);
    if (state.busy_ms > WRITER_SLOW_MS)
        return error_set(err, ERROR_SYSTEM, "the writer has been at one commit for %lld s",
                         (long long)(state.busy_ms / 1000));
    if (state.failure.code == 0)
        return 0;
    return error_set(err, ERROR_SYSTEM, "the last commit failed: %.400s", state.failure.text);
}

static int check_reader(struct service *service, struct error *err) {
    struct store *reader;
    bool due;
    int status = service_reader(service, &reader, err);
    int size = store_check_size(reader, service->store, err);
    if (status == 0)
        status = size;
    if (status == 0)
        status = store_is_due(reader, &due, err);
    service_give_back(service, reader);
    return status;
}

void service_health(struct service *service, struct health *out) {
    *out = (struct health){0};
    int place = store_check_names(service->store, next_reason(out));
    count_reason(out, place);
    count_reason(out, check_room(service, next_reason(out)));
    count_reason(out, check_writer(service, next_reason(out)));
    if (place == 0) /* of another file nothing is read */
        count_reason(out, check_reader(service, next_reason(out)));
}

/* --- figures --- */

static void print_metric(FILE *file, const char *name, const char *type, const char *help,
                         double value) {
    fprintf(file, "# HELP rugo_%s %s\n# TYPE rugo_%s %s\nrugo_%s %.17g\n", name, help, name, type,
            name, value);
}

static void print_queue(FILE *file, const struct store_metrics *metrics) {
    const struct {
        const char *state;
        uint64_t count;
    } states[] = {{"waiting", metrics->jobs_waiting},
                  {"running", metrics->jobs_running},
                  {"done", metrics->jobs_done},
                  {"failed", metrics->jobs_failed},
                  {"cancelled", metrics->jobs_cancelled}};
    fprintf(file, "# HELP rugo_jobs Jobs by state.\n# TYPE rugo_jobs gauge\n");
    for (size_t s = 0; s < sizeof states / sizeof *states; s++)
        fprintf(file, "rugo_jobs{state=\"%s\"} %" PRIu64 "\n", states[s].state, states[s].count);
}

static void print_store(FILE *file, const struct store_metrics *metrics) {
    print_metric(file, "studies", "gauge", "Studies in the store.", (double)metrics->studies);
    print_queue(file, metrics);
    print_metric(file, "wal_bytes", "gauge", "Size of the write-ahead log.",
                 (double)metrics->wal_bytes);
    print_metric(file, "database_bytes", "gauge", "Size of the database file.",
                 (double)metrics->database_bytes);
}

int service_metrics(struct service *service, char **out, struct error *err) {
    struct store *reader;
    struct store_metrics metrics;
    struct writer_figures writer;
    struct memory_file memory;
    struct health health;
    service_health(service, &health);
    int status = service_reader(service, &reader, err);
    if (status == 0)
        status = store_metrics(reader, &metrics, err);
    service_give_back(service, reader);
    if (status != 0 && health.count == 0)
        return status;
    if (!memory_file_open(&memory))
        return error_memory(err, 4096, "metrics");
    FILE *file = memory.file;
    writer_figures(service->writer, &writer);
    fprintf(file, "# HELP rugo_http_answers_total Answers by class of status.\n"
                  "# TYPE rugo_http_answers_total counter\n");
    for (int c = 1; c < STATUS_CLASSES; c++)
        fprintf(file, "rugo_http_answers_total{status=\"%dxx\"} %" PRIuFAST64 "\n", c,
                atomic_load(&service->answers[c]));
    print_metric(file, "http_seconds_total", "counter", "Seconds spent on answers.",
                 1e-9 * (double)atomic_load(&service->nanoseconds));
    print_metric(file, "http_connections", "gauge", "Open connections.",
                 (double)atomic_load(&service->connections));
    print_metric(file, "http_connections_crowded_out_total", "counter",
                 "Connections closed or refused for want of room.",
                 (double)atomic_load(&service->crowded_out));
    print_metric(file, "event_streams", "gauge", "Open streams of events.",
                 (double)atomic_load(&service->streams));
    print_metric(file, "healthy", "gauge", "1 while /healthz says ok, else 0.",
                 health.count == 0 ? 1 : 0);
    if (status == 0)
        print_store(file, &metrics);
    print_metric(file, "changes_total", "counter", "Changes of the store.", (double)writer.changes);
    print_metric(file, "commits_total", "counter",
                 "Commits; changes over commits is the batch size.", (double)writer.commits);
    print_metric(file, "uptime_seconds", "gauge", "Seconds since the start.",
                 1e-3 * (double)(clock_ms() - service->started_ms));
    char *text = memory_file_close(&memory, NULL);
    if (text == NULL)
        return error_memory(err, 4096, "metrics");
    *out = text;
    return 0;
}
