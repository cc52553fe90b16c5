#include "schema/result/swept.h"
#include <cjson/cJSON.h>
#include <string.h>

/* Returns whether a pointer is that of a member of the object that `whole` names. */
static bool is_member(const char *pointer, const char *whole) {
    size_t length = strlen(whole);
    return strncmp(pointer, whole, length) == 0 && pointer[length] == '/';
}

/* Returns whether an earlier parameter of the same or of an earlier case has the pointer of this
 * one. */
static bool is_met(const struct study_result *study, size_t number, size_t parameter) {
    const char *pointer = study->cases[number].parameters[parameter].pointer;
    for (size_t c = 0; c < number; c++)
        if (result_parameter(&study->cases[c], pointer) != NULL)
            return true;
    return result_parameter(&study->cases[number], pointer) !=
           &study->cases[number].parameters[parameter];
}

/* Returns the n-th member that cases have of a swept value which is an object, such as a height in
 * one of several units; NULL beyond the last. */
static const char *member_of(const struct study_result *study, const char *whole, size_t n) {
    for (size_t c = 0; c < study->case_count; c++)
        for (size_t p = 0; p < study->cases[c].parameter_count; p++) {
            const char *pointer = study->cases[c].parameters[p].pointer;
            if (is_member(pointer, whole) && !is_met(study, c, p) && n-- == 0)
                return pointer;
        }
    return NULL;
}

/* Returns whether cases have the swept value itself, and not its members. */
static bool is_whole(const struct study_result *study, const char *pointer) {
    return (study->case_count > 0 && result_parameter(&study->cases[0], pointer) != NULL) ||
           member_of(study, pointer, 0) == NULL;
}

const char *swept_pointer(const struct study_result *study, size_t n) {
    const cJSON *swept;
    cJSON_ArrayForEach(swept, study->swept) {
        const char *whole = cJSON_GetStringValue(swept), *member;
        if (whole == NULL || *whole != '/')
            return NULL;
        if (is_whole(study, whole)) {
            if (n-- == 0)
                return whole;
            continue;
        }
        for (size_t m = 0; (member = member_of(study, whole, m)) != NULL; m++)
            if (n-- == 0)
                return member;
    }
    return NULL;
}

size_t swept_count(const struct study_result *study) {
    size_t count = 0;
    while (swept_pointer(study, count) != NULL)
        count++;
    return count;
}

static const char *last_word(const char *pointer) {
    return strrchr(pointer, '/') + 1; /* every pointer begins with a slash */
}

const char *swept_name(const struct study_result *study, size_t n) {
    const char *own = swept_pointer(study, n), *other;
    for (size_t a = 0; own != NULL && (other = swept_pointer(study, a)) != NULL; a++)
        if (a != n && strcmp(last_word(own), last_word(other)) == 0)
            return own + 1;
    return own != NULL ? last_word(own) : NULL;
}
