#include "core/surface/height_table.h"
#include <gsl/gsl_cdf.h>
#include <gsl/gsl_interp.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

/* The distribution beyond the outermost knot: up to a bound the height is linear in the
 * probability; without a bound it is linear in the score. */
struct tail {
    bool bounded;
    double bound;
    double slope; /* raw height by score; 0: no height lies beyond */
};

/* Raw heights are scaled to 0 in the middle of the table, and to a range of 1. */
struct height_table {
    size_t n;            /* knots: the quantiles at probabilities other than 0 and 1 */
    double *score;       /* n: standard Gaussian quantiles of the probabilities, rising */
    double *height;      /* n: raw, not falling */
    gsl_interp *between; /* height by score (Steffen 1990) */
    struct tail low, high;
    struct height_moments moments;
};

/* Beyond this score a Gaussian tail adds nothing to any moment. */
static const double SCORE_MOST = 12;
/* Without a bound, the slope over this much of the score is extrapolated. */
static const double SLOPE_REACH = 1;
/* Heights that differ by less than this part of them differ by rounding. */
static const double DIFFERENCE_LEAST = 1e-12;

static double gaussian_cdf(double score) {
    return erfc(-score / M_SQRT2) / 2;
}

static double between(const struct height_table *t, double score) {
    return gsl_interp_eval(t->between, t->score, t->height, score, NULL);
}

/* --- the quantile function and its inverse --- */

/* Returns the height beyond the outermost knot; side is 1 for the high tail and -1 for the low one,
 * which is its mirror image. */
static double height_beyond(const struct tail *tail, int side, double knot, double height,
                            double score) {
    if (!tail->bounded)
        return height + tail->slope * (score - knot);
    double share = gaussian_cdf(-side * score) / gaussian_cdf(-side * knot);
    return tail->bound + (height - tail->bound) * share;
}

static double height_at(const struct height_table *t, double score) {
    size_t last = t->n - 1;
    if (score < t->score[0])
        return height_beyond(&t->low, -1, t->score[0], t->height[0], score);
    if (score > t->score[last])
        return height_beyond(&t->high, 1, t->score[last], t->height[last], score);
    return between(t, score);
}

double height_table_at_score(const struct height_table *table, double score) {
    return height_at(table, score);
}

double height_table_quantile(const struct height_table *table, double probability) {
    return height_at(table, gsl_cdf_ugaussian_Pinv(probability));
}

/* Returns the share of heights further out than a raw one beyond the outermost knot. */
static double share_beyond(const struct tail *tail, int side, double knot, double height,
                           double raw) {
    double distance = side * (raw - height);
    if (tail->bounded) {
        double length = side * (tail->bound - height);
        return distance < length ? gaussian_cdf(-side * knot) * (1 - distance / length) : 0;
    }
    return tail->slope > 0 ? gaussian_cdf(-side * knot - distance / tail->slope) : 0;
}

/* Returns the highest knot whose height is not above a raw one, which is neither below the lowest
 * nor above the highest. */
static size_t knot_below(const struct height_table *t, double raw) {
    size_t low = 0, high = t->n;
    while (high - low > 1) {
        size_t middle = low + (high - low) / 2;
        if (t->height[middle] <= raw)
            low = middle;
        else
            high = middle;
    }
    return low;
}

double height_table_cdf(const struct height_table *t, double raw) {
    size_t last = t->n - 1;
    if (raw < t->height[0])
        return share_beyond(&t->low, -1, t->score[0], t->height[0], raw);
    if (raw >= t->height[last])
        return 1 - share_beyond(&t->high, 1, t->score[last], t->height[last], raw);
    size_t knot = knot_below(t, raw);
    double low = t->score[knot], high = t->score[knot + 1];
    for (double middle = low + (high - low) / 2; middle > low && middle < high;
         middle = low + (high - low) / 2) {
        if (between(t, middle) <= raw)
            low = middle;
        else
            high = middle;
    }
    return gaussian_cdf(low);
}

/* --- moments --- */

/* The 4-point rule of Gauss and Legendre on [-1, 1]. */
enum { NODES = 4 };
static const double NODE[NODES] = {-0.8611363115940526, -0.3399810435848563, 0.3399810435848563,
                                   0.8611363115940526};
static const double WEIGHT[NODES] = {0.3478548451374538, 0.6521451548625461, 0.6521451548625461,
                                     0.3478548451374538};
/* Panels are at most so wide, in scores. */
static const double PANEL = 0.25;

/* Integrals over the probability of powers 1 to 4 of the heights about a shift. */
struct powers {
    double shift, sum[4];
};

