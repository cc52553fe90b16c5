#include "core/statistics/spectra/spectrum_leakage.h"
#include <stdlib.h>
#include <string.h>

/* Leakage is looked at up to REACH waves away, beyond which 1e-5 of it is; of ellipses as many
 * times farther as they are longer across, up to REACH_MOST. NODES a wave. */
enum { REACH = 8, REACH_MOST = 64, NODES = 8, TABLE = 64 };

/* The power of Hann's window over all of it, q waves from its middle. */
static double window_power(double q) {
    double t = M_PI * q, sinc = fabs(t) < 1e-4 ? 1 - t * t / 6 : sin(t) / t;
    double beside = 1 - q * q;
    double value = fabs(beside) < 1e-6 ? 0.25 : sinc / (2 * beside);
    return value * value / 0.375;
}

/* The density of the window's power. */
struct window {
    bool profile;
    size_t reach;
    double straight; /* from this ring on rings are as good as lines, moved by their bend */
    double mean[REACH_MOST * TABLE + 1];   /* at q = a/TABLE, its mean over directions */
    double across[REACH_MOST * TABLE + 1]; /* that integrated along a line q from the middle */
    double
        bend; /* half the mean square of q along one axis: what the bend of rings moves them by */
};

static double table_at(const struct window *window, const double *table, double q) {
    double at = q * TABLE;
    if (!(at < (double)(window->reach * TABLE)))
        return 0;
    size_t a = (size_t)at;
    return table[a] + (at - (double)a) * (table[a + 1] - table[a]);
}

static double direction_mean(double q, double x, double y) {
    enum { DIRECTIONS = 128 };
    double total = 0;
    for (size_t d = 0; d < DIRECTIONS; d++) {
        double angle = M_PI / 2 * ((double)d + 0.5) / DIRECTIONS;
        total += window_power(q * cos(angle) * x) * window_power(q * sin(angle) * y);
    }
    return total * x * y / DIRECTIONS;
}

/* The same where rings are ellipses. */
static double lay_mean(const struct map_spectrum *s, double q, double x, double y) {
    enum { DIRECTIONS = 256 };
    const struct lay_frame *f = &s->frame;
    double total = 0;
    for (size_t d = 0; d < DIRECTIONS; d++) {
        double angle = M_PI * ((double)d + 0.5) / DIRECTIONS;
        double along = q * cos(angle) / s->lay.ratio, across = q * sin(angle) / s->lay.ratio;
        total += window_power((f->across_y * along - f->along_y * across) * x) *
                 window_power((f->along_x * across - f->across_x * along) * y);
    }
    return total * x * y / DIRECTIONS / s->lay.ratio;
}

static void window_fill(struct window *window, const struct map_spectrum *s) {
    static const double MEAN_SQUARE = 1. / 3; /* of q along one axis, side 1 */
    static const double STRAIGHT = 48;
    enum { STEPS = 8 };
    const struct grid *grid = &s->modes.grid;
    const struct lay_frame *f = &s->frame;
    const bool plain = lay_is_plain(&s->lay);
    double x = grid->lx / s->side, y = grid->ly / s->side;
    window->profile = grid_is_profile(grid);
    window->reach = (size_t)fmin(ceil(REACH * s->lay.ratio), REACH_MOST);
    window->straight = STRAIGHT * s->lay.ratio;
    for (size_t a = 0; a <= window->reach * TABLE; a++) {
        double q = (double)a / TABLE;
        window->mean[a] = window->profile ? window_power(q)
                          : plain         ? direction_mean(q, x, y)
                                          : lay_mean(s, q, x, y);
    }
    for (size_t a = 0; a <= window->reach * TABLE && !window->profile; a++) {
        double q = (double)a / TABLE;
        window->across[a] = table_at(window, window->mean, q) / STEPS;
        for (size_t t = 1; t < window->reach * STEPS; t++)
            window->across[a] +=
                2 * table_at(window, window->mean, hypot(q, (double)t / STEPS)) / STEPS;
    }
    window->bend = MEAN_SQUARE *
                   ((f->along_x * f->along_x + f->across_x * f->across_x) / (x * x) +
                    (f->along_y * f->along_y + f->across_y * f->across_y) / (y * y)) /
                   4;
}

/* Returns what a wave number s takes of those within a width of k, per density. Across, steps of a
 * quarter wave are exact: the window's power is that of a side of length 1. */
static double part_taken(const struct window *window, double s, double k, double width) {
    const double *table = window->mean, reach = (double)window->reach;
    if (window->profile)
        return width * (table_at(window, table, fabs(s - k)) + table_at(window, table, s + k));
    if (s > window->straight)
        return width * table_at(window, window->across, fabs(k - s - window->bend / s));
    double farthest = fmin((reach * reach - (s - k) * (s - k)) / (4 * s * k), 1), total = 0;
    if (farthest <= 0)
        return 0;
    double most = 2 * asin(sqrt(farthest));
    size_t steps = (size_t)(4 * most * sqrt(s * k)) + 12;
    for (size_t a = 0; a < steps; a++) {
        double half = most * ((double)a + 0.5) / (double)steps / 2;
        double across = 2 * sin(half);
        total += table_at(window, table, sqrt((s - k) * (s - k) + s * k * across * across));
    }
    return 2 * total * most / (double)steps * k * width;
}

static size_t window_first(size_t ring, size_t reach) {
    return ring > reach ? (ring - reach) * NODES - NODES / 2 : 0;
}
static size_t window_last(size_t ring, size_t reach) {
    return (ring + reach) * NODES + NODES / 2;
}

