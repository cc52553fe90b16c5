#include "jobs/tally.h"
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/* The nearest cells with data around each cell of a row of a tally in turn, which rare cells need.
 * Most cells of a sparse tally have none. A walk through the row visits each of them once, where a
 * search around every cell would visit most of them repeatedly. */

/* The data that a cell must have: things in it; things outside it; several realisations, which
 * scatter. */
enum tally_content { CONTENT_THINGS, CONTENT_OTHERS, CONTENT_SCATTER };

/* The nearest cells on either side, as many as are ever needed: each has one realisation at
 * least. */
struct tally_near {
    const struct tally *tally; /* borrowed */
    uint64_t realisations;
    enum tally_content content;
    size_t cell, low, high;              /* position of the walk; its row, up to high - 1 */
    size_t left_count, left[TALLY_RARE]; /* nearest first */
    size_t right_count, right[TALLY_RARE];
    size_t ahead; /* the first cell to the right that was not visited */
};

static bool has_content(const struct tally_near *near, size_t cell) {
    switch (near->content) {
    case CONTENT_THINGS:
        return near->tally->some[cell] > 0;
    case CONTENT_OTHERS:
        return near->tally->all[cell] < near->realisations;
    default:
        return near->tally->some[cell] > 1;
    }
}

static void look_ahead(struct tally_near *near) {
    while (near->right_count < TALLY_RARE && near->ahead < near->high) {
        size_t cell = near->ahead++;
        if (has_content(near, cell))
            near->right[near->right_count++] = cell;
    }
}

static void tally_near_begin(struct tally_near *near, const struct tally *tally,
                             uint64_t realisations, enum tally_content content, size_t cell) {
    *near = (struct tally_near){.tally = tally,
                                .realisations = realisations,
                                .content = content,
                                .cell = cell,
                                .low = cell - cell % tally->row,
                                .ahead = cell + 1};
    near->high = near->low + tally->row;
    for (size_t a = cell; a > near->low && near->left_count < TALLY_RARE; a--)
        if (has_content(near, a - 1))
            near->left[near->left_count++] = a - 1;
    look_ahead(near);
}

/* Goes on to the next cell, which may be the first of the next row. */
static void tally_near_next(struct tally_near *near) {
    size_t cell = near->cell + 1;
    if (cell == near->high) {
        if (cell < near->tally->size)
            tally_near_begin(near, near->tally, near->realisations, near->content, cell);
        return;
    }
    if (has_content(near, near->cell)) {
        near->left_count += near->left_count < TALLY_RARE;
        memmove(near->left + 1, near->left, (near->left_count - 1) * sizeof *near->left);
        near->left[0] = near->cell;
    }
    if (near->right_count > 0 && near->right[0] == cell) {
        near->right_count--;
        memmove(near->right, near->right + 1, near->right_count * sizeof *near->right);
    }
    near->cell = cell;
    near->ahead = near->ahead > cell ? near->ahead : cell + 1;
    look_ahead(near);
}

/* No valid sum comes near (a million realisations of 2^31 points: 2^82), and 2^26 blocks of such
 * sums add up without overflow. */
static const fixed_point SUM_MOST = (fixed_point)1 << 100;

static fixed_point get_sum(struct byte_reader *reader, fixed_point least, fixed_point most) {
    fixed_point value = bytes_get_fixed(reader);
    if (value < least || value > most) {
        reader->failed = true;
        return 0;
    }
    return value;
}

void tally_total_add(struct tally_total *total, uint64_t things) {
    total->realisations++;
    total->sum += things;
    total->square += (fixed_point)things * things;
}

void tally_total_merge(struct tally_total *into, const struct tally_total *from) {
    into->realisations += from->realisations;
    into->sum += from->sum;
    into->square += from->square;
}

void tally_total_put(struct bytes *bytes, const struct tally_total *total) {
    bytes_put_unsigned(bytes, total->realisations);
    bytes_put_fixed(bytes, total->sum);
    bytes_put_fixed(bytes, total->square);
}

void tally_total_get(struct byte_reader *reader, struct tally_total *total) {
    total->realisations = bytes_get_unsigned(reader);
    total->sum = get_sum(reader, 0, SUM_MOST);
    total->square = get_sum(reader, total->sum, SUM_MOST);
}

