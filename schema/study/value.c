#include "schema/study/value.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void value_describe(const cJSON *value, char *text, size_t size) {
    char *printed = json_print(value);
    snprintf(text, size, "%s", printed ? printed : "a value");
    if (printed && strlen(printed) >= size)
        memcpy(text + size - 4, "...", 4);
    free(printed);
}

static void bound_print(double bound, char *text, size_t size) {
    if (isinf(bound))
        snprintf(text, size, "%sinfinity", bound < 0 ? "-" : "");
    else
        snprintf(text, size, "%.15g", bound);
}

void value_range(const struct parameter *parameter, char *text, size_t size) {
    char low[32], high[32];
    bound_print(parameter->minimum, low, sizeof low);
    bound_print(parameter->maximum, high, sizeof high);
    snprintf(text, size, "%c%s, %s%c",
             parameter->above_minimum || isinf(parameter->minimum) ? '(' : '[', low, high,
             parameter->below_maximum || isinf(parameter->maximum) ? ')' : ']');
}

static bool in_range(const struct parameter *parameter, double value) {
    bool above =
        parameter->above_minimum ? value > parameter->minimum : value >= parameter->minimum;
    bool below =
        parameter->below_maximum ? value < parameter->maximum : value <= parameter->maximum;
    return above && below;
}

static bool number_check(const struct parameter *parameter, const cJSON *value, const char *pointer,
                         struct fault_list *faults) {
    char text[48], range[80];
    value_describe(value, text, sizeof text);
    bool integer = parameter->type == PARAMETER_INTEGER;
    if (!cJSON_IsNumber(value)) {
        fault_add(faults, pointer, "%s is not %s", text, integer ? "an integer" : "a number");
        return false;
    }
    if (integer && value->valuedouble != rint(value->valuedouble)) {
        fault_add(faults, pointer, "%s is not an integer", text);
        return false;
    }
    if (!in_range(parameter, value->valuedouble)) {
        value_range(parameter, range, sizeof range);
        fault_add(faults, pointer, "%s is not in %s", text, range);
        return false;
    }
    return true;
}

static bool is_one_of(const char *const *names, const char *name) {
    for (; name && *names; names++)
        if (strcmp(*names, name) == 0)
            return true;
    return false;
}

/* "first", "second" */
static void names_print(const char *const *names, char *text, size_t size) {
    size_t used = 0;
    for (*text = 0; *names && used < size - 1; names++)
        used += (size_t)snprintf(text + used, size - used, "%s\"%s\"", used ? ", " : "", *names);
}

static bool choice_check(const struct parameter *parameter, const cJSON *value, const char *pointer,
                         struct fault_list *faults) {
    if (is_one_of(parameter->choices, cJSON_GetStringValue(value)))
        return true;
    char text[48], allowed[256];
    value_describe(value, text, sizeof text);
    names_print(parameter->choices, allowed, sizeof allowed);
    fault_add(faults, pointer, "%s is not one of %s", text, allowed);
    return false;
}

static bool choices_check(const struct parameter *parameter, const cJSON *value,
                          const char *pointer, struct fault_list *faults) {
    if (!cJSON_IsArray(value))
        return choice_check(parameter, value, pointer, faults);
    bool good = value->child;
    if (!good)
        fault_add(faults, pointer, "an empty list; give at least one value");
    size_t i = 0;
    for (const cJSON *item = value->child; item; item = item->next, i++) {
        char at[POINTER_SIZE];
        snprintf(at, sizeof at, "%s/%zu", pointer, i);
        bool fits = choice_check(parameter, item, at, faults), twice = false;
        for (const cJSON *other = value->child; fits && other != item; other = other->next)
            twice = twice || cJSON_Compare(other, item, true);
        if (twice)
            fault_add(faults, at, "\"%s\" is there already", item->valuestring);
        good = good && fits && !twice;
    }
    return good;
}

static bool measure_check(const struct parameter *parameter, const cJSON *value,
                          const char *pointer, struct fault_list *faults) {
    if (is_one_of(parameter->choices, cJSON_GetStringValue(value)))
        return true;
    const cJSON *number = cJSON_IsObject(value) ? value->child : NULL;
    if (number && !number->next && is_one_of(parameter->units, number->string)) {
        char at[POINTER_SIZE];
        snprintf(at, sizeof at, "%s/%s", pointer, number->string);
        return number_check(parameter, number, at, faults);
    }
    char text[48], allowed[128], units[128];
    value_describe(value, text, sizeof text);
    names_print(parameter->choices, allowed, sizeof allowed);
    names_print(parameter->units, units, sizeof units);
    fault_add(faults, pointer, "%s is not one of %s, nor an object of one number named %s", text,
              allowed, units);
    return false;
}

static bool numbers_check(const struct parameter *parameter, const cJSON *value,
                          const char *pointer, struct fault_list *faults) {
    size_t count = (size_t)cJSON_GetArraySize(value);
    bool good =
        cJSON_IsArray(value) && count >= parameter->items_low && count <= parameter->items_high;
    if (!good) {
        char text[48];
        value_describe(value, text, sizeof text);
        if (parameter->items_low == parameter->items_high)
            fault_add(faults, pointer, "%s is not an array of %zu numbers", text,
                      parameter->items_low);
        else
            fault_add(faults, pointer, "%s is not an array of %zu to %zu numbers", text,
                      parameter->items_low, parameter->items_high);
        return false;
    }
    size_t i = 0;
    for (const cJSON *item = value->child; item; item = item->next, i++) {
        char at[POINTER_SIZE];
        snprintf(at, sizeof at, "%s/%zu", pointer, i);
        good = number_check(parameter, item, at, faults) && good;
    }
    return good;
}

bool value_check(const struct parameter *parameter, const cJSON *value, const char *pointer,
                 struct fault_list *faults) {
    switch (parameter->type) {
    case PARAMETER_NUMBER:
    case PARAMETER_INTEGER:
        return number_check(parameter, value, pointer, faults);
    case PARAMETER_CHOICE:
        return choice_check(parameter, value, pointer, faults);
    case PARAMETER_NUMBERS:
        return numbers_check(parameter, value, pointer, faults);
    case PARAMETER_CHOICES:
        return choices_check(parameter, value, pointer, faults);
    case PARAMETER_MEASURE:
        return measure_check(parameter, value, pointer, faults);
    }
    return false;
}

bool value_is_list(const struct parameter *parameter, const cJSON *value) {
    if (!cJSON_IsArray(value))
        return false;
    bool one = parameter->type == PARAMETER_NUMBERS || parameter->type == PARAMETER_CHOICES;
    return !one || cJSON_IsArray(value->child);
}
