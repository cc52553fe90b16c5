/* What the views of a store say, held against the model. */
#ifndef RUGO_TESTS_UNIT_SCHEMA_LIFE_VIEWS_H
#define RUGO_TESTS_UNIT_SCHEMA_LIFE_VIEWS_H

#include "tests/unit/schema/life_world.h"

enum { TEXT_SIZE = 4096 };

/* The scalar of a realisation, by which a sum shows what it is over. */
static inline double value_of(const struct life_job *job, int64_t realisation) {
    return 1000.0 * job->study + 100.0 * job->case_number + (double)(job->first + realisation);
}

/* The rows of a query of one text column, a line each. */
static inline void read_rows(sqlite3 *db, const char *sql, const char *study,
                             char text[TEXT_SIZE]) {
    sqlite3_stmt *row = NULL;
    size_t used = 0;
    *text = 0;
    if (sqlite3_prepare_v2(db, sql, -1, &row, NULL) != SQLITE_OK)
        fail_msg("%s: %s", sql, sqlite3_errmsg(db));
    sqlite3_bind_text(row, 1, study, -1, SQLITE_STATIC);
    while (sqlite3_step(row) == SQLITE_ROW && used < TEXT_SIZE)
        used += (size_t)snprintf(text + used, TEXT_SIZE - used, "%s\n",
                                 (const char *)sqlite3_column_text(row, 0));
    sqlite3_finalize(row);
    assert_true(used < TEXT_SIZE);
}

static inline void check_rows(const struct world *world, sqlite3 *db, int study, const char *sql,
                              const char *expected) {
    char text[TEXT_SIZE];
    read_rows(db, sql, world->ids[study], text);
    if (strcmp(text, expected) != 0)
        fail_msg("sequence %d, study %d, %s:\n%sinstead of\n%s", world->sequence, study, sql, text,
                 expected);
}

__attribute__((format(printf, 2, 3))) static inline void put(char text[TEXT_SIZE],
                                                             const char *format, ...) {
    size_t used = strlen(text);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text + used, TEXT_SIZE - used, format, arguments);
    va_end(arguments);
}

static inline int64_t realisations_in(const struct life *life, int study, enum life_state state) {
    int64_t n = 0;
    for (int j = 0; j < life->job_count; j++)
        if (life->jobs[j].study == study && life->jobs[j].state == state)
            n += life->jobs[j].count;
    return n;
}

static inline void check_progress(const struct world *world, sqlite3 *db, int s) {
    const struct life *life = &world->life;
    char text[TEXT_SIZE] = "";
    put(text, "%s %d", life_study_state(life, s), life->studies[s].cases);
    for (int state = LIFE_WAITING; state < LIFE_STATES; state++)
        put(text, " %d", life_count(life, s, (enum life_state)state));
    put(text, " %lld %d\n", (long long)realisations_in(life, s, LIFE_DONE),
        2 * life_count(life, s, LIFE_DONE));
    check_rows(world, db, s,
               "SELECT printf('%s %d %d %d %d %d %d %d %d', state, cases, jobs_waiting, "
               "jobs_running, jobs_done, "
               "jobs_failed, jobs_cancelled, realisations_done, cast(seconds AS INTEGER)) FROM "
               "study_progress WHERE study = ?",
               text);
}

static inline void check_jobs(const struct world *world, sqlite3 *db, int s) {
    const struct life *life = &world->life;
    char text[TEXT_SIZE] = "";
    for (int j = 0; j < life->job_count; j++) {
        const struct life_job *job = &life->jobs[j];
        if (job->study != s)
            continue;
        put(text, "%d %d %lld %lld %s %d %d ", j + 1, job->case_number, (long long)job->first,
            (long long)job->count, LIFE_STATE_NAMES[job->state], job->attempts, job->losses);
        if (job->worker > 0)
            put(text, "w%d", job->worker);
        else
            put(text, "-");
        put(text, " %s\n", *job->error ? job->error : "-");
    }
    check_rows(
        world, db, s,
        "SELECT printf('%d %d %d %d %s %d %d %s %s', job, \"case\", first, count, state, attempts, "
        "losses, coalesce(worker, '-'), coalesce(error, '-')) FROM job_log WHERE study = ? "
        "ORDER BY job",
        text);
}

