#include "core/statistics/grooves/groove_lines.h"
#include "core/statistics/spectra/windowed_psd.h"
#include <gsl/gsl_cdf.h>
#include <math.h>

/* --- sums over the map --- */

/* Sums of z exp(-i k r), and of these times x and y from the middle, in sides. */
struct sums {
    double complex plain, x, y;
};

static struct sums sums_at(const struct groove_map *map, double mx, double my) {
    const struct grid *grid = map->grid;
    const double nx = (double)grid->nx, ny = (double)grid->ny;
    const double step = -2 * M_PI * mx / nx;
    const double complex turn = cos(step) + sin(step) * I;
    const double start = -2 * M_PI * mx * (0.5 / nx - 0.5);
    struct sums out = {0};
    for (size_t j = 0; j < grid->ny; j++) {
        const double *row = map->z + j * grid->nx;
        const double y = ((double)j + 0.5) / ny - 0.5, phase = -2 * M_PI * my * y;
        double complex wave = cos(start) + sin(start) * I, plain = 0, first = 0;
        for (size_t i = 0; i < grid->nx; i++) {
            const double complex term = row[i] * wave;
            plain += term;
            first += (((double)i + 0.5) / nx - 0.5) * term;
            wave *= turn;
        }
        const double complex row_wave = cos(phase) + sin(phase) * I;
        out.plain += plain * row_wave;
        out.x += first * row_wave;
        out.y += y * plain * row_wave;
    }
    return out;
}

static double square(double complex value) {
    return creal(value) * creal(value) + cimag(value) * cimag(value);
}

double groove_power(const struct groove_map *map, double mx, double my) {
    const double n = (double)grid_points(map->grid);
    return square(sums_at(map, mx, my).plain) / (n * n);
}

/* Of the window along one axis: its mean, and that of its square; mean squares of the distance from
 * the middle, in sides, weighted by it and by its square. */
struct window {
    double mean, square, moment, square_moment;
};

static struct window window_of(size_t n) {
    struct window out = {0};
    for (size_t i = 0; i < n; i++) {
        const double w = hann_window(i, n), x = ((double)i + 0.5) / (double)n - 0.5;
        out.mean += w;
        out.square += w * w;
        out.moment += w * x * x;
        out.square_moment += w * w * x * x;
    }
    out.moment /= out.mean;
    out.square_moment /= out.square;
    out.mean /= (double)n;
    out.square /= (double)n;
    return out;
}

/* --- the wave vector --- */

/* A step of Gauss and Newton towards the highest sum of powers over their backgrounds, of those of
 * the harmonics up to `most` that stand out. */
struct likelihood {
    double gradient[2], curvature; /* by 2 pi times periods along a side, without the moment of the
                                      window */
};

static void likelihood_add(struct likelihood *out, const struct groove_map *map, double mx,
                           double my, size_t h, double background) {
    const double order = (double)h;
    const struct sums sums = sums_at(map, order * mx, order * my);
    out->gradient[0] += order * cimag(conj(sums.plain) * sums.x) / background;
    out->gradient[1] += order * cimag(conj(sums.plain) * sums.y) / background;
    out->curvature += order * order * square(sums.plain) / background;
}

static double climb_step(double gradient, double curvature, double moment) {
    static const double LONGEST = 0.3; /* of a period along a side */
    const double step = gradient / (curvature * moment * 2 * M_PI);
    return fmin(fmax(step, -LONGEST), LONGEST);
}

/* Moves the wave vector until it rests. which[h - 1]: the harmonic counts. */
static void climb(const struct groove_map *map, const struct groove_background *background,
                  size_t most, const bool *which, double *mx, double *my) {
    enum { STEPS_MOST = 12 };
    static const double SETTLED = 1e-5;
    const bool profile = grid_is_profile(map->grid);
    const struct window along_x = window_of(map->grid->nx), along_y = window_of(map->grid->ny);
    for (int step = 0; step < STEPS_MOST; step++) {
        struct likelihood sum = {0};
        for (size_t h = 1; h <= most; h++)
            if (which[h - 1])
                likelihood_add(
                    &sum, map, *mx, *my, h,
                    background != NULL
                        ? groove_background_power(background, (double)h * *mx, (double)h * *my)
                        : 1);
        if (!(sum.curvature > 0))
            return;
        const double by_x = climb_step(sum.gradient[0], sum.curvature, along_x.moment);
        const double by_y =
            profile ? 0 : climb_step(sum.gradient[1], sum.curvature, along_y.moment);
        *mx += by_x;
        *my += by_y;
        if (fmax(fabs(by_x), fabs(by_y)) < SETTLED)
            return;
    }
}

