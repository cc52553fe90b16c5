#include "core/cost.h"
#include "core/full/linear/gmres.h"
#include "core/statistics/heights/roughness.h"
#include "core/statistics/summits/refined.h"
#include <gsl/gsl_cdf.h>

/* --- surfaces --- */

/* Nanoseconds a point of a Gaussian surface (bench_surface). */
static const double GAUSSIAN_NS = 6;
/* ... and of a table look-up of its height, with random amplitudes. */
static const double TRANSLATION_NS = 3;
/* bench_nongaussian: nanoseconds a point and iteration; iterations after which plain alternation
 * stalls; plain iterations after the relaxed ones. */
static const double ITERATION_NS = 15, PLAIN_ITERATIONS = 120, LAST_ITERATIONS = 3;
/* As above, for iterations that rank by a table: nanoseconds, and the number after which they
 * stall. */
static const double FAST_ITERATION_NS = 9.5, FAST_ITERATIONS = 65;
/* Iterations that reach the tolerance: REACH (tolerance sqrt(points))^-FALL + SKEWED skewness^2,
 * because eps_h converges to about 1/sqrt(points). Within a factor of 2 of the counts for Weibull
 * shapes 1 to 3.602 and lognormal heights, surfaces of 256 x 256 to 1024 x 1024 and tolerances of
 * 0.003 to 0.03. */
static const double REACH = 56, FALL = 0.8, SKEWED = 5;
/* Nanoseconds of refined summits a point of their fine grid, and of spectral curvatures a point of
 * the grid (bench_summits). */
static const double REFINED_NS = 6, SPECTRAL_CURVATURE_NS = 4;
/* Nanoseconds a point of the spectra of heights (bench_statistics, translated surfaces), beside
 * those of rings below. */
static const double SPECTRA_NS = 10;
/* Random amplitudes (bench_statistics): nanoseconds a mode of the half plane, to be drawn and
 * summed; a point, for the field of the autocorrelation; a value of a ring, for exact sums. Fitted
 * to 512 x 512 and 1024 x 1024 points and profiles of 4096 and 65536, 2 to 16 a shortest wave. */
static const double RANDOM_MODE_NS = 30, FIELD_NS = 1, RING_NS = 40;
/* Relative increase of a surface's time a point with each doubling of the points from 2^20 on
 * (bench_surface): of iterations, and of one transform (gaussian-nayak, up to 2^26 points). */
static const double CACHE_SLOPE = 0.4, FIELD_CACHE_SLOPE = 0.12, CACHE_DOUBLINGS = 20;

/* Returns the number of fast iterations until they stall or reach the tolerance. */
static double fast_iterations(const struct surface_options *options, const struct grid *grid) {
    struct height_moments moments;
    double tolerance = options->tolerance_h > 0 ? options->tolerance_h : options->tolerance;
    double reach = grid != NULL ? tolerance * sqrt((double)grid_points(grid)) : 0;
    if (!(reach > 0) || heights_moments(&options->heights, &moments, NULL) != 0)
        return FAST_ITERATIONS;
    double reached = REACH * pow(reach, -FALL) + SKEWED * moments.skewness * moments.skewness;
    return fmin(FAST_ITERATIONS, reached);
}

double cost_generation(const struct surface_options *options, const struct grid *grid) {
    double nanoseconds = GAUSSIAN_NS;
    if (options->heights.type != HEIGHTS_GAUSSIAN && options->law == LAW_TRANSLATION)
        return nanoseconds + TRANSLATION_NS;
    if (!surface_is_iterated(options))
        return nanoseconds;
    double most = (double)options->max_iterations;
    if (options->iteration == ITERATION_PLAIN)
        return nanoseconds + fmin(PLAIN_ITERATIONS, most) * ITERATION_NS;
    if (options->iteration == ITERATION_RELAXED)
        return nanoseconds +
               fmin((double)options->relaxed_iterations + LAST_ITERATIONS, most) * ITERATION_NS;
    return nanoseconds + fmin(fast_iterations(options, grid), most) * FAST_ITERATION_NS +
           fmin(LAST_ITERATIONS, most) * ITERATION_NS;
}

