#include "core/map/preparation/preparation.h"
#include "core/error.h"
#include "core/file/plain_text.h"
#include "core/map/height_map.h"
#include "core/map/length_unit.h"
#include "core/map/preparation/denoise.h"
#include "core/map/preparation/despike.h"
#include "core/map/preparation/extend.h"
#include "core/map/preparation/gaussian_filter.h"
#include "core/map/preparation/map_resample.h"
#include "core/map/preparation/map_turn.h"
#include "core/map/preparation/membrane.h"
#include "core/map/preparation/scan_lines.h"
#include "core/map/preparation/tip.h"
#include "core/statistics/grooves/groove_extension.h"
#include "core/statistics/grooves/map_grooves.h"
#include "core/sum.h"
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double PI = 3.14159265358979323846;
static const double TUKEY_SIDE = 0.1; /* share of the length that falls, at each end */

/* Returns the window at point i of n. */
static double weight_at(size_t i, size_t n, enum map_window window) {
    const double position = ((double)i + 0.5) / (double)n, side = fmin(position, 1 - position);
    const double width = window == MAP_WINDOW_HANN ? 0.5 : TUKEY_SIDE;
    if (n == 1 || window == MAP_WINDOW_NONE || side >= width)
        return 1;
    const double root = sin(PI / 2 * side / width);
    return root * root;
}

double map_taper(const struct grid *grid, double *z, enum map_window window) {
    struct sum heights = {0}, weights = {0}, squares = {0};
    for (size_t j = 0; j < grid->ny; j++) {
        const double row = weight_at(j, grid->ny, window);
        for (size_t i = 0; i < grid->nx; i++) {
            const double weight = row * weight_at(i, grid->nx, window);
            sum_add(&heights, weight * z[j * grid->nx + i]);
            sum_add(&weights, weight);
            sum_add(&squares, weight * weight);
        }
    }
    const double mean = sum_value(&heights) / sum_value(&weights);
    for (size_t j = 0; j < grid->ny; j++) {
        const double row = weight_at(j, grid->ny, window);
        for (size_t i = 0; i < grid->nx; i++)
            z[j * grid->nx + i] =
                row * weight_at(i, grid->nx, window) * (z[j * grid->nx + i] - mean);
    }
    return sum_value(&squares) / (double)grid_points(grid);
}

/* A part of a map. */

/* Keeps the points of columns x to x + width - 1 and rows y to y + height - 1, with their heights
 * bit for bit and their spacing. ERROR_INPUT, the map untouched, where they are not all in the map
 * or fewer than 2 by 1. */
static int map_crop(struct height_map *map, size_t x, size_t y, size_t width, size_t height,
                    struct error *err) {
    struct grid *grid = &map->grid;
    if (width < 2 || height < 1 || width > grid->nx || x > grid->nx - width || height > grid->ny ||
        y > grid->ny - height)
        return error_set(
            err, ERROR_INPUT,
            "columns from %zu and rows from %zu, %zu by %zu points, of a map of %zu by "
            "%zu; allowed: at least 2 by 1, within the map",
            x, y, width, height, grid->nx, grid->ny);
    double dx = grid_dx(grid), dy = grid_dy(grid);
    for (size_t j = 0; j < height; j++)
        memmove(map->z + j * width, map->z + (y + j) * grid->nx + x, width * sizeof *map->z);
    double *less = realloc(map->z, width * height * sizeof *map->z);
    map->z = less != NULL ? less : map->z;
    *grid = (struct grid){width, height, dx * (double)width, dy * (double)height};
    return 0;
}

void preparation_note(struct preparation_record *record, const char *name, const char *format,
                      ...) {
    if (record->count == PREPARATION_STEPS_MOST)
        return;
    struct preparation_step *step = &record->steps[record->count++];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(step->text, sizeof step->text, format, arguments);
    va_end(arguments);
    text_make_plain(step->text);
    step->name = name;
}

int height_map_check_units(const struct height_map *map, struct error *err) {
    if (strcmp(map->xy_unit, map->z_unit) == 0)
        return 0;
    if (length_unit_is_metre(map->xy_unit))
        return error_set(
            err, ERROR_INPUT,
            "x and y are lengths and heights are %s%s, so that slopes have no meaning; "
            "--z-unit nm (or another; z_unit in studies and requests) says what they "
            "are in",
            *map->z_unit != '\0' ? "in " : "without a unit", map->z_unit);
    if (*map->xy_unit == '\0')
        return error_set(err, ERROR_INPUT,
                         "heights are in %s and x and y have no unit, so that slopes have no "
                         "meaning; --unit um, --dx 0.4um (or others) say what x and y are in",
                         map->z_unit);
    return error_set(err, ERROR_INPUT,
                     "the unit of heights is '%s' and that of x and y '%s', so that slopes have no "
                     "meaning; --unit um (or another) and --z-unit say what they are",
                     map->z_unit, map->xy_unit);
}

