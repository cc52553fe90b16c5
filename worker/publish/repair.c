#include "jobs/kind.h"
#include "worker/publish/publish.h"
#include "worker/publish/verify.h"
#include <stdlib.h>
#include <string.h>

enum { PASSES_MOST = 6 }; /* a repair may uncover further faults */

struct found_flaw {
    struct flaw flaw;
    struct found_flaw *next;
};

/* The faults that a pass found. */
struct flaws {
    const struct verification *verification; /* reports each; NULL: none is reported */
    struct found_flaw *first, **last;
    uint64_t of[FLAW_KINDS];
};

static int keep_flaw(void *context, const struct flaw *flaw, struct error *err) {
    struct flaws *flaws = context;
    struct found_flaw *found = array_create(1, sizeof *found);
    if (found == NULL)
        return error_memory(err, sizeof *found, "what was found");
    found->flaw = *flaw;
    found->flaw.text = NULL;
    *flaws->last = found;
    flaws->last = &found->next;
    flaws->of[flaw->kind]++;
    return flaws->verification != NULL
               ? flaws->verification->found(flaws->verification->context, flaw, err)
               : 0;
}

static int keep_progress(void *context, const char *what, uint64_t done) {
    const struct flaws *flaws = context;
    const struct verification *verification = flaws->verification;
    return verification != NULL && verification->progress != NULL
               ? verification->progress(verification->context, what, done)
               : 0;
}

static void flaws_clear(struct flaws *flaws) {
    while (flaws->first != NULL) {
        struct found_flaw *gone = flaws->first;
        flaws->first = gone->next;
        free(gone);
    }
}

/* Finds the faults; the caller clears them, also after a failure. */
static int look(struct store *store, struct flaws *flaws, struct verify_report *report,
                struct error *err) {
    const struct verification verification = {keep_flaw, keep_progress, flaws};
    flaws->last = &flaws->first;
    return verify_store(store, &verification, false, report, err);
}

/* --- parameters --- */

/* Returns the parameters of a case. Components are numbered behind all cases that were asked
 * for. */
static const cJSON *case_parameters(const struct study *study, uint64_t number) {
    uint64_t next = study->case_count;
    if (number < study->case_count)
        return study->cases[number].parameters;
    for (size_t c = 0; c < study->case_count; c++)
        for (size_t a = 0; a < study->cases[c].component_count; a++)
            if (next++ == number)
                return study->cases[c].components[a].parameters;
    return NULL;
}

/* Restores what a case is computed from by the document of the study. */
static int repair_case(struct store *store, const struct flaw *flaw, bool *repaired,
                       struct error *err) {
    struct study *study = NULL;
    struct fault_list faults = {0};
    struct error reason = {0};
    cJSON *document = NULL;
    char *text = NULL, *parameters = NULL;
    int status = store_document(store, flaw->study, &document, &reason);
    if (status == 0 && (text = json_print(document)) != NULL)
        status = kind_read_study(&study, text, strlen(text), NULL, &faults, &reason);
    const cJSON *found = study != NULL ? case_parameters(study, (uint64_t)flaw->case_number) : NULL;
    if (found != NULL && (parameters = json_print(found)) != NULL) {
        const struct case_origin origin = {study->kind->name, parameters, study->random,
                                           study->seed};
        status = store_repair_case(store, flaw->study, (uint64_t)flaw->case_number, &origin,
                                   repaired, err);
    } else {
        status = status == ERROR_MEMORY ? error_set(err, status, "%s", reason.text) : 0;
    }
    free(text);
    free(parameters);
    cJSON_Delete(document);
    fault_list_clear(&faults);
    study_destroy(&study);
    return status;
}

/* --- blocks --- */

static int drop_block(struct store *store, const struct flaw *flaw, uint64_t *dropped,
                      struct error *err) {
    struct study_status about = {0};
    int status = store_status_counted(store, flaw->study, &about, err);
    const struct job_kind *kind = status == 0 ? kind_find(about.kind) : NULL;
    study_status_clear(&about);
    return status != 0
               ? status
               : store_drop_blocks(store, flaw->study, (uint64_t)flaw->case_number, flaw->job,
                                   kind != NULL ? kind_edition(kind) : 0, dropped, err);
}

static int repair_flaw(struct store *store, const struct flaw *flaw, struct repair_report *report,
                       struct error *err) {
    bool repaired = false;
    int status = 0;
    switch (flaw->kind) {
    case FLAW_CASE:
        status = repair_case(store, flaw, &repaired, err);
        report->cases += repaired;
        return status;
    case FLAW_BLOCK:
        return drop_block(store, flaw, &report->blocks, err);
    case FLAW_PUBLISHED:
        report->published++;
        return store_drop_published(store, flaw->study, (uint64_t)flaw->case_number, err);
    default:
        report->counters += flaw->kind == FLAW_COVER || flaw->kind == FLAW_COUNTER;
        return 0;
    }
}

/* Repairs the structure of a file alone where it is damaged, as other faults may follow from it. */
static int repair_all(struct store *store, const struct flaws *flaws, struct repair_report *report,
                      struct error *err) {
    int status = 0;
    if (flaws->of[FLAW_FILE] + flaws->of[FLAW_REFERENCE] > 0) {
        report->structure++;
        return store_repair_structure(store, err);
    }
    for (const struct found_flaw *found = flaws->first; found != NULL && status == 0;
         found = found->next)
        status = repair_flaw(store, &found->flaw, report, err);
    return status != 0 ? status : store_repair_counts(store, err);
}

/* Finds the faults and repairs them, as one change. */
static int repair_once(struct store *store, struct flaws *flaws, struct verify_report *seen,
                       struct repair_report *report, struct error *err) {
    int status = store_begin(store, err);
    if (status != 0)
        return status;
    status = look(store, flaws, seen, err);
    if (status == 0 && report->structure > 0 && flaws->of[FLAW_FILE] > 0)
        status = error_set(err, ERROR_INPUT,
                           "the file itself is damaged: sqlite3 FILE .recover | sqlite3 NEW takes "
                           "out what can be read, and rugo repair --db NEW repairs that");
    if (status == 0)
        status = repair_all(store, flaws, report, err);
    if (status == 0)
        return store_commit(store, err);
    store_abandon(store);
    return status;
}

int repair_store(struct store *store, const struct verification *verification,
                 struct repair_report *report, struct error *err) {
    struct publish_counts counts;
    bool whole = false;
    int status = 0;
    for (int pass = 0; pass < PASSES_MOST && status == 0 && !whole; pass++) {
        struct verify_report seen = {0};
        struct flaws flaws = {.verification = pass == 0 ? verification : NULL};
        status = repair_once(store, &flaws, &seen, report, err);
        if (pass == 0)
            report->before = seen;
        whole = flaws.first == NULL;
        flaws_clear(&flaws);
        if (status == 0)
            status = publish_due(store, NULL, NULL, &counts, err);
    }
    report->sealed = report->before.counts.unsealed;
    return status != 0 ? status : verify_store(store, verification, true, &report->after, err);
}
