/* Blocks: the part of a span that a claim leases, its size, and its counting. */
#include "schema/hex.h"
#include "schema/store/store_internal.h"
#include "schema/store/store_seal.h"
#include "schema/study/study_reader.h"

/* Returns the number of jobs that so many realisations are cut into. */
static int64_t cut_jobs(const struct cut *cut, int64_t realisations) {
    int64_t block = (int64_t)study_block((uint64_t)realisations, cut->seconds, cut->most);
    return (realisations + block - 1) / block;
}

/* The first span of a study that may be claimed. */
struct span {
    int64_t id, count, blocks, attempts, losses;
    struct cut cut;
    double seconds; /* of a realisation, by the clock */
};

/* Reads a span, and fills the job with what is known of its case; the job's count is still that of
 * the whole span. */
static int read_span(struct store *store, const struct found_study *study, struct span *span,
                     struct claimed_job *job, struct error *err) {
    sqlite3_stmt *row = NULL;
    int status = store_query(
        store, &row, err,
        "SELECT j.id, j.case_number, j.first, j.count, j.blocks, j.attempts, j.losses, "
        "c.parameters, c.sequence, " CUT_SECONDS ", c.block, CASE WHEN c.seconds > 0 AND "
        "c.realisations_done > 0 THEN c.seconds / c.realisations_done ELSE c.estimate END, c.seal "
        "IS NULL OR c.seal = " CASE_SEAL_OF(
            "c") " FROM job "
                 "j "
                 "INDEXED BY job_waiting CROSS JOIN study_case c ON c.study_id = j.study_id AND "
                 "c.number = "
                 "j.case_number JOIN study s ON s.id = j.study_id WHERE j.state = 'waiting' AND "
                 "j.study_id = ?1 AND j.not_before <= ?2 ORDER "
                 "BY j.case_number, j.id LIMIT 1",
        "ii", study->id, store_now(store));
    if (status == 0)
        status = store_step(store, row, err);
    if (status <= 0)
        return status != 0
                   ? status
                   : error_set(err, ERROR_SYSTEM, "study %s counts waiting jobs that are not there",
                               job->study);
    *span = (struct span){.id = sqlite3_column_int64(row, 0),
                          .count = sqlite3_column_int64(row, 3),
                          .blocks = sqlite3_column_int64(row, 4),
                          .attempts = sqlite3_column_int64(row, 5),
                          .losses = sqlite3_column_int64(row, 6),
                          .cut = column_cut(row, 9, 10),
                          .seconds = sqlite3_column_double(row, 11)};
    job->case_number = (uint64_t)sqlite3_column_int64(row, 1);
    job->first = (uint64_t)sqlite3_column_int64(row, 2);
    job->attempt = (uint64_t)span->attempts + 1;
    job->lease_ms = store->options.lease_ms;
    job->sequence = sqlite3_column_type(row, 8) != SQLITE_NULL
                        ? (uint64_t)sqlite3_column_int64(row, 8)
                        : study_sequence(study->random, job->case_number);
    status = sqlite3_column_int(row, 12) != 0 ? column_json(row, 7, &job->parameters, err)
                                              : case_damaged(job->study, job->case_number, err);
    sqlite3_reset(row);
    return status;
}

int count_elsewhere(struct store *store, int64_t study, int64_t enough, int64_t *jobs,
                    struct error *err) {
    enum { STUDIES_MOST = 256 };
    return store_integer(store, jobs, err,
                         "SELECT coalesce(sum(jobs_waiting), 0) FROM (SELECT jobs_waiting FROM "
                         "study INDEXED BY study_line WHERE state IN ('queued', 'running') AND "
                         "jobs_waiting > 0 AND id <> ?1 LIMIT ?2)",
                         "ii", study, enough < STUDIES_MOST ? enough : (int64_t)STUDIES_MOST);
}

/* Where fewer jobs wait than threads that may ask for them, each thread gets a share of the
 * realisations. Threads that other studies have jobs for are not counted. */
static int choose_block(struct store *store, struct claiming *claiming,
                        const struct found_study *study, const struct span *span, uint64_t *block,
                        struct error *err) {
    int status = 0;
    *block = study_block((uint64_t)span->count, span->cut.seconds, span->cut.most);
    if (study->jobs_waiting >= claiming->threads)
        return 0;
    if (claiming->elsewhere < 0)
        status = count_elsewhere(store, study->id, claiming->threads, &claiming->elsewhere, err);
    int64_t hungry = claiming->threads - claiming->elsewhere;
    if (status == 0 && study->jobs_waiting < hungry)
        *block = study_share(*block, span->cut.seconds, (uint64_t)study->realisations_waiting,
                             (uint64_t)hungry);
    return status;
}