double cost_summits(enum summit_stencil stencil, enum summit_curvature curvature,
                    const struct grid *grid, size_t mode_x, size_t mode_y) {
    if (stencil == SUMMITS_REFINED)
        return REFINED_NS * refined_points(grid, mode_x, mode_y);
    return curvature == CURVATURE_SPECTRAL ? SPECTRAL_CURVATURE_NS * (double)grid_points(grid) : 0;
}

double cost_spectra(const struct grid *grid) {
    double rings = (double)radial_bins(grid) + (double)acf_lags(grid);
    return SPECTRA_NS * (double)grid_points(grid) + RING_NS * rings;
}

double cost_random_amplitudes(const struct grid *grid, size_t mode_x, size_t mode_y) {
    double modes = (double)(mode_x + 1) * (double)(2 * mode_y + 1);
    double rings = hypot((double)mode_x, (double)mode_y) + (double)acf_lags(grid);
    return RANDOM_MODE_NS * modes + FIELD_NS * (double)grid_points(grid) + RING_NS * rings;
}

static double caches(double points, double slope) {
    return 1 + slope * fmax(0, log2(points) - CACHE_DOUBLINGS);
}

double cost_caches(double points) {
    return caches(points, CACHE_SLOPE);
}

double cost_field_caches(double points) {
    return caches(points, FIELD_CACHE_SLOPE);
}

/* Returns the points a side; of a rectangle the geometric mean, which is exact for squares. */
static double mean_side(const struct grid *grid) {
    return grid_is_profile(grid) ? (double)grid->nx : sqrt((double)grid->nx * (double)grid->ny);
}

/* --- linear contact, as it is planned by: constants that stay, whatever solvers take today --- */

/* Transforms a load at a tolerance of 1e-8 are FRONT * nx^POWER. Few loads are farther apart and
 * take more each. */
static const double PLAN_PROFILE_FRONT = 30, PLAN_PROFILE_POWER = 0.18,
                    PLAN_PROFILE_FEW_LOADS = 1.5;
static const double PLAN_SURFACE_FRONT = 32, PLAN_SURFACE_POWER = 0.125,
                    PLAN_SURFACE_FEW_LOADS = 0.2;
/* The tolerance enters by the factor (digits + 2)/10. */
static const double PLAN_DIGITS_MORE = 2, PLAN_DIGITS_WHOLE = 10;
/* Nanoseconds a point and transform; a tenth more with each doubling of the points from 2^14 on. */
static const double PLAN_PROFILE_TRANSFORM_NS = 4, PLAN_SURFACE_TRANSFORM_NS = 9;
static const double PLAN_TRANSFORM_CACHE_SLOPE = 0.1, PLAN_TRANSFORM_CACHE_DOUBLINGS = 14;

static double planned_transforms(const struct grid *grid, double tolerance, size_t loads) {
    double side = mean_side(grid), digits = -log10(tolerance);
    bool profile = grid_is_profile(grid);
    double transforms = profile ? PLAN_PROFILE_FRONT * pow(side, PLAN_PROFILE_POWER)
                                : PLAN_SURFACE_FRONT * pow(side, PLAN_SURFACE_POWER);
    double few_loads = profile ? PLAN_PROFILE_FEW_LOADS : PLAN_SURFACE_FEW_LOADS;
    return transforms * (1 + few_loads / (double)loads) * (PLAN_DIGITS_MORE + digits) /
           PLAN_DIGITS_WHOLE;
}

double cost_linear_contact(const struct grid *grid, double tolerance, size_t loads) {
    double points = (double)grid_points(grid);
    double nanoseconds =
        grid_is_profile(grid) ? PLAN_PROFILE_TRANSFORM_NS : PLAN_SURFACE_TRANSFORM_NS;
    nanoseconds *=
        1 + PLAN_TRANSFORM_CACHE_SLOPE * fmax(0, log2(points) - PLAN_TRANSFORM_CACHE_DOUBLINGS);
    return 1e-9 * nanoseconds * points * planned_transforms(grid, tolerance, loads) * (double)loads;
}

/* --- linear contact, as it is estimated --- */

/* Transforms a load with its tangent at a tolerance of 1e-8 are FRONT nx^POWER (1 + FEW/loads), of
 * profiles of 512 to 131072 nodes and surfaces of 64 to 1024 a side, 3 to 30 loads up to 0.3. */
