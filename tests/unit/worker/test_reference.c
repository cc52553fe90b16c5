/* Protects: the reference of the study file explains every parameter, and the one in the tree is
 * what the tables say today. */
#include "jobs/kind.h"
#include "schema/study/reference.h"
#include "tests/support/check.h"
#include <stdlib.h>
#include <string.h>

static char *text_of(const char *path, int *status, struct error *err) {
    char *text = NULL;
    size_t size;
    FILE *file = open_memstream(&text, &size);
    assert_non_null(file);
    *status = reference_print(file, JOB_KINDS, path, err);
    assert_int_equal(fclose(file), 0);
    return text;
}

static size_t times(const char *text, const char *part) {
    size_t n = 0;
    for (; (text = strstr(text, part)) != NULL; text++)
        n++;
    return n;
}

static void text_tells_of_all_parameters(void **state) {
    (void)state;
    int status;
    char *text = text_of(NULL, &status, NULL);
    assert_int_equal(status, 0);
    const struct parameter *row;
    size_t rows = 0;
    for (size_t k = 0; JOB_KINDS[k] != NULL; k++)
        for (size_t p = 0; (row = parameter_row(JOB_KINDS[k]->tables, p)) != NULL; p++, rows++) {
            char line[300];
            snprintf(line, sizeof line, "\n  %s\n      %s\n", row->path, row->help);
            if (times(text, line) != 1) /* also of a table that kinds share */
                fail_msg("%s stands there %zu times", row->path, times(text, line));
        }
    assert_true(rows > 40);
    assert_non_null(strstr(text, "\n  /seed\n"));
    assert_non_null(strstr(text, "\"statistics\", \"contact\""));
    free(text);
}

static void a_path_narrows(void **state) {
    (void)state;
    static const char *const PATHS[] = {"/surface/heights", "surface.heights", "surface/heights"};
    struct error err;
    int status;
    for (size_t p = 0; p < 3; p++) {
        char *text = text_of(PATHS[p], &status, &err);
        assert_int_equal(status, 0);
        assert_non_null(strstr(text, "/surface/heights/shape"));
        assert_null(strstr(text, "/surface/hurst"));
        assert_null(strstr(text, "/contact"));
        free(text);
    }
    char *text = text_of("surface.heigths", &status, &err);
    assert_int_equal(status, ERROR_INPUT);
    assert_string_equal(err.text, "a study has no parameter \"surface.heigths\" (did you mean "
                                  "/surface/heights?)");
    assert_string_equal(text, "");
    free(text);
}

static void the_reference_in_the_tree_is_current(void **state) {
    (void)state;
    const char *source = getenv("RUGO_SOURCE");
    if (source == NULL) { /* it is set by tests/run-tests */
        print_message("SKIP: RUGO_SOURCE does not say where the tree is\n");
        skip();
    }
    char path[4096], *wanted = NULL;
    size_t size, length;
    FILE *memory = open_memstream(&wanted, &size);
    assert_non_null(memory);
    assert_int_equal(reference_markdown(memory, JOB_KINDS, NULL), 0);
    assert_int_equal(fclose(memory), 0);
    snprintf(path, sizeof path, "%s/schema/study/REFERENCE.md", source);
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    char *found = calloc(size + 2, 1);
    assert_non_null(found);
    length = fread(found, 1, size + 1, file);
    fclose(file);
    if (length != size || memcmp(found, wanted, size) != 0)
        fail_msg("not what the tables say: rugo help study --format markdown > %s",
                 "schema/study/REFERENCE.md");
    free(found);
    free(wanted);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(text_tells_of_all_parameters),
        cmocka_unit_test(a_path_narrows),
        cmocka_unit_test(the_reference_in_the_tree_is_current),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
