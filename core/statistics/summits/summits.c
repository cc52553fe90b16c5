#include "core/statistics/summits/summits.h"
#include "core/statistics/summits/grid_summits.h"
#include "core/statistics/summits/refined.h"
#include "core/surface/transform.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Of surfaces z = height f(g). */
struct summit_translation {
    const struct height_function *function; /* borrowed, as g; NULL: surfaces are z themselves */
    double height;
    const double *gaussian;
    double *slope;            /* square of the slope of g at every point; owned, as below */
    double complex *spectrum; /* of g; both where curvatures are spectral, NULL otherwise */
};

struct summit_finder {
    struct grid grid;
    enum summit_stencil stencil;
    size_t mode_x, mode_y;
    size_t *columns;             /* one row's summits */
    struct transform *transform; /* spectral curvature: exact derivatives, NULL otherwise */
    double *curvature;           /* of every point, of z or of g, likewise */
    struct refined *refined;     /* SUMMITS_REFINED, NULL otherwise */
    struct summit_translation translation;
};

static int finder_fill(struct summit_finder *f, enum summit_curvature curvature,
                       struct error *err) {
    if (f->stencil == SUMMITS_REFINED)
        return refined_create(&f->refined, &f->grid, f->mode_x, f->mode_y, err);
    f->columns = array_create(f->grid.nx, sizeof *f->columns);
    if (f->columns == NULL)
        return error_memory(err, f->grid.nx * sizeof *f->columns, "a row of summits");
    if (curvature == CURVATURE_FINITE_DIFFERENCE)
        return 0;
    f->curvature = array_create(grid_points(&f->grid), sizeof *f->curvature);
    if (f->curvature == NULL)
        return error_memory(err, grid_points(&f->grid) * sizeof *f->curvature, "curvatures");
    return transform_create(&f->transform, &f->grid, f->mode_x, f->mode_y, err);
}

int summit_finder_create(struct summit_finder **out, const struct grid *grid,
                         enum summit_stencil stencil, enum summit_curvature curvature,
                         size_t mode_x, size_t mode_y, struct error *err) {
    int status = grid_check(grid, err);
    if (status != 0)
        return status;
    struct summit_finder *f = array_create(1, sizeof *f);
    if (f == NULL)
        return error_memory(err, sizeof *f, "a summit finder");
    f->grid = *grid;
    f->stencil = stencil;
    f->mode_x = mode_x;
    f->mode_y = mode_y;
    status = finder_fill(f, curvature, err);
    if (status != 0) {
        summit_finder_destroy(&f);
        return status;
    }
    *out = f;
    return 0;
}

void summit_finder_destroy(struct summit_finder **finder) {
    struct summit_finder *f = *finder;
    if (f == NULL)
        return;
    refined_destroy(&f->refined);
    transform_destroy(&f->transform);
    free(f->translation.slope);
    free(f->translation.spectrum);
    free(f->curvature);
    free(f->columns);
    free(f);
    *finder = NULL;
}

static size_t waves(const struct summit_finder *f) {
    return (f->mode_x + 1) * f->grid.ny;
}

int summit_finder_translate(struct summit_finder *f, const struct height_function *function,
                            double height, struct error *err) {
    struct summit_translation *translation = &f->translation;
    if (f->curvature != NULL && translation->slope == NULL) {
        size_t points = grid_points(&f->grid);
        translation->slope = array_create(points, sizeof *translation->slope);
        translation->spectrum = array_create(waves(f), sizeof *translation->spectrum);
        if (translation->slope == NULL || translation->spectrum == NULL)
            return error_memory(err, points * sizeof *translation->slope, "slopes");
    }
    translation->function = function;
    translation->height = height;
    return 0;
}

void summit_finder_gaussian(struct summit_finder *f, const double *gaussian) {
    f->translation.gaussian = gaussian;
}

double summit_finder_bytes(const struct grid *grid, enum summit_stencil stencil,
                           enum summit_curvature curvature, size_t mode_x, size_t mode_y,
                           bool translated) {
    if (stencil == SUMMITS_REFINED)
        return refined_bytes(grid, mode_x, mode_y);
    double bytes = (double)grid->nx * sizeof(size_t);
    if (curvature == CURVATURE_SPECTRAL)
        bytes += (translated ? 2 : 1) *
                 ((double)grid_points(grid) * sizeof(double) +
                  (double)(mode_x + 1) * (double)grid->ny * sizeof(double complex));
    return bytes;
}

