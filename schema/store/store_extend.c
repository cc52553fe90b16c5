/* Extension: adds the realisations that a study lacks behind those that it has. */
#include "schema/store/store_internal.h"
#include <stdlib.h>

/* --- more realisations of a study --- */

struct longer_case {
    int64_t number;
    struct cut cut;
};

/* out has room for `count` cases, which are all cases of the study. */
static int read_cases(struct store *store, int64_t study, struct longer_case *out, size_t count,
                      struct error *err) {
    sqlite3_stmt *row = NULL;
    size_t n = 0;
    int status =
        store_query(store, &row, err,
                    "SELECT number, " CUT_SECONDS ", block FROM study_case c WHERE study_id "
                    "= ? AND parent IS NULL ORDER BY number",
                    "i", study);
    while (status == 0 && n < count && (status = store_step(store, row, err)) == 1) {
        out[n++] = (struct longer_case){sqlite3_column_int64(row, 0), column_cut(row, 1, 2)};
        status = 0;
    }
    if (status == 0)
        sqlite3_reset(row);
    if (status == 0 && n != count)
        return error_set(err, ERROR_SYSTEM, "a study counts %zu cases and has %zu", count, n);
    return status;
}

static int extend_case(struct store *store, int64_t study, const struct longer_case *one,
                       int64_t had, int64_t wanted, struct queued *queued, struct error *err) {
    const struct job_row all = {
        .study = study, .case_number = one->number, .first = had, .count = wanted - had};
    int64_t before = queued->jobs;
    int status = span_insert(store, &all, &one->cut, queued, err);
    return status != 0 ? status
                       : case_add_jobs(store, study, one->number, queued->jobs - before, err);
}

/* had: the realisations that were asked for of each case before. */
static int extend_cases(struct store *store, int64_t study, int64_t had, int64_t wanted,
                        struct queued *queued, struct error *err) {
    int64_t count = 0;
    int status =
        store_integer(store, &count, err, "SELECT cases FROM study WHERE id = ?", "i", study);
    if (status != 0)
        return status;
    struct longer_case *cases = array_create((size_t)count, sizeof *cases);
    if (cases == NULL)
        return error_memory(err, (size_t)count * sizeof *cases, "cases");
    status = read_cases(store, study, cases, (size_t)count, err);
    for (int64_t c = 0; c < count && status == 0; c++)
        status = extend_case(store, study, &cases[c], had, wanted, queued, err);
    free(cases);
    return status;
}

static int extend(struct store *store, int64_t study, int64_t had, int64_t wanted, int64_t *jobs,
                  struct error *err) {
    struct queued queued = {0};
    int64_t again = 0;
    int status = study_retry(store, study, &again, err);
    if (status == 0)
        status = extend_cases(store, study, had, wanted, &queued, err);
    if (status == 0)
        status = study_count_queued(store, study, &queued, err);
    if (status == 0)
        status = store_run(store, err,
                           "UPDATE study SET realisations = ?, state = CASE WHEN jobs_running > 0 "
                           "THEN 'running' ELSE 'queued' END, finished = NULL, revision = revision "
                           "+ 1 WHERE id = ?",
                           "ii", wanted, study);
    if (status == 0)
        status = store_run(store, err,
                           "UPDATE study_source SET source = json_set(source, '$.realisations', "
                           "?) WHERE study_id = ?",
                           "ii", wanted, study);
    if (status == 0)
        status = store_run(store, err,
                           "UPDATE study_source SET seal = seal_of(source) WHERE study_id = ?", "i",
                           study);
    *jobs = again + queued.jobs;
    return status != 0 ? status : study_count_work(store, study, err);
}

/* Fails where the stored results are of another version of the program, or of one that did not
 * record it. Results of both cannot be merged, and what was published would be lost. */
static int check_edition(struct store *store, int64_t study, const char *id, uint64_t edition,
                         struct error *err) {
    bool own = false;
    int status = study_is_own(store, study, edition, &own, err);
    if (status == 0 && !own)
        return error_set(
            err, ERROR_STATE,
            "study %s is of another version of the program whose results may differ from "
            "this one's: submit it anew with more realisations",
            id);
    return status;
}

static int check_extension(const char *id, int64_t had, uint64_t wanted, struct error *err) {
    if (had == 0)
        return error_set(err, ERROR_INPUT,
                         "study %s asks for an error and chooses its realisations itself: submit "
                         "it anew with a smaller error",
                         id);
    if (wanted > STUDY_REALISATIONS_MOST)
        return error_set(err, ERROR_INPUT, "%llu realisations are above the largest number, %d",
                         (unsigned long long)wanted, STUDY_REALISATIONS_MOST);
    if ((int64_t)wanted < had)
        return error_set(err, ERROR_STATE,
                         "study %s has %lld realisations of each case, which %llu would not extend",
                         id, (long long)had, (unsigned long long)wanted);
    return 0;
}

