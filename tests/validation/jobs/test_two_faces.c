/* Protects contact studies of two rough faces: contact of their sum is that of one face with the
 * sum of their spectra, in profiles and surfaces, with the same theory curves. */
#include "tests/support/contact_document.h"
#include "tests/support/effort.h"
#include <stdio.h>

#define CELL(dimension, length)                                                                    \
    "\"dimension\": " dimension ", \"length_ratio\": " length ", \"points_per_wavelength\": 8"
#define CONTACT                                                                                    \
    "\"contact\": {\"cell_error\": \"none\", \"pressures\": {\"values\": [0.02, 0.1, 0.3]}}}"
#define TWO(cell, face, counter)                                                                   \
    "{\"surface\": {" cell ", " face "}, \"counter_surface\": {" counter "}, " CONTACT
#define ONE(cell, face) "{\"surface\": {" cell ", \"amplitudes\": \"random\", " face "}, " CONTACT
#define AFFINE(hurst, ratio, slope)                                                                \
    "\"hurst\": " hurst ", \"wavelength_ratio\": " ratio ", \"rms_slope\": " slope

/* Means of area and gap differ by at most 4 standard errors of both; theory is the same to rounding
 * of the spectra. */
static void compare(const char *two, const char *one, uint64_t count, double theory) {
    static const char *const QUANTITIES[][2] = {{"contact_area", "edges"}, {"mean_gap", ""}};
    cJSON *pair = solve(two, count), *single = solve(one, count);
    for (size_t q = 0; q < 2; q++) {
        const cJSON *a = curve_of(pair, QUANTITIES[q][0], QUANTITIES[q][1], "halfspace");
        const cJSON *b = curve_of(single, QUANTITIES[q][0], QUANTITIES[q][1], "halfspace");
        assert_int_equal(points(a), 3);
        for (int k = 0; k < points(a); k++) {
            double error = hypot(at(a, "/standard_error", k), at(b, "/standard_error", k));
            printf("%s at %g: %.5f and %.5f, %+.2f standard errors\n", QUANTITIES[q][0],
                   at(a, "/x", k), at(a, "/y", k), at(b, "/y", k),
                   (at(a, "/y", k) - at(b, "/y", k)) / error);
            assert_true(error > 0 && error < 0.05 * at(b, "/y", k));
            assert_near(at(a, "/y", k), at(b, "/y", k), 4 * error, at(a, "/x", k));
        }
    }
    const cJSON *a = curve_of(pair, "contact_area", "edges", "halfspace");
    const cJSON *b = curve_of(single, "contact_area", "edges", "halfspace");
    for (int k = 0; k < points(a); k++) {
        assert_near(at(a, "/theory/persson", k), at(b, "/theory/persson", k), 1e-12, k);
        if (json_at(b, "/theory/bgt") != NULL)
            assert_near(at(a, "/theory/bgt", k), at(b, "/theory/bgt", k), theory, k);
    }
    cJSON_Delete(pair);
    cJSON_Delete(single);
}

/* One face of the same spectrum and sqrt(2) times the heights. Its amplitudes are random, as those
 * of the sum are. */
static void same_spectrum(void **state) {
    (void)state;
    compare(TWO(CELL("1", "16"), AFFINE("0.8", "8", "0.1"), AFFINE("0.8", "8", "0.1")),
            ONE(CELL("1", "16"), AFFINE("0.8", "8", "0.141421356237309505")),
            100 * (uint64_t)effort(), 1e-10);
    compare(TWO(CELL("2", "4"), AFFINE("0.8", "4", "0.1"), AFFINE("0.8", "4", "0.1")),
            ONE(CELL("2", "4"), AFFINE("0.8", "4", "0.141421356237309505")),
            20 * (uint64_t)effort(), 1e-10);
}

/* White spectra of profiles up to two cut-offs, of equal m0. In a cell of 128 lambda_s one face has
 * waves 16 to 128, 113 of them, and the other 16 to 64, 49 of them. Their sum is a table with a
 * step: 1/113 + 1/49 is to 1/113 as 162 to 49. */
static void different_cut_offs(void **state) {
    (void)state;
    static const char two[] =
        TWO(CELL("1", "16"),
            "\"wavelength_ratio\": 8, \"spectrum\": {\"type\": \"table\", \"wave_number\": "
            "[0.7853, 6.29], \"density\": [1, 1]}, \"rms_height\": 0.05",
            "\"spectrum\": {\"type\": \"table\", \"wave_number\": [0.7853, 3.15], \"density\": "
            "[1, 1]}, \"rms_height\": 0.05");
    static const char one[] =
        ONE(CELL("1", "16"),
            "\"wavelength_ratio\": 8, \"spectrum\": {\"type\": \"table\", \"wave_number\": "
            "[0.7853, 3.15, 3.151, 6.29], \"density\": [162, 162, 49, 49]}, \"rms_height\": "
            "0.070710678118654752");
    compare(two, one, 100 * (uint64_t)effort(), 1e-10);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(same_spectrum),
        cmocka_unit_test(different_cut_offs),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