void groove_refine(const struct groove_map *map, double *mx, double *my) {
    static const bool FIRST[] = {true};
    climb(map, NULL, 1, FIRST, mx, my);
}

/* Returns how many harmonics the grid resolves. */
static size_t resolved(const struct grid *grid, double mx, double my) {
    const double most =
        fmin(((double)grid->nx / 2 - 1) / fmax(fabs(mx), 1e-9),
             grid_is_profile(grid) ? INFINITY : ((double)grid->ny / 2 - 1) / fmax(fabs(my), 1e-9));
    return most < 1 ? 1 : (size_t)fmin(most, GROOVE_LINES_MOST);
}

/* Power in lines that is none of theirs: of the strongest what the window leaks, and of the last
 * ones what points fold back of the next. */
static const double LEAKED = 1e-7, FOLDED = 0.001;

static void measure(struct groove_lines *out, const struct groove_map *map,
                    const struct groove_background *background) {
    const struct window along_x = window_of(map->grid->nx), along_y = window_of(map->grid->ny);
    const double weight = (double)grid_points(map->grid) * along_x.mean * along_y.mean;
    const double mean = along_x.mean * along_y.mean;
    double strongest = 0, last = 0;
    for (size_t h = 1; h <= out->count; h++) {
        const double mx = (double)h * out->mx, my = (double)h * out->my;
        const double power = groove_background_power(background, mx, my);
        out->coefficient[h - 1] = sums_at(map, mx, my).plain / weight;
        out->variance[h - 1] = power / (mean * mean);
    }
    for (size_t h = 0; h < out->count; h++)
        strongest = fmax(strongest, square(out->coefficient[h]));
    for (size_t h = out->count < 3 ? 1 : out->count - 2; h < out->count; h++)
        last = fmax(last, square(out->coefficient[h]));
    for (size_t h = 0; h < out->count; h++) {
        out->variance[h] += LEAKED * strongest + FOLDED * last;
        out->excess[h] = square(out->coefficient[h]) / out->variance[h];
    }
}

/* Standard errors of the wave vector, by the noise at the lines that count. */
static void errors_fill(struct groove_lines *out, const struct groove_map *map, const bool *which) {
    const struct window along_x = window_of(map->grid->nx), along_y = window_of(map->grid->ny);
    double information = 0;
    for (size_t h = 1; h <= out->count; h++)
        if (which[h - 1])
            information += (double)(h * h) * fmax(out->excess[h - 1] - 1, 1);
    const double scale = sqrt(0.5 / information) / (2 * M_PI);
    out->mx_error = scale * sqrt(along_x.square_moment) / along_x.moment;
    out->my_error =
        grid_is_profile(map->grid) ? 0 : scale * sqrt(along_y.square_moment) / along_y.moment;
}

/* Lines so many times above the random part count for the wave vector. */
static const double STANDS_OUT = 12;

void groove_lines_fit(struct groove_lines *out, const struct groove_map *map,
                      const struct groove_background *background, double mx, double my) {
    bool which[GROOVE_LINES_MOST] = {false};
    *out = (struct groove_lines){.mx = mx, .my = my, .count = resolved(map->grid, mx, my)};
    for (size_t most = 1;; most = 2 * most < out->count ? 2 * most : out->count) {
        const size_t whole = out->count;
        out->count = most;
        measure(out, map, background);
        out->count = whole;
        size_t strongest = 0;
        for (size_t h = 0; h < most; h++) {
            which[h] = out->excess[h] > STANDS_OUT;
            strongest = out->excess[h] > out->excess[strongest] ? h : strongest;
        }
        which[strongest] = true;
        climb(map, background, most, which, &out->mx, &out->my);
        if (most == out->count)
            break;
    }
    measure(out, map, background);
    errors_fill(out, map, which);
}

double groove_lines_height(const struct groove_lines *lines, double x, double y) {
    const double phase = 2 * M_PI * (lines->mx * x + lines->my * y);
    const double complex turn = cos(phase) + sin(phase) * I;
    double complex sum = 0;
    for (size_t h = lines->count; h-- > 0;)
        sum = (sum + lines->coefficient[h]) * turn;
    return 2 * creal(sum);
}

/* --- the shape --- */