/* Returns a length as messages print it, "2.5 \xc2\xb5m" of a map in metres. */
static const char *preparation_length_text(const struct height_map *map, double length,
                                           char text[40]) {
    double one = 1;
    const char *unit = length_unit_is_metre(map->xy_unit) ? length_unit_readable(length, &one) : "";
    snprintf(text, 40, "%.6g%s%s", length / one, *unit != '\0' ? " " : "", unit);
    return text;
}

/* Sets *out to a requested length, in the map's unit; ERROR_INPUT names the option. */
static int preparation_length(double *out, const struct height_map *map,
                              const struct asked_length *asked, const char *option,
                              struct error *err) {
    if (asked->has_unit && !length_unit_is_metre(map->xy_unit))
        return error_set(err, ERROR_INPUT,
                         "%s has a unit, %g m, and the map's lengths have none: --unit um (or "
                         "another) says it, or a plain number is in the unit of the map",
                         option, asked->value);
    if (!asked->has_unit && length_unit_is_metre(map->xy_unit))
        return error_set(err, ERROR_INPUT,
                         "%s %g needs a unit, such as %gum, since the map's lengths have one",
                         option, asked->value, asked->value);
    *out = asked->value;
    return 0;
}

static int set_spacing(struct height_map *map, const struct preparation *asked, struct error *err) {
    struct grid *grid = &map->grid;
    double dx = asked->dx.value, ratio = grid_dy(grid) / grid_dx(grid);
    double dy = asked->dy.value > 0 ? asked->dy.value : dx * ratio;
    if (asked->dx.has_unit && asked->unit > 0)
        return error_set(err, ERROR_INPUT, "--dx has a unit, so that --unit has nothing to say");
    if (!asked->dx.has_unit && length_unit_is_metre(map->xy_unit) && !(asked->unit > 0))
        return error_set(err, ERROR_INPUT,
                         "--dx %g needs a unit, such as %gum, since the file's lengths have one",
                         dx, dx);
    double one = asked->unit > 0 ? asked->unit : 1;
    grid->lx = dx * one * (double)grid->nx;
    grid->ly = dy * one * (double)grid->ny;
    if (asked->dx.has_unit || asked->unit > 0)
        strcpy(map->xy_unit, "m");
    return grid_check(grid, err);
}

static int preparation_units(struct preparation_record *record, struct height_map *map,
                             const struct preparation *asked, struct error *err) {
    char dx[40], dy[40];
    int status = 0;
    if (asked->dx.value > 0)
        status = set_spacing(map, asked, err);
    else if (asked->unit > 0 && length_unit_is_metre(map->xy_unit))
        return error_set(err, ERROR_INPUT,
                         "the file has lengths with their unit; --unit is for files that have "
                         "none, and for --dx");
    else if (asked->unit > 0) {
        map->grid.lx *= asked->unit;
        map->grid.ly *= asked->unit;
        strcpy(map->xy_unit, "m");
        status = grid_check(&map->grid, err);
    }
    if (status == 0 && (asked->dx.value > 0 || asked->unit > 0))
        preparation_note(record, "spacing", "%s by %s",
                         preparation_length_text(map, grid_dx(&map->grid), dx),
                         preparation_length_text(map, grid_dy(&map->grid), dy));
    if (status != 0 || asked->z_unit == 0)
        return status;
    if (length_unit_is_metre(map->z_unit))
        return error_set(err, ERROR_INPUT,
                         "the file has heights with their unit; --z-unit is for files that have "
                         "none");
    for (size_t i = 0; i < grid_points(&map->grid); i++)
        map->z[i] *= asked->z_unit;
    preparation_note(record, "z_unit", "1%s%s is %g m", *map->z_unit != '\0' ? " " : "",
                     map->z_unit, asked->z_unit);
    strcpy(map->z_unit, "m");
    return 0;
}

/* The requested points. */
struct points {
    double nx, ny; /* whole numbers, which may be too large */
    double dx, dy;
};

