#include "core/statistics/heights/functional.h"
#include "core/statistics/lanes.h"
#include "core/statistics/summits/hills.h"
#include "core/surface/iteration/rank.h"
#include "core/vectors.h"
#include <math.h>
#include <stdlib.h>

/* --- the curve --- */

int material_curve_create(struct material_curve *out, const struct measured_map *map,
                          struct error *err) {
    const size_t points = grid_points(map->grid);
    struct average mean = {0};
    struct ranker *ranker = NULL;
    for (size_t point = 0; point < points; point++)
        average_add(&mean, map->z[point]);
    if (mean.count == 0)
        return error_set(err, ERROR_INPUT, "the map has no heights, only holes");
    *out = (struct material_curve){.mean = average_value(&mean)};
    out->z = array_create(mean.count, sizeof *out->z);
    if (out->z == NULL)
        return error_memory(err, mean.count * sizeof *out->z, "heights in order");
    for (size_t point = 0; point < points; point++)
        if (!isnan(map->z[point]))
            out->z[out->n++] = map->z[point] - out->mean;
    int status = ranker_create(&ranker, out->n, err);
    if (status == 0)
        status = rank_sort(ranker, out->z, err);
    ranker_destroy(&ranker);
    if (status != 0)
        material_curve_clear(out);
    return status;
}

void material_curve_clear(struct material_curve *curve) {
    free(curve->z);
    *curve = (struct material_curve){0};
}

/* Returns height number k from the highest. */
static double height_number(const struct material_curve *curve, size_t k) {
    return curve->z[curve->n - 1 - k];
}

static double ratio_of(const struct material_curve *curve, size_t k) {
    return ((double)k + 0.5) / (double)curve->n;
}

double material_height(const struct material_curve *curve, double ratio) {
    const double at = ratio * (double)curve->n - 0.5, last = (double)(curve->n - 1);
    if (!(at > 0))
        return height_number(curve, 0);
    if (at >= last)
        return height_number(curve, curve->n - 1);
    const size_t k = (size_t)at;
    const double above = height_number(curve, k);
    return above + (at - (double)k) * (height_number(curve, k + 1) - above);
}

double material_ratio(const struct material_curve *curve, double height) {
    size_t lower = 0, end = curve->n; /* how many are lower is between these */
    while (lower < end) {
        const size_t middle = lower + (end - lower) / 2;
        if (curve->z[middle] < height)
            lower = middle + 1;
        else
            end = middle;
    }
    const size_t reach = curve->n - lower;
    if (reach == 0 || lower == 0)
        return reach == 0 ? 0 : 1;
    const double above = height_number(curve, reach - 1), below = height_number(curve, reach);
    return ratio_of(curve, reach - 1) + (above - height) / (above - below) / (double)curve->n;
}

/* Integrals of the curve z(m) over a range: of z, and of z (m - middle). */
struct integrals {
    double zeroth, first;
};

/* Adds the integrals between two corners. */
static void straight_add(struct integrals *out, double middle, double from, double z, double to,
                         double z_to) {
    out->zeroth += (to - from) * (z + z_to) / 2;
    out->first +=
        (to - from) / 6 * ((2 * z + z_to) * (from - middle) + (z + 2 * z_to) * (to - middle));
}

enum { TOGETHER = 64 * LANES }; /* heights whose lanes are added up at once */

/* Adds heights number k to k + n - 1, and each times its number less `middle`. */
WIDE_VECTORS static void corners_add(const struct material_curve *curve, size_t k, size_t n,
                                     double middle, struct lanes *restrict zeroth,
                                     struct lanes *restrict first) {
    const double *z = curve->z + (curve->n - k - n);
    const double last = (double)(k + n - 1) - middle;
    const size_t whole = n - n % LANES;
    for (size_t i = 0; i < whole; i += LANES)
        for (size_t l = 0; l < LANES; l++) {
            zeroth->sum[l] += z[i + l];
            first->sum[l] += z[i + l] * (last - (double)i - (double)l);
        }
    for (size_t i = whole; i < n; i++) {
        zeroth->sum[i - whole] += z[i];
        first->sum[i - whole] += z[i] * (last - (double)i);
    }
}

