#include "core/statistics/grooves/groove_family.h"
#include "core/statistics/heights/roughness.h"
#include "core/statistics/measured_map.h"
#include "core/statistics/spectra/windowed_psd.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* --- heights --- */

void groove_family_add(const struct groove_lines *lines, const struct groove_shape_fit *fit,
                       const struct grid *grid, double times, double jump, double *z) {
    const double nx = (double)grid->nx, ny = (double)grid->ny;
    const bool endless = groove_shape_endless(fit);
    const struct groove_lines beyond = groove_lines_beyond(lines, fit, jump);
    for (size_t first = 0; first < grid->nx; first += GROOVE_TURNS) {
        const size_t points = grid->nx - first < GROOVE_TURNS ? grid->nx - first : GROOVE_TURNS;
        const struct groove_turns turns = groove_turns_of(lines->mx, first, points, grid->nx);
        for (size_t j = 0; j < grid->ny; j++) {
            const double y = ((double)j + 0.5) / ny - 0.5;
            double height[GROOVE_TURNS], *row = z + j * grid->nx + first;
            groove_lines_heights(&beyond, &turns, y, height);
            for (size_t p = 0; p < points && endless; p++) {
                const double x = ((double)(first + p) + 0.5) / nx - 0.5;
                height[p] += groove_shape_height(fit, lines->mx * x + lines->my * y, jump);
            }
            for (size_t p = 0; p < points; p++)
                row[p] += times * height[p];
        }
    }
}

/* --- the estimate --- */

/* Sums over what is left, which the next step takes away. */
struct step {
    double gradient[2], information; /* of the wave vector, but for the moments of the window */
    double complex coefficient[GROOVE_LINES_MOST];
};

/* Lines so many times above the random part count for the wave vector where no shape is known. */
static const double STANDS_OUT = 12;

/* Returns what a line has that the wave vector is estimated of: by its shape, where that is known;
 * 0 where it does not count. */
static double complex line_of(const struct groove_lines *lines, const struct groove_shape_fit *fit,
                              size_t h) {
    if (fit->shape != GROOVE_HARMONICS)
        return groove_shape_line(fit, h, 0);
    size_t strongest = 0;
    for (size_t other = 0; other < lines->count; other++)
        if (lines->excess[other] > lines->excess[strongest])
            strongest = other;
    return lines->excess[h - 1] > STANDS_OUT || h == strongest + 1 ? lines->coefficient[h - 1] : 0;
}

static void step_measure(struct step *out, const struct groove_lines *lines,
                         const struct groove_shape_fit *fit, const struct groove_map *left,
                         double weight) {
    *out = (struct step){.information = 0};
    for (size_t h = 1; h <= lines->count; h++) {
        const double order = (double)h, variance = lines->variance[h - 1];
        const double complex line = line_of(lines, fit, h);
        const struct groove_sums sums = groove_sums_at(left, order * lines->mx, order * lines->my);
        out->coefficient[h - 1] = sums.plain / weight;
        out->gradient[0] += order * cimag(conj(line) * sums.x) / weight / variance;
        out->gradient[1] += order * cimag(conj(line) * sums.y) / weight / variance;
        out->information += order * order * complex_square(line) / variance;
    }
}

/* Returns what points beside the jumps of a saw add to the variance of a line: they are off by up
 * to half the depth, as if at random, since its jump is too wide. */
static double jumps_variance(const struct groove_shape_fit *fit, const struct grid *grid) {
    const struct groove_window x = groove_window_of(grid->nx), y = groove_window_of(grid->ny);
    const double depth = fit->shape == GROOVE_SAW ? fit->of[GROOVE_SAW].depth : 0;
    return depth * depth * GROOVE_JUMP / 12 * x.square * y.square /
           ((double)grid_points(grid) * x.mean * x.mean * y.mean * y.mean);
}

/* Fills variances of the lines by what is left around them, and how far they stand out. */
static void lines_compare(struct groove_lines *lines, const struct groove_shape_fit *fit,
                          const struct groove_background *rest, const struct grid *grid) {
    static const double ROUNDING = 1e-12; /* of the strongest line */
    const struct groove_window x = groove_window_of(grid->nx), y = groove_window_of(grid->ny);
    const double mean = x.mean * y.mean;
    const double jumps = jumps_variance(fit, grid);
    double strongest = 0;
    for (size_t h = 0; h < lines->count; h++)
        strongest = fmax(strongest, complex_square(lines->coefficient[h]));
    for (size_t h = 0; h < lines->count; h++) {
        const double order = (double)(h + 1);
        const double power = groove_background_near(rest, order * lines->mx, order * lines->my);
        lines->variance[h] = power / (mean * mean) + jumps + ROUNDING * strongest;
        lines->excess[h] = complex_square(lines->coefficient[h]) / lines->variance[h];
    }
}

