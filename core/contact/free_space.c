#include "core/contact/free_space.h"
#include "core/contact/coated_space.h"
#include "core/surface/transform.h"
#include <gsl/gsl_sf_expint.h>
#include <math.h>
#include <stdlib.h>

static const double EULER = 0.57721566490153286061;

/* The kernel is the sum of two parts, both known in closed form (F18.24). The far part is smooth:
 * its waves beyond the grid's are below erfc(SPLIT). The near part is below erfc(NEAR) of its value
 * beyond NEAR/alpha. */
static const double SPLIT = 6, NEAR = 6;
enum { MARGIN = 8 }; /* of the grid around: a part of the side */
/* A point more of the grid around: a transform of it, its symbol, and a pyramid. Two arrays are
 * wholly for free space. */
static const double AROUND_BYTES = (1 + 0.5 + 2. / 3) * sizeof(double),
                    SPARE_BYTES = 2 * sizeof(double);

static double alpha_of(const struct grid *grid) {
    return M_PI / (2 * SPLIT * grid_widest_spacing(grid));
}

/* Twice the side, so that no two points of the map meet across the padding; more for small maps, so
 * that the near part does not reach across it either. */
static size_t padded_count(size_t count, double step, double reach) {
    double near = fmin(ceil(reach / step), 1e9); /* grid_check has bounded the counts */
    size_t far = (size_t)near > count ? (size_t)near : count;
    return transform_fast_count(count + far);
}

/* A grid of the same spacings, of a profile again a profile. */
static void extend(const struct grid *grid, size_t nx, size_t ny, struct grid *out) {
    *out = *grid;
    out->nx = nx;
    out->lx = grid_dx(grid) * (double)nx;
    if (grid_is_profile(grid))
        return;
    out->ny = ny;
    out->ly = grid_dy(grid) * (double)ny;
}

void free_space_padded(const struct grid *grid, const struct block *block, struct grid *padded) {
    double reach = NEAR / alpha_of(grid);
    if (block_is_coated(block))
        reach = fmax(reach, coated_space_reach(grid));
    extend(grid, padded_count(grid->nx, grid_dx(grid), reach),
           padded_count(grid->ny, grid_dy(grid), reach), padded);
}

void free_space_around(const struct grid *grid, struct grid *around) {
    extend(grid, transform_fast_count(grid->nx + grid->nx / MARGIN),
           transform_fast_count(grid->ny + grid->ny / MARGIN), around);
}

/* Returns the far part of the displacement E* at a distance from a unit force; for a profile, from
 * a unit line load. */
static double far_kernel(const struct grid *grid, double alpha, double distance) {
    if (!grid_is_profile(grid))
        return distance > 0 ? erf(alpha * distance) / (M_PI * distance)
                            : 2 * alpha / pow(M_PI, 1.5);
    double square = alpha * distance * alpha * distance;
    if (!(square > 0))
        return (EULER + 2 * log(alpha * grid->lx)) / M_PI;
    double rest = square < 500 ? gsl_sf_expint_E1(square) : 0;
    return -(2 * log(distance / grid->lx) + rest) / M_PI;
}

/* Returns the transform of the near part. */
static double near_symbol(double alpha, double k) {
    return k > 0 ? 2 / k * erf(k / (2 * alpha)) : 2 / (alpha * sqrt(M_PI));
}

/* Returns the distance of a point of the padded grid to the first one, around either side. */
static double fold(size_t at, size_t count, double step) {
    return (double)(at <= count / 2 ? at : count - at) * step;
}

/* Fills what a coating adds to the displacement of a profile at the distance lx from a line load,
 * to which all others are relative. Padded by lx, long waves are all of it there, however few the
 * points are. */
static int coating_at_reference(const struct grid *grid, const struct block *block, double *added,
                                struct error *err) {
    struct coated_space *space = NULL;
    struct grid twice;
    extend(grid, 2 * grid->nx, 1, &twice);
    int status = coated_space_create(&space, grid, &twice, block, err);
    if (status == 0)
        *added = coated_space_far(space, grid->lx);
    coated_space_destroy(&space);
    return status;
}

/* coated: NULL without a coating. added: what is taken off its displacements. */
static void transform_far(struct transform *transform, const struct grid *grid,
                          const struct grid *padded, const struct coated_space *coated,
                          double added, double *row) {
    for (size_t j = 0; j < padded->ny; j++) {
        double y = grid_is_profile(grid) ? 0 : fold(j, padded->ny, grid_dy(grid));
        for (size_t i = 0; i < padded->nx; i++) {
            double distance = hypot(fold(i, padded->nx, grid_dx(grid)), y);
            row[i] = far_kernel(grid, alpha_of(grid), distance);
            if (coated != NULL)
                row[i] += coated_space_far(coated, distance) - added;
        }
        transform_forward_rows(transform, j, 1, row);
    }
    transform_forward_columns(transform);
}

int free_space_symbol(const struct grid *grid, const struct grid *padded, const struct block *block,
                      double *symbol, struct error *err) {
    struct transform *transform = NULL;
    struct coated_space *coated = NULL;
    double added = 0, *row = array_create(padded->nx, sizeof *row);
    int status = row == NULL
                     ? error_memory(err, padded->nx * sizeof *row, "a compliance")
                     : transform_create(&transform, padded, padded->nx / 2, padded->ny / 2, err);
    if (status == 0 && block_is_coated(block))
        status = coated_space_create(&coated, grid, padded, block, err);
    if (status == 0 && coated != NULL && grid_is_profile(grid))
        status = coating_at_reference(grid, block, &added, err);
    if (status == 0) {
        transform_far(transform, grid, padded, coated, added, row);
        const double complex *far = transform_spectrum(transform);
        double area = padded->lx * (grid_is_profile(grid) ? 1 : padded->ly);
        for (size_t mx = 0; mx <= padded->nx / 2; mx++)
            for (size_t j = 0; j < padded->ny; j++) {
                double k = transform_wave_number(padded, mx, j);
                double *out = &symbol[mx * padded->ny + j];
                *out = area * creal(far[mx * padded->ny + j]) + near_symbol(alpha_of(grid), k);
                if (coated != NULL)
                    *out += coated_space_near(coated, k);
            }
    }
    coated_space_destroy(&coated);
    transform_destroy(&transform);
    free(row);
    return status;
}

double free_space_bytes(const struct grid *grid) {
    static const struct block UNCOATED = {.model = MODEL_HALFSPACE, .height = INFINITY};
    struct grid padded, around;
    free_space_padded(grid, &UNCOATED, &padded);
    double waves = ((double)padded.nx / 2 + 1) * (double)padded.ny;
    free_space_around(grid, &around);
    double more = (double)grid_points(&around) - (double)grid_points(grid);
    return (sizeof(double _Complex) + 2 * sizeof(double)) * waves + AROUND_BYTES * more +
           SPARE_BYTES * (double)grid_points(&around);
}
