#include "core/statistics/grooves/groove_background.h"
#include "core/surface/spectrum.h"
#include <gsl/gsl_statistics_double.h>
#include <math.h>
#include <stdlib.h>

/* Of powers that are distributed exponentially: median over mean. */
static const double MEDIAN = M_LN2;
/* Powers of a ring that count as independent, under Hann's window and by a median. */
static const double INDEPENDENT = 0.8;
/* White noise of 1 % of the RMS height is taken for granted. */
static const double NOISE = 1e-4;

struct groove_background {
    const struct modes *modes;
    struct lay_frame frame;
    bool profile;
    double side;  /* the shorter one: rings are 2 pi/side wide */
    double least; /* power of a wave: less is leakage of the window, and rounding */
    size_t rings;
    double *power,
        *count; /* of each ring: median over MEDIAN, and how many waves; owned by power */
};

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
        b->power[r] = gsl_stats_median(sorted + start[r], 1, (size_t)b->count[r]) / MEDIAN;
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
    double total = 0;
    const size_t waves = (modes->mode_x + 1) * (2 * modes->mode_y + 1);
    for (size_t w = 0; w < waves; w++)
        total += modes->power[w];
    b->least = NOISE * total / (double)waves;
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

enum { NEAREST = 3, FARTHEST = 22 };

/* Returns the mean power of the waves on the sides from..to of a wave (-1: longer ones, 1:
 * shorter), by their median, each times its ratio to the wave to the power `fall`. */
static double sides(const struct groove_background *b, size_t m, int from, int to, double fall) {
    double near[2 * FARTHEST];
    size_t n = 0;
    for (int side = from; side <= to; side += 2)
        for (int d = NEAREST; d <= FARTHEST; d++) {
            const long at = (long)m + side * d;
            if (at >= 1 && at <= (long)b->modes->mode_x)
                near[n++] =
                    modes_power(b->modes, (size_t)at, 0) * pow((double)at / (double)m, fall);
        }
    return gsl_stats_median(near, 1, n) / MEDIAN;
}

static double both_sides(const struct groove_background *b, size_t m) {
    return sides(b, m, -1, 1, 0);
}

/* Returns the largest that a smooth spectrum may have, also at its ends: spectra fall with the wave
 * number to a power up to about 3. */
static double side_most(const struct groove_background *b, size_t m) {
    return fmax(both_sides(b, m), fmax(sides(b, m, -1, -1, 1.5), sides(b, m, 1, 1, 3)));
}

/* --- both --- */

/* Neighbours of a wave on all sides, but for the nearest, which a line has part of: all of them,
 * and by the eighth of a turn that they are in, where longer ones count as a spectrum has them that
 * falls with the wave number to the power FALL. */
static const double FALL = 3.3;
enum { REACH = 5, WIDTH = 2 * REACH + 1, PARTS = 8 };
struct neighbours {
    size_t count, part_count[PARTS];
    double all[WIDTH * WIDTH], part[PARTS][WIDTH * WIDTH];
};

static void neighbours_find(struct neighbours *out, const struct groove_background *b, double mx,
                            double my) {
    const struct modes *modes = b->modes;
    const double own = fmax(ring_of(b, mx, my), 1);
    *out = (struct neighbours){.count = 0};
    for (long dy = -REACH; dy <= REACH; dy++)
        for (long dx = -REACH; dx <= REACH; dx++) {
            long x = lround(mx) + dx, y = lround(my) + dy;
            if (labs(dx) < NEAREST && labs(dy) < NEAREST)
                continue;
            if (x < 0) {
                x = -x;
                y = -y;
            }
            if (x > (long)modes->mode_x || labs(y) > (long)modes->mode_y || (x == 0 && y == 0))
                continue;
            const double turn = atan2((double)dy, (double)dx) / (2 * M_PI) + 0.5;
            const size_t part = (size_t)(PARTS * turn) % PARTS;
            const double power = modes_power(modes, (size_t)x, y);
            const double nearer = fmin(ring_of(b, (double)x, (double)y) / own, 1);
            out->all[out->count++] = power;
            out->part[part][out->part_count[part]++] = power * pow(nearer, FALL);
        }
}

