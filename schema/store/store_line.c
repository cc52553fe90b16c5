/* The queue of studies: which one is next, and when a study starts.
 *
 * Each owner has a clock, which a claim moves on by the seconds that the job takes, over the
 * owner's weight. The owner whose clock is least is next. An owner with nothing to run does not
 * save up turns: its clock counts from where the last claim began (schema/README.md). */
#include "schema/store/store_internal.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int study_count_work(struct store *store, int64_t study, struct error *err) {
    return store_run(store, err,
                     "UPDATE study SET work = (SELECT total(c.estimate * coalesce(c.realisations, "
                     "study.realisations)) FROM study_case c WHERE c.study_id = ?1 AND (c.parent "
                     "IS NOT NULL OR study.realisations > 0)) WHERE id = ?1",
                     "i", study);
}

/* --- the line: all studies with jobs that wait --- */

struct line_owner {
    char name[OWNER_SIZE];
    double start, begun, weight; /* of its clock */
    double lefts;                /* seconds of all that it has in line */
    size_t first, end;           /* its studies */
};

struct line_study {
    int64_t id, priority;
    bool queued;
    size_t queued_before; /* of those before it in line->studies */
    double begins;        /* when its first job does, on the clock of its owner */
};

/* The line at one moment: studies by owners, priority and age. It is read once for all who ask
 * about that moment. */
struct queue_line {
    int64_t version, changes; /* of the file, and of this handle, when it was read; -1: not known */
    struct line_owner *owners;
    struct line_study *studies;
    size_t owner_count, count, queued;
};

void queue_line_destroy(struct queue_line **line) {
    struct queue_line *gone = *line;
    if (gone == NULL)
        return;
    free(gone->owners);
    free(gone->studies);
    free(gone);
    *line = NULL;
}

/* Makes room for one more of so many. */
static int line_grow(void **all, size_t count, size_t size, struct error *err) {
    enum { LEAST = 64 };
    size_t room = count < LEAST ? LEAST : 2 * count;
    bool full = count == 0 || (count >= LEAST && (count & (count - 1)) == 0);
    if (!full)
        return 0;
    void *larger = realloc(*all, room * size);
    if (larger == NULL)
        return error_memory(err, room * size, "the queue");
    *all = larger;
    return 0;
}

static int line_read_owners(struct store *store, struct queue_line *line, struct error *err) {
    sqlite3_stmt *row = NULL;
    int status = store_query(store, &row, err,
                             "SELECT owner, max(served, (SELECT max(begun) FROM share)), begun, "
                             "weight FROM share ORDER BY owner",
                             "");
    while (status == 0 && (status = store_step(store, row, err)) == 1) {
        void *owners = line->owners;
        status = line_grow(&owners, line->owner_count, sizeof *line->owners, err);
        line->owners = owners;
        if (status != 0) {
            sqlite3_reset(row);
            return status;
        }
        struct line_owner *owner = &line->owners[line->owner_count++];
        *owner = (struct line_owner){.start = sqlite3_column_double(row, 1),
                                     .begun = sqlite3_column_double(row, 2),
                                     .weight = sqlite3_column_double(row, 3)};
        snprintf(owner->name, sizeof owner->name, "%s", (const char *)sqlite3_column_text(row, 0));
    }
    return status;
}

/* Takes a row: study, whether it is queued, seconds left, priority. */
static int line_add(struct queue_line *line, sqlite3_stmt *row, size_t of, struct error *err) {
    struct line_owner *owner = &line->owners[of];
    void *studies = line->studies;
    int status = line_grow(&studies, line->count, sizeof *line->studies, err);
    line->studies = studies;
    if (status != 0)
        return status;
    line->studies[line->count++] =
        (struct line_study){.id = sqlite3_column_int64(row, 0),
                            .priority = sqlite3_column_int64(row, 3),
                            .queued = sqlite3_column_int(row, 1) != 0,
                            .queued_before = line->queued,
                            .begins = owner->start + owner->lefts / owner->weight};
    line->queued += sqlite3_column_int(row, 1) != 0;
    owner->lefts += sqlite3_column_double(row, 2);
    return 0;
}

