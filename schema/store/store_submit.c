/* Submission: a study with its cases, what these are made of, and their jobs. */
#include "schema/program.h"
#include "schema/store/store_internal.h"
#include <stdio.h>
#include <stdlib.h>

/* Where a case stands in its study. */
struct case_place {
    int64_t row, number; /* of the study, of the case */
    int64_t parent;      /* of a component: its case; else -1 */
    int64_t sequence;    /* of a component */
};

static uint64_t blocks_of(const struct study_case *one) {
    return (one->realisations + one->block - 1) / one->block;
}

int jobs_insert(struct store *store, const struct job_row *all, int64_t block, struct error *err) {
    int status = 0;
    for (int64_t done = 0; status == 0 && done < all->count; done += block)
        status = store_run(
            store, err, "INSERT INTO job (study_id, case_number, first, count) VALUES (?, ?, ?, ?)",
            "iiii", all->study, all->case_number, all->first + done,
            all->count - done < block ? all->count - done : block);
    return status;
}

static int insert_component(struct store *store, const struct study_case *one,
                            const struct case_place *place, struct error *err) {
    return store_run(store, err,
                     "UPDATE study_case SET parent = ?, role = ?, sequence = ?, realisations = ?, "
                     "result_bytes = ? WHERE study_id = ? AND number = ?",
                     "itiidii", place->parent, one->role, place->sequence,
                     (int64_t)one->realisations, one->cost.result_bytes, place->row, place->number);
}

/* blocks: jobs of the case, or of its components. */
static int insert_case(struct store *store, const struct study_case *one,
                       const struct case_place *place, int64_t blocks, struct error *err) {
    struct job_row all = {
        .study = place->row, .case_number = place->number, .count = (int64_t)one->realisations};
    char *parameters = json_print(one->parameters);
    if (parameters == NULL)
        return error_memory(err, 0, "the parameters of a case");
    int status = store_run(store, err,
                           "INSERT INTO study_case (study_id, number, parameters, estimate, jobs, "
                           "jobs_left) VALUES (?, ?, ?, ?, ?, ?)",
                           "iitdii", place->row, place->number, parameters,
                           one->component_count > 0 ? 0 : one->cost.seconds, blocks, blocks);
    free(parameters);
    if (status == 0 && place->parent >= 0)
        status = insert_component(store, one, place, err);
    return status != 0 ? status : jobs_insert(store, &all, (int64_t)one->block, err);
}

static uint64_t jobs_of(const struct study_case *one) {
    uint64_t jobs = one->component_count > 0 ? 0 : blocks_of(one);
    for (size_t a = 0; a < one->component_count; a++)
        jobs += blocks_of(&one->components[a]);
    return jobs;
}

/* The cases, and behind them their components. */
static int insert_cases(struct store *store, const struct study *study, int64_t row,
                        struct error *err) {
    int status = 0;
    int64_t next = (int64_t)study->case_count;
    for (size_t c = 0; status == 0 && c < study->case_count; c++) {
        const struct study_case *one = &study->cases[c];
        struct case_place place = {.row = row, .number = (int64_t)c, .parent = -1};
        status = insert_case(store, one, &place, (int64_t)jobs_of(one), err);
        for (size_t a = 0; status == 0 && a < one->component_count; a++) {
            place = (struct case_place){row, next++, (int64_t)c, (int64_t)a};
            if (study->random == RANDOM_INDEPENDENT)
                place.sequence = place.number;
            status = insert_case(store, &one->components[a], &place,
                                 (int64_t)blocks_of(&one->components[a]), err);
        }
    }
    return status;
}

static int insert_study(struct store *store, const struct study *study, const char *key,
                        const char *id, struct error *err) {
    uint64_t jobs = 0;
    for (size_t c = 0; c < study->case_count; c++)
        jobs += jobs_of(&study->cases[c]);
    char seed[24], program[PROGRAM_SIZE];
    program_write(program);
    snprintf(seed, sizeof seed, "%llu", (unsigned long long)study->seed);
    int status = store_run(store, err,
                           "INSERT INTO study (public, name, kind, seed, random, realisations, "
                           "submit_key, state, cases, jobs, jobs_waiting, created, program) VALUES "
                           "(?, ?, ?, ?, ?, ?, ?, 'queued', ?, ?, ?, ?, ?)",
                           "tttttitiiitt", id, study->name, study->kind->name, seed,
                           choice_name(STUDY_RANDOM, (int)study->random),
                           (int64_t)study->realisations, key, (int64_t)study->case_count,
                           (int64_t)jobs, (int64_t)jobs, store_time(store), program);
    int64_t row = sqlite3_last_insert_rowid(store->db);
    if (status == 0)
        status = store_run(store, err, "INSERT INTO study_source (study_id, source) VALUES (?, ?)",
                           "it", row, study->source);
    return status != 0 ? status : insert_cases(store, study, row, err);
}

/* 1 and the id when the key was used for this very study, 0 when it was not used. */
static int find_key(struct store *store, const struct study *study, const char *key,
                    char id[STUDY_ID_SIZE], struct error *err) {
    if (key == NULL)
        return 0;
    sqlite3_stmt *statement = NULL;
    int status = store_query(store, &statement, err,
                             "SELECT public, source = ? FROM study JOIN study_source ON "
                             "study_id = study.id WHERE submit_key = ?",
                             "tt", study->source, key);
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
        status = random_text(id, STUDY_ID_SIZE - 1, err);
    if (status == 0)
        status = insert_study(store, study, key, id, err);
    status = change_end(store, found ? 0 : status, err);
    if (status == 0 && existing != NULL)
        *existing = found;
    return status;
}
