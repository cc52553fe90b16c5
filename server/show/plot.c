#include "server/show/plot.h"
#include "server/show/plot_choice.h"
#include "server/show/plot_pen.h"
#include "server/show/summary_cells.h"
#include "server/show/view.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Theories differ by their dashes. */
static const char *const DASHES[] = {"7 4", "2 3", "12 3 2 3", "4 2 1 2 1 2", "14 5", "1 5"};
enum { DASH_COUNT = sizeof DASHES / sizeof *DASHES };

/* Coarser levels are fainter. */
static const char *const LEVEL_STYLES[] = {
    " stroke-width=\"1.8\"", " stroke-opacity=\".65\" stroke-width=\"1.2\"",
    " stroke-opacity=\".45\" stroke-width=\".9\"", " stroke-opacity=\".3\" stroke-width=\".7\""};
enum { STYLE_COUNT = sizeof LEVEL_STYLES / sizeof *LEVEL_STYLES };

/* What the picture of a quantity is drawn from. */
struct plot {
    struct plot_pen pen;
    struct plot_choice choice;
    bool partial; /* some points are means over fewer realisations */
};

/* --- curves --- */

/* Draws a bar of one standard error to either side, where the error can be seen. */
static void draw_bars(FILE *file, const struct frame *frame, const struct curve *curve,
                      const char *colour) {
    for (size_t n = 0; n < curve->n; n++) {
        double x = curve->x[n], y = curve->y[n], error = curve->standard_error[n];
        if (!frame_has_place(frame, x, y) || !isfinite(error))
            continue;
        if (frame->y.logarithmic && y - error <= 0)
            continue;
        double top = frame_y(frame, fmin(y + error, frame->y.high));
        double bottom = frame_y(frame, fmax(y - error, frame->y.low));
        if (bottom - top > 1)
            fprintf(file, "<path d=\"M%.2f %.2fV%.2f\" class=\"bar\" stroke=\"%s\"/>",
                    frame_x(frame, x), top, bottom, colour);
    }
    fputc('\n', file);
}

/* Draws a difference's band of one standard error to either side, and the line of no difference. */
static void draw_band(FILE *file, const struct frame *frame, const struct curve *curve,
                      const char *colour) {
    if (curve->minuend == NULL)
        return;
    if (frame->y.low < 0 && frame->y.high > 0)
        fprintf(file, "<path d=\"M%d %.2fH%d\" class=\"frame\"/>\n", FRAME_LEFT, frame_y(frame, 0),
                FRAME_RIGHT);
    for (size_t n = 0; n + 1 < curve->n; n++) {
        const double *x = curve->x + n, *y = curve->y + n, *error = curve->standard_error + n;
        if (!frame_has_place(frame, x[0], y[0]) || !frame_has_place(frame, x[1], y[1]) ||
            !isfinite(error[0]) || !isfinite(error[1]))
            continue;
        fprintf(file,
                "<path d=\"M%.2f %.2fV%.2fL%.2f %.2fV%.2fZ\" fill-opacity=\".2\" fill=\"%s\"/>\n",
                frame_x(frame, x[0]), frame_y(frame, y[0] - error[0]),
                frame_y(frame, y[0] + error[0]), frame_x(frame, x[1]),
                frame_y(frame, y[1] + error[1]), frame_y(frame, y[1] - error[1]), colour);
    }
}

/* Draws an open circle where some realisations have no value. */
static void draw_partial(struct plot *plot, const struct curve *curve, const char *colour) {
    for (size_t n = 0; n < curve->n && curve_is_partial(curve); n++) {
        double x = curve->x[n], y = curve->y[n];
        if (!(curve->valueless[n] > 0) || !pen_reaches(&plot->pen, x, y))
            continue;
        fprintf(plot->pen.file,
                "<circle cx=\"%.2f\" cy=\"%.2f\" r=\"3\" class=\"partial\" stroke=\"%s\"/>\n",
                frame_x(&plot->pen.frame, x), frame_y(&plot->pen.frame, y), colour);
        plot->partial = true;
    }
}

enum { STYLE_SIZE = 128 };

