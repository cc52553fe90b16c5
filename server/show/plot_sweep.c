#include "server/show/plot_sweep.h"
#include "server/show/plot_pen.h"
#include <math.h>
#include <stddef.h>
#include <string.h>

enum { STYLE_SIZE = 128, TICKS_MOST = 12, TICK_ROOM = 36, BOTH = 2 };

/* Theories of a scalar, in the order in which they are drawn. */
static const struct sweep_theory {
    const char *label, *dash;
    size_t at; /* in struct scalar */
} THEORIES[BOTH] = {{"theory", "7 4", offsetof(struct scalar, theory)},
                    {"theory of the grid", "2 3", offsetof(struct scalar, grid)}};

static double theory_at(const struct sweep_point *point, const struct sweep_theory *theory) {
    return *(const double *)((const char *)point->scalar + theory->at);
}

struct sweep_plot {
    struct plot_pen pen;
    struct sweep sweep;
    size_t line_count;                             /* that are drawn */
    size_t colours[PLOT_LINES], marks[PLOT_LINES]; /* of the lines */
    size_t tick_count;
    double ticks[TICKS_MOST];
};

/* --- the axes --- */

/* Gathers the values of x, which take the place of ticks where they are few and apart. */
static void gather_ticks(struct sweep_plot *plot) {
    const struct sweep *sweep = &plot->sweep;
    for (size_t p = 0; p < sweep->count && plot->tick_count <= TICKS_MOST; p++) {
        double x = sweep->points[p].x;
        size_t place = plot->tick_count;
        bool met = false;
        for (size_t n = 0; n < plot->tick_count; n++)
            met = met || plot->ticks[n] == x;
        if (met)
            continue;
        if (plot->tick_count++ == TICKS_MOST)
            return;
        for (; place > 0 && plot->ticks[place - 1] > x; place--)
            plot->ticks[place] = plot->ticks[place - 1];
        plot->ticks[place] = x;
    }
}

/* Returns whether the values of x lie nearer to geometric than to even steps. */
static bool is_geometric(const struct sweep_plot *plot) {
    size_t n = plot->tick_count;
    if (n < 3 || n > TICKS_MOST || plot->ticks[0] <= 0 || plot->ticks[n - 1] < 4 * plot->ticks[0])
        return false;
    double low = plot->ticks[0], high = plot->ticks[n - 1], middle = plot->ticks[n / 2];
    if (n % 2 == 0)
        middle = (middle + plot->ticks[n / 2 - 1]) / 2;
    return fabs(middle - sqrt(low * high)) < fabs(middle - (low + high) / 2);
}

static void set_ticks(struct sweep_plot *plot) {
    struct plot_axis *axis = &plot->pen.frame.x;
    if (plot->tick_count > TICKS_MOST)
        return;
    for (size_t n = 1; n < plot->tick_count; n++)
        if (frame_x(&plot->pen.frame, plot->ticks[n]) -
                frame_x(&plot->pen.frame, plot->ticks[n - 1]) <
            TICK_ROOM)
            return;
    axis->ticks = plot->ticks;
    axis->tick_count = plot->tick_count;
}

/* Marks at the ends keep away from the frame. */
static void widen(struct plot_axis *axis, double low, double high) {
    double margin = low < high ? 0.06 * (high - low) : 0.5 * fabs(low) + (low == 0);
    double factor = low < high ? pow(high / low, 0.06) : 2;
    axis->low = axis->logarithmic ? low / factor : low - margin;
    axis->high = axis->logarithmic ? high * factor : high + margin;
}

static void fit(struct sweep_plot *plot) {
    struct frame *frame = &plot->pen.frame;
    double low = INFINITY, high = -INFINITY;
    gather_ticks(plot);
    frame_start(frame, is_geometric(plot), false);
    for (size_t line = 0; line < plot->line_count; line++) {
        size_t count;
        const struct sweep_point *points = sweep_line(&plot->sweep, line, &count);
        for (size_t p = 0; p < count; p++) {
            double y = points[p].scalar->value, error = points[p].scalar->standard_error;
            error = isfinite(error) ? error : 0;
            low = fmin(low, points[p].x);
            high = fmax(high, points[p].x);
            frame_include_point(frame, points[p].x, y - error);
            frame_include_point(frame, points[p].x, y + error);
            for (size_t t = 0; t < BOTH; t++)
                frame_include_point(frame, points[p].x, theory_at(&points[p], &THEORIES[t]));
        }
    }
    frame_finish(frame);
    widen(&frame->x, low, high);
    if (frame->y.low != 0)
        frame->y.low -= 0.06 * (frame->y.high - frame->y.low);
    set_ticks(plot);
}

