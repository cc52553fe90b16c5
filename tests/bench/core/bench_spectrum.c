/* The fit of a spectrum: how often its 95 % intervals hold the truth, how wide they are, and its
 * CPU time. 100 sub-maps each; RUGO_EFFORT=n: n times as many. */
#include "tests/support/check.h"
#include "tests/support/effort.h"
#include "tests/support/spectrum_recovery.h"

static const struct recovery_case CASES[] = {
    {"open", 384, 128, 128, 0.2, 20, 4, 384, 0, false, 0, 0},
    {"open", 384, 128, 128, 0.5, 20, 4, 384, 0, false, 0, 0},
    {"open", 384, 128, 128, 0.8, 20, 4, 384, 0, false, 0, 0},
    {"open, no roll-off", 640, 192, 192, 0.8, 640, 6, 640, 0, false, 0, 0},
    {"open, long end", 512, 192, 192, 0.5, 24, 4, 48, 0, false, 0, 0},
    {"open, unlike sides", 512, 96, 224, 0.5, 20, 4, 512, 0, false, 0, 0},
    {"open, 5 % holes", 384, 128, 128, 0.8, 20, 4, 384, 0.05, false, 0, 0},
    {"periodic", 128, 128, 128, 0.2, 16, 4, 64, 0, false, 0, 0},
    {"periodic", 128, 128, 128, 0.5, 16, 4, 64, 0, false, 0, 0},
    {"periodic", 128, 128, 128, 0.8, 16, 4, 64, 0, false, 0, 0},
    {"periodic, fixed amplitudes", 128, 128, 128, 0.8, 16, 4, 64, 0, true, 0, 0},
    {"open profile", 8192, 2048, 1, 0.5, 100, 8, 8192, 0, false, 0, 0},
    {"periodic profile", 2048, 2048, 1, 0.8, 100, 8, 2048, 0, false, 0, 0},
};

int main(void) {
    for (size_t c = 0; c < sizeof CASES / sizeof *CASES; c++) {
        struct recovery recovery;
        recovery_run(&recovery, &CASES[c], 100 * effort());
        recovery_print(&recovery, &CASES[c]);
        fflush(stdout);
    }
    const struct recovery_case large = {"large", 1152, 1024, 1024,  0.8, 128,
                                        4,       1152, 0,    false, 0,   0};
    struct recovery recovery;
    recovery_run(&recovery, &large, 3);
    recovery_print(&recovery, &large);
    return 0;
}
