/* Protects: errors of rare cells by the neighbours that a walk through the cells finds are those of
 * windows around each cell, which grow by both neighbours at a time, made here from the
 * realisations one by one. */
#include "jobs/tally.h"
#include "tests/support/check.h"
#include "tests/support/seed.h"
#include <math.h>

enum { REALISATIONS = 30, COLUMNS = 40, ROWS = 3, CELLS = ROWS * COLUMNS, TRIALS = 60 };

/* Few things, in few cells; or how many are below each cell, which is all of them in most. */
struct sparse {
    uint64_t n[REALISATIONS][CELLS], things[REALISATIONS];
    double k[REALISATIONS][CELLS];
    struct tally tally;
    struct tally_total total;
    struct tally_sums sums;
};

static void draw(struct sparse *out, uint64_t *seed, bool cumulative) {
    *out = (struct sparse){.things = {0}};
    for (size_t r = 0; r < REALISATIONS; r++) {
        out->n[r][7] = cumulative ? 0 : 20;
        for (uint64_t a = next_word(seed) % 12; a > 0; a--)
            out->n[r][next_word(seed) % (cumulative ? 30 : CELLS)]++;
        for (size_t cell = 0; cell < CELLS; cell++) {
            out->things[r] += out->n[r][cell];
            out->k[r][cell] = (double)(out->n[r][cell] * (1 + next_word(seed) % 8)) / 8;
        }
        for (size_t cell = 1; cell < CELLS && cumulative; cell++)
            out->n[r][cell] += out->n[r][cell - 1];
    }
    assert_int_equal(tally_create(&out->tally, CELLS, cumulative ? CELLS : COLUMNS, NULL), 0);
    assert_int_equal(tally_sums_create(&out->sums, CELLS, NULL), 0);
    for (size_t r = 0; r < REALISATIONS; r++) {
        tally_total_add(&out->total, out->things[r]);
        for (size_t cell = 0; cell < CELLS; cell++)
            if (out->n[r][cell] > 0) {
                tally_add(&out->tally, cell, out->n[r][cell], out->things[r]);
                tally_sums_add(&out->sums, cell, out->k[r][cell], out->n[r][cell]);
            }
    }
}

/* Of one cell: things (in it, or not in it) and the realisations that have any; the variance of
 * their number about its share; and residuals of k. */
struct cell_sums {
    double things, some, variance;
    double rare_things, rare_variance; /* the same, of a rare cell */
    double squares, weight, freedom;
};

static struct cell_sums cell_sums(const struct sparse *sparse, size_t cell, bool outside) {
    struct cell_sums out = {0};
    double n = 0, all = 0, k = 0, m = 0;
    for (size_t r = 0; r < REALISATIONS; r++) {
        n += (double)sparse->n[r][cell];
        all += (double)sparse->things[r];
        k += sparse->k[r][cell];
        m += sparse->n[r][cell] > 0;
    }
    for (size_t r = 0; r < REALISATIONS; r++) {
        double own = (double)sparse->n[r][cell], things = (double)sparse->things[r];
        /* a realisation without any has not all of them in the cell */
        out.some += outside ? own < things || things == 0 : own > 0;
        out.variance += pow(own - n / all * things, 2) * REALISATIONS / (REALISATIONS - 1);
        out.squares += own > 0 ? pow(sparse->k[r][cell] - k / n * own, 2) : 0;
    }
    out.things = outside ? all - n : n;
    if (out.some < TALLY_RARE) {
        out.rare_things = out.things;
        out.rare_variance = out.variance;
    }
    out.weight = m >= 2 ? n * (m - 1) / m : 0;
    out.freedom = m >= 2 ? m - 1 : 0;
    return out;
}

/* Over the window around a cell that is wide enough by `some`, or by degrees of freedom. */
static struct cell_sums window_sums(const struct sparse *sparse, size_t cell, bool outside,
                                    bool by_freedom) {
    size_t low = cell - cell % sparse->tally.row, high = low + sparse->tally.row;
    for (size_t reach = 0;; reach++) {
        size_t first = cell - low > reach ? cell - reach : low;
        size_t last = high - cell > reach ? cell + reach + 1 : high;
        struct cell_sums out = {0};
        for (size_t a = first; a < last; a++) {
            struct cell_sums one = cell_sums(sparse, a, outside);
            out.things += one.things;
            out.rare_things += one.rare_things;
            out.rare_variance += one.rare_variance;
            out.some += one.some;
            out.variance += one.variance;
            out.squares += one.freedom > 0 ? one.squares : 0;
            out.weight += one.weight;
            out.freedom += one.freedom;
        }
        if ((by_freedom ? out.freedom : out.some) >= TALLY_RARE || (first == low && last == high))
            return out;
    }
}

static void check_share(const struct sparse *sparse, size_t cell, struct estimate share,
                        size_t *rare) {
    bool outside = 2 * (double)sparse->tally.count[cell] > (double)sparse->total.sum;
    struct cell_sums own = cell_sums(sparse, cell, outside);
    if (own.some >= TALLY_RARE)
        return;
    struct cell_sums window = window_sums(sparse, cell, outside, false);
    double dispersion = window.things > 0 ? fmax(1, window.variance / window.things) : 1;
    if (window.rare_things > 0)
        dispersion = fmax(dispersion, window.rare_variance / window.rare_things);
    double error = own.things > 0 ? dispersion * sqrt(own.things / dispersion + 1)
                                  : dispersion * TALLY_NONE_SEEN;
    check_relative(share.standard_error, error / (double)sparse->total.sum, 1e-9);
    rare[outside]++;
}

static void check_ratio(const struct sparse *sparse, size_t cell, struct estimate ratio,
                        size_t *few) {
    uint64_t some = sparse->tally.some[cell];
    if (some < 2 || some >= TALLY_RARE)
        return;
    struct cell_sums window = window_sums(sparse, cell, false, true);
    double n = (double)sparse->tally.count[cell];
    check_close(ratio.standard_error, sqrt(window.squares / window.weight / n), 1e-9);
    (*few)++;
}

static void walks_find_what_windows_do(void **state) {
    (void)state;
    static struct sparse sparse;
    static struct estimate shares[CELLS], ratios[CELLS];
    uint64_t seed = seed_of_now();
    size_t rare[2] = {0, 0}, few = 0;
    for (int trial = 0; trial < TRIALS; trial++) {
        draw(&sparse, &seed, trial % 2 == 1);
        tally_shares(&sparse.tally, 0, CELLS, &sparse.total, shares);
        tally_sums_ratios_pooled(&sparse.sums, &sparse.tally, 0, CELLS, ratios);
        for (size_t cell = 0; cell < CELLS; cell++) {
            struct estimate alone = tally_share(&sparse.tally, cell, &sparse.total);
            assert_true(alone.value == shares[cell].value &&
                        alone.standard_error == shares[cell].standard_error);
            check_share(&sparse, cell, shares[cell], rare);
            check_ratio(&sparse, cell, ratios[cell], &few);
        }
        tally_clear(&sparse.tally);
        tally_sums_clear(&sparse.sums);
    }
    assert_true(rare[0] > 10 * TRIALS && rare[1] > 10 * TRIALS && few > 10 * TRIALS);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(walks_find_what_windows_do)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
