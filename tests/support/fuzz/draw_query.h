/* Queries of requests, drawn by the names that a route has. */
#ifndef RUGO_TESTS_SUPPORT_FUZZ_DRAW_QUERY_H
#define RUGO_TESTS_SUPPORT_FUZZ_DRAW_QUERY_H

#include "tests/support/fuzz/served.h"
#include <stdio.h>

struct query_drawing {
    const struct served *served;
    const struct served_study *study; /* of the path; NULL: none */
    const char *const *names;         /* that the route has, NULL behind the last */
    bool odd;                         /* may be what no route takes */
};
/* Prints "?name=value&..." with any of the names, or nothing. Values are what the study has; where
 * it may be odd also any other, and names that are unknown, stand twice, or have no value. */
void draw_query(struct choices *choices, const struct query_drawing *drawing, FILE *file);

#endif
