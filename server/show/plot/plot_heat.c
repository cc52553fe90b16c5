#include "server/show/plot/plot_heat.h"
#include <math.h>

/* --- levels and their colours --- */

struct heat_scale heat_scale_between(double low, double high, int levels, enum heat_ramp ramp) {
    struct heat_scale scale = {.ramp = ramp};
    double step = round_step(high - low, levels), first = floor(low / step);
    for (size_t n = 0; n <= HEAT_LEVELS; n++) {
        scale.bounds[n] = (first + (double)n) * step;
        if (n > 0 && scale.bounds[n - 1] <= high)
            scale.count = n;
    }
    return scale;
}

struct heat_scale heat_scale_of_density(double highest) {
    static const double STEPS[] = {1, 2, 5};
    struct heat_scale scale = {.ramp = HEAT_DENSITY};
    double least = highest / 50, decade = pow(10, floor(log10(least)));
    size_t bounds = 0;
    for (; bounds == 0 || scale.bounds[bounds - 1] <= highest; decade *= 10)
        for (size_t s = 0; s < 3; s++)
            if (STEPS[s] * decade >= least && (bounds == 0 || scale.bounds[bounds - 1] <= highest))
                scale.bounds[bounds++] = STEPS[s] * decade;
    scale.count = bounds - 1;
    return scale;
}

/* Returns -1 for what has no colour. */
static int level_of(const struct heat_scale *scale, double value) {
    if (!(value >= scale->bounds[0]))
        return -1;
    size_t level = scale->count - 1;
    while (level > 0 && value < scale->bounds[level])
        level--;
    return (int)level;
}

/* Colours between these are mixed evenly: blues on a light ground, and those of the map "viridis",
 * whose lightness rises evenly. */
enum { ANCHORS = 5 };
static const unsigned char RAMPS[][ANCHORS][3] = {{{0xe6, 0xf0, 0xf8},
                                                   {0xb9, 0xd5, 0xea},
                                                   {0x7f, 0xb2, 0xd8},
                                                   {0x3d, 0x86, 0xbd},
                                                   {0x0b, 0x55, 0x93}},
                                                  {{0x44, 0x01, 0x54},
                                                   {0x3b, 0x52, 0x8b},
                                                   {0x21, 0x91, 0x8c},
                                                   {0x5e, 0xc9, 0x62},
                                                   {0xfd, 0xe7, 0x25}}};

void heat_colour(enum heat_ramp ramp, double place, char out[HEAT_COLOUR_SIZE]) {
    size_t anchor = (size_t)(place * (ANCHORS - 1));
    anchor = anchor < ANCHORS - 1 ? anchor : ANCHORS - 2;
    double part = place * (ANCHORS - 1) - (double)anchor;
    unsigned mixed[3];
    for (size_t c = 0; c < 3; c++) {
        double from = RAMPS[ramp][anchor][c], to = RAMPS[ramp][anchor + 1][c];
        mixed[c] = (unsigned)lrint(from + part * (to - from)) & 0xff;
    }
    snprintf(out, HEAT_COLOUR_SIZE, "#%02x%02x%02x", mixed[0], mixed[1], mixed[2]);
}

static void colour_of(const struct heat_scale *scale, size_t level, char out[HEAT_COLOUR_SIZE]) {
    heat_colour(scale->ramp, scale->count > 1 ? (double)level / (double)(scale->count - 1) : 1,
                out);
}

/* --- cells --- */

static double edge_x(const struct plot_pen *pen, const struct heat_cells *cells, double i) {
    return frame_x(&pen->frame, cells->x[0] + (cells->x[1] - cells->x[0]) * i / (double)cells->nx);
}

static double edge_y(const struct plot_pen *pen, const struct heat_cells *cells, double j) {
    return frame_y(&pen->frame, cells->y[0] + (cells->y[1] - cells->y[0]) * j / (double)cells->ny);
}

/* A run of cells of one level in a row is one rectangle. */
static void draw_row(const struct plot_pen *pen, const struct heat_cells *cells,
                     const struct heat_scale *scale, size_t j, int level) {
    const double *row = cells->values + j * cells->nx;
    double top = edge_y(pen, cells, (double)j + 1), bottom = edge_y(pen, cells, (double)j);
    for (size_t i = 0; i < cells->nx; i++) {
        size_t first = i;
        while (i < cells->nx && level_of(scale, row[i]) == level)
            i++;
        if (i > first)
            fprintf(pen->file, "M%.1f %.1fH%.1fV%.1fH%.1fZ", edge_x(pen, cells, (double)first), top,
                    edge_x(pen, cells, (double)i), bottom, edge_x(pen, cells, (double)first));
    }
}

