#include "core/theory/sampled_summits.h"
#include "core/random.h"
#include "core/theory/height_cells.h"
#include "core/theory/summit_integrand.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* --- sums over a lattice --- */

/* A lattice rule: point n is at the fractions of n times these steps, beside 1 of the curvature.
 * They are chosen component by component (Sloan & Reztsov 2002) for smooth periodic functions;
 * folding makes the ends of others meet. Independent shifts tell the error: 2e-4 of the density of
 * nine-point summits, 1e-6 of others. */
enum { SHIFTS_MOST = 8, LATTICE_SEED = 1, LATTICE_POINTS = 16381, PROFILE_POINTS = 2039 };
static const unsigned STEPS[UNIFORMS] = {3711, 5711, 3321, 7766, 7145, 6041};
static size_t shift_count(size_t pairs) {
    return pairs == PAIRS_NINE_POINT ? SHIFTS_MOST : 2;
}
/* Profiles have an integral over one line. */
static size_t point_count(size_t pairs) {
    return pairs == PAIRS_PROFILE ? PROFILE_POINTS : LATTICE_POINTS;
}

struct lattice_sums {
    double weight, curvature, height[4]; /* weight times curvature, means of heights to a power */
    double shifted[SHIFTS_MOST];         /* weight of each shift */
    double *cells, *moments;             /* owned, HEIGHT_CELLS; NULL: not wanted */
    double *t1;                          /* of the caller; NULL: not wanted */
    double *joint;                       /* owned, HEIGHT_CELLS of each bin of t1; NULL */
};

/* Adds a weight that is evenly spread over an interval of t1 to the bins under it: to counts[b], or
 * to heights with this mean in the cells of bin b. */
static void add_t1(const struct bins *bins, double low, double high, double weight, double *counts,
                   double *joint, double mean) {
    double width = bins_width(bins), from = (low - bins->low) / width;
    double to = (high - bins->low) / width, span = to - from;
    size_t last = (size_t)fmin(fmax(ceil(to), 0), (double)bins->count);
    for (size_t b = (size_t)fmin(fmax(from, 0), (double)bins->count); b < last; b++) {
        double share = span > 0 ? (fmin(to, (double)b + 1) - fmax(from, (double)b)) / span : 1;
        if (counts != NULL)
            counts[b] += weight * share;
        if (joint != NULL)
            height_cells_add(joint + b * HEIGHT_CELLS, mean, weight * share);
    }
}

/* Gauss and Hermite's rule for a unit normal. */
enum { HERMITE = 5 };
static const double HERMITE_NODES[HERMITE] = {-2.8569700138728056, -1.3556261799742659, 0,
                                              1.3556261799742659, 2.8569700138728056};
static const double HERMITE_WEIGHTS[HERMITE] = {0.011257411327720689, 0.22207592200561266,
                                                0.53333333333333333, 0.22207592200561266,
                                                0.011257411327720689};

/* How much height goes with a curvature that is not known from the even vector. */
static double height_by_curvature(const struct summit_integrand *f) {
    return f->curvature.variance > 0 ? f->common / f->curvature.variance : 0;
}

static void add_curvatures(const struct summit_integrand *f, const struct bins *t1, double height,
                           double curvature, double interval, double weight,
                           struct lattice_sums *sums) {
    double factor = f->pairs == PAIRS_PROFILE ? 1 : sqrt(3), half = factor * interval / 2;
    double deviation = sqrt(f->curvature.variance);
    for (size_t node = 0; node < HERMITE; node++) {
        bool single = deviation == 0;
        double rest = single ? 0 : deviation * HERMITE_NODES[node];
        double at = -factor * (curvature + rest);
        add_t1(t1, at - half, at + half, weight * (single ? 1 : HERMITE_WEIGHTS[node]), sums->t1,
               sums->joint, height + height_by_curvature(f) * rest);
        if (single)
            break;
    }
}

static void add_point(const struct summit_integrand *f, const struct bins *t1, const double *y,
                      double interval, double weight, struct lattice_sums *sums) {
    double height = regression_value(&f->height, y);
    double curvature = regression_value(&f->curvature, y), power = weight;
    sums->weight += weight;
    sums->curvature += weight * curvature;
    for (size_t n = 0; n < 4; n++)
        sums->height[n] += power *= height;
    if (sums->cells != NULL) {
        height_cells_add(sums->cells, height, weight);
        height_cells_add(sums->moments, height, weight * curvature);
    }
    if (sums->t1 != NULL || sums->joint != NULL)
        add_curvatures(f, t1, height, curvature, interval * fabs(f->curvature.slope[0]), weight,
                       sums);
}

