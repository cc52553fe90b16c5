/* Submission: inserts a study with its cases, their components and their jobs. */
#include "schema/hex.h"
#include "schema/program.h"
#include "schema/result/bytes/bytes.h"
#include "schema/store/store_internal.h"
#include "schema/store/store_seal.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The position of a case in its study. */
struct case_position {
    int64_t row, number; /* of the study, of the case */
    int64_t parent;      /* of a component: its case; else -1 */
    int64_t sequence;    /* of a component */
};

static int insert_component(struct store *store, const struct study_case *one,
                            const struct case_position *position, struct error *err) {
    return store_run(store, err,
                     "UPDATE study_case SET parent = ?, role = ?, sequence = ?, realisations = ? "
                     "WHERE study_id = ? AND number = ?",
                     "itiiii", position->parent, one->role, position->sequence,
                     (int64_t)one->realisations, position->row, position->number);
}

/* Inserts a case without jobs, and hashes its parameters into *digest. */
static int insert_case(struct store *store, const struct study_case *one,
                       const struct case_position *position, uint64_t *digest, struct error *err) {
    char *parameters = json_print(one->parameters);
    if (parameters == NULL)
        return error_memory(err, 0, "the parameters of a case");
    int status = store_run(store, err,
                           "INSERT INTO study_case (study_id, number, parameters, estimate, jobs, "
                           "jobs_left, result_bytes, block) VALUES (?, ?, ?, ?, 0, 0, ?, ?)",
                           "iitddi", position->row, position->number, parameters,
                           one->component_count > 0 ? 0 : one->cost.seconds, one->cost.result_bytes,
                           (int64_t)one->block);
    *digest = hash_bytes(*digest, strlen(parameters) + 1, parameters);
    free(parameters);
    if (status == 0 && position->parent >= 0)
        status = insert_component(store, one, position, err);
    return status;
}

/* Returns the position of a case's component a; *next is the number that it takes. */
static struct case_position component_position(const struct study *study,
                                               const struct case_position *of, size_t a,
                                               int64_t *next) {
    struct case_position position = {of->row, (*next)++, of->number, (int64_t)a};
    if (study->random == RANDOM_INDEPENDENT)
        position.sequence = position.number;
    return position;
}

/* Inserts the cases, and behind them their components. */
static int insert_cases(struct store *store, const struct study *study, int64_t row,
                        uint64_t *digest, struct error *err) {
    int status = 0;
    int64_t next = (int64_t)study->case_count;
    for (size_t c = 0; status == 0 && c < study->case_count; c++) {
        const struct study_case *one = &study->cases[c];
        const struct case_position of = {.row = row, .number = (int64_t)c, .parent = -1};
        status = insert_case(store, one, &of, digest, err);
        for (size_t a = 0; status == 0 && a < one->component_count; a++) {
            const struct case_position position = component_position(study, &of, a, &next);
            status = insert_case(store, &one->components[a], &position, digest, err);
        }
    }
    return status;
}

/* Queues what a case lacks, and counts it there; adds to *queued. */
static int queue_case(struct store *store, const struct study_case *one, int64_t row,
                      int64_t number, struct queued *queued, struct error *err) {
    const struct job_row all = {
        .study = row, .case_number = number, .count = (int64_t)one->realisations};
    const struct cut cut = {one->cost.seconds, one->block};
    int64_t before = queued->jobs;
    int status = spans_insert_missing(store, &all, &cut, queued, err);
    return status != 0 ? status : case_add_jobs(store, row, number, queued->jobs - before, err);
}

/* Queues what the cases lack, in the order of their numbers; components follow their case. */
static int queue_cases(struct store *store, const struct study *study, int64_t row,
                       struct queued *queued, struct error *err) {
    int status = 0;
    int64_t next = (int64_t)study->case_count;
    for (size_t c = 0; status == 0 && c < study->case_count; c++) {
        const struct study_case *one = &study->cases[c];
        if (one->component_count == 0)
            status = queue_case(store, one, row, (int64_t)c, queued, err);
        for (size_t a = 0; status == 0 && a < one->component_count; a++)
            status = queue_case(store, &one->components[a], row, next++, queued, err);
    }
    return status;
}

/* Of owner and key, a text that no other owner has (migrations/020.sql); NULL without a key. */
#define OWNED_KEY "? || char(31) || ?"

static const char *owner_of(const struct study *study) {
    return study->owner != NULL ? study->owner : "";
}