/* Integrates exactly. Between the first and the last corner inside a height counts by the hat that
 * it is the tip of; these two have half a hat each. */
static struct integrals integrate(const struct material_curve *curve, double from, double to) {
    const double n = (double)curve->n, width = 1 / n, middle = (from + to) / 2;
    const double corner = fmax(ceil(from * n - 0.5), 0), beyond = fmin(ceil(to * n - 0.5), n);
    const double z_from = material_height(curve, from), z_to = material_height(curve, to);
    struct integrals out = {0, 0};
    if (!(corner < beyond)) {
        straight_add(&out, middle, from, z_from, to, z_to);
        return out;
    }
    const size_t begin = (size_t)corner, last = (size_t)beyond - 1;
    const double m_begin = ratio_of(curve, begin), m_last = ratio_of(curve, last);
    const double z_begin = height_number(curve, begin), z_last = height_number(curve, last);
    struct lane_mean zeroth = {0}, first = {0};
    for (size_t k = begin; k <= last; k += TOGETHER) {
        struct lanes heights = {0}, moments = {0};
        corners_add(curve, k, last + 1 - k < TOGETHER ? last + 1 - k : TOGETHER, middle * n - 0.5,
                    &heights, &moments);
        lane_mean_add(&zeroth, &heights);
        lane_mean_add(&first, &moments);
    }
    out.zeroth = width * (sum_value(&zeroth.sum) - (z_begin + z_last) / 2);
    out.first = width * (width * sum_value(&first.sum) - z_begin * (m_begin - middle) / 2 -
                         z_last * (m_last - middle) / 2 + width * (z_begin - z_last) / 6);
    straight_add(&out, middle, from, z_from, m_begin, z_begin);
    straight_add(&out, middle, m_last, z_last, to, z_to);
    return out;
}

/* --- core, peaks and valleys --- */

static const double CENTRAL = 0.4; /* share of the curve that the secant spans */

/* The least fall of the curve over the central share, and where it begins. */
struct flattest {
    double fall, from;
};

static void flattest_see(struct flattest *flattest, const struct material_curve *curve,
                         double from) {
    const double end = fmin(ratio_of(curve, 0), (1 - CENTRAL) / 2); /* of the heights */
    if (from < end || from > 1 - CENTRAL - end)
        return;
    const double fall = material_height(curve, from) - material_height(curve, from + CENTRAL);
    if (fall < flattest->fall || (fall == flattest->fall && from < flattest->from))
        *flattest = (struct flattest){fall, from};
}

/* The fall is linear between the positions where either end is on a corner of the curve. Both ends
 * lie between the highest height and the lowest, beyond which the curve is level. */
static struct flattest flattest_find(const struct material_curve *curve) {
    struct flattest flattest = {INFINITY, 0};
    flattest_see(&flattest, curve, (1 - CENTRAL) / 2); /* of two heights it is the only one */
    for (size_t k = 0; k < curve->n; k++) {
        flattest_see(&flattest, curve, ratio_of(curve, k));
        flattest_see(&flattest, curve, ratio_of(curve, k) - CENTRAL);
    }
    return flattest;
}

/* upper, lower: heights of the line at the ratios 0 and 1. Where many heights are equal to one of
 * these, but for rounding, they are of the core. */
static struct material_core core_between(const struct material_curve *curve, double upper,
                                         double lower) {
    const double rounding = 1e-12 * (height_number(curve, 0) - height_number(curve, curve->n - 1));
    struct material_core core = {.k = upper - lower,
                                 .mr1 = material_ratio(curve, upper + rounding),
                                 .mr2 = material_ratio(curve, lower - rounding)};
    const double peaks = integrate(curve, 0, core.mr1).zeroth - core.mr1 * upper;
    const double valleys = (1 - core.mr2) * lower - integrate(curve, core.mr2, 1).zeroth;
    core.pk = core.mr1 > 0 ? 2 * peaks / core.mr1 : 0;
    core.vk = core.mr2 < 1 ? 2 * valleys / (1 - core.mr2) : 0;
    return core;
}

