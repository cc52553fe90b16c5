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
    double start, begun, weight; /* of its clock */
    double lefts;                /* seconds of all that it has in line */
};

struct line_study {
    int64_t id;
    size_t owner;
    bool queued;
    double begins; /* when its first job does, on the clock of its owner */
};

/* The line at one moment: studies by owners, priority and age; those that are queued once more, by
 * their places. It is read once for all who ask about that moment. */
struct queue_line {
    int64_t version, changes; /* of the file, and of this handle, when it was read; -1: not known */
    struct line_owner *owners;
    struct line_study *studies;
    const struct line_study **by_id, **by_place;
    size_t owner_count, count, queued_count, room;
};

void queue_line_destroy(struct queue_line **line) {
    struct queue_line *gone = *line;
    if (gone == NULL)
        return;
    free(gone->owners);
    free(gone->studies);
    free(gone->by_id);
    free(gone->by_place);
    free(gone);
    *line = NULL;
}

/* Makes room for one more study, and one more owner. */
static int line_grow(struct queue_line *line, struct error *err) {
    size_t room = line->room > 0 ? 2 * line->room : 64;
    if (line->count < line->room)
        return 0;
    struct line_study *studies = realloc(line->studies, room * sizeof *studies);
    if (studies != NULL)
        line->studies = studies;
    struct line_owner *owners = realloc(line->owners, room * sizeof *owners);
    if (owners != NULL)
        line->owners = owners;
    if (studies == NULL || owners == NULL)
        return error_memory(err, room * sizeof *studies, "the queue");
    line->room = room;
    return 0;
}

/* Takes a row: study, whether it is the first of its owner, state, seconds left, and the clock. */
static int line_add(struct queue_line *line, sqlite3_stmt *row, bool new_owner, struct error *err) {
    int status = line_grow(line, err);
    if (status != 0)
        return status;
    if (new_owner)
        line->owners[line->owner_count++] =
            (struct line_owner){.start = sqlite3_column_double(row, 4),
                                .begun = sqlite3_column_double(row, 5),
                                .weight = sqlite3_column_double(row, 6)};
    struct line_owner *owner = &line->owners[line->owner_count - 1];
    line->studies[line->count++] =
        (struct line_study){.id = sqlite3_column_int64(row, 0),
                            .owner = line->owner_count - 1,
                            .queued = sqlite3_column_int(row, 2) != 0,
                            .begins = owner->start + owner->lefts / owner->weight};
    owner->lefts += sqlite3_column_double(row, 3);
    return 0;
}

/* The seconds of each study with jobs that wait, as measured where any job was done, and the clock
 * of its owner. */
#define WAITING                                                                                    \
    "SELECT s.id, s.owner, s.state = 'queued', CASE WHEN s.realisations_done > 0 THEN s.seconds "  \
    "/ s.realisations_done * s.realisations_waiting ELSE s.work / s.jobs * s.jobs_waiting END, "   \
    "max(t.served, (SELECT max(begun) FROM share)), t.begun, t.weight FROM share t CROSS JOIN "    \
    "study s INDEXED BY study_line ON s.owner = t.owner WHERE s.state IN ('queued', 'running') "   \
    "AND s.jobs_waiting > 0 ORDER BY t.owner, s.priority DESC, s.id"

static int line_read(struct store *store, struct queue_line *line, struct error *err) {
    char owner[OWNER_SIZE] = "";
    sqlite3_stmt *row = NULL;
    int status = store_query(store, &row, err, WAITING, "");
    while (status == 0 && (status = store_step(store, row, err)) == 1) {
        const char *name = (const char *)sqlite3_column_text(row, 1);
        status = line_add(line, row, line->count == 0 || strcmp(owner, name) != 0, err);
        snprintf(owner, sizeof owner, "%s", name);
        if (status != 0)
            sqlite3_reset(row);
    }
    return status;
}

static int compare_ids(const void *a, const void *b) {
    const struct line_study *x = *(const struct line_study *const *)a,
                            *y = *(const struct line_study *const *)b;
    return (x->id > y->id) - (x->id < y->id);
}