/* Returns the number of points `spacing` apart within n points `old` apart. */
static double count_within(size_t n, double old, double spacing) {
    return floor((double)(n - 1) * old / spacing * (1 + 1e-12) + 1e-9) + 1;
}

/* Points within the old ones; the spacing along y is that along x unless another is requested. */
static void points_of_open(struct points *out, const struct grid *grid, double spacing,
                           const struct preparation *asked) {
    const double dx = grid_dx(grid), dy = grid_dy(grid);
    out->dx = spacing > 0 ? spacing
                          : (double)(grid->nx - 1) * dx / fmax((double)asked->resample_x - 1, 1);
    out->nx = spacing > 0 ? count_within(grid->nx, dx, spacing) : (double)asked->resample_x;
    out->dy = asked->resample_y > 1 ? (double)(grid->ny - 1) * dy / (double)(asked->resample_y - 1)
                                    : out->dx;
    out->ny =
        asked->resample_y > 0 ? (double)asked->resample_y : count_within(grid->ny, dy, out->dy);
}

/* Points that divide the cell evenly. */
static void points_of_periodic(struct points *out, const struct grid *grid, double spacing,
                               const struct preparation *asked) {
    out->nx = spacing > 0 ? round(grid->lx / spacing) : (double)asked->resample_x;
    out->dx = grid->lx / out->nx;
    out->ny =
        asked->resample_y > 0 ? (double)asked->resample_y : fmax(round(grid->ly / out->dx), 1);
    out->dy = grid->ly / out->ny;
}

static int preparation_resample(struct preparation_record *record, struct height_map *map,
                                const struct preparation *asked, struct error *err) {
    const struct grid before = map->grid;
    const bool open = record->boundary == BOUNDARY_OPEN, profile = grid_is_profile(&before);
    struct points points = {0};
    double spacing = 0;
    char dx[40], dy[40];
    if (asked->resample_x == 0 && asked->resample_dx.value == 0)
        return 0;
    int status = height_map_check_whole(map, err);
    if (status != 0)
        return error_context(err, "--resample, before which --fill fills holes");
    if (asked->resample_dx.value > 0)
        status = preparation_length(&spacing, map, &asked->resample_dx, "--resample", err);
    if (status != 0)
        return status;
    if (open)
        points_of_open(&points, &before, spacing, asked);
    else
        points_of_periodic(&points, &before, spacing, asked);
    if (profile && asked->resample_y == 0)
        points.ny = 1;
    if (profile != (points.ny == 1))
        return error_set(err, ERROR_INPUT,
                         "--resample: %g rows of a map of %zu; a profile has 1, other maps more",
                         points.ny, before.ny);
    if (!(points.nx * points.ny <= 0x1p31))
        return error_set(err, ERROR_INPUT,
                         "--resample: %g by %g points; at most 2^31 in all can be made", points.nx,
                         points.ny);
    status = map_resample(map, record->boundary, (size_t)points.nx, (size_t)points.ny, points.dx,
                          points.dy, err);
    if (status != 0)
        return error_context(err, "--resample");
    preparation_note(record, "resample", "%zu by %zu points to %zu by %zu, %s by %s apart, %s",
                     before.nx, before.ny, map->grid.nx, map->grid.ny,
                     preparation_length_text(map, grid_dx(&map->grid), dx),
                     preparation_length_text(map, grid_dy(&map->grid), dy),
                     !open                          ? "by waves"
                     : points.dx > grid_dx(&before) ? "without waves that these cannot show"
                                                    : "by a cubic spline");
    return 0;
}

const char *preparation_text(const struct preparation_record *record, const char *name) {
    for (size_t n = 0; n < record->count; n++)
        if (strcmp(record->steps[n].name, name) == 0)
            return record->steps[n].text;
    return NULL;
}

static bool is_origin(const char *name) {
    static const char *const NAMES[] = {"file",   "bytes", "sha256", "unpacked",
                                        "format", "layer", "program"};
    for (size_t n = 0; n < sizeof NAMES / sizeof *NAMES; n++)
        if (strcmp(NAMES[n], name) == 0)
            return true;
    return false;
}

void preparation_steps_text(const struct preparation_record *record, char *out, size_t size) {
    size_t used = 0;
    *out = '\0';
    for (size_t n = 0; n < record->count && used < size; n++)
        if (!is_origin(record->steps[n].name))
            used += (size_t)snprintf(out + used, size - used, "%s%s: %s", used > 0 ? "; " : "",
                                     record->steps[n].name, record->steps[n].text);
    for (char *c = out; *c != '\0'; c++)
        *c = *c == '_' ? ' ' : *c;
}

