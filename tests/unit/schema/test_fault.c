/* Faults beyond those kept are still counted. */
#include "schema/study/fault.h"
#include "tests/support/check.h"

static void faults_are_counted_beyond_those_kept(void **state) {
    (void)state;
    struct fault_list list = {0};
    for (int i = 0; i < FAULTS_KEPT + 7; i++)
        fault_add(&list, "/a", "fault %d", i);
    assert_int_equal(list.count, FAULTS_KEPT + 7);
    assert_string_equal(list.faults[FAULTS_KEPT - 1].detail, "fault 99");
    fault_list_clear(&list);
    assert_int_equal(list.count, 0);
    assert_null(list.faults);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(faults_are_counted_beyond_those_kept),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
