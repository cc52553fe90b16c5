/* The queue of studies: which one is next, and when a study starts.
 *
 * Each owner has a clock, which a claim moves on by the seconds that the job takes, over the
 * owner's weight. The owner whose clock is least is next. An owner with nothing to run does not
 * save up turns: its clock counts from where the last claim began (schema/README.md). */
#include "schema/store/store_internal.h"
#include <math.h>
#include <string.h>

int study_count_work(struct store *store, int64_t study, struct error *err) {
    return store_run(store, err,
                     "UPDATE study SET work = (SELECT total(c.estimate * coalesce(c.realisations, "
                     "study.realisations)) FROM study_case c WHERE c.study_id = ?1 AND (c.parent "
                     "IS NOT NULL OR study.realisations > 0)) WHERE id = ?1",
                     "i", study);
}

/* Owners, and the times of their clocks. */
#define TURN                                                                                       \
    "turn AS (SELECT owner, weight, begun, max(served, (SELECT max(begun) FROM share)) AS start "  \
    "FROM share), "
/* The seconds of each study with jobs that wait, as measured where any job was done. */
#define WAITING                                                                                    \
    "waiting AS (SELECT id, owner, priority, state, CASE WHEN realisations_done > 0 THEN seconds " \
    "/ realisations_done * realisations_waiting ELSE work / jobs * jobs_waiting END AS left FROM " \
    "study INDEXED BY study_line "                                                                 \
    "WHERE state IN ('queued', 'running') AND jobs_waiting > 0), "
/* When the first job of each begins, on the clock of its owner. */
#define LINE                                                                                       \
    "line AS (SELECT w.id, w.owner, w.state, w.left, t.begun, t.start, t.weight, t.start + "       \
    "total(w.left) OVER (PARTITION BY w.owner ORDER BY w.priority DESC, w.id ROWS BETWEEN "        \
    "UNBOUNDED PRECEDING AND 1 PRECEDING) / t.weight AS begins FROM waiting w JOIN turn t ON "     \
    "t.owner = w.owner), mine AS (SELECT begins, begun, id FROM line WHERE id = ?1) "
/* The seconds left of the jobs that run; ?2 is now. */
#define RUNNING                                                                                    \
    ", running AS (SELECT count(*) AS n, min(rest) AS soonest, total(rest) AS rests FROM (SELECT " \
    "max(0, j.count * CASE WHEN c.realisations_done > 0 THEN c.seconds / c.realisations_done "     \
    "ELSE c.estimate END - (?2 - coalesce(j.claimed_ms, ?2)) / 1000.0) AS rest FROM job j JOIN "   \
    "study_case c ON c.study_id = j.study_id AND c.number = j.case_number WHERE j.state = "        \
    "'running')) "
/* Its position; the seconds of jobs that begin before it; the number of jobs that run; and the
 * seconds until the first of them ends, and of all. */
#define LINE_QUERY                                                                                 \
    "WITH " TURN WAITING LINE RUNNING                                                              \
    "SELECT 1 + (SELECT count(*) FROM line l JOIN mine m ON (l.begins, l.begun, l.id) < "          \
    "(m.begins, m.begun, m.id) WHERE l.state = 'queued'), (SELECT total(max(0, min(m.begins - "    \
    "o.start, o.lefts / o.weight)) * o.weight) FROM (SELECT start, weight, sum(left) AS lefts "    \
    "FROM line GROUP BY owner) o, mine m), r.n, r.soonest, r.rests FROM mine, running r"

int study_line(struct store *store, int64_t study, uint64_t *place, double *starts_in,
               struct error *err) {
    sqlite3_stmt *row = NULL;
    *place = 0;
    *starts_in = NAN;
    int status = store_query(store, &row, err, LINE_QUERY, "ii", study, store_now(store));
    if (status == 0)
        status = store_step(store, row, err);
    if (status <= 0)
        return status;
    double before = sqlite3_column_double(row, 1), workers = sqlite3_column_double(row, 2);
    double soonest = sqlite3_column_double(row, 3), rests = sqlite3_column_double(row, 4);
    *place = (uint64_t)sqlite3_column_int64(row, 0);
    if (workers > 0)
        *starts_in = before > 0 ? fmax(soonest, (rests + before) / workers) : soonest;
    sqlite3_reset(row);
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
