#include "core/surface/nongaussian.h"
#include "core/surface/height_error.h"
#include "core/surface/rank.h"
#include "core/surface/target_heights.h"
#include <fftw3.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The relaxed phase runs on so many points a shortest wave: a band-limited surface is the same on
 * any grid that resolves it, and four points sample its heights well enough to choose phases by. */
enum { RELAXED_POINTS = 4, RELAXED_SIDE = 64, RELAXED_LENGTH = 4096 };

/* Plain iterations after the relaxed ones, on the whole grid: see nongaussian_run. */
enum { POLISHING = 3 };

/* A grid and what an iteration on it needs. Heights are in standard deviations throughout. */
struct stage {
    struct grid grid;
    struct ranker *ranker;
    double *sorted; /* target heights, rising */
    double *x;      /* relaxed phase: the iterate */
    double *y;      /* relaxed phase: its reflection; NULL for the whole grid, where z serves */
    double *h;      /* z_h */
};

struct nongaussian {
    const struct modes *modes;
    struct surface_options options;
    struct height_moments moments;
    double deviation;   /* sqrt(m00) of modes */
    double *amplitude;  /* sqrt(power)/deviation, laid out as modes->power */
    struct stage whole; /* the grid of modes */
    struct stage
        thin; /* the grid of the relaxed phase; its ranker is NULL when that is the whole */
    struct transform *thin_transform;
    struct height_error *height_error;
};

/* The least 2^a 3^b 5^c, even, not below n: FFTW is quick on these. */
static size_t smooth_side(size_t n) {
    for (size_t side = n + n % 2;; side += 2) {
        size_t rest = side;
        for (size_t factor = 2; factor <= 5; factor++)
            while (rest % factor == 0)
                rest /= factor;
        if (rest == 1)
            return side;
    }
}

/* The grid of the relaxed phase: thinner where that saves at least a third of the points. */
static struct grid relaxed_grid(const struct grid *grid, size_t mode_x, size_t mode_y) {
    struct grid thin = *grid;
    size_t least = grid_is_profile(grid) ? RELAXED_LENGTH : RELAXED_SIDE;
    size_t x = RELAXED_POINTS * mode_x;
    size_t y = RELAXED_POINTS * mode_y;
    thin.nx = smooth_side(x > least ? x : least);
    if (thin.nx > grid->nx)
        thin.nx = grid->nx;
    if (!grid_is_profile(grid)) {
        thin.ny = smooth_side(y > least ? y : least);
        if (thin.ny > grid->ny)
            thin.ny = grid->ny;
    }
    return grid_points(&thin) <= grid_points(grid) / 3 * 2 ? thin : *grid;
}

static int stage_create(struct stage *stage, const struct grid *grid, bool with_x, bool with_y,
                        struct error *err) {
    size_t n = grid_points(grid);
    stage->grid = *grid;
    int status = ranker_create(&stage->ranker, n, err);
    if (status)
        return status;
    stage->sorted = fftw_alloc_real(n);
    stage->h = fftw_alloc_real(n);
    stage->x = with_x ? fftw_alloc_real(n) : NULL;
    stage->y = with_y ? fftw_alloc_real(n) : NULL;
    if (!stage->sorted || !stage->h || (with_x && !stage->x) || (with_y && !stage->y))
        return error_memory(err, n * sizeof(double), "heights of one iteration");
    return 0;
}

static void stage_clear(struct stage *stage) {
    ranker_destroy(&stage->ranker);
    fftw_free(stage->sorted);
    fftw_free(stage->h);
    fftw_free(stage->x);
    fftw_free(stage->y);
}

static bool is_whole(const struct grid *thin, const struct grid *grid) {
    return thin->nx == grid->nx && thin->ny == grid->ny;
}

static int options_check(const struct surface_options *o, struct error *err) {
    if (!(o->tolerance >= 0 && isfinite(o->tolerance)))
        return error_set(err, ERROR_INPUT, "tolerance = %g; allowed: 0 or more", o->tolerance);
    if (!(o->stall_gain >= 0 && o->stall_gain < 1))
        return error_set(err, ERROR_INPUT, "stall gain = %g; allowed: 0 to below 1", o->stall_gain);
    if (o->stall_iterations < 1 || o->max_iterations < 1)
        return error_set(err, ERROR_INPUT,
                         "stall iterations = %zu, most iterations = %zu; "
                         "allowed: 1 or more",
                         o->stall_iterations, o->max_iterations);
    if (!(o->relaxation > 0 && o->relaxation <= 1))
        return error_set(err, ERROR_INPUT, "relaxation = %g; allowed: above 0, up to 1",
                         o->relaxation);
    return 0;
}

