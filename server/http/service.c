#include "server/http/service.h"
#include "core/file/file.h"
#include "core/file/part_file.h"
#include "server/http/waiting_room.h"
#include "worker/checker.h"
#include "worker/clock.h"
#include <errno.h>
#include <glob.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* --- copies of the store that are being sent, and what is left of them --- */

int service_snapshot_path(const struct service *service, char path[SNAPSHOT_PATH_SIZE],
                          struct error *err) {
    if (snprintf(path, SNAPSHOT_PATH_SIZE, "%s.snapshot", service->database) < SNAPSHOT_PATH_SIZE)
        return 0;
    return error_set(err, ERROR_INPUT, "the path %.100s... is too long", service->database);
}

/* Earlier versions of the program named them DATABASE.snapshot-PROCESS-ADDRESS, and held no lock.
 */
static void remove_older(const char *path) {
    glob_t found;
    char *pattern = file_pattern(path, "-[0-9]*-0x*");
    int failure = pattern != NULL ? glob(pattern, GLOB_NOSORT, NULL, &found) : GLOB_NOSPACE;
    free(pattern);
    if (failure != 0)
        return;
    for (size_t n = 0; n < found.gl_pathc; n++) {
        long process = strtol(found.gl_pathv[n] + strlen(path) + 1, NULL, 10);
        if (process > 0 && kill((pid_t)process, 0) != 0 && errno == ESRCH)
            (void)unlink(found.gl_pathv[n]);
    }
    globfree(&found);
}

/* Takes away the copies that a server left which was killed while it made them. */
static void service_remove_left(const struct service *service) {
    char path[SNAPSHOT_PATH_SIZE];
    if (service_snapshot_path(service, path, NULL) != 0)
        return;
    part_file_remove_left(path);
    remove_older(path);
}

static void wake_claims(void *room) {
    waiting_room_wake(room);
}

static void wake_publisher(void *publisher) {
    publisher_wake(publisher);
}

int service_open(struct service *service, const char *database, int64_t lease_ms,
                 struct error *err) {
    struct store_options options = {.lease_ms = lease_ms};
    service->database = database;
    service->started_ms = clock_ms();
    service->lease_ms = lease_ms;
    pthread_mutex_init(&service->mutex, NULL);
    int status = store_open(&service->store, database, &options, err);
    if (status == 0)
        status = writer_create(&service->writer, service->store, err);
    if (status == 0)
        status = publisher_create(&service->publisher, database, err);
    if (status == 0)
        writer_on_due(service->writer, wake_publisher, service->publisher);
    if (status == 0)
        status = checker_create(&service->checker, err);
    if (status == 0)
        status = waiting_room_create(&service->room, database, err);
    if (status == 0)
        writer_on_change(service->writer, wake_claims, service->room);
    if (status == 0)
        service_remove_left(service);
    return status;
}

void service_close(struct service *service) {
    writer_destroy(&service->writer); /* wakes the publisher */
    waiting_room_destroy(&service->room);
    publisher_destroy(&service->publisher);
    for (size_t r = 0; r < service->reader_count; r++)
        store_close(&service->readers[r]);
    store_close(&service->store); /* last: a reader cannot clear the write-ahead log away */
    checker_destroy(&service->checker);
    tokens_destroy(&service->tokens);
    pthread_mutex_destroy(&service->mutex);
}

int service_reader(struct service *service, struct store **out, struct error *err) {
    *out = NULL;
    int status = store_check_names(service->store, err);
    if (status != 0)
        return status;
    pthread_mutex_lock(&service->mutex);
    if (service->reader_count != 0)
        *out = service->readers[--service->reader_count];
    pthread_mutex_unlock(&service->mutex);
    struct store_options options = {.read_only = true};
    return *out != NULL ? 0 : store_open(out, service->database, &options, err);
}

int service_reader_until(struct service *service, int (*stop)(void *context), void *context,
                         struct store **out, struct error *err) {
    int status = service_reader(service, out, err);
    if (status == 0)
        store_set_stop(*out, stop, context);
    return status;
}

void service_give_back(struct service *service, struct store *reader) {
    struct due_case damaged;
    if (reader == NULL)
        return;
    store_set_stop(reader, NULL, NULL);
    if (store_found_damage(reader, &damaged))
        publisher_mend(service->publisher, &damaged);
    pthread_mutex_lock(&service->mutex);
    if (service->reader_count < READERS_KEPT) {
        service->readers[service->reader_count++] = reader;
        reader = NULL;
    }
    pthread_mutex_unlock(&service->mutex);
    store_close(&reader);
}
