#include "server/show/map/map_png.h"
#include <math.h>
#include <png.h>
#include <stdlib.h>

/* Stops of the colour map "inferno", whose lightness rises evenly from dark to light. */
static const double STOPS[][3] = {{0, 0, 4},     {40, 11, 84},   {101, 21, 110}, {159, 42, 99},
                                  {212, 72, 66}, {245, 125, 21}, {250, 193, 39}, {252, 255, 164}};
enum { STOPS_COUNT = sizeof STOPS / sizeof *STOPS, CHANNELS = 4 };

static void colour(double share, png_byte *pixel) {
    double place = share * (STOPS_COUNT - 1);
    size_t below = place < STOPS_COUNT - 2 ? (size_t)place : STOPS_COUNT - 2;
    for (size_t k = 0; k < 3; k++)
        pixel[k] = (png_byte)lround(STOPS[below][k] + (place - (double)below) *
                                                          (STOPS[below + 1][k] - STOPS[below][k]));
    pixel[3] = 255;
}

struct range {
    double low, high;
};
static struct range range_of(size_t points, const double *z) {
    struct range range = {INFINITY, -INFINITY};
    for (size_t i = 0; i < points; i++)
        if (isfinite(z[i])) {
            range.low = fmin(range.low, z[i]);
            range.high = fmax(range.high, z[i]);
        }
    return range;
}

static void fill_row(const struct grid *grid, const double *z, const struct range *range,
                     png_byte *row) {
    for (size_t i = 0; i < grid->nx; i++) {
        double span = range->high - range->low;
        png_byte *pixel = &row[CHANNELS * i];
        if (isfinite(z[i]))
            colour(span > 0 ? (z[i] - range->low) / span : 0, pixel);
        else
            pixel[3] = 0;
    }
}

/* The library leaves by longjmp where it fails: what changes in between is not looked at after. */
static int write_rows(png_structp png, png_infop info, FILE *file, const struct grid *grid,
                      const double *z, png_byte *row) {
    const struct range range = range_of(grid_points(grid), z);
    char text[64];
    if (setjmp(png_jmpbuf(png)) != 0)
        return ERROR_SYSTEM;
    snprintf(text, sizeof text, "%.9g %.9g", range.low, range.high);
    png_text note = {
        .compression = PNG_TEXT_COMPRESSION_NONE, .key = (png_charp) "Range", .text = text};
    png_init_io(png, file);
    png_set_IHDR(png, info, (png_uint_32)grid->nx, (png_uint_32)grid->ny, 8, PNG_COLOR_TYPE_RGBA,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_text(png, info, &note, 1);
    png_write_info(png, info);
    for (size_t j = grid->ny; j-- > 0;) {
        fill_row(grid, z + j * grid->nx, &range, row);
        png_write_row(png, row);
    }
    png_write_end(png, info);
    return 0;
}

static void no_warning(png_structp png, png_const_charp text) {
    (void)png;
    (void)text;
}

void map_blank_open(const struct grid *grid, double *pressures) {
    size_t points = grid_points(grid);
    if (grid_is_profile(grid) || !(range_of(points, pressures).high > 0))
        return;
    for (size_t i = 0; i < points; i++)
        if (!(pressures[i] > 0))
            pressures[i] = NAN;
}

int map_png(FILE *file, const struct grid *grid, const double *z, struct error *err) {
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, no_warning);
    png_infop info = png != NULL ? png_create_info_struct(png) : NULL;
    png_byte *row = array_create(grid->nx, CHANNELS);
    int status = info != NULL && row != NULL ? write_rows(png, info, file, grid, z, row)
                                             : error_memory(err, CHANNELS * grid->nx, "a picture");
    if (status == ERROR_SYSTEM)
        status = error_set(err, ERROR_SYSTEM, "a picture of %zu x %zu points cannot be written",
                           grid->nx, grid->ny);
    free(row);
    png_destroy_write_struct(&png, &info);
    return status;
}
