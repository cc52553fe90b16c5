/* Protects: a study without a tolerance gets one by its finest mesh, in its parameters, whatever
 * its number of realisations; cases that an older program stored keep theirs. Bounds of the
 * solver's error fall with the tolerance and with the number of nodes. */
#include "jobs/contact/case/contact_case_read.h"
#include "jobs/contact/case/contact_tolerance.h"
#include "jobs/contact/contact_errors.h"
#include "jobs/kind.h"
#include "schema/json/json.h"
#include "schema/study/study_reader.h"
#include "tests/support/check.h"
#include <stdio.h>
#include <string.h>

#define STUDY(realisations, surface, contact)                                                      \
    "{\"name\": \"a\", \"kind\": \"contact\", \"realisations\": " realisations ", \"surface\":"    \
    " {\"dimension\": 1, \"hurst\": 0.8, \"wavelength_ratio\": 4, \"length_ratio\": 2" surface     \
    "}, \"contact\": {\"model\": \"halfspace\"" contact "}}"

static struct study *read(const char *text) {
    struct study *study = NULL;
    struct error err = {0};
    struct fault_list faults = {0};
    if (study_read(&study, text, strlen(text), NULL, JOB_KINDS, 0, &faults, &err) != 0)
        fail_msg("%s: %s", text, err.text);
    fault_list_clear(&faults);
    return study;
}

static double tolerance_of(const struct study *study, size_t c) {
    return json_number_at(study->cases[c].parameters, "/contact/tolerance", (double)NAN);
}

static void meshes_choose(void **state) {
    (void)state;
    static const struct {
        double points;
        size_t levels;
        double tolerance;
    } CASES[] = {{8, 1, 1e-4},    {2, 1, 1e-4},   {4, 3, 1e-4},       {16, 1, 2.5e-5},
                 {16, 2, 2.5e-5}, {8, 3, 2.5e-5}, {32, 4, 1.5625e-6}, {1e4, 1, 1e-8}};
    for (size_t c = 0; c < sizeof CASES / sizeof *CASES; c++)
        check_relative(contact_tolerance(CASES[c].points, CASES[c].levels), CASES[c].tolerance,
                       1e-12);
}

static void studies_hold_it(void **state) {
    (void)state;
    static const struct {
        const char *study;
        double tolerance[2];
    } CASES[] = {
        {STUDY("3", "", ""), {1e-4}},
        {STUDY("3", ", \"points_per_wavelength\": [8, 16]", ""), {1e-4, 2.5e-5}},
        {STUDY("3", ", \"points_per_wavelength\": 16", ", \"levels\": [4, 8]"), {1e-4}},
        {STUDY("3", "", ", \"levels\": [4, 8, 16]"), {6.25e-6}},
        {STUDY("3", "", ", \"levels\": [4, 8, 16], \"tolerance\": 1e-3"), {1e-3}},
        {STUDY("3", "", ", \"tolerance\": [1e-8, 1e-5]"), {1e-8, 1e-5}},
    };
    for (size_t s = 0; s < sizeof CASES / sizeof *CASES; s++) {
        struct study *study = read(CASES[s].study);
        for (size_t c = 0; c < study->case_count; c++) {
            check_relative(tolerance_of(study, c), CASES[s].tolerance[c], 1e-12);
            check_relative(study->cases[c].cost.tolerance, CASES[s].tolerance[c], 1e-12);
        }
        study_destroy(&study);
    }
}

/* Otherwise a study with more realisations would not continue one with fewer. */
static void realisations_do_not_matter(void **state) {
    (void)state;
    struct study *few = read(STUDY("1", "", "")), *many = read(STUDY("1000000", "", ""));
    assert_true(cJSON_Compare(few->cases[0].parameters, many->cases[0].parameters, true));
    study_destroy(&few);
    study_destroy(&many);
}