static int amplitude_create(struct nongaussian *g, struct error *err) {
    const struct modes *modes = g->modes;
    size_t count = (modes->mode_x + 1) * (2 * modes->mode_y + 1);
    struct moments moments;
    modes_moments(modes, &moments);
    g->deviation = moments.rms_height;
    g->amplitude = array_create(count, sizeof *g->amplitude);
    if (!g->amplitude)
        return error_memory(err, count * sizeof *g->amplitude, "amplitudes");
    for (size_t k = 0; k < count; k++)
        g->amplitude[k] = sqrt(modes->power[k]) / g->deviation;
    return 0;
}

static int stages_create(struct nongaussian *g, struct error *err) {
    const struct modes *modes = g->modes;
    bool relaxed = g->options.iteration == ITERATION_RELAXED;
    struct grid thin = relaxed_grid(&modes->grid, modes->mode_x, modes->mode_y);
    bool apart = relaxed && !is_whole(&thin, &modes->grid);
    int status = stage_create(&g->whole, &modes->grid, relaxed && !apart, false, err);
    if (!status && apart)
        status = stage_create(&g->thin, &thin, true, true, err);
    if (!status && apart)
        status = transform_create(&g->thin_transform, &thin, modes->mode_x, modes->mode_y, err);
    return status;
}

int nongaussian_create(struct nongaussian **out, const struct modes *modes,
                       const struct surface_options *options, struct error *err) {
    int status = options_check(options, err);
    if (status)
        return status;
    struct nongaussian *g = array_create(1, sizeof *g);
    if (!g)
        return error_memory(err, sizeof *g, "non-Gaussian generation");
    g->modes = modes;
    g->options = *options;
    status = heights_moments(&options->heights, &g->moments, err);
    if (!status)
        status = amplitude_create(g, err);
    if (!status)
        status = stages_create(g, err);
    if (!status)
        status = height_error_create(&g->height_error, modes, err);
    if (status) {
        nongaussian_destroy(&g);
        return status;
    }
    *out = g;
    return 0;
}

void nongaussian_destroy(struct nongaussian **nongaussian) {
    struct nongaussian *g = *nongaussian;
    if (!g)
        return;
    stage_clear(&g->whole);
    stage_clear(&g->thin);
    transform_destroy(&g->thin_transform);
    height_error_destroy(&g->height_error);
    free(g->amplitude);
    free(g);
    *nongaussian = NULL;
}

/* A mode with the wanted amplitude and the phase it has; phase 0 where it has none. */
static double complex with_amplitude(double complex mode, double amplitude) {
    double size = sqrt(creal(mode) * creal(mode) + cimag(mode) * cimag(mode));
    return size > 0 ? amplitude / size * mode : amplitude;
}

/* A column that is its own mirror image (mx = 0, and Nyquist of an even nx): rows my > 0 decide, so
 * that the symmetry is exact; modes that are their own conjugates keep their sign. */
static void mirror_column_impose(double complex *column, const double *amplitude, size_t ny,
                                 size_t mode_y) {
    for (size_t my = 0; my <= mode_y; my++) {
        if (my == 0 || 2 * my == ny) {
            column[my] = creal(column[my]) < 0 ? -amplitude[mode_y + my] : amplitude[mode_y + my];
            continue;
        }
        column[my] = with_amplitude(column[my], amplitude[mode_y + my]);
        column[ny - my] = conj(column[my]);
    }
}

