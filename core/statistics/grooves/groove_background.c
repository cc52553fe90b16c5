#include "core/statistics/grooves/groove_background.h"
#include "core/surface/spectrum.h"
#include <math.h>
#include <stdlib.h>

/* Of powers that are distributed exponentially: median over mean, and the mean of the logarithm of
 * power over mean. */
static const double MEDIAN = M_LN2, MEAN_LOGARITHM = -0.5772156649015329;
/* Powers of a ring that count as independent, under Hann's window and by a median. */
static const double INDEPENDENT = 0.8;

struct groove_background {
    const struct modes *modes;
    struct lay_frame frame;
    bool profile;
    double side; /* the shorter one: rings are 2 pi/side wide */
    size_t rings;
    double *power,
        *count; /* of each ring: median over MEDIAN, and how many waves; owned by power */
};

static int by_value(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double median_of(double *values, size_t n) {
    if (n == 0)
        return 0;
    qsort(values, n, sizeof *values, by_value);
    return n % 2 == 1 ? values[n / 2] : (values[n / 2 - 1] + values[n / 2]) / 2;
}

/* Returns which ring a wave of mx, my periods is in, as a real number. */
static double ring_of(const struct groove_background *b, double mx, double my) {
    const struct grid *grid = &b->modes->grid;
    if (b->profile)
        return fabs(mx);
    return lay_length(&b->frame, mx * b->side / grid->lx, my * b->side / grid->ly);
}

/* Waves of one half of the plane, each of which stands for its image. */
static long first_row(const struct groove_background *b, size_t mx) {
    return b->profile ? 0 : mx > 0 ? -(long)b->modes->mode_y : 1;
}

static size_t ring_at(const struct groove_background *b, size_t mx, long my) {
    const double ring = round(ring_of(b, (double)mx, (double)my));
    return ring < (double)b->rings ? (size_t)ring : b->rings;
}

/* Sorts the powers into rings, behind each other, and takes medians. */
static int measure(struct groove_background *b, struct error *err) {
    const struct modes *modes = b->modes;
    const size_t waves = (modes->mode_x + 1) * (2 * modes->mode_y + 1);
    double *sorted = array_create(waves, sizeof *sorted);
    size_t *start = array_create(b->rings + 2, sizeof *start);
    int status = sorted != NULL && start != NULL
                     ? 0
                     : error_memory(err, waves * sizeof *sorted, "rings of a spectrum");
    for (int pass = 0; pass < 2 && status == 0; pass++) {
        for (size_t mx = 0; mx <= modes->mode_x; mx++)
            for (long my = first_row(b, mx); my <= (long)modes->mode_y; my++) {
                const size_t ring = ring_at(b, mx, my);
                if (ring >= b->rings)
                    continue;
                if (pass == 1)
                    sorted[start[ring] + (size_t)b->count[ring]] = modes_power(modes, mx, my);
                b->count[ring]++;
            }
        for (size_t r = 0; r < b->rings && pass == 0; r++) {
            start[r + 1] = start[r] + (size_t)b->count[r];
            b->count[r] = 0;
        }
    }
    for (size_t r = 0; r < b->rings && status == 0; r++)
        b->power[r] = median_of(sorted + start[r], (size_t)b->count[r]) / MEDIAN;
    free(sorted);
    free(start);
    return status;
}

int groove_background_create(struct groove_background **out, const struct modes *modes,
                             const struct lay *lay, struct error *err) {
    struct groove_background *b = array_create(1, sizeof *b);
    if (b == NULL)
        return error_memory(err, sizeof *b, "the waves of a random face");
    const struct grid *grid = &modes->grid;
    b->modes = modes;
    b->profile = grid_is_profile(grid);
    b->frame = lay_frame_of(lay);
    b->side = b->profile ? grid->lx : fmin(grid->lx, grid->ly);
    /* as far as the ellipses are whole, and beyond by their corners */
    b->rings = (size_t)ceil(1.5 * ring_of(b, b->profile ? (double)modes->mode_x : 0,
                                          b->profile ? 0 : (double)modes->mode_y)) +
               2;
    const double across = ring_of(b, (double)modes->mode_x, 0);
    if (across + 2 > (double)b->rings)
        b->rings = (size_t)ceil(across) + 2;
    b->power = array_create(2 * b->rings, sizeof *b->power);
    int status = b->power != NULL ? 0 : error_memory(err, 2 * b->rings * sizeof *b->power, "rings");
    if (status == 0) {
        b->count = b->power + b->rings;
        status = measure(b, err);
    }
    if (status != 0)
        groove_background_destroy(&b);
    *out = b;
    return status;
}

void groove_background_destroy(struct groove_background **background) {
    if (*background != NULL)
        free((*background)->power);
    free(*background);
    *background = NULL;
}

/* --- profiles: a wave has neighbours along one line alone --- */

enum { NEAREST = 3, FARTHEST = 14 };

/* Extends the logarithms of the powers on one side of a wave to it, by a straight line. */
static double one_side(const struct groove_background *b, size_t m, int sign) {
    double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
    for (int d = NEAREST; d <= FARTHEST; d++) {
        const long at = (long)m + sign * d;
        if (at < 1 || at > (long)b->modes->mode_x)
            continue;
        const double power = modes_power(b->modes, (size_t)at, 0);
        if (!(power > 0))
            continue;
        const double x = log((double)at / (double)m), y = log(power) - MEAN_LOGARITHM;
        n++;
        sx += x;
        sy += y;
        sxx += x * x;
        sxy += x * y;
    }
    const double spread = n * sxx - sx * sx;
    return n > 4 && spread > 0 ? exp((sy * sxx - sx * sxy) / spread) : 0;
}

static double both_sides(const struct groove_background *b, size_t m) {
    double near[2 * FARTHEST];
    size_t n = 0;
    for (int d = -FARTHEST; d <= FARTHEST; d++) {
        const long at = (long)m + d;
        if (abs(d) >= NEAREST && at >= 1 && at <= (long)b->modes->mode_x)
            near[n++] = modes_power(b->modes, (size_t)at, 0);
    }
    return median_of(near, n) / MEDIAN;
}

/* --- both --- */

/* Returns the median power of the neighbours of a wave on all sides, but for the nearest, which a
 * line has part of. */
static double neighbours(const struct groove_background *b, double mx, double my) {
    enum { REACH = 5, WIDTH = 2 * REACH + 1 };
    const struct modes *modes = b->modes;
    double near[WIDTH * WIDTH];
    size_t n = 0;
    for (long dy = -REACH; dy <= REACH; dy++)
        for (long dx = -REACH; dx <= REACH; dx++) {
            long x = lround(mx) + dx, y = lround(my) + dy;
            if (labs(dx) < NEAREST && labs(dy) < NEAREST)
                continue;
            if (x < 0) {
                x = -x;
                y = -y;
            }
            if (x <= (long)modes->mode_x && labs(y) <= (long)modes->mode_y && (x > 0 || y != 0))
                near[n++] = modes_power(modes, (size_t)x, y);
        }
    return median_of(near, n) / MEDIAN;
}

double groove_background_power(const struct groove_background *b, double mx, double my) {
    if (b->profile)
        return both_sides(b, (size_t)fmax(round(fabs(mx)), 1));
    const double ring = fmax(ring_of(b, mx, my), 1);
    const size_t low = (size_t)ring;
    if (low + 1 >= b->rings)
        return neighbours(b, mx, my);
    const double part = ring - (double)low, from = b->power[low], to = b->power[low + 1];
    return from > 0 && to > 0 ? from * pow(to / from, part) : fmax(from, to);
}

double groove_background_p_value(const struct groove_background *b, double mx, double my,
                                 double power) {
    double expected = 0, count = 0;
    if (b->profile) {
        const size_t m = (size_t)fmax(round(fabs(mx)), 1);
        expected = fmax(both_sides(b, m), fmax(one_side(b, m, 1), one_side(b, m, -1)));
        count = FARTHEST;
    } else {
        const size_t ring = (size_t)fmax(round(ring_of(b, mx, my)), 1);
        expected = neighbours(b, mx, my);
        for (size_t r = ring - 1; r <= ring + 1 && r < b->rings; r++)
            if (r > 0 && b->count[r] > 0)
                expected = fmax(expected, b->power[r]);
        count = ring < b->rings ? b->count[ring] : 0;
    }
    const double freedom = fmax(INDEPENDENT * count, 1);
    return expected > 0 ? exp(-freedom * log1p(power / expected / freedom)) : 1;
}
