/* How long tests take. `make test` and `make validation` try a third of each table of cases that
 * take long. With RUGO_EFFORT=n, as `make nightly` has it, all of them are tried, with n times as
 * many realisations, which makes standard errors, and with them tolerances, smaller. Tests that
 * draw problems, or let some of many allocations fail, take n times as many. */
#ifndef RUGO_TESTS_SUPPORT_EFFORT_H
#define RUGO_TESTS_SUPPORT_EFFORT_H

#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>

enum { EFFORT_MOST = 100 };

static inline uint64_t effort(void) {
    const char *text = getenv("RUGO_EFFORT");
    long n = text != NULL ? strtol(text, NULL, 10) : 1;
    return n < 1 ? 1 : n > EFFORT_MOST ? EFFORT_MOST : (uint64_t)n;
}

static inline bool every_case(void) {
    return getenv("RUGO_EFFORT") != NULL;
}

/* By how many rows a test goes on in a table of cases that take long. */
static inline size_t case_step(void) {
    return every_case() ? 1 : 3;
}

/* How many of n such realisations or drawn problems are made. */
static inline uint64_t cases_of(uint64_t n) {
    return every_case() ? n * effort() : (n + 2) / 3;
}

#endif