/* Returns the wave number along an axis (0: x, 1: y) of a mode of the half spectrum. It is 0 beyond
 * the band, and of a wave of two points, which has no slope at them. */
static double wave_number(const struct summit_finder *f, int axis, size_t mx, size_t row) {
    const struct grid *grid = &f->grid;
    bool above = row <= f->mode_y, below = grid->ny - row <= f->mode_y;
    if ((!above && !below) || (axis == 0 ? 2 * mx == grid->nx : 2 * row == grid->ny))
        return 0;
    if (axis == 0)
        return 2 * M_PI * (double)mx / grid->lx;
    return 2 * M_PI * (above ? (double)row : -(double)(grid->ny - row)) / grid->ly;
}

/* Fills the derivative of g along an axis, from its spectrum, in place of curvatures. */
static void derivative_fill(struct summit_finder *f, int axis) {
    double complex *mode = transform_spectrum(f->transform);
    const double complex *from = f->translation.spectrum;
    for (size_t mx = 0; mx <= f->mode_x; mx++)
        for (size_t row = 0; row < f->grid.ny; row++)
            *mode++ = wave_number(f, axis, mx, row) * I * *from++;
    transform_inverse(f->transform, f->curvature);
}

/* Fills the squares of slopes of g. */
static void slopes_fill(struct summit_finder *f) {
    const size_t points = grid_points(&f->grid);
    double *slope = f->translation.slope;
    derivative_fill(f, 0);
    for (size_t i = 0; i < points; i++)
        slope[i] = f->curvature[i] * f->curvature[i];
    if (grid_is_profile(&f->grid))
        return;
    derivative_fill(f, 1);
    for (size_t i = 0; i < points; i++)
        slope[i] += f->curvature[i] * f->curvature[i];
}

/* Fills in -(z_xx + z_yy)/2 of every point (profiles -z_xx), exact for a band-limited surface. Of a
 * translated one these are of g, with the squares of slopes. */
static void curvature_fill(struct summit_finder *f, const double *z) {
    const struct grid *grid = &f->grid;
    size_t ny = grid->ny;
    const bool translated = f->translation.function != NULL;
    double step_x = 2 * M_PI / grid->lx, step_y = grid_is_profile(grid) ? 0 : 2 * M_PI / grid->ly;
    double half = grid_is_profile(grid) ? 1 : 0.5;
    transform_forward(f->transform, translated ? f->translation.gaussian : z);
    double complex *mode = transform_spectrum(f->transform);
    if (translated) {
        memcpy(f->translation.spectrum, mode, waves(f) * sizeof *mode);
        slopes_fill(f);
        memcpy(mode, f->translation.spectrum, waves(f) * sizeof *mode);
    }
    for (size_t mx = 0; mx <= f->mode_x; mx++)
        for (size_t row = 0; row < ny; row++, mode++) {
            size_t my = row <= ny / 2 ? row : ny - row;
            double kx = (double)mx * step_x, ky = (double)my * step_y;
            *mode *= my <= f->mode_y ? half * (kx * kx + ky * ky) : 0;
        }
    transform_inverse(f->transform, f->curvature);
}

/* Computes the curvature by central second differences (F1.3). */
static double difference_curvature(const struct grid *grid, const double *z, size_t i, size_t j) {
    size_t nx = grid->nx, ny = grid->ny;
    const double *row = z + j * nx;
    double dx = grid_dx(grid), dy = grid_dy(grid);
    double left = row[i != 0 ? i - 1 : nx - 1], right = row[i + 1 < nx ? i + 1 : 0];
    double xx = (left - 2 * row[i] + right) / (dx * dx);
    if (grid_is_profile(grid))
        return -xx;
    double up = z[(j != 0 ? j - 1 : ny - 1) * nx + i], down = z[(j + 1 < ny ? j + 1 : 0) * nx + i];
    double yy = (up - 2 * row[i] + down) / (dy * dy);
    return -(xx + yy) / 2;
}

/* Returns the curvature of a point from exact derivatives (F6.13). */
static double spectral_curvature(const struct summit_finder *f, size_t point) {
    const struct summit_translation *translation = &f->translation;
    if (translation->function == NULL)
        return f->curvature[point];
    double g = translation->gaussian[point], half = grid_is_profile(&f->grid) ? 1 : 0.5;
    double slope = height_function_at(translation->function, g).slope;
    double bend = height_function_bend(translation->function, g);
    return translation->height *
           (slope * f->curvature[point] - half * bend * translation->slope[point]);
}

