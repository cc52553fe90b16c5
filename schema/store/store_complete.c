/* Completion: a result is stored once. */
#include "schema/store/store_internal.h"
#include "schema/store/store_seal.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* --- texts --- */

enum { NUMBER_MOST = 25 }; /* "-1.2345678901234567e-308," */

/* Writes the fewest digits, 15 or more, that read back to the same double; null where it is not
 * finite. Half of all numbers take 17 and most others 16. strfromd() takes two thirds of what
 * snprintf() does, which a library behind LAPACK slows down by a format of its own. */
static char *put_number(char *at, double value) {
    char fewer[NUMBER_MOST + 1];
    if (!isfinite(value))
        return at + snprintf(at, NUMBER_MOST + 1, "null");
    int length = strfromd(at, NUMBER_MOST + 1, "%.16g", value);
    if (strtod(at, NULL) != value)
        return at + strfromd(at, NUMBER_MOST + 1, "%.17g", value);
    int shorter = strfromd(fewer, sizeof fewer, "%.15g", value);
    if (strtod(fewer, NULL) != value)
        return at + length;
    memcpy(at, fewer, (size_t)shorter + 1);
    return at + shorter;
}

/* Makes the scalars as JSON rows without a tree, which took longer than the rest of a
 * completion. */
static char *scalars_text(const struct block_result *result) {
    size_t width = result->scalar_count;
    if (width > SIZE_MAX / NUMBER_MOST - 1)
        return NULL;
    char *text = array_create((size_t)result->count + 1, width * NUMBER_MOST + 4), *at = text;
    if (text == NULL)
        return NULL;
    *at++ = '[';
    for (uint64_t r = 0; r < result->count; r++) {
        *at++ = '[';
        for (size_t s = 0; s < width; s++) {
            at = put_number(at, result->scalars[r * width + s]);
            *at++ = ',';
        }
        at -= width > 0; /* the last comma */
        *at++ = ']';
        *at++ = ',';
    }
    at -= result->count > 0;
    *at++ = ']';
    *at = 0;
    return text;
}

static char *names_text(const struct block_result *result) {
    cJSON *names = cJSON_CreateStringArray(result->names, (int)result->scalar_count);
    char *text = names != NULL ? json_print(names) : NULL;
    cJSON_Delete(names);
    return text;
}

int block_text_create(struct block_text *out, const struct block_result *result,
                      struct error *err) {
    struct block_text text = {.names = names_text(result), .scalars = scalars_text(result)};
    struct block_result stored = *result;
    int status = text.names != NULL && text.scalars != NULL
                     ? bytes_pack(&text.data, result->data, result->size, PACKED_LEAST, err)
                     : error_memory(err, result->size, "a result");
    if (status != 0) {
        block_text_clear(&text);
        return status;
    }
    stored.data = text.data.data;
    stored.size = text.data.size;
    text.seal = block_seal(&stored, text.names, text.scalars);
    *out = text;
    return 0;
}

void block_text_clear(struct block_text *text) {
    free(text->names);
    free(text->scalars);
    packed_bytes_clear(&text->data);
    *text = (struct block_text){0};
}

/* --- the change --- */

/* Finds or inserts the row of this list of names, which most jobs share. */
static int names_row(struct store *store, const char *names, int64_t *id, struct error *err) {
    int status =
        store_integer(store, id, err, "SELECT id FROM scalar_names WHERE names = ?", "t", names);
    if (status != ERROR_ABSENT)
        return status;
    status = store_run(store, err, "INSERT INTO scalar_names (names) VALUES (?)", "t", names);
    *id = sqlite3_last_insert_rowid(store->db);
    return status;
}

static int insert_result(struct store *store, const struct job_row *job,
                         const struct block_text *text, struct error *err) {
    int64_t names = 0;
    int status = names_row(store, text->names, &names, err);
    if (status == 0)
        status = store_run(
            store, err,
            "INSERT INTO result (job_id, names_id, scalars, data, seal) VALUES (?, ?, ?, ?, ?)",
            "iitbi", job->id, names, text->scalars, (const void *)text->data.data, text->data.size,
            text->seal);
    return status;
}

/* Reads how many jobs of the case have not ended. */
static int read_left(struct store *store, const struct job_row *job, int64_t *left,
                     struct error *err) {
    int status = store_integer(store, left, err,
                               "SELECT jobs_left FROM study_case WHERE study_id = ? AND number = ?",
                               "ii", job->study, job->case_number);
    if (status == ERROR_ABSENT)
        return error_set(err, ERROR_SYSTEM, "job %lld has no case", (long long)job->id);
    return status;
}

static int read_cut(struct store *store, const struct job_row *job, struct cut *cut,
                    struct error *err) {
    sqlite3_stmt *row = NULL;
    int status = store_query(store, &row, err,
                             "SELECT " CUT_SECONDS
                             ", block FROM study_case c WHERE study_id = ? AND number = ?",
                             "ii", job->study, job->case_number);
    if (status == 0)
        status = store_step(store, row, err);
    if (status <= 0)
        return status;
    *cut = column_cut(row, 0, 1);
    sqlite3_reset(row);
    return 0;
}

