#include "worker/aggregate.h"
#include "jobs/kind.h"
#include "jobs/merger.h"
#include "schema/json/flat.h"
#include "schema/json/wire_field.h"

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
static int merge_block(void *context, const struct block_result *block, struct error *err) {
    struct merge *merge = context;
    struct error names;
    if (kind_check_names(merge->kind, block, &names) != 0) {
        return error_set(err, ERROR_INPUT,
                         "realisations %llu to %llu hold other scalars than kind %s has",
                         (unsigned long long)block->first,
                         (unsigned long long)(block->first + block->count - 1), merge->kind->name);
    }
    return merger_add(merge->merger, block, err);
}

static int case_merge(struct store *store, const char *study, uint64_t case_number,
                      const struct job_kind *kind, const cJSON *parameters, cJSON **out,
                      struct error *err) {
    struct merge merge = {.kind = kind};
    int status = merger_create(&merge.merger, kind, parameters, err);
    if (status) {
        return status;
    }
    status = store_results(store, study, case_number, merge_block, &merge, err);
    status = status ? status : merger_curves(merge.merger, out, err);
    merger_destroy(&merge.merger);
    return status ? error_context(err, "case %llu", (unsigned long long)case_number) : 0;
}

/* A case that has not begun: without a merger, since a study may have ten thousand of them. */
static int empty_curves(cJSON **out, struct error *err) {
    cJSON *curves = cJSON_CreateObject();
    bool complete = curves && field_put_count(curves, "realisations", 0) &&
                    field_put(curves, "scalars", cJSON_CreateObject()) &&
                    field_put(curves, "curves", cJSON_CreateArray());
    *out = fields_finish(curves, complete);
    return *out ? 0 : no_memory(err);
}

int aggregate_begin(struct store *store, const char *study, struct aggregate *out,
                    struct error *err) {
    struct aggregate found = {0};
    int status = store_status(store, study, &found.about, err);
    if (status) {
        return status;
    }
    found.kind = kind_find(found.about.kind);
    if (!found.kind) {
        status =
            error_set(err, ERROR_INPUT, "this program knows no kind '%.64s'", found.about.kind);
        aggregate_end(&found);
        return status;
    }
    *out = found;
    return 0;
}

void aggregate_end(struct aggregate *aggregate) {
    study_status_clear(&aggregate->about);
    aggregate->kind = NULL;
}

/* Merges what is not published at this revision. */
static int fresh_curves(struct store *store, const struct aggregate *aggregate,
                        uint64_t case_number, const struct case_info *info, cJSON **out,
                        struct error *err) {
    const char *study = aggregate->about.id;
    if (info->realisations_done == 0)
        return empty_curves(out, err);
    int status = store_published(store, study, case_number, info->revision, out, err);
    if (status != 0 || *out != NULL)
        return status;
    return case_merge(store, study, case_number, aggregate->kind, info->parameters, out, err);
}

int aggregate_open(struct store *store, const struct aggregate *aggregate, uint64_t case_number,
                   struct case_info *info, cJSON **out, struct error *err) {
    struct case_info found = {0};
    cJSON *curves = NULL;
    int status = store_case(store, aggregate->about.id, case_number, &found, err);
    if (status != 0)
        return status;
    status = fresh_curves(store, aggregate, case_number, &found, &curves, err);
    if (status != 0) {
        case_info_clear(&found);
        return status;
    }
    *info = found;
    *out = curves;
    return 0;
}

int aggregate_case(struct store *store, const char *study, uint64_t case_number, cJSON **out,
                   struct error *err) {
    struct aggregate aggregate;
    struct case_info info = {0};
    int status = aggregate_begin(store, study, &aggregate, err);
    if (status != 0)
        return status;
    status = aggregate_open(store, &aggregate, case_number, &info, out, err);
    case_info_clear(&info);
    aggregate_end(&aggregate);
    return status;
}

int aggregate_publish(struct store *store, const char *study, uint64_t case_number,
                      struct error *err) {
    struct aggregate aggregate;
    struct case_info info = {0};
    cJSON *curves = NULL;
    int status = aggregate_begin(store, study, &aggregate, err);
    if (status != 0) /* an unknown kind is no fault of the case: another program knows it */
        return status == ERROR_INPUT ? (err->code = ERROR_STATE) : status;
    status = store_case(store, study, case_number, &info, err);
    if (status == 0)
        status =
            case_merge(store, study, case_number, aggregate.kind, info.parameters, &curves, err);
    if (status == 0)
        status = store_publish(store, study, case_number, info.revision, curves, err);
    cJSON_Delete(curves);
    case_info_clear(&info);
    aggregate_end(&aggregate);
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

int aggregate_curves_case(struct store *store, const struct aggregate *aggregate,
                          uint64_t case_number, const char *quantity, cJSON **out,
                          struct error *err) {
    struct case_info info = {0};
    cJSON *curves = NULL;
    int status = aggregate_open(store, aggregate, case_number, &info, &curves, err);
    if (status) {
        return status;
    }
    bool begun = info.realisations_done > 0;
    cJSON *list = cJSON_GetObjectItemCaseSensitive(curves, "curves");
    if (quantity && begun && !has_quantity(list, quantity)) {
        status = quantity_absent(list, quantity, err);
        cJSON_Delete(curves);
    } else {
        if (quantity) {
            keep_quantity(list, quantity);
        }
        *out = case_document(case_number, info.parameters, curves);
        status = *out ? 0 : no_memory(err);
    }
    case_info_clear(&info);
    return status;
}

cJSON *aggregate_head(const struct aggregate *aggregate, bool seconds, cJSON **cases) {
    const struct study_status *about = &aggregate->about;
    cJSON *document = cJSON_CreateObject();
    bool complete = document && field_put_text(document, "study", about->id) &&
                    field_put_text(document, "name", about->name) &&
                    field_put_text(document, "kind", about->kind) &&
                    field_put_text(document, "state", about->state) &&
                    (!seconds || field_put(document, "seconds", json_number(about->seconds)));
    *cases = complete ? cJSON_AddArrayToObject(document, "cases") : NULL;
    return fields_finish(document, *cases != NULL);
}

int aggregate_curves(struct store *store, const char *study, const struct curve_filter *filter,
                     cJSON **out, struct error *err) {
    struct aggregate aggregate;
    int status = aggregate_begin(store, study, &aggregate, err);
    if (status) {
        return status;
    }
    bool one = filter->case_number >= 0;
    uint64_t first = one ? (uint64_t)filter->case_number : 0;
    uint64_t end = one ? first + 1 : aggregate.about.cases;
    cJSON *cases = NULL, *document = aggregate_head(&aggregate, false, &cases);
    status = document ? 0 : no_memory(err);
    for (uint64_t c = first; c < end && !status; c++) {
        cJSON *item = NULL;
        status = aggregate_curves_case(store, &aggregate, c, filter->quantity, &item, err);
        if (!status && !cJSON_AddItemToArray(cases, item)) {
            cJSON_Delete(item);
            status = no_memory(err);
        }
    }
    aggregate_end(&aggregate);
    if (status) {
        cJSON_Delete(document);
        return status;
    }
    *out = document;
    return 0;
}
