/* Deletion: a study disappears at once; its rows and their pages are freed in small parts. */
#include "schema/store/store_internal.h"
#include <time.h>

/* A file smaller than this is rewritten as a whole, once: see shrink_whole. */
static const int64_t WHOLE_BYTES = 268435456;

/* Refuses a study whose jobs may run. */
static int check_ended(struct store *store, int64_t study, const char *id, struct error *err) {
    int64_t open = 0;
    int status =
        store_integer(store, &open, err,
                      "SELECT state IN ('queued', 'running') FROM study WHERE id = ?", "i", study);
    if (status == 0 && open != 0)
        return error_set(err, ERROR_STATE, "study %s has not ended: cancel it first", id);
    return status;
}

/* Frees its name and key, and makes nothing of it due. */
static int bury(struct store *store, int64_t study, struct error *err) {
    int status = store_run(store, err,
                           "INSERT INTO deleted_study (id, public, deleted) SELECT id, public, ? "
                           "FROM study WHERE id = ?",
                           "ti", store_time(store), study);
    if (status == 0)
        status = store_run(store, err,
                           "UPDATE study SET public = 'deleted ' || hex(randomblob(16)), name = "
                           "'', submit_key = NULL, digest = NULL WHERE id = ?",
                           "i", study);
    if (status == 0)
        status = store_run(store, err,
                           "UPDATE study_case SET settled = revision WHERE study_id = ? AND "
                           "settled < revision",
                           "i", study);
    return status;
}

int store_delete(struct store *store, const char *id, struct error *err) {
    int64_t row = 0;
    int status = change_begin(store, err);
    if (status != 0)
        return status;
    status = study_row(store, id, &row, err);
    if (status == 0)
        status = check_ended(store, row, id, err);
    if (status == 0)
        status = bury(store, row, err);
    return change_end(store, status, err);
}

/* --- rows --- */

/* Each deletes a part in some milliseconds, with the rows that refer to it. */
static const char *const PARTS[] = {
    "DELETE FROM curve WHERE id IN (SELECT id FROM curve WHERE study_id = ?1 LIMIT 8)",
    "DELETE FROM job WHERE id IN (SELECT id FROM job WHERE study_id = ?1 LIMIT 32)",
    "DELETE FROM published WHERE rowid IN (SELECT rowid FROM published WHERE study_id = ?1 LIMIT "
    "32)",
    "DELETE FROM scalar WHERE study_id = ?1 AND case_number IN (SELECT case_number FROM scalar "
    "WHERE study_id = ?1 LIMIT 1000)",
    "DELETE FROM scalar_error WHERE study_id = ?1 AND case_number IN (SELECT case_number FROM "
    "scalar_error WHERE study_id = ?1 LIMIT 1000)",
    "DELETE FROM study_case WHERE study_id = ?1 AND number IN (SELECT number FROM study_case WHERE "
    "study_id = ?1 LIMIT 500)",
    "DELETE FROM study WHERE id = ?1"};
enum { PART_COUNT = sizeof PARTS / sizeof *PARTS };

static int delete_part(struct store *store, int64_t study, struct error *err) {
    int status = 0;
    for (size_t p = 0; status == 0 && p < PART_COUNT; p++) {
        status = store_run(store, err, PARTS[p], "i", study);
        if (status == 0 && sqlite3_changes(store->db) > 0)
            return 0;
    }
    if (status == 0)
        status =
            store_run(store, err, "UPDATE deleted_study SET purged = 1 WHERE id = ?", "i", study);
    store->shrinks = store->shrinks || status == 0;
    return status;
}

/* Deletes a part of a study; *left is false where none was to be deleted. */
static int purge_rows(struct store *store, bool *left, struct error *err) {
    int64_t study = 0;
    int status =
        store_integer(store, &study, err,
                      "SELECT id FROM deleted_study WHERE purged = 0 ORDER BY id LIMIT 1", "");
    *left = status == 0;
    if (status != 0)
        return status == ERROR_ABSENT ? 0 : status;
    status = change_begin(store, err);
    if (status != 0)
        return status;
    return change_end(store, delete_part(store, study, err), err);
}

/* --- pages --- */

/* A store of an older program cannot free single pages until it is rewritten as a whole. As that
 * blocks others, a large store is left as it is: its free pages are used again. */
static int shrink_whole(struct store *store, struct error *err) {
    int64_t pages = 0, size = 0;
    int status = store_integer(store, &pages, err, "PRAGMA page_count", "");
    if (status == 0)
        status = store_integer(store, &size, err, "PRAGMA page_size", "");
    if (status != 0 || pages * size > WHOLE_BYTES)
        return status;
    return store_execute(store, "VACUUM", err);
}

/* Frees some pages; *left: there are more. */
static int give_pages(struct store *store, int64_t unused, bool *left, struct error *err) {
    int64_t rest = 0;
    int status = store_execute(store, "PRAGMA incremental_vacuum(512)", err);
    if (status == 0)
        status = store_integer(store, &rest, err, "PRAGMA freelist_count", "");
    *left = status == 0 && rest > 0 && rest < unused;
    return status;
}

static int purge_pages(struct store *store, bool *left, struct error *err) {
    int64_t unused = 0, mode = 0;
    *left = false;
    if (!store->shrinks)
        return 0;
    int status = store_integer(store, &unused, err, "PRAGMA freelist_count", "");
    if (status == 0)
        status = store_integer(store, &mode, err, "PRAGMA auto_vacuum", "");
    if (status != 0 || unused == 0)
        return status;
    return mode == 2 ? give_pages(store, unused, left, err) : shrink_whole(store, err);
}

int store_purge(struct store *store, bool (*stop)(void *context), void *context,
                struct error *err) {
    const struct timespec pause = {0, 2000000}; /* others wait for a part of that */
    for (bool left = true; left;) {
        if (stop != NULL && stop(context))
            return error_set(err, ERROR_STOPPED, "stopped");
        int status = purge_rows(store, &left, err);
        if (status == 0 && !left)
            status = purge_pages(store, &left, err);
        if (status != 0)
            return error_context(err, "what is deleted");
        if (left)
            nanosleep(&pause, NULL);
    }
    store->shrinks = false;
    return 0;
}
