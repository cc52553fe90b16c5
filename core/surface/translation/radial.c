#include "core/surface/translation/radial.h"
#include "core/surface/transform.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The lattice has so many points in the first wave number of the band, as far as LINE_MOST allows,
 * and ends at BEYOND times the last one: products of densities have waves beyond the band. */
enum { BEYOND = 4, LINE_MOST = 8 * BEYOND * RADIAL_RATIO_MOST };
static const double LINE_FINE[] = {[1] = 128, [2] = 32};
static const double LINE_COARSE = 8;

struct radial {
    int dimension;
    size_t nodes, line; /* the lattice has line + 1 points from 0 on */
    double *k;          /* nodes, rising; owned, as all arrays */
    double spacing;     /* of the lattice */
    size_t inside;      /* points of the lattice up to the last node */
    double *project;    /* inside x nodes: from densities to the lattice, times the spacing */
    struct range {
        size_t from, to;
    } * ranges;      /* nodes that count at a point inside */
    double *restore; /* nodes x (line + 1): back; surfaces alone */
    struct transform *transform;
    double *lags; /* 2 line */
};

/* --- matrices of Abel's transform --- */

/* Adds the projection on a lattice point at x of the density that is linear between nodes p and
 * p + 1: twice the integral of density k/sqrt(k^2 - x^2). */
static void project_segment(const struct radial *r, double x, size_t p, double *row) {
    double low = r->k[p], high = r->k[p + 1], from = fmax(low, x);
    double a = sqrt(fmax(from * from - x * x, 0)), b = sqrt(high * high - x * x);
    double zeroth = b - a;
    double first = (high * b - from * a + x * x * log((high + b) / (from + a))) / 2;
    double upper = (first - low * zeroth) / (high - low);
    row[p] += 2 * r->spacing * (zeroth - upper);
    row[p + 1] += 2 * r->spacing * upper;
}

/* Adds the value at x, if it lies between nodes p and p + 1. Points whose surroundings are partly
 * outside the band count for the part inside. */
static void sample_segment(const struct radial *r, double x, size_t p, double *row) {
    double half = r->spacing / 2, low = r->k[p], high = r->k[p + 1];
    double from = fmax(low, x - half), to = fmin(high, x + half);
    if (!(to > from))
        return;
    double upper = ((from + to) / 2 - low) / (high - low);
    row[p] += (to - from) * (1 - upper);
    row[p + 1] += (to - from) * upper;
}

static void range_fill(const struct radial *r, const double *row, struct range *out) {
    *out = (struct range){0, r->nodes};
    while (out->from < out->to && row[out->from] == 0)
        out->from++;
    while (out->to > out->from && row[out->to - 1] == 0)
        out->to--;
}

static void project_fill(struct radial *r) {
    for (size_t i = 0; i < r->inside; i++) {
        double x = (double)i * r->spacing, *row = r->project + i * r->nodes;
        for (size_t p = 0; p + 1 < r->nodes; p++) {
            if (r->dimension == 1)
                sample_segment(r, x, p, row);
            else if (r->k[p + 1] > x)
                project_segment(r, x, p, row);
        }
        range_fill(r, row, &r->ranges[i]);
    }
}

/* The density at k is -1/pi times the integral, from k on, of the slope of the projection over
 * sqrt(x^2 - k^2); the projection is linear between points of the lattice. */
static void restore_fill(struct radial *r) {
    for (size_t a = 0; a < r->nodes; a++) {
        double k = r->k[a], *row = r->restore + a * (r->line + 1);
        double last = 0; /* arcosh at the beginning of a segment */
        for (size_t i = (size_t)(k / r->spacing); i < r->line; i++) {
            double ratio = fmax((double)(i + 1) * r->spacing / k, 1);
            double now = log(ratio + sqrt(ratio * ratio - 1));
            double weight = (now - last) / (M_PI * r->spacing * r->spacing);
            row[i] += weight;
            row[i + 1] -= weight;
            last = now;
        }
    }
}

/* --- creation --- */

static int arrays_create(struct radial *r, struct error *err) {
    size_t restored = r->dimension == 2 ? r->nodes * (r->line + 1) : 0;
    size_t all = r->inside * r->nodes + restored + 2 * r->line;
    r->project = array_create(r->inside * r->nodes, sizeof *r->project);
    r->ranges = array_create(r->inside, sizeof *r->ranges);
    r->restore = restored > 0 ? array_create(restored, sizeof *r->restore) : NULL;
    r->lags = array_create(2 * r->line, sizeof *r->lags);
    if (r->project == NULL || r->ranges == NULL || r->lags == NULL ||
        (restored > 0 && r->restore == NULL))
        return error_memory(err, all * sizeof(double), "transforms of a law of heights");
    return 0;
}

