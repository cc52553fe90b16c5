/* The documents of results of studies, whose cases result_read.c reads. */
#include "schema/json/field.h"
#include "schema/result/result_json.h"
#include <stdlib.h>
#include <string.h>

static int read_cases(const cJSON *cases, struct study_result *study, struct error *err) {
    size_t count = (size_t)cJSON_GetArraySize(cases);
    study->cases = array_create(count, sizeof *study->cases);
    if (study->cases == NULL)
        return error_memory(err, count * sizeof *study->cases, "the results of a study");
    int status = 0;
    for (const cJSON *item = cases != NULL ? cases->child : NULL; item != NULL && status == 0;
         item = item->next) {
        status = result_read(item, &study->cases[study->case_count], err);
        study->case_count += status == 0;
    }
    return status;
}

int study_head_read(const cJSON *document, struct study_result *out, struct error *err) {
    const struct {
        const char *key;
        char **text;
    } texts[] = {{"study", &out->id},
                 {"name", &out->name},
                 {"kind", &out->kind},
                 {"state", &out->state},
                 {"random", &out->random}};
    for (size_t t = 0; t < sizeof texts / sizeof *texts; t++) {
        const char *text = cJSON_GetStringValue(field_at(document, texts[t].key));
        if (texts[t].text == &out->random && field_at(document, "random") == NULL)
            continue; /* of an older program */
        if (text == NULL)
            return error_set(err, ERROR_INPUT, "\"%s\" of a result must be a string", texts[t].key);
        *texts[t].text = strdup(text);
        if (*texts[t].text == NULL)
            return error_memory(err, strlen(text) + 1, "a text of a study");
    }
    const cJSON *swept = field_at(document, "swept");
    const cJSON *provenance = field_at(document, "provenance"); /* neither is of older programs */
    if (cJSON_IsArray(swept) && (out->swept = cJSON_Duplicate(swept, true)) == NULL)
        return error_memory(err, 0, "the swept parameters of a study");
    if (cJSON_IsObject(provenance) && (out->provenance = cJSON_Duplicate(provenance, true)) == NULL)
        return error_memory(err, 0, "the provenance of a study");
    return 0;
}

int study_result_read(const cJSON *document, struct study_result *out, struct error *err) {
    struct study_result study = {0};
    int status = study_head_read(document, &study, err);
    if (status == 0)
        status = read_cases(field_at(document, "cases"), &study, err);
    if (status != 0) {
        study_result_clear(&study);
        return status;
    }
    *out = study;
    return 0;
}
