#include "server/show/plot/plot_map.h"
#include "core/file/memory_file.h"
#include "jobs/maps/map_parameters.h"
#include "server/show/plot/plot_heat.h"
#include "server/show/quantity.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MARKS_MOST = 1000, GROUPS_MOST = 1000 };
/* A cell takes up to 35 bytes of the file. Of two classes most lie in runs of one. */
enum { CELLS_MOST = 1 << 15, CELLS_OF_CLASSES_MOST = 1 << 17 };
enum { BELOW = 70, TRACE_HEIGHT = 150, TRACE_WIDTH_LEAST = 200 };

struct map_plot {
    const struct map_picture *picture;
    struct plot_pen pen;
    struct summit_list summits; /* the highest first */
    int bottom;                 /* of the lowest frame */
};

/* --- summits --- */

static int higher(const void *a, const void *b) {
    double one = ((const struct summit *)a)->height, other = ((const struct summit *)b)->height;
    return (one < other) - (one > other);
}

static int find_summits(struct map_plot *plot, struct error *err) {
    const struct map_picture *picture = plot->picture;
    const struct measured_map map = {picture->grid, picture->z, picture->boundary};
    double searched;
    int status = map_summits_find(&map, SUMMITS_NINE_POINT, map.grid->nx / 2, map.grid->ny / 2,
                                  &plot->summits, &searched, err);
    if (plot->summits.count > 0)
        qsort(plot->summits.summits, plot->summits.count, sizeof *plot->summits.summits, higher);
    return status;
}

/* Marks are smaller where they are many. */
static void draw_summits(struct map_plot *plot) {
    bool profile = grid_is_profile(plot->picture->grid);
    size_t all = plot->summits.count, count = all < MARKS_MOST ? all : MARKS_MOST;
    double radius = count < 150 ? 3.2 : count < 500 ? 2.4 : 1.6;
    const char *fill = profile ? "#d55e00" : "#fff";
    char text[PLOT_LABEL_SIZE];
    for (size_t n = 0; n < count; n++) {
        const struct summit *summit = &plot->summits.summits[n];
        fprintf(plot->pen.file,
                "<circle class=\"summit\" cx=\"%.1f\" cy=\"%.1f\" r=\"%.1f\" fill=\"%s\" "
                "stroke=\"#222\" stroke-width=\".8\"/>\n",
                frame_x(&plot->pen.frame, plot->picture->x0 + summit->x),
                frame_y(&plot->pen.frame, profile ? summit->height : plot->picture->y0 + summit->y),
                radius, fill);
    }
    if (count < all)
        snprintf(text, sizeof text, "circles: the %zu highest of %zu summits", count, all);
    else
        snprintf(text, sizeof text, "circles: %zu %s", all, profile ? "peaks" : "summits");
    pen_note(&plot->pen, text);
}

static void range_of(size_t count, const double *z, double range[2]) {
    range[0] = INFINITY;
    range[1] = -INFINITY;
    for (size_t n = 0; n < count; n++) {
        range[0] = fmin(range[0], z[n]);
        range[1] = fmax(range[1], z[n]);
    }
    (void)range_widen(&range[0], &range[1]);
}

/* --- a profile --- */

size_t map_trace(const struct measured_map *map, size_t groups, double *x, double *y) {
    size_t nx = map->grid->nx, step = (nx + groups - 1) / groups, count = 0;
    double dx = grid_dx(map->grid);
    for (size_t first = 0; first < nx; first += step) {
        size_t low = first, high = first;
        for (size_t i = first; i < nx && i < first + step; i++) {
            low = map->z[i] < map->z[low] || isnan(map->z[low]) ? i : low;
            high = map->z[i] > map->z[high] || isnan(map->z[high]) ? i : high;
        }
        const size_t ends[2] = {low < high ? low : high, low < high ? high : low};
        for (size_t e = ends[0] == ends[1]; e < 2; e++) {
            x[count] = (double)ends[e] * dx;
            y[count++] = map->z[ends[e]];
        }
    }
    if (map->boundary == BOUNDARY_PERIODIC) {
        x[count] = map->grid->lx; /* where the profile begins anew */
        y[count++] = map->z[0];
    }
    return count;
}

