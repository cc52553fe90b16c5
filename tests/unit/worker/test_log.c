/* Log lines stay one line each, whatever a study is called or a server answers. */
#include "worker/log.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

static void fields_stand_in_order(void **state) {
    (void)state;
    char line[LOG_LINE_MOST];
    struct log_about about = {.worker = "host-1-0", .study = "abc", .job = 4, .attempt = 2};
    size_t length = log_format(line, sizeof line, 1767225600123, LEVEL_INFO, &about, "job done");
    assert_string_equal(line, "time=2026-01-01T00:00:00.123Z level=info worker=host-1-0 study=abc "
                              "job=4 attempt=2 msg=\"job done\"\n");
    assert_int_equal(length, strlen(line));
    struct log_about request = {.request = "GET /v1/studies", .status = 200, .seconds = 0.0025};
    log_format(line, sizeof line, 0, LEVEL_WARNING, &request, "ok");
    assert_string_equal(line, "time=1970-01-01T00:00:00.000Z level=warning request=\"GET "
                              "/v1/studies\" status=200 seconds=0.002500 msg=ok\n");
}

/* A name must not forge a field or a second line. */
static void values_are_escaped(void **state) {
    (void)state;
    char line[LOG_LINE_MOST];
    log_format(line, sizeof line, 0, LEVEL_ERROR, NULL, "a\nlevel=info \"b\" \\ \x1b[31m");
    assert_non_null(strstr(line, "msg=\"a\\nlevel=info \\\"b\\\" \\\\ \\x1b[31m\"\n"));
    assert_ptr_equal(strchr(line, '\n'), line + strlen(line) - 1);
}

static void long_lines_are_cut(void **state) {
    (void)state;
    char line[40], text[400];
    memset(text, 'x', sizeof text - 1);
    text[sizeof text - 1] = '\0';
    size_t length = log_format(line, sizeof line, 0, LEVEL_ERROR, NULL, text);
    assert_int_equal(length, sizeof line - 1);
    assert_int_equal(line[length - 1], '\n');
    assert_int_equal(line[length], '\0');
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fields_stand_in_order),
        cmocka_unit_test(values_are_escaped),
        cmocka_unit_test(long_lines_are_cut),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
