#include "schema/json/flat.h"
#include "schema/json/wire_field.h"

#include <string.h>

enum { POINTER_MOST = 256 };

/* Appends "/KEY", escaped; false where it does not fit. */
static bool pointer_append(char *pointer, size_t length, const char *key) {
    pointer[length++] = '/';
    for (; *key && length + 3 < POINTER_MOST; key++) {
        if (*key == '~' || *key == '/') {
            pointer[length++] = '~';
            pointer[length++] = *key == '~' ? '0' : '1';
        } else {
            pointer[length++] = *key;
        }
    }
    pointer[length] = '\0';
    return *key == '\0';
}

/* pointer holds where `object` is; it is extended in place for its members. */
static bool flatten(const cJSON *object, char pointer[POINTER_MOST], cJSON *flat) {
    size_t length = strlen(pointer);
    const cJSON *item;
    cJSON_ArrayForEach(item, object) {
        if (length + 4 > POINTER_MOST || !pointer_append(pointer, length, item->string)) {
            return false;
        }
        bool leaf = cJSON_IsNumber(item) || cJSON_IsString(item) || cJSON_IsBool(item);
        if (leaf && !field_put(flat, pointer, cJSON_Duplicate(item, false))) {
            return false;
        }
        if (cJSON_IsObject(item) && !flatten(item, pointer, flat)) {
            return false;
        }
    }
    pointer[length] = '\0';
    return true;
}

cJSON *flat_parameters(const cJSON *parameters) {
    char pointer[POINTER_MOST] = "";
    cJSON *flat = cJSON_CreateObject();
    return fields_finish(flat, flat && flatten(parameters, pointer, flat));
}
