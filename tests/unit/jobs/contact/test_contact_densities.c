/* Protects: the difference of densities between models and levels has the mean and standard error
 * of the differences of single realisations, also where few realisations have things in a bin; its
 * sums do not depend on the order of merging, and are refused where no realisations could have
 * them; the error of the model that follows is the difference of the two curves. */
#include "jobs/contact/case/contact_case_read.h"
#include "jobs/contact/tally/contact_tally.h"
#include "tests/support/contact_document.h"
#include "tests/support/seed.h"
#include <stdlib.h>

#define STUDY(pairs)                                                                               \
    "{\"surface\": {\"dimension\": 1, \"hurst\": 0.8, \"wavelength_ratio\": 4, \"length_ratio\":"  \
    " 2, \"rms_slope\": 0.1}, \"contact\": {\"model\": [\"halfspace\", \"layered\"], \"levels\":"  \
    " [4, 8, 16], \"pressures\": {\"values\": [0.1, 0.3]}, \"pressure_pdf\": {\"at\": [0.1, 0.3]," \
    " \"bins\": [0, 2, 8]" pairs "}}}"
#define COUNTED STUDY(", \"pairs\": \"counted\"")

enum { MODELS = 2, LEVELS = 3, STATES = MODELS * LEVELS, LOADS = 2, BINS = 8, RUNS = 40 };

struct fixture {
    struct contact_case one_case;
    struct contact_densities densities;
};

static void fixture_open(struct fixture *fixture, const char *text) {
    struct error err = {0};
    cJSON *parameters = cJSON_Parse(text);
    assert_non_null(parameters);
    if (contact_case_read(&fixture->one_case, parameters, 0, NULL, &err) != 0 ||
        contact_densities_create(&fixture->densities, &fixture->one_case, &err) != 0)
        fail_msg("%s", err.text);
    cJSON_Delete(parameters);
}

static void fixture_close(struct fixture *fixture) {
    contact_densities_clear(&fixture->densities);
    contact_case_clear(&fixture->one_case);
}

/* Shares of the area by realisation, state and bin: large ones in the first bins, things of one
 * realisation in the last but one, none in the last. */
struct drawn {
    double shares[RUNS][STATES][BINS];
};

static double number_between(uint64_t *seed, double low, double high) {
    return low + (high - low) * ldexp((double)(next_word(seed) >> 11), -53);
}

static void draw(struct drawn *out, uint64_t usual) {
    uint64_t seed = seed_or(usual);
    for (size_t r = 0; r < RUNS; r++) {
        double common = number_between(&seed, 0.5, 1.5);
        for (size_t s = 0; s < STATES; s++)
            for (size_t b = 0; b < BINS; b++) {
                double share = (common + number_between(&seed, 0, 0.1)) * 0.05 / (double)(b + 1);
                out->shares[r][s][b] = b < 6 ? share : b == 6 && r == 3 ? 1e-3 * share : 0;
            }
    }
}

static void add(struct contact_densities *densities, const struct drawn *drawn, size_t r) {
    for (size_t s = 0; s < STATES; s++)
        for (size_t at = 0; at < LOADS; at++) {
            double shares[BINS + 2] = {0};
            memcpy(shares + 1, drawn->shares[r][s], sizeof drawn->shares[r][s]);
            contact_densities_set(densities, s, at, shares);
        }
    contact_densities_add(densities);
}

/* The mean and the standard error over realisations from `first` on of a difference in a bin. */
static struct estimate expected(const struct drawn *drawn, size_t first, const int *weights,
                                size_t bin) {
    double values[RUNS] = {0};
    for (size_t r = first; r < RUNS; r++)
        for (size_t s = 0; s < STATES; s++)
            values[r] += weights[s] * drawn->shares[r][s][bin];
    return estimate_mean(RUNS - first, values + first);
}

/* Shares are rounded to 2^-32 of the cell. */
static void differences_are_those_of_realisations(void **state) {
    (void)state;
    static const int WEIGHTS[][STATES] = {
        {0, -1, 1, 0, 0, 0}, {0, 0, -1, 0, 0, 1}, {0, 1, -1, 0, -1, 1}, {1, 0, 0, 0, 0, 0}};
    static const double NONE[BINS] = {0};
    static struct drawn drawn;
    struct fixture f;
    struct estimate out[BINS];
    fixture_open(&f, COUNTED);
    draw(&drawn, 7);
    for (size_t r = 0; r < RUNS; r++)
        add(&f.densities, &drawn, r);
    for (size_t w = 0; w < sizeof WEIGHTS / sizeof *WEIGHTS; w++) {
        contact_densities_difference(&f.densities, 1, WEIGHTS[w], NONE, out);
        for (size_t b = 0; b < 6; b++) {
            struct estimate own = expected(&drawn, 0, WEIGHTS[w], b);
            assert_near(out[b].value, own.value, 1e-9, (double)b);
            assert_near(out[b].standard_error, own.standard_error, 1e-9, (double)b);
        }
        assert_true(out[7].value == 0);
    }
    fixture_close(&f);
}

