/* What is due: cases whose jobs have ended and whose results are neither published nor marked as
 * impossible to publish. The condition is that of the index case_due, word for word. */
#include "schema/store/store_internal.h"
#include <stdio.h>
#include <stdlib.h>

#define DUE "jobs_left = 0 AND revision > settled"

/* The position of find_due, and the case that is due there. */
struct cursor {
    int64_t study;
    struct due_case due;
};

/* Finds the next case due behind the cursor. Returns 1, or 0 for none. */
static int find_due(struct store *store, struct cursor *cursor, struct error *err) {
    sqlite3_stmt *row = NULL;
    int status =
        store_query(store, &row, err,
                    "SELECT study_id, number, revision, (SELECT public FROM study WHERE id = "
                    "study_id) FROM study_case INDEXED BY case_due WHERE " DUE
                    " AND (study_id, number) > (?, ?) ORDER BY study_id, number LIMIT 1",
                    "ii", cursor->study, (int64_t)cursor->due.case_number);
    if (status == 0)
        status = store_step(store, row, err);
    if (status <= 0)
        return status;
    struct due_case *due = &cursor->due;
    cursor->study = sqlite3_column_int64(row, 0);
    due->case_number = (uint64_t)sqlite3_column_int64(row, 1);
    due->revision = (uint64_t)sqlite3_column_int64(row, 2);
    snprintf(due->study, sizeof due->study, "%s", (const char *)sqlite3_column_text(row, 3));
    sqlite3_reset(row);
    return 1;
}

int store_is_due(struct store *store, bool *due, struct error *err) {
    int64_t found = 0;
    int status = store_integer(
        store, &found, err,
        "SELECT EXISTS (SELECT 1 FROM study_case INDEXED BY case_due WHERE " DUE ")", "");
    if (status == 0)
        *due = found != 0;
    return status;
}

static int mark(struct store *store, int64_t study, const struct due_case *due, const char *reason,
                struct error *err) {
    int status =
        store_run(store, err,
                  "UPDATE study_case SET settled = revision, publish_error = ? WHERE "
                  "study_id = ? AND number = ? AND revision = ? AND " DUE,
                  "tiii", reason, study, (int64_t)due->case_number, (int64_t)due->revision);
    if (status != 0 || sqlite3_changes(store->db) == 0)
        return status;
    status = store_run(store, err, "UPDATE study SET cases_failed = cases_failed + 1 WHERE id = ?",
                       "i", study);
    return status != 0 ? status : study_settle(store, study, err);
}

/* Marks a case that cannot be published: it is no longer due, and its study fails once it ends.
 * Does nothing where the case is not due at this revision. */
static int fail_publication(struct store *store, const struct due_case *due, const char *reason,
                            struct error *err) {
    int64_t study = 0;
    int status = change_begin(store, err);
    if (status != 0)
        return status;
    status = study_row(store, due->study, &study, err);
    if (status == 0)
        status = mark(store, study, due, reason, err);
    return change_end(store, status, err);
}

enum { GROUP_MS = 20 }; /* of preparation, beyond which no further one is begun */

struct offered {
    struct due_case due;
    int status; /* of its preparation, then of its publication */
    struct error reason;
};

/* Finds and prepares the next cases. A publication that prepares nothing has them one by one. */
static int gather(struct store *store, const struct publication *publication, struct cursor *cursor,
                  struct offered *group, size_t *count, struct error *err) {
    const size_t most = publication->prepare != NULL ? PUBLICATION_GROUP : 1;
    const int64_t until_ms = store_now(store) + GROUP_MS;
    int status = 1;
    *count = 0;
    while (*count < most && (*count == 0 || store_now(store) < until_ms) &&
           (status = find_due(store, cursor, err)) == 1) {
        struct offered *next = &group[*count];
        if (publication->stop != NULL && publication->stop(publication->context))
            return error_set(err, ERROR_STOPPED, "stopped");
        *next = (struct offered){.due = cursor->due};
        if (publication->prepare != NULL)
            next->status = publication->prepare(publication->context, store, &next->due, *count,
                                                &next->reason);
        ++*count;
    }
    return status < 0 ? status : 0;
}

