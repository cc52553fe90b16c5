#include "tests/support/fuzz/draw_map.h"
#include "core/map/height_map_file.h"
#include "tests/support/fuzz/fuzz.h"
#include <math.h>

enum shape { WAVES, NOISE, PLANE, STEPS, SPIKES, FLAT, BOWL, ANY_NUMBERS, SHAPES };

/* Returns a number that follows from the two together and looks random, in [-1, 1). */
static double noise(size_t seed, size_t point) {
    uint64_t word = (seed * 7919 + point + 1) * UINT64_C(0x9e3779b97f4a7c15);
    word = (word ^ word >> 31) * UINT64_C(0xbf58476d1ce4e5b9);
    return (double)(word >> 11) / 0x1p52 - 1;
}

static void draw_grid(struct choices *choices, size_t side, struct grid *grid) {
    static const double SPACINGS[] = {1, 0.5, 3, 1e29, 1e-29, 1e300, 5e-324, 1e-6};
    enum { COUNT = sizeof SPACINGS / sizeof *SPACINGS };
    double dx = 1, dy = 1;
    *grid = (struct grid){.nx = side, .ny = 1 + side / 2};
    switch (choose(choices, 8)) {
    case 0:
        break;
    case 1: /* a profile, or none since it has one point */
        grid->nx = 1 + choose(choices, 2 * side);
        grid->ny = 1;
        break;
    case 2: /* next to none, or a column */
        grid->nx = 1 + choose(choices, 3);
        grid->ny = 1 + choose(choices, 4);
        break;
    default:
        grid->nx = 2 + choose(choices, side - 1);
        grid->ny = 1 + choose(choices, side);
    }
    if (choose_rarely(choices, 4))
        dx = dy = SPACINGS[choose(choices, COUNT)];
    if (choose_rarely(choices, 16))
        dy = SPACINGS[choose(choices, COUNT)];
    grid->lx = dx * (double)grid->nx;
    grid->ly = dy * (double)grid->ny;
}

/* A height of the shapes that follow from the position and the seed alone. */
static double height_at(enum shape shape, size_t seed, size_t i, size_t j,
                        const struct grid *grid) {
    const double x = (double)i, y = (double)j;
    const double wave = 2 * M_PI * (1 + (double)(seed % 7)) / (double)grid->nx;
    switch (shape) {
    case WAVES:
        return sin(wave * x) + 0.5 * cos(1.7 * wave * (x + y)) + 0.2 * sin(2.9 * wave * y);
    case NOISE:
        return noise(seed, j * grid->nx + i);
    case PLANE:
        return 0.3 * x - 0.01 * (double)seed * y;
    case STEPS:
        return floor((x + y) / (double)(1 + seed % 5));
    case BOWL:
        return -0.01 * (x * x + y * y);
    default:
        return 0;
    }
}

static void draw_shape(struct choices *choices, const struct grid *grid, double *z) {
    const enum shape shape = (enum shape)choose(choices, SHAPES);
    const size_t seed = choose(choices, 256), points = grid_points(grid);
    for (size_t point = 0; point < points; point++)
        z[point] = height_at(shape, seed, point % grid->nx, point / grid->nx, grid);
    if (shape == SPIKES)
        for (size_t left = 1 + seed % 4; left > 0; left--)
            z[choose(choices, points)] = choose_odd_number(choices, false);
    if (shape == ANY_NUMBERS)
        for (size_t point = 0; point < points; point++)
            z[point] = choose_rarely(choices, 16) ? choose_odd_number(choices, false)
                                                  : choose_number(choices, -10, 10);
}

/* Scales and moves the heights and takes some away, of two maps in five nothing of this. */
static void spoil(struct choices *choices, const struct grid *grid, double *z) {
    static const double SCALES[] = {1e-9,  1e3,   1e16,   1e38,   1e-38,
                                    1e-20, 1e300, 1e-300, 5e-324, 1e45};
    const size_t points = grid_points(grid), kind = choose(choices, 8), seed = choose(choices, 64);
    const double scale =
        choose_rarely(choices, 4) ? SCALES[choose(choices, sizeof SCALES / sizeof *SCALES)] : 1;
    const double offset = choose_rarely(choices, 8) ? choose_odd_number(choices, false) : 0;
    for (size_t point = 0; point < points; point++) {
        bool hole = (kind == 5 && noise(seed, point) > 0.8) ||
                    (kind == 6 && point / grid->nx == seed % grid->ny) ||
                    (kind == 7 && point != seed && noise(seed, point) > -0.9);
        z[point] = hole ? (double)NAN : z[point] * scale + offset;
        if (isinf(z[point]) && !choose_rarely(choices, 16)) /* which no reader takes */
            z[point] = copysign(1.7e308, z[point]);
    }
}

/* Lines that the readers of text know (core/instrument/text/text.c). */
static void draw_header(struct choices *choices, FILE *file, enum height_map_format format,
                        const struct grid *grid, const char *unit) {
    static const char *const UNITS[] = {"", "nm", "mm", "m", "um", "V"};
    enum { COUNT = sizeof UNITS / sizeof *UNITS };
    const char *xy = unit, *z = *unit != '\0' ? "nm" : "";
    if (choose_rarely(choices, 8)) {
        xy = UNITS[choose(choices, COUNT)];
        z = UNITS[choose(choices, COUNT)];
    }
    const bool spaced = choose(choices, 2) == 1;
    if (format == HEIGHT_MAP_CSV && (spaced || *xy != '\0')) {
        fprintf(file, "# dx: %.17g %s\n", grid_dx(grid), xy);
        fprintf(file, "# dy: %.17g %s\n", grid_dy(grid), xy);
    } else if (*xy != '\0')
        fprintf(file, "# xy unit: %s\n", xy);
    if (*z != '\0')
        fprintf(file, "# z unit: %s\n", z);
}

void draw_map(struct choices *choices, const char *path, const char *unit, size_t side) {
    const enum height_map_format format = height_map_format_of(path);
    struct error err = {0};
    struct grid grid;
    draw_grid(choices, side, &grid);
    double *z = array_create(grid_points(&grid), sizeof *z);
    FILE *file = fopen(path, "wb");
    MUST(z != NULL && file != NULL && format != HEIGHT_MAP_FORMATS);
    draw_shape(choices, &grid, z);
    spoil(choices, &grid, z);
    if (format != HEIGHT_MAP_NPY)
        draw_header(choices, file, format, &grid, unit);
    MUST(height_map_write(file, format, &grid, z, &err) == 0);
    MUST(fclose(file) == 0);
    free(z);
}
