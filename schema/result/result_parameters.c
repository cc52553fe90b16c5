#include "schema/result/result_json.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { POINTER_MOST = 256 };

/* Appends "/KEY", escaped by RFC 6901; false where it does not fit. */
static bool pointer_append(char *pointer, size_t length, const char *key) {
    pointer[length++] = '/';
    for (; *key != '\0' && length + 3 < POINTER_MOST; key++) {
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

static size_t count_leaves(const cJSON *object) {
    size_t count = 0;
    for (const cJSON *item = object != NULL ? object->child : NULL; item != NULL; item = item->next)
        count += cJSON_IsObject(item) ? count_leaves(item) : 1;
    return count;
}

bool result_add_parameter(struct case_result *result, const char *pointer, const cJSON *value) {
    struct result_parameter *one = &result->parameters[result->parameter_count];
    if (cJSON_IsNumber(value)) {
        *one = (struct result_parameter){.number = value->valuedouble};
    } else if (cJSON_IsString(value)) {
        *one = (struct result_parameter){.text = result_text(result, value->valuestring)};
    } else if (cJSON_IsBool(value)) {
        const char *text = cJSON_IsTrue(value) ? "true" : "false";
        *one = (struct result_parameter){.text = result_text(result, text), .flag = true};
    } else if (cJSON_IsArray(value)) {
        char *text = json_print(value);
        *one = (struct result_parameter){.text = result_text(result, text), .list = true};
        free(text);
    } else {
        return true;
    }
    if (!cJSON_IsNumber(value))
        one->number = NAN;
    one->pointer = result_text(result, pointer);
    result->parameter_count++;
    return one->pointer != NULL && (cJSON_IsNumber(value) || one->text != NULL);
}

/* pointer names `object`, and is extended in place for its members. */
static int flatten(struct case_result *result, const cJSON *object, char pointer[POINTER_MOST],
                   struct error *err) {
    size_t length = strlen(pointer);
    for (const cJSON *item = object->child; item != NULL; item = item->next) {
        int status = 0;
        if (length + 4 > POINTER_MOST || !pointer_append(pointer, length, item->string))
            return error_set(err, ERROR_INPUT, "a parameter's name is longer than %d bytes",
                             POINTER_MOST);
        if (cJSON_IsObject(item))
            status = flatten(result, item, pointer, err);
        else if (!result_add_parameter(result, pointer, item))
            status = error_memory(err, POINTER_MOST, "a parameter");
        if (status != 0)
            return status;
    }
    pointer[length] = '\0';
    return 0;
}

int result_set_parameters(struct case_result *result, const cJSON *parameters, struct error *err) {
    char pointer[POINTER_MOST] = "";
    size_t count = count_leaves(parameters);
    result->parameter_count = 0;
    result->parameters = result_room(result, count + 1, sizeof *result->parameters);
    if (result->parameters == NULL)
        return error_memory(err, count * sizeof *result->parameters, "parameters");
    return parameters != NULL ? flatten(result, parameters, pointer, err) : 0;
}
