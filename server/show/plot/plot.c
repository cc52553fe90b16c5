#include "server/show/plot/plot.h"
#include "schema/result/swept.h"
#include "server/show/plot/plot_errors.h"
#include "server/show/plot/plot_layout.h"
#include "server/show/plot/plot_style.h"
#include "server/show/quantity.h"
#include "server/show/view.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *const AXES_NAMES[AXES_COUNT] = {
    [AXES_AUTOMATIC] = "auto", [AXES_LINEAR] = "none",      [AXES_X] = "x", [AXES_Y] = "y",
    [AXES_XY] = "xy",          [AXES_ONE_PLUS] = "one-plus"};

/* Theories beside the lines of a picture. */

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

/* Returns whether a line has the theory of another at all points of that one. Both rise. */
static bool covers(const struct plot_line *line, const struct plot_line *other, const char *name) {
    const double *own = theory_of(line, name), *theirs = theory_of(other, name);
    size_t k = 0;
    for (size_t n = 0; n < other->curve->n; n++) {
        while (k < line->curve->n && line->curve->x[k] < other->curve->x[n])
            k++;
        if (k == line->curve->n || !same_number(line->curve->x[k], other->curve->x[n]) ||
            !same_number(own[k], theirs[n]))
            return false;
    }
    return true;
}

static bool has(const struct plot_lines *lines, size_t n, size_t panel, const char *name) {
    return lines->list[n].at[CHANNEL_PANEL] == panel && theory_of(&lines->list[n], name) != NULL;
}

/* Returns whether all lines of a panel that have a theory share it, be it at some of its points;
 * *first is the first of them, or the count of the lines where none has it. */
static bool is_shared(const struct plot_lines *lines, size_t panel, const char *name,
                      size_t *first) {
    *first = lines->count;
    size_t longest = lines->count;
    for (size_t n = lines->count; n-- > 0;) {
        if (!has(lines, n, panel, name))
            continue;
        *first = n;
        if (longest == lines->count || lines->list[n].curve->n > lines->list[longest].curve->n)
            longest = n;
    }
    for (size_t n = *first; n < lines->count; n++)
        if (has(lines, n, panel, name) && !covers(&lines->list[longest], &lines->list[n], name))
            return false;
    return true;
}

/* Returns whether another line draws the theory of this one: an earlier one has the same, or a
 * longer one all of it. */
static bool is_drawn(const struct plot_lines *lines, size_t line, size_t panel, const char *name) {
    const struct plot_line *own = &lines->list[line];
    for (size_t n = 0; n < lines->count; n++) {
        const struct plot_line *other = &lines->list[n];
        if (n != line && has(lines, n, panel, name) && covers(other, own, name) &&
            (n < line || other->curve->n > own->curve->n))
            return true;
    }
    return false;
}

/* Draws the theories of the lines of one panel, whose frame the pen has: each once where lines
 * share it, black where all of them do, else in the colour of its line, darkened. */
static void plot_theories_draw(const struct plot_lines *lines, size_t panel,
                               const struct plot_pen *pen) {
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
            plot_theory_style(t, shared ? BLACK : colour, style);
            pen_line(pen, line->curve->n, line->curve->x, theory_of(line, names[t]), style);
        }
    }
}

/* Returns whether the theory of some line in the first panels reaches the frame of the pen. */
static bool is_seen(const struct plot_lines *lines, size_t panels, const char *name,
                    const struct plot_pen *pen) {
    for (size_t n = 0; n < lines->count; n++) {
        const struct curve *curve = lines->list[n].curve;
        const double *y = theory_of(&lines->list[n], name);
        if (lines->list[n].at[CHANNEL_PANEL] < panels && y != NULL &&
            pen_meets(pen, curve->n, curve->x, y))
            return true;
    }
    return false;
}