/* Returns the mean power of the neighbours, by their median; parts: of the part that has most. */
static double neighbours(const struct groove_background *b, double mx, double my, bool parts) {
    struct neighbours near;
    neighbours_find(&near, b, mx, my);
    double most = gsl_stats_median(near.all, 1, near.count);
    for (size_t p = 0; p < PARTS && parts; p++)
        most = fmax(most, gsl_stats_median(near.part[p], 1, near.part_count[p]));
    return most / MEDIAN;
}

/* Returns the largest power of the rings that a wave and those beside it are in, from which the
 * window takes some. */
static double rings_near(const struct groove_background *b, double mx, double my) {
    const double at[] = {ring_of(b, mx - 1, my), ring_of(b, mx + 1, my), ring_of(b, mx, my - 1),
                         ring_of(b, mx, my + 1)};
    double low = at[0], high = at[0], most = 0;
    for (size_t a = 1; a < 4; a++) {
        low = fmin(low, at[a]);
        high = fmax(high, at[a]);
    }
    for (size_t r = (size_t)fmax(round(low), 1); r <= (size_t)round(high) && r < b->rings; r++)
        if (b->count[r] > 0)
            most = fmax(most, b->power[r]);
    return most;
}

/* --- waves across the lines of the map, in which offsets of whole lines are --- */

/* What the waves have that are `own` periods along one axis and any number along the other, beyond
 * those 3 to 5 periods beside them, and how many waves it is known by. */
struct axis_excess {
    double power, freedom;
};

static double wave_power(const struct groove_background *b, bool along_y, long own, long at) {
    const long mx = along_y ? own : at, my = along_y ? at : own;
    return modes_power(b->modes, (size_t)labs(mx), mx < 0 ? -my : my);
}

/* Returns the excess about wave m by shorter ones, of which the surface has least, without the
 * harmonics of a wave of `base` periods. Offsets of lines may fall with the wave number, as where
 * an instrument drifts. */
static struct axis_excess axis_excess(const struct groove_background *b, bool along_y, long own,
                                      double m, double base) {
    enum { WAVES = 40, LAST = 5, BESIDE = 2 * (LAST - NEAREST + 1) };
    static const double BY_MEDIAN = 0.25, FEW = 5;
    static const double LINE = 1.7; /* as far as the window takes any of it */
    const long last = (long)(along_y ? b->modes->mode_y : b->modes->mode_x), from = lround(m);
    const long first = last - WAVES - NEAREST < from ? last - WAVES - NEAREST : from;
    double on[WAVES], beside[WAVES * BESIDE];
    size_t n = 0, others = 0;
    for (long at = first > 1 ? first : 1; at <= last && n < WAVES; at++) {
        const double fall = (double)at / m;
        if (fabs(remainder((double)at, base)) < LINE)
            continue;
        on[n++] = fall * wave_power(b, along_y, own, at);
        for (int d = NEAREST; d <= LAST; d++) {
            beside[others++] = fall * wave_power(b, along_y, own - d, at);
            beside[others++] = fall * wave_power(b, along_y, own + d, at);
        }
    }
    if (n == 0)
        return (struct axis_excess){0};
    return (struct axis_excess){
        fmax((gsl_stats_median(on, 1, n) - gsl_stats_median(beside, 1, others)) / MEDIAN, 0),
        fmax(BY_MEDIAN * (double)n, FEW)};
}

/* Returns the excess where a wave is of an axis, or beside it as far as the window takes some
 * there; {0} for others. Waves may be any of the first harmonics of grooves, whose base leaves
 * least.
 */
static struct axis_excess axis_excess_at(const struct groove_background *b, double mx, double my) {
    enum { SIDE_LEAST = 8, HARMONICS = 6, MAP_PERIODS = 4 };
    static const double BESIDE = 1.5;
    struct axis_excess most = {0};
    for (int along_y = 0; along_y < 2 && !b->profile; along_y++) {
        const double own = fabs(along_y ? mx : my), m = fabs(along_y ? my : mx);
        if (own >= BESIDE || m < 1 || (along_y ? b->modes->mode_x : b->modes->mode_y) < SIDE_LEAST)
            continue;
        struct axis_excess least = axis_excess(b, along_y != 0, lround(own), m, m);
        for (int h = 2; h <= HARMONICS && m / h >= MAP_PERIODS; h++) {
            const struct axis_excess one = axis_excess(b, along_y != 0, lround(own), m, m / h);
            least = one.power < least.power ? one : least;
        }
        most = least.power > most.power ? least : most;
    }
    return most;
}

