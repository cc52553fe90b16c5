/* Protects: the gate lets exactly RFC 8259 through, says where and what else is wrong, and numbers
 * come back with the bits they had. */
#include "schema/json/json.h"
#include "tests/support/check.h"
#include <float.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void malformed_texts_are_told_apart(void **state) {
    (void)state;
    static const struct {
        const char *text, *message;
    } BAD[] = {
        {"", "line 1, column 1: the text ends where a value was expected"},
        {"{\"a\":\n 01}", "line 2, column 3: a malformed number"},
        {"[1.]", "a malformed number"},
        {"[.5]", "something that is no JSON value"},
        {"[+1]", "something that is no JSON value"},
        {"[1e]", "a malformed number"},
        {"[0x10]", "a malformed number"},
        {"[1e999]", "a number beyond the range of a double"},
        {"[9007199254740993]", "an integer beyond 2^53"},
        {"[-9007199254740993]", "an integer beyond 2^53"},
        {"[1111111111111111111111111111111111111111111111111111111111111]",
         "more than 60 characters"},
        {"[NaN]", "something that is no JSON value"},
        {"[tru]", "something that is no JSON value"},
        {"[1,]", "something that is no JSON value"},
        {"[1 2]", "a ',' or ']' was expected"},
        {"{\"a\" 1}", "a ':' was expected"},
        {"{a:1}", "a member name was expected"},
        {"{\"a\":1,}", "a member name was expected"},
        {"{\"a\":1 \"b\":2}", "a ',' or '}' was expected"},
        {"{\"a\":1}x", "text behind the end"},
        {"\xef\xbb\xbf\xef\xbb\xbf{}", "something that is no JSON value"},
        {"\xef\xbb\xbf", "line 1, column 1: the text ends where a value was expected"},
        {"\xef\xbb\xbf[\n x]", "line 2, column 2: something that is no JSON value"},
        {"\xff\xfe[", "the text is in UTF-16; JSON is in UTF-8"},
        {"\xfe\xff", "the text is in UTF-16"},
        {"[\"\x01\"]", "a control character"},
        {"[\"\\q\"]", "an unknown escape"},
        {"[\"\\u00g0\"]", "a malformed \\u escape"},
        {"[\"\\ud800\"]", "half of a surrogate pair"},
        {"[\"\\ud800\\u0041\"]", "half of a surrogate pair"},
        {"[\"\\udc00\"]", "a malformed \\u escape"},
        {"[\"\\u0000\"]", "a NUL character"},
        {"[\"abc", "a string without an end"},
        {"[\"\xff\"]", "invalid UTF-8"},
        {"[\"\xc0\xaf\"]", "invalid UTF-8"},         /* overlong */
        {"[\"\xed\xa0\x80\"]", "invalid UTF-8"},     /* surrogate */
        {"[\"\xf4\x90\x80\x80\"]", "invalid UTF-8"}, /* beyond U+10FFFF */
        {"[\"\xe2\x82\"]", "invalid UTF-8"},
        {"{\"a\":1,\"a\":2}", "the name \"a\" is given twice"},
        {"{\"x\":{\"a\":1,\"\\u0061\":2}}", "the name \"a\" is given twice"},
    };
    for (size_t b = 0; b < sizeof BAD / sizeof *BAD; b++) {
        struct error err = {0};
        cJSON *value = NULL;
        int status = json_parse(BAD[b].text, strlen(BAD[b].text), NULL, &value, &err);
        if (status != ERROR_INPUT || !strstr(err.text, BAD[b].message))
            print_error("%s: %d %s\n", BAD[b].text, status, err.text);
        assert_int_equal(status, ERROR_INPUT);
        assert_non_null(strstr(err.text, BAD[b].message));
        assert_null(value);
    }
}

static void well_formed_texts_pass(void **state) {
    (void)state;
    static const char *const GOOD[] = {" [ ] ",
                                       "{}",
                                       "null",
                                       "-0.5e-3",
                                       "\"\\ud83d\\ude00\"",
                                       "[\"\xf0\x9f\x98\x80\"]",
                                       "[9007199254740992]",
                                       "{\"a\":{\"a\":[1,2,{\"b\":true}]}}",
                                       "1e308",
                                       "\xef\xbb\xbf{\"a\":1}"}; /* as Notepad saves it */
    for (size_t g = 0; g < sizeof GOOD / sizeof *GOOD; g++) {
        cJSON *value = NULL;
        assert_int_equal(json_parse(GOOD[g], strlen(GOOD[g]), NULL, &value, NULL), 0);
        assert_non_null(value);
        cJSON_Delete(value);
    }
}