/* Draws the trace of a line of heights, whose first point is at x0, in the frame of the pen. */
static int draw_trace(const struct plot_pen *pen, const struct measured_map *line, double x0,
                      struct error *err) {
    static const char STYLE[] = "class=\"curve\" stroke=\"#0072b2\" stroke-width=\"1.2\"";
    double *points = array_create(4 * GROUPS_MOST + 2, sizeof *points);
    if (points == NULL)
        return error_memory(err, (4 * GROUPS_MOST + 2) * sizeof *points, "a trace");
    double *heights = points + 2 * GROUPS_MOST + 1;
    size_t count = map_trace(line, GROUPS_MOST, points, heights);
    for (size_t n = 0; n < count; n++)
        points[n] += x0;
    pen_line(pen, count, points, heights, STYLE);
    free(points);
    return 0;
}

static int draw_profile(struct map_plot *plot, struct error *err) {
    const struct map_picture *picture = plot->picture;
    struct plot_pen *pen = &plot->pen;
    const struct measured_map map = {picture->grid, picture->z, picture->boundary};
    double range[2];
    range_of(picture->grid->nx, picture->z, range);
    double margin = 0.06 * (range[1] - range[0]);
    (void)frame_set(&pen->frame, (const double[]){picture->x0, picture->x0 + picture->grid->lx},
                    (const double[]){range[0] - margin, range[1] + margin}, false);
    plot->bottom = pen->frame.bottom;
    frame_draw(pen->file, &pen->frame, picture->x_label, picture->z_label);
    return draw_trace(pen, &map, picture->x0, err);
}

/* --- a surface --- */

void map_join_points(const struct measured_map *map, size_t step, double *out) {
    const struct grid *grid = map->grid;
    for (size_t row = 0; row < grid->ny; row += step)
        for (size_t column = 0; column < grid->nx; column += step) {
            struct average mean = {0};
            for (size_t j = row; j < grid->ny && j < row + step; j++)
                for (size_t i = column; i < grid->nx && i < column + step; i++)
                    average_add(&mean, map->z[j * grid->nx + i]);
            *out++ = average_value(&mean);
        }
}

static bool has_trace(const struct map_picture *picture) {
    return picture->trace > 0 && !grid_is_profile(picture->grid);
}

/* Marks a row across the surface, and draws it below, over the same x. */
static int draw_row(struct map_plot *plot, struct error *err) {
    const struct map_picture *picture = plot->picture;
    const struct grid *grid = picture->grid;
    struct plot_pen below = plot->pen;
    double range[2];
    size_t row = (size_t)fmod(rint(picture->trace / grid_dy(grid)), (double)grid->ny);
    double y = frame_y(&plot->pen.frame, picture->y0 + (double)row * grid_dy(grid));
    const struct grid line = {.nx = grid->nx, .ny = 1, .lx = grid->lx, .ly = 1};
    const struct measured_map map = {&line, picture->z + row * grid->nx, picture->boundary};
    fprintf(below.file,
            "<path class=\"cut\" d=\"M%d %.2fH%d\" stroke=\"#d55e00\" stroke-width=\"1.5\"/>\n",
            below.frame.left, y, below.frame.right);
    below.frame.top = below.frame.bottom + BELOW;
    plot->bottom = below.frame.bottom = below.frame.top + TRACE_HEIGHT;
    if (below.frame.right < below.frame.left + TRACE_WIDTH_LEAST)
        below.frame.right = below.frame.left + TRACE_WIDTH_LEAST;
    range_of(grid->nx, map.z, range);
    double margin = 0.06 * (range[1] - range[0]);
    below.frame.y = (struct plot_axis){.low = range[0] - margin, .high = range[1] + margin};
    frame_draw(below.file, &below.frame, picture->x_label, picture->z_label);
    return draw_trace(&below, &map, picture->x0, err);
}

static size_t cells_along(size_t points, size_t step) {
    return (points + step - 1) / step;
}

/* Returns the side of the squares of points that are joined: the least whose cells are neither
 * smaller than pixels nor too many for a file. */
