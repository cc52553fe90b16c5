#include "server/show/plot/plot_style.h"
#include "schema/result/swept.h"
#include "server/show/summary/summary_cells.h"
#include "server/show/view.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Curves have dashes alone, theories have dots, so that no theory is taken for a curve. */
static const char *const DASHES[DASHES_MOST] = {"",         "8 4",          "4 3",
                                                "14 3 5 3", "16 3 5 3 5 3", "20 6"};
static const char *const THEORIES[] = {"1.5 2.5",         "9 2.5 1.5 2.5",    "1.5 6",
                                       "9 2 1.5 2 1.5 2", "18 2.5 1.5 2.5",   "1.5 2 1.5 7",
                                       "4 2 1.5 2",       "1.5 2 1.5 2 1.5 8"};
enum { THEORY_COUNT = sizeof THEORIES / sizeof *THEORIES };

/* Coarser levels are fainter. */
static const char *const LEVELS[] = {
    "stroke-width=\"1.8\"", "stroke-opacity=\".75\" stroke-width=\"1.2\"",
    "stroke-opacity=\".5\" stroke-width=\".9\"", "stroke-opacity=\".35\" stroke-width=\".7\""};
enum { LEVEL_COUNT = sizeof LEVELS / sizeof *LEVELS };
/* Coarser levels have shorter dashes, too, where nothing else has. */
static const char *const LEVEL_DASHES[LEVEL_COUNT] = {"", "9 3", "4 3", "4 7"};

/* Stops of the colour map "viridis", whose lightness rises evenly, without the palest. */
static const double STOPS[][3] = {{68, 1, 84},    {70, 50, 127},  {54, 92, 141}, {39, 127, 142},
                                  {31, 161, 135}, {74, 194, 109}, {159, 218, 58}};
enum { STOP_COUNT = sizeof STOPS / sizeof *STOPS, ENTRIES_MOST = 10, STEPS = 6 };
static const char NEUTRAL[] = "#444444";

void plot_colour(const struct plot_channel *channel, size_t v, char colour[COLOUR_SIZE]) {
    unsigned parts[3];
    if (channel->count <= 1 || (!channel->ordered && channel->count <= PLOT_LINES)) {
        snprintf(colour, COLOUR_SIZE, "%s", PEN_COLOURS[v % PLOT_LINES]);
        return;
    }
    double place = (double)v / (double)(channel->count - 1) * (STOP_COUNT - 1);
    size_t below = place < STOP_COUNT - 2 ? (size_t)place : STOP_COUNT - 2;
    for (size_t k = 0; k < 3; k++)
        parts[k] = (unsigned)lround(STOPS[below][k] + (place - (double)below) *
                                                          (STOPS[below + 1][k] - STOPS[below][k]));
    snprintf(colour, COLOUR_SIZE, "#%02x%02x%02x", parts[0] & 255, parts[1] & 255, parts[2] & 255);
}

void plot_darken(char colour[COLOUR_SIZE]) {
    unsigned long all = strtoul(colour + 1, NULL, 16);
    snprintf(colour, COLOUR_SIZE, "#%06lx", all >> 1 & 0x7f7f7f); /* each byte by half */
}

static void style_of(const struct plot_lines *lines, const char *colour, size_t dash,
                     size_t coarseness, char style[LEGEND_STYLE_SIZE]) {
    size_t level = coarseness < LEVEL_COUNT ? coarseness : LEVEL_COUNT - 1;
    const char *dashes =
        lines->channels[CHANNEL_DASH].count > 1 ? DASHES[dash % DASHES_MOST] : LEVEL_DASHES[level];
    snprintf(style, LEGEND_STYLE_SIZE, "class=\"curve\" stroke=\"%s\" %s%s%s%s", colour,
             LEVELS[level], *dashes != '\0' ? " stroke-dasharray=\"" : "", dashes,
             *dashes != '\0' ? "\"" : "");
}

