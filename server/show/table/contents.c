#include "server/show/table/contents.h"
#include "schema/json/field.h"
#include "schema/result/result_json.h"
#include "server/show/table/shown_cases.h"
#include <math.h>

/* --- cases --- */

/* The parameters of all cases, without their results. */
static int read_parameters(struct store *store, const struct aggregate *aggregate,
                           struct study_result *out, struct error *err) {
    const uint64_t count = aggregate->about.cases;
    int status = aggregate_head(store, aggregate, out, err);
    if (status == 0 && (out->cases = array_create(count, sizeof *out->cases)) == NULL)
        status = error_memory(err, count * sizeof *out->cases, "cases");
    for (uint64_t c = 0; status == 0 && c < count; c++) {
        struct case_info info = {0};
        struct case_result *one = &out->cases[out->case_count++];
        status = store_case(store, aggregate->about.id, c, &info, err);
        if (status == 0)
            status = result_set_parameters(one, info.parameters, err);
        one->case_number = c;
        one->realisations = info.realisations_done;
        case_info_clear(&info);
    }
    return status;
}

static cJSON *value_of(const struct result_parameter *parameter) {
    if (parameter == NULL)
        return cJSON_CreateNull();
    if (parameter->text == NULL)
        return json_number(parameter->number);
    return parameter->list || parameter->flag ? cJSON_Parse(parameter->text)
                                              : cJSON_CreateString(parameter->text);
}

static bool put_case(cJSON *list, const struct shown_cases *shown, const struct case_result *one) {
    cJSON *entry = list_put_object(list);
    bool complete = field_put_count(entry, "case", one->case_number) &&
                    field_put_count(entry, "realisations", one->realisations);
    cJSON *swept = complete ? cJSON_AddObjectToObject(entry, "swept") : NULL;
    complete = swept != NULL;
    for (size_t p = 0; complete && p < shown->varied_count; p++)
        complete = field_put(swept, shown->varied[p],
                             value_of(parameter_at(one, shown->varied[p], SIZE_MAX)));
    return complete;
}

static bool put_cases(cJSON *document, const struct study_result *study) {
    struct shown_cases shown = {0};
    cJSON *list = cJSON_AddArrayToObject(document, "cases");
    bool complete = list != NULL && shown_of_results(study, &shown);
    for (size_t c = 0; complete && c < study->case_count; c++)
        complete = put_case(list, &shown, &study->cases[c]);
    shown_clear(&shown);
    return complete;
}

/* --- curves and scalars --- */

static bool put_text_once(cJSON *list, const char *text) {
    const cJSON *item;
    if (text == NULL)
        return true;
    cJSON_ArrayForEach(item, list) if (same_text(item->valuestring, text)) return true;
    return list_put(list, cJSON_CreateString(text));
}

static bool put_number_once(cJSON *list, double number) {
    const cJSON *item;
    if (isnan(number))
        return true;
    cJSON_ArrayForEach(item, list) if (same_number(item->valuedouble, number)) return true;
    return list_put(list, cJSON_CreateNumber(number));
}

/* Curves of one quantity stand together; one entry names them all. */
static cJSON *entry_of(cJSON *list, const struct curve *curve) {
    cJSON *last = cJSON_GetArrayItem(list, cJSON_GetArraySize(list) - 1);
    if (last != NULL &&
        same_text(cJSON_GetStringValue(field_at(last, "quantity")), curve->quantity))
        return last;
    cJSON *entry = list_put_object(list);
    bool complete = entry != NULL && field_put_text(entry, "quantity", curve->quantity) &&
                    field_put(entry, "matrix", cJSON_CreateBool(curve->columns > 0)) &&
                    field_put_text(entry, "x_label", curve->x_label) &&
                    field_put_text(entry, "y_label", curve->y_label) &&
                    field_put(entry, "series", cJSON_CreateArray()) &&
                    field_put(entry, "models", cJSON_CreateArray()) &&
                    field_put(entry, "levels", cJSON_CreateArray());
    return complete ? entry : NULL;
}

static bool put_results(cJSON *document, const struct case_result *one) {
    cJSON *curves = cJSON_AddArrayToObject(document, "curves");
    cJSON *scalars = cJSON_AddArrayToObject(document, "scalars");
    bool complete = curves != NULL && scalars != NULL;
    for (size_t a = 0; complete && a < one->curve_count; a++) {
        const struct curve *curve = &one->curves[a];
        cJSON *entry = entry_of(curves, curve);
        complete = entry != NULL &&
                   put_text_once(cJSON_GetObjectItem(entry, "series"), curve->series) &&
                   put_text_once(cJSON_GetObjectItem(entry, "models"), curve->model) &&
                   put_number_once(cJSON_GetObjectItem(entry, "levels"), curve->level);
    }
    for (size_t s = 0; complete && s < one->scalar_count; s++)
        complete = put_text_once(scalars, one->scalars[s].name);
    return complete;
}

/* Reads the first case that has results; *out stays empty where none has. */
static int read_first(struct store *store, const struct aggregate *aggregate,
                      const struct study_result *study, struct case_result *out,
                      struct error *err) {
    const struct result_filter all = {.case_number = -1};
    int status = 0;
    for (size_t c = 0; status == 0 && out->curve_count == 0 && c < study->case_count; c++)
        if (study->cases[c].realisations > 0) {
            result_clear(out);
            status = aggregate_case(store, aggregate, c, &all, out, err);
        }
    return status;
}

static int document_of(const struct study_result *study, const struct case_result *first,
                       cJSON **out, struct error *err) {
    cJSON *document = cJSON_CreateObject();
    bool complete = document != NULL && field_put_text(document, "study", study->id) &&
                    field_put_text(document, "name", study->name) &&
                    field_put_text(document, "kind", study->kind) &&
                    field_put(document, "provenance", cJSON_Duplicate(study->provenance, true)) &&
                    put_cases(document, study) && put_results(document, first);
    *out = fields_finish(document, complete);
    return *out != NULL ? 0 : error_memory(err, 0, "the contents of a study");
}

int contents_document(struct store *store, const char *id, cJSON **out, struct error *err) {
    struct aggregate aggregate;
    struct study_result study = {0};
    struct case_result first = {0};
    int status = aggregate_begin(store, id, &aggregate, err);
    if (status != 0)
        return status;
    status = read_parameters(store, &aggregate, &study, err);
    if (status == 0)
        status = read_first(store, &aggregate, &study, &first, err);
    if (status == 0)
        status = document_of(&study, &first, out, err);
    result_clear(&first);
    study_result_clear(&study);
    aggregate_end(&aggregate);
    return status;
}
