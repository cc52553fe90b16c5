/* A locale whose numbers have a comma, as German ones have, in the test's folder. */
#ifndef RUGO_TESTS_SUPPORT_COMMA_LOCALE_H
#define RUGO_TESTS_SUPPORT_COMMA_LOCALE_H

#include "tests/support/process.h"
#include <stdbool.h>
#include <stdlib.h>
#include <unistd.h>

/* Makes the locale "comma", and lets setlocale of this process and of those that it starts find
 * it. Returns false where the system cannot make locales. */
static inline bool comma_locale_make(void) {
    char here[4096];
    spit("comma.src", "LC_NUMERIC\ndecimal_point \",\"\nthousands_sep \".\"\ngrouping 3;3\n"
                      "END LC_NUMERIC\n");
    /* it warns of the categories that the locale leaves out, with status 1 */
    run_shell("localedef -c -i comma.src ./comma");
    return getcwd(here, sizeof here) != NULL && setenv("LOCPATH", here, 1) == 0 &&
           access("comma/LC_NUMERIC", R_OK) == 0;
}

#endif