/* Leases the whole span. */
static int lease_whole(struct store *store, const struct claim *claim, const struct span *span,
                       struct claimed_job *job, const unsigned char *digest, struct error *err) {
    job->id = span->id;
    return store_run(
        store, err,
        "UPDATE job SET state = 'running', blocks = 1, attempts = attempts + 1, token = ?, worker "
        "= ?, host = ?, program = ?, claimed_ms = ?5, lease_until = ?5 + ?6, reported = 0, "
        "reported_ms = 0, claimed = ?7 WHERE id = ?8",
        "btttiiti", (const void *)digest, (size_t)DIGEST_SIZE, claim->worker, claim->host,
        claim->program, store_now(store), store->options.lease_ms, store_time(store), span->id);
}

/* Leases the front of a span: the rest keeps its number, and counts as `blocks` jobs. */
static int lease_front(struct store *store, const struct claim *claim, int64_t study,
                       const struct span *span, int64_t blocks, struct claimed_job *job,
                       const unsigned char *digest, struct error *err) {
    int status = store_run(store, err,
                           "UPDATE job SET first = first + ?1, count = count - ?1, blocks = ?2 "
                           "WHERE id = ?3",
                           "iii", (int64_t)job->count, blocks, span->id);
    if (status == 0)
        status = store_run(
            store, err,
            "INSERT INTO job (study_id, case_number, first, count, state, attempts, losses, token, "
            "worker, host, program, claimed_ms, lease_until, claimed) VALUES (?1, ?2, ?3, ?4, "
            "'running', ?5, ?6, ?7, ?8, ?9, ?10, ?11, ?11 + ?12, ?13)",
            "iiiiiibtttiit", study, (int64_t)job->case_number, (int64_t)job->first,
            (int64_t)job->count, (int64_t)job->attempt, span->losses, (const void *)digest,
            (size_t)DIGEST_SIZE, claim->worker, claim->host, claim->program, store_now(store),
            store->options.lease_ms, store_time(store));
    job->id = sqlite3_last_insert_rowid(store->db);
    return status;
}

/* Moves the clock of the study's owner on. Jobs that take no time count a little, so that their
 * owners take turns, too. */
static int count_share(struct store *store, const struct found_study *study, double seconds,
                       struct error *err) {
    static const double LEAST = 1e-3;
    return store_run(store, err,
                     "UPDATE share SET begun = start, served = start + ?1 / weight FROM (SELECT "
                     "max(served, (SELECT max(begun) FROM share)) AS start FROM share WHERE owner "
                     "= ?2) WHERE owner = ?2",
                     "dt", seconds > LEAST ? seconds : LEAST, study->owner);
}

/* Counts a claim. The state changes with the first claim alone, as it is indexed. blocks: number of
 * queued jobs that were cut short. */
static int count_claim(struct store *store, const struct found_study *study,
                       const struct claimed_job *job, int64_t blocks, struct error *err) {
    int status = store_run(store, err,
                           "UPDATE study SET jobs = jobs + 1 - ?1, jobs_waiting = jobs_waiting - "
                           "?1, jobs_running = jobs_running + 1, realisations_waiting = "
                           "realisations_waiting - ?2, revision = revision + 1 WHERE id = ?3",
                           "iii", blocks, (int64_t)job->count, study->id);
    if (status == 0 && study->queued)
        status = store_run(store, err, "UPDATE study SET state = 'running' WHERE id = ?", "i",
                           study->id);
    return status != 0
               ? status
               : case_add_jobs(store, study->id, (int64_t)job->case_number, 1 - blocks, err);
}

/* Fails what waits of a damaged case as one job, so that it does not block others. */
static int fail_damaged(struct store *store, const struct claimed_job *job,
                        const struct error *damage, struct error *err) {
    struct job_row row;
    int status = job_read(store, job->id, job->token, &row, err);
    if (status == 0)
        status = job_fail(store, &row, damage->text, err);
    store->claim_failed_jobs = true;
    return status != 0 ? status : 1;
}

