#include "server/show/plot/plot_errors.h"
#include "schema/result/total.h"
#include <math.h>
#include <string.h>

/* What of a value is drawn: an interval of the y axis, and whether it leaves a source out. */
struct span {
    double low, high;
    bool dashed;
};

static struct span standard_span(const struct curve *curve, size_t n) {
    double y = curve->y[n], error = curve->standard_error[n];
    return (struct span){.low = y - error, .high = y + error};
}

static struct span total_span(const struct curve *curve, size_t n) {
    const struct total total = curve_total(curve, n);
    return (struct span){total.low, total.high, total_is_partial(&total)};
}

static double clamped(const struct frame *frame, double y) {
    return frame_y(frame, fmin(frame->y.high, fmax(frame->y.low, y)));
}

/* --- bars --- */

/* Draws a bar of one standard error to either side, where the error can be seen. */
static void draw_bar(const struct plot_pen *pen, const struct curve *curve, size_t n,
                     const char *colour) {
    const struct frame *frame = &pen->frame;
    const struct span span = standard_span(curve, n);
    if (!isfinite(span.high))
        return;
    double top = clamped(frame, span.high), bottom = clamped(frame, span.low);
    if (bottom - top > 1)
        fprintf(pen->file, "<path d=\"M%.2f %.2fV%.2f\" class=\"bar\" stroke=\"%s\"/>",
                frame_x(frame, curve->x[n]), top, bottom, colour);
}

/* Draws a thin bar over the total interval, with a stroke across each end that is within the
 * frame. */
static void draw_total(const struct plot_pen *pen, const struct curve *curve, size_t n,
                       double scale, const char *colour) {
    static const double HALF = 2.5; /* of a stroke across */
    const struct frame *frame = &pen->frame;
    const struct span span = total_span(curve, n);
    if (!isfinite(span.high))
        return;
    double x = frame_x(frame, curve->x[n]), half = HALF * scale;
    double top = clamped(frame, span.high), bottom = clamped(frame, span.low);
    if (bottom - top <= 1)
        return;
    fprintf(pen->file, "<path d=\"M%.2f %.2fV%.2f\" class=\"total%s\" stroke=\"%s\"/>", x, top,
            bottom, span.dashed ? " part" : "", colour);
    if (span.high <= frame->y.high)
        fprintf(pen->file, "<path d=\"M%.2f %.2fh%.2f\" class=\"total\" stroke=\"%s\"/>", x - half,
                top, 2 * half, colour);
    if (span.low >= frame->y.low)
        fprintf(pen->file, "<path d=\"M%.2f %.2fh%.2f\" class=\"total\" stroke=\"%s\"/>", x - half,
                bottom, 2 * half, colour);
}

static void draw_bars(const struct plot_pen *pen, const struct curve *curve,
                      const struct errors_drawn *drawn, const char *colour) {
    for (size_t n = 0; n < curve->n; n++) {
        if (!pen_reaches(pen, curve->x[n], curve->y[n]))
            continue;
        if (drawn->total)
            draw_total(pen, curve, n, drawn->scale, colour);
        draw_bar(pen, curve, n, colour);
    }
    fputc('\n', pen->file);
}

/* --- bands --- */

typedef struct span (*span_of)(const struct curve *curve, size_t n);

static bool has_band(const struct plot_pen *pen, const struct curve *curve, size_t n, span_of of) {
    return n < curve->n && pen_reaches(pen, curve->x[n], curve->y[n]) &&
           isfinite(of(curve, n).high);
}

static void draw_part(const struct plot_pen *pen, const struct curve *curve, size_t first,
                      size_t end, span_of of, const char *colour) {
    const struct frame *frame = &pen->frame;
    bool dashed = false;
    for (size_t k = first; k < end; k++)
        dashed = dashed || of(curve, k).dashed;
    fprintf(pen->file, "<path class=\"%s%s\" d=\"", of == total_span ? "wide" : "band",
            dashed ? " part" : "");
    for (size_t k = first; k < end; k++)
        fprintf(pen->file, "%c%.2f %.2f", k == first ? 'M' : 'L', frame_x(frame, curve->x[k]),
                clamped(frame, of(curve, k).high));
    for (size_t k = end; k-- > first;)
        fprintf(pen->file, "L%.2f %.2f", frame_x(frame, curve->x[k]),
                clamped(frame, of(curve, k).low));
    fprintf(pen->file, "Z\" fill=\"%s\"", colour);
    if (dashed)
        fprintf(pen->file, " stroke=\"%s\"", colour);
    fputs("/>\n", pen->file);
}

/* Draws a band, a part for each run of points that have one. */
static void draw_band(const struct plot_pen *pen, const struct curve *curve, span_of of,
                      const char *colour) {
    for (size_t n = 0; n < curve->n;) {
        size_t end = n;
        while (has_band(pen, curve, end, of))
            end++;
        if (end > n + 1)
            draw_part(pen, curve, n, end, of, colour);
        n = end > n ? end : n + 1;
    }
}

/* Returns the lines of finest levels in the panel that has most of them. */
static size_t most_in_panel(const struct plot_lines *lines, size_t panels) {
    size_t most = 0;
    for (size_t panel = 0; panel < panels; panel++) {
        size_t count = 0;
        for (size_t n = 0; n < lines->count; n++)
            count += lines->list[n].at[CHANNEL_PANEL] == panel && lines->list[n].coarseness == 0;
        most = count > most ? count : most;
    }
    return most;
}

