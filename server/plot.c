#include "server/plot.h"
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/* The picture, in SVG user units; the plot area inside its margins, the legend at its right. */
enum { WIDTH = 1040, HEIGHT = 560, LEFT = 80, RIGHT = 700, TOP = 30, BOTTOM = 490 };

/* Okabe & Ito (2008): told apart by every reader. */
static const char *const COLOURS[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                      "#e69f00", "#56b4e9", "#000000", "#8a8a00"};
enum { COLOUR_COUNT = sizeof COLOURS / sizeof *COLOURS };

static const cJSON *member(const cJSON *object, const char *name) {
    return cJSON_GetObjectItemCaseSensitive(object, name);
}

static const cJSON *first_of(const cJSON *object, const char *name) {
    const cJSON *array = member(object, name);
    return array ? array->child : NULL;
}

static const char *text_of(const cJSON *object, const char *name) {
    const cJSON *value = member(object, name);
    return cJSON_IsString(value) ? value->valuestring : "";
}

static bool has_quantity(const cJSON *curve, const char *quantity) {
    return strcmp(text_of(curve, "quantity"), quantity) == 0 && !member(curve, "x2");
}

/* --- axes --- */

struct axis {
    double low, high;
    bool logarithmic;
};

static void axis_include(struct axis *axis, double value) {
    if (!isfinite(value) || (axis->logarithmic && value <= 0))
        return;
    axis->low = fmin(axis->low, value);
    axis->high = fmax(axis->high, value);
}

static double axis_place(const struct axis *axis, double value) {
    if (axis->logarithmic)
        return log(value / axis->low) / log(axis->high / axis->low);
    return (value - axis->low) / (axis->high - axis->low);
}

struct frame {
    struct axis x, y;
};

static double place_x(const struct frame *frame, double x) {
    return LEFT + (RIGHT - LEFT) * axis_place(&frame->x, x);
}

static double place_y(const struct frame *frame, double y) {
    return BOTTOM - (BOTTOM - TOP) * axis_place(&frame->y, y);
}

static bool drawable(const struct frame *frame, const cJSON *x, const cJSON *y) {
    return cJSON_IsNumber(x) && cJSON_IsNumber(y) &&
           (!frame->x.logarithmic || x->valuedouble > 0) &&
           (!frame->y.logarithmic || y->valuedouble > 0);
}

/* Spectra span decades. */
static bool is_logarithmic(const char *quantity) {
    return strcmp(quantity, "psd") == 0;
}

static void frame_include(struct frame *frame, const cJSON *curve) {
    const cJSON *x = first_of(curve, "x"), *y = first_of(curve, "y");
    for (; x && y; x = x->next, y = y->next) {
        /* Points at zero at the ends of a histogram say nothing: they do not widen the frame. */
        if (!drawable(frame, x, y) || y->valuedouble == 0)
            continue;
        axis_include(&frame->x, x->valuedouble);
        axis_include(&frame->y, y->valuedouble);
    }
}

static bool frame_fit(struct frame *frame, const cJSON *cases, const char *quantity) {
    struct axis empty = {INFINITY, -INFINITY, is_logarithmic(quantity)};
    int drawn = 0;
    frame->x = frame->y = empty;
    for (const cJSON *one = cases; one && drawn < PLOT_CASES; one = one->next, drawn++)
        for (const cJSON *curve = first_of(one, "curves"); curve; curve = curve->next)
            if (has_quantity(curve, quantity))
                frame_include(frame, curve);
    if (!(frame->x.low <= frame->x.high))
        return false;
    if (!frame->y.logarithmic && frame->y.low > 0 && frame->y.low < frame->y.high / 2)
        frame->y.low = 0;
    struct axis *axes[] = {&frame->x, &frame->y};
    for (int a = 0; a < 2; a++)
        if (axes[a]->low == axes[a]->high) {
            axes[a]->high = axes[a]->logarithmic ? 2 * axes[a]->low : axes[a]->low + 1;
        } else if (a == 1 && !axes[a]->logarithmic) {
            axes[a]->high += 0.06 * (axes[a]->high - axes[a]->low);
        }
    return true;
}

/* A step of 1, 2 or 5 times a power of ten, with about five of them along the axis. */
static double tick_step(const struct axis *axis) {
    double rough = (axis->high - axis->low) / 5, power = pow(10, floor(log10(rough)));
    double relative = rough / power;
    return power * (relative < 1.5 ? 1 : relative < 3.5 ? 2 : relative < 7.5 ? 5 : 10);
}

