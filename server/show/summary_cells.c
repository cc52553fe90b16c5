#include "server/show/summary_cells.h"
#include "server/show/document.h"
#include <string.h>

static bool is_among(const char *name, const char *const *names, size_t count) {
    for (size_t n = 0; n < count; n++)
        if (strcmp(names[n], name) == 0)
            return true;
    return false;
}

/* Whether some case has another value than this one. */
static bool varies(const cJSON *cases, const cJSON *parameter) {
    for (const cJSON *one = cases->child; one; one = one->next)
        if (!cJSON_Compare(parameter, member(member(one, "parameters"), parameter->string), true))
            return true;
    return false;
}

size_t varied_parameters(const cJSON *cases, const char *names[COLUMNS_MOST]) {
    size_t count = 0;
    const cJSON *first = member(cases->child, "parameters");
    for (const cJSON *one = cases->child; one; one = one->next)
        for (const cJSON *p = first_of(one, "parameters"); p && count < COLUMNS_MOST; p = p->next) {
            bool candidate = one == cases->child ? varies(cases, p) : !member(first, p->string);
            if (candidate && !is_among(p->string, names, count))
                names[count++] = p->string;
        }
    return count;
}

const char *last_name(const char *pointer) {
    const char *slash = strrchr(pointer, '/');
    return slash ? slash + 1 : pointer;
}

void value_cell(struct text_table *table, const cJSON *value) {
    if (cJSON_IsString(value))
        table_cell(table, "%s", value->valuestring);
    else
        table_number(table, cJSON_IsNumber(value) ? value->valuedouble : (double)NAN);
}

void measured_text(double value, double error, char *out, size_t size) {
    if (!isfinite(value)) {
        snprintf(out, size, "-");
        return;
    }
    bool uncertain = error > 1e-9 * fabs(value);
    int decimals = uncertain ? 1 - (int)floor(log10(error)) : 0;
    decimals = decimals < 0 ? 0 : decimals;
    if (!uncertain)
        snprintf(out, size, "%.5g", value);
    else if (decimals > 9)
        snprintf(out, size, "%.5g +- %.2g", value, error);
    else
        snprintf(out, size, "%.*f +- %.*f", decimals, value, decimals, error);
}

void measured_cell(struct text_table *table, double value, double error) {
    char text[64];
    measured_text(value, error, text, sizeof text);
    table_cell(table, "%s", text);
}

const char *partial_text(double realisations, double valueless, char *out, size_t size) {
    out[0] = 0;
    if (valueless > 0)
        snprintf(out, size, " (%.0f of %.0f)", realisations - valueless, realisations);
    return out;
}

/* At any point, or in all of a report's curve. */
static bool is_partial(const cJSON *curve) {
    const cJSON *valueless = member(curve, "valueless");
    for (const cJSON *v = first_of(curve, "valueless"); v; v = v->next)
        if (v->valuedouble > 0)
            return true;
    return cJSON_IsNumber(valueless) && valueless->valuedouble > 0;
}

void print_partial(const cJSON *cases, FILE *file) {
    for (const cJSON *one = cases->child; one; one = one->next)
        for (const cJSON *curve = first_of(one, "curves"); curve; curve = curve->next)
            if (is_partial(curve)) {
                fputs(
                    "\n(n of N): only n of N realisations have a value at the load; of a curve, at "
                    "the load with fewest\n",
                    file);
                return;
            }
}

void percent_cell(struct text_table *table, double share) {
    if (isnan(share))
        table_cell(table, "-");
    else
        table_cell(table, "%.2g", 100 * share);
}

void print_swept(const cJSON *one, const char *const *names, size_t count, FILE *file) {
    for (size_t n = 0; n < count; n++) {
        const cJSON *value = member(member(one, "parameters"), names[n]);
        if (cJSON_IsString(value))
            fprintf(file, "%s, ", value->valuestring);
        else if (cJSON_IsNumber(value))
            fprintf(file, "%s %.5g, ", last_name(names[n]), value->valuedouble);
    }
}

const char *model_text(const cJSON *curve, char *out, size_t size) {
    const char *model = text_of(curve, "model", "-");
    const char *kinematics = text_of(curve, "kinematics", NULL);
    if (kinematics)
        snprintf(out, size, "%s (%s)", model, kinematics);
    else
        snprintf(out, size, "%s", model);
    return out;
}

static bool ends_with(const char *text, const char *end) {
    size_t length = strlen(text), tail = strlen(end);
    return length >= tail && strcmp(text + length - tail, end) == 0;
}

bool is_bracket(const cJSON *curve) {
    const char *series = text_of(curve, "series", "");
    return ends_with(series, "_lower") || ends_with(series, "_upper");
}

void print_notes(const cJSON *cases, size_t most, FILE *file) {
    double count = 0, shown = 0;
    for (const cJSON *one = cases->child; one; one = one->next)
        count += fmax(number_of(member(one, "notes"), "count"), 0);
    if (count > 0)
        fprintf(file, "\nnotes: %.0f\n", count);
    for (const cJSON *one = cases->child; one; one = one->next) {
        const cJSON *note = first_of(member(one, "notes"), "kept");
        for (; note && shown < (double)most; note = note->next, shown++)
            fprintf(file, "case %.0f, realisation %.0f: %s\n", number_of(one, "case"),
                    number_of(note, "realisation"), text_of(note, "text", "-"));
    }
    if (shown < count)
        fprintf(file, "and %.0f more\n", count - shown);
}