static size_t step_of(const struct map_picture *picture, const struct frame *frame) {
    const struct grid *grid = picture->grid;
    const size_t most = picture->classes[0] != NULL ? CELLS_OF_CLASSES_MOST : CELLS_MOST;
    const size_t width = (size_t)(frame->right - frame->left);
    const size_t height = (size_t)(frame->bottom - frame->top);
    size_t step = 1;
    while (cells_along(grid->nx, step) > width || cells_along(grid->ny, step) > height ||
           cells_along(grid->nx, step) * cells_along(grid->ny, step) > most)
        step++;
    return step;
}

static struct heat_scale scale_of(const struct map_picture *picture) {
    double range[2];
    if (picture->classes[0] != NULL) /* a cell of several points belongs to most of them */
        return (struct heat_scale){.count = 2, .bounds = {0, 0.5, 1.5}, .ramp = HEAT_DENSITY};
    range_of(grid_points(picture->grid), picture->z, range);
    return heat_scale_between(range[0], range[1], 10, HEAT_HEIGHT);
}

/* Names the colours, and says what of the map is not seen as it is. */
static void name_surface(struct map_plot *plot, const struct heat_scale *scale, size_t step,
                         double stretched) {
    const struct map_picture *picture = plot->picture;
    const struct grid *grid = picture->grid;
    char text[PLOT_LABEL_SIZE], style[HEAT_STYLE_SIZE], range[HEAT_LABEL_SIZE];
    if (picture->classes[0] == NULL)
        heat_legend(&plot->pen, scale, picture->z_label);
    for (size_t level = 2; level-- > 0 && picture->classes[0] != NULL;) {
        heat_level(scale, level, style, range);
        pen_legend(&plot->pen, picture->classes[level], style);
    }
    if (step > 1) {
        snprintf(text, sizeof text, "%s of %zu × %zu points",
                 picture->classes[0] != NULL ? "majorities" : "means",
                 step < grid->nx ? step : grid->nx, step < grid->ny ? step : grid->ny);
        pen_note(&plot->pen, text);
    }
    if (frame_stretch_text(stretched, text, sizeof text))
        pen_note(&plot->pen, text);
}

static int draw_surface(struct map_plot *plot, struct error *err) {
    const struct map_picture *picture = plot->picture;
    const struct grid *grid = picture->grid;
    struct plot_pen *pen = &plot->pen;
    double dx = grid_dx(grid), dy = grid_dy(grid);
    const double left = picture->x0 - dx / 2, low = picture->y0 - dy / 2;
    /* A point lies in the middle of its square. */
    double stretched = frame_set(&pen->frame, (const double[]){left, left + grid->lx},
                                 (const double[]){low, low + grid->ly}, true);
    size_t step = step_of(picture, &pen->frame);
    struct heat_cells cells = {.nx = cells_along(grid->nx, step),
                               .ny = cells_along(grid->ny, step)};
    double *values = array_create(cells.nx * cells.ny, sizeof *values);
    if (values == NULL)
        return error_memory(err, cells.nx * cells.ny * sizeof *values, "a picture");
    const struct measured_map map = {grid, picture->z, picture->boundary};
    map_join_points(&map, step, values);
    cells.values = values;
    cells.x[0] = left;
    cells.x[1] = left + (double)(cells.nx * step) * dx;
    cells.y[0] = low;
    cells.y[1] = low + (double)(cells.ny * step) * dy;
    pen->frame.x.high = cells.x[1]; /* the last squares may have fewer points */
    pen->frame.y.high = cells.y[1];
    plot->bottom = pen->frame.bottom;
    const struct heat_scale scale = scale_of(picture);
    frame_draw(pen->file, &pen->frame, has_trace(picture) ? NULL : picture->x_label,
               picture->y_label);
    heat_draw(pen, &cells, &scale);
    name_surface(plot, &scale, step, stretched);
    free(values);
    return has_trace(picture) ? draw_row(plot, err) : 0;
}

/* Draws all but the head, whose size depends on it. */
static int draw_body(struct map_plot *plot, struct error *err) {
    const struct map_picture *picture = plot->picture;
    int status = picture->unmarked ? 0 : find_summits(plot, err);
    if (status == 0) {
        pen_title(&plot->pen, picture->name, picture->subject);
        status = grid_is_profile(picture->grid) ? draw_profile(plot, err) : draw_surface(plot, err);
    }
    if (status == 0) {
        if (!picture->unmarked)
            draw_summits(plot);
        if (picture->note != NULL)
            pen_note(&plot->pen, picture->note);
        fputs("</svg>\n", plot->pen.file);
    }
    summit_list_clear(&plot->summits);
    return status;
}