/* --- crop --- */

static int crop(struct preparation_record *record, struct height_map *map,
                const struct preparation *asked, struct error *err) {
    const struct grid before = map->grid;
    const double spacing[2] = {grid_dx(&before), grid_dy(&before)};
    size_t points[4];
    if (asked->crop[2].value == 0)
        return 0;
    for (size_t c = 0; c < 4; c++) {
        const struct asked_length *length = &asked->crop[c];
        double count = length->value;
        if (length->has_unit) {
            int status = preparation_length(&count, map, length, "--crop", err);
            if (status != 0)
                return status;
            count = round(count / spacing[c % 2]);
        }
        points[c] = (size_t)(count < 1e15 ? count : 1e15);
    }
    int status = map_crop(map, points[0], points[1], points[2], points[3], err);
    if (status != 0)
        return error_context(err, "--crop");
    preparation_note(record, "crop", "columns %zu to %zu, rows %zu to %zu of %zu by %zu points",
                     points[0], points[0] + points[2] - 1, points[1], points[1] + points[3] - 1,
                     before.nx, before.ny);
    return 0;
}

/* Columns and rows between those that stay hold nothing of their own, where an instrument did not
 * measure them. */
static int stride(struct preparation_record *record, struct height_map *map,
                  const struct preparation *asked, struct error *err) {
    struct grid *grid = &map->grid;
    const struct grid before = *grid;
    const size_t x = asked->stride_x, y = grid_is_profile(grid) ? 1 : asked->stride_y;
    if (x == 0)
        return 0;
    const size_t nx = (before.nx - 1) / x + 1, ny = (before.ny - 1) / y + 1;
    if (nx < 2 || (ny < 2 && !grid_is_profile(&before)))
        return error_set(
            err, ERROR_INPUT,
            "--stride %zu,%zu leaves %zu by %zu of %zu by %zu points; allowed: 2 along "
            "each axis",
            x, y, nx, ny, before.nx, before.ny);
    for (size_t j = 0; j < ny; j++)
        for (size_t i = 0; i < nx; i++)
            map->z[j * nx + i] = map->z[j * y * before.nx + i * x];
    double *less = realloc(map->z, nx * ny * sizeof *map->z);
    map->z = less != NULL ? less : map->z;
    *grid = (struct grid){nx, ny, grid_dx(&before) * (double)(x * nx),
                          grid_dy(&before) * (double)(y * ny)};
    preparation_note(record, "stride", "1 of %zu columns and 1 of %zu rows, %zu by %zu points", x,
                     y, nx, ny);
    return 0;
}

/* --- what can be computed with --- */

/* Within these the fourth powers of slopes, and products of such of curvatures, are numbers, and
 * none of what is measured. Instruments are far inside, and so is the largest number of 32 bits,
 * which some write into holes. */
static const double HEIGHT_MOST = 1e40, HEIGHT_LEAST = 1e-40;
static const double SPACING_MOST = 1e30, SPACING_LEAST = 1e-30;

static bool is_spacing(double spacing) {
    return spacing >= SPACING_LEAST && spacing <= SPACING_MOST;
}

static int check_range(const struct height_map *map, struct error *err) {
    const struct grid *grid = &map->grid;
    const double dx = grid_dx(grid), dy = grid_is_profile(grid) ? dx : grid_dy(grid);
    double low = INFINITY, high = -INFINITY;
    for (size_t point = 0; point < grid_points(grid); point++) {
        low = fmin(low, map->z[point]); /* holes are passed over */
        high = fmax(high, map->z[point]);
    }
    if (!is_spacing(dx) || !is_spacing(dy))
        return error_set(err, ERROR_INPUT,
                         "points %g by %g apart; allowed: %g to %g (--dx and --unit say others)",
                         dx, dy, SPACING_LEAST, SPACING_MOST);
    if (low < -HEIGHT_MOST || high > HEIGHT_MOST)
        return error_set(
            err, ERROR_INPUT,
            "heights from %g to %g; allowed: at most %g above or below 0, and nan in holes", low,
            high, HEIGHT_MOST);
    if (high > low && high - low < HEIGHT_LEAST)
        return error_set(err, ERROR_INPUT,
                         "heights that differ by %g in all; allowed: %g at the least, or none",
                         high - low, HEIGHT_LEAST);
    return 0;
}