static void draw_tick(FILE *file, const struct frame *frame, bool horizontal, double value) {
    double x = horizontal ? place_x(frame, value) : LEFT;
    double y = horizontal ? BOTTOM : place_y(frame, value);
    fprintf(file, "<path d=\"M%.1f %.1f%s\" class=\"grid\"/>", x, y, horizontal ? "V30" : "H700");
    fprintf(file, "<text x=\"%.1f\" y=\"%.1f\" class=\"%s\">%.4g</text>\n", horizontal ? x : x - 8,
            horizontal ? y + 18 : y + 4, horizontal ? "middle" : "end",
            fabs(value) < 1e-12 * (frame->y.high - frame->y.low) ? 0.0 : value);
}

static void draw_ticks(FILE *file, const struct frame *frame, bool horizontal) {
    const struct axis *axis = horizontal ? &frame->x : &frame->y;
    if (axis->logarithmic) {
        int last = (int)floor(log10(axis->high));
        for (int decade = (int)ceil(log10(axis->low)); decade <= last; decade++)
            draw_tick(file, frame, horizontal, pow(10, decade));
        return;
    }
    double step = tick_step(axis);
    long last = lrint(floor(axis->high / step));
    for (long n = lrint(ceil(axis->low / step)); n <= last; n++)
        draw_tick(file, frame, horizontal, (double)n * step);
}

/* --- text --- */

static void print_escaped(FILE *file, const char *text) {
    for (; *text; text++) {
        const char *entity = *text == '<'   ? "&lt;"
                             : *text == '>' ? "&gt;"
                             : *text == '&' ? "&amp;"
                             : *text == '"' ? "&quot;"
                                            : NULL;
        if (entity)
            fputs(entity, file);
        else
            fputc(*text, file);
    }
}

/* "hurst 0.8, shape 2": what tells this case from the first other one that differs. */
static void print_label(FILE *file, const cJSON *cases, const cJSON *one, const char *series) {
    bool some = false;
    const cJSON *parameter = first_of(one, "parameters");
    for (; parameter; parameter = parameter->next) {
        bool varies = false;
        for (const cJSON *other = cases; other && !varies; other = other->next)
            varies = !cJSON_Compare(parameter,
                                    member(member(other, "parameters"), parameter->string), true);
        if (!varies)
            continue;
        const char *slash = strrchr(parameter->string, '/');
        print_escaped(file, some ? ", " : "");
        some = true;
        if (cJSON_IsString(parameter)) {
            print_escaped(file, parameter->valuestring);
        } else {
            print_escaped(file, slash ? slash + 1 : parameter->string);
            fprintf(file, " %.5g", parameter->valuedouble);
        }
    }
    if (*series) {
        print_escaped(file, some ? ", " : "");
        print_escaped(file, series);
    } else if (!some) {
        fprintf(file, "case %.0f", member(one, "case")->valuedouble);
    }
}

/* --- curves --- */

/* A band of one standard error to either side, where the error can be seen. */
static void draw_band(FILE *file, const struct frame *frame, const cJSON *curve,
                      const char *colour) {
    const cJSON *x = first_of(curve, "x"), *y = first_of(curve, "y");
    const cJSON *deviation = first_of(curve, "standard_error");
    for (; x && y && deviation; x = x->next, y = y->next, deviation = deviation->next) {
        if (!drawable(frame, x, y) || !cJSON_IsNumber(deviation))
            continue;
        double low = y->valuedouble - deviation->valuedouble;
        double high = y->valuedouble + deviation->valuedouble;
        if (frame->y.logarithmic && low <= 0)
            continue;
        double top = place_y(frame, fmin(high, frame->y.high));
        double bottom = place_y(frame, fmax(low, frame->y.low));
        if (bottom - top > 1)
            fprintf(file, "<path d=\"M%.2f %.2fV%.2f\" class=\"band\" stroke=\"%s\"/>",
                    place_x(frame, x->valuedouble), top, bottom, colour);
    }
    fputc('\n', file);
}

static void draw_line(FILE *file, const struct frame *frame, const cJSON *x, const cJSON *y,
                      const char *colour, bool dashed) {
    bool pen_down = false;
    fprintf(file, "<path class=\"%s\" stroke=\"%s\" d=\"", dashed ? "theory" : "curve", colour);
    for (; x && y; x = x->next, y = y->next) {
        bool inside = drawable(frame, x, y) && x->valuedouble >= frame->x.low &&
                      x->valuedouble <= frame->x.high && y->valuedouble <= frame->y.high &&
                      y->valuedouble >= frame->y.low;
        if (inside)
            fprintf(file, "%c%.2f %.2f", pen_down ? 'L' : 'M', place_x(frame, x->valuedouble),
                    place_y(frame, y->valuedouble));
        pen_down = inside;
    }
    fputs("\"/>\n", file);
}

