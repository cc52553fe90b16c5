#include "schema/result/swept.h"
#include <cjson/cJSON.h>
#include <string.h>

size_t swept_count(const struct study_result *study) {
    return study->swept != NULL ? (size_t)cJSON_GetArraySize(study->swept) : 0;
}

const char *swept_pointer(const struct study_result *study, size_t n) {
    const char *pointer = n < swept_count(study)
                              ? cJSON_GetStringValue(cJSON_GetArrayItem(study->swept, (int)n))
                              : NULL;
    return pointer != NULL && *pointer == '/' ? pointer : NULL;
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