/* Curvatures by differences rise in equal steps, so that each bin of t1 sees as many points as
 * the next; the other coordinates are those of a lattice, folded so that its ends meet. */
static void integrate(const struct summit_integrand *f, const struct bins *t1,
                      struct lattice_sums *sums) {
    const size_t points = point_count(f->pairs);
    const double interval = LEAD_MOST / (double)points;
    for (size_t shift = 0; shift < shift_count(f->pairs); shift++) {
        double random[UNIFORMS + 1], u[UNIFORMS], y[PAIRS_MOST] = {0};
        double before = sums->weight;
        random_uniform((struct random_key){LATTICE_SEED, 0, shift}, STREAM_PHASES, 0, UNIFORMS + 1,
                       random);
        for (size_t n = 0; n < points; n++) {
            for (size_t a = 0; a < UNIFORMS; a++) {
                double place = (double)n * STEPS[a] / (double)points + random[a];
                u[a] = fmin(fmax(fabs(2 * (place - floor(place)) - 1), 1e-15), 1 - 1e-15);
            }
            double lead = interval * ((double)n + random[UNIFORMS]);
            double weight = summit_integrand_weigh(f, lead, u, y);
            if (weight > 0)
                add_point(f, t1, y, interval, weight, sums);
        }
        sums->shifted[shift] = sums->weight - before;
    }
}

/* --- what comes out --- */

static double relative_error(const struct lattice_sums *sums, size_t shifts) {
    double n = (double)shifts, mean = sums->weight / n, squares = 0;
    for (size_t shift = 0; shift < shifts; shift++)
        squares += (sums->shifted[shift] - mean) * (sums->shifted[shift] - mean);
    return sqrt(squares / (n * (n - 1))) / mean;
}

/* Heights are their means, with these moments, plus a normal rest. */
static void moments_take(const struct lattice_sums *sums, double rest,
                         struct sampled_summits *out) {
    double m[4];
    for (size_t n = 0; n < 4; n++)
        m[n] = sums->height[n] / sums->weight;
    double second = m[1] - m[0] * m[0];
    double third = m[2] - 3 * m[0] * m[1] + 2 * m[0] * m[0] * m[0];
    double fourth = m[3] - 4 * m[0] * m[2] + 6 * m[0] * m[0] * m[1] - 3 * m[0] * m[0] * m[0] * m[0];
    double variance = second + rest;
    out->height_mean = m[0];
    out->height_variance = variance;
    out->height_skewness = third / (variance * sqrt(variance));
    out->height_kurtosis = (fourth + 6 * rest * second + 3 * rest * rest) / (variance * variance);
}

/* Below this share of all summits in a bin their curvature is not told. */
static const double SHARE_LEAST = 1e-14;

static int heights_take(const struct summit_integrand *f, const struct lattice_sums *sums,
                        const struct sampled_bins *bins, struct error *err) {
    size_t edges = bins->height->count + 1;
    double *room = array_create(edges, 4 * sizeof *room), width = bins_width(bins->height);
    if (room == NULL)
        return error_memory(err, edges * 4 * sizeof *room, "bins of theory");
    struct height_edges out = {room, room + edges, room + 2 * edges, room + 3 * edges};
    double rest = f->height.variance;
    int status = height_cells_spread(sums->cells, sums->moments, rest,
                                     rest > 0 ? f->common / rest : 0, bins->height, &out, err);
    for (size_t b = 0; b + 1 < edges && status == 0; b++) {
        double weight = height_edges_within(out.below, out.above, b);
        bool lower = out.below[b] < out.above[b + 1];
        double moment = lower ? out.below_moment[b + 1] - out.below_moment[b]
                              : out.above_moment[b] - out.above_moment[b + 1];
        bins->pdf[b] = weight / sums->weight / width;
        bins->cdf[b] = fmin(out.below[b + 1] / sums->weight, 1);
        bins->curvature[b] = weight > SHARE_LEAST * sums->weight ? moment / weight : (double)NAN;
    }
    free(room);
    return status;
}