static void bounds_hold(void **state) {
    (void)state;
    struct error err = {0};
    cJSON *value = NULL;
    const struct json_limits tight = {.bytes = 20, .depth = 2, .values = 4};
    assert_int_equal(json_parse("[[[1]]]", 7, &tight, &value, &err), ERROR_INPUT);
    assert_non_null(strstr(err.text, "nesting deeper"));
    assert_int_equal(json_parse("[1,2,3,4]", 9, &tight, &value, &err), ERROR_INPUT);
    assert_non_null(strstr(err.text, "more values"));
    assert_int_equal(json_parse("[1,                  2]", 23, &tight, &value, &err), ERROR_INPUT);
    assert_non_null(strstr(err.text, "23 bytes of JSON; allowed: up to 20"));
    assert_int_equal(json_parse("[1]\0", 4, NULL, &value, &err), ERROR_INPUT); /* NUL is no space */
    /* refused by its size alone: the text behind the pointer is not touched */
    assert_int_equal(json_parse("", (size_t)100 << 20, NULL, &value, &err), ERROR_INPUT);
}

static void numbers_come_back_with_their_bits(void **state) {
    (void)state;
    static const double NUMBERS[] = {0.1,
                                     1.0 / 3,
                                     DBL_MAX,
                                     -DBL_MAX,
                                     DBL_MIN,
                                     5e-324,
                                     0x1p53,
                                     0x1p53 + 2,
                                     0x1p53 - 1,
                                     -0x1.fffffffffffffp52,
                                     123456789012345678.0,
                                     1e23,
                                     6.02214076e23,
                                     0,
                                     3,
                                     -2.5e-7};
    for (size_t n = 0; n < sizeof NUMBERS / sizeof *NUMBERS; n++) {
        cJSON *number = json_number(NUMBERS[n]), *again = NULL;
        char *text = json_print(number);
        assert_non_null(text);
        assert_int_equal(json_parse(text, strlen(text), NULL, &again, NULL), 0);
        assert_true(again->valuedouble == NUMBERS[n]);
        free(text);
        cJSON_Delete(number);
        cJSON_Delete(again);
    }
    const double odd[] = {NAN, INFINITY, -INFINITY};
    cJSON *array = json_numbers(odd, 3);
    char *text = json_print(array);
    assert_string_equal(text, "[null,null,null]");
    free(text);
    cJSON_Delete(array);
}

static void values_are_printed_in_one_way(void **state) {
    (void)state;
    static const struct {
        double number;
        const char *text;
    } NUMBERS[] = {{0, "0"},        {-0.0, "-0"}, {-7, "-7"}, {999999999999999, "999999999999999"},
                   {1e15, "1e+15"}, {0.5, "0.5"}};
    for (size_t n = 0; n < sizeof NUMBERS / sizeof *NUMBERS; n++) {
        cJSON *number = json_number(NUMBERS[n].number);
        char *text = json_print(number);
        assert_string_equal(text, NUMBERS[n].text);
        free(text);
        cJSON_Delete(number);
    }
    static const char *const STRINGS[] = {"",         "a name",       "\"",
                                          "a\\b",     "\x01\n\t\x1f", "\x7f/\'",
                                          "\xc3\xa4", "\xe2\x82\xac", "behind\b"};
    for (size_t n = 0; n < sizeof STRINGS / sizeof *STRINGS; n++) {
        cJSON *string = cJSON_CreateString(STRINGS[n]);
        char *text = json_print(string), *same = cJSON_PrintUnformatted(string);
        assert_string_equal(text, same);
        free(text);
        cJSON_free(same);
        cJSON_Delete(string);
    }
}