int block_lease(struct store *store, struct claiming *claiming, const struct found_study *study,
                struct claimed_job *job, struct error *err) {
    unsigned char digest[DIGEST_SIZE];
    struct error damage = {0};
    struct span span = {0};
    int status = read_span(store, study, &span, job, &damage);
    bool damaged = status == ERROR_INPUT;
    if (damaged) {
        job->count = (uint64_t)span.count;
        status = 0;
    } else if (status != 0) {
        return error_set(err, status, "%s", damage.text);
    }
    if (!damaged)
        status = choose_block(store, claiming, study, &span, &job->count, err);
    if (status == 0)
        status = hex_random(job->token, TOKEN_SIZE - 1, err);
    if (status != 0)
        return status;
    digest_text(job->token, digest);
    int64_t rest = span.count - (int64_t)job->count;
    int64_t blocks = rest > 0 ? cut_jobs(&span.cut, rest) : 0;
    status = rest > 0
                 ? lease_front(store, claiming->claim, study->id, &span, blocks, job, digest, err)
                 : lease_whole(store, claiming->claim, &span, job, digest, err);
    if (status == 0)
        status = count_claim(store, study, job, span.blocks - blocks, err);
    if (status == 0 && damaged)
        return fail_damaged(store, job, &damage, err);
    claiming->seconds += span.cut.seconds * (double)job->count;
    return status != 0 ? status : count_share(store, study, span.seconds * (double)job->count, err);
}

/* Spans: realisations of a case that wait as one row, until claims cut blocks off them. */

struct cut column_cut(sqlite3_stmt *row, int seconds, int most) {
    static const struct study_cost ANY = {0};
    struct cut cut = {sqlite3_column_double(row, seconds), study_block_most(&ANY)};
    if (sqlite3_column_int64(row, most) > 0)
        cut.most = (uint64_t)sqlite3_column_int64(row, most);
    return cut;
}

int span_insert(struct store *store, const struct job_row *all, const struct cut *cut,
                struct queued *queued, struct error *err) {
    int64_t jobs = cut_jobs(cut, all->count);
    if (all->count == 0)
        return 0;
    queued->jobs += jobs;
    queued->realisations += all->count;
    return store_run(store, err,
                     "INSERT INTO job (study_id, case_number, first, count, blocks, attempts, "
                     "losses) VALUES (?, ?, ?, ?, ?, ?, ?)",
                     "iiiiiii", all->study, all->case_number, all->first, all->count, jobs,
                     all->attempts, all->losses);
}

/* Finds the first realisation from `at` on that a job has, or `end`; *behind: the first one behind
 * that job. */
static int next_job(struct store *store, const struct job_row *all, int64_t at, int64_t end,
                    int64_t *first, int64_t *behind, struct error *err) {
    sqlite3_stmt *row = NULL;
    int status = store_query(store, &row, err,
                             "SELECT first, first + count FROM job WHERE study_id = ?1 AND "
                             "case_number = ?2 AND first >= ?3 ORDER BY first LIMIT 1",
                             "iii", all->study, all->case_number, at);
    *first = *behind = end;
    if (status == 0)
        status = store_step(store, row, err);
    if (status <= 0)
        return status;
    *first = sqlite3_column_int64(row, 0);
    *behind = sqlite3_column_int64(row, 1);
    sqlite3_reset(row);
    return 0;
}

int spans_insert_missing(struct store *store, const struct job_row *all, const struct cut *cut,
                         struct queued *queued, struct error *err) {
    int64_t at = all->first, end = all->first + all->count, first = 0;
    int status = 0;
    while (status == 0 && at < end) {
        struct job_row gap = *all;
        gap.first = at;
        status = next_job(store, all, at, end, &first, &at, err);
        gap.count = (first < end ? first : end) - gap.first;
        if (status == 0)
            status = span_insert(store, &gap, cut, queued, err);
    }
    return status;
}

int study_count_queued(struct store *store, int64_t study, const struct queued *queued,
                       struct error *err) {
    return store_run(store, err,
                     "UPDATE study SET jobs = jobs + ?1, jobs_waiting = jobs_waiting + ?1, "
                     "realisations_waiting = realisations_waiting + ?2 WHERE id = ?3",
                     "iii", queued->jobs, queued->realisations, study);
}

int case_add_jobs(struct store *store, int64_t study, int64_t case_number, int64_t jobs,
                  struct error *err) {
    if (jobs == 0)
        return 0;
    return store_run(store, err,
                     "UPDATE study_case SET jobs = jobs + ?3, jobs_left = jobs_left + ?3 WHERE "
                     "study_id = ?1 AND number IN (?2, " CASE_PARENT ")",
                     "iii", study, case_number, jobs);
}