static double power_at(const struct groove_background *b, double mx, double my) {
    if (b->profile)
        return both_sides(b, (size_t)fmax(round(fabs(mx)), 1));
    const double ring = fmax(ring_of(b, mx, my), 1);
    const size_t low = (size_t)ring;
    if (low + 1 >= b->rings)
        return neighbours(b, mx, my, false);
    const double part = ring - (double)low, from = b->power[low], to = b->power[low + 1];
    return from > 0 && to > 0 ? from * pow(to / from, part) : fmax(from, to);
}

/* Returns the median of what the neighbours have over what their rings have; that of the quarter of
 * them that has most, where that is so much more that an end of the spectrum must be near, of which
 * rings along a lay do not say exactly where it is. */
static double ratio_near(const struct groove_background *b, double mx, double my) {
    enum { FAR = 8, ACROSS = 2 * FAR + 1, QUARTERS = 4 };
    static const double END = 4;
    const struct modes *modes = b->modes;
    double all[ACROSS * ACROSS], quarter[QUARTERS][ACROSS * ACROSS], most = 0;
    size_t count = 0, quarter_count[QUARTERS] = {0};
    for (long dy = -FAR; dy <= FAR; dy++)
        for (long dx = -FAR; dx <= FAR; dx++) {
            const long x = lround(mx) + dx, y = lround(my) + dy;
            if ((labs(dx) < NEAREST && labs(dy) < NEAREST) || (x == 0 && y == 0) ||
                labs(x) > (long)modes->mode_x || labs(y) > (long)modes->mode_y)
                continue;
            const double ring = power_at(b, (double)x, (double)y);
            if (!(ring > 0))
                continue;
            const double ratio = modes_power(modes, (size_t)labs(x), x < 0 ? -y : y) / ring;
            const size_t q = labs(dx) > labs(dy) ? dx > 0 : 2 + (dy > 0);
            all[count++] = ratio;
            quarter[q][quarter_count[q]++] = ratio;
        }
    const double middle = gsl_stats_median(all, 1, count);
    for (size_t q = 0; q < QUARTERS; q++)
        most = fmax(most, gsl_stats_median(quarter[q], 1, quarter_count[q]));
    return (most > END * middle ? most : middle) / MEDIAN;
}

double groove_background_near(const struct groove_background *b, double mx, double my) {
    const double ring = power_at(b, mx, my);
    return b->profile ? ring : ring * ratio_near(b, mx, my) + axis_excess_at(b, mx, my).power;
}

double groove_background_power(const struct groove_background *b, double mx, double my) {
    return fmax(power_at(b, mx, my) + axis_excess_at(b, mx, my).power, b->least);
}

double groove_background_p_value(const struct groove_background *b, double mx, double my,
                                 double power, enum groove_test test) {
    double expected = 0, count = 0;
    if (b->profile) {
        const size_t m = (size_t)fmax(round(fabs(mx)), 1);
        expected = side_most(b, m);
        count = FARTHEST;
    } else {
        const size_t ring = (size_t)fmax(round(ring_of(b, mx, my)), 1);
        expected = fmax(neighbours(b, mx, my, test == GROOVE_ALONE), rings_near(b, mx, my));
        count = ring < b->rings ? b->count[ring] : 0;
    }
    double freedom = fmax(INDEPENDENT * count, 1);
    expected = fmax(expected, b->least);
    if (!(expected > 0))
        return 1;
    const struct axis_excess axis =
        test == GROOVE_SOUGHT ? (struct axis_excess){0} : axis_excess_at(b, mx, my);
    const double all = expected + axis.power;
    if (axis.power > 0)
        freedom =
            all * all / (expected * expected / freedom + axis.power * axis.power / axis.freedom);
    return exp(-freedom * log1p(power / all / freedom));
}
