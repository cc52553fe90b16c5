/* Reading the JSON documents of openapi.yaml: what is missing or of another type reads as nothing.
 */
#ifndef RUGO_SERVER_SHOW_DOCUMENT_H
#define RUGO_SERVER_SHOW_DOCUMENT_H

#include <cjson/cJSON.h>
#include <math.h>
#include <stdbool.h>

/* All borrow from the document; object may be NULL. */
static inline const cJSON *member(const cJSON *object, const char *name) {
    return cJSON_GetObjectItemCaseSensitive(object, name);
}
/* The first element or member of a member. */
static inline const cJSON *first_of(const cJSON *object, const char *name) {
    const cJSON *list = member(object, name);
    return list ? list->child : NULL;
}
/* Its text, or otherwise. */
static inline const char *text_of(const cJSON *object, const char *name, const char *otherwise) {
    const cJSON *value = member(object, name);
    return cJSON_IsString(value) ? value->valuestring : otherwise;
}
/* Its number, or NaN. */
static inline double number_of(const cJSON *object, const char *name) {
    const cJSON *value = member(object, name);
    return cJSON_IsNumber(value) ? value->valuedouble : (double)NAN;
}

/* Whether both have the same member, or both none. */
static inline bool same_member(const cJSON *a, const cJSON *b, const char *name) {
    const cJSON *one = member(a, name), *other = member(b, name);
    return one ? cJSON_Compare(one, other, true) : !other;
}

#endif