/* Gives a half spectrum on `grid` the target amplitudes; all other modes become zero. */
static void amplitudes_impose(const struct nongaussian *g, const struct grid *grid,
                              double complex *spectrum) {
    size_t mode_x = g->modes->mode_x;
    size_t mode_y = g->modes->mode_y;
    size_t ny = grid->ny;
    for (size_t mx = 0; mx <= mode_x; mx++) {
        double complex *column = spectrum + mx * ny;
        const double *amplitude = g->amplitude + mx * (2 * mode_y + 1);
        if (2 * mode_y + 1 < ny)
            memset(column + mode_y + 1, 0, (ny - 2 * mode_y - 1) * sizeof *column);
        if (mx == 0 || 2 * mx == grid->nx) {
            mirror_column_impose(column, amplitude, ny, mode_y);
            continue;
        }
        for (size_t my = 0; my <= mode_y; my++)
            column[my] = with_amplitude(column[my], amplitude[mode_y + my]);
        for (size_t my = 1; my <= mode_y && 2 * my != ny; my++)
            column[ny - my] = with_amplitude(column[ny - my], amplitude[mode_y - my]);
    }
}

/* Copies the band of a half spectrum between grids that both resolve it, rows beyond it zero. */
static void band_copy(const struct modes *modes, const double complex *from, size_t from_ny,
                      double complex *to, size_t to_ny) {
    size_t mode_y = modes->mode_y;
    memset(to, 0, (modes->mode_x + 1) * to_ny * sizeof *to);
    for (size_t mx = 0; mx <= modes->mode_x; mx++) {
        memcpy(to + mx * to_ny, from + mx * from_ny, (mode_y + 1) * sizeof *to);
        for (size_t my = 1; my <= mode_y; my++)
            to[(mx + 1) * to_ny - my] = from[(mx + 1) * from_ny - my];
    }
}

/* Relaxed averaged alternating reflections (Luke 2005). With s the nearest surface of the exact
 * spectrum, y = 2 s - x its reflection and h the exact heights in the order of y:
 *     x <- b (x + h) + (1 - 2 b) s,   b the relaxation.
 * x starts as the Gaussian surface. On return the transform's spectrum is that of the last x. */
static int relaxed_run(const struct nongaussian *g, const struct stage *stage,
                       struct transform *transform, double *y, size_t iterations,
                       struct error *err) {
    size_t n = grid_points(&stage->grid);
    double *x = stage->x;
    double b = g->options.relaxation;
    for (size_t iteration = 0; iteration < iterations; iteration++) {
        if (iteration > 0) {
            amplitudes_impose(g, &stage->grid, transform_spectrum(transform));
            transform_inverse(transform, y);
        } else {
            memcpy(y, x, n * sizeof *y);
        }
        for (size_t i = 0; i < n; i++)
            y[i] = 2 * y[i] - x[i];
        int status = rank_place(stage->ranker, y, stage->sorted, stage->h, err);
        if (status)
            return status;
        for (size_t i = 0; i < n; i++)
            x[i] = b * (x[i] + stage->h[i]) + (0.5 - b) * (x[i] + y[i]);
        transform_forward(transform, x);
    }
    return 0;
}

/* The relaxed phase from the Gaussian z; leaves the band of its last iterate in transform. */
static int relaxed_phase(struct nongaussian *g, struct transform *transform, double *z,
                         size_t iterations, struct error *err) {
    const struct grid *grid = &g->modes->grid;
    if (!g->thin_transform) {
        memcpy(g->whole.x, z, grid_points(grid) * sizeof *z);
        return relaxed_run(g, &g->whole, transform, z, iterations, err);
    }
    size_t thin = grid_points(&g->thin.grid);
    int status = target_heights_thin(g->whole.sorted, grid_points(grid), g->thin.sorted, thin, err);
    if (status)
        return status;
    double complex *spectrum = transform_spectrum(transform);
    double complex *thin_spectrum = transform_spectrum(g->thin_transform);
    transform_forward(transform, z);
    band_copy(g->modes, spectrum, grid->ny, thin_spectrum, g->thin.grid.ny);
    transform_inverse(g->thin_transform, g->thin.x);
    status = relaxed_run(g, &g->thin, g->thin_transform, g->thin.y, iterations, err);
    band_copy(g->modes, thin_spectrum, g->thin.grid.ny, spectrum, grid->ny);
    return status;
}

/* One plain iteration: from the transform's spectrum of z_h (or of the start) to z_s, to z_h in
 * whole.h, and to its spectrum. */