int store_extend(struct store *store, const char *id, uint64_t realisations, uint64_t edition,
                 uint64_t *jobs, struct error *err) {
    int64_t row = 0, had = 0, queued = 0;
    int status = change_begin(store, err);
    if (status != 0)
        return status;
    status = study_row(store, id, &row, err);
    if (status == 0)
        status = store_integer(store, &had, err, "SELECT realisations FROM study WHERE id = ?", "i",
                               row);
    if (status == 0)
        status = check_extension(id, had, realisations, err);
    if (status == 0)
        status = check_edition(store, row, id, edition, err);
    if (status == 0 && (int64_t)realisations > had)
        status = extend(store, row, had, (int64_t)realisations, &queued, err);
    status = change_end(store, status, err);
    if (status == 0)
        *jobs = (uint64_t)queued;
    return status;
}

/* --- blocks of another study --- */

/* Joins studies with the same cases, parameter by parameter: two different studies may have one
 * digest. */
#define SAME_STUDY                                                                                 \
    "FROM study a JOIN study b ON b.digest = a.digest AND b.edition = a.edition AND b.kind = "     \
    "a.kind AND b.seed = a.seed "                                                                  \
    "AND b.random = a.random AND b.cases = a.cases WHERE a.id = ?1 AND b.id <> a.id AND "          \
    "b.realisations < a.realisations AND b.realisations_done > 0 AND NOT EXISTS (SELECT 1 FROM "   \
    "study_case c JOIN study_case d ON d.study_id = b.id AND d.number = c.number WHERE "           \
    "c.study_id = a.id AND d.parameters <> c.parameters)"

static int copy_blocks(struct store *store, int64_t from, int64_t to, struct error *err) {
    int status = store_run(
        store, err,
        "INSERT INTO job (study_id, case_number, first, count, state, attempts, worker, host, "
        "seconds, cpu_seconds, claimed, ended, program) SELECT ?2, j.case_number, j.first, "
        "j.count, "
        "'done', j.attempts, j.worker, j.host, j.seconds, j.cpu_seconds, j.claimed, j.ended, "
        "j.program FROM "
        "job j JOIN study_case c ON c.study_id = j.study_id AND c.number = j.case_number WHERE "
        "j.study_id = ?1 AND j.state = 'done' AND c.publish_error IS NULL ORDER BY j.id",
        "ii", from, to);
    if (status == 0)
        status = store_run(
            store, err,
            "INSERT INTO result (job_id, names_id, scalars, data, seal) SELECT n.id, r.names_id, "
            "r.scalars, r.data, r.seal FROM job n JOIN job j ON j.study_id = ?1 AND j.case_number "
            "= "
            "n.case_number AND j.first = n.first JOIN result r ON r.job_id = j.id WHERE "
            "n.study_id = ?2",
            "ii", from, to);
    return status;
}

static int count_blocks(struct store *store, int64_t study, struct error *err) {
    int status = store_run(
        store, err,
        "UPDATE study_case SET jobs = n, realisations_done = r, seconds = s, cpu_seconds = u, "
        "jobs_without_cpu = w, revision = n FROM (SELECT case_number AS number_of, count(*) AS n, "
        "sum(count) AS r, total(seconds) AS s, total(coalesce(cpu_seconds, seconds)) AS u, "
        "sum(cpu_seconds IS NULL) AS w FROM job WHERE study_id = ?1 GROUP BY case_number) WHERE "
        "study_id = ?1 AND number = number_of",
        "i", study);
    if (status == 0)
        status = store_run(
            store, err,
            "UPDATE study SET jobs = n, jobs_done = n, realisations_done = r, seconds = s, "
            "cpu_seconds = u, jobs_without_cpu = w FROM (SELECT sum(jobs) AS n, "
            "sum(realisations_done) AS r, total(seconds) AS s, total(cpu_seconds) AS u, "
            "sum(jobs_without_cpu) AS w FROM study_case WHERE study_id = ?1) WHERE id = ?1",
            "i", study);
    return status;
}

int study_take_blocks(struct store *store, int64_t study, int64_t *taken, struct error *err) {
    int64_t from = 0;
    *taken = 0;
    int status = store_integer(store, &from, err,
                               "SELECT b.id " SAME_STUDY " ORDER BY b.realisations_done DESC, b.id "
                               "DESC LIMIT 1",
                               "i", study);
    if (status != 0)
        return status == ERROR_ABSENT ? 0 : status;
    status = copy_blocks(store, from, study, err);
    if (status == 0)
        status = count_blocks(store, study, err);
    if (status == 0)
        status = store_integer(store, taken, err,
                               "SELECT realisations_done FROM study WHERE id = ?", "i", study);
    return status;
}
