#include "core/statistics/grooves/groove_lines.h"
#include "core/vectors.h"
#include <math.h>

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
    const struct groove_sums sums = groove_sums_at(map, order * mx, order * my);
    out->gradient[0] += order * cimag(conj(sums.plain) * sums.x) / background;
    out->gradient[1] += order * cimag(conj(sums.plain) * sums.y) / background;
    out->curvature += order * order * complex_square(sums.plain) / background;
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
    const struct groove_window along_x = groove_window_of(map->grid->nx),
                               along_y = groove_window_of(map->grid->ny);
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
    const struct groove_window along_x = groove_window_of(map->grid->nx),
                               along_y = groove_window_of(map->grid->ny);
    const double weight = (double)grid_points(map->grid) * along_x.mean * along_y.mean;
    const double mean = along_x.mean * along_y.mean;
    double strongest = 0, last = 0;
    for (size_t h = 1; h <= out->count; h++) {
        const double mx = (double)h * out->mx, my = (double)h * out->my;
        const double power = groove_background_power(background, mx, my);
        out->coefficient[h - 1] = groove_sums_at(map, mx, my).plain / weight;
        out->variance[h - 1] = power / (mean * mean);
    }
    for (size_t h = 0; h < out->count; h++)
        strongest = fmax(strongest, complex_square(out->coefficient[h]));
    for (size_t h = out->count < 3 ? 1 : out->count - 2; h < out->count; h++)
        last = fmax(last, complex_square(out->coefficient[h]));
    for (size_t h = 0; h < out->count; h++) {
        out->variance[h] += LEAKED * strongest + FOLDED * last;
        out->excess[h] = complex_square(out->coefficient[h]) / out->variance[h];
    }
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
}

struct groove_turns groove_turns_of(double periods, size_t first, size_t points, size_t n) {
    struct groove_turns out = {{0}, {0}};
    for (size_t p = 0; p < points; p++) {
        const double x = ((double)(first + p) + 0.5) / (double)n - 0.5;
        out.re[p] = cos(2 * M_PI * periods * x);
        out.im[p] = sin(2 * M_PI * periods * x);
    }
    return out;
}

/* Horner's scheme at all points at once. */
WIDE_VECTORS void groove_lines_heights(const struct groove_lines *lines,
                                       const struct groove_turns *along_x, double y,
                                       double out[GROOVE_TURNS]) {
    const double phase = 2 * M_PI * lines->my * y, row_re = cos(phase), row_im = sin(phase);
    double re[GROOVE_TURNS] = {0}, im[GROOVE_TURNS] = {0};
    struct groove_turns turns;
    for (size_t p = 0; p < GROOVE_TURNS; p++) {
        turns.re[p] = along_x->re[p] * row_re - along_x->im[p] * row_im;
        turns.im[p] = along_x->re[p] * row_im + along_x->im[p] * row_re;
    }
    for (size_t h = lines->count; h-- > 0;) {
        const double line_re = creal(lines->coefficient[h]), line_im = cimag(lines->coefficient[h]);
        for (size_t p = 0; p < GROOVE_TURNS; p++) {
            const double a = re[p] + line_re, b = im[p] + line_im;
            re[p] = a * turns.re[p] - b * turns.im[p];
            im[p] = a * turns.im[p] + b * turns.re[p];
        }
    }
    for (size_t p = 0; p < GROOVE_TURNS; p++)
        out[p] = 2 * re[p];
}
