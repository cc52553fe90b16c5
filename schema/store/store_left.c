/* Time left: estimates what the rest of a study takes, and how it is divided among the workers.
 *
 * A case with jobs or parts of jobs done goes on at their rate. A case that has not begun takes its
 * estimate, corrected by how the estimates compare with the time of all that is done. */
#include "schema/store/schedule.h"
#include "schema/store/store_internal.h"
#include <math.h>
#include <stdlib.h>

enum { LAST_JOBS = 256 }; /* their order decides on the end; those before are divided evenly */

/* A job that runs, and what is done of its case. Times are in seconds. */
struct running_job {
    int64_t case_number;
    int64_t wanted, done; /* realisations of the case but for those given up; of completed jobs */
    double estimate, seconds; /* of a realisation; of the completed jobs of the case */
    double count, reported, reported_after, elapsed;
    bool leads; /* the first one of its case */
};

static const double PRIOR = 4;
static const double LEAST_LEFT = 0.05; /* of a realisation, of a job that has not ended */

/* Realisations of a case c that no job will do: they failed for good, or were cancelled. */
#define GIVEN_UP                                                                                   \
    "CASE WHEN (SELECT jobs_failed + jobs_cancelled FROM study WHERE id = ?1) > 0 THEN (SELECT "   \
    "coalesce(sum(count), 0) FROM job WHERE study_id = ?1 AND case_number = c.number AND state "   \
    "IN ('failed', 'cancelled')) ELSE 0 END"

struct reading {
    struct store *store;
    int64_t study, realisations; /* of each case; 0: each case has its own */
    struct running_job *jobs;    /* owned, by cases */
    size_t job_count, room;
    double completed;        /* seconds of completed jobs */
    double spent, estimated; /* seconds of these and of what is reported, measured and estimated */
};

static int add_job(struct reading *reading, sqlite3_stmt *row, struct error *err) {
    if (reading->job_count == reading->room) {
        size_t room = reading->room > 0 ? 2 * reading->room : 16;
        struct running_job *jobs = realloc(reading->jobs, room * sizeof *jobs);
        if (jobs == NULL)
            return error_memory(err, room * sizeof *jobs, "running jobs");
        reading->jobs = jobs;
        reading->room = room;
    }
    int64_t now = store_now(reading->store);
    bool timed = sqlite3_column_type(row, 7) != SQLITE_NULL;
    struct running_job job = {.case_number = sqlite3_column_int64(row, 0),
                              .wanted = sqlite3_column_int64(row, 1),
                              .done = sqlite3_column_int64(row, 2),
                              .estimate = sqlite3_column_double(row, 3),
                              .seconds = sqlite3_column_double(row, 4),
                              .count = sqlite3_column_double(row, 5),
                              .reported = timed ? sqlite3_column_double(row, 6) : 0,
                              .reported_after = sqlite3_column_double(row, 8) / 1000};
    job.elapsed = timed ? fmax(0, (double)(now - sqlite3_column_int64(row, 7)) / 1000) : 0;
    const struct running_job *before =
        reading->job_count > 0 ? &reading->jobs[reading->job_count - 1] : NULL;
    job.leads = before == NULL || before->case_number != job.case_number;
    reading->jobs[reading->job_count++] = job;
    return 0;
}

static int read_jobs(struct reading *reading, struct error *err) {
    sqlite3_stmt *row = NULL;
    int status = store_query(
        reading->store, &row, err,
        "SELECT j.case_number, coalesce(c.realisations, ?2) - " GIVEN_UP
        ", c.realisations_done, c.estimate, "
        "c.seconds, j.count, j.reported, j.claimed_ms, j.reported_ms FROM job j INDEXED BY "
        "job_running CROSS JOIN study_case c ON c.study_id = j.study_id AND c.number = "
        "j.case_number WHERE j.state = 'running' AND "
        "j.study_id = ?1 ORDER BY j.case_number",
        "ii", reading->study, reading->realisations);
    while (status == 0 && (status = store_step(reading->store, row, err)) == 1) {
        status = add_job(reading, row, err);
        if (status != 0)
            sqlite3_reset(row);
    }
    return status;
}