static double shortened(double step) {
    static const double LONGEST = 0.3; /* of a period along a side */
    return fmin(fmax(step, -LONGEST), LONGEST);
}

/* Steps of Gauss and Newton towards the least squares of what is left, each wave as likely as the
 * rest has them. named: of the named shape that fits best. */
static int settle(struct groove_lines *lines, struct groove_shape_fit *fit, bool named,
                  const struct grid *grid, const struct groove_background *rest, double *left,
                  double *windowed, struct error *err) {
    enum { STEPS_MOST = 40 };
    static const double SETTLED = 0.001;            /* about hundredths of standard errors */
    static const double WIDE = 0.1, NARROWER = 0.8; /* jumps, so that they are found from afar */
    const bool profile = grid_is_profile(grid);
    const struct groove_window along_x = groove_window_of(grid->nx),
                               along_y = groove_window_of(grid->ny);
    const double mean = along_x.mean * along_y.mean;
    const double weight = (double)grid_points(grid) * mean;
    const struct measured_map map = {grid, left, BOUNDARY_OPEN};
    const struct groove_map sums = {grid, windowed};
    double power, moved = INFINITY, jump = GROOVE_JUMP;
    for (int step = 0; step < STEPS_MOST && (moved > SETTLED || jump > GROOVE_JUMP); step++) {
        struct step by;
        int status = windowed_heights(&map, windowed, &power, err);
        if (status != 0)
            return status;
        lines_compare(lines, fit, rest, grid);
        step_measure(&by, lines, fit, &sums, weight);
        if (!(by.information > 0))
            return 0;
        groove_family_add(lines, fit, grid, 1, jump, left);
        jump =
            fit->shape == GROOVE_SAW ? fmax(WIDE * pow(NARROWER, step), GROOVE_JUMP) : GROOVE_JUMP;
        const double scale = 1 / (2 * M_PI * by.information);
        const double by_x = shortened(by.gradient[0] * scale / along_x.moment);
        const double by_y = profile ? 0 : shortened(by.gradient[1] * scale / along_y.moment);
        lines->mx += by_x;
        lines->my += by_y;
        moved = hypot(by_x, by_y) * sqrt(by.information);
        for (size_t h = 0; h < lines->count; h++)
            lines->coefficient[h] += by.coefficient[h];
        lines_compare(lines, fit, rest, grid);
        groove_shape_find(fit, lines);
        if (!named)
            groove_shape_forget(fit, lines);
        groove_family_add(lines, fit, grid, -1, jump, left);
    }
    return 0;
}

/* A linear function of x and y from the middle, in sides. */
struct direction {
    double x, y;
};

/* Returns the variance of a sum over the lines of what the rest has under the window times a linear
 * function of x and y: sum_h (h/v_h)^2 |c_h|^2 u_h/2, where u_h is as v_h under that. */
static int score_variance(double *out, const struct groove_lines *lines,
                          const struct groove_shape_fit *fit, const struct groove_map *left,
                          const struct lay *lay, struct direction by, double *scratch,
                          struct error *err) {
    const struct grid *grid = left->grid;
    const struct groove_window x = groove_window_of(grid->nx), y = groove_window_of(grid->ny);
    const double mean = x.mean * y.mean;
    const double jumps = jumps_variance(fit, grid);
    const double square = by.x * by.x * x.square_moment + by.y * by.y * y.square_moment;
    struct modes modes = {.power = NULL};
    struct groove_background *rest = NULL;
    for (size_t j = 0; j < grid->ny; j++)
        for (size_t i = 0; i < grid->nx; i++)
            scratch[j * grid->nx + i] =
                left->z[j * grid->nx + i] * (by.x * (((double)i + 0.5) / (double)grid->nx - 0.5) +
                                             by.y * (((double)j + 0.5) / (double)grid->ny - 0.5));
    int status = map_modes_measure(grid, scratch, &modes, err);
    if (status == 0)
        status = groove_background_create(&rest, &modes, lay, err);
    *out = 0;
    for (size_t h = 1; h <= lines->count && status == 0; h++) {
        const double order = (double)h, variance = lines->variance[h - 1];
        const double power = groove_background_near(rest, order * lines->mx, order * lines->my);
        *out += order * order * complex_square(line_of(lines, fit, h)) *
                (power / (mean * mean) + square * jumps) / 2 / (variance * variance);
    }
    groove_background_destroy(&rest);
    free(modes.power);
    return status;
}

