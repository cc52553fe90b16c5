/* Protects: a misspelt name finds the one that was meant, and one that is like none finds none. */
#include "schema/near_name.h"
#include "tests/support/check.h"
#include <stdlib.h>

static const char *const NAMES[] = {"hurst", "wavelength_ratio", "length_ratio", "rms_slope"};

static const char *nearest(const char *typed) {
    struct near_name near = {.typed = typed};
    for (size_t n = 0; n < sizeof NAMES / sizeof *NAMES; n++)
        near_name_see(&near, NAMES[n]);
    return near.name;
}

static void what_was_meant_is_found(void **state) {
    (void)state;
    static const char *const TYPED[][2] = {
        {"hurts", "hurst"},           {"H", "hurst"},
        {"Hurst", "hurst"},           {"lenght_ratio", "length_ratio"},
        {"slope", "rms_slope"},       {"wavelengthratio", "wavelength_ratio"},
        {"wave", "wavelength_ratio"}, {"huerstt", "hurst"},
    };
    for (size_t t = 0; t < sizeof TYPED / sizeof *TYPED; t++) {
        const char *found = nearest(TYPED[t][0]);

        assert_non_null(found);
        assert_string_equal(found, TYPED[t][1]);
    }
}

static void what_is_like_none_finds_none(void **state) {
    (void)state;
    char hint[NEAR_HINT_SIZE];
    static const char *const TYPED[] = {"", "x", "ab", "colour",
                                        "zzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzz"};
    for (size_t t = 0; t < sizeof TYPED / sizeof *TYPED; t++)
        assert_null(nearest(TYPED[t]));
    const struct near_name none = {.typed = "x"}, one = {.typed = "hurts", .name = "hurst"};
    assert_string_equal(near_name_hint(&none, hint), "");
    assert_string_equal(near_name_hint(&one, hint), " (did you mean hurst?)");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_was_meant_is_found),
        cmocka_unit_test(what_is_like_none_finds_none),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