/* Queries after each update, as RETURNING makes a table for its row each time. */
static int count_completion(struct store *store, const struct job_row *job,
                            const struct block_result *result, int64_t *left, struct error *err) {
    bool without = isnan(result->cpu_seconds);
    double seconds = result->seconds, cpu_seconds = without ? seconds : result->cpu_seconds;
    int64_t undone = 1;
    int status = store_run(
        store, err,
        "UPDATE study_case SET jobs_left = jobs_left - 1, realisations_done = realisations_done "
        "+ ?3, seconds = seconds + ?4, cpu_seconds = cpu_seconds + ?5, jobs_without_cpu = "
        "jobs_without_cpu + ?6, revision = revision + 1, settled = CASE WHEN parent IS NULL "
        "THEN settled ELSE revision + 1 END WHERE study_id = ?1 AND number IN (?2, " CASE_PARENT
        ")",
        "iiiddi", job->study, job->case_number, (int64_t)result->count, seconds, cpu_seconds,
        (int64_t)without);
    if (status == 0)
        status = store_run(
            store, err,
            "UPDATE study SET jobs_running = jobs_running - 1, jobs_done = jobs_done + 1, "
            "realisations_done = realisations_done + ?, seconds = seconds + ?, cpu_seconds = "
            "cpu_seconds + ?, jobs_without_cpu = jobs_without_cpu + ?, revision = revision + 1 "
            "WHERE id = ?",
            "iddii", (int64_t)result->count, seconds, cpu_seconds, (int64_t)without, job->study);
    if (status == 0)
        status = read_left(store, job, left, err);
    if (status == 0 && *left == 0) /* else something of the study is left, too */
        status = store_integer(store, &undone, err,
                               "SELECT jobs_waiting + jobs_running FROM study WHERE id = ?", "i",
                               job->study);
    return status == 0 && undone == 0 ? study_settle(store, job->study, err) : status;
}

/* Queues the rest of a partial result again, as if it had never been leased. */
static int queue_rest(struct store *store, const struct job_row *job,
                      const struct block_result *result, struct error *err) {
    struct job_row rest = *job;
    struct queued queued = {0};
    struct cut cut = {0};
    rest.first += (int64_t)result->count;
    rest.count -= (int64_t)result->count;
    rest.attempts--;
    int status = read_cut(store, job, &cut, err);
    if (status == 0)
        status = span_insert(store, &rest, &cut, &queued, err);
    if (status == 0)
        status = study_count_queued(store, job->study, &queued, err);
    if (status == 0)
        status = case_add_jobs(store, job->study, job->case_number, queued.jobs, err);
    return status != 0 ? status
                       : store_run(store, err, "UPDATE job SET count = ? WHERE id = ?", "ii",
                                   (int64_t)result->count, job->id);
}

static int job_complete(struct store *store, const struct job_row *job,
                        const struct block_result *result, const struct block_text *text,
                        int64_t *left, struct error *err) {
    int status = insert_result(store, job, text, err);
    if (status == 0 && (int64_t)result->count < job->count)
        status = queue_rest(store, job, result, err);
    if (status == 0)
        status = store_run(
            store, err,
            "UPDATE job SET state = 'done', reported = 0, seconds = ?, cpu_seconds = ?, ended = ? "
            "WHERE id = ?",
            "ddti", result->seconds, result->cpu_seconds, store_time(store), job->id);
    return status != 0 ? status : count_completion(store, job, result, left, err);
}

/* Checks that a result has the first realisations of the job; of a job that is done, all of
 * them. */
static int check_block(const struct job_row *job, const struct block_result *result,
                       struct error *err) {
    uint64_t count = (uint64_t)job->count;
    bool part = !job->done && result->count > 0 && result->count < count;
    if (result->first == (uint64_t)job->first && (result->count == count || part))
        return 0;
    return error_set(err, ERROR_INPUT,
                     "a result of %llu realisations from %llu; job %lld is %lld from %lld",
                     (unsigned long long)result->count, (unsigned long long)result->first,
                     (long long)job->id, (long long)job->count, (long long)job->first);
}

/* Completes within a change. *again: it was completed before, under this token. */
static int complete(struct store *store, int64_t id, const char *token,
                    const struct block_result *result, const struct block_text *text, bool *again,
                    int64_t *left, struct error *err) {
    struct job_row job;
    int status = job_read(store, id, token, &job, err);
    if (status != 0)
        return status;
    *again = job.done && job.owned;
    if (!*again)
        status = job_check_lease(&job, err);
    if (status == 0)
        status = check_block(&job, result, err);
    if (status != 0)
        return status;
    if (!*again)
        return job_complete(store, &job, result, text, left, err);
    return read_left(store, &job, left, err);
}

int store_complete(struct store *store, int64_t job, const char *token,
                   const struct block_result *result, bool *first_time, bool *case_done,
                   struct error *err) {
    struct block_text made = {0};
    const struct block_text *text = result->text != NULL ? result->text : &made;
    int64_t left = 0;
    bool again = false;
    int status = result->text != NULL ? 0 : block_text_create(&made, result, err);
    if (status == 0 && (status = change_begin(store, err)) == 0) {
        status = complete(store, job, token, result, text, &again, &left, err);
        status = change_end(store, status, err);
    }
    block_text_clear(&made);
    if (status == 0) {
        *first_time = !again;
        *case_done = left == 0;
    }
    return status;
}