static void curve_style(const struct plot_line *line, char style[STYLE_SIZE]) {
    size_t level = line->coarseness < STYLE_COUNT ? line->coarseness : STYLE_COUNT - 1;
    snprintf(style, STYLE_SIZE, "class=\"curve\" stroke=\"%s\"%s", PEN_COLOURS[line->colour],
             LEVEL_STYLES[level]);
}

static void theory_style(size_t dash, const char *colour, char style[STYLE_SIZE]) {
    snprintf(style, STYLE_SIZE, "class=\"theory\" stroke=\"%s\" stroke-dasharray=\"%s\"", colour,
             DASHES[dash % DASH_COUNT]);
}

/* Coarse levels first, so that the finest lies on top; without their bars, which are much the same.
 */
static void draw_curves(struct plot *plot) {
    const struct plot_choice *choice = &plot->choice;
    char style[STYLE_SIZE], label[PLOT_LABEL_SIZE];
    for (size_t n = choice->count; n > 0; n--) {
        const struct plot_line *line = &choice->lines[n - 1];
        curve_style(line, style);
        draw_band(plot->pen.file, &plot->pen.frame, line->curve, PEN_COLOURS[line->colour]);
        if (line->coarseness == 0)
            draw_bars(plot->pen.file, &plot->pen.frame, line->curve, PEN_COLOURS[line->colour]);
        pen_line(&plot->pen, line->curve->n, line->curve->x, line->curve->y, style);
        draw_partial(plot, line->curve, PEN_COLOURS[line->colour]);
    }
    for (size_t n = 0; n < choice->count; n++) {
        curve_style(&choice->lines[n], style);
        plot_label(choice, n, label);
        pen_legend(&plot->pen, label, style);
    }
}

/* --- theories --- */

/* Returns NULL where the line has no such theory. */
static const double *theory_of(const struct plot_line *line, const char *name) {
    for (size_t t = 0; t < line->curve->theory_count; t++)
        if (strcmp(line->curve->theories[t].name, name) == 0)
            return line->curve->theories[t].y;
    return NULL;
}

static bool same_numbers(size_t n, const double *a, const double *b) {
    for (size_t p = 0; p < n; p++)
        if (!same_number(a[p], b[p]))
            return false;
    return true;
}

/* Returns whether two lines have the same theory of this name, or one of them has none. */
static bool same_theory(const struct plot_line *a, const struct plot_line *b, const char *name) {
    const double *one = theory_of(a, name), *other = theory_of(b, name);
    size_t n = a->curve->n;
    return one == NULL || other == NULL ||
           (n == b->curve->n && same_numbers(n, a->curve->x, b->curve->x) &&
            same_numbers(n, one, other));
}

/* Returns whether the theory of this name was met at a line before this one; alike: with the same
 * values. */
static bool met_before(const struct plot_choice *choice, size_t line, const char *name,
                       bool alike) {
    for (size_t n = 0; n < line; n++)
        if (theory_of(&choice->lines[n], name) != NULL &&
            (!alike || same_theory(&choice->lines[n], &choice->lines[line], name)))
            return true;
    return false;
}

static bool is_shared(const struct plot_choice *choice, const char *name) {
    size_t first = 0;
    while (theory_of(&choice->lines[first], name) == NULL)
        first++;
    for (size_t n = first + 1; n < choice->count; n++)
        if (!same_theory(&choice->lines[first], &choice->lines[n], name))
            return false;
    return true;
}

/* One that all curves share is black; otherwise each has the colour of its curve. */
static void draw_theory(struct plot *plot, const char *name, size_t dash) {
    const struct plot_choice *choice = &plot->choice;
    char style[STYLE_SIZE], label[PLOT_LABEL_SIZE];
    bool shared = is_shared(choice, name);
    for (size_t n = 0; n < choice->count; n++) {
        const struct plot_line *line = &choice->lines[n];
        const double *theory = theory_of(line, name);
        if (theory == NULL || met_before(choice, n, name, true))
            continue;
        theory_style(dash, shared ? "#222" : PEN_COLOURS[line->colour], style);
        pen_line(&plot->pen, line->curve->n, line->curve->x, theory, style);
    }
    snprintf(label, sizeof label, "theory: %.80s%s", name, shared ? "" : " of each");
    theory_style(dash, shared ? "#222" : "#777", style);
    pen_legend(&plot->pen, label, style);
}

