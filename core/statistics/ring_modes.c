#include "core/statistics/ring_modes.h"
#include <math.h>
#include <stdlib.h>

/* A quarter plane of modes, mx and my >= 0, each for its mirror images. */
struct quarter {
    size_t nx, ny;  /* modes along each axis */
    size_t *ring;   /* nx * ny; `rings` beyond them */
    double *weight; /* density expected over that of the ring */
    double *total;  /* of weights by ring */
};

static double mode_distance(const struct map_spectrum *s, size_t mx, size_t my) {
    const struct grid *grid = &s->modes.grid;
    return hypot((double)mx * (s->side / grid->lx),
                 grid_is_profile(grid) ? 0 : (double)my * (s->side / grid->ly));
}

/* How many modes of the full plane a mode of the quarter stands for. */
static double images(size_t mx, size_t my) {
    return (mx > 0 ? 2 : 1) * (my > 0 ? 2 : 1);
}

/* Counts circles up to the Nyquist wave number of both axes, but half a ring. */
static size_t whole_rings(const struct map_spectrum *s) {
    const struct grid *grid = &s->modes.grid;
    double reach = (double)grid->nx / 2 * (s->side / grid->lx);
    if (!grid_is_profile(grid))
        reach = fmin(reach, (double)grid->ny / 2 * (s->side / grid->ly));
    size_t rings = (size_t)fmax(reach + 0.5, 1);
    return rings < s->bins ? rings : s->bins;
}

enum { SLOPE_RINGS = 3, SLOPED_RINGS = 16 };

/* Returns the exponent by which the density falls about ring r, by the rings nearby, 0 to 4. */
static double ring_slope(const struct map_spectrum *s, size_t r) {
    double n = 0, x = 0, y = 0, xx = 0, xy = 0;
    for (size_t b = r > SLOPE_RINGS ? r - SLOPE_RINGS : 1; b <= r + SLOPE_RINGS && b < s->rings;
         b++)
        if (s->density[b] > 0) {
            double u = log((double)b), v = log(s->density[b]);
            n++;
            x += u;
            y += v;
            xx += u * u;
            xy += u * v;
        }
    double spread = n * xx - x * x;
    return spread > 0 ? fmin(fmax((x * y - n * xy) / spread, 0), 4) : 0;
}

/* Makes shares and means of counts and sums. */
static void parts_divide(struct map_spectrum *s) {
    for (size_t r = 0; r < s->rings; r++) {
        double count = 0;
        for (size_t part = 0; part < RING_PARTS; part++) {
            count += s->share[r][part];
            if (s->share[r][part] > 0)
                s->distance[r][part] /= s->share[r][part];
        }
        for (size_t part = 0; part < RING_PARTS; part++)
            s->share[r][part] /= count;
    }
}

/* Sorts the modes into rings and their parts. */
static void modes_sort(struct map_spectrum *s, const struct quarter *quarter) {
    for (size_t mx = 0; mx < quarter->nx; mx++)
        for (size_t my = 0; my < quarter->ny; my++) {
            double distance = mode_distance(s, mx, my), slope = 0;
            size_t r = (size_t)(distance + 0.5), at = mx * quarter->ny + my;
            quarter->ring[at] = r < s->rings ? r : s->rings;
            if (r >= s->rings)
                continue;
            if (r > 0 && r < SLOPED_RINGS)
                slope = ring_slope(s, r);
            quarter->weight[at] = slope > 0 ? pow(distance / (double)r, -slope) : 1;
            quarter->total[r] += images(mx, my) * quarter->weight[at];
            size_t part = (size_t)((distance + 0.5 - (double)r) * RING_PARTS);
            part = part < RING_PARTS ? part : RING_PARTS - 1;
            s->share[r][part] += images(mx, my);
            s->distance[r][part] += images(mx, my) * distance;
        }
}

/* Adds the correlations of one mode with those nearby to the covariance of their rings. */
static void mode_correlate(struct map_spectrum *s, const struct quarter *quarter, size_t mx,
                           size_t my, long reach_x, long reach_y) {
    size_t at = mx * quarter->ny + my, r = quarter->ring[at];
    double weight = images(mx, my) * quarter->weight[at];
    for (long dx = -reach_x; dx <= reach_x; dx++) {
        size_t x = (size_t)labs((long)mx + dx);
        for (long dy = -reach_y; dy <= reach_y && x < quarter->nx; dy++) {
            size_t y = (size_t)labs((long)my + dy), beside = x * quarter->ny + y;
            if (y >= quarter->ny || quarter->ring[beside] < r ||
                quarter->ring[beside] >= s->rings || quarter->ring[beside] - r >= RING_REACH)
                continue;
            s->covariance[r][quarter->ring[beside] - r] +=
                weight * quarter->weight[beside] * window_correlation(dx) * window_correlation(dy);
        }
    }
}