static int joint_take(const struct summit_integrand *f, const struct lattice_sums *sums,
                      const struct sampled_bins *bins, struct error *err) {
    size_t edges = bins->height->count + 1, columns = bins->t1->count;
    double *room = array_create(edges, 2 * sizeof *room);
    if (room == NULL)
        return error_memory(err, edges * 2 * sizeof *room, "bins of theory");
    struct height_edges out = {.below = room, .above = room + edges};
    double rest = fmax(f->height.variance - f->common * height_by_curvature(f), 0);
    double cell = bins_width(bins->height) * bins_width(bins->t1) * sums->weight;
    int status = 0;
    for (size_t column = 0; column < columns && status == 0; column++) {
        status = height_cells_spread(sums->joint + column * HEIGHT_CELLS, NULL, rest, 0,
                                     bins->height, &out, err);
        for (size_t b = 0; b + 1 < edges && status == 0; b++)
            bins->joint[b * columns + column] = height_edges_within(out.below, out.above, b) / cell;
    }
    free(room);
    return status;
}

static int take(const struct summit_integrand *f, const struct sampled_surface *surface,
                const struct lattice_sums *sums, const struct sampled_bins *bins,
                struct sampled_summits *out, struct error *err) {
    const struct grid *grid = &surface->modes->grid;
    int status = 0;
    if (sums->cells != NULL)
        status = heights_take(f, sums, bins, err);
    if (sums->joint != NULL && status == 0)
        status = joint_take(f, sums, bins, err);
    if (status != 0)
        return status;
    for (size_t b = 0; sums->t1 != NULL && b < bins->t1->count; b++)
        sums->t1[b] /= sums->weight * bins_width(bins->t1);
    double points = (double)(shift_count(f->pairs) * point_count(f->pairs));
    double area = grid_is_profile(grid) ? grid_dx(grid) : grid_dx(grid) * grid_dy(grid);
    out->density = sums->weight / points / area;
    out->density_error = relative_error(sums, shift_count(f->pairs));
    out->curvature = sums->curvature / sums->weight;
    moments_take(sums, f->height.variance, out);
    return 0;
}

static int sums_create(struct lattice_sums *sums, const struct sampled_bins *bins,
                       struct error *err) {
    *sums = (struct lattice_sums){0};
    if (bins == NULL)
        return 0;
    size_t cells = bins->pdf != NULL ? 2 : 0, joint = bins->joint != NULL ? bins->t1->count : 0;
    size_t bytes = (cells + joint) * HEIGHT_CELLS * sizeof(double);
    sums->t1 = bins->t1_pdf;
    if (sums->t1 != NULL)
        memset(sums->t1, 0, bins->t1->count * sizeof *sums->t1);
    if (cells != 0)
        sums->cells = array_create(2 * HEIGHT_CELLS, sizeof *sums->cells);
    if (joint != 0)
        sums->joint = array_create(joint * HEIGHT_CELLS, sizeof *sums->joint);
    if ((cells != 0 && sums->cells == NULL) || (joint != 0 && sums->joint == NULL))
        return error_memory(err, bytes, "sums of theory");
    sums->moments = cells != 0 ? sums->cells + HEIGHT_CELLS : NULL;
    return 0;
}

int sampled_summits(const struct sampled_surface *surface, struct sampled_summits *out,
                    const struct sampled_bins *bins, struct error *err) {
    struct sampled_field field;
    struct summit_integrand f;
    struct lattice_sums sums;
    size_t pairs = grid_is_profile(&surface->modes->grid)   ? PAIRS_PROFILE
                   : surface->stencil == SUMMITS_NINE_POINT ? PAIRS_NINE_POINT
                                                            : PAIRS_FIVE_POINT;
    if (surface->stencil == SUMMITS_REFINED)
        return error_set(err, ERROR_INPUT,
                         "refined summits are not those of a grid; allowed: "
                         "nine-point and five-point ones");
    int status = sampled_field_fill(surface->modes, surface->moments, pairs, &field, err);
    if (status != 0)
        return status;
    summit_integrand_prepare(&field, surface->curvature, &f);
    status = sums_create(&sums, bins, err);
    if (status == 0) {
        integrate(&f, bins != NULL ? bins->t1 : NULL, &sums);
        status = take(&f, surface, &sums, bins, out, err);
    }
    free(sums.cells);
    free(sums.joint);
    return status;
}