static const double PROFILE_FRONT = 16, PROFILE_POWER = 0.22, PROFILE_FEW = 2;
static const double SURFACE_FRONT = 21.4, SURFACE_POWER = 0.137, SURFACE_FEW = 1.4;
/* The tolerance enters by the factor (digits + 3)/11. Without the tangent there are fewer
 * transforms, on meshes more, and two of each load for its area. */
static const double DIGITS_MORE = 3, DIGITS_WHOLE = 11;
static const double WITHOUT_TANGENT = 0.76, ON_ELEMENTS = 1.15, ELEMENTS_AREA = 2;
/* Nanoseconds a point and transform, with the other work of an iteration; SLOPE more with each
 * doubling of the points from DOUBLINGS on. */
static const double PROFILE_TRANSFORM_NS = 5.5, SURFACE_TRANSFORM_NS = 7.5;
static const double PROFILE_CACHE_SLOPE = 0.15, PROFILE_CACHE_DOUBLINGS = 12;
static const double SURFACE_CACHE_SLOPE = 0.1, SURFACE_CACHE_DOUBLINGS = 14;
/* Areas and patches take nanoseconds a point, and of each edge on a grid line; the pressures of a
 * load as many times that. Lines have so many edges for a shortest wave. */
static const double POINT_NS = 40, EDGE_NS = 1000, EDGES_A_WAVE = 0.65, DENSITY_TIMES = 1.4;

static double load_transforms(const struct linear_work *of) {
    double side = mean_side(of->grid), loads = (double)of->loads;
    bool profile = grid_is_profile(of->grid), tangent = of->elements || of->tangent;
    double transforms = profile ? PROFILE_FRONT * pow(side, PROFILE_POWER)
                                : SURFACE_FRONT * pow(side, SURFACE_POWER);
    transforms *= 1 + (profile ? PROFILE_FEW : SURFACE_FEW) / loads;
    transforms *= (DIGITS_MORE - log10(of->tolerance)) / DIGITS_WHOLE;
    transforms *= (tangent ? 1 : WITHOUT_TANGENT) * (of->elements ? ON_ELEMENTS : 1);
    return transforms + (of->elements ? ELEMENTS_AREA : 0);
}

/* Returns the nanoseconds a point of the areas of a load. */
static double area_nanoseconds(const struct linear_work *of) {
    const struct grid *grid = of->grid;
    double waves = (double)of->mode_x / (double)grid->nx;
    if (!grid_is_profile(grid))
        waves += (double)of->mode_y / (double)grid->ny;
    return POINT_NS + EDGE_NS * EDGES_A_WAVE * fmin(waves, 1);
}

double cost_linear_loads(const struct linear_work *of) {
    double points = (double)grid_points(of->grid), loads = (double)of->loads;
    bool profile = grid_is_profile(of->grid);
    double slope = profile ? PROFILE_CACHE_SLOPE : SURFACE_CACHE_SLOPE;
    double doublings = profile ? PROFILE_CACHE_DOUBLINGS : SURFACE_CACHE_DOUBLINGS;
    double nanoseconds = profile ? PROFILE_TRANSFORM_NS : SURFACE_TRANSFORM_NS;
    double transform = nanoseconds * (1 + slope * fmax(0, log2(points) - doublings));
    double area = area_nanoseconds(of) * (loads + DENSITY_TIMES * (double)of->densities);
    return 1e-9 * points * (transform * load_transforms(of) * loads + area);
}

/* --- finite elements (bench_full) --- */

/* Iterations of Newton's method a load, of profiles and of surfaces: `least`, `doubling` for each
 * doubling of nx, `steep` h' with h' the RMS slope, the share `pressures` of it where these are
 * unknowns. Materials that give sideways, nu below UPRIGHT, have load steps cut on slopes above
 * GENTLE, which takes `wide` (h' - GENTLE)(UPRIGHT - nu) sqrt(nx/wide_side) more for each 0.1 E* h'
 * of load. */
