#include "server/show/plot_choice.h"
#include "server/show/document.h"
#include "server/show/summary_cells.h"
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

/* How narrow the choice is: each step keeps what those before it keep. */
enum { KEEP_ESTIMATES = 1, KEEP_FINEST, KEEP_SERIES, KEEP_MODEL, KEEP_FIRST };

struct choosing {
    const char *quantity, *y_label;
    const cJSON *first; /* the first curve of all */
    int narrow;
};

/* No matrices. */
static bool is_candidate(const struct choosing *choosing, const cJSON *curve) {
    return strcmp(text_of(curve, "quantity", ""), choosing->quantity) == 0 &&
           !member(curve, "x2") &&
           (!choosing->y_label || strcmp(text_of(curve, "y_label", ""), choosing->y_label) == 0);
}

static bool same_series(const cJSON *a, const cJSON *b) {
    return same_member(a, b, "quantity") && same_member(a, b, "series") &&
           same_member(a, b, "model") && same_member(a, b, "pressure");
}

/* Levels of the same series that are finer. */
static size_t finer_levels(const cJSON *one, const cJSON *curve) {
    size_t finer = 0;
    for (const cJSON *other = first_of(one, "curves"); other; other = other->next)
        finer += number_of(other, "level") > number_of(curve, "level") && same_series(other, curve);
    return finer;
}

static bool is_kept(const struct choosing *choosing, const cJSON *one, const cJSON *curve) {
    int narrow = choosing->narrow;
    return is_candidate(choosing, curve) && (narrow < KEEP_ESTIMATES || !is_bracket(curve)) &&
           (narrow < KEEP_FINEST || finer_levels(one, curve) == 0) &&
           (narrow < KEEP_SERIES || same_member(curve, choosing->first, "series")) &&
           (narrow < KEEP_MODEL || same_member(curve, choosing->first, "model"));
}

/* That of an earlier line of the series, or a new one. */
static size_t colour_of(const struct plot_choice *choice, const struct plot_line *line) {
    size_t colours = 0;
    for (const struct plot_line *l = choice->lines; l < line; l++) {
        if (l->one == line->one && same_series(l->curve, line->curve))
            return l->colour;
        colours = l->colour + 1 > colours ? l->colour + 1 : colours;
    }
    return colours;
}

/* Curves kept; the first of them fill the choice. */
static size_t collect(struct plot_choice *choice, const struct choosing *choosing) {
    size_t found = 0;
    choice->count = 0;
    for (const cJSON *one = choice->cases; one; one = one->next)
        for (const cJSON *curve = first_of(one, "curves"); curve; curve = curve->next) {
            if (!is_kept(choosing, one, curve))
                continue;
            if (found++ < PLOT_LINES) {
                struct plot_line *line = &choice->lines[choice->count++];
                *line = (struct plot_line){one, curve, 0, finer_levels(one, curve)};
                line->colour = colour_of(choice, line);
            }
        }
    return found;
}

static const cJSON *first_candidate(const cJSON *cases, const struct choosing *choosing) {
    for (const cJSON *one = cases; one; one = one->next)
        for (const cJSON *curve = first_of(one, "curves"); curve; curve = curve->next)
            if (is_candidate(choosing, curve))
                return curve;
    return NULL;
}

__attribute__((format(printf, 2, 3))) static void append(char label[PLOT_LABEL_SIZE],
                                                         const char *format, ...) {
    size_t used = strlen(label);
    va_list arguments;
    if (used)
        used += (size_t)snprintf(label + used, PLOT_LABEL_SIZE - used, ", ");
    if (used >= PLOT_LABEL_SIZE)
        return;
    va_start(arguments, format);
    vsnprintf(label + used, PLOT_LABEL_SIZE - used, format, arguments);
    va_end(arguments);
}

/* Says what a step that left something out has kept. */
static void note(struct plot_choice *choice, const struct choosing *choosing, size_t before) {
    char *text = choice->left_out, model[64];
    if (choosing->narrow == KEEP_ESTIMATES)
        append(text, "without brackets");
    else if (choosing->narrow == KEEP_FINEST)
        append(text, "finest level");
    else if (choosing->narrow == KEEP_SERIES)
        append(text, "%.40s", text_of(choosing->first, "series", ""));
    else if (choosing->narrow == KEEP_MODEL)
        append(text, "%s", model_text(choosing->first, model, sizeof model));
    else
        append(text, "first %d of %zu curves", PLOT_LINES, before);
}

void plot_choose(struct plot_choice *choice, const cJSON *curves, const char *quantity,
                 const char *y_label) {
    struct choosing choosing = {.quantity = quantity, .y_label = y_label};
    *choice = (struct plot_choice){.cases = first_of(curves, "cases")};
    choosing.first = first_candidate(choice->cases, &choosing);
    if (!choosing.first)
        return;
    choosing.y_label = text_of(choosing.first, "y_label", "");
    size_t found = collect(choice, &choosing);
    while (found > PLOT_LINES && choosing.narrow < KEEP_FIRST) {
        choosing.narrow++;
        size_t kept = collect(choice, &choosing);
        if (kept < found || choosing.narrow == KEEP_FIRST)
            note(choice, &choosing, found);
        found = kept;
    }
}

/* --- labels --- */

static bool varies(const cJSON *cases, const cJSON *parameter) {
    for (const cJSON *other = cases; other; other = other->next)
        if (!cJSON_Compare(parameter, member(member(other, "parameters"), parameter->string), true))
            return true;
    return false;
}

/* Whether the lines differ in a member of their curves. */
static bool lines_differ(const struct plot_choice *choice, const char *name) {
    for (size_t n = 1; n < choice->count; n++)
        if (!same_member(choice->lines[n].curve, choice->lines[0].curve, name))
            return true;
    return false;
}

void plot_label(const struct plot_choice *choice, size_t line, char label[PLOT_LABEL_SIZE]) {
    const cJSON *one = choice->lines[line].one, *curve = choice->lines[line].curve;
    const char *series = text_of(curve, "series", "");
    char model[64];
    label[0] = 0;
    for (const cJSON *p = first_of(one, "parameters"); p; p = p->next) {
        const char *slash = strrchr(p->string, '/');
        if (!varies(choice->cases, p))
            continue;
        if (cJSON_IsString(p))
            append(label, "%s", p->valuestring);
        else
            append(label, "%s %.5g", slash ? slash + 1 : p->string, p->valuedouble);
    }
    if (lines_differ(choice, "pressure"))
        append(label, "at %.4g", number_of(curve, "pressure"));
    if (lines_differ(choice, "model") || member(curve, "kinematics"))
        append(label, "%s", model_text(curve, model, sizeof model));
    if (*series)
        append(label, "%s", series);
    if (lines_differ(choice, "level"))
        append(label, "level %.4g", number_of(curve, "level"));
    if (!*label)
        append(label, "case %.0f", number_of(one, "case"));
}
