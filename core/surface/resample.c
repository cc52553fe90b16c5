#include "core/surface/surface.h"
#include "core/surface/transform.h"

/* Copies one column of modes between grids. A Nyquist mode of the coarse grid (even ny) stands for
 * two modes of a finer one, each of half its amplitude. */
static void column_copy(const double complex *from, size_t from_ny, double complex *to,
                        size_t to_ny, size_t mode_y, double factor) {
    for (size_t row = 0; row < to_ny; row++)
        to[row] = 0;
    for (size_t my = 0; my <= mode_y; my++) {
        bool split = my > 0 && 2 * my == from_ny && 2 * my < to_ny;
        double part = split ? factor / 2 : factor;
        to[my] += part * from[my];
        if (my > 0 && 2 * my != to_ny)
            to[to_ny - my] += part * from[from_ny - my];
    }
}

int surface_resample(const struct grid *from, const double *z, const struct grid *to, double *out,
                     size_t mode_x, size_t mode_y, struct error *err) {
    struct transform *coarse = NULL, *fine = NULL;
    int status = transform_create(&coarse, from, mode_x, mode_y, err);
    if (!status)
        status = transform_create(&fine, to, mode_x, mode_y, err);
    if (!status) {
        transform_forward(coarse, z);
        for (size_t mx = 0; mx <= mode_x; mx++) {
            bool split = mx > 0 && 2 * mx == from->nx && 2 * mx < to->nx;
            column_copy(transform_spectrum(coarse) + mx * from->ny, from->ny,
                        transform_spectrum(fine) + mx * to->ny, to->ny, mode_y, split ? 0.5 : 1);
        }
        transform_inverse(fine, out);
    }
    transform_destroy(&coarse);
    transform_destroy(&fine);
    return status;
}
