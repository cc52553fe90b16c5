/* Protects: the progress that is shown never falls, but where a next round begins, which is said.
 */
#include "server/show/summary/progress.h"
#include "tests/support/check.h"
#include "tests/support/count_of.h"
#include "tests/support/process.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

/* Draws shares of so many realisations in turn, as lines; returns what was printed, which the
 * caller frees. */
static char *drawn(size_t count, const double shares[][2]) {
    struct progress_bar bar = {.command = "run"};
    int own = dup(STDERR_FILENO);
    assert_true(own >= 0);
    assert_non_null(freopen("progress.out", "w", stderr));
    for (size_t n = 0; n < count; n++)
        progress_draw(&bar, &(struct progress_state){.study = "s",
                                                     .share = shares[n][0],
                                                     .seconds_left = NAN,
                                                     .total = shares[n][1]});
    assert_true(fflush(stderr) == 0 && dup2(own, STDERR_FILENO) >= 0);
    close(own);
    return slurp("progress.out");
}

static void a_share_does_not_fall(void **state) {
    (void)state;
    char *text = drawn(4, (const double[][2]){{0.25, 20}, {0.5, 20}, {0.4, 20}, {0.75, 20}});
    assert_string_equal(text, "rugo run: s 25.0 %, - left\nrugo run: s 50.0 %, - left\n"
                              "rugo run: s 50.0 %, - left\nrugo run: s 75.0 %, - left\n");
    free(text);
}

static void a_next_round_is_said(void **state) {
    (void)state;
    char *text = drawn(4, (const double[][2]){{0.99, 20}, {0.6, 40}, {0.5, 40}, {0.7, 40}});
    assert_string_equal(text, "rugo run: s 99.0 %, - left\nrugo run: s 60.0 %, next round, - left\n"
                              "rugo run: s 60.0 %, next round, - left\n"
                              "rugo run: s 70.0 %, next round, - left\n");
    free(text);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_share_does_not_fall),
        cmocka_unit_test(a_next_round_is_said),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
