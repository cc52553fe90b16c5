#include "schema/study/parameter.h"
#include <string.h>

const struct parameter *parameter_row(const struct parameter_table *const *tables, size_t index) {
    for (; *tables != NULL; tables++) {
        if (index < (*tables)->count)
            return &(*tables)->rows[index];
        index -= (*tables)->count;
    }
    return NULL;
}

const struct parameter *parameter_find(const struct parameter_table *const *tables,
                                       const char *path, size_t *index) {
    size_t before = 0;
    for (; *tables != NULL; before += (*tables)->count, tables++)
        for (size_t p = 0; p < (*tables)->count; p++)
            if (strcmp((*tables)->rows[p].path, path) == 0) {
                if (index != NULL)
                    *index = before + p;
                return &(*tables)->rows[p];
            }
    return NULL;
}

size_t parameter_count(const struct parameter_table *const *tables) {
    size_t count = 0;
    for (; *tables != NULL; tables++)
        count += (*tables)->count;
    return count;
}

const struct choice *choice_find(const struct choice *choices, const char *name) {
    for (; name != NULL && choices->name != NULL; choices++)
        if (strcmp(choices->name, name) == 0)
            return choices;
    return NULL;
}

const char *choice_name(const struct choice *choices, int value) {
    for (; choices->name != NULL; choices++)
        if (choices->value == value)
            return choices->name;
    return NULL;
}
