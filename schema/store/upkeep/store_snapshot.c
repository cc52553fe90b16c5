/* Copies of the store, by SQLite's online backup.
 *
 * One read transaction is held over all steps. Without it every change by another connection would
 * restart the copy, and on a busy store it would not end. Writers go on meanwhile; what they write
 * stays in the write-ahead log until the copy has ended. */
#include "core/file/part_file.h"
#include "schema/store/store_internal.h"
#include <errno.h>
#include <string.h>
#include <unistd.h>

enum { STEP_PAGES = 1024 /* 4 MiB between two calls of stop */ };

static int copy_error(const struct store *store, sqlite3 *copy, const char *path, int code,
                      struct error *err) {
    int reason = errno;
    bool said = copy != NULL && sqlite3_errcode(copy) == code;
    if (said && (code & 0xff) == SQLITE_IOERR) {
        disk_error(reason, path, sqlite3_errmsg(copy), err);
        return error_context(err, "copying %s", store->path);
    }
    return error_set(err, code == SQLITE_NOMEM ? ERROR_MEMORY : ERROR_SYSTEM,
                     "copying %s to %s: %s", store->path, path,
                     said ? sqlite3_errmsg(copy) : sqlite3_errstr(code));
}

static int copy_pages(struct store *store, sqlite3 *copy, const char *path,
                      bool (*stop)(void *context), void *context, struct error *err) {
    sqlite3_backup *backup = sqlite3_backup_init(copy, "main", store->db, "main");
    if (backup == NULL)
        return copy_error(store, copy, path, sqlite3_errcode(copy), err);
    int code = SQLITE_OK;
    bool stopped = false;
    while (code == SQLITE_OK && !stopped) {
        stopped = stop != NULL && stop(context);
        if (!stopped)
            code = sqlite3_backup_step(backup, STEP_PAGES);
    }
    int end = sqlite3_backup_finish(backup);
    if (stopped)
        return error_set(err, ERROR_STOPPED, "copying %s: stopped", store->path);
    if (code == SQLITE_DONE)
        code = end;
    return code != SQLITE_OK ? copy_error(store, copy, path, code, err) : 0;
}

/* Opens the copy without a journal, as an incomplete copy is not kept. Whoever made its file brings
 * it to the disk once. */
static int copy_open(sqlite3 **copy, const struct store *store, const char *path,
                     struct error *err) {
    int code = sqlite3_open_v2(
        path, copy, SQLITE_OPEN_READWRITE | SQLITE_OPEN_NOMUTEX | SQLITE_OPEN_EXRESCODE, NULL);
    if (code == SQLITE_OK)
        code = sqlite3_exec(*copy, "PRAGMA journal_mode = OFF; PRAGMA synchronous = OFF", NULL,
                            NULL, NULL);
    return code != SQLITE_OK ? copy_error(store, *copy, path, code, err) : 0;
}

int store_copy(struct store *store, const struct part_file *part, bool (*stop)(void *context),
               void *context, struct error *err) {
    sqlite3 *copy = NULL;
    int status = read_begin(store, err);
    if (status != 0)
        return status;
    status = copy_open(&copy, store, part->path, err);
    if (status == 0)
        status = copy_pages(store, copy, part->path, stop, context, err);
    sqlite3_close(copy);
    read_end(store);
    return status != 0 ? status : file_ask_for_no_log(part->file, part->path, err);
}

int store_snapshot(struct store *store, const char *path, bool (*stop)(void *context),
                   void *context, struct error *err) {
    struct part_file part;
    int status = part_file_create(&part, path, err);
    if (status == 0)
        status = store_copy(store, &part, stop, context, err);
    if (status == 0)
        status = part_file_publish(&part, err);
    part_file_destroy(&part);
    return status;
}
