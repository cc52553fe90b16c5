/* Gaussian surfaces on a periodic cell that hold a measured patch and go on as a law says: draws
 * from all surfaces of the law, given the patch (FORMULAS.md, F18.49). */
#ifndef RUGO_CORE_SURFACE_CONDITIONAL_H
#define RUGO_CORE_SURFACE_CONDITIONAL_H

#include "core/random.h"
#include "core/surface/grid.h"

/* Powers are mean squares |Z|^2 of the cell's waves, one a wave of the half spectrum in the layout
 * of transform.h: power[mx*ny + row], mx = 0..nx/2. The mean height is such a wave, too. */
struct conditional_law {
    const struct grid *cell; /* borrowed */
    const double *power;     /* borrowed, (nx/2 + 1) x ny; the same for a wave and its opposite */
    double noise;            /* mean square of the noise of a measured height, above 0 */
};
/* The patch lies in the first ny rows of nx points of the cell, which has its spacing and twice its
 * sides (of profiles: 1 row as well). */
struct conditional_patch {
    size_t nx, ny;
    const double *z; /* borrowed, nx*ny; NaN: a hole, where nothing was measured */
    /* Polynomials of fewer than so many orders were taken out of the patch, so that a draw has its
     * own: 0 none, 1 the mean, 2 a plane, 3 a quadratic form. */
    int trend;
};

struct conditional_report {
    size_t points;     /* that were measured */
    size_t steps;      /* of conjugate gradients */
    double residual;   /* RMS of what the equations lack, over that of the noise */
    double held;       /* RMS difference of patch and surface, but for a trend that was taken out,
                          over that of the noise: about 1 of a patch of this law and noise */
    double power;      /* of the patch in the covariance of law and noise, d (A C A^T + N)^-1 d, a
                          point, as far as a draw shows it: 1 +- sqrt(8/points) of a patch of both */
    double difference; /* RMS difference of patch and surface, likewise */
};

/* Fills z[grid_points] with one draw. Patch and law have the same mean, 0 unless the law's power of
 * wave 0 lets it be another. Time: 20 to 2200 steps of four transforms of the cell each, most where
 * the law ends far before the points' shortest waves, noise is low and there are holes. Memory:
 * about five cells. ERROR_INPUT for a cell of other sides, a patch of holes alone or noise that is
 * not above 0; ERROR_NUMERIC where the equations are not solved; ERROR_MEMORY. */
int conditional_draw(const struct conditional_law *law, const struct conditional_patch *patch,
                     struct random_key key, double *z, struct conditional_report *report,
                     struct error *err);

/* Fills z[grid_points] with a surface of the law that knows of no patch, from the same random
 * numbers. ERROR_MEMORY. */
int conditional_free_draw(const struct conditional_law *law, struct random_key key, double *z,
                          struct error *err);
/* Fills out[n] with independent Gaussian numbers of mean 0 and mean square 1, those that the noise
 * of a patch has. */
void conditional_noise(struct random_key key, size_t n, double *out);

#endif
