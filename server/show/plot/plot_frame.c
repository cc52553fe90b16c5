#include "server/show/plot/plot_frame.h"
#include "server/show/plot/plot_words.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static bool axis_has(const struct plot_axis *axis, double value) {
    return isfinite(value) && (!axis->logarithmic || value > 0) &&
           (axis->plus == 0 || value > -axis->plus);
}

static void axis_include(struct plot_axis *axis, double value) {
    if (!axis_has(axis, value))
        return;
    axis->low = fmin(axis->low, value);
    axis->high = fmax(axis->high, value);
}

static double axis_place(const struct plot_axis *axis, double value) {
    if (axis->logarithmic)
        return log(value / axis->low) / log(axis->high / axis->low);
    if (axis->plus > 0)
        return log((axis->plus + value) / (axis->plus + axis->low)) /
               log((axis->plus + axis->high) / (axis->plus + axis->low));
    return (value - axis->low) / (axis->high - axis->low);
}

double frame_x(const struct frame *frame, double x) {
    return frame->left + (frame->right - frame->left) * axis_place(&frame->x, x);
}

double frame_y(const struct frame *frame, double y) {
    return frame->bottom - (frame->bottom - frame->top) * axis_place(&frame->y, y);
}

bool frame_has_place(const struct frame *frame, double x, double y) {
    return axis_has(&frame->x, x) && axis_has(&frame->y, y);
}

void frame_include_point(struct frame *frame, double x, double y) {
    if (!frame_has_place(frame, x, y))
        return;
    axis_include(&frame->x, x);
    axis_include(&frame->y, y);
}

void frame_include(struct frame *frame, size_t n, const double *x, const double *y) {
    for (size_t a = 0; a < n; a++)
        frame_include_point(frame, x[a], y[a]);
}

void frame_start(struct frame *frame, bool x_logarithmic, bool y_logarithmic) {
    *frame = (struct frame){.x = {.low = INFINITY, .high = -INFINITY, .logarithmic = x_logarithmic},
                            .y = {.low = INFINITY, .high = -INFINITY, .logarithmic = y_logarithmic},
                            .left = FRAME_LEFT,
                            .top = FRAME_TOP,
                            .right = FRAME_RIGHT,
                            .bottom = FRAME_BOTTOM,
                            .scale = 1};
}

double frame_set(struct frame *frame, const double x[2], const double y[2], bool same_lengths) {
    const double height = FRAME_BOTTOM - FRAME_TOP, width = FRAME_RIGHT - FRAME_LEFT;
    const double ratio = (x[1] - x[0]) / (y[1] - y[0]);
    const double shown = fmin(fmax(ratio, 1 / FRAME_RATIO_MOST), FRAME_RATIO_MOST);
    frame_start(frame, false, false);
    frame->x = (struct plot_axis){.low = x[0], .high = x[1]};
    frame->y = (struct plot_axis){.low = y[0], .high = y[1]};
    if (!same_lengths)
        return 1;
    if (shown * height < width)
        frame->right = FRAME_LEFT + (int)lrint(shown * height);
    else
        frame->bottom = FRAME_TOP + (int)lrint(width / shown);
    return ratio / shown;
}

bool frame_stretch_text(double stretched, char *text, size_t size) {
    snprintf(text, size, "not to scale: %c stretched %.3g times", stretched > 1 ? 'y' : 'x',
             stretched > 1 ? stretched : 1 / stretched);
    return fabs(stretched - 1) > 1e-3;
}

/* Zero belongs to an axis that begins near it. */
static void axis_begin_at_zero(struct plot_axis *axis) {
    if (!axis->logarithmic && !axis->single && axis->low > 0 && axis->low < axis->high / 2)
        axis->low = 0;
}

bool range_is_single(double low, double high) {
    static const double ROUNDING = 1e-9; /* of sums of many terms, with much to spare */
    return !(high - low >= fmax(RANGE_LEAST, ROUNDING * fmax(fabs(low), fabs(high))));
}

bool range_widen(double *low, double *high) {
    if (!range_is_single(*low, *high))
        return false;
    double middle = *low <= *high ? *low + (*high - *low) / 2 : 0;
    double half = fabs(middle) / 2 >= RANGE_LEAST ? fabs(middle) / 2 : 1;
    *low = middle - half;
    *high = middle + half;
    return true;
}