static const double PEAK_RATIO = 0.1, VALLEY_RATIO = 0.8; /* of the volumes, the defaults */
static const double EXTREME_RATIO = 0.025;

/* Returns the volume of material above the height at a ratio, by area. */
static double material_above(const struct material_curve *curve, double ratio) {
    return integrate(curve, 0, ratio).zeroth - ratio * material_height(curve, ratio);
}
static double voids_below(const struct material_curve *curve, double ratio) {
    return (1 - ratio) * material_height(curve, ratio) - integrate(curve, ratio, 1).zeroth;
}

void functional_measure(const struct material_curve *curve, struct functional *out) {
    const struct flattest flattest = flattest_find(curve);
    const double from = flattest.from, to = from + CENTRAL, middle = (from + to) / 2;
    const struct integrals central = integrate(curve, from, to);
    const double slope = 12 * central.first / (CENTRAL * CENTRAL * CENTRAL);
    const double secant = -flattest.fall / CENTRAL, start = material_height(curve, from);
    const double mean = central.zeroth / CENTRAL;
    const double material = material_above(curve, PEAK_RATIO);
    const double voids = voids_below(curve, VALLEY_RATIO);
    *out = (struct functional){
        .line = core_between(curve, mean - slope * middle, mean + slope * (1 - middle)),
        .secant = core_between(curve, start - secant * from, start + secant * (1 - from)),
        .xp = material_height(curve, EXTREME_RATIO) - material_height(curve, 0.5),
        .vmp = material,
        .vmc = material_above(curve, VALLEY_RATIO) - material,
        .vvc = voids_below(curve, PEAK_RATIO) - voids,
        .vvv = voids};
}

/* --- ten points --- */

enum { POINTS = 5 };
static const double PRUNED_SHARE = 0.05;

static int compare_heights(const void *a, const void *b) {
    const double first = *(const double *)a, second = *(const double *)b;
    return first < second ? 1 : first > second ? -1 : 0;
}

/* Sets *out to the mean of the five highest above `mean`, or of as many as there are. */
static int highest_mean(const struct summit_list *list, double mean, double *out,
                        struct error *err) {
    const size_t count = list->count < POINTS ? list->count : POINTS;
    double total = 0;
    *out = (double)NAN;
    if (count == 0)
        return 0;
    double *heights = array_create(list->count, sizeof *heights);
    if (heights == NULL)
        return error_memory(err, list->count * sizeof *heights, "hills in order");
    for (size_t n = 0; n < list->count; n++)
        heights[n] = list->summits[n].height;
    qsort(heights, list->count, sizeof *heights, compare_heights);
    for (size_t n = 0; n < count; n++)
        total += heights[n] - mean;
    *out = total / (double)count;
    free(heights);
    return 0;
}

static int dales_find(const struct measured_map *map, double least, struct summit_list *dales,
                      struct error *err) {
    const size_t points = grid_points(map->grid);
    struct measured_map turned = *map;
    struct hills unused;
    double *z = array_create(points, sizeof *z);
    if (z == NULL)
        return error_memory(err, points * sizeof *z, "dales");
    for (size_t point = 0; point < points; point++)
        z[point] = -map->z[point];
    turned.z = z;
    int status = hills_find(&turned, least, dales, &unused, err);
    free(z);
    return status;
}

