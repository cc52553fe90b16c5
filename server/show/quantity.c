#include "server/show/quantity.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const struct prefix {
    const char *name;
    double scale;
} PREFIXES[] = {
    {"T", 1e12}, {"G", 1e9},         {"M", 1e6},         {"k", 1e3},
    {"", 1},     {"m", 1e-3},        {"\xc2\xb5", 1e-6}, /* micro sign, by which tables print it */
    {"u", 1e-6}, {"\xce\xbc", 1e-6},                     /* Greek mu */
    {"n", 1e-9}, {"p", 1e-12}};
enum { PREFIX_COUNT = sizeof PREFIXES / sizeof *PREFIXES };

/* Returns what a text of a unit with its prefix stands for; 0 where it is none. */
static double unit_scale(const char *text, const char *unit) {
    for (size_t a = 0; a < PREFIX_COUNT; a++) {
        size_t length = strlen(PREFIXES[a].name);
        if (strncmp(text, PREFIXES[a].name, length) == 0 && strcmp(text + length, unit) == 0)
            return PREFIXES[a].scale;
    }
    return 0;
}

bool quantity_parse(const char *text, size_t size, const char *unit, double *out) {
    char copy[64];
    char *end;
    if (size == 0 || size >= sizeof copy || strchr("+.0123456789", *text) == NULL)
        return false;
    memcpy(copy, text, size);
    copy[size] = '\0';
    double value = strtod(copy, &end);
    if (end == copy)
        return false;
    end += strspn(end, " ");
    value *= unit_scale(end, unit);
    if (!(value > 0 && isfinite(value)))
        return false;
    *out = value;
    return true;
}

bool quantities_parse(const char *text, const char *unit, size_t most, double *out, size_t *count) {
    *count = 0;
    for (;; text++) {
        size_t width = strcspn(text, ",");
        if (*count == most || !quantity_parse(text, width, unit, &out[*count]) ||
            (*count > 0 && !(out[*count] > out[*count - 1])))
            return false;
        ++*count;
        text += width;
        if (*text == '\0')
            return true;
    }
}

const char *quantity_prefix(double value, double *scale) {
    size_t a = 0, last = PREFIX_COUNT - 1;
    *scale = 1;
    if (!(fabs(value) > 0 && isfinite(value)))
        return "";
    while (a < last && fabs(value) < PREFIXES[a].scale * (1 - 1e-12))
        a++;
    /* The names of one prefix follow each other, the one to print first. */
    *scale = PREFIXES[a].scale;
    return PREFIXES[a].name;
}