int tally_create(struct tally *out, size_t size, size_t row, struct error *err) {
    *out = (struct tally){.size = size,
                          .row = row,
                          .count = array_create(size, sizeof *out->count),
                          .some = array_create(size, sizeof *out->some),
                          .all = array_create(size, sizeof *out->all),
                          .square = array_create(size, sizeof *out->square),
                          .cross = array_create(size, sizeof *out->cross)};
    if (out->count != NULL && out->some != NULL && out->all != NULL && out->square != NULL &&
        out->cross != NULL)
        return 0;
    tally_clear(out);
    return error_memory(err, (size_t)tally_bytes(size), "a tally");
}

void tally_clear(struct tally *tally) {
    free(tally->count);
    free(tally->some);
    free(tally->all);
    free(tally->square);
    free(tally->cross);
    *tally = (struct tally){0};
}

void tally_merge(struct tally *into, const struct tally *from) {
    for (size_t cell = 0; cell < into->size; cell++) {
        if (from->count[cell] == 0) /* then all are zero, as in most cells of a sparse tally */
            continue;
        into->count[cell] += from->count[cell];
        into->some[cell] += from->some[cell];
        into->all[cell] += from->all[cell];
        into->square[cell] += from->square[cell];
        into->cross[cell] += from->cross[cell];
    }
}

void tally_put(struct bytes *bytes, const struct tally *tally) {
    bytes_put_counts(bytes, tally->size, tally->count);
    for (size_t cell = 0; cell < tally->size; cell++) {
        if (tally->count[cell] == 0)
            continue;
        bytes_put_unsigned(bytes, tally->some[cell]);
        bytes_put_unsigned(bytes, tally->all[cell]);
        bytes_put_fixed(bytes, tally->square[cell]);
        bytes_put_fixed(bytes, tally->cross[cell]);
    }
}

static void get_tally(struct byte_reader *reader, struct tally *tally, bool within) {
    bytes_get_counts(reader, tally->size, tally->count);
    for (size_t cell = 0; cell < tally->size && !reader->failed; cell++) {
        fixed_point count = tally->count[cell];
        if (count == 0)
            continue;
        tally->some[cell] = bytes_get_unsigned(reader);
        tally->all[cell] = bytes_get_unsigned(reader);
        if (tally->some[cell] == 0 || tally->some[cell] > (uint64_t)count ||
            tally->all[cell] > tally->some[cell])
            reader->failed = true;
        tally->square[cell] = get_sum(reader, count, SUM_MOST);
        tally->cross[cell] = get_sum(reader, within ? tally->square[cell] : count, SUM_MOST);
    }
}

void tally_get(struct byte_reader *reader, struct tally *tally) {
    get_tally(reader, tally, true);
}

void tally_get_weighed(struct byte_reader *reader, struct tally *tally) {
    get_tally(reader, tally, false);
}

int tally_sums_create(struct tally_sums *out, size_t size, struct error *err) {
    *out = (struct tally_sums){.size = size,
                               .sum = array_create(size, sizeof *out->sum),
                               .square = array_create(size, sizeof *out->square),
                               .cross = array_create(size, sizeof *out->cross)};
    if (out->sum != NULL && out->square != NULL && out->cross != NULL)
        return 0;
    tally_sums_clear(out);
    return error_memory(err, (size_t)tally_sums_bytes(size), "sums of a tally");
}

void tally_sums_clear(struct tally_sums *sums) {
    free(sums->sum);
    free(sums->square);
    free(sums->cross);
    *sums = (struct tally_sums){0};
}

void tally_sums_add(struct tally_sums *sums, size_t cell, double k, uint64_t n) {
    if (k == 0) /* then all sums stay, as in the rings beyond a band */
        return;
    exact_sum_add(&sums->sum[cell], k);
    exact_sum_add(&sums->square[cell], k * k);
    exact_sum_add(&sums->cross[cell], k * (double)n);
}

void tally_sums_merge(struct tally_sums *into, const struct tally_sums *from) {
    for (size_t cell = 0; cell < into->size; cell++) {
        exact_sum_merge(&into->sum[cell], &from->sum[cell]);
        exact_sum_merge(&into->square[cell], &from->square[cell]);
        exact_sum_merge(&into->cross[cell], &from->cross[cell]);
    }
}