/* --- the lines --- */

/* Lines of one value of the colour's parameter share it, and take different marks. */
static void choose_styles(struct sweep_plot *plot) {
    const struct sweep *sweep = &plot->sweep;
    const struct case_result *seen[PLOT_LINES] = {0};
    size_t colours = 0, taken[PLOT_LINES] = {0}, count;
    for (size_t line = 0; line < plot->line_count; line++) {
        const struct case_result *one = sweep_line(sweep, line, &count)->one;
        size_t colour = 0;
        while (colour < colours &&
               (sweep->colour == NULL || !sweep_same(seen[colour], one, sweep->colour)))
            colour++;
        if (colour == colours)
            seen[colours++] = one;
        plot->colours[line] = colour;
        plot->marks[line] = taken[colour]++;
    }
}

/* Circle, square, triangle, diamond; filled at first, then open. */
static void draw_mark(FILE *file, size_t mark, double x, double y, const char *colour) {
    static const char *const SHAPES[] = {"m-4 0a4 4 0 1 0 8 0a4 4 0 1 0 -8 0",
                                         "m-3.6 -3.6h7.2v7.2h-7.2Z", "m0 -4.8l4.4 7.8h-8.8Z",
                                         "m0 -5l5 5l-5 5l-5 -5Z"};
    enum { SHAPE_COUNT = sizeof SHAPES / sizeof *SHAPES };
    fprintf(file,
            "<path d=\"M%.2f %.2f%sZ\" class=\"mark\" stroke-width=\"1.2\" stroke=\"%s\" "
            "fill=\"%s\"/>\n",
            x, y, SHAPES[mark % SHAPE_COUNT], colour,
            mark / SHAPE_COUNT % 2 == 0 ? colour : "#fff");
}

static void draw_points(struct sweep_plot *plot, const struct sweep_point *points, size_t count,
                        size_t line) {
    const struct frame *frame = &plot->pen.frame;
    const char *colour = PEN_COLOURS[plot->colours[line]];
    for (size_t p = 0; p < count; p++) {
        double x = points[p].x, y = points[p].scalar->value,
               error = points[p].scalar->standard_error;
        if (!pen_reaches(&plot->pen, x, y))
            continue;
        if (isfinite(error) && error > 0)
            fprintf(plot->pen.file, "<path d=\"M%.2f %.2fV%.2f\" class=\"bar\" stroke=\"%s\"/>",
                    frame_x(frame, x), frame_y(frame, y - error), frame_y(frame, y + error),
                    colour);
        draw_mark(plot->pen.file, plot->marks[line], frame_x(frame, x), frame_y(frame, y), colour);
    }
}

/* Draws a line through one number of each point; at: its offset in struct scalar. */
static void draw_line(struct sweep_plot *plot, const struct sweep_point *points, size_t count,
                      size_t at, const char *style) {
    const struct frame *frame = &plot->pen.frame;
    bool down = false;
    fprintf(plot->pen.file, "<path %s d=\"", style);
    for (size_t p = 0; p < count; p++) {
        double y = *(const double *)((const char *)points[p].scalar + at);
        bool inside = pen_reaches(&plot->pen, points[p].x, y);
        if (inside)
            fprintf(plot->pen.file, "%c%.2f %.2f", down ? 'L' : 'M', frame_x(frame, points[p].x),
                    frame_y(frame, y));
        down = inside;
    }
    fputs("\"/>\n", plot->pen.file);
}

static void draw_curves(struct sweep_plot *plot) {
    for (size_t line = 0; line < plot->line_count; line++) {
        size_t count;
        char style[STYLE_SIZE], label[PLOT_LABEL_SIZE];
        const struct sweep_point *points = sweep_line(&plot->sweep, line, &count);
        snprintf(style, sizeof style, "class=\"curve\" stroke=\"%s\" stroke-opacity=\".55\"",
                 PEN_COLOURS[plot->colours[line]]);
        draw_line(plot, points, count, offsetof(struct scalar, value), style);
        draw_points(plot, points, count, line);
        sweep_label(&plot->sweep, points, label, sizeof label);
        int row = plot->pen.rows;
        pen_legend(&plot->pen, *label != '\0' ? label : points->scalar->name, style);
        draw_mark(plot->pen.file, plot->marks[line], plot->pen.frame.right + 29, pen_row(row),
                  PEN_COLOURS[plot->colours[line]]);
    }
}