/* The seconds of each study of an owner with jobs that wait, as measured where any job was done. */
#define WAITING(from)                                                                              \
    "SELECT id, state = 'queued', CASE WHEN realisations_done > 0 THEN seconds / "                 \
    "realisations_done * realisations_waiting ELSE work / jobs * jobs_waiting END, priority "      \
    "FROM study INDEXED BY " from " AND owner = ?1 AND jobs_waiting > 0"
#define LINE                                                                                       \
    WAITING("study_queued WHERE state = 'queued'")                                                 \
    " UNION ALL " WAITING(                                                                         \
        "study_line WHERE state = 'running' AND state IN ('queued', 'running')") " ORDER BY 4 "    \
                                                                                 "DESC, 1"

/* Asks whether to stop seldom, as the rows are many and small. */
static int line_read_studies(struct store *store, struct queue_line *line, size_t of,
                             struct error *err) {
    enum { UNTIL_ASKED = 256 };
    sqlite3_stmt *row = NULL;
    int status = store_query(store, &row, err, LINE, "t", line->owners[of].name), code = 0;
    while (status == 0) {
        if (line->count % UNTIL_ASKED == 0)
            status = store_step(store, row, err);
        else if ((code = sqlite3_step(row)) == SQLITE_ROW)
            status = 1;
        else
            status = code == SQLITE_DONE ? 0 : store_error(store, err);
        if (status != 1)
            break;
        status = line_add(line, row, of, err);
    }
    sqlite3_reset(row);
    return status;
}

static int line_read(struct store *store, struct queue_line *line, struct error *err) {
    int status = line_read_owners(store, line, err);
    for (size_t o = 0; status == 0 && o < line->owner_count; o++) {
        line->owners[o].first = line->count;
        status = line_read_studies(store, line, o, err);
        line->owners[o].end = line->count;
    }
    return status;
}

static int line_create(struct store *store, struct queue_line **out, struct error *err) {
    struct queue_line *line = array_create(1, sizeof *line);
    int status = line != NULL ? 0 : error_memory(err, sizeof *line, "the queue");
    if (status == 0)
        status = store_integer(store, &line->version, err, "PRAGMA data_version", "");
    if (status == 0)
        status = line_read(store, line, err);
    if (status != 0)
        queue_line_destroy(&line);
    *out = line;
    return status;
}

/* Brings the line of the handle up to date. One that is read within a change is not kept, as the
 * change may be undone. */
static int line_renew(struct store *store, struct error *err) {
    bool changing = sqlite3_txn_state(store->db, NULL) == SQLITE_TXN_WRITE;
    bool alone = sqlite3_get_autocommit(store->db) != 0;
    int64_t changes = sqlite3_total_changes64(store->db), version = 0;
    int status = store_integer(store, &version, err, "PRAGMA data_version", "");
    if (status != 0 || (store->line != NULL && !changing && store->line->version == version &&
                        store->line->changes == changes))
        return status;
    queue_line_destroy(&store->line);
    if (alone && (status = read_begin(store, err)) != 0)
        return status;
    status = line_create(store, &store->line, err);
    if (alone)
        read_end(store);
    if (status == 0)
        store->line->changes = changing ? -1 : changes;
    return status;
}

/* --- the jobs that run --- */

/* The seconds left of the jobs that run; ?1 is now. */
#define RUNNING                                                                                    \
    "SELECT count(*), min(rest), total(rest), count(DISTINCT worker) FROM (SELECT j.worker AS "    \
    "worker, max(0, j.count * CASE WHEN c.realisations_done > 0 THEN c.seconds / "                 \
    "c.realisations_done ELSE c.estimate END - (?1 - coalesce(j.claimed_ms, ?1)) / 1000.0) AS "    \
    "rest FROM job j INDEXED BY job_running CROSS JOIN study_case c ON c.study_id = j.study_id "   \
    "AND c.number = j.case_number WHERE j.state = 'running')"