void plot_curve_style(const struct plot_lines *lines, const struct plot_line *line,
                      char style[LEGEND_STYLE_SIZE]) {
    char colour[COLOUR_SIZE];
    plot_colour(&lines->channels[CHANNEL_COLOUR], line->at[CHANNEL_COLOUR], colour);
    style_of(lines, colour, line->at[CHANNEL_DASH], line->coarseness, style);
}

void plot_theory_style(size_t number, const char *colour, char style[LEGEND_STYLE_SIZE]) {
    snprintf(style, LEGEND_STYLE_SIZE, "class=\"theory\" stroke=\"%s\" stroke-dasharray=\"%s\"",
             colour, THEORIES[number % THEORY_COUNT]);
}

enum plot_marks plot_marks_of(const struct plot_lines *lines, const struct plot_words *words) {
    enum { SHAPES_MOST = 16, DOTS_MOST = 40 };
    size_t most = 0;
    for (size_t n = 0; n < lines->count; n++)
        if (lines->list[n].curve->n > most)
            most = lines->list[n].curve->n;
    return words->points || most <= SHAPES_MOST ? MARKS_SHAPES
           : most <= DOTS_MOST                  ? MARKS_DOTS
                                                : MARKS_NONE;
}

/* --- the legend --- */

static void set_mark(struct legend_row *row, enum plot_marks marks, const char *colour,
                     size_t dash) {
    if (marks != MARKS_SHAPES)
        return;
    row->mark = (int)dash;
    snprintf(row->colour, sizeof row->colour, "%s", colour);
}

/* Names all colours of few values, and of many in an order about ten of them: the steps between
 * are seen. */
static void add_colours(struct legend *legend, const struct plot_lines *lines,
                        enum plot_marks marks) {
    const struct plot_channel *channel = &lines->channels[CHANNEL_COLOUR];
    char label[PLOT_LABEL_SIZE], style[LEGEND_STYLE_SIZE], colour[COLOUR_SIZE], name[96];
    bool thinned = channel->ordered && channel->count > ENTRIES_MOST;
    size_t steps = thinned ? STEPS : channel->count - 1;
    for (size_t s = 0; s <= steps && channel->count > 1; s++) {
        size_t v = thinned ? (s * (channel->count - 1) + steps / 2) / steps : s;
        channel_label(lines, CHANNEL_COLOUR, v, label, sizeof label);
        plot_colour(channel, v, colour);
        style_of(lines, colour, 0, 0, style);
        set_mark(legend_add(legend, label, style), marks, colour, 0);
    }
    if (thinned) {
        channel_name(lines, CHANNEL_COLOUR, name, sizeof name);
        snprintf(label, sizeof label, "in between: of %zu values of %s", channel->count, name);
        legend_add(legend, label, "");
    }
}

static void add_dashes(struct legend *legend, const struct plot_lines *lines,
                       enum plot_marks marks) {
    const struct plot_channel *channel = &lines->channels[CHANNEL_DASH];
    for (size_t v = 0; v < channel->count && channel->count > 1; v++) {
        char label[PLOT_LABEL_SIZE], style[LEGEND_STYLE_SIZE];
        channel_label(lines, CHANNEL_DASH, v, label, sizeof label);
        style_of(lines, NEUTRAL, v, 0, style);
        set_mark(legend_add(legend, label, style), marks, NEUTRAL, v);
    }
}

/* Levels have their number where all lines so faint are of the same. */
static void add_levels(struct legend *legend, const struct plot_lines *lines) {
    size_t coarsest = 0;
    for (size_t n = 0; n < lines->count; n++)
        if (lines->list[n].coarseness > coarsest)
            coarsest = lines->list[n].coarseness;
    for (size_t k = 0; k <= coarsest && coarsest > 0; k++) {
        char label[64], style[LEGEND_STYLE_SIZE];
        double level = NAN;
        bool same = true;
        for (size_t n = 0; n < lines->count; n++) {
            if (lines->list[n].coarseness != k)
                continue;
            same = same && (isnan(level) || level == lines->list[n].curve->level);
            level = lines->list[n].curve->level;
        }
        if (same)
            snprintf(label, sizeof label, "level %.4g", level);
        else
            snprintf(label, sizeof label, k == 0 ? "finest level" : "%zu levels coarser", k);
        style_of(lines, NEUTRAL, 0, k, style);
        legend_add(legend, label, style);
    }
}