/* One realisation of 40 does not show the variance of a bin, and none not at all: what the other
 * bins show of it holds, times the share that is expected. */
static void rare_bins_take_the_dispersion_of_others(void **state) {
    (void)state;
    static const int WEIGHTS[STATES] = {0, -1, 1, 0, 0, 0};
    double usual[BINS], more[BINS];
    static struct drawn drawn;
    struct fixture f;
    struct estimate out[BINS], twice[BINS];
    fixture_open(&f, COUNTED);
    draw(&drawn, 8);
    for (size_t r = 0; r < RUNS; r++)
        add(&f.densities, &drawn, r);
    for (size_t b = 0; b < BINS; b++) {
        usual[b] = b < 6 ? 0 : 1e-4;
        more[b] = 4 * usual[b];
    }
    contact_densities_difference(&f.densities, 0, WEIGHTS, usual, out);
    contact_densities_difference(&f.densities, 0, WEIGHTS, more, twice);
    double variance = 0, share = 0;
    for (size_t b = 0; b < 7; b++) {
        double error = expected(&drawn, 0, WEIGHTS, b).standard_error;
        variance += error * error * RUNS;
        for (size_t r = 0; r < RUNS; r++)
            share += (drawn.shares[r][1][b] + drawn.shares[r][2][b]) / 2 / RUNS;
    }
    for (size_t b = 6; b < BINS; b++) {
        double error = sqrt(variance / share * 1e-4 / RUNS);
        assert_near(out[b].standard_error, error, 1e-3 * error, (double)b);
        assert_near(twice[b].standard_error, 2 * error, 2e-3 * error, (double)b);
    }
    for (size_t b = 0; b < 6; b++)
        assert_true(out[b].standard_error == twice[b].standard_error);
    fixture_close(&f);
}

/* A realisation that a state lacks at a load is left out there, and counted at the other. */
static void realisations_without_a_state_are_left_out(void **state) {
    (void)state;
    static const int WEIGHTS[STATES] = {0, 0, -1, 0, 0, 1};
    static const double NONE[BINS] = {0};
    static struct drawn drawn;
    struct fixture f;
    struct estimate out[BINS];
    fixture_open(&f, COUNTED);
    draw(&drawn, 9);
    for (size_t s = 0; s < STATES; s++) {
        const double shares[BINS + 2] = {0, 0.3};
        contact_densities_set(&f.densities, s, 0, shares);
        if (s > 0)
            contact_densities_set(&f.densities, s, 1, shares);
    }
    contact_densities_add(&f.densities);
    for (size_t r = 1; r < RUNS; r++)
        add(&f.densities, &drawn, r);
    assert_int_equal(f.densities.realisations[0], RUNS);
    assert_int_equal(f.densities.realisations[1], RUNS - 1);
    contact_densities_difference(&f.densities, 1, WEIGHTS, NONE, out);
    for (size_t b = 0; b < 6; b++)
        assert_near(out[b].value, expected(&drawn, 1, WEIGHTS, b).value, 1e-9, (double)b);
    fixture_close(&f);
}

static void one_realisation_has_no_error(void **state) {
    (void)state;
    static const int WEIGHTS[STATES] = {0, 0, -1, 0, 0, 1};
    static const double NONE[BINS] = {0};
    static struct drawn drawn;
    struct fixture f;
    struct estimate out[BINS];
    fixture_open(&f, COUNTED);
    draw(&drawn, 9);
    add(&f.densities, &drawn, 0);
    contact_densities_difference(&f.densities, 0, WEIGHTS, NONE, out);
    for (size_t b = 0; b < BINS; b++)
        assert_true(isnan(out[b].value) && isnan(out[b].standard_error));
    fixture_close(&f);
}

static struct bytes encoded(const struct contact_densities *densities) {
    struct bytes bytes = {0};
    contact_densities_put(&bytes, densities);
    bytes_put_checksum(&bytes);
    assert_false(bytes.failed);
    return bytes;
}

/* Returns whether the bytes are read whole. */
static bool decodes(const struct bytes *bytes, struct contact_densities *out) {
    struct byte_reader reader = bytes_open(bytes->data, bytes->size);
    contact_densities_get(&reader, out);
    return !reader.failed && reader.at == reader.end;
}

