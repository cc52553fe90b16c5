/* Sums of contact realisations: values at very light loads keep their digits, and realisations
 * without a value are left out and counted. Pressures lie on the area in contact. The rows of
 * single realisations are the same however they were merged. */
#include "jobs/contact/case/contact_case_read.h"
#include "jobs/contact/tally/contact_tally.h"
#include "jobs/partial.h"
#include "tests/support/check.h"
#include "tests/support/seed.h"
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
    if (contact_case_read(&fixture->one_case, parameters, 0, NULL, &err) != 0 ||
        contact_tally_create(&fixture->tally, &fixture->one_case, &err) != 0)
        fail_msg("%s", err.text);
    cJSON_Delete(parameters);
}

static void add_realisation(struct contact_tally *tally) {
    struct error err = {0};
    assert_int_equal(contact_tally_add(tally, &err), 0);
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
        add_realisation(&f.tally);
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
        add_realisation(&f.tally);
    }
    check_close(contact_tally_mean(&f.tally, MEASURE_STIFFNESS, 0).value, 2, 1e-14);
    assert_int_equal(contact_tally_valueless(&f.tally, MEASURE_STIFFNESS, 0), 2);
    assert_true(isnan(contact_tally_mean(&f.tally, MEASURE_GAP, 0).value));
    assert_true(isnan(contact_tally_model(&f.tally, MEASURE_GAP, 0, 0).value));
    fixture_close(&f);
}

/* Puts an area into the bin of pressures from 2 to 3, and a part of it below all bins. */
static void add_pressures(struct contact_tally *tally, size_t model, double area, double below) {
    const double shares[5] = {below * area, 0, (1 - below) * area, 0, 0};
    contact_tally_pressures(tally, model, 0, 0, shares);
}

/* Pressures lie on the area by edges, whatever it is. A block that has another is refused. */
static void pressures_lie_on_the_area(void **state) {
    (void)state;
    static const struct {
        double edges, told; /* by edges, and in the histogram */
        int status;
    } CASES[] = {{0.2, 0.2, 0}, {1, 1, 0}, {1.0 / 3, 1.0 / 3, 0}, {0.2, 0.1999, ERROR_INPUT}};
    static const enum contact_measure always[] = {MEASURE_NODES, MEASURE_EDGES, MEASURE_GAP,
                                                  MEASURE_ITERATIONS};
    for (size_t c = 0; c < sizeof CASES / sizeof *CASES; c++) {
        struct tally_fixture f, copy;
        struct error err = {0};
        unsigned char *data = NULL;
        size_t size = 0;
        fixture_open(&f, FULL_STUDY);
        fixture_open(&copy, FULL_STUDY);
        for (size_t m = 0; m < 2; m++) {
            for (size_t a = 0; a < 4; a++)
                contact_tally_values(&f.tally, always[a])[m] = a == 1 ? CASES[c].edges : 0.25;
            add_pressures(&f.tally, m, CASES[c].told, 0.4);
        }
        add_realisation(&f.tally);
        /* 2^-20 of each of 16 nodes */
        const uint64_t *parts =
            f.tally.pressures.count + contact_tally_pressure_cell(&f.tally, 1, 0, 0);
        double all = 16 * (double)CONTACT_AREA_PARTS;
        check_close((double)parts[0] / all, 0.4 * CASES[c].told, 6e-8);
        check_close((double)parts[2] / all, 0.6 * CASES[c].told, 6e-8);
        assert_int_equal(partial_encode(kind_find("contact"), 1, &f.tally, &data, &size, &err), 0);
        assert_int_equal(partial_decode(kind_find("contact"), 1, data, size, &copy.tally, &err),
                         CASES[c].status);
        assert_true(CASES[c].status == 0 || strstr(err.text, "does not add up") != NULL);
        free(data);
        fixture_close(&f);
        fixture_close(&copy);
    }
}

/* --- rows --- */

/* Tallies a realisation whose values follow from its number. */
static void add_row(struct contact_tally *tally, uint64_t realisation) {
    static const enum contact_measure always[] = {MEASURE_NODES, MEASURE_EDGES, MEASURE_GAP,
                                                  MEASURE_ITERATIONS};
    for (size_t m = 0; m < 2; m++) {
        for (size_t a = 0; a < 4; a++)
            contact_tally_values(tally, always[a])[m] = a == 0 ? 0.25 : (double)realisation / 7;
        add_pressures(tally, m, (double)realisation / 7, 0);
    }
    tally->realisation = realisation;
    add_realisation(tally);
}