struct newton_fit {
    double least, doubling, steep, pressures, wide, wide_side;
};
static const struct newton_fit PROFILE_NEWTON = {1.2, 0.18, 4.5, 0.95, 85, 128},
                               SURFACE_NEWTON = {0.6, 0.57, 1.8, 0.8, 125, 16};
static const double GENTLE = 0.3, UPRIGHT = 0.3;
/* A load further than FAR/h' from the one before it is approached in steps: of lengths l in E* h',
 * FAR_STEPS (l h' - FAR) more loads' work. One nearer than 0.1 takes (l/0.1)^NEAR_POWER. */
static const double FAR = 0.11, PROFILE_FAR_STEPS = 60, SURFACE_FAR_STEPS = 15, NEAR_POWER = 0.15;
static const double USUAL_LOAD = 0.1; /* p/(E* h') */
/* Steep faces fold and jump, some of them: a realisation does at a normal distribution's share of
 * those below (h' + JUMP_LOAD ln(p/0.1) - jump_slope)/jump_width at the highest load p, and more in
 * cells of more than JUMP_WAVES shortest waves. A jump takes so many iterations as `newton`, with
 * `linear` of the linear equations in each (0: as many as in others), and factorisations, e times
 * more or less. */
struct jump_fit {
    double slope, pressures_slope, width, pressures_width, newton, linear, factored;
};
static const struct jump_fit PROFILE_JUMP = {1, 0.97, 0.15, 0.22, 300, 20, 160},
                             SURFACE_JUMP = {1.75, 1.75, 0.25, 0.25, 150, 0, 0};
static const double JUMP_LOAD = 0.02, JUMP_WAVES = 16;
/* Variances of the time of a jump over its square, without and with friction. Fewer jumps a
 * realisation than RARE are not counted. */
static const double JUMP_SPREAD = 1, SLIDE_SPREAD = 2.2, RARE = 0.01;
/* Iterations of the linear equations: LINEAR_LEAST + STEEP h' (1 + h') (0.4 min(B, 10))^0.6
 * (nx/SIDE)^SIDE_POWER, with B = 1/(1 - 2 nu), about the bulk over the shear modulus, and at least
 * 1 for the power. With pressures as unknowns it is LINEAR_PRESSURES, and there are PRESSURE_TENS
 * more for each factor of 10 by which B is above that of the flat block (gmres.c). */
static const double LINEAR_LEAST = 1.6, PROFILE_STEEP = 10, SURFACE_STEEP = 6;
static const double PROFILE_SIDE = 512, SURFACE_SIDE = 32, SIDE_POWER = 0.15;
static const double BULK_FRONT = 0.4, BULK_MOST = 10, BULK_POWER = 0.6, LINEAR_PRESSURES = 1.65;
static const double PROFILE_TENS = 0.65, PROFILE_BULK = 60, SURFACE_TENS = 2.2, SURFACE_BULK = 300;
/* Equations of profiles that need more iterations are factorised (core/full/newton.h). */
static const double FACTORED_ITERATIONS = 30;
/* Nanoseconds a degree of freedom: of an iteration of Newton's method without its linear equations,
 * of an iteration of these, more of it for each of them in a step, of the pressures in it, and of
 * an iteration of Newton's method with a factorisation. */
struct full_fit {
    double newton, linear, each, pressures, factored;
};
static const struct full_fit PROFILE_FULL = {400, 55, 2.5, 35, 1e4},
                             SURFACE_FULL = {1800, 130, 4, 60, 7e4};
/* They hold for so many degrees of freedom or more, and rise by this power of fewer. */
static const double FULL_FREEDOM = 40000, CACHE_POWER = 0.2, FACTOR_CACHE_POWER = 0.4;
/* Arrays take so many times their bytes, with what heaps keep between them. */
static const double MEMORY_ROOM = 1.03;
/* Iterations of the linear equations of a step, over their mean, at most. */
static const double ITERATIONS_MOST = 3;
/* Of random faces only those of higher RMS slopes overhang. */
static const double OVERHANG_SLOPE = 0.7;
/* Bytes a degree of freedom of a factorisation. */
static const double FACTOR_BYTES = 900;
/* Number of transforms of a point that take the time of an iteration of Newton's method on a degree
 * of freedom. */
