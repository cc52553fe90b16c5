/* Protects: messages keep what went wrong, whatever is put in front. */
#include "core/error.h"
#include "tests/support/check.h"
#include <stdlib.h>
#include <string.h>

static void keeps_code_and_text(void **state) {
    (void)state;
    struct error err = {0};
    assert_int_equal(error_set(&err, ERROR_INPUT, "hurst = %g", 1.4), ERROR_INPUT);
    assert_int_equal(error_context(&err, "case %d", 3), ERROR_INPUT);
    assert_string_equal(err.text, "case 3: hurst = 1.4");
}

static void takes_no_error(void **state) {
    (void)state;
    assert_int_equal(error_set(NULL, ERROR_MEMORY, "nowhere"), ERROR_MEMORY);
}

/* The cause is worth more than its context: it must survive however much is put in front. */
static void context_gives_way(void **state) {
    (void)state;
    struct error err = {0};
    char longest[600];
    memset(longest, 'x', sizeof longest - 1);
    longest[sizeof longest - 1] = 0;
    error_set(&err, ERROR_SYSTEM, "the cause");
    for (int i = 0; i < 3; i++)
        error_context(&err, "%s", longest);
    assert_true(strlen(err.text) < sizeof err.text);
    assert_non_null(strstr(err.text, "the cause"));
    assert_string_equal(err.text + strlen(err.text) - strlen("the cause"), "the cause");
}

static void array_refuses_overflow(void **state) {
    (void)state;
    assert_null(array_create(SIZE_MAX / 2, 4));
    void *none = array_create(0, 8);
    assert_non_null(none);
    free(none);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(keeps_code_and_text),
        cmocka_unit_test(takes_no_error),
        cmocka_unit_test(context_gives_way),
        cmocka_unit_test(array_refuses_overflow),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