static void a_text_for_people_has_a_line_a_value(void **state) {
    (void)state;
    static const char TEXT[] = "{\"a\":[9007199254740992,{}],\"b\":{\"c\":null,\"d\":[]}}";
    cJSON *value = NULL;
    assert_int_equal(json_parse(TEXT, strlen(TEXT), NULL, &value, NULL), 0);
    char *pretty = json_print_pretty(value), *compact = json_print(value);
    assert_string_equal(pretty, "{\n"
                                "  \"a\": [\n"
                                "    9007199254740992,\n"
                                "    {}\n"
                                "  ],\n"
                                "  \"b\": {\n"
                                "    \"c\": null,\n"
                                "    \"d\": []\n"
                                "  }\n"
                                "}\n");
    assert_string_equal(compact, TEXT);
    free(pretty);
    free(compact);
    cJSON_Delete(value);
}

static void pointers_lead_where_they_say(void **state) {
    (void)state;
    const char *text = "{\"a\":[10,{\"b/c\":1,\"d~e\":2}],\"\":3}";
    cJSON *root = NULL;
    assert_int_equal(json_parse(text, strlen(text), NULL, &root, NULL), 0);
    assert_true(json_at(root, "/a/0")->valuedouble == 10);
    assert_true(json_at(root, "/a/1/b~1c")->valuedouble == 1);
    assert_true(json_at(root, "/a/1/d~0e")->valuedouble == 2);
    assert_true(json_at(root, "/")->valuedouble == 3);
    assert_ptr_equal(json_at(root, ""), root);
    assert_null(json_at(root, "/a/2"));
    assert_null(json_at(root, "/a/x"));
    assert_null(json_at(root, "a"));
    cJSON_Delete(root);
}

static void base64_of_every_length(void **state) {
    (void)state;
    unsigned char data[70], *again = NULL;
    for (size_t i = 0; i < sizeof data; i++)
        data[i] = (unsigned char)(i * 37 + 11);
    for (size_t size = 0; size <= sizeof data; size++) {
        char *text = NULL;
        size_t length;
        assert_int_equal(base64_encode(data, size, &text, NULL), 0);
        assert_int_equal(base64_decode(text, &again, &length, NULL), 0);
        assert_int_equal(length, size);
        assert_memory_equal(again, data, size);
        free(text);
        free(again);
    }
    /* RFC 4648, 10 */
    static const char *const KNOWN[] = {"",         "Zg==",     "Zm8=",    "Zm9v",
                                        "Zm9vYg==", "Zm9vYmE=", "Zm9vYmFy"};
    for (size_t size = 0; size < sizeof KNOWN / sizeof *KNOWN; size++) {
        char *text = NULL;
        assert_int_equal(base64_encode((const unsigned char *)"foobar", size, &text, NULL), 0);
        assert_string_equal(text, KNOWN[size]);
        free(text);
    }
    /* White space, padding that is not at the end or too long, and bits behind the last byte. */
    static const char *const BAD[] = {
        "A",         "AA=",      "A===",     "AB==CD==", "AA A",        "AB==",
        "****",      "AA =",     "AA==    ", "AA= =AAA", "AAAAA===",    "AA==AAAA",
        "\nAAAAAAA", "AAAA   A", "====",     "AAAA====", "AA==\n\n\n\n"};
    size_t length;
    for (size_t b = 0; b < sizeof BAD / sizeof *BAD; b++)
        assert_int_equal(base64_decode(BAD[b], &again, &length, NULL), ERROR_INPUT);
}

static void base64_has_64_digits(void **state) {
    (void)state;
    int digits = 0;
    for (int c = 1; c < 256; c++) {
        const char text[] = {'A', 'A', (char)c, 'A', '\0'};
        bool digit = (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') ||
                     c == '+' || c == '/';
        unsigned char *data = NULL;
        size_t size = 0;
        assert_int_equal(base64_decode(text, &data, &size, NULL), digit ? 0 : ERROR_INPUT);
        digits += digit;
        free(data);
    }
    assert_int_equal(digits, 64);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(malformed_texts_are_told_apart),
        cmocka_unit_test(well_formed_texts_pass),
        cmocka_unit_test(bounds_hold),
        cmocka_unit_test(numbers_come_back_with_their_bits),
        cmocka_unit_test(a_text_for_people_has_a_line_a_value),
        cmocka_unit_test(pointers_lead_where_they_say),
        cmocka_unit_test(values_are_printed_in_one_way),
        cmocka_unit_test(base64_of_every_length),
        cmocka_unit_test(base64_has_64_digits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
