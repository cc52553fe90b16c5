#include "server/http/health.h"
#include "server/http/service.h"
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
        return 0; /* the file is gone, which is told */
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
    if (status == 0)
        status = store_is_due(reader, &due, err);
    service_give_back(service, reader);
    return status;
}

void service_health(struct service *service, struct health *out) {
    *out = (struct health){0};
    int place = service_check_file(service, next_reason(out));
    count_reason(out, place);
    count_reason(out, check_room(service, next_reason(out)));
    count_reason(out, check_writer(service, next_reason(out)));
    if (place == 0) /* of another file nothing is read */
        count_reason(out, check_reader(service, next_reason(out)));
}
