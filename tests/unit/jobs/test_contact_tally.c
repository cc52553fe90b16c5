/* Sums of contact realisations: values at very light loads keep their digits, realisations without
 * a value are left out and counted, and pressures lie on the area in contact. */
#include "jobs/contact/contact_tally.h"
#include "jobs/partial.h"
#include "tests/support/check.h"
#include <stdlib.h>
#include <string.h>

#define STUDY(contact)                                                                             \
    "{\"surface\": {\"dimension\": 1, \"hurst\": 0.8, \"wavelength_ratio\": 2,"                    \
    " \"length_ratio\": 1}, \"contact\": {" contact "}}"

/* 16 points; bins of pressure 1 to 2, 2 to 3, 3 to 4. */
static const char FULL_STUDY[] =
    "{\"surface\": {\"dimension\": 1, \"hurst\": 0.8, \"wavelength_ratio\": 2, \"length_ratio\":"
    " 1, \"rms_slope\": 0.1}, \"contact\": {\"model\": [\"layered\", \"full\"], \"pressures\":"
    " {\"values\": [0.1]}, \"pressure_pdf\": {\"bins\": [1, 4, 3]}}}";

struct tally_fixture {
    struct contact_case one_case;
    struct contact_tally tally;
};

static void fixture_open(struct tally_fixture *fixture, const char *text) {
    struct error err = {0};
    cJSON *parameters = cJSON_Parse(text);
    assert_non_null(parameters);
    if (contact_case_read(&fixture->one_case, parameters, NULL, &err) != 0 ||
        contact_tally_create(&fixture->tally, &fixture->one_case, &err) != 0)
        fail_msg("%s", err.text);
    cJSON_Delete(parameters);
}

static void fixture_close(struct tally_fixture *fixture) {
    contact_tally_clear(&fixture->tally);
    contact_case_clear(&fixture->one_case);
}

/* Areas and stiffness fall with the load. Exact sums resolve 2^-60 = 9e-19, squares too: at 1e-8 a
 * value of 1e-8 scaled by 2^16 has the square 4e-7. */
static void light_loads_keep_their_digits(void **state) {
    (void)state;
    static const double loads[] = {1e-12, 1e-8, 1e-3, 0.5, 100};
    static const enum contact_measure measures[] = {MEASURE_NODES, MEASURE_EDGES, MEASURE_STIFFNESS,
                                                    MEASURE_PATCH_MEAN};
    struct tally_fixture f;
    fixture_open(&f, STUDY("\"pressures\": {\"values\": [1e-12, 1e-8, 1e-3, 0.5, 100]}"));
    for (int r = 0; r < 2; r++) {
        for (size_t k = 0; k < 5; k++)
            for (size_t a = 0; a < 4; a++)
                contact_tally_values(&f.tally, measures[a])[k] = loads[k] * (r == 0 ? 1.9 : 2.1);
        contact_tally_add(&f.tally);
    }
    for (size_t k = 0; k < 5; k++)
        for (size_t a = 0; a < 4; a++) {
            struct estimate mean = contact_tally_mean(&f.tally, measures[a], k);
            double tolerance = k == 0 ? 1e-6 : 1e-10;
            check_relative(mean.value, 2 * loads[k], tolerance);
            if (k > 0) /* half the difference; at 1e-12 the squares are below resolution */
                check_relative(mean.standard_error, 0.1 * loads[k], 1e-6);
        }
    fixture_close(&f);
}

static void valueless_realisations_are_counted(void **state) {
    (void)state;
    struct tally_fixture f;
    fixture_open(&f, STUDY("\"pressures\": {\"values\": [0.1]}"));
    static const double stiffness[] = {1, NAN, 3, NAN};
    for (size_t r = 0; r < 4; r++) {
        contact_tally_values(&f.tally, MEASURE_STIFFNESS)[0] = stiffness[r];
        contact_tally_add(&f.tally);
    }
    check_close(contact_tally_mean(&f.tally, MEASURE_STIFFNESS, 0).value, 2, 1e-14);
    assert_int_equal(contact_tally_valueless(&f.tally, MEASURE_STIFFNESS, 0), 2);
    assert_true(isnan(contact_tally_mean(&f.tally, MEASURE_GAP, 0).value));
    assert_true(isnan(contact_tally_model(&f.tally, MEASURE_GAP, 0, 0).value));
    fixture_close(&f);
}

/* Pressures lie on the area in contact, stretched as it is: that of some nodes of 16, or of all,
 * each 1.25 times as large in the model full. A block that tells otherwise is refused. */
static void pressures_lie_on_the_area(void **state) {
    (void)state;
    static const struct {
        size_t nodes;
        double told; /* of their stretch, in the histogram */
        int status;
    } CASES[] = {{3, 1.25, 0}, {16, 1.25, 0}, {3, 1, ERROR_INPUT}};
    static const enum contact_measure always[] = {MEASURE_NODES, MEASURE_EDGES, MEASURE_GAP,
                                                  MEASURE_ITERATIONS};
    for (size_t c = 0; c < sizeof CASES / sizeof *CASES; c++) {
        struct tally_fixture f, copy;
        struct error err = {0};
        double share = (double)CASES[c].nodes / 16, pressures[16] = {0};
        unsigned char *data = NULL;
        size_t size = 0;
        for (size_t i = 0; i < CASES[c].nodes; i++)
            pressures[i] = 2;
        fixture_open(&f, FULL_STUDY);
        fixture_open(&copy, FULL_STUDY);
        for (size_t m = 0; m < 2; m++) {
            for (size_t a = 0; a < 4; a++)
                contact_tally_values(&f.tally, always[a])[m] = (m == 1 ? 1.25 : 1) * share;
            contact_tally_pressures(&f.tally, m, 0, 0, pressures, 1, m == 1 ? CASES[c].told : 1);
        }
        contact_tally_add(&f.tally);
        check_relative(contact_tally_pressure(&f.tally, 1, 0, 0, 2).value, CASES[c].told * share,
                       1e-14);
        assert_int_equal(partial_encode(kind_find("contact"), 1, &f.tally, &data, &size, &err), 0);
        assert_int_equal(partial_decode(kind_find("contact"), 1, data, size, &copy.tally, &err),
                         CASES[c].status);
        assert_true(CASES[c].status == 0 || strstr(err.text, "does not add up") != NULL);
        free(data);
        fixture_close(&f);
        fixture_close(&copy);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(light_loads_keep_their_digits),
        cmocka_unit_test(valueless_realisations_are_counted),
        cmocka_unit_test(pressures_lie_on_the_area),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