/* Adds a row for each theory of any line. The pen has the frame of all panels. */
static void plot_theories_name(const struct plot_lines *lines, size_t panels,
                               const struct plot_pen *pen, struct legend *legend) {
    const char *names[NAMES_MOST];
    size_t count = names_of(lines, names), first;
    for (size_t t = 0; t < count; t++) {
        char label[PLOT_LABEL_SIZE], style[LEGEND_STYLE_SIZE], name[96];
        bool shared = true;
        for (size_t panel = 0; panel < lines->channels[CHANNEL_PANEL].count && shared; panel++)
            shared = is_shared(lines, panel, names[t], &first);
        plot_in_words(view_words(view_of(lines->kind), names[t]), name, sizeof name);
        snprintf(label, sizeof label, "%s%s%s%s",
                 strncmp(name, "theory", 6) == 0 ? "" : "theory: ", name,
                 shared ? "" : ", of each line",
                 is_seen(lines, panels, names[t], pen) ? "" : ", beyond the axes");
        plot_theory_style(t, shared ? BLACK : "#777777", style);
        legend_add(legend, label, style);
    }
}

enum { TICKS_MOST = 12, TICK_ROOM = 36 };

struct plot {
    const struct plot_lines *lines;
    const struct plot_request *request;
    const struct plot_words *words;
    enum plot_marks marks;
    struct errors_drawn errors;
    size_t panels;
    struct plot_pen pen;
    struct legend legend;
    struct plot_layout layout;
    struct physical_unit x_unit, y_unit; /* of all lines */
    size_t tick_count;
    double ticks[TICKS_MOST];
};

/* --- one line --- */

/* Marks where values were computed; open circles where some realisations have none. */
static void draw_marks(const struct plot *plot, const struct plot_line *line, const char *colour) {
    const struct plot_pen *pen = &plot->pen;
    const struct curve *curve = line->curve;
    for (size_t n = 0; n < curve->n; n++) {
        double x = frame_x(&pen->frame, curve->x[n]), y = frame_y(&pen->frame, curve->y[n]);
        if (!pen_reaches(pen, curve->x[n], curve->y[n]))
            continue;
        if (curve_is_partial(curve) && curve->valueless[n] > 0)
            fprintf(pen->file,
                    "<circle cx=\"%.2f\" cy=\"%.2f\" r=\"3\" class=\"partial\" stroke=\"%s\"/>\n",
                    x, y, colour);
        else if (plot->marks == MARKS_SHAPES && line->coarseness == 0)
            mark_draw(pen->file, line->at[CHANNEL_DASH], x, y, plot->layout.scale, colour);
        else if (plot->marks == MARKS_DOTS && line->coarseness == 0)
            fprintf(pen->file, "<path d=\"M%.2f %.2fh0\" class=\"dot\" stroke=\"%s\"/>", x, y,
                    colour);
    }
}

static void draw_line(const struct plot *plot, const struct plot_line *line) {
    char style[LEGEND_STYLE_SIZE], colour[COLOUR_SIZE];
    plot_colour(&plot->lines->channels[CHANNEL_COLOUR], line->at[CHANNEL_COLOUR], colour);
    plot_curve_style(plot->lines, line, style);
    if (line->coarseness == 0)
        plot_errors_draw(&plot->pen, line->curve, &plot->errors, colour);
    pen_line(&plot->pen, line->curve->n, line->curve->x, line->curve->y, style);
    draw_marks(plot, line, colour);
}

/* --- the axes --- */

/* Values in geometric steps: their middle one lies near the geometric mean of the ends. */
static bool is_geometric(size_t n, const double *x) {
    return n > 4 && x[0] > 0 && x[n - 1] > 10 * x[0] && x[n / 2] < x[n - 1] / 4;
}

/* Returns whether the values of a parameter lie nearer to geometric than to even steps. */
static bool are_geometric(size_t n, const double *ticks) {
    if (n < 3 || n > TICKS_MOST || ticks[0] <= 0 || ticks[n - 1] < 4 * ticks[0])
        return false;
    double low = ticks[0], high = ticks[n - 1], middle = ticks[n / 2];
    if (n % 2 == 0)
        middle = (middle + ticks[n / 2 - 1]) / 2;
    return fabs(middle - sqrt(low * high)) < fabs(middle - (low + high) / 2);
}

/* Adds a value of x to those that take the place of ticks; TICKS_MOST + 1 of them are too many. */
static void add_tick(struct plot *plot, double x) {
    size_t place = 0;
    if (plot->tick_count > TICKS_MOST)
        return;
    while (place < plot->tick_count && plot->ticks[place] < x)
        place++;
    if (place < plot->tick_count && plot->ticks[place] == x)
        return;
    if (plot->tick_count++ == TICKS_MOST)
        return;
    memmove(plot->ticks + place + 1, plot->ticks + place,
            (plot->tick_count - 1 - place) * sizeof *plot->ticks);
    plot->ticks[place] = x;
}

