/* Estimates of costs before a computation: CPU seconds on one core at 3 GHz, bytes, and the scatter
 * of results between realisations. Every constant in cost.c names its unit and the bench in
 * tests/bench/core that it was fitted to; estimates are within a factor of about 2. */
#ifndef RUGO_CORE_COST_H
#define RUGO_CORE_COST_H

#include "core/full/full.h"
#include "core/statistics/summits/summits.h"
#include "core/surface/surface.h"
#include <math.h>

/* Nanoseconds a point and realisation to generate a surface, non-Gaussian ones by the number of
 * iterations expected for their tolerance and heights. */
double cost_generation(const struct surface_options *options, const struct grid *grid);
/* Nanoseconds a realisation: to find the summits of such a band on a grid, or its pits. */
double cost_summits(enum summit_stencil stencil, enum summit_curvature curvature,
                    const struct grid *grid, size_t mode_x, size_t mode_y);
/* Nanoseconds a realisation: to measure moments, spectral density and autocorrelation of its
 * heights, up to the waves of the grid (core/statistics/spectra/whole_band.h). */
double cost_spectra(const struct grid *grid);
/* Nanoseconds a realisation: to draw random amplitudes, and to measure what the drawn spectrum has
 * (core/statistics/spectra/spectral_band.h) and add it up exactly. */
double cost_random_amplitudes(const struct grid *grid, size_t mode_x, size_t mode_y);
/* Returns the factor by which work on this many points slows down beyond the processor's caches. */
double cost_caches(double points);
/* ... of surfaces that are made without iterations. */
double cost_field_caches(double points);

/* CPU seconds of a linear model (core/contact) for a series of loads of one surface, by which
 * companions are planned. Values depend on such a plan: it does not follow what solvers take.
 * tolerance is that of contact_options. */
double cost_linear_contact(const struct grid *grid, double tolerance, size_t loads);
/* What a linear model solves of one surface. */
struct linear_work {
    const struct grid *grid; /* borrowed */
    size_t mode_x, mode_y;   /* highest waves of the surface */
    bool elements;           /* MODEL_LAYERED */
    bool tangent;            /* is computed; of elements always */
    double tolerance;        /* that of contact_options */
    size_t loads, densities; /* in a rising series, and those whose pressures are counted */
};
/* CPU seconds of all loads, with their areas and patches, as estimated. */
double cost_linear_loads(const struct linear_work *of);

/* The number of equations of the finite elements (core/full) on a grid, and the iterations to solve
 * them. Fitted to profiles of 128 to 2048 points and surfaces of 16 x 16 to 64 x 64, RMS slopes of
 * 0.05 to 0.5 and Poisson's ratios of 0 to 0.4999. */
struct full_size {
    double degrees_of_freedom; /* 0 where the block takes too many layers */
    double newton;             /* iterations of Newton's method a load, evenly spaced loads */
    double wide;               /* more of them for a load 0.1 E* h' further, where steps are cut */
    double linear;             /* iterations of the linear equations in each of these */
    bool factored;             /* linear is so large that the equations are factorised instead */
    bool pressures; /* elements are nearly incompressible: their pressures are unknowns */
    bool folds;     /* strains are finite: a steep face may fold and jump */
    bool overhangs; /* the face is so steep that it may overhang (core/full/full.h) */
};
struct full_size cost_full_size(const struct grid *grid, const struct block *block,
                                const struct full_options *options, double rms_slope);
/* CPU seconds for a series of loads of one surface, and bytes of the solver; 0 bytes where the
 * block takes too many layers. On profiles of 1024 to 65536 points and surfaces of 32 x 32 to
 * 192 x 192, the measured peak, with the surface and the program, was 0.96 to 1.05 of the estimate;
 * 0.45 for steep profiles, not all of which are factorised in the end. Where a surface may
 * overhang, the directions of gmres_lengthen count in full. Times of studies
 * stand in jobs/contact/METHODS.md ("Before a study runs"). Without jumps, which come beside them,
 * 32 of 35 took 0.67 to 1.3 of it. */
double cost_full_contact(const struct grid *grid, const struct full_size *size, double loads);
/* Returns the number of loads near each other whose work these rising ones take, in E* h': those
 * far from the one before are reached in several steps on steep faces. NULL: all are near. */
