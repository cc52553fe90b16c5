#include "worker/aggregate.h"
#include "jobs/kind.h"
#include "worker/flat.h"
#include "worker/wire_field.h"

#include <stdio.h>
#include <string.h>

static int no_memory(struct error *err) {
    return error_set(err, ERROR_MEMORY, "no memory left for curves");
}

/* --- one case --- */

struct merge {
    const struct job_kind *kind;
    struct job_merger *merger;
};

/* The names tell data of an older program, whose scalars were others. */
static bool names_agree(const struct job_kind *kind, const struct block_result *block) {
    size_t n = 0;
    while (n < block->scalar_count && kind->scalars[n] &&
           strcmp(kind->scalars[n], block->names[n]) == 0) {
        n++;
    }
    return n == block->scalar_count && !kind->scalars[n];
}

static int merge_block(void *context, const struct block_result *block, struct error *err) {
    struct merge *merge = context;
    if (!names_agree(merge->kind, block)) {
        return error_set(err, ERROR_INPUT,
                         "realisations %llu to %llu hold other scalars than kind %s has",
                         (unsigned long long)block->first,
                         (unsigned long long)(block->first + block->count - 1), merge->kind->name);
    }
    /* the merger reads only: the casts hand over what the block lends */
    struct job_result result = {
        .first = block->first,
        .count = block->count,
        .scalar_count = block->scalar_count,
        .scalars = (double *)block->scalars,
        .data = (unsigned char *)block->data,
        .size = block->size,
        .seconds = block->seconds,
    };
    return merge->kind->merge(merge->merger, &result, err);
}

static int case_merge(struct store *store, const char *study, uint64_t case_number,
                      const struct job_kind *kind, const cJSON *parameters, cJSON **out,
                      struct error *err) {
    struct merge merge = {.kind = kind};
    int status = kind->merger_create(&merge.merger, parameters, err);
    if (status) {
        return status;
    }
    status = store_results(store, study, case_number, merge_block, &merge, err);
    status = status ? status : kind->curves(merge.merger, out, err);
    kind->merger_destroy(&merge.merger);
    return status ? error_context(err, "case %llu", (unsigned long long)case_number) : 0;
}

static bool is_complete(const cJSON *curves, const struct case_info *info) {
    double realisations = cJSON_GetNumberValue(field_at(curves, "realisations"));
    return realisations >= (double)info->realisations;
}

/* Kind of a study, and what else its status says (study_status_clear). */
static int study_find(struct store *store, const char *study, struct study_status *status,
                      const struct job_kind **kind, struct error *err) {
    int code = store_status(store, study, status, err);
    if (code) {
        return code;
    }
    *kind = kind_find(status->kind);
    if (!*kind) {
        code = error_set(err, ERROR_INPUT, "this program knows no kind '%.64s'", status->kind);
        study_status_clear(status);
        return code;
    }
    return 0;
}

/* The case's curves, and its info (case_info_clear) where this succeeds. unpublished: filled where
 * only the publishing failed. */
static int case_curves(struct store *store, const char *study, uint64_t case_number,
                       const struct job_kind *kind, struct case_info *info, cJSON **out,
                       struct error *unpublished, struct error *err) {
    struct case_info found = {0};
    cJSON *curves = NULL;
    int status = store_case(store, study, case_number, &found, err);
    if (status) {
        return status;
    }
    status = store_published(store, study, case_number, found.revision, &curves, err);
    if (!status && !curves) {
        status = case_merge(store, study, case_number, kind, found.parameters, &curves, err);
        if (!status && is_complete(curves, &found)) {
            (void)store_publish(store, study, case_number, found.revision, curves, unpublished);
        }
    }
    if (status) {
        case_info_clear(&found);
        return status;
    }
    *info = found;
    *out = curves;
    return 0;
}

/* case_curves for those who know the study's name only. */
static int case_open(struct store *store, const char *study, uint64_t case_number, cJSON **out,
                     struct error *unpublished, struct error *err) {
    struct study_status about = {0};
    const struct job_kind *kind = NULL;
    int status = study_find(store, study, &about, &kind, err);
    if (status) {
        return status;
    }
    struct case_info info = {0};
    status = case_curves(store, study, case_number, kind, &info, out, unpublished, err);
    case_info_clear(&info);
    study_status_clear(&about);
    return status;
}

int aggregate_case(struct store *store, const char *study, uint64_t case_number, cJSON **out,
                   struct error *err) {
    struct error unpublished = {0};
    return case_open(store, study, case_number, out, &unpublished, err);
}

int aggregate_publish(struct store *store, const char *study, uint64_t case_number,
                      struct error *err) {
    struct error unpublished = {0};
    cJSON *curves = NULL;
    int status = case_open(store, study, case_number, &curves, &unpublished, err);
    cJSON_Delete(curves);
    if (!status && unpublished.code) {
        *err = unpublished;
        status = err->code;
    }
    return status;
}

