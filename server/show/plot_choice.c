#include "server/show/plot_choice.h"
#include "server/show/summary_cells.h"
#include <math.h>
#include <stdarg.h>
#include <string.h>

/* The choice narrows by steps, each of which keeps no more than those before it. */
enum { KEEP_ESTIMATES = 1, KEEP_FINEST, KEEP_SERIES, KEEP_MODEL, KEEP_FIRST };

struct choosing {
    const char *quantity, *y_label;
    const struct curve *first; /* the first curve of all */
    int narrow;
};

/* Says whether a curve may be drawn; matrices may not. */
static bool is_candidate(const struct choosing *choosing, const struct curve *curve) {
    return strcmp(curve->quantity, choosing->quantity) == 0 && curve->columns == 0 &&
           (choosing->y_label == NULL || same_text(curve->y_label, choosing->y_label));
}

static bool same_colour(const struct curve *a, const struct curve *b) {
    return curve_same_series(a, b) && same_text(a->model, b->model);
}

/* Counts the levels of the same series that are finer. */
static size_t finer_levels(const struct case_result *one, const struct curve *curve) {
    size_t finer = 0;
    for (size_t a = 0; a < one->curve_count; a++)
        finer += one->curves[a].level > curve->level && same_colour(&one->curves[a], curve);
    return finer;
}

static bool is_kept(const struct choosing *choosing, const struct case_result *one,
                    const struct curve *curve) {
    int narrow = choosing->narrow;
    return is_candidate(choosing, curve) &&
           (narrow < KEEP_ESTIMATES || !is_bracket(curve->series)) &&
           (narrow < KEEP_FINEST || finer_levels(one, curve) == 0) &&
           (narrow < KEEP_SERIES || same_text(curve->series, choosing->first->series)) &&
           (narrow < KEEP_MODEL || same_text(curve->model, choosing->first->model));
}

/* Returns the colour of an earlier line of the series, or a new one. */
static size_t colour_of(const struct plot_choice *choice, const struct plot_line *line) {
    size_t colours = 0;
    for (const struct plot_line *l = choice->lines; l < line; l++) {
        if (l->one == line->one && same_colour(l->curve, line->curve))
            return l->colour;
        colours = l->colour + 1 > colours ? l->colour + 1 : colours;
    }
    return colours;
}

/* Counts the curves kept; the first of them fill the choice. */
static size_t collect(struct plot_choice *choice, const struct choosing *choosing) {
    size_t found = 0;
    choice->count = 0;
    for (size_t c = 0; c < choice->study->case_count; c++) {
        const struct case_result *one = &choice->study->cases[c];
        for (size_t a = 0; a < one->curve_count; a++) {
            const struct curve *curve = &one->curves[a];
            if (!is_kept(choosing, one, curve) || found++ >= PLOT_LINES)
                continue;
            struct plot_line *line = &choice->lines[choice->count++];
            *line = (struct plot_line){one, curve, 0, finer_levels(one, curve)};
            line->colour = colour_of(choice, line);
        }
    }
    return found;
}

static const struct curve *first_candidate(const struct study_result *study,
                                           const struct choosing *choosing) {
    for (size_t c = 0; c < study->case_count; c++)
        for (size_t a = 0; a < study->cases[c].curve_count; a++)
            if (is_candidate(choosing, &study->cases[c].curves[a]))
                return &study->cases[c].curves[a];
    return NULL;
}

__attribute__((format(printf, 2, 3))) static void append(char label[PLOT_LABEL_SIZE],
                                                         const char *format, ...) {
    size_t used = strlen(label);
    va_list arguments;
    if (used > 0)
        used += (size_t)snprintf(label + used, PLOT_LABEL_SIZE - used, ", ");
    if (used >= PLOT_LABEL_SIZE)
        return;
    va_start(arguments, format);
    vsnprintf(label + used, PLOT_LABEL_SIZE - used, format, arguments);
    va_end(arguments);
}

static void append_model(char label[PLOT_LABEL_SIZE], const struct curve *curve) {
    char model[64];
    append(label, "%s", model_text(curve->model, curve->kinematics, model, sizeof model));
}

/* Says what a step that left something out has kept. */
static void note(struct plot_choice *choice, const struct choosing *choosing, size_t before) {
    const char *series = choosing->first->series;
    char *text = choice->left_out;
    if (choosing->narrow == KEEP_ESTIMATES)
        append(text, "without brackets");
    else if (choosing->narrow == KEEP_FINEST)
        append(text, "finest level");
    else if (choosing->narrow == KEEP_SERIES)
        append(text, "%.40s", series != NULL ? series : "");
    else if (choosing->narrow == KEEP_MODEL)
        append_model(text, choosing->first);
    else
        append(text, "first %d of %zu curves", PLOT_LINES, before);
}

void plot_choose(struct plot_choice *choice, const struct study_result *study, const char *quantity,
                 const char *y_label) {
    struct choosing choosing = {.quantity = quantity, .y_label = y_label};
    *choice = (struct plot_choice){.study = study};
    choosing.first = first_candidate(study, &choosing);
    if (choosing.first == NULL)
        return;
    choosing.y_label = choosing.first->y_label;
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

/* Returns whether some case of the study has another value than this one at its parameter p. */
static bool varies(const struct study_result *study, const struct case_result *one, size_t p) {
    const struct result_parameter *value = &one->parameters[p];
    for (size_t c = 0; c < study->case_count; c++)
        if (!parameter_same(value, parameter_at(&study->cases[c], value->pointer, p)))
            return true;
    return false;
}

static bool same_pressure(const struct curve *a, const struct curve *b) {
    return same_number(a->pressure, b->pressure);
}

static bool same_level(const struct curve *a, const struct curve *b) {
    return same_number(a->level, b->level);
}

static bool same_model(const struct curve *a, const struct curve *b) {
    return same_text(a->model, b->model);
}

static bool lines_differ(const struct plot_choice *choice,
                         bool (*same)(const struct curve *, const struct curve *)) {
    for (size_t n = 1; n < choice->count; n++)
        if (!same(choice->lines[n].curve, choice->lines[0].curve))
            return true;
    return false;
}

static void append_swept(char label[PLOT_LABEL_SIZE], const struct study_result *study,
                         const struct case_result *one) {
    for (size_t p = 0; p < one->parameter_count; p++) {
        const struct result_parameter *value = &one->parameters[p];
        if (value->list || !varies(study, one, p))
            continue;
        if (value->text != NULL)
            append(label, "%s", value->text);
        else
            append(label, "%s %.5g", last_name(value->pointer), value->number);
    }
}

void plot_label(const struct plot_choice *choice, size_t line, char label[PLOT_LABEL_SIZE]) {
    const struct case_result *one = choice->lines[line].one;
    const struct curve *curve = choice->lines[line].curve;
    label[0] = '\0';
    if (one->difference)
        append(label, "case %llu less case %llu", (unsigned long long)one->case_number,
               (unsigned long long)one->less);
    append_swept(label, choice->study, one);
    if (lines_differ(choice, same_pressure))
        append(label, "at %.4g", curve->pressure);
    if (lines_differ(choice, same_model) || curve->kinematics != NULL)
        append_model(label, curve);
    if (curve->series != NULL && *curve->series != '\0')
        append(label, "%s", curve->series);
    if (lines_differ(choice, same_level))
        append(label, "level %.4g", curve->level);
    if (*label == '\0')
        append(label, "case %llu", (unsigned long long)one->case_number);
}