static int compare_places(const void *a, const void *b, void *context) {
    const struct queue_line *line = context;
    const struct line_study *x = *(const struct line_study *const *)a,
                            *y = *(const struct line_study *const *)b;
    double p = line->owners[x->owner].begun, q = line->owners[y->owner].begun;
    if (x->begins != y->begins)
        return x->begins < y->begins ? -1 : 1;
    if (p != q)
        return p < q ? -1 : 1;
    return (x->id > y->id) - (x->id < y->id);
}

static int line_sort(struct queue_line *line, struct error *err) {
    line->by_id = array_create(line->count + 1, sizeof *line->by_id);
    line->by_place = array_create(line->count + 1, sizeof *line->by_place);
    if (line->by_id == NULL || line->by_place == NULL)
        return error_memory(err, line->count * sizeof *line->by_id, "the queue");
    for (size_t n = 0; n < line->count; n++) {
        line->by_id[n] = &line->studies[n];
        if (line->studies[n].queued)
            line->by_place[line->queued_count++] = &line->studies[n];
    }
    qsort(line->by_id, line->count, sizeof *line->by_id, compare_ids);
    qsort_r(line->by_place, line->queued_count, sizeof *line->by_place, compare_places, line);
    return 0;
}

/* Brings the line of the handle up to date. One that is read within a change is not kept, as the
 * change may be undone. */
static int line_renew(struct store *store, struct error *err) {
    bool changing = sqlite3_txn_state(store->db, NULL) == SQLITE_TXN_WRITE;
    int64_t changes = sqlite3_total_changes64(store->db), version = 0;
    int status = store_integer(store, &version, err, "PRAGMA data_version", "");
    if (status != 0 || (store->line != NULL && !changing && store->line->version == version &&
                        store->line->changes == changes))
        return status;
    queue_line_destroy(&store->line);
    struct queue_line *line = array_create(1, sizeof *line);
    if (line == NULL)
        return error_memory(err, sizeof *line, "the queue");
    line->version = changing ? -1 : version;
    line->changes = changes;
    status = line_read(store, line, err);
    if (status == 0)
        status = line_sort(line, err);
    if (status != 0)
        queue_line_destroy(&line);
    store->line = line;
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

/* Returns how many queued studies begin before it. */
static size_t studies_before(struct queue_line *line, const struct line_study *study) {
    size_t low = 0, high = line->queued_count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (compare_places(&line->by_place[middle], &study, line) < 0)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

int study_line(struct store *store, int64_t study, const struct at_work *at_work, uint64_t *place,
               double *starts_in, struct error *err) {
    const struct line_study wanted = {.id = study}, *key = &wanted;
    *place = 0;
    *starts_in = NAN;
    int status = line_renew(store, err);
    if (status != 0 || store->line->count == 0)
        return status;
    const struct line_study **found = bsearch(&key, store->line->by_id, store->line->count,
                                              sizeof *store->line->by_id, compare_ids);
    if (found == NULL)
        return 0;
    double before = seconds_before(store->line, *found);
    *place = 1 + studies_before(store->line, *found);
    if (at_work->jobs > 0)
        *starts_in = before > 0 ? fmax(at_work->soonest, (at_work->rests + before) / at_work->jobs)
                                : at_work->soonest;
    return 0;
}

int store_share(struct store *store, const char *owner, double weight, struct error *err) {
    if (!(weight > 0) || isinf(weight) || strlen(owner) >= OWNER_SIZE)
        return error_set(err, ERROR_INPUT, "%.60s=%g is no share: a weight is above 0", owner,
                         weight);
    int status = change_begin(store, err);
    if (status != 0)
        return status;
    status = store_run(store, err,
                       "INSERT INTO share (owner, weight) VALUES (?1, ?2) ON CONFLICT (owner) DO "
                       "UPDATE SET weight = ?2",
                       "td", owner, weight);
    return change_end(store, status, err);
}
