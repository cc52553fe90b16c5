#include "schema/study/sweep.h"
#include "schema/study/value.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A swept parameter: its list, and how many cases share one of its values in a row. */
struct axis {
    const struct parameter *parameter;
    const cJSON *list;
    size_t length, stride;
};

static const struct parameter *find_parameter(const struct study_kind *kind, const char *pointer) {
    for (size_t p = 0; p < kind->parameter_count; p++)
        if (strcmp(kind->parameters[p].path, pointer) == 0)
            return &kind->parameters[p];
    return NULL;
}

/* Axes of the document's lists, in its own order. */
static size_t find_axes(const struct study_kind *kind, const cJSON *object, const char *prefix,
                        struct axis *axes, size_t count) {
    for (const cJSON *member = object->child; member; member = member->next) {
        char pointer[POINTER_SIZE];
        snprintf(pointer, sizeof pointer, "%s/%s", prefix, member->string);
        const struct parameter *parameter = find_parameter(kind, pointer);
        if (parameter && value_is_list(parameter, member))
            axes[count++] = (struct axis){parameter, member, (size_t)cJSON_GetArraySize(member), 1};
        else if (cJSON_IsObject(member))
            count = find_axes(kind, member, pointer, axes, count);
    }
    return count;
}

/* The last axis runs fastest; false when there would be too many cases. */
static bool set_strides(struct axis *axes, size_t count, size_t *cases) {
    *cases = 1;
    for (size_t a = count; a-- > 0;) {
        axes[a].stride = *cases;
        if (axes[a].length > STUDY_CASES_MOST / *cases)
            return false;
        *cases *= axes[a].length;
    }
    return true;
}

/* Puts a value (taken) at a pointer below root, making objects on the way. */
static int put_at(cJSON *root, const char *pointer, cJSON *value) {
    cJSON *object = root;
    char name[POINTER_SIZE];
    for (const char *at = pointer + 1;;) {
        size_t length = strcspn(at, "/");
        snprintf(name, sizeof name, "%.*s", (int)length, at);
        if (!at[length])
            break;
        cJSON *next = cJSON_GetObjectItemCaseSensitive(object, name);
        object = next ? next : cJSON_AddObjectToObject(object, name);
        at += length + 1;
        if (!object)
            break;
    }
    if (object && value && cJSON_AddItemToObject(object, name, value))
        return 0;
    cJSON_Delete(value);
    return ERROR_MEMORY;
}

static cJSON *parameter_value(const struct parameter *parameter, const cJSON *document,
                              const struct axis *axes, size_t axis_count, size_t number) {
    for (size_t a = 0; a < axis_count; a++)
        if (axes[a].parameter == parameter) {
            size_t index = number / axes[a].stride % axes[a].length;
            return cJSON_Duplicate(cJSON_GetArrayItem(axes[a].list, (int)index), true);
        }
    const cJSON *given = json_at(document, parameter->path);
    if (given)
        return cJSON_Duplicate(given, true);
    return cJSON_Parse(parameter->default_json);
}

static int case_create(struct study *study, size_t number, const cJSON *document,
                       const struct axis *axes, size_t axis_count) {
    cJSON *parameters = cJSON_CreateObject();
    study->cases[number].parameters = parameters;
    if (!parameters)
        return ERROR_MEMORY;
    for (size_t p = 0; p < study->kind->parameter_count; p++) {
        const struct parameter *parameter = &study->kind->parameters[p];
        if (!parameter->default_json && !json_at(document, parameter->path))
            continue;
        cJSON *value = parameter_value(parameter, document, axes, axis_count, number);
        if (put_at(parameters, parameter->path, value))
            return ERROR_MEMORY;
    }
    return 0;
}

static int fill(struct study *study, const cJSON *document, const struct axis *axes, size_t count,
                size_t cases, struct error *err) {
    study->swept = array_create(count + 1, sizeof *study->swept);
    study->cases = array_create(cases, sizeof *study->cases);
    if (!study->swept || !study->cases)
        return error_memory(err, cases * sizeof *study->cases, "cases");
    study->case_count = cases;
    for (size_t a = 0; a < count; a++)
        if (!(study->swept[a] = strdup(axes[a].parameter->path)))
            return error_memory(err, POINTER_SIZE, "a pointer");
    for (size_t number = 0; number < cases; number++)
        if (case_create(study, number, document, axes, count))
            return error_memory(err, cases * sizeof *study->cases, "the parameters of cases");
    return 0;
}

int sweep_open(struct study *study, const cJSON *document, struct fault_list *faults,
               struct error *err) {
    struct axis *axes = array_create(study->kind->parameter_count, sizeof *axes);
    if (!axes)
        return error_memory(err, study->kind->parameter_count * sizeof *axes, "sweeps");
    size_t cases, count = find_axes(study->kind, document, "", axes, 0);
    int status = 0;
    if (set_strides(axes, count, &cases))
        status = fill(study, document, axes, count, cases, err);
    else
        fault_add(faults, "", "the lists make more than %d cases", STUDY_CASES_MOST);
    free(axes);
    return status;
}