static void lattice_choose(struct radial *r) {
    double first = r->k[0], last = r->k[r->nodes - 1];
    double fine = LINE_MOST * first / (BEYOND * last);
    r->spacing = first / fmin(LINE_FINE[r->dimension], fmax(fine, LINE_COARSE));
    r->inside = (size_t)(last / r->spacing) + 2;
    r->line = transform_fast_count((size_t)ceil(BEYOND * last / r->spacing));
}

static int fill(struct radial *r, const double *k, struct error *err) {
    r->k = array_create(r->nodes, sizeof *r->k);
    if (r->k == NULL)
        return error_memory(err, r->nodes * sizeof *r->k, "wave numbers of a law of heights");
    memcpy(r->k, k, r->nodes * sizeof *r->k);
    lattice_choose(r);
    int status = arrays_create(r, err);
    if (status != 0)
        return status;
    project_fill(r);
    if (r->dimension == 2)
        restore_fill(r);
    const struct grid grid = {2 * r->line, 1, 2 * M_PI / r->spacing, 1};
    return transform_create(&r->transform, &grid, r->line, 0, err);
}

int radial_create(struct radial **out, int dimension, size_t n, const double *k,
                  struct error *err) {
    if (!(k[n - 1] <= RADIAL_RATIO_MOST * (1 + 1e-9) * k[0]))
        return error_set(err, ERROR_INPUT,
                         "the longest wave of the spectrum is %.4g times the shortest one; the law "
                         "\"translation\" allows up to %d, and more where those waves have less "
                         "than 1 %% of the variance",
                         k[n - 1] / k[0], RADIAL_RATIO_MOST);
    struct radial *r = array_create(1, sizeof *r);
    if (r == NULL)
        return error_memory(err, sizeof *r, "transforms of a law of heights");
    r->dimension = dimension;
    r->nodes = n;
    int status = fill(r, k, err);
    if (status != 0) {
        radial_destroy(&r);
        return status;
    }
    *out = r;
    return 0;
}

void radial_destroy(struct radial **radial) {
    struct radial *r = *radial;
    if (r == NULL)
        return;
    transform_destroy(&r->transform);
    free(r->k);
    free(r->project);
    free(r->ranges);
    free(r->restore);
    free(r->lags);
    free(r);
    *radial = NULL;
}

/* --- transforms --- */

size_t radial_lags(const struct radial *radial) {
    return radial->line + 1;
}

void radial_correlate(struct radial *r, const double *density, double *correlation) {
    double complex *spectrum = transform_spectrum(r->transform);
    for (size_t i = 0; i < r->inside; i++) {
        double power = 0;
        const double *row = r->project + i * r->nodes;
        for (size_t a = r->ranges[i].from; a < r->ranges[i].to; a++)
            power += row[a] * density[a];
        spectrum[i] = power;
    }
    for (size_t i = r->inside; i <= r->line; i++)
        spectrum[i] = 0;
    transform_inverse(r->transform, r->lags);
    memcpy(correlation, r->lags, (r->line + 1) * sizeof *correlation);
}

/* 1 up to half the lags, then the square of a cosine down to 0. */
static double taper(double part) {
    double cosine = cos(M_PI / 2 * fmax(2 * part - 1, 0));
    return cosine * cosine;
}

static double restore_one(const struct radial *r, const double complex *spectrum, size_t node) {
    double at = r->k[node] / r->spacing, sum = 0;
    size_t below = (size_t)at;
    if (r->dimension == 1) {
        double t = at - (double)below;
        return ((1 - t) * creal(spectrum[below]) + t * creal(spectrum[below + 1])) / r->spacing;
    }
    const double *row = r->restore + node * (r->line + 1);
    for (size_t i = below; i <= r->line; i++)
        sum += row[i] * creal(spectrum[i]);
    return sum;
}

void radial_density(struct radial *r, const double *correlation, double *density) {
    r->lags[0] = correlation[0];
    for (size_t i = 1; i <= r->line; i++) {
        double value = correlation[i] * taper((double)i / (double)r->line);
        r->lags[i] = value;
        if (i < r->line)
            r->lags[2 * r->line - i] = value;
    }
    transform_forward(r->transform, r->lags);
    const double complex *spectrum = transform_spectrum(r->transform);
    for (size_t a = 0; a < r->nodes; a++)
        density[a] = restore_one(r, spectrum, a);
}

double radial_integral(const struct radial *r, const double *density) {
    double sum = 0;
    for (size_t a = 0; a + 1 < r->nodes; a++) {
        double width = r->k[a + 1] - r->k[a];
        double low = density[a], high = density[a + 1];
        if (r->dimension == 2) {
            low *= M_PI * r->k[a];
            high *= M_PI * r->k[a + 1];
        }
        sum += width * (low + high);
    }
    return sum;
}