static int point_add(struct summit_finder *f, const double *z, size_t i, size_t j, bool mirrored,
                     struct summit_list *list, struct error *err) {
    const struct grid *grid = &f->grid;
    const double sign = mirrored ? -1 : 1;
    size_t point = j * grid->nx + i;
    double curvature =
        f->curvature != NULL ? spectral_curvature(f, point) : difference_curvature(grid, z, i, j);
    struct summit summit = {.x = (double)i * grid_dx(grid),
                            .y = grid_is_profile(grid) ? 0 : (double)j * grid_dy(grid),
                            .height = sign * z[point],
                            .curvature = sign * curvature};
    return summit_list_add(list, &summit, err);
}

/* Rows above and below are NULL for a profile. */
struct three_rows {
    const double *up, *middle, *down;
};
static struct three_rows rows_at(const struct grid *grid, const double *z, size_t j) {
    size_t nx = grid->nx, ny = grid->ny;
    if (grid_is_profile(grid))
        return (struct three_rows){NULL, z, NULL};
    return (struct three_rows){z + (j != 0 ? j - 1 : ny - 1) * nx, z + j * nx,
                               z + (j + 1 < ny ? j + 1 : 0) * nx};
}

/* Appends refined summits to an empty list. Those of a translated surface lie where those of g
 * do. */
static int refine(struct summit_finder *f, const double *z, bool mirrored, struct summit_list *list,
                  struct error *err) {
    const struct summit_translation *translation = &f->translation;
    const double sign = mirrored ? -1 : 1;
    const double *field = translation->function != NULL ? translation->gaussian : z;
    int status = mirrored ? refined_find_pits(f->refined, field, list, err)
                          : refined_find(f->refined, field, list, err);
    for (size_t s = 0; s < list->count && translation->function != NULL && status == 0; s++) {
        struct summit *summit = &list->summits[s];
        struct height_slope at = height_function_at(translation->function, sign * summit->height);
        summit->height = sign * translation->height * at.height;
        summit->curvature *= translation->height * at.slope;
    }
    return status;
}

static int find(struct summit_finder *f, const double *z, bool mirrored, struct summit_list *list,
                struct error *err) {
    list->count = 0;
    if (f->stencil == SUMMITS_REFINED)
        return refine(f, z, mirrored, list, err);
    if (f->curvature != NULL)
        curvature_fill(f, z);
    const bool corners = f->stencil == SUMMITS_NINE_POINT;
    int status = 0;
    for (size_t j = 0; j < f->grid.ny && status == 0; j++) {
        struct three_rows rows = rows_at(&f->grid, z, j);
        size_t found = (mirrored ? row_pits : row_summits)(rows.up, rows.middle, rows.down,
                                                           f->grid.nx, corners, f->columns);
        for (size_t s = 0; s < found && status == 0; s++)
            status = point_add(f, z, f->columns[s], j, mirrored, list, err);
    }
    return status;
}

int summits_find(struct summit_finder *f, const double *z, struct summit_list *list,
                 struct error *err) {
    return find(f, z, false, list, err);
}

int pits_find(struct summit_finder *f, const double *z, struct summit_list *list,
              struct error *err) {
    return find(f, z, true, list, err);
}

int extremes_find(struct summit_finder *f, const double *z, size_t first, size_t count,
                  struct summit_list *summits, struct summit_list *pits, struct error *err) {
    const bool corners = f->stencil == SUMMITS_NINE_POINT;
    int status = 0;
    if (f->stencil == SUMMITS_REFINED) {
        status = first == 0 ? refine(f, z, false, summits, err) : 0;
        return status != 0 || first > 0 ? status : refine(f, z, true, pits, err);
    }
    if (f->curvature != NULL && first == 0)
        curvature_fill(f, z);
    for (size_t j = first; j < first + count && status == 0; j++) {
        struct three_rows rows = rows_at(&f->grid, z, j);
        size_t found =
            row_extremes(rows.up, rows.middle, rows.down, f->grid.nx, corners, f->columns);
        for (size_t s = 0; s < found && status == 0; s++) {
            size_t i = f->columns[s];
            bool pit = rows.middle[i] < rows.middle[i + 1 < f->grid.nx ? i + 1 : 0];
            status = point_add(f, z, i, j, pit, pit ? pits : summits, err);
        }
    }
    return status;
}