/* Returns what the series of a line is called. */
static const char *series_words(const char *kind, const struct plot_line *line) {
    const struct result_view *view = view_of(kind);
    const char *shown = view_series_name(view, line->one, line->curve->series);
    return shown != NULL ? shown : view_words(view, line->curve->series);
}

/* A picture of one line says whose it is. */
static void add_only(struct legend *legend, const struct plot_lines *lines, enum plot_marks marks,
                     const struct plot_words *words) {
    const struct plot_line *line = &lines->list[0];
    char label[PLOT_LABEL_SIZE], style[LEGEND_STYLE_SIZE], model[64];
    unsigned long long number = line->one->case_number, less = line->one->less;
    if (words->points)
        snprintf(label, sizeof label, "%s", words->y);
    else if (line->one->difference)
        snprintf(label, sizeof label, "case %llu less case %llu", number, less);
    else if (line->curve->series != NULL && *line->curve->series != '\0')
        plot_in_words(series_words(lines->kind, line), label, sizeof label);
    else if (line->curve->model != NULL)
        snprintf(label, sizeof label, "%s",
                 model_text(line->curve->model, line->curve->kinematics, model, sizeof model));
    else
        snprintf(label, sizeof label, "case %llu", number);
    plot_curve_style(lines, line, style);
    set_mark(legend_add(legend, label, style), marks, PEN_COLOURS[0], 0);
}

void plot_legend_lines(struct legend *legend, const struct plot_lines *lines, enum plot_marks marks,
                       const struct plot_words *words) {
    add_colours(legend, lines, marks);
    add_dashes(legend, lines, marks);
    if (legend->count == 0)
        add_only(legend, lines, marks, words);
    add_levels(legend, lines);
}

/* Adds "H = 0.8", or "distribution: Weibull min". */
static void add_parameter(struct legend *legend, const char *kind,
                          const struct result_parameter *value) {
    char text[PLOT_LABEL_SIZE], name[81], words[81];
    plot_parameter_words(kind, value->pointer, name, sizeof name);
    plot_in_words(value->text != NULL ? value->text : "", words, sizeof words);
    if (value->text != NULL)
        snprintf(text, sizeof text, "%s: %s", name, words);
    else
        snprintf(text, sizeof text, "%.60s = %.5g", plot_symbol(kind, value->pointer),
                 value->number);
    legend_add(legend, text, "");
}

void plot_legend_case(struct legend *legend, const struct study_result *study,
                      const struct case_result *one) {
    struct swept swept;
    swept_find(study, &swept);
    for (size_t n = 0; n < swept.count; n++) {
        const struct result_parameter *value = result_parameter(one, swept.columns[n].pointer);
        if (value != NULL && !value->list)
            add_parameter(legend, study->kind, value);
    }
}

static bool is_partial(const struct plot_lines *lines) {
    for (size_t n = 0; n < lines->count; n++) {
        const struct curve *curve = lines->list[n].curve;
        for (size_t k = 0; k < curve->n && curve_is_partial(curve); k++)
            if (curve->valueless[k] > 0 && isfinite(curve->y[k]))
                return true;
    }
    return false;
}

void plot_legend_notes(struct legend *legend, const struct plot_lines *lines, const char *note) {
    const struct plot_channel *panels = &lines->channels[CHANNEL_PANEL];
    char text[PLOT_LABEL_SIZE + 16];
    if (is_partial(lines))
        legend_add(legend, "circles: not over all realisations", "");
    if (note != NULL && *note != '\0')
        legend_add(legend, note, "");
    if (*lines->narrowed != '\0') {
        snprintf(text, sizeof text, "shown: %s", lines->narrowed);
        legend_add(legend, text, "");
    }
    if (panels->count > PANELS_MOST) {
        snprintf(text, sizeof text, "shown: first %d of %zu panels", PANELS_MOST, panels->count);
        legend_add(legend, text, "");
    }
}