double cost_full_loads(const struct grid *grid, const struct full_size *size, double rms_slope,
                       size_t count, const double *loads);
/* What jumps of steep faces take of a realisation: CPU seconds in the mean and at most, and their
 * variance between realisations, of which some jump. */
struct cost_jumps {
    double seconds, variance, most;
};
static inline struct cost_jumps cost_jumps_sum(struct cost_jumps a, struct cost_jumps b) {
    return (struct cost_jumps){a.seconds + b.seconds, a.variance + b.variance, a.most + b.most};
}
/* Returns what a limit leaves to jumps beside what all realisations take: their `most`. INFINITY
 * for a limit of 0, which is none. */
static inline double cost_jumps_most(double limit, double seconds) {
    if (!(limit > 0))
        return INFINITY;
    return limit > seconds ? limit - seconds : 0;
}
/* wave: nodes of a shortest wave; pressure: the highest load, in E* h'; most: cost_jumps_most. */
struct cost_jumps cost_full_jumps(const struct grid *grid, const struct full_size *size,
                                  double wave, double rms_slope, double pressure, double most);
/* What iterations on a mesh of this size count of a limit of so many of these seconds. */
struct full_limit cost_full_limit(const struct grid *grid, const struct full_size *size,
                                  double seconds);
double cost_full_bytes(const struct grid *grid, const struct block *block,
                       const struct full_options *options, const struct full_size *size);
/* A flat that is dragged over a face with friction (core/full/friction). */
struct friction_work {
    const struct grid *grid;      /* borrowed, as the next */
    const struct full_size *load; /* of contact without friction */
    double coefficient, rms_slope, poisson;
    double pressure; /* p/(E* h') */
    double wave;     /* nodes of a shortest wave */
    double leg;      /* steps from where the flat turns to the next turn */
};
/* What a step takes. */
struct friction_size {
    double newton;   /* iterations of Newton's method */
    double linear;   /* iterations of the linear equations in each of these */
    double factored; /* factorisations; none of surfaces */
};
struct friction_size cost_friction_size(const struct friction_work *of);
/* CPU seconds of so many steps, without jumps. 48 studies of profiles of 64 to 512 points took 0.68
 * to 1.6 of the whole estimate, to which they were fitted, 11 of surfaces of 8 x 8 to 32 x 32
 * points 0.67 to 1.14, and 23 others 0.70 to 1.66: slopes of 0.05 to 1, coefficients of 0.1 to 1,
 * Poisson's ratios of 0 to 0.4999, loads of 0.02 to 0.4. Since then Newton's iterations rise less
 * with the coefficient, and paths that end before all slides take fewer steps: 20 studies took 0.7
 * to 1.25 of it, one with pressing at a load of 0.3 1.8. */
double cost_friction_steps(const struct friction_work *of, double steps);
/* As cost_full_jumps, of a path; slid: how far all of the flat slides there, over the RMS height.
 */
struct cost_jumps cost_friction_jumps(const struct friction_work *of, double slid, double most);
/* As cost_full_limit. */
struct full_limit cost_friction_limit(const struct friction_work *of, double seconds);
double cost_friction_bytes(const struct grid *grid, const struct block *block,
                           const struct full_options *options, const struct full_size *size);
/* Returns the number of Fourier transforms of a point, the unit of contact_state.work, that take as
 * long as an iteration of Newton's method on a degree of freedom. */
double cost_full_transforms(const struct grid *grid);

/* What the contact fraction of a realisation scatters with. */
struct area_scatter {
    int dimension;
    bool fixed;        /* amplitudes, of Gaussian heights */
    double long_waves; /* side of the cell in longest waves */
    double ratio;      /* of the longest and the shortest wave */
    double hurst;      /* NaN for spectra that are not self-affine */
    double skewness;   /* of the heights */
    double load;       /* p/(E* h') */
};
/* Returns the standard deviation of the contact fraction between realisations, over its mean. Of
 * 743 fractions (H 0.2 to 0.8, ratios 4 to 32, cells of 2 to 16 waves, Gaussian and Weibull heights
 * of both tails, loads 0.003 to 0.3) the scatter was 0.7 to 1.5 of it in nine of ten. */
double cost_area_scatter(const struct area_scatter *of);

#endif