void axis_widen_single(struct plot_axis *axis) {
    if (!range_is_single(axis->low, axis->high))
        return;
    axis->single = true;
    if (axis->logarithmic) {
        axis->low /= 2;
        axis->high *= 2;
        return;
    }
    const double low = axis->low;
    (void)range_widen(&axis->low, &axis->high);
    if (axis->plus > 0) /* it ends above -plus, and at zero where no value is below */
        axis->low = fmax(axis->low, low >= 0 ? 0 : (low - axis->plus) / 2);
}

static void leave_margin(struct plot_axis *axis) {
    double margin = 0.06 * (axis->high - axis->low);
    if (axis->logarithmic) {
        axis->high *= 1.5;
        axis->low /= 1.5;
        return;
    }
    if (axis->plus > 0) {
        const double plus = axis->plus,
                     factor = pow((plus + axis->high) / (plus + axis->low), 0.06);
        axis->high = (plus + axis->high) * factor - plus;
        axis->low = axis->low < 0 ? (plus + axis->low) / factor - plus : axis->low;
        return;
    }
    axis->high += margin;
    if (axis->low != 0)
        axis->low = axis->low > 0 ? fmax(axis->low - margin, 0) : axis->low - margin;
}

bool frame_finish(struct frame *frame) {
    if (!(frame->x.low <= frame->x.high))
        return false;
    axis_widen_single(&frame->x);
    axis_widen_single(&frame->y);
    axis_begin_at_zero(&frame->x);
    axis_begin_at_zero(&frame->y);
    leave_margin(&frame->y);
    return true;
}

int number_digits(double value, double step) {
    enum { LEAST = 4, MOST = 15 };
    if (!(fabs(value) > step && step > 0))
        return LEAST;
    return (int)fmin(MOST, fmax(LEAST, ceil(log10(fabs(value) / step)) + 1));
}

double round_step(double range, int parts) {
    double rough = range / parts, power = pow(10, floor(log10(rough)));
    double relative = rough / power;
    return power * (relative < 1.5 ? 1 : relative < 3.5 ? 2 : relative < 7.5 ? 5 : 10);
}

/* Returns the value of a tick: zero where a multiple of the step misses it by rounding. */
static double tick_value(double value, const struct plot_axis *axis) {
    return fabs(value) < 1e-12 * (axis->high - axis->low) ? 0.0 : value;
}

static void print_power(FILE *file, long power) {
    fprintf(file, "10<tspan class=\"index\" dy=\"-5\">%s%ld</tspan>", power < 0 ? "−" : "",
            labs(power));
}

enum tick_label { TICK_BARE, TICK_NUMBER, TICK_POWER };
struct tick {
    double value, step; /* to its neighbours; 0: they differ by their first digits */
    enum tick_label label;
};

/* Prints the number of a tick with a minus sign, large and small ones with a power of ten: "2×10"
 * to the 5th; or the power of ten that it is. */
static void print_number(FILE *file, const struct tick *tick) {
    char text[32];
    const double value = tick->value;
    if (tick->label == TICK_POWER) {
        print_power(file, lrint(log10(value)));
        return;
    }
    snprintf(text, sizeof text, "%.*g", number_digits(value, tick->step), fabs(value));
    char *exponent = strchr(text, 'e');
    long ten = exponent != NULL ? strtol(exponent + 1, NULL, 10) : 0;
    if (exponent != NULL)
        *exponent = '\0';
    bool one = exponent != NULL && strcmp(text, "1") == 0;
    fprintf(file, "%s%s%s", value < 0 ? "−" : "", one ? "" : text,
            exponent != NULL && !one ? "×" : "");
    if (exponent != NULL)
        print_power(file, ten);
}

/* Draws a tick outside of the frame. */
static void draw_opposite_tick(FILE *file, const struct frame *frame, bool horizontal,
                               const struct tick *tick) {
    static const double LENGTH = 4;
    double x = horizontal ? frame_x(frame, tick->value) : frame->right;
    double y = horizontal ? frame->top : frame_y(frame, tick->value);
    double length = LENGTH * frame->scale;
    fprintf(file, "<path d=\"M%.1f %.1f%c%.1f\" class=\"frame\"/>", x, y, horizontal ? 'v' : 'h',
            horizontal ? -length : length);
    if (tick->label != TICK_BARE) {
        fprintf(file, "<text x=\"%.1f\" y=\"%.1f\"%s>", horizontal ? x : x + 7 * frame->scale,
                y + (horizontal ? -7 : 4) * frame->scale, horizontal ? " class=\"middle\"" : "");
        print_number(file, tick);
        fputs("</text>", file);
    }
    fputc('\n', file);
}