/* Publishes a case, or marks it. Returns the error of the mark alone. */
static int offer(struct store *store, const struct publication *publication,
                 struct offered *offered, size_t number, struct error *err) {
    if (offered->status == 0)
        offered->status = publication->publish(publication->context, store, &offered->due, number,
                                               &offered->reason);
    return publish_is_final(offered->status)
               ? fail_publication(store, &offered->due, offered->reason.text, err)
               : 0;
}

static int offer_each(struct store *store, const struct publication *publication,
                      struct offered *group, size_t count, struct error *err) {
    int status = 0;
    for (size_t n = 0; n < count && status == 0; n++)
        status = offer(store, publication, &group[n], n, err);
    return status;
}

/* Postpones all of a group whose change failed: for the first reason that one of them had, which
 * may have undone the others, or that of the change. */
static void postpone(struct offered *group, size_t count, const struct error *failed) {
    const struct error *reason = failed;
    for (size_t n = count; n > 0; n--)
        if (group[n - 1].status != 0 && !publish_is_final(group[n - 1].status))
            reason = &group[n - 1].reason;
    const struct error first = *reason;
    for (size_t n = 0; n < count; n++) {
        group[n].status = ERROR_SYSTEM;
        group[n].reason = first;
    }
}

/* Publishes a group in one change. If that fails, none of them is published. */
static int offer_group(struct store *store, const struct publication *publication,
                       struct offered *group, size_t count, struct error *err) {
    struct error failed = {0};
    if (count < 2 || store->batch != 0) /* the caller's change has them */
        return offer_each(store, publication, group, count, err);
    int status = store_begin(store, &failed);
    if (status == 0) {
        status = offer_each(store, publication, group, count, &failed);
        if (status == 0)
            status = store_commit(store, &failed);
        else
            store_abandon(store);
    }
    if (status != 0)
        postpone(group, count, &failed);
    return 0;
}

static void count_group(const struct offered *group, size_t count, struct publish_counts *counts) {
    for (size_t n = 0; n < count; n++) {
        if (publish_is_final(group[n].status)) {
            counts->failed++;
        } else if (group[n].status != 0) {
            counts->postponed++;
            counts->reason = group[n].reason;
        } else {
            counts->published++;
        }
    }
}

int store_publish_due(struct store *store, const struct publication *publication,
                      struct publish_counts *counts, struct error *err) {
    struct offered *group = array_create(PUBLICATION_GROUP, sizeof *group);
    struct cursor cursor = {0};
    size_t count = 1;
    int status = 0;
    *counts = (struct publish_counts){0};
    if (group == NULL)
        return error_memory(err, PUBLICATION_GROUP * sizeof *group, "cases that are due");
    while (status == 0 && count > 0) {
        status = gather(store, publication, &cursor, group, &count, err);
        if (status == 0)
            status = offer_group(store, publication, group, count, err);
        if (status == 0)
            count_group(group, count, counts);
        if (publication->clear != NULL)
            publication->clear(publication->context);
    }
    free(group);
    return status;
}

/* --- marks --- */

int case_settle(struct store *store, int64_t study, int64_t case_number, int64_t revision,
                struct error *err) {
    int64_t marked = 0;
    int status = store_integer(store, &marked, err,
                               "SELECT publish_error IS NOT NULL FROM study_case WHERE study_id = "
                               "? AND number = ? AND settled <= ?",
                               "iii", study, case_number, revision);
    if (status != 0)
        return status == ERROR_ABSENT ? 0 : status;
    status = store_run(store, err,
                       "UPDATE study_case SET settled = ?, publish_error = NULL WHERE study_id = ? "
                       "AND number = ?",
                       "iii", revision, study, case_number);
    if (status == 0 && marked != 0)
        status = store_run(
            store, err,
            "UPDATE study SET cases_failed = cases_failed - 1, state = CASE WHEN state = 'failed' "
            "THEN 'running' ELSE state END WHERE id = ?",
            "i", study);
    int64_t ends = 0; /* nothing is left to run: the study may end with this */
    if (status == 0)
        status = store_integer(store, &ends, err,
                               "SELECT state = 'running' AND jobs_waiting + jobs_running = 0 FROM "
                               "study WHERE id = ?",
                               "i", study);
    return status == 0 && (marked != 0 || ends != 0) ? study_settle(store, study, err) : status;
}
