#include "server/show/plot_theory.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { NAMES_MOST = 16 };
static const char BLACK[] = "#222222";

/* The names of theories, in the order in which they are met. */
static size_t names_of(const struct plot_lines *lines, const char *names[NAMES_MOST]) {
    size_t count = 0;
    for (size_t n = 0; n < lines->count; n++)
        for (size_t t = 0; t < lines->list[n].curve->theory_count; t++) {
            const struct theory *theory = &lines->list[n].curve->theories[t];
            bool met = theory->y == NULL;
            for (size_t m = 0; m < count && !met; m++)
                met = strcmp(names[m], theory->name) == 0;
            if (!met && count < NAMES_MOST)
                names[count++] = theory->name;
        }
    return count;
}

/* Returns NULL where the line has no such theory. */
static const double *theory_of(const struct plot_line *line, const char *name) {
    for (size_t t = 0; t < line->curve->theory_count; t++)
        if (strcmp(line->curve->theories[t].name, name) == 0)
            return line->curve->theories[t].y;
    return NULL;
}

static bool same_numbers(size_t n, const double *a, const double *b) {
    for (size_t k = 0; k < n; k++)
        if (!same_number(a[k], b[k]))
            return false;
    return true;
}

/* Returns whether two lines that have a theory have the same one, at the same places. */
static bool same_theory(const struct plot_line *a, const struct plot_line *b, const char *name) {
    size_t n = a->curve->n;
    return n == b->curve->n && same_numbers(n, a->curve->x, b->curve->x) &&
           same_numbers(n, theory_of(a, name), theory_of(b, name));
}

static bool has(const struct plot_lines *lines, size_t n, size_t panel, const char *name) {
    return lines->list[n].at[CHANNEL_PANEL] == panel && theory_of(&lines->list[n], name) != NULL;
}

/* Returns whether all lines of a panel that have a theory share it; *first is one of them, or the
 * count of the lines where none has it. */
static bool is_shared(const struct plot_lines *lines, size_t panel, const char *name,
                      size_t *first) {
    *first = 0;
    while (*first < lines->count && !has(lines, *first, panel, name))
        (*first)++;
    for (size_t n = *first + 1; n < lines->count; n++)
        if (has(lines, n, panel, name) && !same_theory(&lines->list[*first], &lines->list[n], name))
            return false;
    return true;
}

static bool is_drawn(const struct plot_lines *lines, size_t line, size_t panel, const char *name) {
    for (size_t n = 0; n < line; n++)
        if (has(lines, n, panel, name) && same_theory(&lines->list[n], &lines->list[line], name))
            return true;
    return false;
}

void plot_theories_draw(const struct plot_lines *lines, size_t panel, const struct plot_pen *pen) {
    const char *names[NAMES_MOST];
    size_t count = names_of(lines, names), first;
    for (size_t t = 0; t < count; t++) {
        bool shared = is_shared(lines, panel, names[t], &first);
        for (size_t n = first; n < lines->count; n++) {
            const struct plot_line *line = &lines->list[n];
            char style[LEGEND_STYLE_SIZE], colour[COLOUR_SIZE];
            if (!has(lines, n, panel, names[t]) || is_drawn(lines, n, panel, names[t]))
                continue;
            plot_colour(&lines->channels[CHANNEL_COLOUR], line->at[CHANNEL_COLOUR], colour);
            plot_darken(colour);
            plot_theory_style(lines, t, shared ? BLACK : colour, style);
            pen_line(pen, line->curve->n, line->curve->x, theory_of(line, names[t]), style);
        }
    }
}

void plot_theories_name(const struct plot_lines *lines, struct legend *legend) {
    const char *names[NAMES_MOST];
    size_t count = names_of(lines, names), first;
    for (size_t t = 0; t < count; t++) {
        char label[PLOT_LABEL_SIZE], style[LEGEND_STYLE_SIZE], name[96];
        bool shared = true;
        for (size_t panel = 0; panel < lines->channels[CHANNEL_PANEL].count && shared; panel++)
            shared = is_shared(lines, panel, names[t], &first);
        plot_spaced(names[t], name, sizeof name);
        snprintf(label, sizeof label, "%s%s%s",
                 strncmp(name, "theory", 6) == 0 ? "" : "theory: ", name,
                 shared ? "" : ", of each");
        plot_theory_style(lines, t, shared ? BLACK : "#777777", style);
        legend_add(legend, label, style);
    }
}
