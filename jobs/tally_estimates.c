/* Shares, ratios and means with their errors, from what tallies hold. */
#include "jobs/tally.h"
#include "jobs/tally_near.h"
#include <math.h>

/* Returns a b - c d of integers, exact unless a product passes 2^127. */
static double cross_difference(fixed_point a, fixed_point b, fixed_point c, fixed_point d) {
    fixed_point left, right;
    if (__builtin_mul_overflow(a, b, &left) || __builtin_mul_overflow(c, d, &right))
        return (double)a * (double)b - (double)c * (double)d;
    return (double)(left - right);
}

/* M/(M-1) sum (n_r - R N_r)^2: the sum of squares is sum N times less than A - R B with
 * A = sum n_r (n_r sum N - n N_r), B likewise with N_r: each an exact integer before it is rounded,
 * so that what cancels does so exactly. */
static double cell_variance(const struct tally *tally, size_t cell,
                            const struct tally_total *total) {
    fixed_point n = tally->count[cell];
    double things = (double)total->sum, share = (double)n / things;
    double a = cross_difference(tally->square[cell], total->sum, n, tally->cross[cell]);
    double b = cross_difference(tally->cross[cell], total->sum, n, total->square);
    double m = (double)total->realisations;
    return m / (m - 1) * fmax(0, (a - share * b) / things);
}

/* What a share is of: the things in a cell, or the things that are not. Both have one variance. */
static fixed_point side_count(const struct tally *tally, size_t cell,
                              const struct tally_total *total, bool outside) {
    fixed_point n = tally->count[cell];
    return outside ? total->sum - n : n;
}
static uint64_t side_some(const struct tally *tally, size_t cell, const struct tally_total *total,
                          bool outside) {
    return outside ? total->realisations - tally->all[cell] : tally->some[cell];
}
static bool is_rare(uint64_t some, uint64_t realisations) {
    return some < TALLY_RARE && some < realisations;
}

/* Variance over mean of the counts of cells, at least that of things which are independent. */
static double dispersion_of(double variance, double count) {
    return count > 0 ? fmax(1, variance / count) : 1;
}

/* What a window holds. */
struct window_sum {
    double variance, count;
    uint64_t some;
};
static void window_add(struct window_sum *sum, const struct tally *tally, size_t cell,
                       const struct tally_total *total, bool outside) {
    sum->variance += tally->count[cell] > 0 ? cell_variance(tally, cell, total) : 0;
    sum->count += (double)side_count(tally, cell, total, outside);
    sum->some += side_some(tally, cell, total, outside);
}

/* Over the cell and its neighbours that tell of the side, nearest first, until there are enough;
 * those as near on the left and on the right come together. */
static double neighbours_dispersion(const struct tally_near *near, const struct tally_total *total,
                                    bool outside) {
    struct window_sum sum = {0};
    size_t left = 0, right = 0;
    window_add(&sum, near->tally, near->cell, total, outside);
    while (sum.some < TALLY_RARE && (left < near->left_count || right < near->right_count)) {
        size_t before = left < near->left_count ? near->cell - near->left[left] : SIZE_MAX;
        size_t behind = right < near->right_count ? near->right[right] - near->cell : SIZE_MAX;
        if (before <= behind)
            window_add(&sum, near->tally, near->left[left++], total, outside);
        if (behind <= before)
            window_add(&sum, near->tally, near->right[right++], total, outside);
    }
    return dispersion_of(sum.variance, sum.count);
}

/* The error of a count of clusters as large as the dispersion: a Poisson mean of which n were seen
 * has the variance n + 1 (its posterior, Gelman et al. 2013, section 2.6), and one
 * of which none was seen its bound. */
static double rare_error(double dispersion, double count) {
    return count > 0 ? dispersion * sqrt(count / dispersion + 1) : dispersion * TALLY_NONE_SEEN;
}

static struct estimate share_at(const struct tally_near *things, const struct tally_near *others,
                                const struct tally_total *total) {
    const struct tally *tally = things->tally;
    size_t cell = things->cell;
    if (total->sum == 0)
        return (struct estimate){NAN, NAN};
    double all = (double)total->sum, error;
    struct estimate share = {(double)tally->count[cell] / all, NAN};
    bool outside = 2 * (fixed_point)tally->count[cell] > total->sum;
    if (total->realisations < 2)
        return share;
    if (is_rare(side_some(tally, cell, total, outside), total->realisations))
        error = rare_error(neighbours_dispersion(outside ? others : things, total, outside),
                           (double)side_count(tally, cell, total, outside));
    else
        error = sqrt(cell_variance(tally, cell, total));
    share.standard_error = error / all;
    return share;
}

