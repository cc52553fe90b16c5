/* Protects: several files that are sent as a form arrive as they were, whatever bytes they have and
 * whatever stands around them; the study is found; and a form that is cut, forged or changed
 * anywhere is refused by what is wrong with it, or read, without a step beyond its bytes. */
#include "server/command/map/form.h"
#include "tests/support/check.h"
#include <stdlib.h>
#include <string.h>

#define PART(said, bytes) "--b0\r\nContent-Disposition: form-data; " said "\r\n\r\n" bytes "\r\n"
#define END "--b0--\r\n"
#define MAP "name=\"map\"; filename="

static int take(struct form *form, const char *text, size_t size, struct error *err) {
    char *own = malloc(size + 1); /* no byte more, for sanitizers to see */
    assert_non_null(own);
    memcpy(own, text, size);
    own[size] = '\0';
    return form_take(form, own, size, "b0", err);
}

static void check_file(const struct form *form, const char *name, const char *bytes, size_t size) {
    struct error err = {0};
    char *text = NULL;
    size_t found = 0;
    if (form_read(form, name, &text, &found, &err) != 0)
        fail_msg("%s", err.text);
    assert_int_equal(found, size);
    assert_memory_equal(text, bytes, size);
    assert_int_equal(text[size], 0);
    free(text);
}

static void files_are_as_they_were(void **state) {
    (void)state;
    static const char BYTES[] = "a\0b\r\n--b\r\n\r\n--b1\r\n";
    static const char TEXT[] = "words before\r\n" PART(MAP "\"a b.csv\"", "1,2\n3,4\n")
        PART(MAP "\"\\\"q\\\\.npy\"\r\nContent-Type: application/octet-stream",
             "a\0b\r\n--b\r\n\r\n--b1\r\n") PART("filename=\"empty.x3p\"; name=\"any\"", "")
            PART("name=\"study\"", "{\"kind\": 1}") END "words behind";
    struct form form = {0};
    struct error err = {0};
    char *text = NULL;
    size_t size;
    assert_int_equal(take(&form, TEXT, sizeof TEXT - 1, &err), 0);
    assert_int_equal(form.count, 3);
    check_file(&form, "a b.csv", "1,2\n3,4\n", 8);
    check_file(&form, "\"q\\.npy", BYTES, sizeof BYTES - 1);
    check_file(&form, "empty.x3p", "", 0);
    assert_string_equal(form.study.data, "{\"kind\": 1}");
    assert_int_equal(form_read(&form, "/etc/passwd", &text, &size, &err), ERROR_INPUT);
    assert_string_equal(err.text, "/etc/passwd: no file of this name was sent");
    form_clear(&form);
}

static void what_is_wrong_is_named(void **state) {
    (void)state;
    static const struct {
        const char *text, *words;
    } FAULTS[] = {
        {"", "no boundary --b0"},
        {"--b1\r\n", "no boundary --b0"},
        {END, "a form without files"},
        {PART("name=\"study\"", "{}") END, "a form without files"},
        {PART("name=\"map\"", "1") END, "part 1 of the form: neither a file nor"},
        {PART(MAP "\"a\"", "1") PART("name=\"x\"", "1") END, "part 2 of the form: neither"},
        {PART(MAP "\"\"", "1") END, "part 1 of the form: a file has a name"},
        {PART(MAP "\"a", "1") END, "neither a file"},
        {PART(MAP "\"a\"", "1") PART(MAP "\"a\"", "2") END, "two files named a"},
        {PART("name=\"study\"", "1") PART("name=\"study\"", "2") END, "a second study"},
        {PART(MAP "\"a\"", "1"), "part 1 of the form: the boundary is missing"},
        {"--b0\r\nContent-Disposition: form-data", "it ends within its headers"},
    };
    for (size_t f = 0; f < sizeof FAULTS / sizeof *FAULTS; f++) {
        struct form form = {0};
        struct error err = {0};
        assert_int_equal(take(&form, FAULTS[f].text, strlen(FAULTS[f].text), &err), ERROR_INPUT);
        if (strstr(err.text, FAULTS[f].words) == NULL)
            fail_msg("no \"%s\" in \"%s\"", FAULTS[f].words, err.text);
        form_clear(&form);
    }
}

/* Cut after each byte, and each byte changed to those that a form is made of. */
static void no_form_harms(void **state) {
    (void)state;
    static const char TEXT[] = PART(MAP "\"a\\\"\"", "1") PART("name=\"study\"", "{}") END;
    static const char OTHERS[] = "\r\n-\"\\;=b\0";
    const size_t size = sizeof TEXT - 1;
    char text[sizeof TEXT];
    for (size_t at = 0; at < size; at++)
        for (size_t other = 0; other < sizeof OTHERS; other++) {
            struct form form = {0};
            struct error err = {0};
            memcpy(text, TEXT, sizeof text);
            text[at] = OTHERS[other];
            if (take(&form, text, size, &err) != 0)
                assert_int_equal(err.code, ERROR_INPUT);
            form_clear(&form);
            (void)take(&form, TEXT, at, &err);
            form_clear(&form);
        }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(files_are_as_they_were),
        cmocka_unit_test(what_is_wrong_is_named),
        cmocka_unit_test(no_form_harms),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