static bool has_level(const struct heat_cells *cells, const struct heat_scale *scale, int level) {
    for (size_t cell = 0; cell < cells->nx * cells->ny; cell++)
        if (level_of(scale, cells->values[cell]) == level)
            return true;
    return false;
}

void heat_draw(const struct plot_pen *pen, const struct heat_cells *cells,
               const struct heat_scale *scale) {
    for (size_t level = 0; level < scale->count; level++) {
        char colour[HEAT_COLOUR_SIZE];
        if (!has_level(cells, scale, (int)level))
            continue;
        colour_of(scale, level, colour);
        fprintf(pen->file, "<path class=\"heat\" fill=\"%s\" shape-rendering=\"crispEdges\" d=\"",
                colour);
        for (size_t j = 0; j < cells->ny; j++)
            draw_row(pen, cells, scale, j, (int)level);
        fputs("\"/>\n", pen->file);
    }
}

/* --- contours --- */

/* Four centres of cells, in turn, and the values there. */
struct square {
    double x[4], y[4], value[4];
};

/* Returns how many sides of the square a level cuts, and where. */
static size_t cut_sides(const struct square *square, double level, double x[4], double y[4]) {
    size_t cuts = 0;
    for (size_t a = 0; a < 4; a++) {
        size_t b = (a + 1) % 4;
        double from = square->value[a], to = square->value[b];
        if ((from >= level) == (to >= level) || !isfinite(from) || !isfinite(to))
            continue;
        double part = (level - from) / (to - from);
        x[cuts] = square->x[a] + part * (square->x[b] - square->x[a]);
        y[cuts++] = square->y[a] + part * (square->y[b] - square->y[a]);
    }
    return cuts;
}

static void draw_square(const struct plot_pen *pen, const struct heat_cells *cells, size_t i,
                        size_t j, double level) {
    static const size_t CORNERS[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    struct square square;
    double x[4], y[4];
    for (size_t a = 0; a < 4; a++) {
        size_t column = i + CORNERS[a][0], row = j + CORNERS[a][1];
        square.x[a] = edge_x(pen, cells, (double)column + 0.5);
        square.y[a] = edge_y(pen, cells, (double)row + 0.5);
        square.value[a] = cells->values[row * cells->nx + column];
    }
    size_t cuts = cut_sides(&square, level, x, y);
    for (size_t a = 0; a + 1 < cuts; a += 2)
        fprintf(pen->file, "M%.1f %.1fL%.1f %.1f", x[a], y[a], x[a + 1], y[a + 1]);
}

void heat_contours(const struct plot_pen *pen, const struct heat_cells *cells,
                   const struct heat_scale *scale, const char *style) {
    fprintf(pen->file, "<path %s d=\"", style);
    for (size_t level = 0; level < scale->count; level++)
        for (size_t j = 0; j + 1 < cells->ny; j++)
            for (size_t i = 0; i + 1 < cells->nx; i++)
                draw_square(pen, cells, i, j, scale->bounds[level]);
    fputs("\"/>\n", pen->file);
}

/* --- the legend --- */

void heat_level(const struct heat_scale *scale, size_t level, char style[HEAT_STYLE_SIZE],
                char label[HEAT_LABEL_SIZE]) {
    char colour[HEAT_COLOUR_SIZE];
    colour_of(scale, level, colour);
    snprintf(style, HEAT_STYLE_SIZE, "stroke=\"%s\" stroke-width=\"12\"", colour);
    double low = scale->bounds[level], high = scale->bounds[level + 1];
    snprintf(label, HEAT_LABEL_SIZE, "%s%.*g to %s%.*g", low < 0 ? "−" : "",
             number_digits(low, high - low), fabs(low), high < 0 ? "−" : "",
             number_digits(high, high - low), fabs(high));
}

void heat_legend(struct plot_pen *pen, const struct heat_scale *scale, const char *heading) {
    pen_note(pen, heading);
    for (size_t level = scale->count; level > 0; level--) {
        char style[HEAT_STYLE_SIZE], label[HEAT_LABEL_SIZE];
        heat_level(scale, level - 1, style, label);
        pen_legend(pen, label, style);
    }
}
