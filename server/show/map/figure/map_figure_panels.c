/* Curves on the page: the spectral density, slope and curvature by scale. Each is drawn of what the
 * characterisation has; a panel without values says so. */
#include "server/show/map/figure/map_figure.h"
#include "server/show/map/figure/map_figure_internal.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { LEFT_FROM = 112, LEFT_TO = 404, RIGHT_FROM = 496, RIGHT_TO = 788 };
enum { MIDDLE_TOP = 528, MIDDLE_BOTTOM = 742, LOW_TOP = 828, LOW_BOTTOM = 1008 };

int figure_points_create(struct figure_points *out, size_t count, struct error *err) {
    enum { ARRAYS = 5 };
    double *block = array_create((count > 0 ? count : 1) * ARRAYS, sizeof *block);
    if (block == NULL)
        return error_memory(err, ARRAYS * count * sizeof *block, "a panel");
    *out = (struct figure_points){
        count, block, block + count, block + 2 * count, block + 3 * count, block + 4 * count};
    return 0;
}

void figure_place(struct figure_page *page, bool right, bool low) {
    struct frame *frame = &page->pen.frame;
    frame->left = right ? RIGHT_FROM : LEFT_FROM;
    frame->right = right ? RIGHT_TO : LEFT_TO;
    frame->top = low ? LOW_TOP : MIDDLE_TOP;
    frame->bottom = low ? LOW_BOTTOM : MIDDLE_BOTTOM;
    frame->scale = 0.9;
    frame->powers = true;
}

void figure_draw_none(struct figure_page *page, bool right, bool low, const char *heading,
                      const char *text) {
    figure_place(page, right, low);
    const struct frame *frame = &page->pen.frame;
    figure_heading(page, heading, frame->left, frame->top - FIGURE_HEADING);
    fprintf(page->pen.file,
            "<rect x=\"%d\" y=\"%d\" width=\"%d\" height=\"%d\" class=\"frame\"/><text x=\"%d\" "
            "y=\"%d\" class=\"middle note\">%s</text>\n",
            frame->left, frame->top, frame->right - frame->left, frame->bottom - frame->top,
            (frame->left + frame->right) / 2, (frame->top + frame->bottom) / 2, text);
}

/* Fills `out` with a column divided by a unit, NaN where there is none. */
static bool take(const struct figure_page *page, const char *group, const char *name, double unit,
                 size_t count, double *out) {
    const struct named_column *column = named_column_find(page->figure->found, group, name);
    for (size_t n = 0; n < count; n++)
        out[n] = column != NULL && n < column->count ? column->values[n] / unit : (double)NAN;
    return column != NULL;
}

/* Why a panel has nothing to show. */
static const char *why_nothing(const struct figure_page *page) {
    return named_number(page->figure->found, "heights", "rms") > 0 ? "the map has too few points"
                                                                   : "all heights are the same";
}

/* Returns how many points logarithmic axes can show. */
static size_t count_shown(const struct figure_points *points) {
    size_t shown = 0;
    for (size_t n = 0; n < points->count; n++)
        shown += points->x[n] > 0 && points->y[n] > 0 ? 1 : 0;
    return shown;
}

static size_t length_of(const struct figure_page *page, const char *group, const char *name) {
    const struct named_column *column = named_column_find(page->figure->found, group, name);
    return column != NULL ? column->count : 0;
}

/* --- spectrum --- */

/* Fills the field between two curves; it is interrupted where either has no value. */
static void draw_band(const struct figure_page *page, const struct figure_points *points) {
    const struct frame *frame = &page->pen.frame;
    FILE *file = page->pen.file;
    for (size_t n = 0; n < points->count;) {
        size_t first = n;
        while (n < points->count && pen_reaches(&page->pen, points->x[n], points->low[n]) &&
               pen_reaches(&page->pen, points->x[n], points->high[n]))
            n++;
        if (n - first > 1) {
            fputs("<path " BAND " d=\"", file);
            for (size_t a = first; a < n; a++)
                fprintf(file, "%c%.2f %.2f", a == first ? 'M' : 'L', frame_x(frame, points->x[a]),
                        frame_y(frame, points->high[a]));
            for (size_t a = n; a-- > first;)
                fprintf(file, "L%.2f %.2f", frame_x(frame, points->x[a]),
                        frame_y(frame, points->low[a]));
            fputs("z\"/>\n", file);
        }
        n += n == first;
    }
}

/* Shades the wave numbers of the wavelengths that can be trusted; returns whether there are any. */
static bool draw_trusted(const struct figure_page *page) {
    static const char GROUP[] = "spectrum_fit";
    const struct frame *frame = &page->pen.frame;
    double longest = named_number(page->figure->found, GROUP, "trusted_from");
    double shortest = named_number(page->figure->found, GROUP, "trusted_to");
    if (!(longest > shortest && shortest > 0))
        return false;
    double from = fmax(2 * M_PI / longest * page->units.x, frame->x.low);
    double to = fmin(2 * M_PI / shortest * page->units.x, frame->x.high);
    if (!(from < to))
        return false;
    double left = frame_x(frame, from), right = frame_x(frame, to);
    fprintf(page->pen.file,
            "<rect x=\"%.1f\" y=\"%d\" width=\"%.1f\" height=\"%d\" " TRUSTED "/>"
            "<path d=\"M%.1f %dV%dM%.1f %dV%d\" stroke=\"#8f8763\" stroke-dasharray=\"3 3\"/>\n",
            left, frame->top, right - left, frame->bottom - frame->top, left, frame->top,
            frame->bottom, right, frame->top, frame->bottom);
    return true;
}