static void modes_correlate(struct map_spectrum *s, const struct quarter *quarter, double heights) {
    bool profile = grid_is_profile(&s->modes.grid);
    long reach = s->windowed ? 2 : 0;
    for (size_t mx = 0; mx < quarter->nx; mx++)
        for (size_t my = 0; my < quarter->ny; my++)
            if (quarter->ring[mx * quarter->ny + my] < s->rings)
                mode_correlate(s, quarter, mx, my, reach, profile ? 0 : reach);
    for (size_t r = 0; r < s->rings; r++)
        for (size_t d = 0; d < RING_REACH && r + d < s->rings; d++)
            s->covariance[r][d] *= 2 / (quarter->total[r] * quarter->total[r + d] * heights);
}

/* Adds up over the rings first to last - 1: the squares of powers over the ring's mean. Returns how
 * much they exceed those of waves of one mean and random amplitudes, 2, beyond chance; at least 1:
 * densities that differ by direction do. */
static double excess(const struct map_spectrum *s, size_t first, size_t last, double count,
                     double squares) {
    double independent = 0;
    for (size_t r = first; r < last; r++)
        independent += 1 / s->covariance[r][0];
    double found = count > 0 ? squares / (2 * count) : 1;
    return found > 1 + 2 * sqrt(5 / independent) ? found : 1;
}

static void ring_squares(const struct map_spectrum *s, const struct quarter *quarter,
                         double *squares) {
    const struct modes *modes = &s->modes;
    for (size_t mx = 0; mx < quarter->nx; mx++)
        for (size_t my = 0; my < quarter->ny; my++) {
            size_t r = quarter->ring[mx * quarter->ny + my];
            double other = modes_power(modes, mx, 2 * my == modes->grid.ny ? (long)my : -(long)my);
            double one = modes_power(modes, mx, (long)my);
            if (r < s->rings)
                squares[r] += images(mx, my) * (one * one + other * other) / 2;
        }
}

/* Takes directions of unlike densities into account, octave by octave. */
static void rings_widen(struct map_spectrum *s, const struct quarter *quarter, double *squares) {
    const struct grid *grid = &s->modes.grid;
    double cell =
        grid_is_profile(grid) ? grid->lx / (2 * M_PI) : grid->lx * grid->ly / (4 * M_PI * M_PI);
    enum { LOWEST = 8 };
    static const double STEEP = 0.6, DEEP = 0.03; /* below, a ring is beyond an end */
    ring_squares(s, quarter, squares);
    for (size_t first = LOWEST; first < s->rings; first *= 2) {
        size_t last = 2 * first < s->rings ? 2 * first : s->rings;
        double count = 0, sum = 0;
        for (size_t r = first; r < last; r++)
            if (s->density[r] > STEEP * s->density[r - 1] &&
                s->density[r] > DEEP * s->density[first]) {
                count += quarter->total[r];
                sum += squares[r] * pow(cell / (s->density[r] * s->power), 2);
            }
        double factor = excess(s, first, last, count, sum);
        for (size_t r = first == LOWEST ? 0 : first; r < last; r++)
            for (size_t d = 0; d < RING_REACH; d++)
                s->covariance[r][d] *= factor;
    }
}

int ring_modes_measure(struct map_spectrum *s, double heights, struct error *err) {
    const struct grid *grid = &s->modes.grid;
    struct quarter quarter = {.nx = grid->nx / 2 + 1, .ny = grid->ny / 2 + 1};
    size_t count = quarter.nx * quarter.ny;
    s->rings = whole_rings(s);
    quarter.ring = array_create(count, sizeof *quarter.ring);
    quarter.weight = array_create(count, sizeof *quarter.weight);
    quarter.total = array_create(2 * s->bins, sizeof *quarter.total);
    bool made = quarter.ring != NULL && quarter.weight != NULL && quarter.total != NULL;
    if (made) {
        modes_sort(s, &quarter);
        parts_divide(s);
        modes_correlate(s, &quarter, heights);
        rings_widen(s, &quarter, quarter.total + s->bins);
        for (size_t r = 0; r < s->rings; r++)
            s->freedom[r] = 2 / s->covariance[r][0];
    }
    free(quarter.ring);
    free(quarter.weight);
    free(quarter.total);
    return made ? 0 : error_memory(err, count * sizeof *quarter.weight, "rings of modes");
}
