/* A measured surface among random ones like it, in plain text. */
#ifndef RUGO_SERVER_SHOW_SUMMARY_LIKE_H
#define RUGO_SERVER_SHOW_SUMMARY_LIKE_H

#include "schema/result/result.h"
#include <stdio.h>

/* Prints what was measured of each quantity, what the pieces of the surfaces have in the mean with
 * their deviation, and the percentile; nothing of a case that is like no measured surface. */
void summary_of_like(const struct case_result *one, FILE *file);

#endif
