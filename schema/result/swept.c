#include "schema/result/swept.h"
#include <cjson/cJSON.h>
#include <string.h>

static void add(struct swept *out, const char *pointer) {
    if (out->count < SWEPT_MOST)
        out->columns[out->count++].pointer = pointer;
}

/* Returns whether a pointer is that of a member of the object that `whole` names. */
static bool is_member(const char *pointer, const char *whole) {
    size_t length = strlen(whole);
    return strncmp(pointer, whole, length) == 0 && pointer[length] == '/';
}

/* Adds the members that a case has and none of the columns behind `from` is. */
static void add_members(struct swept *out, size_t from, const struct case_result *one,
                        const char *whole) {
    for (size_t p = 0; p < one->parameter_count; p++) {
        const char *pointer = one->parameters[p].pointer;
        if (!is_member(pointer, whole))
            continue;
        size_t n = from;
        while (n < out->count && strcmp(out->columns[n].pointer, pointer) != 0)
            n++;
        if (n == out->count)
            add(out, pointer);
    }
}

/* Adds the columns of a swept value: itself where some case has it, or where none has a member. */
static void add_value(struct swept *out, const struct study_result *study, const char *whole) {
    const size_t from = out->count;
    bool any = false;
    for (size_t c = 0; c < study->case_count && !any; c++)
        any = result_parameter(&study->cases[c], whole) != NULL;
    if (any)
        add(out, whole);
    for (size_t c = 0; c < study->case_count; c++)
        add_members(out, from, &study->cases[c], whole);
    if (out->count == from)
        add(out, whole);
}

static const char *last_word(const char *pointer) {
    return strrchr(pointer, '/') + 1; /* every pointer begins with a slash */
}

static const char *name_of(const struct swept *swept, size_t n) {
    const char *own = swept->columns[n].pointer;
    for (size_t a = 0; a < swept->count; a++)
        if (a != n && strcmp(last_word(own), last_word(swept->columns[a].pointer)) == 0)
            return own + 1;
    return last_word(own);
}

void swept_find(const struct study_result *study, struct swept *out) {
    const cJSON *swept;
    out->count = 0;
    cJSON_ArrayForEach(swept, study->swept) {
        const char *whole = cJSON_GetStringValue(swept);
        if (whole == NULL || *whole != '/')
            break;
        add_value(out, study, whole);
    }
    for (size_t n = 0; n < out->count; n++)
        out->columns[n].name = name_of(out, n);
}