/* Of the errors of depths to those estimated without it, over 120 sub-maps of known grooves. */
static const double MEASURED = 1.12;

struct shape_trial {
    double deviance, depth, variance, at;
};

/* Returns what a shape leaves of the lines where it begins t periods before the middle. */
static struct shape_trial shape_at(const struct groove_lines *lines, enum groove_shape shape,
                                   bool reversed, double t) {
    double product = 0, norm = 0, total = 0;
    for (size_t h = 1; h <= lines->count; h++) {
        double complex unit = groove_shape_coefficient(shape, h);
        if (reversed)
            unit = conj(unit);
        const double phase = 2 * M_PI * (double)h * t, v = lines->variance[h - 1];
        unit *= cos(phase) + sin(phase) * I;
        product += creal(conj(unit) * lines->coefficient[h - 1]) / v;
        norm += square(unit) / v;
        total += square(lines->coefficient[h - 1]) / v;
    }
    const double depth = fmax(product / norm, 0);
    return (struct shape_trial){2 * (total - 2 * depth * product + depth * depth * norm), depth,
                                0.5 / norm, t};
}

static struct shape_trial shape_fit(const struct groove_lines *lines, enum groove_shape shape,
                                    bool reversed) {
    enum { HALVINGS = 18 };
    const size_t points = 16 * lines->count + 32;
    struct shape_trial best = {.deviance = INFINITY};
    double at = 0, reach = 1. / (double)points;
    for (size_t i = 0; i < points; i++) {
        const struct shape_trial trial =
            shape_at(lines, shape, reversed, (double)i / (double)points);
        if (trial.deviance < best.deviance) {
            best = trial;
            at = (double)i / (double)points;
        }
    }
    for (int step = 0; step < HALVINGS; step++, reach /= 2)
        for (int sign = -1; sign <= 1; sign += 2) {
            const struct shape_trial trial =
                shape_at(lines, shape, reversed, at + sign * reach / 2);
            if (trial.deviance < best.deviance) {
                best = trial;
                at += sign * reach / 2;
                break;
            }
        }
    return best;
}

/* Depth of the series up to the last line that stands out; its error by all lines of it. */
static void series_depth(struct groove_shape_fit *out, const struct groove_lines *lines) {
    double variance = 0;
    const struct groove_extremes e = groove_extremes_find(out->standing, lines->coefficient);
    for (size_t h = 1; h <= out->standing; h++) {
        const double apart = 2 * sin(M_PI * (double)h * (e.high_at - e.low_at));
        variance += 2 * lines->variance[h - 1] * apart * apart;
    }
    out->depth = e.high - e.low;
    out->depth_error = MEASURED * sqrt(variance);
}

void groove_shape_find(struct groove_shape_fit *out, const struct groove_lines *lines) {
    static const double STANDS = 7, WRONG = 0.003, NEAR = 6;
    const double freedom = 2 * (double)lines->count - 2;
    struct shape_trial trial[GROOVE_HARMONICS + 1];
    int best = 0;
    *out = (struct groove_shape_fit){.standing = 1};
    for (size_t h = 1; h <= lines->count; h++)
        out->standing = lines->excess[h - 1] > STANDS ? h : out->standing;
    for (int s = 0; s <= GROOVE_HARMONICS; s++) {
        const bool reversed = s == GROOVE_HARMONICS;
        trial[s] = shape_fit(lines, reversed ? GROOVE_SAW : (enum groove_shape)s, reversed);
        best = trial[s].deviance < trial[best].deviance ? s : best;
    }
    out->reversed = best == GROOVE_HARMONICS;
    out->shape = out->reversed ? GROOVE_SAW : (enum groove_shape)best;
    out->p_value = freedom > 0 ? gsl_cdf_chisq_Q(trial[best].deviance, freedom) : 1;
    out->depth = trial[best].depth;
    out->at = trial[best].at;
    double low = out->depth, high = out->depth;
    for (int s = 0; s <= GROOVE_HARMONICS; s++)
        if (trial[s].deviance < trial[best].deviance + NEAR) {
            low = fmin(low, trial[s].depth);
            high = fmax(high, trial[s].depth);
        }
    /* shapes that fit as well have other depths */
    out->depth_error = hypot(MEASURED * sqrt(trial[best].variance), (high - low) / 2);
    if (out->p_value < WRONG) {
        out->shape = GROOVE_HARMONICS;
        out->reversed = false;
        out->p_value = (double)NAN;
        series_depth(out, lines);
    }
}
