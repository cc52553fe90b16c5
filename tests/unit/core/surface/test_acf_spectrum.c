/* Protects: the spectrum of an autocorrelation by a table, to closed forms; and that what no
 * surface has is refused. */
#include "core/surface/acf_spectrum.h"
#include "tests/support/check.h"
#include <math.h>
#include <string.h>

enum { LAGS = 400, WAVES = 60 };
static const double LENGTH = 2;

static double exponential(double lag) {
    return exp(-lag / LENGTH);
}
static double gaussian(double lag) {
    return exp(-lag * lag / (LENGTH * LENGTH));
}
static double triangle(double lag) {
    return fmax(0, 1 - lag / LENGTH);
}
static double box(double lag) {
    return lag < LENGTH ? 1 : 0;
}

/* Over the density at the wave number 0, of profiles and of surfaces. */
static double exponential_density(int dimension, double k) {
    return pow(1 + k * k * LENGTH * LENGTH, dimension == 1 ? -1 : -1.5);
}
static double gaussian_density(int dimension, double k) {
    (void)dimension;
    return exp(-k * k * LENGTH * LENGTH / 4);
}
static double triangle_density(int dimension, double k) {
    (void)dimension; /* of profiles */
    return pow(sin(k * LENGTH / 2) / (k * LENGTH / 2), 2);
}

static int transformed(int dimension, double (*correlation)(double lag), double spacing,
                       const double *k, double *density, struct error *err) {
    static double lag[LAGS], values[LAGS];
    const struct acf_table table = {LAGS, lag, values};
    for (size_t a = 0; a < LAGS; a++) {
        lag[a] = spacing * (double)a;
        values[a] = correlation(lag[a]);
    }
    return acf_spectrum(dimension, &table, WAVES, k, density, err);
}

/* Tables of 20 lags a correlation length: interpolation leaves 5e-4 of the highest density, which
 * is doubled here. */
static void closed_forms(void **state) {
    (void)state;
    static const struct {
        double (*correlation)(double lag);
        double (*density)(int dimension, double k);
        int dimensions;
    } KNOWN[] = {{exponential, exponential_density, 2},
                 {gaussian, gaussian_density, 2},
                 {triangle, triangle_density, 1}};
    double k[WAVES], density[WAVES];
    for (size_t a = 0; a < WAVES; a++)
        k[a] = 0.001 + 0.1 * (double)a;
    for (size_t n = 0; n < sizeof KNOWN / sizeof *KNOWN; n++)
        for (int dimension = 1; dimension <= KNOWN[n].dimensions; dimension++) {
            struct error err = {0};
            if (transformed(dimension, KNOWN[n].correlation, 0.1, k, density, &err) != 0)
                fail_msg("%zu: %s", n, err.text);
            for (size_t a = 0; a < WAVES; a++)
                check_close(density[a] / density[0],
                            KNOWN[n].density(dimension, k[a]) / KNOWN[n].density(dimension, k[0]),
                            1e-3);
        }
}

static void what_no_surface_has_is_refused(void **state) {
    (void)state;
    double k[WAVES], density[WAVES];
    struct error err = {0};
    for (size_t a = 0; a < WAVES; a++)
        k[a] = 0.05 + 0.1 * (double)a;
    assert_int_equal(transformed(1, box, 0.1, k, density, &err), ERROR_INPUT);
    assert_non_null(strstr(err.text, "no profile has this autocorrelation"));
    assert_int_equal(transformed(2, triangle, 0.1, k, density, &err), ERROR_INPUT);
    assert_non_null(strstr(err.text, "no isotropic surface"));
    static const double LAG[] = {0, 1, 1, 2}, VALUE[] = {1, 0.5, 0.2, 1.5};
    const struct {
        struct acf_table table;
        const char *word;
    } BAD[] = {{{2, LAG, VALUE}, "3 lags"},
               {{3, LAG + 1, VALUE}, "begins with 1"},
               {{3, LAG, VALUE + 1}, "begins with 1"},
               {{4, LAG, VALUE}, "number 2, 1, does not"}};
    for (size_t n = 0; n < sizeof BAD / sizeof *BAD; n++) {
        assert_int_equal(acf_table_check(&BAD[n].table, &err), ERROR_INPUT);
        assert_non_null(strstr(err.text, BAD[n].word));
    }
    const struct acf_table high = {3, (const double[]){0, 1, 2}, (const double[]){1, 1.5, 0}};
    assert_int_equal(acf_table_check(&high, &err), ERROR_INPUT);
    const struct acf_table endless = {3, (const double[]){0, 1, 1e6}, (const double[]){1, 0.5, 0}};
    assert_int_equal(acf_spectrum(2, &endless, WAVES, k, density, &err), ERROR_INPUT);
    assert_non_null(strstr(err.text, "too many"));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(closed_forms),
        cmocka_unit_test(what_no_surface_has_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