static const double DECADES_MOST = 1e10; /* below, there is rounding alone */

static void draw_psd_panel(struct figure_page *page, struct figure_points *points, int dimension) {
    static const char GROUP[] = "psd";
    struct frame *frame = &page->pen.frame;
    double unit = figure_unit(&page->units, dimension, 2);
    char x_label[PLOT_LABEL_SIZE], y_label[PLOT_LABEL_SIZE];
    struct figure_mark marks[4] = {{"measured", MEASURED, false}};
    size_t count = points->count, rows = 1;
    (void)take(page, GROUP, "wave_number", 1 / page->units.x, count, points->x);
    (void)take(page, GROUP, "density", unit, count, points->y);
    bool band = take(page, GROUP, "density_low", unit, count, points->low) &&
                take(page, GROUP, "density_high", unit, count, points->high);
    bool law = take(page, GROUP, "density_fitted", unit, count, points->law);
    frame_start(frame, true, true);
    frame_include(frame, count, points->x, points->y);
    frame_include(frame, count, points->x, points->high);
    frame_include(frame, count, points->x, points->law);
    if (count_shown(points) < 2 || !frame_finish(frame)) {
        figure_draw_none(page, true, false, "Power spectral density", why_nothing(page));
        return;
    }
    frame->y.low = fmax(frame->y.low, frame->y.high / DECADES_MOST);
    figure_place(page, true, false);
    bool trusted = draw_trusted(page);
    figure_axis_label(&page->units, "q = 2π/λ", -1, 0, x_label);
    figure_axis_label(&page->units, dimension == 2 ? "C(q)" : "C", dimension, 2, y_label);
    frame_draw(page->pen.file, frame, x_label, y_label);
    draw_band(page, points);
    pen_line(&page->pen, count, points->x, points->y, MEASURED);
    pen_line(&page->pen, count, points->x, points->law, FITTED);
    if (band)
        marks[rows++] = (struct figure_mark){"95 % band", BAND, true};
    if (law)
        marks[rows++] = (struct figure_mark){"self-affine fit", FITTED, false};
    if (trusted)
        marks[rows++] = (struct figure_mark){"trusted", TRUSTED " stroke=\"#bbb\"", true};
    figure_legend(page, rows, marks, false, false);
    figure_heading(page, "Power spectral density", frame->left, frame->top - FIGURE_HEADING);
}

int figure_draw_psd(struct figure_page *page, struct error *err) {
    struct figure_points points;
    int status = figure_points_create(&points, length_of(page, "psd", "wave_number"), err);
    if (status != 0)
        return status;
    draw_psd_panel(page, &points, grid_is_profile(page->map.grid) ? 1 : 2);
    free(points.x);
    return 0;
}

/* --- scales --- */

struct scale_panel {
    const char *column, *heading, *label;
    int x_power;
};

static void draw_scale_panel(struct figure_page *page, struct figure_points *points,
                             const struct scale_panel *panel, bool right) {
    struct frame *frame = &page->pen.frame;
    char x_label[PLOT_LABEL_SIZE], y_label[PLOT_LABEL_SIZE];
    double unit = figure_unit(&page->units, panel->x_power, 0);
    (void)take(page, "scales", "length", page->units.x, points->count, points->x);
    (void)take(page, "scales", panel->column, unit, points->count, points->y);
    frame_start(frame, true, true);
    frame_include(frame, points->count, points->x, points->y);
    if (points->count == 1) { /* it stands in the middle */
        frame_include_point(frame, points->x[0] / 2, points->y[0] / 2);
        frame_include_point(frame, 2 * points->x[0], 2 * points->y[0]);
    }
    if (!frame_finish(frame)) {
        figure_draw_none(page, right, true, panel->heading, why_nothing(page));
        return;
    }
    frame->x.low /= 1.15;
    frame->x.high *= 1.15;
    figure_place(page, right, true);
    figure_axis_label(&page->units, "distance", 1, 0, x_label);
    figure_axis_label(&page->units, panel->label, panel->x_power, 0, y_label);
    frame_draw(page->pen.file, frame, x_label, y_label);
    pen_line(&page->pen, points->count, points->x, points->y, MEASURED);
    for (size_t n = 0; n < points->count; n++)
        if (pen_reaches(&page->pen, points->x[n], points->y[n]))
            fprintf(page->pen.file,
                    "<circle cx=\"%.2f\" cy=\"%.2f\" r=\"2.6\" fill=\"#0b4f7d\"/>\n",
                    frame_x(frame, points->x[n]), frame_y(frame, points->y[n]));
    figure_heading(page, panel->heading, frame->left, frame->top - FIGURE_HEADING);
}

int figure_draw_scales(struct figure_page *page, struct error *err) {
    /* x and z have one unit in the map: a slope is a number. */
    const struct scale_panel slope = {"rms_slope", "RMS slope by distance", "slope", 0};
    const struct scale_panel curvature = {"rms_curvature", "RMS curvature by distance", "curvature",
                                          -1};
    struct figure_points points;
    int status = figure_points_create(&points, length_of(page, "scales", "length"), err);
    if (status != 0)
        return status;
    draw_scale_panel(page, &points, &slope, false);
    draw_scale_panel(page, &points, &curvature, true);
    free(points.x);
    return 0;
}