/* --- the document of curves --- */

static bool is_quantity(const cJSON *curve, const char *quantity) {
    const char *name = cJSON_GetStringValue(field_at(curve, "quantity"));
    return name && strcmp(name, quantity) == 0;
}

static bool has_quantity(const cJSON *curves, const char *quantity) {
    const cJSON *curve;
    cJSON_ArrayForEach(curve, curves) {
        if (is_quantity(curve, quantity)) {
            return true;
        }
    }
    return false;
}

static void keep_quantity(cJSON *curves, const char *quantity) {
    cJSON *curve = curves ? curves->child : NULL;
    while (curve) {
        cJSON *next = curve->next;
        if (!is_quantity(curve, quantity)) {
            cJSON_Delete(cJSON_DetachItemViaPointer(curves, curve));
        }
        curve = next;
    }
}

/* Names what there is; several curves of one quantity follow each other. */
static int quantity_absent(const cJSON *curves, const char *quantity, struct error *err) {
    char names[256] = "";
    const char *last = "";
    const cJSON *curve;
    cJSON_ArrayForEach(curve, curves) {
        const char *name = cJSON_GetStringValue(field_at(curve, "quantity"));
        size_t length = strlen(names);
        if (name && strcmp(name, last) != 0) {
            snprintf(names + length, sizeof names - length, "%s%s", length ? ", " : "", name);
            last = name;
        }
    }
    return error_set(err, ERROR_INPUT, "no quantity '%.64s' in this study; it has %s", quantity,
                     names[0] ? names : "none");
}

/* {"case", "parameters", "realisations", "scalars", "curves"}; takes curves. */
static cJSON *case_document(uint64_t case_number, const cJSON *parameters, cJSON *curves) {
    cJSON *document = cJSON_CreateObject();
    bool complete = document && field_put_count(document, "case", case_number) &&
                    field_put(document, "parameters", flat_parameters(parameters));
    while (complete && curves->child) {
        cJSON *item = cJSON_DetachItemViaPointer(curves, curves->child);
        complete = field_put(document, item->string, item); /* copies the key first */
    }
    cJSON_Delete(curves);
    return fields_finish(document, complete);
}

static int case_append(struct store *store, const struct study_status *about,
                       const struct job_kind *kind, uint64_t case_number,
                       const struct curve_filter *filter, cJSON *cases, struct error *err) {
    struct case_info info = {0};
    struct error unpublished = {0};
    cJSON *curves = NULL;
    int status =
        case_curves(store, about->id, case_number, kind, &info, &curves, &unpublished, err);
    if (status) {
        return status;
    }
    bool begun = cJSON_GetNumberValue(field_at(curves, "realisations")) > 0;
    cJSON *list = cJSON_GetObjectItemCaseSensitive(curves, "curves");
    if (filter->quantity && begun && !has_quantity(list, filter->quantity)) {
        status = quantity_absent(list, filter->quantity, err);
        cJSON_Delete(curves);
    } else {
        if (filter->quantity) {
            keep_quantity(list, filter->quantity);
        }
        cJSON *document = case_document(case_number, info.parameters, curves);
        if (!document || !cJSON_AddItemToArray(cases, document)) {
            cJSON_Delete(document);
            status = no_memory(err);
        }
    }
    case_info_clear(&info);
    return status;
}

static int cases_append(struct store *store, const struct study_status *about,
                        const struct job_kind *kind, const struct curve_filter *filter,
                        cJSON *cases, struct error *err) {
    uint64_t first = 0, end = about->cases;
    if (filter->case_number >= 0) {
        first = (uint64_t)filter->case_number;
        end = first + 1;
    }
    int status = 0;
    for (uint64_t c = first; c < end && !status; c++) {
        status = case_append(store, about, kind, c, filter, cases, err);
    }
    return status;
}

int aggregate_curves(struct store *store, const char *study, const struct curve_filter *filter,
                     cJSON **out, struct error *err) {
    struct study_status about = {0};
    const struct job_kind *kind = NULL;
    int status = study_find(store, study, &about, &kind, err);
    if (status) {
        return status;
    }
    cJSON *document = cJSON_CreateObject(), *cases = cJSON_CreateArray();
    bool complete = document && field_put_text(document, "study", about.id) &&
                    field_put_text(document, "name", about.name) &&
                    field_put_text(document, "kind", about.kind) &&
                    field_put_text(document, "state", about.state);
    complete = field_put(document, "cases", cases) && complete;
    status = complete ? cases_append(store, &about, kind, filter, cases, err) : no_memory(err);
    study_status_clear(&about);
    if (status) {
        cJSON_Delete(document);
        return status;
    }
    *out = document;
    return 0;
}
