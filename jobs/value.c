#include "jobs/value.h"
#include <math.h>
#include <string.h>

const cJSON *value_at(const cJSON *root, const char *pointer) {
    const cJSON *at = root;
    while (at != NULL && *pointer == '/') {
        const char *key = pointer + 1;
        size_t length = strcspn(key, "/");
        const cJSON *child = cJSON_IsObject(at) ? at->child : NULL;
        while (child != NULL &&
               (strncmp(child->string, key, length) != 0 || child->string[length] != '\0'))
            child = child->next;
        at = child;
        pointer = key + length;
    }
    return at;
}

cJSON *value_number(double number) {
    return isfinite(number) ? cJSON_CreateNumber(number) : cJSON_CreateNull();
}

cJSON *value_numbers(size_t n, const double *numbers) {
    cJSON *array = cJSON_CreateArray();
    for (size_t a = 0; a < n; a++) {
        if (!value_append(array, value_number(numbers[a]))) {
            cJSON_Delete(array);
            return NULL;
        }
    }
    return array;
}

cJSON *value_matrix(size_t rows, size_t columns, const double *numbers) {
    cJSON *array = cJSON_CreateArray();
    for (size_t j = 0; j < rows; j++) {
        if (!value_append(array, value_numbers(columns, numbers + j * columns))) {
            cJSON_Delete(array);
            return NULL;
        }
    }
    return array;
}

bool value_put(cJSON *object, const char *key, cJSON *item) {
    if (object != NULL && item != NULL && cJSON_AddItemToObject(object, key, item))
        return true;
    cJSON_Delete(item);
    return false;
}

bool value_append(cJSON *array, cJSON *item) {
    if (array != NULL && item != NULL && cJSON_AddItemToArray(array, item))
        return true;
    cJSON_Delete(item);
    return false;
}