/* --- lines, spikes, tip --- */

/* Returns a height as messages print it. */
static const char *height_text(const struct height_map *map, double height, char text[40]) {
    double one = 1;
    const char *unit =
        length_unit_is_metre(map->z_unit) ? length_unit_readable(height, &one) : map->z_unit;
    snprintf(text, 40, "%.4g%s%s", height / one, *unit != '\0' ? " " : "", unit);
    return text;
}

static int level_lines(struct preparation_record *record, struct height_map *map,
                       const struct preparation *asked, struct error *err) {
    static const char *const NAMES[] = {"none", "mean", "median", "linear", "quadratic"};
    const bool along_x = asked->lines_along == SCAN_ALONG_X;
    struct scan_lines_result done;
    char rms[40];
    if (asked->lines == SCAN_LINES_NONE)
        return 0;
    if (!along_x && grid_is_profile(&map->grid))
        return error_set(err, ERROR_INPUT, "--lines-along y: a profile has one line, along x");
    int status = scan_lines_level(&map->grid, map->z, asked->lines, asked->lines_along, &done, err);
    if (status != 0)
        return error_context(err, "--lines");
    record->lines = asked->lines;
    record->lines_along = asked->lines_along;
    preparation_note(record, "lines",
                     "%s of each of %zu lines along %s, RMS %s, %.3g %% of the mean square",
                     NAMES[asked->lines], done.lines, along_x ? "x" : "y",
                     height_text(map, done.rms, rms), isnan(done.share) ? 0 : 100 * done.share);
    return 0;
}

static int remove_spikes(struct preparation_record *record, struct height_map *map,
                         const struct preparation *asked, struct error *err) {
    struct despike_result done;
    char deviation[40];
    if (asked->despike == 0)
        return 0;
    int status = despike(&map->grid, map->z, asked->despike, &done, err);
    if (status != 0)
        return error_context(err, "--despike");
    preparation_note(record, "despike",
                     "%zu points, %.3g %%, became holes: beyond %g deviations of %s from their "
                     "neighbours",
                     done.spikes, 100 * (double)done.spikes / (double)grid_points(&map->grid),
                     asked->despike, height_text(map, done.deviation, deviation));
    return 0;
}

static int remove_tip(struct preparation_record *record, struct height_map *map,
                      const struct preparation *asked, struct error *err) {
    const size_t points = grid_points(&map->grid);
    unsigned char *untrusted = NULL;
    struct tip_result done;
    char radius[40], rms[40];
    double length = 0;
    if (asked->tip.value == 0)
        return 0;
    int status = height_map_check_units(map, err);
    if (status == 0)
        status = preparation_length(&length, map, &asked->tip, "--deconvolve", err);
    if (status != 0)
        return status;
    if (asked->tip_holes && (untrusted = array_create(points, 1)) == NULL)
        return error_memory(err, points, "marks of a tip");
    status = tip_erode(&map->grid, map->z, length, untrusted, &done, err);
    for (size_t point = 0; point < points && status == 0 && untrusted != NULL; point++)
        if (untrusted[point] != 0)
            map->z[point] = (double)NAN;
    free(untrusted);
    if (status != 0)
        return error_context(err, "--deconvolve");
    preparation_note(record, "deconvolve",
                     "tip of radius %s, RMS change %s; %zu points, %.3g %%, not reached, %s",
                     preparation_length_text(map, length, radius), height_text(map, done.rms, rms),
                     done.untrusted, 100 * (double)done.untrusted / (double)points,
                     asked->tip_holes ? "became holes" : "bounded from above");
    return 0;
}

/* --- what the instrument left --- */

static int find_stored(struct preparation_record *record, const struct height_map *map,
                       const struct preparation *asked, struct error *err) {
    if (!asked->artefacts)
        return 0;
    return map_artefacts_find_stored(&map->grid, map->z, &record->artefacts, err);
}

static int find_left(struct preparation_record *record, const struct height_map *map,
                     const struct preparation *asked, struct error *err) {
    if (!asked->artefacts)
        return 0;
    record->artefacts.smoothed = asked->short_waves.value > 0 || asked->denoise;
    return map_artefacts_find_left(&map->grid, map->z, &record->artefacts, err);
}

/* --- turns --- */

