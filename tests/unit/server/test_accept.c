/* Protects: a peer gets the form that it likes best, not one whose name its header happens to hold.
 */
#include "server/http/accept.h"
#include "server/http/compress.h"
#include "tests/support/check.h"

static void the_closest_range_says_how_much_a_type_is_liked(void **state) {
    (void)state;
    static const struct {
        const char *accept;
        double csv, json;
    } ASKED[] = {
        {NULL, 1, 1},
        {"", 0, 0},
        {"*/*", 1, 1},
        {"text/csv", 1, 0},
        {"TEXT/CSV", 1, 0},
        {"text/*;q=0.5", 0.5, 0},
        {"text/csv-schema", 0, 0},
        {"text/csv;q=0, application/json", 0, 1},
        {"application/json,text/csv;q=0.25", 0.25, 1},
        {"*/*;q=0.1, text/csv ; header=present ; q=0.75", 0.75, 0.1},
        {"text/*;q=0.5, text/csv;q=0.75, */*;q=0.25", 0.75, 0.25},
        {"text/html, image/png", 0, 0},
        {",, ;q=1,text/", 0, 0},
        {"text/csv;", 1, 0},
        {"text/csv;q", 1, 0},
    };
    for (size_t a = 0; a < sizeof ASKED / sizeof *ASKED; a++) {
        assert_true(accept_quality(ASKED[a].accept, "text/csv") == ASKED[a].csv);
        assert_true(accept_quality(ASKED[a].accept, "application/json") == ASKED[a].json);
    }
}

static void a_coding_is_taken_where_it_is_named(void **state) {
    (void)state;
    assert_false(compress_is_accepted(NULL));
    assert_false(compress_is_accepted(""));
    assert_false(compress_is_accepted("br, deflate"));
    assert_false(compress_is_accepted("gzip;q=0, *"));
    assert_false(compress_is_accepted("gzipped"));
    assert_true(compress_is_accepted("deflate, gzip, br"));
    assert_true(compress_is_accepted("gzip;q=0.1"));
    assert_true(compress_is_accepted("*"));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_closest_range_says_how_much_a_type_is_liked),
        cmocka_unit_test(a_coding_is_taken_where_it_is_named),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