void exact_sum_put(struct bytes *bytes, const struct exact_sum *sum) {
    bytes_put_fixed(bytes, sum->total);
    bytes_put_unsigned(bytes, sum->lost);
}

void exact_sum_get(struct byte_reader *reader, struct exact_sum *sum) {
    sum->total = bytes_get_fixed(reader);
    sum->lost = bytes_get_unsigned(reader);
}

void tally_sums_put(struct bytes *bytes, const struct tally_sums *sums) {
    for (size_t cell = 0; cell < sums->size; cell++) {
        exact_sum_put(bytes, &sums->sum[cell]);
        exact_sum_put(bytes, &sums->square[cell]);
        exact_sum_put(bytes, &sums->cross[cell]);
    }
}

void tally_sums_get(struct byte_reader *reader, struct tally_sums *sums) {
    for (size_t cell = 0; cell < sums->size && !reader->failed; cell++) {
        exact_sum_get(reader, &sums->sum[cell]);
        exact_sum_get(reader, &sums->square[cell]);
        exact_sum_get(reader, &sums->cross[cell]);
    }
}

/* Shares, ratios and means of tallies, with their errors. */

/* Returns a b - c d of integers, exact unless a product passes 2^127. */
static double cross_difference(fixed_point a, fixed_point b, fixed_point c, fixed_point d) {
    fixed_point left, right;
    if (__builtin_mul_overflow(a, b, &left) || __builtin_mul_overflow(c, d, &right))
        return (double)a * (double)b - (double)c * (double)d;
    return (double)(left - right);
}

/* M/(M-1) sum (n_r - R N_r)^2. The sum of squares is sum N times less than A - R B with A = sum n_r
 * (n_r sum N - n N_r), B likewise with N_r. Each is an exact integer before it is rounded, so that
 * terms cancel exactly. */
static double cell_variance(const struct tally *tally, size_t cell,
                            const struct tally_total *total) {
    fixed_point n = tally->count[cell];
    double things = (double)total->sum, share = (double)n / things;
    double a = cross_difference(tally->square[cell], total->sum, n, tally->cross[cell]);
    double b = cross_difference(tally->cross[cell], total->sum, n, total->square);
    double m = (double)total->realisations;
    return m / (m - 1) * fmax(0, (a - share * b) / things);
}

/* Returns the count of a share: of the things in a cell, or of those outside. Both have one
 * variance. */
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

/* Variance over mean of the counts of cells, at least 1, that of independent things. */
static double dispersion_of(double variance, double count) {
    return count > 0 ? fmax(1, variance / count) : 1;
}

/* Sums over a cell and some of its neighbours: all, and those that are rare. */
struct window_sum {
    double variance, count, rare_variance, rare_count;
    uint64_t some;
};
static void window_add(struct window_sum *sum, const struct tally *tally, size_t cell,
                       const struct tally_total *total, bool outside) {
    const double variance = tally->count[cell] > 0 ? cell_variance(tally, cell, total) : 0;
    const double count = (double)side_count(tally, cell, total, outside);
    const uint64_t some = side_some(tally, cell, total, outside);
    sum->variance += variance;
    sum->count += count;
    sum->some += some;
    if (!is_rare(some, total->realisations))
        return;
    sum->rare_variance += variance;
    sum->rare_count += count;
}

/* Returns the dispersion of the cell and its nearest neighbours with things on that side, as many
 * as are needed. Neighbours at equal distance on the left and right are added together. One that is
 * not rare may raise the dispersion, and does not lower it: how many things it has may be
 * prescribed, as of heights near the edge of their distribution, and says nothing of clusters. */
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
    return fmax(dispersion_of(sum.variance, sum.count),
                dispersion_of(sum.rare_variance, sum.rare_count));
}

/* Returns the error of a count of clusters as large as the dispersion. A Poisson mean of which n
 * were seen has the variance n + 1 (its posterior, Gelman et al. 2013, section 2.6); if none was
 * seen the error is a bound. */
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
    tally_near_begin(&things, tally, total->realisations, CONTENT_THINGS, first);
    tally_near_begin(&others, tally, total->realisations, CONTENT_OTHERS, first);
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

/* Returns the variance over the cell and its neighbours with a scatter, from left to right, as many
 * as give TALLY_RARE degrees of freedom. */
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
    tally_near_begin(&near, counts, 0, CONTENT_SCATTER, first);
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
