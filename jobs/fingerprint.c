#include "jobs/fingerprint.h"
#include "schema/result/bytes.h"
#include "schema/study/value.h"
#include <string.h>

static uint64_t hash_number(uint64_t hash, double number) {
    return hash_bytes(hash, sizeof number, &number);
}

static uint64_t hash_text(uint64_t hash, const char *text) {
    return hash_bytes(hash, strlen(text), text);
}

/* Hashes one value; members of an object with their names. */
static uint64_t hash_value(uint64_t hash, const cJSON *value) {
    if (cJSON_IsNumber(value))
        return hash_number(hash, value->valuedouble);
    if (cJSON_IsString(value))
        return hash_text(hash, value->valuestring);
    for (const cJSON *item = value->child; item != NULL; item = item->next) {
        if (item->string != NULL)
            hash = hash_text(hash, item->string);
        if (!cJSON_IsNumber(item)) /* so that ["ab"] is not ["a", "b"] */
            hash = hash_number(hash, 0);
        if (cJSON_IsNumber(item) || cJSON_IsString(item))
            hash = hash_value(hash, item);
    }
    return hash;
}

uint64_t case_fingerprint(const struct values *values,
                          const struct parameter_table *const *tables) {
    uint64_t hash = HASH_START;
    const struct parameter *row;
    double number = 0;
    for (size_t p = 0; (row = parameter_row(tables, p)) != NULL; p++) {
        if (row->later)
            continue;
        hash = hash_number(hash, number++);
        if (values_json(values, p) != NULL)
            hash = hash_value(hash, values_json(values, p));
    }
    for (size_t p = 0; (row = parameter_row(tables, p)) != NULL; p++)
        if (row->later && !values_is_default(values, p))
            hash = hash_value(hash_text(hash, row->path), values_json(values, p));
    return hash;
}