static const double PROFILE_TRANSFORMS = 95, SURFACE_TRANSFORMS = 280;

/* Of profiles, with friction: nanoseconds a degree of freedom of an iteration of Newton's method
 * without its linear equations, of a solution with the factors, and of a factorisation, which rise
 * by these powers of the degrees of freedom over FRICTION_FREEDOM; bytes with those of the factors.
 */
static const double FRICTION_NEWTON_NS = 470, FRICTION_SOLVE_NS = 110, FRICTION_FACTOR_NS = 4000;
static const double FRICTION_FREEDOM = 2000, SOLVE_POWER = 0.45, FACTOR_POWER = 0.25;
static const double FRICTION_BYTES = 2100;
/* Of profiles, a step takes NEWTON (w/4)^NEWTON_FINER e^(NEWTON_STEEP s) (n/20)^-NEWTON_SHORT
 * (p/0.1)^NEWTON_LOAD iterations of Newton's method, with w nodes a shortest wave, s the sum of the
 * coefficient and h', n steps from a turn to the next and the load p. Each of them takes
 * SOLVES e^(SOLVES_STEEP s) solutions, and a step FACTORED factorisations. Rubber, with pressures
 * as unknowns, takes these parts more, and FACTORED_RUBBER (w/4)^FACTORED_FINER e^(FACTORED_STEEP
 * s) h'^FACTORED_SLOPE factorisations more, at a bulk modulus of 10^RUBBER_DECADES shear moduli. */
static const double STEP_NEWTON = 1.8, NEWTON_FINER = 0.28, NEWTON_STEEP = 0.2, NEWTON_SHORT = 0.2,
                    NEWTON_LOAD = 0.12, NEWTON_RUBBER = 0.17;
static const double STEP_SOLVES = 6.8, SOLVES_STEEP = 0.15, SOLVES_RUBBER = 0.28;
static const double STEP_FACTORED = 0.1, FACTORED_RUBBER = 0.24, FACTORED_FINER = 0.5,
                    FACTORED_STEEP = 1.27, FACTORED_SLOPE = 0.32;
static const double WAVE_NODES = 4, LEG_STEPS = 20, RUBBER_DECADES = 3.7;
/* A profile that slides jumps so often a path of an RMS height and JUMP_WAVES shortest waves: as a
 * normal distribution's share below (mu h' (p/0.1)^SLIDE_JUMP_LOAD - SLIDE_JUMP)/SLIDE_JUMP_WIDTH.
 * A jump takes so many iterations of Newton's method, and factorisations in each. */
static const double SLIDE_JUMP = 0.38, SLIDE_JUMP_WIDTH = 0.06, SLIDE_JUMP_LOAD = 0.4;
static const double SLIDE_JUMP_NEWTON = 900, SLIDE_JUMP_FACTORED = 0.02;
/* Of surfaces, iterations of a step over those of a load without friction: Newton's, and of the
 * linear equations. Bytes of a degree of freedom, more with pressures. */
static const double SURFACE_FRICTION_NEWTON = 0.8, SURFACE_FRICTION_LINEAR = 1.4;
static const double SURFACE_FRICTION_BYTES = 510, SURFACE_PRESSURE_BYTES = 100;

static double newton_iterations(const struct newton_fit *fit, const struct grid *grid,
                                bool pressures, double rms_slope) {
    double all = fit->least + fit->doubling * log2(mean_side(grid)) + fit->steep * rms_slope;
    return pressures ? fit->pressures * all : all;
}

static double wide_iterations(const struct newton_fit *fit, const struct grid *grid, double poisson,
                              double rms_slope) {
    return fit->wide * fmax(0, rms_slope - GENTLE) * fmax(0, UPRIGHT - poisson) *
           sqrt(mean_side(grid) / fit->wide_side);
}