static void set_ticks(const struct plot *plot, struct frame *frame) {
    if (!plot->words->points || plot->tick_count > TICKS_MOST)
        return;
    for (size_t n = 1; n < plot->tick_count; n++)
        if (frame_x(frame, plot->ticks[n]) - frame_x(frame, plot->ticks[n - 1]) <
            TICK_ROOM * frame->scale)
            return;
    frame->x.ticks = plot->ticks;
    frame->x.tick_count = plot->tick_count;
}

/* Points of a curve from `first` on, before `end`. */
struct stretch {
    size_t first, end;
};

/* Returns which points must be seen: those of a density between its empty bins at the ends, none
 * where all of its bins are empty; else all. */
static struct stretch stretch_of(const struct plot *plot, const struct curve *curve) {
    const char *const *densities = view_of(plot->lines->kind)->densities;
    struct stretch seen = {0, curve->n};
    if (plot->words->points || curve->minuend != NULL || !view_lists(densities, curve->quantity))
        return seen;
    while (seen.end > 0 && !(fabs(curve->y[seen.end - 1]) > 0))
        seen.end--;
    while (seen.first < seen.end && !(fabs(curve->y[seen.first]) > 0))
        seen.first++;
    return seen;
}

/* Includes what is seen of a line: its points, and theories over a parameter, or as a whole. */
static void include(struct frame *frame, const struct plot *plot, const struct curve *curve) {
    bool points = plot->words->points;
    const struct stretch seen = stretch_of(plot, curve);
    frame_include(frame, seen.end - seen.first, curve->x + seen.first, curve->y + seen.first);
    for (size_t t = 0; t < curve->theory_count; t++)
        for (size_t n = 0; n < curve->n && curve->theories[t].y != NULL; n++) {
            if (points || plot->request->theories_whole)
                frame_include_point(frame, curve->x[n], curve->theories[t].y[n]);
        }
}

static void set_logarithmic(const struct plot *plot, const struct study_result *study, bool *x,
                            bool *y) {
    const struct curve *first = plot->lines->list[0].curve;
    const struct logarithmic_picture *picture =
        view_logarithmic(view_of(study->kind), first->quantity);
    enum plot_axes axes = plot->request->axes;
    bool both = axes == AXES_XY || (axes == AXES_AUTOMATIC && !plot->words->points &&
                                    picture != NULL && picture->suffix == NULL);
    bool steps = plot->words->points ? are_geometric(plot->tick_count, plot->ticks)
                                     : is_geometric(first->n, first->x);
    *x = both || axes == AXES_X || (axes == AXES_AUTOMATIC && steps);
    *y = axes == AXES_Y || (both && first->minuend == NULL); /* differences have either sign */
}

/* Differences may be below -1, and have linear axes. */
static bool is_one_plus(const struct plot *plot) {
    return plot->request->axes == AXES_ONE_PLUS && plot->lines->list[0].curve->minuend == NULL;
}

/* Marks at the ends keep away from the frame by this share of it. */
static void widen(struct plot_axis *axis, double share) {
    double low = axis->low, high = axis->high, margin = share * (high - low);
    double factor = axis->logarithmic ? pow(high / low, share) : 1;
    axis->low = axis->logarithmic ? low / factor : low - margin;
    axis->high = axis->logarithmic ? high * factor : high + margin;
}

/* Returns whether no point has been included yet. */
static bool is_empty(const struct frame *frame) {
    return !(frame->x.low <= frame->x.high);
}

/* Includes the lines of all panels, which share their axes; where all of them are densities without
 * a thing in any bin, these bins. */
static void include_lines(const struct plot *plot, struct frame *frame) {
    const struct plot_lines *lines = plot->lines;
    for (size_t n = 0; n < lines->count; n++)
        if (lines->list[n].at[CHANNEL_PANEL] < plot->panels)
            include(frame, plot, lines->list[n].curve);
    for (size_t n = 0, empty = is_empty(frame); n < lines->count && empty; n++)
        frame_include(frame, lines->list[n].curve->n, lines->list[n].curve->x,
                      lines->list[n].curve->y);
}

