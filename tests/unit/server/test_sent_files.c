/* Protects: files that the service hands on one behind the other arrive as they were, whatever
 * bytes they have; the study behind them is found; and sizes that are not those of the files are
 * refused by what is wrong with them. */
#include "server/command/map/sent_files.h"
#include "tests/support/check.h"
#include <stdlib.h>
#include <string.h>

static const char TEXT[] = "a\0b1,2\n3,4\n{\"kind\": 1}";
static const char *const NAMES[] = {"a b.csv", "empty.x3p", "-q", NULL};

static int take(struct sent_files *files, const char *sizes, const char *const *names,
                struct error *err) {
    char *own = malloc(sizeof TEXT - 1); /* no byte more, for sanitizers to see */
    assert_non_null(own);
    memcpy(own, TEXT, sizeof TEXT - 1);
    return sent_files_take(files, own, sizeof TEXT - 1, sizes, names, err);
}

static void files_are_as_they_were(void **state) {
    (void)state;
    static const struct {
        const char *bytes;
        size_t size;
    } FILES[] = {{"a\0b", 3}, {"", 0}, {"1,2\n3,4\n", 8}};
    struct sent_files files = {0};
    struct error err = {0};
    char *text = NULL;
    size_t size;
    assert_int_equal(take(&files, "3,0,8", NAMES, &err), 0);
    for (size_t f = 0; f < sizeof FILES / sizeof *FILES; f++) {
        assert_int_equal(sent_files_read(&files, NAMES[f], &text, &size, &err), 0);
        assert_int_equal(size, FILES[f].size);
        assert_memory_equal(text, FILES[f].bytes, size + 1);
        free(text);
    }
    assert_int_equal(sent_files_study(&files, &text, &size, &err), 0);
    assert_string_equal(text, "{\"kind\": 1}");
    free(text);
    assert_int_equal(sent_files_read(&files, "/etc/passwd", &text, &size, &err), ERROR_INPUT);
    assert_string_equal(err.text, "/etc/passwd: no file of this name was sent");
    sent_files_clear(&files);
}

static void no_study_is_empty(void **state) {
    (void)state;
    struct sent_files files = {0};
    struct error err = {0};
    char *text = NULL;
    size_t size;
    assert_int_equal(take(&files, "22", (const char *const[]){"all", NULL}, &err), 0);
    assert_int_equal(sent_files_study(&files, &text, &size, &err), 0);
    assert_int_equal(size, 0);
    free(text);
    sent_files_clear(&files);
}

static void wrong_sizes_are_named(void **state) {
    (void)state;
    static const struct {
        const char *sizes, *words;
    } FAULTS[] = {
        {"", "not "},
        {"3,0", "such as 120,77"},
        {"3,0,8,2", "a size for each"},
        {"3,-1,8", "not -1,8"},
        {"3,x,8", "not x,8"},
        {"3,0,20", "20 bytes of a file"},
        {"3,0,8 ", "not 8 "},
        {"99999999999999999999,0,1", "standard input has 22 left"},
    };
    for (size_t f = 0; f < sizeof FAULTS / sizeof *FAULTS; f++) {
        struct sent_files files = {0};
        struct error err = {0};
        assert_int_equal(take(&files, FAULTS[f].sizes, NAMES, &err), ERROR_INPUT);
        if (strstr(err.text, FAULTS[f].words) == NULL)
            fail_msg("no \"%s\" in \"%s\"", FAULTS[f].words, err.text);
        sent_files_clear(&files);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(files_are_as_they_were),
        cmocka_unit_test(no_study_is_empty),
        cmocka_unit_test(wrong_sizes_are_named),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