/* The jobs that are published of a case, in the order of their realisations. */
static inline void put_points(char text[TEXT_SIZE], const struct life *life, uint32_t jobs, int c) {
    for (int64_t at = 0; at < LIFE_MOST; at++)
        for (int j = 0; j < life->job_count; j++)
            if ((jobs >> j & 1) != 0 && life->jobs[j].first == at)
                put(text, "%d %lld %lld\n", c, (long long)at, (long long)life->jobs[j].count);
}

static inline void check_cases(const struct world *world, sqlite3 *db, int s) {
    const struct life *life = &world->life;
    char cases[TEXT_SIZE] = "", scalars[TEXT_SIZE] = "", points[TEXT_SIZE] = "";
    for (int c = 0; c < life->studies[s].cases; c++) {
        const struct life_case *one = &life->studies[s].of[c];
        int64_t n = 0;
        double sum = 0;
        put(cases, "%d %s %d %s\n", c, life_case_state(life, s, c), life_left(life, s, c),
            one->marked ? "poisoned" : "-");
        for (int j = 0; j < life->job_count; j++) {
            const struct life_job *job = &life->jobs[j];
            if (!(one->published_jobs >> j & 1))
                continue;
            for (int64_t r = 0; r < job->count; r++)
                sum += value_of(job, r);
            n += job->count;
        }
        put_points(points, life, one->published_jobs, c);
        if (one->published > 0)
            put(scalars, "%d %.0f %lld\n", c, sum, (long long)n);
    }
    check_rows(
        world, db, s,
        "SELECT printf('%d %s %d %s', \"case\", state, jobs_left, coalesce(error, '-')) FROM "
        "case_progress WHERE study = ? ORDER BY \"case\"",
        cases);
    check_rows(world, db, s,
               "SELECT printf('%d %d %d', \"case\", cast(value AS INTEGER), cast(standard_error AS "
               "INTEGER)) FROM case_scalars WHERE study = ? ORDER BY \"case\"",
               scalars);
    check_rows(world, db, s,
               "SELECT printf('%d %d %d', \"case\", cast(x AS INTEGER), cast(y AS INTEGER)) FROM "
               "curve_points WHERE study = ? ORDER BY \"case\", x",
               points);
}

/* Every realisation that is done is there once. */
static inline void check_realisations(const struct world *world, sqlite3 *db, int s) {
    const struct life *life = &world->life;
    char text[TEXT_SIZE] = "";
    for (int c = 0; c < LIFE_CASES; c++)
        for (int64_t r = 0; r < LIFE_MOST; r++)
            for (int j = 0; j < life->job_count; j++) {
                const struct life_job *job = &life->jobs[j];
                if (job->study == s && job->case_number == c && job->state == LIFE_DONE &&
                    job->first <= r && r < job->first + job->count)
                    put(text, "%d %" PRId64 " %.0f\n", c, r, value_of(job, r - job->first));
            }
    check_rows(
        world, db, s,
        "SELECT printf('%d %d %d', \"case\", realisation, cast(value AS INTEGER)) FROM "
        "realisation_scalars WHERE study = ? AND scalar = 'a' ORDER BY \"case\", realisation",
        text);
}

static inline void check_views(const struct world *world) {
    sqlite3 *db = NULL;
    assert_int_equal(sqlite3_open_v2(path, &db, SQLITE_OPEN_READONLY, NULL), SQLITE_OK);
    for (int s = 0; s < world->life.study_count; s++) {
        check_progress(world, db, s);
        check_jobs(world, db, s);
        check_cases(world, db, s);
        check_realisations(world, db, s);
    }
    sqlite3_close(db);
}

#endif