/* Begins the frame: which of its axes are logarithmic, and the ticks of a parameter. */
static void start_axes(struct plot *plot, const struct study_result *study) {
    bool x, y;
    for (size_t n = 0; n < plot->lines->count && plot->words->points; n++)
        for (size_t k = 0; k < plot->lines->list[n].curve->n; k++)
            add_tick(plot, plot->lines->list[n].curve->x[k]);
    set_logarithmic(plot, study, &x, &y);
    frame_start(&plot->pen.frame, x, y);
    plot->pen.frame.y.plus = is_one_plus(plot) ? 1 : 0;
}

/* Lets the y axis reach a theory that would not be seen at all, be it in part: each end by half of
 * its range, or of its decades, at most. */
static void reach_theories(const struct plot *plot, struct frame *frame) {
    static const double PART = 0.5;
    const struct plot_axis points = frame->y;
    const bool logarithmic = points.logarithmic;
    double part =
        logarithmic ? pow(points.high / points.low, PART) : PART * (points.high - points.low);
    double least = logarithmic ? points.low / part : points.low - part;
    double most = logarithmic ? points.high * part : points.high + part;
    for (size_t n = 0; n < plot->lines->count; n++) {
        const struct curve *curve = plot->lines->list[n].curve;
        for (size_t t = 0; t < curve->theory_count; t++) {
            struct frame own = *frame;
            own.y.low = INFINITY;
            own.y.high = -INFINITY;
            for (size_t k = 0; k < curve->n && curve->theories[t].y != NULL; k++)
                if (curve->x[k] >= frame->x.low && curve->x[k] <= frame->x.high)
                    frame_include_point(&own, curve->x[k], curve->theories[t].y[k]);
            if (own.y.low > points.high || own.y.high < points.low) {
                frame->y.low = fmin(frame->y.low, fmax(least, own.y.low));
                frame->y.high = fmax(frame->y.high, fmin(most, own.y.high));
            }
        }
    }
}

/* Fits one frame to the lines. Returns false where no point can be drawn on the axes. */
static bool fit(struct plot *plot) {
    struct frame *frame = &plot->pen.frame;
    include_lines(plot, frame);
    if (is_empty(frame))
        return false;
    axis_widen_single(&frame->y);
    reach_theories(plot, frame);
    plot_errors_include(frame, plot->lines, plot->panels, &plot->errors,
                        plot->words->points || plot->lines->list[0].curve->minuend != NULL);
    struct plot_axis own = frame->x;
    (void)frame_finish(frame); /* there are points */
    static const double POINTS = 0.06, MARKS = 0.03;
    if (plot->words->points) {
        frame->x = frame->x.single ? frame->x : own;
        widen(&frame->x, POINTS);
    } else if (plot->marks != MARKS_NONE) {
        double low = frame->x.low;
        widen(&frame->x, MARKS);
        frame->x.low = low == 0 ? 0 : frame->x.low; /* an axis from zero begins there */
    }
    return true;
}

/* --- the picture --- */

static void draw_title(const struct plot *plot, size_t panel) {
    char label[PLOT_LABEL_SIZE];
    const struct frame *frame = &plot->pen.frame;
    if (plot->panels < 2)
        return;
    channel_label(plot->lines, CHANNEL_PANEL, panel, label, sizeof label);
    fprintf(plot->pen.file, "<text x=\"%d\" y=\"%.1f\">", frame->left,
            frame->top - 6 * frame->scale);
    svg_label(plot->pen.file, label);
    fputs("</text>\n", plot->pen.file);
}

/* The line of no difference. */
static void draw_zero(const struct plot_pen *pen, const struct curve *curve) {
    const struct frame *frame = &pen->frame;
    if (curve->minuend != NULL && frame->y.low < 0 && frame->y.high > 0)
        fprintf(pen->file, "<path d=\"M%d %.2fH%d\" class=\"frame\"/>\n", frame->left,
                frame_y(frame, 0), frame->right);
}

