#include "server/show/map/named_values.h"
#include "core/error.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

void named_values_add(struct named_values *out, const char *group, const char *name, double value) {
    if (out->count < NAMED_VALUES_MOST)
        out->list[out->count++] = (struct named_value){group, name, value, 0, NULL};
}

void named_values_add_length(struct named_values *out, const char *group, const char *name,
                             double value, int power) {
    if (out->count < NAMED_VALUES_MOST)
        out->list[out->count++] = (struct named_value){group, name, value, power, NULL};
}

void named_values_add_text(struct named_values *out, const char *group, const char *name,
                           const char *text) {
    if (out->count < NAMED_VALUES_MOST)
        out->list[out->count++] = (struct named_value){group, name, (double)NAN, 0, text};
}

double *named_values_column_length(struct named_values *out, const char *group, const char *name,
                                   size_t count, int power) {
    double *values = out->column_count < NAMED_COLUMNS_MOST
                         ? array_create(count > 0 ? count : 1, sizeof *values)
                         : NULL;
    if (values != NULL)
        out->columns[out->column_count++] =
            (struct named_column){group, name, values, count, power};
    return values;
}

void named_values_clear(struct named_values *values) {
    for (size_t c = 0; c < values->column_count; c++)
        free(values->columns[c].values);
    *values = (struct named_values){0};
}

static const struct named_value *find(const struct named_values *values, const char *group,
                                      const char *name) {
    for (size_t n = 0; n < values->count; n++)
        if (strcmp(values->list[n].group, group) == 0 && strcmp(values->list[n].name, name) == 0)
            return &values->list[n];
    return NULL;
}

double named_number(const struct named_values *values, const char *group, const char *name) {
    const struct named_value *found = find(values, group, name);
    return found != NULL ? found->value : (double)NAN;
}

const char *named_text(const struct named_values *values, const char *group, const char *name) {
    const struct named_value *found = find(values, group, name);
    return found != NULL ? found->text : NULL;
}

const struct named_column *named_column_find(const struct named_values *values, const char *group,
                                             const char *name) {
    for (size_t c = 0; c < values->column_count; c++)
        if (strcmp(values->columns[c].group, group) == 0 &&
            strcmp(values->columns[c].name, name) == 0)
            return &values->columns[c];
    return NULL;
}

static bool is_listed(const char *groups, const char *name) {
    const size_t length = strlen(name);
    for (const char *at = groups;; at += strcspn(at, ",") + 1) {
        if (strcspn(at, ",") == length && strncmp(at, name, length) == 0)
            return true;
        if (at[strcspn(at, ",")] == '\0')
            return false;
    }
}

static bool has_group(const struct named_values *values, const char *name, size_t length) {
    for (size_t n = 0; n < values->count; n++)
        if (strlen(values->list[n].group) == length &&
            strncmp(values->list[n].group, name, length) == 0)
            return true;
    for (size_t c = 0; c < values->column_count; c++)
        if (strlen(values->columns[c].group) == length &&
            strncmp(values->columns[c].group, name, length) == 0)
            return true;
    return false;
}

static void append_group(char *text, size_t size, const char *group) {
    size_t used = strlen(text);
    bool known = false;
    for (const char *at = text; (at = strstr(at, group)) != NULL && !known; at++)
        known = (at == text || at[-1] == ' ') && strchr(", ", at[strlen(group)]) != NULL;
    if (!known)
        snprintf(text + used, size - used, "%s%s", used > 0 ? ", " : "", group);
}

void named_values_groups(const struct named_values *values, char *text, size_t size) {
    *text = '\0';
    for (size_t n = 0; n < values->count; n++)
        append_group(text, size, values->list[n].group);
    for (size_t c = 0; c < values->column_count; c++)
        append_group(text, size, values->columns[c].group);
}

bool named_values_keep(struct named_values *values, const char *groups, const char **unknown,
                       size_t *length) {
    for (*unknown = groups;; *unknown += *length + 1) {
        *length = strcspn(*unknown, ",");
        if (!has_group(values, *unknown, *length))
            return false;
        if ((*unknown)[*length] == '\0')
            break;
    }
    size_t count = 0, columns = 0;
    for (size_t n = 0; n < values->count; n++)
        if (is_listed(groups, values->list[n].group))
            values->list[count++] = values->list[n];
    for (size_t c = 0; c < values->column_count; c++)
        if (is_listed(groups, values->columns[c].group))
            values->columns[columns++] = values->columns[c];
        else
            free(values->columns[c].values);
    values->count = count;
    values->column_count = columns;
    return true;
}