static void check_same_bytes(const struct contact_tally *a, const struct contact_tally *b) {
    struct bytes one = {0}, other = {0};
    contact_tally_put(&one, a);
    contact_tally_put(&other, b);
    assert_int_equal(one.size, other.size);
    assert_memory_equal(one.data, other.data, one.size);
    bytes_clear(&one);
    bytes_clear(&other);
}

/* Realisations in one tally, or split at random among several that are merged in random order, make
 * the same bytes, and these are read to the same rows. */
static void rows_merge_in_any_order(void **state) {
    (void)state;
    enum { ROWS = 40, PARTS = 5 };
    uint64_t seed = seed_of_now();
    struct error err = {0};
    for (int trial = 0; trial < 20; trial++) {
        struct tally_fixture all, part[PARTS], into, read;
        fixture_open(&all, FULL_STUDY);
        fixture_open(&into, FULL_STUDY);
        fixture_open(&read, FULL_STUDY);
        for (size_t p = 0; p < PARTS; p++)
            fixture_open(&part[p], FULL_STUDY);
        for (uint64_t r = 0; r < ROWS; r++) {
            add_row(&all.tally, 3 * r);
            add_row(&part[next_word(&seed) % PARTS].tally, 3 * r);
        }
        size_t first = (size_t)(next_word(&seed) % PARTS);
        for (size_t p = 0; p < PARTS; p++)
            assert_int_equal(
                contact_tally_merge(&into.tally, &part[(first + 3 * p) % PARTS].tally, &err), 0);
        assert_int_equal(into.tally.rows.count, ROWS);
        check_same_bytes(&all.tally, &into.tally);
        struct bytes bytes = {0};
        contact_tally_put(&bytes, &all.tally);
        struct byte_reader reader = {bytes.data, bytes.data + bytes.size, false, false};
        contact_tally_get(&reader, &read.tally);
        assert_true(!reader.failed && reader.at == reader.end);
        check_same_bytes(&all.tally, &read.tally);
        assert_true(contact_tally_adds_up(&read.tally));
        bytes_clear(&bytes);
        for (size_t p = 0; p < PARTS; p++)
            fixture_close(&part[p]);
        fixture_close(&all);
        fixture_close(&into);
        fixture_close(&read);
    }
}

/* Each value is found where the measure, model and load say. */
static void rows_hold_the_values(void **state) {
    (void)state;
    struct tally_fixture f;
    size_t column;
    fixture_open(&f, STUDY("\"levels\": [8, 16], \"model\": [\"halfspace\", \"layered\"], "
                           "\"pressures\": {\"values\": [0.1, 0.2]}"));
    double *gaps = contact_tally_values(&f.tally, MEASURE_GAP);
    for (size_t cell = 0; cell < contact_case_cells(&f.one_case); cell++)
        gaps[cell] = 1 + (double)cell;
    f.tally.realisation = 11;
    add_realisation(&f.tally);
    assert_int_equal(f.tally.rows.realisation[0], 11);
    for (size_t m = 0; m < 2; m++)
        for (size_t k = 0; k < 2; k++) {
            assert_true(contact_rows_column(&f.one_case, m, MEASURE_GAP, &column));
            check_close(f.tally.rows.values[column + k],
                        1 + (double)contact_case_cell(&f.one_case, m, 1, k), 0);
            assert_true(contact_rows_column(&f.one_case, m, MEASURE_EDGES, &column));
            assert_true(isnan(f.tally.rows.values[column + k]));
        }
    assert_false(contact_rows_column(&f.one_case, 0, MEASURE_PATCHES, &column));
    fixture_close(&f);
}

/* Rows that do not rise, are not as many as the realisations, or have other values than the sums
 * beside them. */
static void rows_that_cannot_be_are_refused(void **state) {
    (void)state;
    for (int fault = 0; fault < 4; fault++) {
        struct tally_fixture f, copy;
        struct error err = {0};
        unsigned char *data = NULL;
        size_t size = 0;
        fixture_open(&f, FULL_STUDY);
        fixture_open(&copy, FULL_STUDY);
        add_row(&f.tally, 4);
        add_row(&f.tally, fault == 1 ? 4 : 6);
        if (fault == 2)
            f.tally.rows.count--;
        if (fault == 3)
            f.tally.rows.values[0] += 1e-9;
        assert_int_equal(partial_encode(kind_find("contact"), 1, &f.tally, &data, &size, &err), 0);
        assert_int_equal(partial_decode(kind_find("contact"), 1, data, size, &copy.tally, &err),
                         fault == 0 ? 0 : ERROR_INPUT);
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
        cmocka_unit_test(rows_merge_in_any_order),
        cmocka_unit_test(rows_hold_the_values),
        cmocka_unit_test(rows_that_cannot_be_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