/* Coarse levels first, so that the finest lies on top, and theories on top of all. */
static void draw_panel(struct plot *plot, size_t panel) {
    const struct plot_lines *lines = plot->lines;
    size_t coarsest = 0;
    plot_place(&plot->layout, panel, &plot->pen.frame);
    set_ticks(plot, &plot->pen.frame);
    fputs("<g class=\"panel\">\n", plot->pen.file);
    frame_draw(plot->pen.file, &plot->pen.frame, NULL, NULL);
    draw_title(plot, panel);
    draw_zero(&plot->pen, lines->list[0].curve);
    for (size_t n = 0; n < lines->count; n++)
        if (lines->list[n].coarseness > coarsest)
            coarsest = lines->list[n].coarseness;
    for (size_t level = coarsest + 1; level-- > 0;)
        for (size_t n = 0; n < lines->count; n++)
            if (lines->list[n].at[CHANNEL_PANEL] == panel && lines->list[n].coarseness == level)
                draw_line(plot, &lines->list[n]);
    plot_theories_draw(lines, panel, &plot->pen);
    fputs("</g>\n", plot->pen.file);
}

/* --- physical units --- */

/* Returns the unit that the axes of all lines have, with the same scale. */
static struct physical_unit common_unit(const struct plot_lines *lines, bool horizontal) {
    static const double ROUNDING = 1e-6; /* which nobody sees */
    struct physical_unit common = {0};
    for (size_t n = 0; n < lines->count; n++) {
        const struct curve *curve = lines->list[n].curve;
        const struct physical_unit *unit = horizontal ? &curve->x_unit : &curve->y_unit;
        if (n == 0)
            common = *unit;
        if (!same_text(common.unit, unit->unit) ||
            !(fabs(unit->scale - common.scale) <= ROUNDING * common.scale))
            return (struct physical_unit){0};
    }
    return common;
}

static double largest_of(const struct plot_axis *axis) {
    return fmax(fabs(axis->low), fabs(axis->high));
}

/* Draws the axes in physical units of a picture of one panel. */
static void draw_second(const struct plot *plot) {
    const struct frame *frame = &plot->pen.frame;
    const struct physical_unit *units[] = {&plot->x_unit, &plot->y_unit};
    const double most[] = {largest_of(&frame->x), largest_of(&frame->y)};
    double factors[2] = {0, 0};
    char labels[2][PLOT_LABEL_SIZE] = {"", ""}, unit[32];
    for (size_t a = 0; a < 2; a++)
        if (units[a]->unit != NULL) {
            factors[a] = units[a]->scale / unit_readable(units[a]->unit, units[a]->scale * most[a],
                                                         unit, sizeof unit);
            snprintf(labels[a], sizeof labels[a], "%s%s%s", units[a]->symbol,
                     *unit != '\0' ? ", " : "", unit);
        }
    if (factors[0] > 0 || factors[1] > 0)
        frame_draw_second(plot->pen.file, frame, factors, labels[0], labels[1]);
}

/* Names the units of a picture of several panels in its legend. */
static void note_unit(struct plot *plot, const struct physical_unit *unit, const char *label) {
    char text[PLOT_LABEL_SIZE];
    if (unit->unit == NULL || plot->panels < 2)
        return;
    unit_note(label, unit->symbol, unit->unit, unit->scale, text, sizeof text);
    (void)legend_add(&plot->legend, text, "");
}

/* Returns whether a label fits beside the panels, in whose middle it stands. */
static bool has_room(const struct plot *plot, const struct frame *whole, const char *label) {
    double middle = (whole->top + whole->bottom) / 2.0;
    double room = 2 * fmin(middle, plot->layout.size.height - middle);
    return (double)plot_letters(label) * PEN_LETTER * plot->layout.scale <= room;
}

/* One label an axis, in the middle of all panels. */
static void draw_labels(const struct plot *plot) {
    struct frame whole = {0}, last = {0};
    plot_place(&plot->layout, 0, &whole);
    plot_place(&plot->layout, plot->layout.columns - 1, &last);
    whole.right = last.right;
    plot_place(&plot->layout, plot->panels - 1, &last);
    whole.bottom = last.bottom;
    frame_label(plot->pen.file, &whole, true, plot->words->x);
    char label[PLOT_LABEL_SIZE];
    snprintf(label, sizeof label, "%.120s%s", plot->words->y,
             is_one_plus(plot) ? ", as log10(1 + y)" : "");
    if (plot->words->y_bare != NULL && !has_room(plot, &whole, label))
        snprintf(label, sizeof label, "%.120s", plot->words->y_bare);
    frame_label(plot->pen.file, &whole, false, label);
}

