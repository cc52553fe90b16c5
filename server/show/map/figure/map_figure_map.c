/* The map itself on the page: its heights in colours with their scale, a bar for its lengths; of a
 * profile its trace. */
#include "server/show/map/figure/map_figure.h"
#include "server/show/map/figure/map_figure_internal.h"
#include "server/show/plot/plot_heat.h"
#include "server/show/plot/plot_map.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    TOP = 112,
    SIDE = 330,       /* of the square that the map fills at least one side of */
    CELLS_MOST = 192, /* a side: the picture stays below half a megabyte */
    COLOURS = 24,
    BAR_GAP = 12,
    BAR_WIDTH = 14,
    GROUPS_MOST = 600,
    PROFILE_WIDTH = 292,
    PROFILE_HEIGHT = 290
};
static const double TAIL = 0.002; /* of the heights at either end have the colour of the end */

struct cells {
    size_t nx, ny;
    double *values;         /* owned: nx * ny, x fastest, y upwards; NaN: a hole */
    double low, high;       /* of the colours */
    bool clipped;           /* some heights are beyond */
    double left, top, side; /* on the page; side: of a cell along x */
    double side_y;
};

static int ascending(const void *a, const void *b) {
    double one = *(const double *)a, other = *(const double *)b;
    return (one > other) - (one < other);
}

/* Single spikes must not take all colours. */
static int find_range(struct cells *cells, struct error *err) {
    size_t points = cells->nx * cells->ny, count = 0;
    double *sorted = array_create(points, sizeof *sorted);
    if (sorted == NULL)
        return error_memory(err, points * sizeof *sorted, "the colours of a map");
    for (size_t n = 0; n < points; n++)
        if (isfinite(cells->values[n]))
            sorted[count++] = cells->values[n];
    qsort(sorted, count, sizeof *sorted, ascending);
    size_t tail = (size_t)(TAIL * (double)count);
    cells->low = count > 0 ? sorted[tail] : 0;
    cells->high = count > 0 ? sorted[count - 1 - tail] : 0;
    cells->clipped = count > 0 && (sorted[0] < cells->low || sorted[count - 1] > cells->high);
    if (range_is_single(cells->low, cells->high)) {
        double middle = cells->low, step = fabs(middle) >= RANGE_LEAST ? 1e-3 * fabs(middle) : 1;
        cells->low = middle - step;
        cells->high = middle + step;
    }
    free(sorted);
    return 0;
}

static int colour_of(const struct cells *cells, double value) {
    if (isnan(value))
        return -1;
    double place = (value - cells->low) / (cells->high - cells->low);
    return (int)fmin(COLOURS - 1, fmax(0, floor(place * COLOURS)));
}

/* Cells are units of the drawing here, which is scaled as a whole: a run is a few letters. */
static void draw_colour(FILE *file, const struct cells *cells, int colour) {
    char fill[HEAT_COLOUR_SIZE];
    bool begun = false;
    heat_colour(HEAT_HEIGHT, colour / (COLOURS - 1.0), fill);
    for (size_t j = 0; j < cells->ny; j++)
        for (size_t i = 0; i < cells->nx; i++) {
            const double *row = cells->values + j * cells->nx;
            size_t first = i;
            while (i < cells->nx && colour_of(cells, row[i]) == colour)
                i++;
            if (i == first)
                continue;
            if (!begun)
                fprintf(file, "<path class=\"map\" fill=\"%s\" d=\"", fill);
            begun = true;
            fprintf(file, "M%zu %zuh%zuv1h-%zuz", first, cells->ny - 1 - j, i - first, i - first);
        }
    if (begun)
        fputs("\"/>\n", file);
}

static void draw_cells(FILE *file, const struct cells *cells) {
    double width = cells->side * (double)cells->nx, height = cells->side_y * (double)cells->ny;
    fprintf(file,
            "<rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\" fill=\"url(#hole)\"/>\n"
            "<g transform=\"translate(%.1f %.1f) scale(%.6g %.6g)\" "
            "shape-rendering=\"crispEdges\">\n",
            cells->left, cells->top, width, height, cells->left, cells->top, cells->side,
            cells->side_y);
    for (int colour = 0; colour < COLOURS; colour++)
        draw_colour(file, cells, colour);
    fprintf(file,
            "</g>\n<rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\" class=\"frame\"/>\n",
            cells->left, cells->top, width, height);
}

/* The colours beside the map, with round heights. */
static void draw_scale(const struct figure_page *page, const struct cells *cells) {
    FILE *file = page->pen.file;
    double unit = page->units.z, low = cells->low / unit, high = cells->high / unit;
    double height = fmax(120, cells->side_y * (double)cells->ny);
    double left = cells->left + cells->side * (double)cells->nx + BAR_GAP, top = cells->top;
    char fill[HEAT_COLOUR_SIZE], label[PLOT_LABEL_SIZE];
    for (int colour = 0; colour < COLOURS; colour++) {
        heat_colour(HEAT_HEIGHT, colour / (COLOURS - 1.0), fill);
        fprintf(file,
                "<rect x=\"%.1f\" y=\"%.2f\" width=\"%d\" height=\"%.2f\" fill=\"%s\" "
                "shape-rendering=\"crispEdges\"/>\n",
                left, top + height * (COLOURS - 1 - colour) / COLOURS, BAR_WIDTH,
                height / COLOURS + 0.5, fill);
    }
    fprintf(file, "<rect x=\"%.1f\" y=\"%.1f\" width=\"%d\" height=\"%.1f\" class=\"frame\"/>\n",
            left, top, BAR_WIDTH, height);
    double step = round_step(high - low, height > 200 ? 6 : 3);
    /* Counted: where heights differ by their last digits alone, one more changes no multiple. */
    const double first = ceil(low / step - 1e-9), count = floor(high / step + 1e-9) - first;
    for (int mark = 0; mark <= count; mark++) {
        double n = first + mark;
        double y = top + height * (high - n * step) / (high - low);
        double value = fabs(n) < 0.5 ? 0 : n * step;
        fprintf(file,
                "<path d=\"M%.1f %.1fh4\" stroke=\"#444\"/><text x=\"%.1f\" y=\"%.1f\" "
                "class=\"small\">%.4g</text>\n",
                left + BAR_WIDTH, y, left + BAR_WIDTH + 7, y + 4, value);
    }
    figure_axis_label(&page->units, "z", 0, 1, label);
    fprintf(file, "<text x=\"%.1f\" y=\"%.1f\" class=\"small\">", left, top - 6);
    svg_label(file, label);
    fputs("</text>\n", file);
}