/* Returns the iterations of the linear equations in one of Newton's. */
static double linear_iterations(const struct grid *grid, double poisson, bool pressures,
                                double rms_slope) {
    bool profile = grid_is_profile(grid);
    double bulk = 1 / (1 - 2 * poisson);
    double steep = (profile ? PROFILE_STEEP : SURFACE_STEEP) * rms_slope * (1 + rms_slope) *
                   pow(mean_side(grid) / (profile ? PROFILE_SIDE : SURFACE_SIDE), SIDE_POWER);
    if (!pressures)
        return LINEAR_LEAST + steep * pow(fmax(1, BULK_FRONT * fmin(bulk, BULK_MOST)), BULK_POWER);
    double above = bulk / (profile ? PROFILE_BULK : SURFACE_BULK);
    return LINEAR_LEAST + LINEAR_PRESSURES * steep +
           (profile ? PROFILE_TENS : SURFACE_TENS) * log10(fmax(1, above));
}

struct full_size cost_full_size(const struct grid *grid, const struct block *block,
                                const struct full_options *options, double rms_slope) {
    bool profile = grid_is_profile(grid);
    const struct newton_fit *fit = profile ? &PROFILE_NEWTON : &SURFACE_NEWTON;
    struct material material = material_of(block->poisson, options->kinematics);
    bool pressures = gmres_needs_pressures(&material);
    struct full_size size = {
        .degrees_of_freedom = (double)full_degrees_of_freedom(grid, block, options),
        .newton = newton_iterations(fit, grid, pressures, rms_slope),
        .wide = wide_iterations(fit, grid, block->poisson, rms_slope),
        .linear = linear_iterations(grid, block->poisson, pressures, rms_slope),
        .pressures = pressures,
        .folds = options->kinematics != KINEMATICS_SMALL};
    size.overhangs = size.folds && rms_slope > OVERHANG_SLOPE;
    size.factored = profile && size.linear > FACTORED_ITERATIONS;
    return size;
}

/* Returns what iterations take, by so many nanoseconds a degree of freedom: less on small meshes,
 * which stay in the caches. `linear` is an iteration of the linear equations. */
static struct full_fit nanoseconds(const struct grid *grid, const struct full_size *size) {
    struct full_fit out = grid_is_profile(grid) ? PROFILE_FULL : SURFACE_FULL;
    const double part = fmin(1, pow(size->degrees_of_freedom / FULL_FREEDOM, CACHE_POWER));
    out.linear += out.each * size->linear + (size->pressures ? out.pressures : 0);
    out.newton *= part;
    out.linear *= part;
    out.factored *= fmin(1, pow(size->degrees_of_freedom / FULL_FREEDOM, FACTOR_CACHE_POWER));
    return out;
}

struct full_limit cost_full_limit(const struct grid *grid, const struct full_size *size,
                                  double seconds) {
    const struct full_fit each = nanoseconds(grid, size);
    const double unit = 1e-9 * size->degrees_of_freedom;
    return (struct full_limit){.seconds = seconds,
                               .newton = unit * each.newton,
                               .linear = unit * each.linear,
                               .factored = unit * each.factored};
}

/* In E* h': all touches long before it, and what lies beyond is one step or no solution. */
static const double LOAD_REACHED = 10;

double cost_full_loads(const struct grid *grid, const struct full_size *size, double rms_slope,
                       size_t count, const double *loads) {
    const double steps = grid_is_profile(grid) ? PROFILE_FAR_STEPS : SURFACE_FAR_STEPS;
    const double wide = size->folds ? size->wide / size->newton : 0;
    double all = loads != NULL ? 0 : (double)count * (1 + wide);
    for (size_t l = 0; loads != NULL && l < count; l++) {
        double length =
            fmin(loads[l], LOAD_REACHED) - (l > 0 ? fmin(loads[l - 1], LOAD_REACHED) : 0);
        all += pow(fmin(1, fmax(0, length) / USUAL_LOAD), NEAR_POWER) +
               steps * fmax(0, length * rms_slope - FAR) + wide * length / USUAL_LOAD;
    }
    return all;
}

/* Returns what so many jumps take in the mean: each of these seconds, with a variance of `spread`
 * times their square, and all no more than `most`. What lies between 0 and `most` has a variance of
 * a quarter of its square at most. */
static struct cost_jumps jumps_of(double number, double seconds, double spread, double most) {
    const double each = fmin(seconds, most);
    if (!(number > 0))
        return (struct cost_jumps){0};
    return (struct cost_jumps){.seconds = fmin(number * each, most),
                               .variance =
                                   fmin((1 + spread) * number * each * each, most * most / 4),
                               .most = most};
}