static int read_totals(struct reading *reading, struct error *err) {
    sqlite3_stmt *row = NULL;
    int status = store_query(reading->store, &row, err,
                             "SELECT total(seconds), total(estimate * realisations_done) FROM "
                             "study_case WHERE study_id = ?1 AND (parent IS NOT NULL OR ?2 > 0)",
                             "ii", reading->study, reading->realisations);
    if (status == 0)
        status = store_step(reading->store, row, err);
    if (status <= 0)
        return status;
    reading->completed = reading->spent = sqlite3_column_double(row, 0);
    reading->estimated = sqlite3_column_double(row, 1);
    sqlite3_reset(row);
    for (size_t j = 0; j < reading->job_count; j++) {
        const struct running_job *job = &reading->jobs[j];
        if (job->reported > 0) {
            reading->spent += job->reported_after;
            reading->estimated += job->reported * job->estimate;
        }
    }
    return 0;
}

/* Returns the measured over the estimated time so far. */
static double correction(const struct reading *reading) {
    return reading->spent > 0 && reading->estimated > 0 ? reading->spent / reading->estimated : 1;
}

/* Returns the seconds of a realisation of the case whose first job that runs is jobs[first]. As the
 * first reports of a case are few and rounded, the corrected estimate counts as PRIOR realisations
 * beside them. */
static double case_rate(const struct reading *reading, size_t first) {
    const struct running_job *lead = &reading->jobs[first];
    double expected = lead->estimate * correction(reading);
    double prior = reading->completed > lead->seconds ? PRIOR : 0;
    double seconds = lead->seconds + prior * expected, done = (double)lead->done + prior;
    for (size_t j = first; j < reading->job_count && (j == first || !reading->jobs[j].leads); j++)
        if (reading->jobs[j].reported > 0) {
            seconds += reading->jobs[j].reported_after;
            done += reading->jobs[j].reported;
        }
    return done > 0 ? seconds / done : expected;
}

/* Returns the seconds of a realisation of a case; fallback where none of its jobs runs. */
static double rate_of(const struct reading *reading, int64_t case_number, double fallback) {
    for (size_t j = 0; j < reading->job_count; j++)
        if (reading->jobs[j].leads && reading->jobs[j].case_number == case_number)
            return case_rate(reading, j);
    return fallback;
}

/* Sets the loads of the workers, and *done to the seconds that their jobs took so far. A job that
 * should have ended needs as long again as it is late: nothing else is known of a realisation that
 * takes many times its estimate. These seconds are returned; the share that is done leaves them
 * out, as it would fall. */
static double load_workers(const struct reading *reading, double *loads, double *done) {
    double rate = 0, all_late = 0;
    for (size_t j = 0; j < reading->job_count; j++) {
        const struct running_job *job = &reading->jobs[j];
        if (job->leads)
            rate = case_rate(reading, j);
        double since = job->elapsed - (job->reported > 0 ? job->reported_after : 0);
        double whole = job->count * rate, most = fmax(0, whole - LEAST_LEFT * rate);
        double took = job->reported * rate + fmax(0, since), now = fmin(most, took);
        double late = took - now;
        loads[j] = whole - now + late;
        *done += now;
        all_late += late;
    }
    return all_late;
}

