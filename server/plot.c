#include "server/plot.h"
#include "server/document.h"
#include "server/plot_frame.h"
#include <stdarg.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/* The picture, in SVG user units, and its legend at the right. LETTER: about a letter's width. */
enum { WIDTH = 960, HEIGHT = 570, LEGEND = FRAME_RIGHT + 48, LETTER = 7, LABEL_SIZE = 200 };

/* The first seven after Okabe & Ito (2008): told apart by every reader. */
static const char *const COLOURS[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                      "#e69f00", "#56b4e9", "#000000", "#8a8a00",
                                      "#7f3b08", "#6a51a3", "#999999", "#a50026"};
enum { COLOUR_COUNT = sizeof COLOURS / sizeof *COLOURS };

static bool has_quantity(const cJSON *curve, const char *quantity) {
    return strcmp(text_of(curve, "quantity", ""), quantity) == 0 && !member(curve, "x2");
}

/* Spectra span decades. */
static bool is_logarithmic(const char *quantity) {
    return strcmp(quantity, "psd") == 0;
}

__attribute__((format(printf, 2, 3))) static void append(char label[LABEL_SIZE], const char *format,
                                                         ...) {
    size_t used = strlen(label);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(label + used, LABEL_SIZE - used, format, arguments);
    va_end(arguments);
}

static bool varies(const cJSON *cases, const cJSON *parameter) {
    for (const cJSON *other = cases; other; other = other->next)
        if (!cJSON_Compare(parameter, member(member(other, "parameters"), parameter->string), true))
            return true;
    return false;
}

/* "hurst 0.8, shape 2": what tells this case from others, and its series. */
static void label_of(const cJSON *cases, const cJSON *one, const char *series,
                     char label[LABEL_SIZE]) {
    label[0] = 0;
    const cJSON *parameter = first_of(one, "parameters");
    for (; parameter; parameter = parameter->next) {
        const char *slash = strrchr(parameter->string, '/'), *comma = *label ? ", " : "";
        if (!varies(cases, parameter))
            continue;
        if (cJSON_IsString(parameter))
            append(label, "%s%s", comma, parameter->valuestring);
        else
            append(label, "%s%s %.5g", comma, slash ? slash + 1 : parameter->string,
                   parameter->valuedouble);
    }
    if (*series)
        append(label, "%s%s", *label ? ", " : "", series);
    else if (!*label)
        append(label, "case %.0f", member(one, "case")->valuedouble);
}

/* --- curves --- */

/* A band of one standard error to either side, where the error can be seen. */
static void draw_band(FILE *file, const struct frame *frame, const cJSON *curve,
                      const char *colour) {
    const cJSON *x = first_of(curve, "x"), *y = first_of(curve, "y");
    const cJSON *deviation = first_of(curve, "standard_error");
    for (; x && y && deviation; x = x->next, y = y->next, deviation = deviation->next) {
        if (!frame_has_place(frame, x, y) || !cJSON_IsNumber(deviation))
            continue;
        double low = y->valuedouble - deviation->valuedouble;
        double high = y->valuedouble + deviation->valuedouble;
        if (frame->y.logarithmic && low <= 0)
            continue;
        double top = frame_y(frame, fmin(high, frame->y.high));
        double bottom = frame_y(frame, fmax(low, frame->y.low));
        if (bottom - top > 1)
            fprintf(file, "<path d=\"M%.2f %.2fV%.2f\" class=\"band\" stroke=\"%s\"/>",
                    frame_x(frame, x->valuedouble), top, bottom, colour);
    }
    fputc('\n', file);
}

static void draw_line(FILE *file, const struct frame *frame, const cJSON *x, const cJSON *y,
                      const char *colour, bool dashed) {
    bool pen_down = false;
    fprintf(file, "<path class=\"%s\" stroke=\"%s\" d=\"", dashed ? "theory" : "curve", colour);
    for (; x && y; x = x->next, y = y->next) {
        bool inside = frame_has_place(frame, x, y) && x->valuedouble >= frame->x.low &&
                      x->valuedouble <= frame->x.high && y->valuedouble <= frame->y.high &&
                      y->valuedouble >= frame->y.low;
        if (inside)
            fprintf(file, "%c%.2f %.2f", pen_down ? 'L' : 'M', frame_x(frame, x->valuedouble),
                    frame_y(frame, y->valuedouble));
        pen_down = inside;
    }
    fputs("\"/>\n", file);
}

/* What the pen is about to draw of a quantity. */
struct plot {
    FILE *file;
    struct frame frame;
    const cJSON *cases;
    const char *quantity;
    const cJSON *shared; /* the theories of every curve, where they are the same; or NULL */
    int lines;           /* of the legend, so far */
};

/* The first curve of the quantity that is drawn after this one (NULL: from the start); *one is its
 * case. */
static const cJSON *next_curve(const struct plot *plot, const cJSON **one, int *drawn,
                               const cJSON *curve) {
    curve = curve ? curve->next : NULL;
    for (;;) {
        for (; curve; curve = curve->next)
            if (has_quantity(curve, plot->quantity))
                return curve;
        *one = *one ? (*one)->next : plot->cases;
        if (!*one || ++*drawn > PLOT_CASES)
            return NULL;
        curve = first_of(*one, "curves");
    }
}

static const cJSON *shared_theory(const struct plot *plot) {
    const cJSON *one = NULL, *first = NULL;
    int drawn = 0;
    for (const cJSON *curve = NULL; (curve = next_curve(plot, &one, &drawn, curve));) {
        first = first ? first : curve;
        if (!first_of(curve, "theory") ||
            !cJSON_Compare(member(curve, "theory"), member(first, "theory"), true) ||
            !cJSON_Compare(member(curve, "x"), member(first, "x"), true))
            return NULL;
    }
    return member(first, "theory");
}

