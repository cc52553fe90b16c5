/* Cases that ask for an error: their components, and the rounds in which these grow. */
#include "schema/store/store_internal.h"
#include <math.h>
#include <stdlib.h>

void components_free(struct component *components, size_t count) {
    for (size_t a = 0; components != NULL && a < count; a++)
        free(components[a].role);
    free(components);
}

/* Appends a component. It is counted before it is complete, so that the list is freed with it. */
static int append(sqlite3_stmt *row, struct component **list, size_t *count, struct error *err) {
    struct component *larger = realloc(*list, (*count + 1) * sizeof *larger);
    if (larger == NULL)
        return error_memory(err, (*count + 1) * sizeof *larger, "components");
    *list = larger;
    larger[*count] = (struct component){.number = (uint64_t)sqlite3_column_int64(row, 0),
                                        .role = column_copy(row, 1),
                                        .realisations = (uint64_t)sqlite3_column_int64(row, 2),
                                        .cost = {.seconds = sqlite3_column_double(row, 3),
                                                 .result_bytes = sqlite3_column_double(row, 4)},
                                        .block = column_cut(row, 3, 5).most};
    return larger[(*count)++].role != NULL ? 0 : error_memory(err, 0, "a component's role");
}

static int read_components(struct store *store, int64_t study, uint64_t case_number,
                           struct component **out, size_t *count, struct error *err) {
    sqlite3_stmt *row = NULL;
    struct component *list = NULL;
    size_t n = 0;
    int status = store_query(
        store, &row, err,
        "SELECT number, role, realisations, estimate, result_bytes, block FROM study_case WHERE "
        "study_id = ? AND parent = ? ORDER BY number",
        "ii", study, (int64_t)case_number);
    while (status == 0 && (status = store_step(store, row, err)) == 1) {
        status = append(row, &list, &n, err);
        if (status != 0)
            sqlite3_reset(row);
    }
    if (status != 0) {
        components_free(list, n);
        return status;
    }
    *out = list;
    *count = n;
    return 0;
}

int store_components(struct store *store, const char *study, uint64_t case_number,
                     struct component **out, size_t *count, struct error *err) {
    int64_t row = 0;
    int status = study_row(store, study, &row, err);
    return status != 0 ? status : read_components(store, row, case_number, out, count, err);
}

/* --- a round --- */

/* Queues the realisations that a component lacks; adds to *queued. */
static int grow_component(struct store *store, int64_t study, const struct component *component,
                          uint64_t wanted, struct queued *queued, struct error *err) {
    if (wanted <= component->realisations)
        return 0;
    const struct job_row all = {.study = study,
                                .case_number = (int64_t)component->number,
                                .first = (int64_t)component->realisations,
                                .count = (int64_t)(wanted - component->realisations)};
    const struct cut cut = {component->cost.seconds, component->block};
    int64_t before = queued->jobs;
    int status = span_insert(store, &all, &cut, queued, err);
    if (status == 0)
        status = store_run(store, err,
                           "UPDATE study_case SET realisations = ? WHERE study_id = ? AND number "
                           "= ?",
                           "iii", (int64_t)wanted, study, all.case_number);
    return status != 0 ? status
                       : case_add_jobs(store, study, all.case_number, queued->jobs - before, err);
}

static int grow(struct store *store, int64_t study, uint64_t case_number,
                const struct next_round *next, struct error *err) {
    struct component *components = NULL;
    struct queued queued = {0};
    size_t count = 0;
    int status = read_components(store, study, case_number, &components, &count, err);
    for (size_t a = 0; a < count && status == 0; a++)
        status = grow_component(store, study, &components[a], next->wanted[a], &queued, err);
    components_free(components, count);
    if (status == 0)
        status = store_run(
            store, err, "UPDATE study_case SET error_reached = ? WHERE study_id = ? AND number = ?",
            "dii", next->error_reached, study, (int64_t)case_number);
    if (status == 0)
        status = study_count_queued(store, study, &queued, err);
    if (status == 0)
        status = store_run(store, err, "UPDATE study SET revision = revision + 1 WHERE id = ?", "i",
                           study);
    return status != 0 ? status : study_count_work(store, study, err);
}

int store_grow(struct store *store, const char *study, uint64_t case_number,
               const struct next_round *next, bool *grown, struct error *err) {
    int64_t row = 0, current = 0;
    int status = change_begin(store, err);
    if (status != 0)
        return status;
    status = study_row(store, study, &row, err);
    if (status == 0)
        status = store_integer(store, &current, err,
                               "SELECT c.jobs_left = 0 AND c.revision = ? AND s.state = 'running' "
                               "FROM study_case c JOIN study s ON s.id = c.study_id WHERE s.id = "
                               "? AND c.number = ?",
                               "iii", (int64_t)next->revision, row, (int64_t)case_number);
    if (status == 0 && current != 0)
        status = grow(store, row, case_number, next, err);
    int64_t left = 0;
    if (status == 0)
        status = store_integer(store, &left, err,
                               "SELECT jobs_left > 0 FROM study_case WHERE study_id = ? AND "
                               "number = ?",
                               "ii", row, (int64_t)case_number);
    status = change_end(store, status, err);
    if (status == 0)
        *grown = left != 0;
    return status;
}