static int plain_iterate(const struct nongaussian *g, struct transform *transform, double *z,
                         struct error *err) {
    const struct stage *stage = &g->whole;
    amplitudes_impose(g, &stage->grid, transform_spectrum(transform));
    transform_inverse(transform, z);
    int status = rank_place(stage->ranker, z, stage->sorted, stage->h, err);
    if (!status)
        transform_forward(transform, stage->h);
    return status;
}

/* The plain phase, ended by the tolerance, by the limit of iterations, or by the stall rule of
 * theory.md: the largest error has not gained `stall_gain` on its best in `stall_iterations`. */
static int plain_phase(struct nongaussian *g, struct transform *transform, double *z, size_t limit,
                       struct surface_report *report, struct error *err) {
    const struct surface_options *options = &g->options;
    double mark = INFINITY; /* the error when it last gained enough */
    size_t stuck = 0;
    report->end = END_LIMIT;
    for (size_t iteration = 1; report->end == END_LIMIT && iteration <= limit; iteration++) {
        int status = plain_iterate(g, transform, z, err);
        if (status)
            return status;
        report->iterations++;
        double worst =
            height_error_measure(g->height_error, z, g->whole.h, transform_spectrum(transform),
                                 iteration == limit, report);
        if (worst <= mark * (1 - options->stall_gain)) {
            mark = worst;
            stuck = 0;
        } else {
            stuck++;
        }
        if (worst <= options->tolerance)
            report->end = END_CONVERGED;
        else if (stuck >= options->stall_iterations)
            report->end = END_STALLED;
    }
    height_error_measure(g->height_error, z, g->whole.h, transform_spectrum(transform), true,
                         report);
    return 0;
}

static int iterate(struct nongaussian *g, struct transform *transform, struct random_key key,
                   double *z, struct surface_report *report, struct error *err) {
    const struct surface_options *options = &g->options;
    size_t n = grid_points(&g->modes->grid);
    int status = target_heights_draw(&options->heights, &g->moments, options->draw, key, n,
                                     g->whole.ranker, g->whole.sorted, err);
    if (status)
        return status;
    height_error_start(g->height_error, &g->moments, g->whole.sorted);
    for (size_t i = 0; i < n; i++)
        z[i] /= g->deviation;
    size_t plain = options->max_iterations;
    size_t relaxed = 0;
    if (options->iteration == ITERATION_RELAXED) {
        plain = plain < POLISHING ? plain : POLISHING;
        relaxed = options->max_iterations - plain;
        if (relaxed > options->relaxed_iterations)
            relaxed = options->relaxed_iterations;
    }
    if (relaxed > 0)
        status = relaxed_phase(g, transform, z, relaxed, err);
    else
        transform_forward(transform, z);
    report->iterations = relaxed;
    return status ? status : plain_phase(g, transform, z, plain, report, err);
}

int nongaussian_run(struct nongaussian *g, struct transform *transform, struct random_key key,
                    double *z, struct surface_report *report, struct error *err) {
    struct surface_report local = {0};
    int status = iterate(g, transform, key, z, &local, err);
    if (status)
        return status;
    const double *kept = g->options.keep == KEEP_HEIGHTS ? g->whole.h : z;
    for (size_t i = 0; i < grid_points(&g->modes->grid); i++)
        z[i] = g->deviation * kept[i];
    if (report)
        *report = local;
    return 0;
}

double nongaussian_bytes(const struct grid *grid, size_t mode_x, size_t mode_y,
                         const struct surface_options *options) {
    double bytes = sizeof(struct nongaussian) + height_error_bytes(grid);
    double points = (double)grid_points(grid);
    bytes += sizeof(double) * (double)(mode_x + 1) * (double)(2 * mode_y + 1);
    bytes += 2 * sizeof(double) * points + (double)ranker_bytes(grid_points(grid));
    if (options->iteration != ITERATION_RELAXED)
        return bytes;
    struct grid thin = relaxed_grid(grid, mode_x, mode_y);
    if (is_whole(&thin, grid))
        return bytes + sizeof(double) * points;
    size_t fewer = grid_points(&thin);
    bytes += 4 * sizeof(double) * (double)fewer + (double)ranker_bytes(fewer);
    return bytes + sizeof(double complex) * (double)(mode_x + 1) * (double)thin.ny;
}