/* A case that an older program stored has the default of its time, written out or not. */
static void stored_cases_keep_theirs(void **state) {
    (void)state;
    struct study *study = read(STUDY("3", "", ""));
    cJSON *stored = cJSON_Duplicate(study->cases[0].parameters, true);
    cJSON *contact = cJSON_GetObjectItem(stored, "contact");
    const struct job_kind *kind = kind_find("contact");
    uint64_t with, without, now;
    struct contact_case one_case;
    assert_int_equal(kind_fingerprint(kind, stored, &now, NULL), 0);
    cJSON_SetNumberValue(cJSON_GetObjectItem(contact, "tolerance"), 1e-8);
    assert_int_equal(kind_fingerprint(kind, stored, &with, NULL), 0);
    cJSON_DeleteItemFromObject(contact, "tolerance");
    assert_int_equal(kind_fingerprint(kind, stored, &without, NULL), 0);
    assert_true(with == without && with != now);
    assert_int_equal(contact_case_read(&one_case, stored, 0, NULL, NULL), 0);
    check_relative(one_case.tolerance, 1e-8, 1e-12);
    contact_case_clear(&one_case);
    cJSON_Delete(stored);
    study_destroy(&study);
}

static double bound_of(enum measure_solver solver, double tolerance, double nodes, double open,
                       double value) {
    const struct solver_counts of = {tolerance, nodes, open, nodes / 10};
    return contact_errors_solver(solver, &of, value);
}

/* Bounds fall with the tolerance and with the number of nodes, down to a part of the tolerance. One
 * node of some that are counted is always within. */
static void bounds_fall(void **state) {
    (void)state;
    for (enum measure_solver solver = SOLVER_SMOOTH; solver <= SOLVER_PATCHES; solver++) {
        double before = INFINITY;
        for (double nodes = 10; nodes < 1e9; nodes *= 10) {
            double bound = bound_of(solver, 1e-4, nodes, nodes, 1);
            assert_true(bound <= before && bound <= 0.1);
            assert_true(bound >= bound_of(solver, 1e-5, nodes, nodes, 1));
            check_relative(bound_of(solver, 1e-4, nodes, 10 * nodes, -2), 2 * bound, 1e-12);
            before = bound;
        }
        assert_true(before < (solver == SOLVER_FLOW ? 0.01 : 0.005) && before > 1e-4);
        check_relative(bound_of(solver, 1e-6, 0, 0, 1), 1e-3, 1e-12);
        assert_true(isnan(bound_of(solver, 1e-4, 1000, 1000, (double)NAN)));
    }
    assert_true(bound_of(SOLVER_COUNTED, 1e-4, 1000, 1000, 1) > 1.0 / 1000);
    assert_true(bound_of(SOLVER_SMOOTH, 1e-4, 1e6, 1e6, 1) < 0.002);
    check_relative(bound_of(SOLVER_BINNED, 1e-4, 1e6, 1e6, 1), 0.1, 1e-12);
    check_relative(bound_of(SOLVER_FLOW, 1e-4, 1e6, 1e6, 1),
                   15 * bound_of(SOLVER_COUNTED, 1e-4, 1e6, 1e6, 1), 1e-12);
}

/* Near full contact few nodes are open. They decide the stiffness, and gaps are closed within a
 * length, not within a share. */
static void open_nodes_decide_near_full_contact(void **state) {
    (void)state;
    double half = bound_of(SOLVER_STIFFNESS, 1e-4, 1000, 1000, 1);
    check_relative(bound_of(SOLVER_STIFFNESS, 1e-4, 1000, 10, 1), 100 * half, 1e-12);
    check_relative(bound_of(SOLVER_STIFFNESS, 1e-4, 1000, 0, 1), 1000 * half, 1e-12);
    check_relative(bound_of(SOLVER_COUNTED, 1e-4, 1000, 10, 1), half, 1e-12);
    double gap = bound_of(SOLVER_GAP, 1e-4, 1000, 10, 1e-6);
    assert_true(gap > 3e-6 && gap < 4e-6);
    check_relative(bound_of(SOLVER_GAP, 1e-4, 1000, 10, 0), gap, 1e-12);
    check_relative(bound_of(SOLVER_GAP, 1e-4, 1000, 9000, 2),
                   bound_of(SOLVER_SMOOTH, 1e-4, 1000, 9000, 2), 1e-12);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(meshes_choose),
        cmocka_unit_test(studies_hold_it),
        cmocka_unit_test(realisations_do_not_matter),
        cmocka_unit_test(stored_cases_keep_theirs),
        cmocka_unit_test(bounds_fall),
        cmocka_unit_test(open_nodes_decide_near_full_contact),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
