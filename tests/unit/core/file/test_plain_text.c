/* Protects: a text from outside has nothing that a terminal obeys or that makes XML malformed, and
 * keeps every character that people write. */
#include "core/file/plain_text.h"
#include "tests/support/check.h"
#include "tests/support/seed.h"
#include <string.h>

static void people_keep_their_letters(void **state) {
    (void)state;
    static const char *const KEPT[] = {"",         "weibull C = 1.5 <&>", "Rauheit über 10 µm",
                                       "表面粗さ", "\xf0\x9f\x8c\x8a",    "l\xc2\xa0m"};
    for (size_t k = 0; k < sizeof KEPT / sizeof *KEPT; k++) {
        char text[64];
        snprintf(text, sizeof text, "%s", KEPT[k]);
        assert_string_equal(text_make_plain(text), KEPT[k]);
    }
    assert_null(text_make_plain(NULL));
}

static void what_is_obeyed_is_replaced(void **state) {
    (void)state;
    static const char *const TEXTS[][2] = {
        {"a\033[31mb", "a?[31mb"},
        {"a\nb\tc\rd", "a?b?c?d"},
        {"\x7f\x01", "??"},
        {"\xc2\x9b"
         "2J",
         "??2J"},
        {"\xef\xbf\xbe", "???"},
        {"\xff\xc3", "??"},
        {"\xed\xa0\x80", "???"},
        {"\xc0\x80", "??"},
        {"\xf4\x90\x80\x80", "????"},
    };
    for (size_t t = 0; t < sizeof TEXTS / sizeof *TEXTS; t++) {
        char text[64];
        snprintf(text, sizeof text, "%s", TEXTS[t][0]);
        assert_string_equal(text_make_plain(text), TEXTS[t][1]);
    }
}

/* Byte by byte, as a text of the source must not turn its direction itself. */
static void what_turns_the_direction_is_replaced(void **state) {
    (void)state;
    char text[] = {(char)0xe2, (char)0x80, (char)0xae, 't', 'x', 't', '\0'};
    assert_string_equal(text_make_plain(text), "???txt");
}

static void printing_does_the_same(void **state) {
    (void)state;
    uint64_t random = seed_of_now();
    for (int n = 0; n < 2000; n++) {
        char text[40], printed[80] = "";
        for (size_t a = 0; a + 1 < sizeof text; a++)
            text[a] = (char)(next_word(&random) >> 40);
        text[sizeof text - 1] = '\0';
        FILE *file = fmemopen(printed, sizeof printed, "w");
        assert_non_null(file);
        text_print_plain(file, text);
        assert_int_equal(fclose(file), 0);
        text_make_plain(text);
        assert_string_equal(printed, text);
        for (const char *at = text; *at != '\0'; at += text_shown(at))
            assert_true(text_shown(at) > 0);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(people_keep_their_letters),
        cmocka_unit_test(what_is_obeyed_is_replaced),
        cmocka_unit_test(what_turns_the_direction_is_replaced),
        cmocka_unit_test(printing_does_the_same),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