/* Returns how many cells of JUMP_WAVES shortest waves a cell is worth, each of so many nodes. */
static double cell_share(const struct grid *grid, double wave) {
    return (double)grid->nx / wave / JUMP_WAVES;
}

struct cost_jumps cost_full_jumps(const struct grid *grid, const struct full_size *size,
                                  double wave, double rms_slope, double pressure, double most) {
    const struct jump_fit *fit = grid_is_profile(grid) ? &PROFILE_JUMP : &SURFACE_JUMP;
    const double slope = rms_slope + JUMP_LOAD * log(pressure / USUAL_LOAD);
    const double least = size->pressures ? fit->pressures_slope : fit->slope;
    const double width = size->pressures ? fit->pressures_width : fit->width;
    const double number =
        gsl_cdf_ugaussian_P((slope - least) / width) * fmax(1, cell_share(grid, wave));
    struct full_size within = *size;
    within.linear = fit->linear > 0 ? fit->linear : size->linear;
    const struct full_limit each = cost_full_limit(grid, &within, 0);
    return jumps_of(number > RARE && size->folds ? number : 0,
                    fit->newton * (each.newton + within.linear * each.linear) +
                        fit->factored * each.factored,
                    JUMP_SPREAD, most);
}

double cost_full_contact(const struct grid *grid, const struct full_size *size, double loads) {
    const struct full_limit each = cost_full_limit(grid, size, 0);
    double newton = size->factored ? each.factored : each.newton + each.linear * size->linear;
    return newton * size->newton * loads;
}

double cost_full_bytes(const struct grid *grid, const struct block *block,
                       const struct full_options *options, const struct full_size *size) {
    double most = ITERATIONS_MOST * size->linear;
    double bytes = MEMORY_ROOM * full_bytes(grid, block, options, most, size->overhangs);
    if (size->factored || (size->overhangs && grid_is_profile(grid)))
        bytes += FACTOR_BYTES * size->degrees_of_freedom;
    return isnan(bytes) ? 0 : bytes;
}

static struct friction_size surface_step(const struct friction_work *of) {
    return (struct friction_size){.newton = SURFACE_FRICTION_NEWTON * of->load->newton,
                                  .linear = SURFACE_FRICTION_LINEAR * of->load->linear};
}

/* Returns how far a block is rubber, from 0 to 1. */
static double rubber_share(const struct friction_work *of) {
    const double decades = -log10(1 - 2 * of->poisson);
    return of->load->pressures ? fmin(1, fmax(0, decades - 1) / (RUBBER_DECADES - 1)) : 0;
}

static struct friction_size profile_step(const struct friction_work *of) {
    const double steep = of->coefficient + of->rms_slope, finer = of->wave / WAVE_NODES;
    const double rubber = rubber_share(of);
    const double factored = pow(finer, FACTORED_FINER) * exp(FACTORED_STEEP * steep) *
                            pow(of->rms_slope, FACTORED_SLOPE);
    return (struct friction_size){
        .newton = STEP_NEWTON * pow(finer, NEWTON_FINER) * exp(NEWTON_STEEP * steep) *
                  pow(of->leg / LEG_STEPS, -NEWTON_SHORT) *
                  pow(of->pressure / USUAL_LOAD, NEWTON_LOAD) * (1 + rubber * NEWTON_RUBBER),
        .linear = STEP_SOLVES * exp(SOLVES_STEEP * steep) * (1 + rubber * SOLVES_RUBBER),
        .factored = STEP_FACTORED + rubber * FACTORED_RUBBER * factored};
}

struct friction_size cost_friction_size(const struct friction_work *of) {
    return grid_is_profile(of->grid) ? profile_step(of) : surface_step(of);
}

struct full_limit cost_friction_limit(const struct friction_work *of, double seconds) {
    const double freedom = of->load->degrees_of_freedom, over = freedom / FRICTION_FREEDOM;
    if (!grid_is_profile(of->grid)) {
        struct full_size step = *of->load;
        step.linear = surface_step(of).linear;
        return cost_full_limit(of->grid, &step, seconds);
    }
    return (struct full_limit){
        .seconds = seconds,
        .newton = 1e-9 * freedom * FRICTION_NEWTON_NS,
        .linear = 1e-9 * freedom * FRICTION_SOLVE_NS * pow(over, SOLVE_POWER),
        .factored = 1e-9 * freedom * FRICTION_FACTOR_NS * pow(over, FACTOR_POWER)};
}