static int insert_row(struct store *store, const struct study *study, const char *key,
                      const char *id, int64_t *row, struct error *err) {
    char seed[24], program[PROGRAM_SIZE];
    const char *owner = owner_of(study);
    const int64_t realisations = (int64_t)study->realisations;
    program_write(program);
    snprintf(seed, sizeof seed, "%llu", (unsigned long long)study->seed);
    int status = store_run(store, err,
                           "INSERT INTO study (public, name, kind, seed, random, realisations, "
                           "asked, submit_key, state, cases, jobs, jobs_waiting, created, program, "
                           "owner, priority) VALUES "
                           "(?, ?, ?, ?, ?, ?, ?, " OWNED_KEY ", 'queued', ?, 0, 0, ?, ?, ?, ?)",
                           "tttttiittittti", id, study->name, study->kind->name, seed,
                           choice_name(STUDY_RANDOM, (int)study->random), realisations,
                           realisations, owner, key, (int64_t)study->case_count, store_time(store),
                           program, owner, study->priority);
    *row = sqlite3_last_insert_rowid(store->db);
    if (status == 0)
        status =
            store_run(store, err, "INSERT OR IGNORE INTO share (owner) VALUES (?)", "t", owner);
    return status != 0 ? status
                       : store_run(store, err,
                                   "INSERT INTO study_source (study_id, source, seal) VALUES (?1, "
                                   "?2, seal_of(?2))",
                                   "it", *row, study->source);
}

static int insert_study(struct store *store, const struct study *study, const char *key,
                        const char *id, struct error *err) {
    int64_t row = 0, taken = 0;
    struct queued queued = {0};
    const bool known = study->edition != 0, shares = known && study->realisations != 0;
    uint64_t digest = HASH_START;
    int status = insert_row(store, study, key, id, &row, err);
    if (status == 0)
        status = insert_cases(store, study, row, &digest, err);
    if (status == 0)
        status = cases_seal(store, row, err);
    if (status == 0 && known)
        status = store_run(store, err, "UPDATE study SET edition = ? WHERE id = ?", "ii",
                           (int64_t)study->edition, row);
    if (status == 0 && shares)
        status = store_run(store, err, "UPDATE study SET digest = ? WHERE id = ?", "ii",
                           (int64_t)digest, row);
    if (status == 0 && shares)
        status = study_take_blocks(store, row, &taken, err);
    if (status == 0)
        status = queue_cases(store, study, row, &queued, err);
    if (status == 0)
        status = study_count_queued(store, row, &queued, err);
    return status != 0 ? status : study_count_work(store, row, err);
}

/* Returns 1 and the id when the key was used for this very study, 0 when it was not used. An
 * extension changes the realisations in the source, but not those that were asked for. */
static int find_key(struct store *store, const struct study *study, const char *key,
                    char id[STUDY_ID_SIZE], struct error *err) {
    if (key == NULL)
        return 0;
    sqlite3_stmt *statement = NULL;
    int status =
        store_query(store, &statement, err,
                    "SELECT public, source IN (?1, json_set(?1, '$.realisations', realisations)) "
                    "AND coalesce(asked = ?4, 1) FROM study JOIN study_source ON study_id = "
                    "study.id WHERE submit_key = ?2 || char(31) || ?3",
                    "ttti", study->source, owner_of(study), key, (int64_t)study->realisations);
    if (status == 0)
        status = store_step(store, statement, err);
    if (status <= 0)
        return status;
    bool same = sqlite3_column_int(statement, 1);
    snprintf(id, STUDY_ID_SIZE, "%s", (const char *)sqlite3_column_text(statement, 0));
    sqlite3_reset(statement);
    if (!same)
        return error_set(err, ERROR_STATE, "the key \"%.60s\" was used for another study", key);
    return 1;
}

int store_submit(struct store *store, const struct study *study, const char *key,
                 char id[STUDY_ID_SIZE], bool *existing, struct error *err) {
    int status = change_begin(store, err);
    if (status != 0)
        return status;
    status = find_key(store, study, key, id, err);
    bool found = status == 1;
    if (status == 0)
        status = hex_random(id, STUDY_ID_SIZE - 1, err);
    if (status == 0)
        status = insert_study(store, study, key, id, err);
    status = change_end(store, found ? 0 : status, err);
    if (status == 0 && existing != NULL)
        *existing = found;
    return status;
}