static void draw_tick(FILE *file, const struct frame *frame, bool horizontal,
                      const struct tick *tick) {
    if (frame->opposite) {
        draw_opposite_tick(file, frame, horizontal, tick);
        return;
    }
    double x = horizontal ? frame_x(frame, tick->value) : frame->left;
    double y = horizontal ? frame->bottom : frame_y(frame, tick->value);
    fprintf(file, "<path d=\"M%.1f %.1f%c%d\" class=\"grid\"/>", x, y, horizontal ? 'V' : 'H',
            horizontal ? frame->top : frame->right);
    if (tick->label != TICK_BARE && !(horizontal ? frame->without_x : frame->without_y)) {
        fprintf(file, "<text x=\"%.1f\" y=\"%.1f\" class=\"%s\">",
                horizontal ? x : x - 8 * frame->scale, y + (horizontal ? 18 : 4) * frame->scale,
                horizontal ? "middle" : "end");
        print_number(file, tick);
        fputs("</text>", file);
    }
    fputc('\n', file);
}

static double length_of(const struct frame *frame, bool horizontal) {
    return (horizontal ? frame->right - frame->left : frame->bottom - frame->top) / frame->scale;
}

/* Lines at decades alone, with as many numbers as there is room for. */
static void draw_decades(FILE *file, const struct frame *frame, bool horizontal) {
    static const double ROOM_X = 42, ROOM_Y = 24; /* of a number */
    const struct plot_axis *axis = horizontal ? &frame->x : &frame->y;
    double decades = log10(axis->high / axis->low);
    int each = (int)ceil((horizontal ? ROOM_X : ROOM_Y) * decades / length_of(frame, horizontal));
    int first = (int)ceil(log10(axis->low) - 1e-9);
    for (int decade = first; decade <= log10(axis->high) + 1e-9; decade++)
        draw_tick(file, frame, horizontal,
                  &(struct tick){pow(10, decade), 0,
                                 (decade - first) % each == 0 ? TICK_POWER : TICK_BARE});
}

/* Lines at multiples of a round step. */
static void draw_round_ticks(FILE *file, const struct frame *frame, bool horizontal) {
    enum { PARTS = 5, PART_ROOM = 55 };
    const struct plot_axis *axis = horizontal ? &frame->x : &frame->y;
    double room = floor(length_of(frame, horizontal) / PART_ROOM);
    double step = round_step(axis->high - axis->low, (int)fmin(PARTS, fmax(2, room)));
    static const double ROUNDING = 1e-9; /* of a tick at an end */
    const double first = ceil(axis->low / step - ROUNDING);
    /* Counted, as one more changes no multiple that is as large as 1e16. */
    const double count = floor(axis->high / step + ROUNDING) - first;
    for (int n = 0; n <= count && n <= 2 * PARTS; n++)
        draw_tick(file, frame, horizontal,
                  &(struct tick){tick_value((first + n) * step, axis), step, TICK_NUMBER});
}

static const double STEPS[] = {1, 2, 5};
enum { STEP_COUNT = sizeof STEPS / sizeof *STEPS };

/* Returns how many multiples by 1, 2 and 5 of powers of ten an axis has. */
static size_t count_steps(const struct plot_axis *axis) {
    size_t count = 0;
    for (int decade = (int)floor(log10(axis->low)); pow(10, decade) <= axis->high; decade++)
        for (int s = 0; s < STEP_COUNT; s++) {
            double value = STEPS[s] * pow(10, decade);
            count += value >= axis->low && value <= axis->high;
        }
    return count;
}

/* Lines at 1, 2 and 5 of each decade; numbers at all of them where they do not crowd. A part of a
 * decade that has fewer than two of these has round steps. */
static void draw_logarithmic_ticks(FILE *file, const struct frame *frame, bool horizontal) {
    static const double ROOM_X = 110, ROOM_Y = 60; /* of a decade */
    const struct plot_axis *axis = horizontal ? &frame->x : &frame->y;
    bool crowded = length_of(frame, horizontal) <
                   (horizontal ? ROOM_X : ROOM_Y) * log10(axis->high / axis->low);
    if (frame->powers && crowded) {
        draw_decades(file, frame, horizontal);
        return;
    }
    if (count_steps(axis) < 2) {
        draw_round_ticks(file, frame, horizontal);
        return;
    }
    for (int decade = (int)floor(log10(axis->low)); pow(10, decade) <= axis->high; decade++)
        for (int s = 0; s < STEP_COUNT; s++) {
            double value = STEPS[s] * pow(10, decade);
            if (value >= axis->low && value <= axis->high)
                draw_tick(file, frame, horizontal,
                          &(struct tick){value, 0, s == 0 || !crowded ? TICK_NUMBER : TICK_BARE});
        }
}