int ten_points_measure(const struct measured_map *map, const struct summit_list *hills, double mean,
                       double sz, struct ten_points *out, struct error *err) {
    struct summit_list dales = {0};
    int status = dales_find(map, PRUNED_SHARE * sz, &dales, err);
    *out = (struct ten_points){.hills = hills->count, .dales = dales.count};
    if (status == 0)
        status = highest_mean(hills, mean, &out->s5p, err);
    if (status == 0)
        status = highest_mean(&dales, -mean, &out->s5v, err);
    out->s10z = out->s5p + out->s5v;
    summit_list_clear(&dales);
    return status;
}

/* --- widths of a profile's elements --- */

/* A walk along a profile, in one direction, over the significant crossings of its mean line. */
struct walk {
    double upper, lower; /* a hill or dale goes beyond these */
    double narrowest;    /* a portion between two crossings that is narrower is none; in points */
    int side;            /* of the last significant portion: 1 above, -1 below, 0 none yet */
    double crossing;     /* the last one of the mean line; NaN: none */
    double begin[2];     /* where the last two significant portions began; NaN: none */
    struct average width;
};

/* A significant portion begins at the last crossing. */
static void walk_turn(struct walk *walk, int side) {
    average_add(&walk->width, fabs(walk->crossing - walk->begin[0]));
    walk->begin[0] = walk->begin[1];
    walk->begin[1] = walk->crossing;
    walk->side = side;
}

static void walk_reset(struct walk *walk) {
    walk->side = 0;
    walk->crossing = walk->begin[0] = walk->begin[1] = (double)NAN;
}

/* Returns where the portion that begins at point i, on the other side of the line than the one
 * before, ends: the number of its points in this direction. */
static size_t portion_length(const double *z, size_t n, size_t from, long step, double mean,
                             double *extreme) {
    size_t count = 0;
    const bool above = z[0] > mean;
    *extreme = 0;
    while (from + count < n) {
        const double height = z[(long)count * step] - mean;
        if (isnan(height) || (height > 0) != above)
            break;
        *extreme = fabs(height) > fabs(*extreme) ? height : *extreme;
        count++;
    }
    return count;
}

static void walk_run(struct walk *walk, const struct measured_map *profile, double mean,
                     bool forwards) {
    const size_t n = profile->grid->nx;
    const long step = forwards ? 1 : -1;
    const double *first = profile->z + (forwards ? 0 : n - 1);
    walk_reset(walk);
    for (size_t i = 0; i < n;) {
        const double *at = first + (long)i * step;
        double extreme;
        if (isnan(*at)) {
            walk_reset(walk);
            i++;
            continue;
        }
        const double before = i > 0 ? at[-step] - mean : (double)NAN, here = *at - mean;
        walk->crossing = (double)i - here / (here - before);
        const size_t count = portion_length(at, n, i, step, mean, &extreme);
        const int side = extreme > walk->upper ? 1 : extreme < walk->lower ? -1 : 0;
        if (side != 0 && side != walk->side && (double)count >= walk->narrowest)
            walk_turn(walk, side);
        i += count > 0 ? count : 1;
    }
}

void profile_spacing_measure(const struct measured_map *profile, double mean,
                             struct profile_spacing *out) {
    static const double SHARE = 0.1, NARROW = 0.01;
    const size_t n = profile->grid->nx;
    const double dx = grid_dx(profile->grid);
    double high = 0, low = 0;
    for (size_t i = 0; i < n; i++) {
        high = fmax(high, profile->z[i] - mean);
        low = fmin(low, profile->z[i] - mean);
    }
    struct walk walk = {.upper = SHARE * high, .lower = SHARE * low};
    struct walk old = {.upper = SHARE * (high - low),
                       .lower = -SHARE * (high - low),
                       .narrowest = NARROW * (double)n};
    walk_run(&walk, profile, mean, true);
    walk_run(&walk, profile, mean, false);
    walk_run(&old, profile, mean, true);
    *out = (struct profile_spacing){.elements = walk.width.count,
                                    .elements_old = old.width.count,
                                    .rsm = average_value(&walk.width) * dx,
                                    .rsm_old = average_value(&old.width) * dx};
}