double cost_friction_steps(const struct friction_work *of, double steps) {
    const struct friction_size step = cost_friction_size(of);
    const struct full_limit each = cost_friction_limit(of, 0);
    return steps * (step.newton * (each.newton + step.linear * each.linear) +
                    step.factored * each.factored);
}

struct cost_jumps cost_friction_jumps(const struct friction_work *of, double slid, double most) {
    const double steep =
        of->coefficient * of->rms_slope * pow(of->pressure / USUAL_LOAD, SLIDE_JUMP_LOAD);
    const double share = gsl_cdf_ugaussian_P((steep - SLIDE_JUMP) / SLIDE_JUMP_WIDTH);
    const bool jump = grid_is_profile(of->grid) && of->load->folds && share > RARE;
    const struct full_limit each = cost_friction_limit(of, 0);
    const double newton = each.newton + cost_friction_size(of).linear * each.linear +
                          SLIDE_JUMP_FACTORED * each.factored;
    return jumps_of(jump ? share * slid * cell_share(of->grid, of->wave) : 0,
                    SLIDE_JUMP_NEWTON * newton, SLIDE_SPREAD, most);
}

double cost_friction_bytes(const struct grid *grid, const struct block *block,
                           const struct full_options *options, const struct full_size *size) {
    double bytes = FRICTION_BYTES;
    if (!grid_is_profile(grid))
        bytes = SURFACE_FRICTION_BYTES + (size->pressures ? SURFACE_PRESSURE_BYTES : 0);
    return cost_full_bytes(grid, block, options, size) + bytes * size->degrees_of_freedom;
}

double cost_full_transforms(const struct grid *grid) {
    return grid_is_profile(grid) ? PROFILE_TRANSFORMS : SURFACE_TRANSFORMS;
}

/* --- scatter --- */

/* A cell of n longest waves holds about n^dimension independent parts of surface, of which fewer
 * bear a light load, and more where short waves have a larger share. Logarithms of the scatter
 * times n^(dimension/2), about the load 0.03 and the ratio 4, fitted by least squares. A cell that
 * few patches bear scatters no more than SCATTER_MOST. */
struct scatter_fit {
    double mean, load, ratio, ratio_hurst, hurst, fixed, fixed_load, skewness, skewness_load,
        skewness_ratio, load_ratio;
};
static const struct scatter_fit SCATTER_FITS[] = {
    {-1.006, -0.250, -0.346, 0.200, 0.137, -0.192, -0.047, 0.193, 0.017, -0.001, -0.068},
    {-1.613, -0.348, -0.845, 0.506, 0.300, -0.366, -0.136, 0.377, 0.031, -0.096, -0.059}};
static const double SCATTER_MOST = 0.4, SCATTER_LOAD = 0.03, SCATTER_RATIO = 4, SCATTER_HURST = 0.8,
                    SKEWNESS_MOST = 2;

double cost_area_scatter(const struct area_scatter *of) {
    const struct scatter_fit *fit = &SCATTER_FITS[of->dimension - 1];
    double load = log(of->load / SCATTER_LOAD), ratio = log(of->ratio / SCATTER_RATIO);
    double hurst = isnan(of->hurst) ? SCATTER_HURST : of->hurst;
    double skewness = fmax(-SKEWNESS_MOST, fmin(of->skewness, SKEWNESS_MOST));
    double logarithm = fit->mean + fit->load * load + fit->ratio * ratio +
                       fit->ratio_hurst * ratio * hurst + fit->hurst * hurst +
                       fit->skewness * skewness + fit->skewness_load * skewness * load +
                       fit->skewness_ratio * skewness * ratio + fit->load_ratio * load * ratio;
    if (of->fixed)
        logarithm += fit->fixed + fit->fixed_load * load;
    return fmin(exp(logarithm) * pow(of->long_waves, -of->dimension / 2.0), SCATTER_MOST);
}