static int transpose(struct preparation_record *record, struct height_map *map, bool asked,
                     struct error *err) {
    if (!asked)
        return 0;
    int status = map_transpose(map, err);
    if (status != 0)
        return error_context(err, "--transpose");
    preparation_note(record, "transpose", "x and y exchanged, %zu by %zu points", map->grid.nx,
                     map->grid.ny);
    return 0;
}

static int turn(struct preparation_record *record, struct height_map *map,
                const struct preparation *asked, struct error *err) {
    const struct grid before = map->grid;
    const double right_angles = asked->turn / 90;
    struct map_turn_result done;
    if (asked->turn == 0)
        return 0;
    if (right_angles == floor(right_angles)) {
        int status = map_turn_right(map, (unsigned)(right_angles + 4) % 4, err);
        if (status != 0)
            return error_context(err, "--rotate %g", asked->turn);
        preparation_note(record, "rotate", "%g degrees counter-clockwise, exactly", asked->turn);
        return 0;
    }
    if (asked->boundary == ASK_BOUNDARY_PERIODIC)
        return error_set(err, ERROR_INPUT,
                         "--rotate %g: a turned map no longer repeats; allowed with --boundary "
                         "periodic: multiples of 90",
                         asked->turn);
    int status = map_turn(map, asked->turn * PI / 180, &done, err);
    if (status != 0)
        return error_context(err, "--rotate %g", asked->turn);
    preparation_note(record, "rotate",
                     "%g degrees counter-clockwise, %zu by %zu points to %zu by %zu inside, by a "
                     "spline of degree 7; one of 5 changes slopes by %.2g %%",
                     asked->turn, before.nx, before.ny, map->grid.nx, map->grid.ny,
                     100 * done.slope_change);
    return 0;
}

/* --- boundary and trend --- */

static int check_holes(const struct height_map *map, const struct preparation *asked, double holes,
                       struct error *err) {
    if (holes == 1)
        return error_set(err, ERROR_INPUT, "the map has no heights, only holes");
    if (holes > 0 && !asked->fill && asked->boundary == ASK_BOUNDARY_PERIODIC) {
        int status = height_map_check_whole(map, err);
        return status == 0 ? 0 : error_context(err, "a periodic map");
    }
    return 0;
}

/* Formats that are converted are those of instruments, whose maps do not repeat; spikes inside can
 * make the seam look smooth. */
static void decide_boundary(struct preparation_record *record, enum asked_boundary asked) {
    bool instrument = preparation_text(record, "converted") != NULL;
    bool open = record->holes > 0 || instrument || seam_is_rough(&record->seam);
    if (asked != ASK_BOUNDARY_AUTO)
        open = asked == ASK_BOUNDARY_OPEN;
    record->boundary = open ? BOUNDARY_OPEN : BOUNDARY_PERIODIC;
    record->boundary_by = asked != ASK_BOUNDARY_AUTO ? "option"
                          : record->holes > 0        ? "holes"
                          : instrument               ? "instrument"
                                                     : "seam";
}

/* The seam is measured on the heights that are analysed later, except for a trend that only an open
 * map loses. */
static int level(struct preparation_record *record, struct height_map *map,
                 const struct preparation *asked, struct error *err) {
    bool given = asked->detrend != ASK_DETREND_AUTO;
    record->holes = (double)height_map_holes(map) / (double)grid_points(&map->grid);
    record->detrend = given ? (enum detrend)(asked->detrend - ASK_DETREND_NONE) : DETREND_NONE;
    int status = check_holes(map, asked, record->holes, err);
    if (status == 0 && given)
        status = detrend(&map->grid, map->z, record->detrend, &record->trend, err);
    if (status == 0)
        status = seam_measure(&map->grid, map->z, &record->seam, err);
    if (status != 0)
        return status;
    decide_boundary(record, asked->boundary);
    if (!given && record->boundary == BOUNDARY_OPEN) {
        record->detrend = DETREND_PLANE;
        status = detrend(&map->grid, map->z, record->detrend, &record->trend, err);
    }
    if (status == 0 && record->detrend != DETREND_NONE)
        preparation_note(record, "detrend", "%s%s, of least squares",
                         DETREND_NAMES[record->detrend], given ? "" : " (an open map)");
    return status;
}