/* Draws a picture whose values and labels are those that are drawn. */
static int draw_as_it_is(const struct map_picture *picture, FILE *file, struct error *err) {
    struct map_plot plot = {.picture = picture};
    struct memory_file memory;
    size_t size = 0;
    if (!memory_file_open(&memory))
        return error_memory(err, 0, "a picture");
    plot.pen.file = memory.file;
    int status = draw_body(&plot, err);
    char *body = memory_file_close(&memory, &size);
    if (status == 0 && body == NULL)
        status = error_memory(err, 0, "a picture");
    if (status == 0) {
        int legend = pen_row(plot.pen.rows), frames = plot.bottom + BELOW;
        plot.pen.file = file;
        pen_head_sized(&plot.pen,
                       &(struct pen_size){PEN_WIDTH, legend > frames ? legend : frames, 13, 0});
        (void)fwrite(body, 1, size, file); /* the file remembers a failure */
    }
    free(body);
    return status;
}

/* --- units --- */

/* Writes the unit in which values up to `most` of an SI unit are best read; returns what it stands
 * for. Other units stay as they are. */
static double readable(const char *unit, double most, char *out, size_t size) {
    static const double HUNDREDTHS = 100; /* of areas: 0.9 nm^2 rather than 900 000 pm^2 */
    char inverse[24];
    if (strcmp(unit, "m") == 0 || strcmp(unit, "Pa") == 0)
        return unit_readable(unit, most, out, size);
    if (strcmp(unit, "m^2") == 0)
        return unit_readable(unit, HUNDREDTHS * most, out, size);
    if (strcmp(unit, "rad/m") != 0) {
        snprintf(out, size, "%s", unit);
        return 1;
    }
    double scale = unit_readable("1/m", most, inverse, sizeof inverse);
    snprintf(out, size, "rad%s", inverse + 1); /* "/um" */
    return scale;
}

/* Writes "x (nm)", for values up to `most` in that unit. Returns what is drawn as one. */
static double label_with_unit(const char *label, const char *unit, double most,
                              char out[PLOT_LABEL_SIZE]) {
    char name[32] = "";
    double scale = unit != NULL ? readable(unit, most, name, sizeof name) : 1;
    snprintf(out, PLOT_LABEL_SIZE, *name != '\0' ? "%.100s (%s)" : "%.100s", label, name);
    return scale;
}

int plot_map(const struct map_picture *picture, FILE *file, struct error *err) {
    char x_label[PLOT_LABEL_SIZE], y_label[PLOT_LABEL_SIZE], z_label[PLOT_LABEL_SIZE];
    size_t points = grid_points(picture->grid);
    double range[2], longer = picture->grid->lx;
    struct map_picture own = *picture;
    struct grid grid = *picture->grid;
    range_of(points, picture->z, range);
    if (!grid_is_profile(picture->grid))
        longer = fmax(longer, picture->grid->ly);
    double xy = label_with_unit(picture->x_label, picture->xy_unit, longer, x_label);
    (void)label_with_unit(picture->y_label, picture->xy_unit, longer, y_label);
    double z = label_with_unit(picture->z_label, picture->z_unit,
                               fmax(fabs(range[0]), fabs(range[1])), z_label);
    double *values = array_create(points, sizeof *values);
    if (values == NULL)
        return error_memory(err, points * sizeof *values, "a picture");
    for (size_t n = 0; n < points; n++)
        values[n] = picture->z[n] / z;
    grid.lx /= xy;
    grid.ly /= xy;
    own.grid = &grid;
    own.z = values;
    own.x0 = picture->x0 / xy;
    own.y0 = picture->y0 / xy;
    own.trace = picture->trace / xy;
    own.x_label = x_label;
    own.y_label = y_label;
    own.z_label = z_label;
    int status = draw_as_it_is(&own, file, err);
    free(values);
    return status;
}
