/* What a study comes to in physical units, where its parameters give any (jobs/units.h). */
#ifndef RUGO_SERVER_SHOW_SUMMARY_SUMMARY_UNITS_H
#define RUGO_SERVER_SHOW_SUMMARY_SUMMARY_UNITS_H

#include "server/show/table/shown_cases.h"
#include <stdio.h>

/* Prints "lambda_s = 2 um, E* = 231 GPa" in a line, where all cases have the same; nothing without
 * units. */
void print_scales(const struct shown_cases *shown, FILE *file);
/* Prints the same, and a row a case of all scalars that have a unit. */
void print_units(const struct shown_cases *shown, FILE *file);

#endif