/* Fills the errors of period and angle: the wave vector is that where sum_h (h/v_h) Im(conj(c_h)
 * X_h) is 0, with X_h the sums of w z exp(-i h q r) times x and y, and changes with it as that
 * does by the rest. */
static int errors_fill(struct groove_lines *lines, const struct groove_shape_fit *fit,
                       const struct groove_map *left, const struct lay *lay, double *scratch,
                       struct error *err) {
    const struct grid *grid = left->grid;
    const bool profile = grid_is_profile(grid);
    const double x_moment = groove_window_of(grid->nx).moment * grid->lx;
    const double y_moment = profile ? 1 : groove_window_of(grid->ny).moment * grid->ly;
    const double x = lines->mx / grid->lx, y = profile ? 0 : lines->my / grid->ly;
    double information = 0, radial = 0, turning = 0;
    for (size_t h = 1; h <= lines->count; h++)
        information +=
            (double)(h * h) * complex_square(line_of(lines, fit, h)) / lines->variance[h - 1];
    const double scale = 1 / (2 * M_PI * information * (x * x + y * y));
    int status = score_variance(&radial, lines, fit, left, lay,
                                (struct direction){x / x_moment, y / y_moment}, scratch, err);
    if (status == 0 && !profile)
        status = score_variance(&turning, lines, fit, left, lay,
                                (struct direction){-y / x_moment, x / y_moment}, scratch, err);
    lines->stretch_error = scale * sqrt(radial);
    lines->angle_error = scale * sqrt(turning);
    return status;
}

/* Adds to the errors of a saw what is estimated amiss of the saw alone, sharp as it is, in the same
 * manner: its points fold harmonics back beside its lines. */
static int folds_add(struct groove_lines *lines, struct groove_shape_fit *fit,
                     const struct grid *grid, const struct groove_background *rest, double *alone,
                     double *windowed, struct error *err) {
    const struct measured_map map = {grid, alone, BOUNDARY_OPEN};
    const struct groove_map sums = {grid, windowed};
    const double ly = grid_is_profile(grid) ? INFINITY : grid->ly;
    struct groove_lines found = *lines;
    struct groove_shape_fit shape;
    double power;
    for (size_t h = 1; h <= lines->count; h++) /* the shape alone */
        found.coefficient[h - 1] = groove_shape_line(fit, h, 0);
    memset(alone, 0, grid_points(grid) * sizeof *alone);
    groove_family_add(&found, fit, grid, 1, 0, alone);
    int status = windowed_heights(&map, windowed, &power, err);
    if (status != 0)
        return status;
    groove_lines_fit(&found, &sums, rest, lines->mx, lines->my);
    groove_shape_find(&shape, &found);
    groove_family_add(&found, &shape, grid, -1, GROOVE_JUMP, alone);
    status = settle(&found, &shape, true, grid, rest, alone, windowed, err);
    const double x = lines->mx / grid->lx, y = lines->my / ly, square = x * x + y * y;
    const double by_x = found.mx / grid->lx - x, by_y = found.my / ly - y;
    lines->stretch_error = hypot(lines->stretch_error, (x * by_x + y * by_y) / square);
    lines->angle_error = hypot(lines->angle_error, (x * by_y - y * by_x) / square);
    return status;
}

int groove_family_estimate(struct groove_lines *lines, struct groove_shape_fit *fit,
                           const struct grid *grid, const struct groove_background *rest,
                           const struct lay *lay, double *left, struct error *err) {
    const size_t points = grid_points(grid);
    double *windowed = array_create(points, sizeof *windowed), power;
    double *scratch = array_create(points, sizeof *scratch);
    int status = windowed != NULL && scratch != NULL
                     ? 0
                     : error_memory(err, 2 * points * sizeof *windowed, "a map under a window");
    if (status == 0)
        status = settle(lines, fit, true, grid, rest, left, windowed, err);
    if (status == 0 && fit->p_value < GROOVE_SHAPE_LEVEL)
        status = settle(lines, fit, false, grid, rest, left, windowed, err);
    const struct measured_map map = {grid, left, BOUNDARY_OPEN};
    const struct groove_map sums = {grid, windowed};
    if (status == 0)
        status = windowed_heights(&map, windowed, &power, err);
    if (status == 0)
        status = errors_fill(lines, fit, &sums, lay, scratch, err);
    if (status == 0 && fit->shape == GROOVE_SAW)
        status = folds_add(lines, fit, grid, rest, scratch, windowed, err);
    free(windowed);
    free(scratch);
    return status;
}