static void draw_curve(FILE *file, const struct frame *frame, const cJSON *curve,
                       const char *colour) {
    draw_band(file, frame, curve, colour);
    draw_line(file, frame, first_of(curve, "x"), first_of(curve, "y"), colour, false);
    for (const cJSON *theory = first_of(curve, "theory"); theory; theory = theory->next)
        draw_line(file, frame, first_of(curve, "x"), theory->child, colour, true);
}

static void draw_legend(FILE *file, const cJSON *cases, const cJSON *one, const char *series,
                        int line, const char *colour) {
    int y = TOP + 12 + 20 * line;
    fprintf(file, "<path d=\"M%d %dh24\" class=\"curve\" stroke=\"%s\"/><text x=\"%d\" y=\"%d\">",
            RIGHT + 16, y - 4, colour, RIGHT + 48, y);
    print_label(file, cases, one, series);
    fputs("</text>\n", file);
}

static void draw_cases(FILE *file, const struct frame *frame, const cJSON *cases,
                       const char *quantity) {
    int line = 0, drawn = 0;
    const cJSON *one = cases;
    for (; one && drawn < PLOT_CASES; one = one->next, drawn++)
        for (const cJSON *curve = first_of(one, "curves"); curve; curve = curve->next) {
            if (!has_quantity(curve, quantity))
                continue;
            const char *colour = COLOURS[line % COLOUR_COUNT];
            draw_curve(file, frame, curve, colour);
            draw_legend(file, cases, one, text_of(curve, "series"), line++, colour);
        }
    int y = TOP + 12 + 20 * line;
    fprintf(file,
            "<text x=\"%d\" y=\"%d\" class=\"note\">bars: standard error; dashed: theory</text>\n",
            RIGHT + 16, y + 4);
    if (one)
        fprintf(file, "<text x=\"%d\" y=\"%d\" class=\"note\">the first %d cases</text>\n",
                RIGHT + 16, y + 22, PLOT_CASES);
}

static void draw_frame(FILE *file, const struct frame *frame, const cJSON *curve) {
    fputs("<g>\n", file);
    draw_ticks(file, frame, true);
    draw_ticks(file, frame, false);
    fprintf(file, "<rect x=\"%d\" y=\"%d\" width=\"%d\" height=\"%d\" class=\"frame\"/>\n", LEFT,
            TOP, RIGHT - LEFT, BOTTOM - TOP);
    fprintf(file, "<text x=\"%d\" y=\"%d\" class=\"middle\">", (LEFT + RIGHT) / 2, BOTTOM + 44);
    print_escaped(file, text_of(curve, "x_label"));
    fprintf(file, "</text>\n<text transform=\"translate(20 %d) rotate(-90)\" class=\"middle\">",
            (TOP + BOTTOM) / 2);
    print_escaped(file, text_of(curve, "y_label"));
    fputs("</text></g>\n", file);
}

static const cJSON *find_curve(const cJSON *cases, const char *quantity) {
    for (const cJSON *one = cases; one; one = one->next)
        for (const cJSON *curve = first_of(one, "curves"); curve; curve = curve->next)
            if (has_quantity(curve, quantity))
                return curve;
    return NULL;
}

int plot_quantity(const cJSON *curves, const char *quantity, FILE *file, struct error *err) {
    const cJSON *cases = first_of(curves, "cases");
    const cJSON *curve = find_curve(cases, quantity);
    struct frame frame;
    if (!curve)
        return error_set(err, ERROR_ABSENT, "no case has the quantity \"%.60s\"", quantity);
    fprintf(file,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %d %d\" width=\"%d\" "
            "height=\"%d\">\n<style>text{font:13px system-ui,sans-serif;fill:#222}"
            ".middle{text-anchor:middle}.end{text-anchor:end}.note{fill:#666;font-size:12px}"
            ".grid{stroke:#e4e4e4}.frame{fill:none;stroke:#444}"
            ".curve{fill:none;stroke-width:1.8;stroke-linejoin:round}"
            ".theory{fill:none;stroke-width:1.3;stroke-dasharray:6 4;stroke-opacity:.75}"
            ".band{stroke-width:1.4;stroke-opacity:.35}</style>\n"
            "<rect width=\"%d\" height=\"%d\" fill=\"#fff\"/>\n",
            WIDTH, HEIGHT, WIDTH, HEIGHT, WIDTH, HEIGHT);
    fprintf(file, "<title>");
    print_escaped(file, text_of(curves, "name"));
    fprintf(file, ": %s</title>\n", quantity);
    if (frame_fit(&frame, cases, quantity)) {
        draw_frame(file, &frame, curve);
        draw_cases(file, &frame, cases, quantity);
    }
    fputs("</svg>\n", file);
    return 0;
}