/* A length of 1, 2 or 5 times a power of ten, about a quarter of the side; below it what is not
 * seen as it is. */
static void draw_length(const struct figure_page *page, const struct cells *cells) {
    const struct grid *grid = &page->figure->map->grid;
    FILE *file = page->pen.file;
    double lx = grid->lx / page->units.x, ly = grid->ly / page->units.x;
    double length = round_step(lx, 4), width = cells->side * (double)cells->nx;
    double y = cells->top + cells->side_y * (double)cells->ny + 16;
    const char *unit = page->units.x_name;
    fprintf(file,
            "<path d=\"M%.1f %.1fh%.1f\" stroke=\"#222\" stroke-width=\"4\"/><text x=\"%.1f\" "
            "y=\"%.1f\">%.4g%s%s</text>\n",
            cells->left, y, width * length / lx, cells->left + width * length / lx + 8, y + 4,
            length, unit[0] != '\0' ? " " : "", unit);
    if (width > 250)
        fprintf(file, "<text x=\"%.1f\" y=\"%.1f\" class=\"end note\">%.4g × %.4g%s%s</text>\n",
                cells->left + width, y + 4, lx, ly, unit[0] != '\0' ? " " : "", unit);
    bool holes = named_number(page->figure->found, "map", "holes") > 0;
    fprintf(file, "<text x=\"%.1f\" y=\"%.1f\" class=\"note\">", cells->left, y + 22);
    if (cells->clipped)
        fprintf(file, "%g %% beyond each end of the colours%s", 100 * TAIL, holes ? "; " : "");
    fprintf(file, "%s</text>\n", holes ? "hatched: not measured" : "");
    char text[PLOT_LABEL_SIZE];
    const double height = cells->side_y * (double)cells->ny;
    if (frame_stretch_text(height / width * (grid->lx / grid->ly), text, sizeof text))
        fprintf(file, "<text x=\"%.1f\" y=\"%.1f\" class=\"note\">%s</text>\n", cells->left, y + 36,
                text);
}

static int draw_surface(struct figure_page *page, struct error *err) {
    const struct grid *grid = &page->figure->map->grid;
    size_t longer = grid->nx > grid->ny ? grid->nx : grid->ny;
    size_t step = (longer + CELLS_MOST - 1) / CELLS_MOST;
    double longest = fmax(grid->lx, grid->ly);
    struct cells cells = {.nx = (grid->nx + step - 1) / step, .ny = (grid->ny + step - 1) / step};
    cells.values = array_create(cells.nx * cells.ny, sizeof *cells.values);
    if (cells.values == NULL)
        return error_memory(err, cells.nx * cells.ny * sizeof *cells.values, "a picture");
    map_join_points(&page->map, step, cells.values);
    cells.left = PAGE_LEFT;
    cells.top = TOP;
    cells.side = fmax(20, SIDE * grid->lx / longest) / (double)cells.nx;
    cells.side_y = fmax(20, SIDE * grid->ly / longest) / (double)cells.ny;
    int status = find_range(&cells, err);
    if (status == 0) {
        draw_cells(page->pen.file, &cells);
        draw_scale(page, &cells);
        draw_length(page, &cells);
    }
    free(cells.values);
    return status;
}

static int draw_profile(struct figure_page *page, struct error *err) {
    struct frame *frame = &page->pen.frame;
    char x_label[PLOT_LABEL_SIZE], z_label[PLOT_LABEL_SIZE];
    enum { ROOM = 2 * GROUPS_MOST + 1 };
    double *x = array_create(2 * (size_t)ROOM, sizeof *x);
    if (x == NULL)
        return error_memory(err, 2 * ROOM * sizeof *x, "a trace");
    double *z = x + ROOM;
    size_t count = map_trace(&page->map, GROUPS_MOST, x, z);
    frame_start(frame, false, false);
    for (size_t n = 0; n < count; n++) {
        x[n] /= page->units.x;
        z[n] /= page->units.z;
        frame_include_point(frame, x[n], z[n]);
    }
    if (frame_finish(frame)) {
        frame->left = PAGE_LEFT + 60;
        frame->right = PAGE_LEFT + 60 + PROFILE_WIDTH;
        frame->top = TOP;
        frame->bottom = TOP + PROFILE_HEIGHT;
        frame->scale = 0.9;
        figure_axis_label(&page->units, "x", 1, 0, x_label);
        figure_axis_label(&page->units, "z", 0, 1, z_label);
        frame_draw(page->pen.file, frame, x_label, z_label);
        pen_line(&page->pen, count, x, z, "class=\"curve\" stroke=\"#0b4f7d\"");
    }
    free(x);
    return 0;
}

int figure_draw_map(struct figure_page *page, struct error *err) {
    return grid_is_profile(&page->figure->map->grid) ? draw_profile(page, err)
                                                     : draw_surface(page, err);
}