/* Reads the seconds of one worker that wait. */
static int read_waiting(const struct reading *reading, double *waiting, struct error *err) {
    sqlite3_stmt *row = NULL;
    int status = store_query(
        reading->store, &row, err,
        "SELECT total((coalesce(realisations, ?2) - realisations_done - " GIVEN_UP ") * CASE WHEN "
        "realisations_done > 0 THEN seconds / realisations_done ELSE estimate * ?3 END) FROM "
        "study_case c WHERE study_id = ?1 AND (parent IS NOT NULL OR ?2 > 0) AND jobs_left > 0 AND "
        "number NOT IN (SELECT case_number FROM job INDEXED BY job_running WHERE state = 'running' "
        "AND study_id = ?1)",
        "iid", reading->study, reading->realisations, correction(reading));
    if (status == 0)
        status = store_step(reading->store, row, err);
    if (status <= 0)
        return status;
    *waiting = sqlite3_column_double(row, 0);
    sqlite3_reset(row);
    double rest = 0;
    for (size_t j = 0; j < reading->job_count; j++) {
        const struct running_job *job = &reading->jobs[j];
        if (job->leads)
            rest = (double)(job->wanted - job->done);
        rest -= job->count;
        bool last = j + 1 == reading->job_count || reading->jobs[j + 1].leads;
        if (last && rest > 0)
            *waiting += rest * rate_of(reading, job->case_number, 0);
    }
    return 0;
}

/* Reads the seconds of the last jobs that wait, in their order, as the spans will be cut. */
static int read_last(const struct reading *reading, double last[LAST_JOBS], size_t *count,
                     struct error *err) {
    sqlite3_stmt *row = NULL;
    size_t n = 0;
    int status = store_query(
        reading->store, &row, err,
        "SELECT j.case_number, 1.0 * j.count / j.blocks, CASE WHEN c.realisations_done > 0 THEN "
        "c.seconds / c.realisations_done ELSE c.estimate * ?2 END, j.blocks FROM job j JOIN "
        "study_case c ON c.study_id = j.study_id AND c.number = j.case_number WHERE j.state = "
        "'waiting' AND j.study_id = ?1 ORDER BY j.case_number DESC, j.id DESC LIMIT ?3",
        "idi", reading->study, correction(reading), (int64_t)LAST_JOBS);
    while (status == 0 && n < LAST_JOBS && (status = store_step(reading->store, row, err)) == 1) {
        double rate = rate_of(reading, sqlite3_column_int64(row, 0), sqlite3_column_double(row, 2));
        double seconds = sqlite3_column_double(row, 1) * rate;
        for (int64_t b = sqlite3_column_int64(row, 3); b > 0 && n < LAST_JOBS; b--)
            last[n++] = seconds;
        status = 0;
    }
    if (status == 0 && row != NULL)
        sqlite3_reset(row);
    for (size_t a = 0; a < n / 2; a++) {
        double other = last[a];
        last[a] = last[n - 1 - a];
        last[n - 1 - a] = other;
    }
    *count = n;
    return status;
}

/* Computes what is left from what was read. loads has room for n workers, of whom some have
 * jobs. */
static int make_left(const struct reading *reading, double *loads, size_t n, struct work_left *out,
                     struct error *err) {
    double last[LAST_JOBS], waiting = 0, done = reading->completed;
    size_t count = 0;
    int status = read_waiting(reading, &waiting, err);
    if (status == 0)
        status = read_last(reading, last, &count, err);
    if (status != 0)
        return status;
    const double late = load_workers(reading, loads, &done);
    out->work = waiting;
    for (size_t j = 0; j < reading->job_count; j++)
        out->work += loads[j];
    out->share = done + out->work > 0 ? done / (done + out->work - late) : 0;
    double bulk = waiting;
    for (size_t job = 0; job < count; job++)
        bulk -= last[job];
    out->seconds = n > 0 ? schedule_end(loads, n, bulk, last, count) : (double)NAN;
    return 0;
}

int study_left(struct store *store, int64_t study, uint64_t realisations, size_t workers,
               struct work_left *out, struct error *err) {
    struct reading reading = {
        .store = store, .study = study, .realisations = (int64_t)realisations};
    int status = read_jobs(&reading, err);
    if (status == 0)
        status = read_totals(&reading, err);
    size_t n = workers > reading.job_count ? workers : reading.job_count;
    double *loads = array_create(n > 0 ? n : 1, sizeof *loads);
    if (status == 0 && loads == NULL)
        status = error_memory(err, n * sizeof *loads, "the loads of workers");
    if (status == 0)
        status = make_left(&reading, loads, n, out, err);
    free(loads);
    free(reading.jobs);
    return status;
}