static int degroove(struct preparation_record *record, struct height_map *map, struct error *err) {
    const struct measured_map measured = {&map->grid, map->z, record->boundary};
    struct map_grooves found;
    char period[2][40] = {"", ""}, depth[2][40] = {"", ""};
    int status = map_grooves_find(&found, &measured, err);
    if (status != 0)
        return error_context(err, "--degroove");
    map_grooves_take(&found, &map->grid, map->z);
    for (size_t f = 0; f < found.families; f++) {
        preparation_length_text(map, found.family[f].period, period[f]);
        height_text(map, found.family[f].fit.depth, depth[f]);
    }
    if (found.families == 0)
        preparation_note(record, "degroove", "none found; heights stay");
    else
        preparation_note(record, "degroove", "every %s, %s deep%s%s%s%s%s", period[0], depth[0],
                         found.families > 1 ? "; every " : "", period[1],
                         found.families > 1 ? ", " : "", depth[1],
                         found.families > 1 ? " deep" : "");
    return 0;
}

static int fill(struct preparation_record *record, struct height_map *map, struct error *err) {
    const size_t holes = height_map_holes(map);
    int status = membrane_fill(&map->grid, map->z, record->boundary, err);
    if (status != 0)
        return error_context(err, "--fill");
    preparation_note(record, "fill", "%zu holes, %.4g %% of the points, by the smoothest membrane",
                     holes, 100 * record->holes);
    return 0;
}

static int denoise(struct preparation_record *record, struct height_map *map, struct error *err) {
    struct denoise_result done;
    char noise[40], shortest[40];
    int status = height_map_check_whole(map, err);
    if (status != 0)
        return error_context(err, "--denoise, before which --fill fills holes");
    status = map_denoise(&map->grid, map->z, record->boundary, &done, err);
    if (status != 0)
        return error_context(err, "--denoise");
    record->denoised = done.found;
    record->denoised_slope = done.slope_error;
    record->denoised_curvature = done.curvature_error;
    record->denoised_to = done.shortest;
    if (!done.found)
        preparation_note(record, "denoise", "no noise governs the slopes; heights stay");
    else
        preparation_note(record, "denoise",
                         "noise of RMS %s, out of waves down to %s with the law's power, and all "
                         "shorter waves; RMS slope %.4g to %.4g",
                         height_text(map, done.noise, noise),
                         preparation_length_text(map, done.shortest, shortest), done.slope_before,
                         done.slope_after);
    return 0;
}

static int filter_one(struct preparation_record *record, struct height_map *map,
                      const struct asked_length *asked, bool keeps_long_waves, bool robust,
                      struct error *err) {
    const char *option = keeps_long_waves ? "--filter S" : "--filter L";
    struct gaussian_filter filter = {.keeps_long_waves = keeps_long_waves,
                                     .robust = robust,
                                     .metres = length_unit_is_metre(map->xy_unit)};
    struct gaussian_filter_result result;
    char cut_off[40], weights[60] = "";
    if (asked->value == 0)
        return 0;
    int status = preparation_length(&filter.cut_off, map, asked, option, err);
    if (status != 0)
        return status;
    status = gaussian_filter_run(&map->grid, map->z, record->boundary, &filter, &result, err);
    if (status != 0)
        return error_context(err, "%s", option);
    if (robust)
        snprintf(weights, sizeof weights, ", %zu steps of weights, %.3g %% rejected", result.steps,
                 100 * result.rejected);
    preparation_note(
        record, keeps_long_waves ? "s_filter" : "l_filter",
        "%s, cut-off %s, of which the mean has %.4g %%%s", robust ? "robust Gaussian" : "Gaussian",
        preparation_length_text(map, filter.cut_off, cut_off), 100 * result.transmission, weights);
    return 0;
}

static int filter(struct preparation_record *record, struct height_map *map,
                  const struct preparation *asked, struct error *err) {
    const struct asked_length *first = &asked->short_waves, *second = &asked->long_waves;
    char short_cut_off[40], long_cut_off[40];
    if (first->value > 0 && second->value > 0 && !(first->value < second->value))
        return error_set(err, ERROR_INPUT,
                         "--filter S=%s and L=%s leave no waves: the cut-off of S must be shorter",
                         preparation_length_text(map, first->value, short_cut_off),
                         preparation_length_text(map, second->value, long_cut_off));
    int status = filter_one(record, map, first, true, asked->robust, err);
    return status == 0 ? filter_one(record, map, second, false, asked->robust, err) : status;
}

/* What is done with grooves, of a map that had this grid. */
static void write_extended(const struct map_grooves *grooves, const struct height_map *map,
                           const struct grid *before, char out[160]) {
    char period[40], beyond[40];
    if (grooves->families == 0)
        return;
    preparation_length_text(map, grooves->family[0].period, period);
    preparation_length_text(map, groove_extension_period(&grooves->family[0], before), beyond);
    snprintf(out, 160, "; grooves every %s go on every %s, so that whole ones fit", period, beyond);
}