/* Draws theories on top of all curves, in the order in which they are met. */
static void draw_theories(struct plot *plot) {
    size_t dash = 0;
    for (size_t n = 0; n < plot->choice.count; n++) {
        const struct curve *curve = plot->choice.lines[n].curve;
        for (size_t t = 0; t < curve->theory_count; t++)
            if (curve->theories[t].y != NULL &&
                !met_before(&plot->choice, n, curve->theories[t].name, false))
                draw_theory(plot, curve->theories[t].name, dash++);
    }
}

/* --- the picture --- */

static void draw_notes(struct plot *plot) {
    pen_note(&plot->pen, "bars: one standard error");
    if (plot->partial)
        pen_note(&plot->pen, "circles: not over all realisations");
    if (*plot->choice.left_out != '\0') {
        char text[PLOT_LABEL_SIZE + 16];
        snprintf(text, sizeof text, "shown: %s", plot->choice.left_out);
        pen_note(&plot->pen, text);
    }
}

/* Places in geometric steps: their middle one lies near the geometric mean of the ends. */
static bool is_geometric(size_t n, const double *x) {
    return n > 4 && x[0] > 0 && x[n - 1] > 10 * x[0] && x[n / 2] < x[n - 1] / 4;
}

/* Theories are seen as far as the curves go; on logarithmic axes, where they are near, as a whole.
 */
static void include(struct frame *frame, const struct curve *curve, bool theories) {
    frame_include(frame, curve->n, curve->x, curve->y);
    for (size_t n = 0; n < curve->n && curve->minuend != NULL; n++) {
        double error = isfinite(curve->standard_error[n]) ? curve->standard_error[n] : 0;
        const double ends[] = {curve->y[n] - error, curve->y[n] + error};
        frame_include(frame, 1, &curve->x[n], &ends[0]);
        frame_include(frame, 1, &curve->x[n], &ends[1]);
    }
    for (size_t t = 0; theories && t < curve->theory_count; t++)
        if (curve->theories[t].y != NULL)
            frame_include(frame, curve->n, curve->x, curve->theories[t].y);
}

/* Fits the frame to the curves; axes are logarithmic as the view has the quantity. */
static bool fit(struct plot *plot, const struct plot_request *request, bool logarithmic) {
    const struct plot_choice *choice = &plot->choice;
    const struct curve *first = choice->lines[0].curve;
    bool both = request->logarithmic || logarithmic;
    frame_start(&plot->pen.frame, both || is_geometric(first->n, first->x),
                both && first->minuend == NULL); /* differences have either sign */
    for (size_t n = 0; n < choice->count; n++)
        include(&plot->pen.frame, choice->lines[n].curve, request->logarithmic);
    return frame_finish(&plot->pen.frame);
}

/* Returns the width that the longest label of the legend needs. */
static int width_of(const struct plot_choice *choice) {
    int width = PEN_WIDTH;
    for (size_t n = 0; n < choice->count; n++) {
        char label[PLOT_LABEL_SIZE];
        plot_label(choice, n, label);
        int needed = PEN_LEGEND + PEN_LETTER * (int)strlen(label) + 16;
        width = needed > width ? needed : width;
    }
    int note = FRAME_RIGHT + 16 + PEN_LETTER * (int)(strlen(choice->left_out) + 8) + 16;
    return note > width ? note : width;
}

int plot_quantity(const struct study_result *study, const struct plot_request *request, FILE *file,
                  struct error *err) {
    const struct logarithmic_picture *picture =
        view_logarithmic(view_of(study->kind), request->quantity);
    struct plot plot = {.pen = {.file = file}};
    plot_choose(&plot.choice, study, request->quantity, request->y_label);
    if (plot.choice.count == 0)
        return error_set(err, ERROR_ABSENT, "no case has the quantity \"%.60s\"",
                         request->quantity);
    pen_head(&plot.pen, width_of(&plot.choice));
    pen_study(&plot.pen, study);
    pen_title(&plot.pen, study->name, request->quantity);
    if (fit(&plot, request, picture != NULL && picture->suffix == NULL)) {
        const struct curve *first = plot.choice.lines[0].curve;
        frame_draw(file, &plot.pen.frame, first->x_label, first->y_label);
        draw_curves(&plot);
        draw_theories(&plot);
        draw_notes(&plot);
    }
    fputs("</svg>\n", file);
    return 0;
}