static void blocks_merge_in_any_order(void **state) {
    (void)state;
    static struct drawn drawn;
    struct fixture whole, parts[2], sum;
    draw(&drawn, 10);
    fixture_open(&whole, COUNTED);
    fixture_open(&sum, COUNTED);
    for (size_t p = 0; p < 2; p++)
        fixture_open(&parts[p], COUNTED);
    for (size_t r = 0; r < RUNS; r++) {
        add(&whole.densities, &drawn, r);
        add(&parts[r % 3 == 0].densities, &drawn, r);
    }
    for (size_t p = 2; p > 0; p--) {
        struct fixture copy;
        fixture_open(&copy, COUNTED);
        struct bytes bytes = encoded(&parts[p - 1].densities);
        assert_true(decodes(&bytes, &copy.densities));
        contact_densities_merge(&sum.densities, &copy.densities);
        bytes_clear(&bytes);
        fixture_close(&copy);
    }
    struct bytes one = encoded(&whole.densities), other = encoded(&sum.densities);
    assert_int_equal(one.size, other.size);
    assert_memory_equal(one.data, other.data, one.size);
    bytes_clear(&one);
    bytes_clear(&other);
    fixture_close(&whole);
    fixture_close(&sum);
    for (size_t p = 0; p < 2; p++)
        fixture_close(&parts[p]);
}

/* Sums that no shares have are refused: more than whole cells, squares less than sums, products of
 * two above those of both. */
static void impossible_sums_are_refused(void **state) {
    (void)state;
    static struct drawn drawn;
    draw(&drawn, 11);
    for (int flaw = 0; flaw < 4; flaw++) {
        struct fixture f, copy;
        fixture_open(&f, COUNTED);
        fixture_open(&copy, COUNTED);
        for (size_t r = 0; r < RUNS; r++)
            add(&f.densities, &drawn, r);
        if (flaw == 1)
            f.densities.sum[0] = (uint64_t)(RUNS + 1) << 32;
        if (flaw == 2)
            f.densities.product[0] = 1;
        if (flaw == 3)
            f.densities.product[1] *= 4;
        struct bytes bytes = encoded(&f.densities);
        assert_int_equal(decodes(&bytes, &copy.densities), flaw == 0);
        bytes_clear(&bytes);
        fixture_close(&f);
        fixture_close(&copy);
    }
}

static void nothing_is_kept_unless_asked_for(void **state) {
    (void)state;
    struct fixture f;
    fixture_open(&f, STUDY(""));
    struct bytes bytes = {0};
    contact_densities_put(&bytes, &f.densities);
    assert_int_equal(bytes.size, 0);
    assert_true(contact_densities_bytes(&f.one_case) == 0);
    assert_false(contact_tally_counts(&f.one_case, 0));
    fixture_close(&f);
    fixture_open(&f, COUNTED);
    assert_true(contact_tally_counts(&f.one_case, 0));
    fixture_close(&f);
}

/* The half-space less the layers, which are the more complete model, at every bin. Nothing else of
 * the curves changes with the pairs; without them the error is not known. */
static void densities_have_the_error_of_the_model(void **state) {
    (void)state;
    cJSON *counted = solve(COUNTED, 12), *omitted = solve(STUDY(""), 12);
    const cJSON *half = curve_of(counted, "contact_pressure_pdf", "", "halfspace");
    const cJSON *layers = curve_of(counted, "contact_pressure_pdf", "", "layered");
    const cJSON *plain = curve_of(omitted, "contact_pressure_pdf", "", "halfspace");
    double paired = 0, independent = 0;
    for (int b = 0; b < BINS; b++) {
        double difference = at(half, "/y", b) - at(layers, "/y", b);
        assert_near(at(half, "/model_error", b), difference, 1e-6, at(half, "/x", b));
        assert_true(at(half, "/y", b) == at(plain, "/y", b));
        assert_true(at(half, "/discretisation_bound", b) == at(plain, "/discretisation_bound", b));
        assert_true(at(half, "/model_bound", b) >= 0);
        paired += at(half, "/model_error_standard_error", b);
        independent += hypot(at(half, "/standard_error", b), at(layers, "/standard_error", b));
    }
    assert_true(paired > 0 && paired < independent);
    assert_false(cJSON_IsArray(json_at(plain, "/model_error")));
    assert_false(cJSON_IsArray(json_at(layers, "/model_error")));
    cJSON_Delete(counted);
    cJSON_Delete(omitted);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(differences_are_those_of_realisations),
        cmocka_unit_test(rare_bins_take_the_dispersion_of_others),
        cmocka_unit_test(realisations_without_a_state_are_left_out),
        cmocka_unit_test(one_realisation_has_no_error),
        cmocka_unit_test(blocks_merge_in_any_order),
        cmocka_unit_test(impossible_sums_are_refused),
        cmocka_unit_test(nothing_is_kept_unless_asked_for),
        cmocka_unit_test(densities_have_the_error_of_the_model),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