static void powers_add(struct powers *powers, double height, double weight) {
    double term = weight;
    for (int a = 0; a < 4; a++) {
        term *= height - powers->shift;
        powers->sum[a] += term;
    }
}

static void add_scores(const struct height_table *t, double low, double high,
                       struct powers *powers) {
    size_t panels = high > low ? (size_t)ceil((high - low) / PANEL) : 0;
    for (size_t panel = 0; panel < panels; panel++) {
        double half = (high - low) / (double)panels / 2;
        double centre = low + (2 * (double)panel + 1) * half;
        for (int q = 0; q < NODES; q++) {
            double score = centre + half * NODE[q];
            double density = exp(-score * score / 2) / sqrt(2 * M_PI);
            powers_add(powers, height_at(t, score), half * WEIGHT[q] * density);
        }
    }
}

/* Between a knot and a bound heights are evenly distributed. */
static void add_bounded(double share, double height, double bound, struct powers *powers) {
    for (int q = 0; q < NODES; q++)
        powers_add(powers, height + (bound - height) * (1 + NODE[q]) / 2, share * WEIGHT[q] / 2);
}

static struct powers powers_about(const struct height_table *t, double shift) {
    struct powers powers = {.shift = shift};
    double first = t->score[0], last = t->score[t->n - 1];
    if (t->low.bounded)
        add_bounded(gaussian_cdf(first), t->height[0], t->low.bound, &powers);
    else
        add_scores(t, fmin(-SCORE_MOST, first), first, &powers);
    for (size_t a = 1; a < t->n; a++)
        add_scores(t, t->score[a - 1], t->score[a], &powers);
    if (t->high.bounded)
        add_bounded(gaussian_cdf(-last), t->height[t->n - 1], t->high.bound, &powers);
    else
        add_scores(t, last, fmax(SCORE_MOST, last), &powers);
    return powers;
}

/* Returns the end of a tail; INFINITY (high) or -INFINITY (low) where it has none. */
static double tail_end(const struct tail *tail, double height, double endless) {
    return tail->bounded ? tail->bound : tail->slope > 0 ? endless : height;
}

static int moments_fill(struct height_table *t, struct error *err) {
    struct height_moments *m = &t->moments;
    m->mean = powers_about(t, 0).sum[0];
    struct powers about = powers_about(t, m->mean);
    m->deviation = sqrt(about.sum[1]);
    if (!(m->deviation > DIFFERENCE_LEAST))
        return error_set(err, ERROR_INPUT, "next to all heights are equal");
    m->skewness = about.sum[2] / (about.sum[1] * m->deviation);
    m->kurtosis = about.sum[3] / (about.sum[1] * about.sum[1]);
    m->lowest = (tail_end(&t->low, t->height[0], -INFINITY) - m->mean) / m->deviation;
    m->highest = (tail_end(&t->high, t->height[t->n - 1], INFINITY) - m->mean) / m->deviation;
    return 0;
}

void height_table_moments(const struct height_table *table, struct height_moments *out) {
    *out = table->moments;
}

/* --- construction --- */

int height_table_check(size_t n, const double *probability, struct error *err) {
    if (n < HEIGHT_QUANTILES_LEAST)
        return error_set(err, ERROR_INPUT, "%zu quantiles; at least %d are needed", n,
                         HEIGHT_QUANTILES_LEAST);
    for (size_t a = 0; a < n; a++) {
        if (!(probability[a] >= 0 && probability[a] <= 1))
            return error_set(err, ERROR_INPUT, "probability number %zu, %.17g, is not in [0, 1]", a,
                             probability[a]);
        if (a > 0 && !(probability[a] > probability[a - 1]))
            return error_set(err, ERROR_INPUT,
                             "probabilities must rise; number %zu, %.17g, is not above %.17g", a,
                             probability[a], probability[a - 1]);
    }
    return 0;
}

static int heights_check(size_t n, const double *height, struct error *err) {
    for (size_t a = 0; a < n; a++) {
        if (!isfinite(height[a]))
            return error_set(err, ERROR_INPUT, "height number %zu, %g, is not finite", a,
                             height[a]);
        if (a > 0 && height[a] < height[a - 1])
            return error_set(err, ERROR_INPUT,
                             "heights must not fall; number %zu, %.17g, is below %.17g", a,
                             height[a], height[a - 1]);
    }
    double most = fmax(fabs(height[0]), fabs(height[n - 1])), span = height[n - 1] - height[0];
    if (!(span > DIFFERENCE_LEAST * most && isfinite(span)))
        return error_set(err, ERROR_INPUT,
                         "heights must differ by more than rounding, and by a finite number; "
                         "lowest %.17g, highest %.17g",
                         height[0], height[n - 1]);
    return 0;
}

