/* Comparisons that a NaN does not pass. Include after cmocka's headers. */
#ifndef RUGO_TESTS_SUPPORT_CHECK_H
#define RUGO_TESTS_SUPPORT_CHECK_H

/* cmocka wants these before its own header. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>

#define check_close(value, expected, tolerance)                                                    \
    check_close_at(value, expected, tolerance, #value, __FILE__, __LINE__)
#define check_relative(value, expected, tolerance)                                                 \
    check_close_at(value, expected, (tolerance)*fabs((double)(expected)), #value, __FILE__,        \
                   __LINE__)

static inline void check_close_at(double value, double expected, double tolerance, const char *what,
                                  const char *file, int line) {
    if (!(fabs(value - expected) <= tolerance)) {
        print_error("%s:%d: %s = %.17g, expected %.17g within %.3g\n", file, line, what, value,
                    expected, tolerance);
        _fail(file, line);
    }
}

#endif
