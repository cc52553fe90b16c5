/* Health, metrics, snapshot, and the schema of studies. */
#include "core/file/part_file.h"
#include "jobs/kind.h"
#include "schema/json/field.h"
#include "server/http/health.h"
#include "server/http/route/route.h"
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

void handle_schema(struct exchange *exchange, const char *id) {
    (void)id;
    cJSON *schema = study_schema(JOB_KINDS);
    char *text = schema != NULL ? json_print_pretty(schema) : NULL;
    cJSON_Delete(schema);
    answer_text(exchange, 200, "application/json", text);
}

/* Adds what is wrong; false out of memory. */
static bool add_reasons(cJSON *document, const struct health *health) {
    cJSON *reasons = cJSON_AddArrayToObject(document, "reasons");
    for (size_t r = 0; r < health->count && reasons != NULL; r++) {
        char text[sizeof health->reasons[r].text];
        snprintf(text, sizeof text, "%s", health->reasons[r].text);
        answer_mend(text);
        if (!list_put(reasons, cJSON_CreateString(text)))
            return false;
    }
    return reasons != NULL;
}

void handle_health(struct exchange *exchange, const char *id) {
    (void)id;
    struct health health;
    service_health(exchange->service, &health);
    cJSON *document = cJSON_CreateObject();
    if (document != NULL)
        cJSON_AddStringToObject(document, "status", health.count == 0 ? "ok" : "failing");
    if (document != NULL && health.count > 0 && !add_reasons(document, &health)) {
        cJSON_Delete(document);
        document = NULL;
    }
    answer_json(exchange, health.count == 0 ? 200 : 503, document);
    answer_header(exchange, "Cache-Control", "no-store");
}

void handle_metrics(struct exchange *exchange, const char *id) {
    (void)id;
    struct error err = {0};
    char *text;
    if (service_metrics(exchange->service, &text, &err) != 0)
        answer_error(exchange, &err);
    else
        answer_text(exchange, 200, "text/plain; version=0.0.4; charset=utf-8", text);
}

/* --- snapshot --- */

enum { SNAPSHOTS_MOST = 4 }; /* at a time: each is a copy of the whole database */

/* A copy of the database is sent from this, part by part. */
struct download {
    struct exchange *exchange; /* lives as long as the library calls read_download */
    struct service *service;
    int file; /* -1 until opened */
};

static ssize_t read_download(void *context, uint64_t position, char *buffer, size_t room) {
    struct download *download = context;
    ssize_t got = pread(download->file, buffer, room, (off_t)position);
    exchange_renew(download->exchange); /* who takes nothing for a whole deadline is cut */
    return got > 0 ? got : MHD_CONTENT_READER_END_WITH_ERROR;
}

static void download_free(void *context) {
    struct download *download = context;
    atomic_fetch_sub(&download->service->snapshots, 1);
    if (download->file >= 0)
        close(download->file);
    free(download);
}

static bool is_lost(void *context) {
    return exchange_is_lost(context) != 0;
}

/* Copies beside the database, where there is room of the same kind, and keeps the copy open without
 * a name: it is gone with the connection, whatever ends it. */
static int snapshot_file(struct download *download, uint64_t *size, struct error *err) {
    struct service *service = download->service;
    struct store *reader;
    struct part_file part = {0};
    struct stat info;
    char path[SNAPSHOT_PATH_SIZE];
    int status = service_snapshot_path(service, path, err);
    if (status == 0)
        status = service_reader(service, &reader, err);
    if (status != 0)
        return status;
    status = part_file_create(&part, path, err);
    if (status == 0)
        status = store_copy(reader, &part, is_lost, download->exchange, err);
    service_give_back(service, reader);
    if (status == 0 && ((download->file = fcntl(part.file, F_DUPFD_CLOEXEC, 0)) < 0 ||
                        fstat(download->file, &info) != 0))
        status = error_set(err, ERROR_SYSTEM, "the snapshot cannot be read: %s", strerror(errno));
    part_file_destroy(&part);
    if (status == 0)
        *size = (uint64_t)info.st_size;
    return status;
}

void handle_snapshot(struct exchange *exchange, const char *id) {
    (void)id;
    struct error err = {0};
    uint64_t size;
    struct download *download = array_create(1, sizeof *download);
    if (download == NULL) {
        answer_problem(exchange, 503, "no memory for a snapshot", NULL);
        return;
    }
    *download = (struct download){exchange, exchange->service, -1};
    if (atomic_fetch_add(&exchange->service->snapshots, 1) >= SNAPSHOTS_MOST) {
        download_free(download);
        answer_problem(exchange, 503, "too many snapshots are being sent", NULL);
    } else if (snapshot_file(download, &size, &err) != 0) {
        download_free(download);
        answer_error(exchange, &err);
    } else {
        answer_stream(exchange, "application/vnd.sqlite3", size, read_download, download,
                      download_free);
        answer_header(exchange, "Content-Disposition", "attachment; filename=\"rugo.db\"");
    }
}