static void draw_legend(struct plot *plot, const char *label, const char *colour, bool dashed) {
    int y = FRAME_TOP + 12 + 20 * plot->lines++;
    fprintf(plot->file,
            "<path d=\"M%d %dh24\" class=\"%s\" stroke=\"%s\"/><text x=\"%d\" y=\"%d\">",
            FRAME_RIGHT + 16, y - 4, dashed ? "theory" : "curve", colour, LEGEND, y);
    svg_text(plot->file, label);
    fputs("</text>\n", plot->file);
}

static void draw_curve(const struct plot *plot, const cJSON *curve, const char *colour) {
    draw_band(plot->file, &plot->frame, curve, colour);
    draw_line(plot->file, &plot->frame, first_of(curve, "x"), first_of(curve, "y"), colour, false);
    for (const cJSON *theory = plot->shared ? NULL : first_of(curve, "theory"); theory;
         theory = theory->next)
        draw_line(plot->file, &plot->frame, first_of(curve, "x"), theory->child, colour, true);
}

static void draw_note(struct plot *plot, const char *text) {
    fprintf(plot->file, "<text x=\"%d\" y=\"%d\" class=\"note\">%s</text>\n", FRAME_RIGHT + 16,
            FRAME_TOP + 16 + 20 * plot->lines++, text);
}

/* The theories on top of all curves: one line of the legend each. */
static void draw_theories(struct plot *plot, const cJSON *curve) {
    const cJSON *theory = first_of(curve, "theory");
    for (; theory; theory = theory->next) {
        const char *colour = plot->shared ? "#222" : "#777";
        char label[LABEL_SIZE] = "theory";
        if (plot->shared)
            append(label, ": %s", theory->string);
        else
            append(label, " of each case");
        draw_legend(plot, label, colour, true);
        if (plot->shared)
            draw_line(plot->file, &plot->frame, first_of(curve, "x"), theory->child, colour, true);
    }
}

static void draw_cases(struct plot *plot, const cJSON *first) {
    const cJSON *one = NULL;
    int drawn = 0;
    plot->shared = shared_theory(plot);
    for (const cJSON *curve = NULL; (curve = next_curve(plot, &one, &drawn, curve));) {
        const char *colour = COLOURS[plot->lines % COLOUR_COUNT];
        char label[LABEL_SIZE];
        label_of(plot->cases, one, text_of(curve, "series", ""), label);
        draw_curve(plot, curve, colour);
        draw_legend(plot, label, colour, false);
    }
    draw_theories(plot, first);
    draw_note(plot, "bars: one standard error");
    if (drawn > PLOT_CASES)
        draw_note(plot, "the first cases only");
}

static bool fit(struct plot *plot) {
    const cJSON *one = NULL;
    int drawn = 0;
    frame_start(&plot->frame, is_logarithmic(plot->quantity));
    for (const cJSON *curve = NULL; (curve = next_curve(plot, &one, &drawn, curve));)
        frame_include(&plot->frame, curve);
    return frame_finish(&plot->frame);
}

/* As wide as the longest label of the legend needs. */
static int width_of(const struct plot *plot) {
    const cJSON *one = NULL;
    int drawn = 0, width = WIDTH;
    for (const cJSON *curve = NULL; (curve = next_curve(plot, &one, &drawn, curve));) {
        char label[LABEL_SIZE];
        label_of(plot->cases, one, text_of(curve, "series", ""), label);
        int needed = LEGEND + LETTER * (int)strlen(label) + 16;
        width = needed > width ? needed : width;
    }
    return width;
}

/* title for readers of the file and for those of the picture. */
static void draw_title(const struct plot *plot, const char *name) {
    char title[LABEL_SIZE] = "";
    append(title, "%.120s: %.60s", name, plot->quantity);
    fputs("<title>", plot->file);
    svg_text(plot->file, title);
    fprintf(plot->file, "</title>\n<text x=\"%d\" y=\"%d\" class=\"title\">", FRAME_LEFT,
            FRAME_TOP - 14);
    svg_text(plot->file, title);
    fputs("</text>\n", plot->file);
}

int plot_quantity(const cJSON *curves, const char *quantity, FILE *file, struct error *err) {
    struct plot plot = {.file = file, .cases = first_of(curves, "cases"), .quantity = quantity};
    const cJSON *one = NULL;
    int drawn = 0;
    const cJSON *first = next_curve(&plot, &one, &drawn, NULL);
    if (!first)
        return error_set(err, ERROR_ABSENT, "no case has the quantity \"%.60s\"", quantity);
    int width = width_of(&plot);
    fprintf(file,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %d %d\" width=\"%d\" "
            "height=\"%d\">\n<style>text{font:13px system-ui,sans-serif;fill:#222}"
            ".title{font-weight:600}.middle{text-anchor:middle}.end{text-anchor:end}"
            ".note{fill:#666;font-size:12px}.grid{stroke:#e4e4e4}.frame{fill:none;stroke:#444}"
            ".curve{fill:none;stroke-width:1.8;stroke-linejoin:round}"
            ".theory{fill:none;stroke-width:1.4;stroke-dasharray:6 4;stroke-opacity:.85}"
            ".band{stroke-width:1.4;stroke-opacity:.35}</style>\n"
            "<rect width=\"%d\" height=\"%d\" fill=\"#fff\"/>\n",
            width, HEIGHT, width, HEIGHT, width, HEIGHT);
    draw_title(&plot, text_of(curves, "name", ""));
    if (fit(&plot)) {
        frame_draw(file, &plot.frame, text_of(first, "x_label", ""), text_of(first, "y_label", ""));
        draw_cases(&plot, first);
    }
    fputs("</svg>\n", file);
    return 0;
}
