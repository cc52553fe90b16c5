#include "core/statistics/spectra/spectrum_range.h"

/* The fewest waves a side that are looked at for ends, where rings have few modes. */
enum { LEAST_RING = 8 };
/* An edge is this many rings wide under the window. */
enum { EDGE_BEFORE = 2, EDGE_AFTER = 3 };

const char *const SPECTRUM_END_NAMES[SPECTRUM_ENDS] = {"option",  "map side", "point spacing",
                                                       "cut-off", "low pass", "noise"};

static const double LEAST_DENSITY = 1e-300;

static double log_density(const struct map_spectrum *s, size_t ring) {
    return log(fmax(s->density[ring], LEAST_DENSITY));
}

/* Returns the slope of the density by the wave number, both in logarithms, over rings first to
 * last; *error: its standard error. */
static double slope_over(const struct map_spectrum *s, size_t first, size_t last, double *error) {
    double n = 0, x = 0, y = 0, xx = 0, xy = 0;
    for (size_t r = first; r <= last; r++) {
        /* the variance of the logarithm of chi squared, nearly */
        double freedom = s->freedom[r], weight = freedom / 2 * freedom / (freedom + 1);
        double u = log((double)r), v = log_density(s, r);
        n += weight;
        x += weight * u;
        y += weight * v;
        xx += weight * u * u;
        xy += weight * u * v;
    }
    double spread = xx - x * x / n;
    *error = sqrt((s->windowed ? 2 : 1) / spread);
    return (xy - x * y / n) / spread;
}

/* The slope at a ring is that of the rings within a sixth of it. */
static size_t slope_first(size_t ring) {
    size_t half = ring / 6 > 2 ? ring / 6 : 2;
    return ring - half;
}
static size_t slope_last(size_t ring, size_t last) {
    size_t half = ring / 6 > 2 ? ring / 6 : 2;
    return ring + half < last ? ring + half : last;
}

/* Returns the mean density over rings first to last, by their degrees of freedom. */
static double mean_density(const struct map_spectrum *s, size_t first, size_t last) {
    double total = 0, count = 0;
    for (size_t r = first; r <= last; r++) {
        total += s->density[r] * s->freedom[r];
        count += s->freedom[r];
    }
    return total / count;
}

/* Returns how many rings must be put together for a mean of small statistical error: one of a
 * surface; of profiles, whose rings are one wave, more. */
static size_t block_of(const struct map_spectrum *s, size_t r) {
    static const double ENOUGH = 24;
    return (size_t)fmin(fmax(ceil(ENOUGH / s->freedom[r]), 1), (double)s->rings); /* inf: none */
}

/* Returns by how much the logarithm of the density falls across ring r more than by the steepest
 * law, over 1 plus 4 standard errors: above 1 at an edge. */
static double edge_fall(const struct map_spectrum *s, size_t r, size_t block) {
    double steepest = grid_is_profile(&s->modes.grid) ? 3 : 4, freedom = 0;
    size_t before = r - EDGE_BEFORE, after = r + EDGE_AFTER;
    for (size_t b = 0; b < block; b++)
        freedom += s->freedom[r + b];
    double high = mean_density(s, before + 1 - block, before);
    double low = fmax(mean_density(s, after, after + block - 1), LEAST_DENSITY);
    double fall = log(high / low) -
                  steepest * log((double)(after + block - 1) / (double)(before + 1 - block));
    return fall / (1 + 8 / sqrt(freedom));
}

/* Returns the ring of the sharpest edge from ring first to last; 0: none. */
static size_t edge_find(const struct map_spectrum *s, size_t first, size_t last) {
    size_t found = 0, block = block_of(s, first);
    double most = 1;
    if (first < LEAST_RING || first < block + EDGE_BEFORE)
        return 0;
    for (size_t r = first; r <= last && r + EDGE_AFTER + block <= s->rings; r++) {
        double fall = edge_fall(s, r, block);
        if (fall > most) {
            most = fall;
            found = r;
        }
    }
    if (found == 0)
        return 0;
    /* within it, the last ring that has its share */
    static const double SHARE = 0.3;
    double high = mean_density(s, found - EDGE_BEFORE + 1 - block, found - EDGE_BEFORE);
    size_t edge = found + EDGE_AFTER - 1;
    while (edge > found - EDGE_BEFORE && s->density[edge] < SHARE * high)
        edge--;
    return edge;
}

/* Finds the first ring from which on the tail is flat or rises, far below the highest density; 0:
 * none. */
