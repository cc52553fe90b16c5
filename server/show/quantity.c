#include "server/show/quantity.h"
#include "core/map/length_unit.h"
#include <math.h>
#include <stdio.h>
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

bool rising_numbers(const char *text, size_t most, double *out, size_t *count) {
    double last = 0;
    *count = 0;
    for (char *stop;; text = stop + 1) {
        double value = strtod(text, &stop);
        if (stop == text || !(value > last && isfinite(value)) || *count == most)
            return false;
        out[(*count)++] = last = value;
        if (*stop == '\0')
            return true;
        if (*stop != ',')
            return false;
    }
}

/* Says of one that could not be read whether it is no number, has no unit, or another one. */
static int refuse_quantity(const char *text, size_t width, const char *unit, struct error *err) {
    char copy[64], *end;
    snprintf(copy, sizeof copy, "%.*s", (int)(width < sizeof copy ? width : sizeof copy), text);
    double value = strtod(copy, &end);
    end += strspn(end, " ");
    if (end == copy || !(value > 0 && isfinite(value)))
        return error_set(err, ERROR_INPUT, "\"%.40s\" is no number above 0 with a unit", copy);
    if (*end == '\0')
        return error_set(err, ERROR_INPUT, "%.40s has no unit, %s or one with a prefix from p to T",
                         copy, unit);
    return error_set(err, ERROR_INPUT,
                     "\"%.20s\" is not the unit %s, which may have a prefix from p to T; capitals "
                     "count",
                     end, unit);
}

int quantities_parse(const char *text, const char *unit, size_t most, double *out, size_t *count,
                     struct error *err) {
    const char *before = text;
    *count = 0;
    for (;; text++) {
        size_t width = strcspn(text, ",");
        if (*count == most)
            return error_set(err, ERROR_INPUT, "more than %zu values", most);
        if (!quantity_parse(text, width, unit, &out[*count]))
            return refuse_quantity(text, width, unit, err);
        if (*count > 0 && !(out[*count] > out[*count - 1]))
            return error_set(err, ERROR_INPUT, "must rise; %.*s is not above %.*s",
                             (int)(width < 40 ? width : 40), text, (int)strcspn(before, ","),
                             before);
        ++*count;
        before = text;
        text += width;
        if (*text == '\0')
            return 0;
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

/* Of inverse units, for numbers of 1 to 1000 rather than of 0.001 to 1. */
static const double LARGER = 999.999;

/* Writes a unit that is no power of a length. */
static double prefixed_unit(const char *unit, double most, char *out, size_t size) {
    bool inverse = strncmp(unit, "1/", 2) == 0;
    double scale = 1;
    const char *prefix = quantity_prefix(inverse ? LARGER / most : most, &scale);
    snprintf(out, size, "%s%s%s", inverse ? "1/" : "", prefix, inverse ? unit + 2 : unit);
    return inverse ? 1 / scale : scale;
}

double unit_readable(const char *unit, double most, char *out, size_t size) {
    bool inverse = strncmp(unit, "1/", 2) == 0;
    const char *length = inverse ? unit + 2 : unit, *power = *length == 'm' ? length + 1 : "-";
    double scale, exponent = *power == '^' ? strtod(power + 1, NULL) : 1;
    most = most > 0 && isfinite(most) ? most : 1; /* nothing to read */
    *out = '\0';
    if (strcmp(unit, "1") == 0)
        return 1;
    if (*power != '\0' && *power != '^')
        return prefixed_unit(unit, most, out, size);
    const char *name =
        length_unit_readable(pow(inverse ? LARGER / most : most, 1 / exponent), &scale);
    snprintf(out, size, "%s%s%s", inverse ? "1/" : "", name, power);
    scale = pow(scale, exponent);
    return inverse ? 1 / scale : scale;
}

void unit_note(const char *label, const char *symbol, const char *unit, double scale, char *out,
               size_t size) {
    char name[32];
    double readable = unit_readable(unit, scale, name, sizeof name);
    snprintf(out, size, "%.60s of 1: %s = %.4g %s", label, symbol, scale / readable, name);
}