void plot_errors_choose(struct errors_drawn *drawn, const struct plot_lines *lines, size_t panels,
                        bool bands, bool total) {
    enum { TOTAL_BANDS_MOST = 3 };
    bool crowded = bands && most_in_panel(lines, panels) > TOTAL_BANDS_MOST;
    *drawn = (struct errors_drawn){
        .bands = bands, .total = total && !crowded, .crowded = total && crowded};
}

void plot_errors_draw(const struct plot_pen *pen, const struct curve *curve,
                      const struct errors_drawn *drawn, const char *colour) {
    if (!drawn->bands) {
        draw_bars(pen, curve, drawn, colour);
        return;
    }
    if (drawn->total)
        draw_band(pen, curve, total_span, colour);
    draw_band(pen, curve, standard_span, colour);
}

/* --- axis and legend --- */

/* Limits how far an axis grows for totals: by `part` of the range of the points, or of its decades.
 */
static void find_limits(const struct plot_axis *axis, double part, bool whole, double *least,
                        double *most) {
    double low = axis->low, high = axis->high, length = part * (high - low);
    *least = whole ? -INFINITY : low - length;
    *most = whole ? INFINITY : high + length;
    if (axis->logarithmic) {
        *least = low / pow(high / low, part);
        *most = whole ? INFINITY : high * pow(high / low, part);
    } else if (!whole && low >= 0) {
        *least = fmax(*least, 0);
    }
    if (axis->plus > 0)
        *least = low;
}

/* Returns how far an axis reaches down for a standard error that ends at `low`: a decade below the
 * points where it is logarithmic. Where no point lies below zero, it ends there for bands, such as
 * those of densities, and for bars that would hardly be seen below. */
static double standard_low(const struct plot_axis *points, bool bands, bool whole, double low) {
    static const double SEEN = 0.05, DECADE = 10;
    if (points->logarithmic)
        return fmax(low, points->low / DECADE);
    if (points->plus > 0)
        return fmax(low, fmin(points->low, 0));
    bool hidden = bands || -low < SEEN * (points->high - points->low);
    return !whole && points->low >= 0 && hidden ? fmax(low, 0) : low;
}

void plot_errors_include(struct frame *frame, const struct plot_lines *lines, size_t panels,
                         const struct errors_drawn *drawn, bool whole) {
    const struct plot_axis points = frame->y;
    double least, most;
    if (!(points.low <= points.high))
        return;
    find_limits(&points, drawn->bands || points.logarithmic ? 0.5 : 1, whole, &least, &most);
    for (size_t n = 0; n < lines->count; n++) {
        const struct plot_line *line = &lines->list[n];
        if (line->at[CHANNEL_PANEL] >= panels || line->coarseness > 0)
            continue;
        for (size_t k = 0; k < line->curve->n; k++) {
            const struct span standard = standard_span(line->curve, k);
            const struct span total = total_span(line->curve, k);
            if (!frame_has_place(frame, line->curve->x[k], line->curve->y[k]))
                continue;
            if (isfinite(standard.low) && isfinite(standard.high)) {
                frame->y.low =
                    fmin(frame->y.low, standard_low(&points, drawn->bands, whole, standard.low));
                frame->y.high = fmax(frame->y.high, standard.high);
            }
            if (drawn->total && isfinite(total.low) && isfinite(total.high)) {
                frame->y.low = fmin(frame->y.low, fmax(least, total.low));
                frame->y.high = fmax(frame->y.high, fmin(most, total.high));
            }
        }
    }
}

static void note_unknown(struct legend *legend, const struct plot_lines *lines, bool bands) {
    bool left_out[UNKNOWN_SOURCES] = {false}, any = false;
    char text[PLOT_LABEL_SIZE];
    snprintf(text, sizeof text, "dashed %s: without ", bands ? "edges" : "bars");
    for (size_t n = 0; n < lines->count; n++) {
        bool unknown[UNKNOWN_SOURCES];
        curve_unknown(lines->list[n].curve, unknown);
        for (size_t s = 0; s < UNKNOWN_SOURCES && lines->list[n].coarseness == 0; s++)
            left_out[s] = left_out[s] || unknown[s];
    }
    for (size_t s = 0; s < UNKNOWN_SOURCES; s++) {
        size_t used = strlen(text);
        if (left_out[s])
            snprintf(text + used, sizeof text - used, "%s%s", any ? ", " : "",
                     unknown_source_name(s));
        any = any || left_out[s];
    }
    if (any)
        legend_add(legend, text, "");
}

void plot_errors_note(struct legend *legend, const struct plot_lines *lines,
                      const struct errors_drawn *drawn) {
    legend_add(legend, drawn->bands ? "bands: one standard error" : "bars: one standard error", "");
    if (drawn->crowded)
        legend_add(legend, "total, 95 %: not drawn of so many bands", "");
    if (!drawn->total)
        return;
    legend_add(legend, drawn->bands ? "pale bands: total, 95 %" : "thin bars: total, 95 %", "");
    note_unknown(legend, lines, drawn->bands);
}
