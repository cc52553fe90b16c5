/* Protects: the 95 % intervals of the law that fits a spectrum hold the truth as often as they say,
 * for sub-maps of larger surfaces and for periodic ones, with H = 0.2, 0.5 and 0.8. They are those
 * of H, roll-off, amplitude, both ends where they are inside, RMS height and slope. 20 patches
 * each; from RUGO_EFFORT 3 on 100, of which 90 at least must hold the truth. With fixed amplitudes,
 * as a control, nearly all errors are far smaller than reported. tests/bench/core/bench_spectrum.c
 * prints widths and times. */
#include "tests/support/check.h"

#include "tests/support/effort.h"
#include "tests/support/spectrum_recovery.h"

static const struct recovery_case CASES[] = {
    {"open", 384, 128, 128, 0.2, 20, 4, 384, 0, false, 0, 0},
    {"open", 384, 128, 128, 0.5, 20, 4, 384, 0, false, 0, 0},
    {"open", 384, 128, 128, 0.8, 20, 4, 384, 0, false, 0, 0},
    {"open, no roll-off", 448, 128, 128, 0.8, 448, 5, 448, 0, false, 0, 0},
    {"open, no sharp end", 384, 128, 128, 0.5, 20, 2, 384, 0, false, 0, 0},
    {"open, long end", 512, 192, 192, 0.5, 24, 4, 48, 0, false, 0, 0},
    {"open, unlike sides", 512, 96, 224, 0.5, 20, 4, 512, 0, false, 0, 0},
    {"open, 5 % holes", 384, 128, 128, 0.8, 20, 4, 384, 0.05, false, 0, 0},
    {"open, lay", 384, 128, 128, 0.7, 20, 4, 384, 0, false, 1.5, 45},
    {"open, lay", 384, 128, 128, 0.7, 20, 4, 384, 0, false, 2, 20},
    {"open, lay", 384, 128, 128, 0.7, 20, 4, 384, 0, false, 3, 0},
    {"periodic", 128, 128, 128, 0.2, 16, 4, 64, 0, false, 0, 0},
    {"periodic", 128, 128, 128, 0.5, 16, 4, 64, 0, false, 0, 0},
    {"periodic", 128, 128, 128, 0.8, 16, 4, 64, 0, false, 0, 0},
};

/* The fewest of n that hold the truth: fewer do so once in 90 times, of 20 once in 400. */
static size_t fewest(size_t n) {
    return n >= 100 ? n * 90 / 100 : n * 80 / 100;
}

static void recovery(void **state) {
    (void)state;
    size_t patches = effort() < 3 ? 20 : 100, all = 0, counted = 0;
    bool well = true;
    for (size_t c = 0; c < sizeof CASES / sizeof *CASES; c += case_step()) {
        struct recovery found;
        recovery_run(&found, &CASES[c], patches);
        bool here = true;
        for (size_t a = 0; a < RECOVERED; a++) {
            here = here && found.of[a].inside >= fewest(patches);
            if (a == RECOVERED_HURST || a == RECOVERED_ROLLOFF || a == RECOVERED_AMPLITUDE) {
                all += found.of[a].inside;
                counted += patches;
            }
        }
        /* the end is seen beside a lay, too, whose error blurs it */
        if (CASES[c].lay_ratio > 0)
            here = here && found.of[RECOVERED_SHORT].seen >= fewest(patches);
        if (!here)
            recovery_print(&found, &CASES[c]);
        well = well && here;
    }
    printf("H, roll-off, amplitude: %zu of %zu inside\n", all, counted);
    assert_true(well);
    /* nor do they hold it much more often: the intervals are as narrow as they can be */
    check_close((double)all / (double)counted, 0.955, every_case() ? 0.025 : 0.04);
}

static void fixed_amplitudes(void **state) {
    (void)state;
    const struct recovery_case fixed = {"fixed", 128, 128, 128, 0.8, 16, 4, 64, 0, true, 0, 0};
    struct recovery found;
    recovery_run(&found, &fixed, 4);
    assert_true(found.of[RECOVERED_HURST].error < 5e-3);
    assert_true(found.of[RECOVERED_HURST].width > 0.1);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(recovery),
        cmocka_unit_test(fixed_amplitudes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
