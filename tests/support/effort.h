/* How long statistical tests take: RUGO_EFFORT=n makes n times as many realisations, which makes
 * their standard errors, and with them their tolerances, smaller. Tests that draw problems, or let
 * some of many allocations fail, take n times as many. `make test` takes 1. */
#ifndef RUGO_TESTS_SUPPORT_EFFORT_H
#define RUGO_TESTS_SUPPORT_EFFORT_H

#include <stdint.h>
#include <stdlib.h>

enum { EFFORT_MOST = 100 };

static inline uint64_t effort(void) {
    const char *text = getenv("RUGO_EFFORT");
    long n = text != NULL ? strtol(text, NULL, 10) : 1;
    return n < 1 ? 1 : n > EFFORT_MOST ? EFFORT_MOST : (uint64_t)n;
}

/* By how many rows a test goes on in a table of cases that take long. Sanitizers, which look for
 * faults of memory and take ten times as long, try each third, and with RUGO_EFFORT each one. */
static inline size_t case_step(void) {
#ifdef RUGO_SANITIZED
    return getenv("RUGO_EFFORT") != NULL ? 1 : 3;
#else
    return 1;
#endif
}

#endif
