#include "schema/study/sweep.h"
#include "schema/json/field.h"
#include "schema/study/value.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A swept parameter: its list, and how many cases share one of its values in a row. */
struct axis {
    const struct parameter *parameter;
    const cJSON *list;
    size_t length, stride;
    const cJSON *item; /* the value in the case that is being made */
};

/* The source of a parameter's value in each case. */
struct origin {
    const char *path;
    const struct axis *axis; /* borrowed; NULL: the value below */
    const cJSON *value;      /* borrowed from the document or from `usual` */
    cJSON *usual;            /* owned default */
};

/* Finds the lists of the document that are swept, in the order of the document. */
static size_t find_axes(const struct study_kind *kind, const cJSON *object, const char *prefix,
                        struct axis *axes, size_t count) {
    for (const cJSON *member = object->child; member != NULL; member = member->next) {
        char pointer[POINTER_SIZE];
        snprintf(pointer, sizeof pointer, "%s/%s", prefix, member->string);
        const struct parameter *parameter = parameter_find(kind->tables, pointer, NULL);
        if (parameter != NULL && value_is_list(parameter, member))
            axes[count++] = (struct axis){parameter, member, (size_t)cJSON_GetArraySize(member), 1,
                                          member->child};
        else if (cJSON_IsObject(member))
            count = find_axes(kind, member, pointer, axes, count);
    }
    return count;
}

/* Sets how many cases share a value, the last axis running fastest; false when there are too many
 * cases. */
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

/* Puts a value (taken) at a pointer below root, and makes the objects above it. */
static int put_at(cJSON *root, const char *pointer, cJSON *value) {
    cJSON *object = root;
    char name[POINTER_SIZE];
    for (const char *at = pointer + 1;;) {
        size_t length = strcspn(at, "/");
        snprintf(name, sizeof name, "%.*s", (int)length, at);
        if (at[length] == '\0')
            break;
        cJSON *next = cJSON_GetObjectItemCaseSensitive(object, name);
        object = next != NULL ? next : cJSON_AddObjectToObject(object, name);
        at += length + 1;
        if (object == NULL)
            break;
    }
    return field_put(object, name, value) ? 0 : ERROR_MEMORY;
}

static void origins_destroy(struct origin *origins, size_t count) {
    for (size_t p = 0; origins != NULL && p < count; p++)
        cJSON_Delete(origins[p].usual);
    free(origins);
}

/* Makes an origin for each parameter that is given or has a default; *count is their number. */
static int origins_create(struct origin **out, size_t *count, const struct study_kind *kind,
                          const cJSON *document, const struct axis *axes, size_t axis_count,
                          struct error *err) {
    struct origin *origins = array_create(parameter_count(kind->tables), sizeof *origins);
    const struct parameter *row;
    size_t n = 0;
    bool complete = origins != NULL;
    for (size_t p = 0; complete && (row = parameter_row(kind->tables, p)) != NULL; p++) {
        struct origin origin = {.path = row->path, .value = json_at(document, row->path)};
        if (origin.value == NULL && row->default_json == NULL)
            continue;
        for (size_t a = 0; a < axis_count; a++)
            if (axes[a].parameter == row)
                origin.axis = &axes[a];
        if (origin.value == NULL)
            origin.value = origin.usual = value_default(row);
        complete = origin.value != NULL;
        origins[n++] = origin;
    }
    if (!complete) {
        origins_destroy(origins, n);
        return error_memory(err, parameter_count(kind->tables) * sizeof *origins, "parameters");
    }
    *out = origins;
    *count = n;
    return 0;
}

/* Moves each axis to its item in a case. Cases come in order, from 0. */
static void axes_move(struct axis *axes, size_t count, size_t number) {
    for (size_t a = 0; number > 0 && a < count; a++)
        if (number % axes[a].stride == 0)
            axes[a].item = axes[a].item->next != NULL ? axes[a].item->next : axes[a].list->child;
}

static int case_create(struct study_case *one, const struct origin *origins, size_t count) {
    one->parameters = cJSON_CreateObject();
    for (size_t p = 0; one->parameters != NULL && p < count; p++) {
        const struct axis *axis = origins[p].axis;
        cJSON *value = cJSON_Duplicate(axis != NULL ? axis->item : origins[p].value, true);
        if (put_at(one->parameters, origins[p].path, value) != 0)
            return ERROR_MEMORY;
    }
    return one->parameters != NULL ? 0 : ERROR_MEMORY;
}

static int fill(struct study *study, const cJSON *document, struct axis *axes, size_t count,
                size_t cases, struct error *err) {
    struct origin *origins = NULL;
    size_t origin_count;
    study->swept = array_create(count + 1, sizeof *study->swept);
    study->cases = array_create(cases, sizeof *study->cases);
    if (study->swept == NULL || study->cases == NULL)
        return error_memory(err, cases * sizeof *study->cases, "cases");
    study->case_count = cases;
    for (size_t a = 0; a < count; a++)
        if ((study->swept[a] = strdup(axes[a].parameter->path)) == NULL)
            return error_memory(err, POINTER_SIZE, "a pointer");
    int status = origins_create(&origins, &origin_count, study->kind, document, axes, count, err);
    if (status != 0)
        return status;
    for (size_t number = 0; status == 0 && number < cases; number++) {
        axes_move(axes, count, number);
        if (case_create(&study->cases[number], origins, origin_count) != 0)
            status = error_memory(err, cases * sizeof *study->cases, "the parameters of cases");
    }
    origins_destroy(origins, origin_count);
    return status;
}

/* Most values of all cases together, as each is a small object in memory. */
static const size_t VALUES_MOST = 20000000;

/* Counts values, those in lists and objects too. */
static size_t count_values(const cJSON *value) {
    size_t count = 1;
    for (const cJSON *item = value->child; item != NULL; item = item->next)
        count += count_values(item);
    return count;
}

/* Returns how many values of the document each case has; a swept list counts as one. */
static size_t case_values(const cJSON *document, const struct axis *axes, size_t count) {
    size_t values = count_values(document);
    for (size_t a = 0; a < count; a++)
        values -= count_values(axes[a].list) - count_values(axes[a].list->child);
    return values;
}

int sweep_open(struct study *study, const cJSON *document, struct fault_list *faults,
               struct error *err) {
    size_t rows = parameter_count(study->kind->tables);
    struct axis *axes = array_create(rows, sizeof *axes);
    if (axes == NULL)
        return error_memory(err, rows * sizeof *axes, "sweeps");
    size_t cases, count = find_axes(study->kind, document, "", axes, 0);
    int status = 0;
    if (!set_strides(axes, count, &cases))
        fault_add(faults, "", "the lists make more than %d cases", STUDY_CASES_MOST);
    else if (cases * case_values(document, axes, count) > VALUES_MOST)
        fault_add(faults, "", "%zu cases of %zu values each are too many: %zu values at most",
                  cases, case_values(document, axes, count), VALUES_MOST);
    else
        status = fill(study, document, axes, count, cases, err);
    free(axes);
    return status;
}

cJSON *sweep_pointers(const struct study_kind *kind, const cJSON *document) {
    struct axis *axes = array_create(parameter_count(kind->tables), sizeof *axes);
    cJSON *pointers = axes != NULL ? cJSON_CreateArray() : NULL;
    bool done = pointers != NULL;
    size_t count = done ? find_axes(kind, document, "", axes, 0) : 0;
    for (size_t a = 0; a < count && done; a++)
        done = list_put(pointers, cJSON_CreateString(axes[a].parameter->path));
    free(axes);
    return fields_finish(pointers, done);
}