/* Rows of panels end with the last factor, where that fills them. */
static size_t columns_of(const struct plot_channel *channel) {
    enum { COLUMNS_MOST_OF_FACTOR = 4 };
    size_t all = 1, last = 0;
    for (size_t f = 0; f < channel->factor_count; f++) {
        last = channel->factors[f]->count;
        all *= last;
    }
    return channel->factor_count > 1 && all == channel->count && last <= COLUMNS_MOST_OF_FACTOR
               ? last
               : 0;
}

/* Says how many values are not drawn, as a logarithmic axis has no zero. */
static void note_off_axis(struct plot *plot) {
    char text[PLOT_LABEL_SIZE];
    size_t count = 0;
    for (size_t n = 0; n < plot->lines->count; n++) {
        const struct curve *curve = plot->lines->list[n].curve;
        const struct stretch seen = stretch_of(plot, curve);
        for (size_t k = seen.first; k < seen.end; k++)
            count += plot->lines->list[n].at[CHANNEL_PANEL] < plot->panels &&
                     isfinite(curve->x[k]) && isfinite(curve->y[k]) &&
                     !frame_has_place(&plot->pen.frame, curve->x[k], curve->y[k]);
    }
    snprintf(text, sizeof text, "not on this axis: %zu point%s", count, count == 1 ? "" : "s");
    if (count > 0)
        (void)legend_add(&plot->legend, text, "");
}

/* Chooses what is drawn of the lines, and on which axes. */
static void choose(struct plot *plot, const struct study_result *study) {
    const struct plot_channel *panels = &plot->lines->channels[CHANNEL_PANEL];
    plot->panels = panels->count < PANELS_MOST ? panels->count : PANELS_MOST;
    plot->marks = plot_marks_of(plot->lines, plot->words);
    plot_errors_choose(&plot->errors, plot->lines, plot->panels,
                       plot->marks == MARKS_NONE || plot->lines->list[0].curve->minuend != NULL,
                       !plot->request->without_total);
    start_axes(plot, study);
}

/* Lays out a picture whose axes are fitted, as its legend says what they lack. */
static void lay_out(struct plot *plot, const struct study_result *study) {
    const struct plot_channel *panels = &plot->lines->channels[CHANNEL_PANEL];
    plot_legend_lines(&plot->legend, plot->lines, plot->marks, plot->words);
    plot_theories_name(plot->lines, plot->panels, &plot->pen, &plot->legend);
    plot_errors_note(&plot->legend, plot->lines, &plot->errors);
    if (plot->words->one != NULL)
        plot_legend_case(&plot->legend, study, plot->words->one);
    plot_legend_notes(&plot->legend, plot->lines, plot->words->note);
    note_off_axis(plot);
    plot->x_unit = common_unit(plot->lines, true);
    plot->y_unit = common_unit(plot->lines, false);
    note_unit(plot, &plot->x_unit, plot->words->x);
    note_unit(plot, &plot->y_unit, plot->words->y);
    plot->layout.second_x = plot->x_unit.unit != NULL;
    plot->layout.second_y = plot->y_unit.unit != NULL;
    plot_lay_out(&plot->layout, plot->panels, columns_of(panels), &plot->legend,
                 plot->request->millimetres);
    plot->errors.scale = plot->layout.scale;
}

static void draw_picture(struct plot *plot, const struct study_result *study) {
    const struct plot_layout *layout = &plot->layout;
    FILE *file = plot->pen.file;
    pen_head_sized(&plot->pen, &layout->size);
    pen_study(&plot->pen, study);
    (plot->request->millimetres > 0 ? pen_subject : pen_title)(&plot->pen, study->name,
                                                               plot->words->subject);
    for (size_t panel = 0; panel < plot->panels; panel++)
        draw_panel(plot, panel);
    if (plot->panels == 1)
        draw_second(plot);
    draw_labels(plot);
    legend_draw(&plot->legend, file, layout->scale, layout->legend_left, layout->legend_top,
                layout->legend_width);
    fputs("</svg>\n", file);
}

/* Says why there is nothing to draw. */
static int refuse_empty(const struct plot *plot, struct error *err) {
    const struct frame *frame = &plot->pen.frame;
    const bool x = frame->x.logarithmic, y = frame->y.logarithmic;
    const char *axes = x && y ? "x and y" : x ? "x" : "y";
    if (x || y)
        return error_set(err, ERROR_ABSENT,
                         "%.120s: no point to draw: none is above 0 on the logarithmic %s",
                         plot->words->subject, axes);
    return error_set(err, ERROR_ABSENT, "%.120s: no point to draw: no value is a finite number",
                     plot->words->subject);
}

