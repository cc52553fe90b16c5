#include "worker/publish/verify.h"
#include "jobs/merger.h"
#include "schema/study/study.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The case whose blocks are being checked. */
struct merging {
    const struct verification *verification;
    struct verify_report *report;
    const struct job_kind *kind;
    struct job_merger *merger; /* owned; empty */
    const char *study;
    uint64_t case_number;
    bool published; /* the case, or that of which it is a component, is published */
    uint64_t done;
};

static int report_flaw(const struct merging *merging, const struct flaw *flaw, struct error *err) {
    merging->report->counts.flaws++;
    return merging->verification->found(merging->verification->context, flaw, err);
}

/* Checks whether a block can be merged. The blocks of a published case are kept in any case: what
 * an older program published stays. */
static int block_check(void *context, const struct block_result *block, struct error *err) {
    struct merging *merging = context;
    struct error reason = {0};
    int status = kind_check_names(merging->kind, block, &reason);
    if (status == 0)
        status = merger_fits(merging->merger, block, &reason);
    if (status == 0)
        return 0;
    if (status != ERROR_INPUT)
        return error_set(err, status, "%s", reason.text);
    if (merging->published) {
        merging->report->kept++;
        return 0;
    }
    struct flaw flaw = {.kind = FLAW_BLOCK,
                        .case_number = (int64_t)merging->case_number,
                        .first = block->first,
                        .count = block->count,
                        .text = reason.text};
    snprintf(flaw.study, sizeof flaw.study, "%s", merging->study);
    return report_flaw(merging, &flaw, err);
}

/* Checks the blocks of a case. Cases that cannot be read at all were reported by store_verify. */
static int case_check(struct store *store, struct merging *merging, struct error *err) {
    struct case_info info = {0};
    struct error reason = {0};
    int status = store_any_case(store, merging->study, merging->case_number, &info, &reason);
    if (status == 0 && info.realisations_done > 0)
        status = merger_create(&merging->merger, merging->kind, info.parameters, &reason);
    if (status == 0 && info.realisations_done > 0)
        status = store_results(store, merging->study, merging->case_number, block_check, merging,
                               &reason);
    merger_destroy(&merging->merger);
    case_info_clear(&info);
    if (status != 0 && status != ERROR_INPUT)
        return error_set(err, status, "%s", reason.text);
    const struct verification *verification = merging->verification;
    if (verification->progress != NULL &&
        verification->progress(verification->context, "cases merged", ++merging->done) != 0)
        return error_set(err, ERROR_STOPPED, "stopped");
    return 0;
}

/* Returns whether the case is published whole at its present revision. */
static int is_published(struct store *store, const char *study, uint64_t case_number, bool *found,
                        struct error *err) {
    const struct published_part scalars = {.scalars_only = true};
    struct case_info info = {0};
    struct case_result result = {0};
    struct due_case ignored;
    int status = store_case(store, study, case_number, &info, err);
    if (status == 0)
        status = store_published(store, study, case_number, info.revision, &scalars, &result, found,
                                 err);
    (void)store_found_damage(store, &ignored);
    result_clear(&result);
    case_info_clear(&info);
    return status == ERROR_INPUT ? 0 : status;
}

/* Checks the case, or its components. */
static int parts_check(struct store *store, struct merging *merging, struct error *err) {
    struct component *components = NULL;
    size_t count = 0;
    int status =
        is_published(store, merging->study, merging->case_number, &merging->published, err);
    if (status == 0)
        status =
            store_components(store, merging->study, merging->case_number, &components, &count, err);
    if (status == 0 && count == 0)
        status = case_check(store, merging, err);
    for (size_t a = 0; a < count && status == 0; a++) {
        merging->case_number = components[a].number;
        status = case_check(store, merging, err);
    }
    components_free(components, count);
    return status;
}

static int study_check(struct store *store, const struct study_status *study,
                       struct merging *merging, struct error *err) {
    int status = 0;
    merging->kind = kind_find(study->kind);
    merging->study = study->id;
    for (uint64_t c = 0; merging->kind != NULL && c < study->cases && status == 0; c++) {
        merging->case_number = c;
        merging->published = false;
        status = parts_check(store, merging, err);
    }
    return status;
}

static int merges_check(struct store *store, struct merging *merging, struct error *err) {
    enum { PAGE = 64 };
    char after[STUDY_ID_SIZE] = "";
    size_t count = PAGE;
    int status = 0;
    while (status == 0 && count == PAGE) {
        struct study_status *studies = NULL;
        count = 0;
        status = store_list(store, after, PAGE, &studies, &count, err);
        for (size_t s = 0; s < count; s++) {
            if (status == 0)
                status = study_check(store, &studies[s], merging, err);
            snprintf(after, sizeof after, "%s", studies[s].id);
            study_status_clear(&studies[s]);
        }
        free(studies);
    }
    return status;
}

int verify_store(struct store *store, const struct verification *verification, bool quick,
                 struct verify_report *report, struct error *err) {
    struct merging merging = {.verification = verification, .report = report};
    uint64_t before = report->counts.flaws;
    int status = store_verify(store, verification, &report->counts, err);
    /* where rows are damaged, failures to merge follow from that */
    if (status == 0 && !quick && report->counts.flaws == before)
        status = merges_check(store, &merging, err);
    return status;
}
