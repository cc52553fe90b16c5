/* A scalar, or a value of curves at one point, over a parameter: a line for each setting of the
 * others, as curves that plot.h draws. */
#ifndef RUGO_SERVER_SHOW_TABLE_SWEEP_H
#define RUGO_SERVER_SHOW_TABLE_SWEEP_H

#include "server/show/plot/plot.h"
#include "server/show/table/case_table.h"

/* Draws all columns of the table, which are of one name and differ by their models. x: a parameter,
 * "hurst" or "surface/hurst"; NULL: of the numbers that differ, the one of most values. The lines
 * are put into the table's room. ERROR_INPUT for a parameter that no case has as a number (x), a
 * channel that nothing differs in, or where nothing differs; ERROR_ABSENT where no case has a
 * value.
 */
int sweep_draw(struct case_table *table, const char *name, const char *x,
               const struct plot_request *request, FILE *file, struct error *err);

#endif