int at_work_read(struct store *store, struct at_work *out, struct error *err) {
    sqlite3_stmt *row = NULL;
    if (out->known)
        return 0;
    int status = store_query(store, &row, err, RUNNING, "i", store_now(store));
    if (status == 0)
        status = store_step(store, row, err);
    if (status < 0)
        return status;
    *out = (struct at_work){.known = true,
                            .jobs = sqlite3_column_double(row, 0),
                            .soonest = sqlite3_column_double(row, 1),
                            .rests = sqlite3_column_double(row, 2),
                            .workers = (size_t)sqlite3_column_int64(row, 3)};
    sqlite3_reset(row);
    return 0;
}

/* --- the position of a study --- */

/* Returns the seconds of the jobs in line that begin before a study does. */
static double seconds_before(const struct queue_line *line, const struct line_study *study) {
    double before = 0;
    for (size_t o = 0; o < line->owner_count; o++) {
        const struct line_owner *owner = &line->owners[o];
        double most = fmin(study->begins - owner->start, owner->lefts / owner->weight);
        before += fmax(0, most) * owner->weight;
    }
    return before;
}

/* Returns how many queued studies of an owner begin before a study of another, or the same, does.
 * They begin in their order; those that begin at once, as some take no time, are compared each. */
static size_t queued_before(const struct queue_line *line, const struct line_owner *owner,
                            const struct line_study *study, double begun) {
    size_t low = owner->first, high = owner->end, count = 0;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (line->studies[middle].begins < study->begins)
            low = middle + 1;
        else
            high = middle;
    }
    count = (low < line->count ? line->studies[low].queued_before : line->queued) -
            (owner->first < line->count ? line->studies[owner->first].queued_before : line->queued);
    for (; low < owner->end && line->studies[low].begins == study->begins; low++)
        count +=
            line->studies[low].queued &&
            (owner->begun < begun || (owner->begun == begun && line->studies[low].id < study->id));
    return count;
}

static int compare_names(const void *name, const void *owner) {
    return strcmp(name, ((const struct line_owner *)owner)->name);
}

/* Finds a study that waits: by priority, then by age. */
static const struct line_study *line_find(const struct queue_line *line,
                                          const struct line_owner *owner, int64_t priority,
                                          int64_t id) {
    size_t low = owner->first, high = owner->end;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        const struct line_study *at = &line->studies[middle];
        if (at->priority > priority || (at->priority == priority && at->id < id))
            low = middle + 1;
        else
            high = middle;
    }
    return low < owner->end && line->studies[low].id == id ? &line->studies[low] : NULL;
}

int study_line(struct store *store, int64_t study, const struct at_work *at_work,
               struct study_status *of, struct error *err) {
    of->place = 0;
    of->starts_in = NAN;
    int status = line_renew(store, err);
    if (status != 0 || store->line->owner_count == 0)
        return status;
    const struct queue_line *line = store->line;
    const struct line_owner *owner =
        bsearch(of->owner, line->owners, line->owner_count, sizeof *line->owners, compare_names);
    const struct line_study *found =
        owner != NULL ? line_find(line, owner, of->priority, study) : NULL;
    if (found == NULL)
        return 0;
    of->place = 1;
    for (size_t o = 0; o < line->owner_count; o++)
        of->place += queued_before(line, &line->owners[o], found, owner->begun);
    double before = seconds_before(line, found);
    if (at_work->jobs > 0)
        of->starts_in = before > 0
                            ? fmax(at_work->soonest, (at_work->rests + before) / at_work->jobs)
                            : at_work->soonest;
    return 0;
}

int store_share(struct store *store, const char *owner, double weight, struct error *err) {
    if (!(weight > 0) || isinf(weight) || strlen(owner) >= OWNER_SIZE)
        return error_set(err, ERROR_INPUT, "%.60s=%g is no share: a weight is above 0, finite",
                         owner, weight);
    int status = change_begin(store, err);
    if (status != 0)
        return status;
    status = store_run(store, err,
                       "INSERT INTO share (owner, weight) VALUES (?1, ?2) ON CONFLICT (owner) DO "
                       "UPDATE SET weight = ?2",
                       "td", owner, weight);
    return change_end(store, status, err);
}