static int extend(struct preparation_record *record, struct height_map *map,
                  const struct preparation *asked, struct error *err) {
    static const double USUAL = 1.5; /* power that is no misfit */
    struct extend_result done;
    char noise[40], power[40] = "", grooves[160] = "";
    if (!asked->extend)
        return 0;
    if (asked->window != MAP_WINDOW_NONE)
        return error_set(err, ERROR_INPUT,
                         "--extend and --window both make a map repeat; allowed: one of them");
    if (record->boundary == BOUNDARY_PERIODIC)
        return error_set(err, ERROR_INPUT,
                         "--extend: the map repeats already (by %s); --boundary open says that it "
                         "does not",
                         record->boundary_by);
    const struct grid before = map->grid;
    int status = map_extend(map, record->detrend, asked->extend_seed, &done, err);
    if (status != 0)
        return error_context(err, "--extend");
    record->boundary = BOUNDARY_PERIODIC;
    record->boundary_by = "extension";
    if (done.draw.power > USUAL)
        snprintf(power, sizeof power, "; %.3g times the law's power", done.draw.power);
    write_extended(&done.grooves, map, &before, grooves);
    preparation_note(
        record, "extend", "to %zu by %zu points, draw %llu, %s off the map, %.3g of %s%s%s%s%s%s",
        map->grid.nx, map->grid.ny, (unsigned long long)asked->extend_seed,
        height_text(map, done.draw.difference, noise), done.draw.held,
        done.noise_seen ? "its noise" : "1/1000 RMS", power, done.law_holds ? "" : "; no law holds",
        done.translated ? "; by normal scores" : "",
        done.drawn ? "" : "; by the law of the map itself", grooves);
    return 0;
}

static int taper(struct preparation_record *record, struct height_map *map, enum map_window window,
                 struct error *err) {
    int status = height_map_check_whole(map, err);
    if (status != 0)
        return error_context(err, "--window, before which --fill fills holes");
    record->window_power = map_taper(&map->grid, map->z, window);
    record->boundary = BOUNDARY_PERIODIC;
    record->boundary_by = "window";
    preparation_note(record, "window", "%s, 1 in the middle, mean square %.6g",
                     window == MAP_WINDOW_HANN ? "Hann" : "Tukey, a tenth at each side",
                     record->window_power);
    return 0;
}

static int take_missing(struct preparation_record *record, struct height_map *map,
                        const struct preparation *asked, struct error *err) {
    char text[MISSING_TEXT];
    int status = missing_take_out(map, &asked->missing, text, err);
    if (status == 0 && *text != '\0')
        preparation_note(record, "missing", "%s", text);
    return status;
}

int preparation_run(struct preparation_record *record, struct height_map *map,
                    const struct preparation *asked, struct error *err) {
    record->window_power = 1;
    int status = take_missing(record, map, asked, err);
    if (status == 0)
        status = preparation_units(record, map, asked, err);
    if (status == 0)
        status = crop(record, map, asked, err);
    if (status == 0)
        status = stride(record, map, asked, err);
    if (status == 0)
        status = check_range(map, err);
    if (status == 0)
        status = find_stored(record, map, asked, err);
    if (status == 0)
        status = level_lines(record, map, asked, err);
    if (status == 0)
        status = remove_spikes(record, map, asked, err);
    if (status == 0)
        status = remove_tip(record, map, asked, err);
    if (status == 0)
        status = find_left(record, map, asked, err);
    if (status == 0)
        status = transpose(record, map, asked->transpose, err);
    if (status == 0)
        status = turn(record, map, asked, err);
    if (status == 0)
        status = level(record, map, asked, err);
    if (status == 0 && asked->degroove)
        status = degroove(record, map, err);
    if (status == 0 && asked->fill)
        status = fill(record, map, err);
    if (status == 0 && asked->denoise)
        status = denoise(record, map, err);
    if (status == 0)
        status = filter(record, map, asked, err);
    if (status == 0)
        status = preparation_resample(record, map, asked, err);
    if (status == 0)
        status = extend(record, map, asked, err);
    if (status == 0 && asked->window != MAP_WINDOW_NONE)
        status = taper(record, map, asked->window, err);
    return status;
}