static void windowed_fill(struct spectrum_leakage *l, const struct map_spectrum *s,
                          const struct window *window) {
    const size_t reach = window->reach;
    size_t base = window_first(l->first, reach), at = 0;
    for (size_t a = 0; a < l->nodes; a++)
        l->node[a] = ((double)(base + a) + 0.5) / NODES;
    for (size_t r = 0; r < l->count; r++) {
        size_t ring = l->first + r, from = window_first(ring, reach) - base;
        size_t to = window_last(ring, reach) - base;
        l->offset[r] = from;
        l->begin[r] = at;
        for (size_t a = from; a < to; a++, at++)
            for (size_t part = 0; part < RING_PARTS; part++)
                if (s->share[ring][part] > 0)
                    l->weight[at] +=
                        s->share[ring][part] *
                        part_taken(window, s->distance[ring][part], l->node[a], l->width);
    }
    l->begin[l->count] = at;
}

/* Without a window, rings have what their modes have. */
static void plain_fill(struct spectrum_leakage *l, const struct map_spectrum *s) {
    l->nodes = 0;
    for (size_t r = 0; r < l->count; r++) {
        l->offset[r] = l->begin[r] = l->nodes;
        for (size_t part = 0; part < RING_PARTS; part++)
            if (s->share[l->first + r][part] > 0) {
                l->weight[l->nodes] = s->share[l->first + r][part];
                l->node[l->nodes++] = s->distance[l->first + r][part];
            }
    }
    l->begin[l->count] = l->nodes;
}

/* window: NULL without one. */
static int leakage_create(struct spectrum_leakage **out, const struct map_spectrum *s,
                          const struct window *window, size_t first, size_t last,
                          struct error *err) {
    struct spectrum_leakage *l = array_create(1, sizeof *l);
    if (l == NULL)
        return error_memory(err, sizeof *l, "leakage of a spectrum");
    size_t weights = last - first + 1;
    l->first = first;
    l->count = last - first + 1;
    l->width = 1. / (window != NULL ? NODES : RING_PARTS);
    l->nodes = window != NULL
                   ? window_last(last, window->reach) - window_first(first, window->reach)
                   : RING_PARTS * l->count;
    weights *= window != NULL ? (2 * window->reach + 1) * NODES : RING_PARTS;
    l->node = array_create(l->nodes, sizeof *l->node);
    l->offset = array_create(l->count, sizeof *l->offset);
    l->begin = array_create(l->count + 1, sizeof *l->begin);
    l->weight = array_create(weights, sizeof *l->weight);
    if (l->node == NULL || l->offset == NULL || l->begin == NULL || l->weight == NULL) {
        spectrum_leakage_destroy(&l);
        return error_memory(err, weights * sizeof *l->weight, "leakage of a spectrum");
    }
    if (window != NULL)
        windowed_fill(l, s, window);
    else
        plain_fill(l, s);
    *out = l;
    return 0;
}

int spectrum_leakage_create(struct spectrum_leakage **out, const struct map_spectrum *s,
                            size_t first, size_t last, struct error *err) {
    if (!s->windowed)
        return leakage_create(out, s, NULL, first, last, err);
    struct window *window = array_create(1, sizeof *window);
    if (window == NULL)
        return error_memory(err, sizeof *window, "leakage of a spectrum");
    window_fill(window, s);
    int status = leakage_create(out, s, window, first, last, err);
    free(window);
    return status;
}

void spectrum_leakage_destroy(struct spectrum_leakage **leakage) {
    struct spectrum_leakage *l = *leakage;
    if (l == NULL)
        return;
    free(l->node);
    free(l->offset);
    free(l->begin);
    free(l->weight);
    free(l);
    *leakage = NULL;
}

/* Rings added up together, of which no sum waits for another. */
enum { TOGETHER = 4 };

static void rings_apply(const struct spectrum_leakage *l, size_t first, const double *density,
                        double *expected) {
    const double *of[TOGETHER], *weight[TOGETHER];
    double total[TOGETHER] = {0};
    size_t count = l->begin[first + 1] - l->begin[first];
    for (size_t q = 0; q < TOGETHER; q++) {
        of[q] = density + l->offset[first + q];
        weight[q] = l->weight + l->begin[first + q];
    }
    for (size_t a = 0; a < count; a++)
        for (size_t q = 0; q < TOGETHER; q++)
            total[q] += weight[q][a] * of[q][a];
    for (size_t q = 0; q < TOGETHER; q++)
        expected[first + q] = total[q];
}

/* Returns whether the next rings are so many, and have as many weights each. */
static bool are_alike(const struct spectrum_leakage *l, size_t first) {
    bool alike = first + TOGETHER <= l->count;
    for (size_t r = first + 1; alike && r < first + TOGETHER; r++)
        alike = l->begin[r + 1] - l->begin[r] == l->begin[first + 1] - l->begin[first];
    return alike;
}

void spectrum_leakage_apply(const struct spectrum_leakage *l, const double *density,
                            double *expected) {
    for (size_t r = 0; r < l->count;) {
        if (are_alike(l, r)) {
            rings_apply(l, r, density, expected);
            r += TOGETHER;
            continue;
        }
        const double *of = density + l->offset[r], *weight = l->weight + l->begin[r];
        size_t count = l->begin[r + 1] - l->begin[r];
        double total = 0;
        for (size_t a = 0; a < count; a++)
            total += weight[a] * of[a];
        expected[r++] = total;
    }
}