int plot_lines_draw(const struct plot_lines *lines, const struct study_result *study,
                    const struct plot_request *request, const struct plot_words *words, FILE *file,
                    struct error *err) {
    struct plot *plot = calloc(1, sizeof *plot);
    if (plot == NULL)
        return error_memory(err, sizeof *plot, "a picture");
    plot->lines = lines;
    plot->request = request;
    plot->words = words;
    plot->pen.file = file;
    choose(plot, study);
    int status = fit(plot) ? 0 : refuse_empty(plot, err);
    if (status == 0) {
        lay_out(plot, study);
        draw_picture(plot, study);
    }
    free(plot);
    return status;
}

/* Returns what a series shows, where all cases agree in it, or its name; NULL for NULL. */
static const char *series_shown(const struct study_result *study, const char *series) {
    const struct result_view *view = view_of(study->kind);
    const char *name = view_series_name(view, &study->cases[0], series);
    for (size_t c = 1; c < study->case_count; c++)
        if (view_series_name(view, &study->cases[c], series) != name)
            return series;
    return name != NULL ? name : series;
}

/* Returns the load that all lines are at; NaN where there are several, or none. */
static double shared_load(const struct plot_lines *lines) {
    double load = lines->list[0].curve->pressure;
    for (size_t n = 1; n < lines->count; n++)
        if (!(lines->list[n].curve->pressure == load))
            return (double)NAN;
    return load;
}

/* Returns whether the picture is of one case of several. */
static bool is_one_of(const struct study_result *study) {
    struct swept swept;
    if (study->case_count != 1 || study->cases[0].difference)
        return false;
    swept_find(study, &swept);
    return swept.count > 0;
}

/* Names the quantity, the series that was asked for, the load where all have one, and the case
 * where it is one of several, or the two of a difference. */
static void make_subject(const struct study_result *study, const struct plot_lines *lines,
                         const struct lines_request *request, char subject[PLOT_LABEL_SIZE]) {
    char quantity[61], series_words[61];
    double load = shared_load(lines);
    const struct case_result *one = &study->cases[0];
    unsigned long long number = one->case_number, less = one->less;
    bool other = request->series != NULL && strcmp(request->series, request->quantity) != 0;
    const char *series = other ? series_shown(study, request->series) : NULL;
    plot_in_words(view_words(view_of(study->kind), request->quantity), quantity, sizeof quantity);
    plot_in_words(series != NULL ? view_words(view_of(study->kind), series) : "", series_words,
                  sizeof series_words);
    int used = snprintf(subject, PLOT_LABEL_SIZE, "%s%s%s", quantity, series != NULL ? ", " : "",
                        series_words);
    if (!isnan(load))
        used += snprintf(subject + used, PLOT_LABEL_SIZE - (size_t)used, " at load %.4g", load);
    if (one->difference)
        snprintf(subject + used, PLOT_LABEL_SIZE - (size_t)used, ", case %llu less case %llu",
                 number, less);
    else if (is_one_of(study))
        snprintf(subject + used, PLOT_LABEL_SIZE - (size_t)used, ", case %llu", number);
}

int plot_quantity(const struct study_result *study, const struct plot_request *request, FILE *file,
                  struct error *err) {
    struct plot_lines lines = {0};
    char subject[PLOT_LABEL_SIZE];
    int status = plot_lines_choose(&lines, study, &request->lines, err);
    if (status != 0)
        return status;
    const struct curve *first = lines.list[0].curve;
    make_subject(study, &lines, &request->lines, subject);
    const struct result_view *view = view_of(study->kind);
    char y[PLOT_LABEL_SIZE];
    snprintf(y, sizeof y, "%s%.120s", first->minuend != NULL ? "difference of " : "",
             view_label(view, first->y_label));
    const struct plot_words words = {
        .subject = subject,
        .x = view_label(view, first->x_label),
        .y = y,
        .one = is_one_of(study) || study->cases[0].difference ? &study->cases[0] : NULL,
        .y_bare = first->y_label};
    status = plot_lines_draw(&lines, study, request, &words, file, err);
    plot_lines_clear(&lines);
    return status;
}