void tally_shares(const struct tally *tally, size_t first, size_t n,
                  const struct tally_total *total, struct estimate *out) {
    struct tally_near things, others;
    tally_near_begin(&things, tally, total->realisations, TELLING_THINGS, first);
    tally_near_begin(&others, tally, total->realisations, TELLING_OTHERS, first);
    for (size_t a = 0; a < n; a++) {
        out[a] = share_at(&things, &others, total);
        tally_near_next(&things);
        tally_near_next(&others);
    }
}

struct estimate tally_share(const struct tally *tally, size_t cell,
                            const struct tally_total *total) {
    struct estimate out;
    tally_shares(tally, cell, 1, total, &out);
    return out;
}

double tally_empty_bound(const struct tally *tally, const struct tally_total *total) {
    double variance = 0, count = 0;
    if (total->sum == 0 || total->realisations < 2)
        return NAN;
    for (size_t cell = 0; cell < tally->size; cell++) {
        if (tally->count[cell] == 0 || !is_rare(tally->some[cell], total->realisations))
            continue;
        variance += cell_variance(tally, cell, total);
        count += (double)tally->count[cell];
    }
    return rare_error(dispersion_of(variance, count), 0) / (double)total->sum;
}

static double exact_value(const struct exact_sum *sum) {
    return sum->lost == 0 ? exact_sum_value(sum) : NAN;
}

/* sum (k_r - R n_r)^2 by sums of k^2, k n and n^2, R = k/n. */
static double residual_squares(const struct tally_sums *sums, const struct tally *counts,
                               size_t cell) {
    double value = exact_value(&sums->sum[cell]) / (double)counts->count[cell];
    double kk = exact_value(&sums->square[cell]), kn = exact_value(&sums->cross[cell]);
    return fmax(0, (kk - value * kn) - value * (kn - value * (double)counts->square[cell]));
}

struct estimate tally_sums_ratio(const struct tally_sums *sums, const struct tally *counts,
                                 size_t cell) {
    double n = (double)counts->count[cell], m = (double)counts->some[cell];
    if (!(n > 0))
        return (struct estimate){NAN, NAN};
    struct estimate ratio = {exact_value(&sums->sum[cell]) / n, NAN};
    if (m >= 2)
        ratio.standard_error = sqrt(m / (m - 1) * residual_squares(sums, counts, cell)) / n;
    return ratio;
}

/* Residuals of m realisations with n things have the variance of n (m - 1)/m things. */
struct residuals {
    double squares, things;
};
static void residuals_add(struct residuals *sum, const struct tally_sums *sums,
                          const struct tally *counts, size_t cell) {
    double m = (double)counts->some[cell];
    sum->squares += residual_squares(sums, counts, cell);
    sum->things += (double)counts->count[cell] * (m - 1) / m;
}

/* Over the cell and its neighbours that show a scatter, from the left to the right, as many as it
 * takes for TALLY_RARE degrees of freedom. */
static double pooled_variance(const struct tally_sums *sums, const struct tally_near *near) {
    const struct tally *counts = near->tally;
    uint64_t freedom = counts->some[near->cell] - 1;
    struct residuals pooled = {0, 0};
    size_t left = 0, right = 0;
    while (freedom < TALLY_RARE && (left < near->left_count || right < near->right_count)) {
        size_t before = left < near->left_count ? near->cell - near->left[left] : SIZE_MAX;
        size_t behind = right < near->right_count ? near->right[right] - near->cell : SIZE_MAX;
        if (before <= behind)
            freedom += counts->some[near->left[left++]] - 1;
        if (behind <= before)
            freedom += counts->some[near->right[right++]] - 1;
    }
    while (left > 0)
        residuals_add(&pooled, sums, counts, near->left[--left]);
    residuals_add(&pooled, sums, counts, near->cell);
    for (size_t a = 0; a < right; a++)
        residuals_add(&pooled, sums, counts, near->right[a]);
    return pooled.squares / pooled.things;
}

void tally_sums_ratios_pooled(const struct tally_sums *sums, const struct tally *counts,
                              size_t first, size_t n, struct estimate *out) {
    struct tally_near near;
    tally_near_begin(&near, counts, 0, TELLING_SCATTER, first);
    for (size_t a = 0; a < n; a++, tally_near_next(&near)) {
        size_t cell = first + a;
        uint64_t some = counts->some[cell];
        out[a] = tally_sums_ratio(sums, counts, cell);
        if (some >= 2 && some < TALLY_RARE)
            out[a].standard_error =
                sqrt(pooled_variance(sums, &near) / (double)counts->count[cell]);
    }
}

struct estimate tally_sums_mean(const struct tally_sums *sums, size_t cell, uint64_t realisations) {
    double m = (double)realisations, k = exact_value(&sums->sum[cell]), value = k / m;
    if (realisations == 0)
        return (struct estimate){NAN, NAN};
    if (realisations < 2)
        return (struct estimate){value, NAN};
    double kk = exact_value(&sums->square[cell]);
    double squares = fmax(0, (kk - value * k) - value * (k - value * m));
    return (struct estimate){value, sqrt(m / (m - 1) * squares) / m};
}