/* Round numbers from 0 on, those that do not crowd: 0, 0.2, 0.5, 1, 2, 5, 10 ... */
static void draw_plus_ticks(FILE *file, const struct frame *frame, bool horizontal) {
    static const double ROOM = 30; /* of a number */
    const struct plot_axis *axis = horizontal ? &frame->x : &frame->y;
    double length = length_of(frame, horizontal), last = -1;
    if (axis->low <= 0) {
        draw_tick(file, frame, horizontal, &(struct tick){0, 0, TICK_NUMBER});
        last = axis_place(axis, 0);
    }
    int highest = (int)floor(log10(axis->high));
    for (int decade = highest - 2; decade <= highest; decade++)
        for (int s = 0; s < STEP_COUNT; s++) {
            double value = STEPS[s] * pow(10, decade), place = axis_place(axis, value);
            if (value < axis->low || value > axis->high || (place - last) * length < ROOM)
                continue;
            draw_tick(file, frame, horizontal, &(struct tick){value, 0, TICK_NUMBER});
            last = place;
        }
}

/* Returns the least distance between ticks, which rise. */
static double least_step(const struct plot_axis *axis) {
    double step = axis->high - axis->low;
    for (size_t n = 1; n < axis->tick_count; n++)
        step = fmin(step, axis->ticks[n] - axis->ticks[n - 1]);
    return step;
}

static void draw_ticks(FILE *file, const struct frame *frame, bool horizontal) {
    const struct plot_axis *axis = horizontal ? &frame->x : &frame->y;
    for (size_t n = 0; n < axis->tick_count; n++)
        draw_tick(file, frame, horizontal,
                  &(struct tick){axis->ticks[n], least_step(axis), TICK_NUMBER});
    if (axis->tick_count > 0)
        return;
    if (axis->logarithmic)
        draw_logarithmic_ticks(file, frame, horizontal);
    else if (axis->plus > 0)
        draw_plus_ticks(file, frame, horizontal);
    else
        draw_round_ticks(file, frame, horizontal);
}

void frame_draw(FILE *file, const struct frame *frame, const char *x_label, const char *y_label) {
    fputs("<g>\n", file);
    draw_ticks(file, frame, true);
    draw_ticks(file, frame, false);
    fprintf(file, "<rect x=\"%d\" y=\"%d\" width=\"%d\" height=\"%d\" class=\"frame\"/>\n",
            frame->left, frame->top, frame->right - frame->left, frame->bottom - frame->top);
    if (x_label != NULL)
        frame_label(file, frame, true, x_label);
    if (y_label != NULL)
        frame_label(file, frame, false, y_label);
    fputs("</g>\n", file);
}

/* Returns the axis in other units, with ticks at round numbers of these. */
static struct plot_axis second_axis(const struct plot_axis *axis, double factor) {
    return (struct plot_axis){.low = axis->low * factor,
                              .high = axis->high * factor,
                              .logarithmic = axis->logarithmic,
                              .plus = axis->plus * factor};
}

void frame_draw_second(FILE *file, const struct frame *frame, const double factors[2],
                       const char *x_label, const char *y_label) {
    struct frame second = *frame;
    second.opposite = true;
    fputs("<g>\n", file);
    if (factors[0] > 0) {
        second.x = second_axis(&frame->x, factors[0]);
        draw_ticks(file, &second, true);
        frame_label(file, &second, true, x_label);
    }
    if (factors[1] > 0) {
        second.y = second_axis(&frame->y, factors[1]);
        draw_ticks(file, &second, false);
        frame_label(file, &second, false, y_label);
    }
    fputs("</g>\n", file);
}

void frame_label(FILE *file, const struct frame *frame, bool horizontal, const char *label) {
    double x = (frame->left + frame->right) / 2.0, y = (frame->top + frame->bottom) / 2.0;
    bool opposite = frame->opposite;
    if (horizontal)
        fprintf(file, "<text x=\"%.0f\" y=\"%.0f\" class=\"middle\">", x,
                opposite ? frame->top - 24 * frame->scale : frame->bottom + 44 * frame->scale);
    else
        fprintf(file, "<text transform=\"translate(%.0f %.0f) rotate(-90)\" class=\"middle\">",
                opposite ? frame->right + 60 * frame->scale : frame->left - 66 * frame->scale, y);
    svg_label(file, label);
    fputs("</text>\n", file);
}