/* Returns the slope of heights near an end, where the outermost two differ; side as above. */
static double end_slope(const struct height_table *t, int side) {
    size_t end = side > 0 ? t->n - 1 : 0, next = side > 0 ? t->n - 2 : 1;
    if (t->height[end] == t->height[next])
        return 0;
    double within = t->score[end] - side * SLOPE_REACH;
    within = fmin(fmax(within, t->score[0]), t->score[t->n - 1]);
    return (t->height[end] - between(t, within)) / (t->score[end] - within);
}

/* Fills in the knots, `first` being the first of them in the arrays. */
static int knots_fill(struct height_table *t, size_t first, const double *probability,
                      const double *height, double centre, double span, struct error *err) {
    for (size_t a = 0; a < t->n; a++) {
        t->score[a] = gsl_cdf_ugaussian_Pinv(probability[first + a]);
        t->height[a] = (height[first + a] - centre) / span;
        if (a > 0 && !(t->score[a] > t->score[a - 1]))
            return error_set(err, ERROR_INPUT,
                             "probability number %zu, %.17g, is too near to the one before",
                             first + a, probability[first + a]);
    }
    gsl_interp_init(t->between, t->score, t->height, t->n);
    return 0;
}

static int fill(struct height_table *t, size_t n, const double *probability, const double *height,
                struct error *err) {
    double centre = height[n / 2], span = height[n - 1] - height[0];
    t->low = (struct tail){probability[0] == 0, (height[0] - centre) / span, 0};
    t->high = (struct tail){probability[n - 1] == 1, (height[n - 1] - centre) / span, 0};
    int status = knots_fill(t, t->low.bounded, probability, height, centre, span, err);
    if (status != 0)
        return status;
    t->low.slope = end_slope(t, -1);
    t->high.slope = end_slope(t, 1);
    return moments_fill(t, err);
}

int height_table_of_quantiles(struct height_table **out, size_t n, const double *probability,
                              const double *height, struct error *err) {
    int status = height_table_check(n, probability, err);
    if (status == 0)
        status = heights_check(n, height, err);
    if (status != 0)
        return status;
    struct height_table *t = array_create(1, sizeof *t);
    if (t == NULL)
        return error_memory(err, sizeof *t, "a table of heights");
    t->n = n - (probability[0] == 0) - (probability[n - 1] == 1);
    t->score = array_create(t->n, sizeof *t->score);
    t->height = array_create(t->n, sizeof *t->height);
    t->between = gsl_interp_alloc(gsl_interp_steffen, t->n);
    if (t->score == NULL || t->height == NULL || t->between == NULL)
        status = error_memory(err, 8 * t->n * sizeof *t->score, "a table of heights");
    else
        status = fill(t, n, probability, height, err);
    if (status == 0)
        *out = t;
    else
        height_table_destroy(&t);
    return status;
}

static int compare(const void *a, const void *b) {
    double one = *(const double *)a, other = *(const double *)b;
    return (one > other) - (one < other);
}

int height_table_of_samples(struct height_table **out, size_t n, const double *sample,
                            struct error *err) {
    if (n < HEIGHT_SAMPLES_LEAST)
        return error_set(err, ERROR_INPUT, "%zu samples; at least %d are needed", n,
                         HEIGHT_SAMPLES_LEAST);
    double *sorted = array_create(2 * n, sizeof *sorted);
    if (sorted == NULL)
        return error_memory(err, 2 * n * sizeof *sorted, "samples of heights");
    double *probability = sorted + n;
    int status = 0;
    for (size_t a = 0; a < n && status == 0; a++) {
        sorted[a] = sample[a];
        probability[a] = ((double)a + 0.5) / (double)n;
        if (!isfinite(sample[a]))
            status =
                error_set(err, ERROR_INPUT, "sample number %zu, %g, is not finite", a, sample[a]);
    }
    if (status == 0) {
        qsort(sorted, n, sizeof *sorted, compare);
        status = height_table_of_quantiles(out, n, probability, sorted, err);
    }
    free(sorted);
    return status;
}

void height_table_destroy(struct height_table **table) {
    struct height_table *t = *table;
    if (t == NULL)
        return;
    gsl_interp_free(t->between);
    free(t->score);
    free(t->height);
    free(t);
    *table = NULL;
}
