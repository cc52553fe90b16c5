#include "schema/study/value.h"
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Prints the fewest digits, of 15 or more, that read back to the bound. */
static void bound_print(double bound, char *text, size_t size) {
    if (isinf(bound)) {
        snprintf(text, size, "%sinfinity", bound < 0 ? "-" : "");
        return;
    }
    int digits = 15;
    do
        snprintf(text, size, "%.*g", digits, bound);
    while (strtod(text, NULL) != bound && ++digits <= 17);
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

/* Adds the fault "TEXT is not WHAT", in which TEXT is the value as written. */
static bool is_not(const cJSON *value, const char *pointer, struct fault_list *faults,
                   const char *what) {
    char text[48];
    json_describe(value, text, sizeof text);
    fault_add(faults, pointer, "%s is not %s", text, what);
    return false;
}

static bool range_check(const struct parameter *parameter, const cJSON *value, const char *pointer,
                        struct fault_list *faults) {
    if (in_range(parameter, value->valuedouble))
        return true;
    char range[80], what[96];
    value_range(parameter, range, sizeof range);
    snprintf(what, sizeof what, "in %s", range);
    return is_not(value, pointer, faults, what);
}

static bool number_fits(const struct parameter *parameter, const cJSON *value) {
    return cJSON_IsNumber(value) && in_range(parameter, value->valuedouble) &&
           (parameter->type != PARAMETER_INTEGER || value->valuedouble == rint(value->valuedouble));
}

static bool number_check(const struct parameter *parameter, const cJSON *value, const char *pointer,
                         struct fault_list *faults) {
    bool integer = parameter->type == PARAMETER_INTEGER;
    if (!cJSON_IsNumber(value))
        return is_not(value, pointer, faults, integer ? "an integer" : "a number");
    if (integer && value->valuedouble != rint(value->valuedouble))
        return is_not(value, pointer, faults, "an integer");
    return range_check(parameter, value, pointer, faults);
}

/* Counts the characters of a UTF-8 text: bytes that do not continue a character. */
static size_t characters(const char *text) {
    size_t n = 0;
    for (; *text != '\0'; text++)
        n += ((unsigned char)*text & 0xc0u) != 0x80u;
    return n;
}

/* Returns whether a UTF-8 text has control characters, which a terminal would obey. */
static bool has_controls(const char *text) {
    for (const unsigned char *s = (const unsigned char *)text; *s != '\0'; s++)
        if (*s < ' ' || *s == 0x7f || (*s == 0xc2 && s[1] >= 0x80 && s[1] < 0xa0))
            return true;
    return false;
}

static bool text_check(const struct parameter *parameter, const cJSON *value, const char *pointer,
                       struct fault_list *faults) {
    if (cJSON_IsString(value) && in_range(parameter, (double)characters(value->valuestring)) &&
        !has_controls(value->valuestring))
        return true;
    char what[96];
    snprintf(what, sizeof what, "a text of %.0f to %.0f characters, none a control character",
             parameter->minimum, parameter->maximum);
    return is_not(value, pointer, faults, what);
}

bool value_seed(const cJSON *value, uint64_t *seed) {
    if (cJSON_IsNumber(value)) {
        *seed = (uint64_t)value->valuedouble;
        return true;
    }
    const char *text = cJSON_GetStringValue(value);
    if (text == NULL || *text == '\0' || strspn(text, "0123456789") != strlen(text))
        return false;
    errno = 0;
    *seed = strtoull(text, NULL, 10);
    return errno == 0;
}

static bool seed_check(const struct parameter *parameter, const cJSON *value, const char *pointer,
                       struct fault_list *faults) {
    uint64_t seed;
    if (cJSON_IsString(value)) {
        if (value_seed(value, &seed))
            return true;
        return is_not(value, pointer, faults, "a decimal number up to 18446744073709551615");
    }
    if (!cJSON_IsNumber(value) || value->valuedouble != rint(value->valuedouble) ||
        value->valuedouble < 0)
        return is_not(value, pointer, faults, "an integer of 0 or more");
    if (in_range(parameter, value->valuedouble))
        return true;
    char range[80], what[160];
    value_range(parameter, range, sizeof range);
    snprintf(what, sizeof what, "in %s; write a larger seed as a decimal string", range);
    return is_not(value, pointer, faults, what);
}

/* Writes the names of choices: "first", "second". */
void value_choices(const struct choice *choices, char *text, size_t size) {
    size_t used = 0;
    for (*text = 0; choices->name != NULL && used < size - 1; choices++)
        used += (size_t)snprintf(text + used, size - used, "%s\"%s\"", used > 0 ? ", " : "",
                                 choices->name);
}

static bool choice_check(const struct parameter *parameter, const cJSON *value, const char *pointer,
                         struct fault_list *faults) {
    if (choice_find(parameter->choices, cJSON_GetStringValue(value)) != NULL)
        return true;
    char allowed[256], what[272];
    value_choices(parameter->choices, allowed, sizeof allowed);
    snprintf(what, sizeof what, "one of %s", allowed);
    return is_not(value, pointer, faults, what);
}

static bool flag_check(const cJSON *value, const char *pointer, struct fault_list *faults) {
    return cJSON_IsBool(value) || is_not(value, pointer, faults, "true or false");
}

static bool choices_check(const struct parameter *parameter, const cJSON *value,
                          const char *pointer, struct fault_list *faults) {
    if (!cJSON_IsArray(value))
        return choice_check(parameter, value, pointer, faults);
    bool good = value->child;
    if (!good)
        fault_add(faults, pointer, "an empty list; give at least one value");
    size_t i = 0;
    for (const cJSON *item = value->child; item != NULL; item = item->next, i++) {
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
    if (choice_find(parameter->choices, cJSON_GetStringValue(value)) != NULL)
        return true;
    const cJSON *number = cJSON_IsObject(value) ? value->child : NULL;
    if (number != NULL && number->next == NULL &&
        choice_find(parameter->units, number->string) != NULL) {
        char at[POINTER_SIZE];
        snprintf(at, sizeof at, "%s/%s", pointer, number->string);
        return number_check(parameter, number, at, faults);
    }
    char allowed[128], units[128], what[320];
    value_choices(parameter->choices, allowed, sizeof allowed);
    value_choices(parameter->units, units, sizeof units);
    snprintf(what, sizeof what, "one of %s, nor an object of one number named %s", allowed, units);
    return is_not(value, pointer, faults, what);
}

static bool numbers_check(const struct parameter *parameter, const cJSON *value,
                          const char *pointer, struct fault_list *faults) {
    size_t count = (size_t)cJSON_GetArraySize(value);
    bool good =
        cJSON_IsArray(value) && count >= parameter->items_low && count <= parameter->items_high;
    if (parameter->choices != NULL &&
        choice_find(parameter->choices, cJSON_GetStringValue(value)) != NULL)
        return true;
    if (!good) {
        char what[80], allowed[128], either[240];
        if (parameter->items_low == parameter->items_high)
            snprintf(what, sizeof what, "an array of %zu numbers", parameter->items_low);
        else
            snprintf(what, sizeof what, "an array of %zu to %zu numbers", parameter->items_low,
                     parameter->items_high);
        if (parameter->choices == NULL)
            return is_not(value, pointer, faults, what);
        value_choices(parameter->choices, allowed, sizeof allowed);
        snprintf(either, sizeof either, "%s, nor one of %s", what, allowed);
        return is_not(value, pointer, faults, either);
    }
    size_t i = 0;
    for (const cJSON *item = value->child; item != NULL; item = item->next, i++) {
        char at[POINTER_SIZE];
        if (number_fits(parameter, item))
            continue; /* saves the pointers of thousands of valid numbers */
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
    case PARAMETER_TEXT:
        return text_check(parameter, value, pointer, faults);
    case PARAMETER_SEED:
        return seed_check(parameter, value, pointer, faults);
    case PARAMETER_CHOICE:
        return choice_check(parameter, value, pointer, faults);
    case PARAMETER_FLAG:
        return flag_check(value, pointer, faults);
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

cJSON *value_default(const struct parameter *parameter) {
    return parameter->default_json != NULL ? cJSON_Parse(parameter->default_json) : NULL;
}

void value_missing(const struct parameter *parameter, struct fault_list *faults) {
    char allowed[256] = "";
    if (parameter->type == PARAMETER_CHOICE)
        value_choices(parameter->choices, allowed, sizeof allowed);
    fault_add(faults, parameter->path, "missing: %s%s%s", parameter->help,
              *allowed != '\0' ? "; one of " : "", allowed);
}