static size_t noise_find(const struct map_spectrum *s, size_t last, double *noise) {
    static const double FLAT = -0.5, FAR_BELOW = 0.1, ROUNDING = 1e-26;
    double highest = 0, least = INFINITY, error;
    size_t begin = 0, shortest = last / 10 > 6 ? last / 10 : 6, block = block_of(s, last);
    for (size_t r = 1; r <= last; r++)
        highest = fmax(highest, s->density[r]);
    for (size_t r = slope_first(last); r >= LEAST_RING; r--) {
        double slope = slope_over(s, slope_first(r), slope_last(r, last), &error);
        if (slope < FLAT - 2 * error || s->density[r] > FAR_BELOW * highest)
            break;
        begin = slope_first(r);
        least = fmin(least, mean_density(s, r, r + block - 1 < last ? r + block - 1 : last));
    }
    if (begin == 0 || last - begin < shortest || !(least > ROUNDING * highest))
        return 0;
    *noise = fmin(mean_density(s, begin, last), 2 * least);
    return begin;
}

/* Finds the first ring at which the density falls significantly faster than any law; 0: none. */
static size_t steep_find(const struct map_spectrum *s, size_t last) {
    double steepest = grid_is_profile(&s->modes.grid) ? 3 : 4;
    for (size_t r = LEAST_RING; r <= last; r++) {
        double error, slope = slope_over(s, slope_first(r), slope_last(r, last), &error);
        if (slope < -(steepest + 1 + 3 * error))
            return r;
    }
    return 0;
}

/* Finds the end at short waves among rings up to last. */
static void end_find(const struct map_spectrum *s, size_t last, struct spectrum_range *out) {
    static const double ABOVE = 4; /* times the noise a trusted density is */
    size_t noisy = noise_find(s, last, &out->noise), steep = steep_find(s, last);
    size_t end = noisy > 0 ? noisy : last;
    out->tail_density = noisy > 0 ? out->noise : mean_density(s, last - last / 10, last);
    while (noisy > 0 && end > 1 && s->density[end] < ABOVE * out->noise)
        end--;
    if (steep > 0 && steep <= end + EDGE_AFTER) {
        size_t edge = edge_find(s, steep, steep + steep / 3 + EDGE_AFTER);
        out->steep = steep;
        out->edge = edge;
        out->to_end = edge > 0 ? SPECTRUM_END_CUTOFF : SPECTRUM_END_LOW_PASS;
        out->last = edge > 0 ? edge + EDGE_AFTER : steep < end ? steep : end;
        return;
    }
    if (noisy > 0) {
        out->to_end = SPECTRUM_END_NOISE;
        out->last = end;
        return;
    }
    /* points between waves that are as short make others look longer than they are */
    out->to_end = SPECTRUM_END_SPACING;
    out->last = last / 2;
}

/* Returns the first ring that is looked at: of ellipses one with waves in most directions. */
static size_t first_ring(const struct map_spectrum *s) {
    static const double AROUND = 1.0; /* waves along the lay */
    size_t first = s->windowed ? 2 : 1;
    if (lay_is_plain(&s->lay))
        return first;
    first = (size_t)fmax((double)first, fmin(ceil(AROUND * s->lay.ratio), (double)s->rings - 1));
    for (size_t r = first; r < s->rings; r++)
        first = s->freedom[r] > 0 ? first : r + 1;
    return first < s->rings ? first : s->rings - 1;
}

int spectrum_range_find(const struct map_spectrum *s, const struct spectrum_fit_request *request,
                        struct spectrum_range *out, struct error *err) {
    static const double GUARD = 1e-9;
    size_t last = s->rings - 1;
    *out = (struct spectrum_range){.first = first_ring(s), .from_end = SPECTRUM_END_SIDE};
    if (last > LEAST_RING + EDGE_AFTER)
        end_find(s, last, out);
    else {
        out->last = last;
        out->to_end = SPECTRUM_END_SPACING;
    }
    if (request->longest > 0) {
        out->from_end = SPECTRUM_END_OPTION;
        out->first = (size_t)fmin(fmax(ceil(s->side / request->longest - GUARD), 1),
                                  (double)last + 1); /* none */
    }
    if (request->shortest > 0) {
        size_t asked = (size_t)fmin(s->side / request->shortest + GUARD, (double)last);
        out->to_end = out->edge > 0 && asked >= out->last ? out->to_end : SPECTRUM_END_OPTION;
        out->edge = asked >= out->last ? out->edge : 0;
        out->last = out->edge > 0 ? out->last : asked;
    }
    if ((request->longest > 0 || request->shortest > 0) && out->first > out->last)
        return error_set(
            err, ERROR_INPUT,
            "no wave of the map is from %g to %g long; it has those from %g to %g, all "
            "in its own unit of length (m where the file has units)",
            request->shortest, request->longest, s->side / (double)last, s->side);
    out->last = out->last > out->first ? out->last : out->first;
    return 0;
}