/* Returns whether two lines have the same theory at the same places; false where one has none. */
static bool same_theory(const struct sweep_plot *plot, const struct sweep_theory *theory,
                        size_t line, size_t other) {
    size_t count, other_count, known = 0;
    const struct sweep_point *a = sweep_line(&plot->sweep, line, &count);
    const struct sweep_point *b = sweep_line(&plot->sweep, other, &other_count);
    for (size_t p = 0; p < count && count == other_count; p++) {
        if (a[p].x != b[p].x || !same_number(theory_at(&a[p], theory), theory_at(&b[p], theory)))
            return false;
        known += isfinite(theory_at(&a[p], theory)) != 0;
    }
    return known > 0;
}

/* Draws what is not drawn yet: a theory that lines share is drawn once, and black. */
static bool draw_theory(struct sweep_plot *plot, const struct sweep_theory *theory, size_t line) {
    char style[STYLE_SIZE];
    size_t count;
    bool shared = false;
    const struct sweep_point *points = sweep_line(&plot->sweep, line, &count);
    if (!same_theory(plot, theory, line, line))
        return false;
    for (size_t other = 0; other < line; other++)
        if (same_theory(plot, theory, line, other))
            return false;
    for (size_t other = line + 1; other < plot->line_count; other++)
        shared = shared || same_theory(plot, theory, line, other);
    snprintf(style, sizeof style, "class=\"theory\" stroke=\"%s\" stroke-dasharray=\"%s\"",
             shared ? "#222" : PEN_COLOURS[plot->colours[line]], theory->dash);
    draw_line(plot, points, count, theory->at, style);
    return true;
}

/* Theories lie on top of all lines. */
static void draw_theories(struct sweep_plot *plot) {
    for (size_t t = 0; t < BOTH; t++) {
        char style[STYLE_SIZE], label[PLOT_LABEL_SIZE];
        size_t drawn = 0;
        for (size_t line = 0; line < plot->line_count; line++)
            drawn += draw_theory(plot, &THEORIES[t], line);
        if (drawn == 0)
            continue;
        snprintf(style, sizeof style, "class=\"theory\" stroke=\"#777\" stroke-dasharray=\"%s\"",
                 THEORIES[t].dash);
        snprintf(label, sizeof label, "%s%s", THEORIES[t].label, drawn > 1 ? ", of each" : "");
        pen_legend(&plot->pen, label, style);
    }
}

static void draw_notes(struct sweep_plot *plot) {
    char text[PLOT_LABEL_SIZE];
    pen_note(&plot->pen, "bars: one standard error");
    if (plot->line_count < plot->sweep.line_count) {
        snprintf(text, sizeof text, "shown: first %d of %zu lines", PLOT_LINES,
                 plot->sweep.line_count);
        pen_note(&plot->pen, text);
    }
    if (plot->sweep.left_out > 0) {
        snprintf(text, sizeof text, "without a value: %zu %s", plot->sweep.left_out,
                 plot->sweep.left_out == 1 ? "case" : "cases");
        pen_note(&plot->pen, text);
    }
}

/* Returns the width that the longest label of the legend needs. */
static int width_of(const struct sweep_plot *plot) {
    int width = PEN_WIDTH;
    for (size_t line = 0; line < plot->line_count; line++) {
        char label[PLOT_LABEL_SIZE];
        size_t count;
        sweep_label(&plot->sweep, sweep_line(&plot->sweep, line, &count), label, sizeof label);
        int needed = PEN_LEGEND + PEN_LETTER * (int)strlen(label) + 16;
        width = needed > width ? needed : width;
    }
    return width;
}

int plot_sweep(const struct study_result *study, const struct sweep_request *request, FILE *file,
               struct error *err) {
    struct sweep_plot plot = {.pen = {.file = file}};
    char subject[PLOT_LABEL_SIZE];
    int status = sweep_make(&plot.sweep, study, request, err);
    if (status != 0)
        return status;
    plot.line_count = plot.sweep.line_count < PLOT_LINES ? plot.sweep.line_count : PLOT_LINES;
    choose_styles(&plot);
    snprintf(subject, sizeof subject, "%.60s over %.60s", request->scalar, last_name(plot.sweep.x));
    pen_head(&plot.pen, width_of(&plot));
    pen_study(&plot.pen, study);
    pen_title(&plot.pen, study->name, subject);
    fit(&plot);
    frame_draw(file, &plot.pen.frame, last_name(plot.sweep.x), request->scalar);
    draw_curves(&plot);
    draw_theories(&plot);
    draw_notes(&plot);
    fputs("</svg>\n", file);
    sweep_clear(&plot.sweep);
    return 0;
}
