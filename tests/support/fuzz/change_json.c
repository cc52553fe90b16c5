#include "tests/support/fuzz/change_json.h"
#include "tests/support/fuzz/fuzz.h"

cJSON *odd_json(struct choices *choices) {
    static const char *const TEXTS[] = {
        "null", "true", "\"\"", "\"12\"", "{}",      "[]",        "[[1],[2,3]]", "{\"a\":{}}",
        "-1",   "1.5",  "1e18", "[null]", "[1e300]", "\"a\\nb\"", "\"/\"",       "\"\xc3\xa9\""};
    enum { COUNT = sizeof TEXTS / sizeof *TEXTS };
    uint64_t one = choose(choices, COUNT + 8);
    return one < COUNT ? cJSON_Parse(TEXTS[one])
                       : cJSON_CreateNumber(choose_odd_number(choices, true));
}

static size_t count_values(const cJSON *value) {
    size_t count = 1;
    for (const cJSON *child = value->child; child != NULL; child = child->next)
        count += count_values(child);
    return count;
}

/* Returns the value that stands so many behind this one, and what holds it. */
static cJSON *find_value(cJSON *value, size_t *behind, cJSON **holder) {
    if (*behind == 0)
        return value;
    for (cJSON *child = value->child; child != NULL; child = child->next) {
        --*behind;
        cJSON *held = value, *found = find_value(child, behind, &held);
        if (found != NULL) {
            *holder = found == child ? value : held;
            return found;
        }
    }
    return NULL;
}

/* These take `other`. */
static void put_beside(cJSON *holder, const cJSON *value, cJSON *other) {
    MUST(cJSON_IsArray(holder) ? cJSON_AddItemToArray(holder, other)
                               : cJSON_AddItemToObject(holder, value->string, other));
}

static void put_in_place(cJSON *holder, cJSON *value, cJSON *other) {
    MUST(cJSON_IsArray(holder)
             ? cJSON_ReplaceItemViaPointer(holder, value, other)
             : cJSON_ReplaceItemInObjectCaseSensitive(holder, value->string, other));
}

void change_json(struct choices *choices, cJSON **document) {
    size_t behind = choose(choices, count_values(*document));
    cJSON *holder = NULL, *value = find_value(*document, &behind, &holder);
    uint64_t change = choose(choices, 8);
    MUST(value != NULL);
    if (holder == NULL) {
        cJSON_Delete(*document);
        *document = odd_json(choices);
    } else if (change == 0)
        put_beside(holder, value, cJSON_Duplicate(value, true));
    else if (change == 1)
        cJSON_Delete(cJSON_DetachItemViaPointer(holder, value));
    else if (change < 4 && cJSON_IsNumber(value))
        cJSON_SetNumberValue(value, value->valuedouble + (double)choose(choices, 3) - 1);
    else
        put_in_place(holder, value, odd_json(choices));
    MUST(*document != NULL);
}
