/* Spans: realisations of a case that wait as one row, until claims cut blocks off them. */
#include "schema/store/store_internal.h"
#include "schema/study/study_reader.h"

struct cut column_cut(sqlite3_stmt *row, int seconds, int most) {
    static const struct study_cost ANY = {0};
    struct cut cut = {sqlite3_column_double(row, seconds), study_block_most(&ANY)};
    if (sqlite3_column_int64(row, most) > 0)
        cut.most = (uint64_t)sqlite3_column_int64(row, most);
    return cut;
}

int64_t cut_jobs(const struct cut *cut, int64_t realisations) {
    int64_t block = (int64_t)study_block((uint64_t)realisations, cut->seconds, cut->most);
    return (realisations + block - 1) / block;
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

/* The first realisation from `at` on that a job has, or `end`; *behind: the one behind that job. */
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
