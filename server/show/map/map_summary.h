/* What `characterise` prints of a map unless it is asked for more: one screen of at most 45 lines.
 */
#ifndef RUGO_SERVER_SHOW_MAP_MAP_SUMMARY_H
#define RUGO_SERVER_SHOW_MAP_MAP_SUMMARY_H

#include "server/show/map/figure/map_figure.h"

/* Prints the file and its preparation, the size, the main parameters rounded to their errors, the
 * verdicts in sentences, and how the rest is printed. Write errors are left to the file's flag. */
void map_summary_print(FILE *file, const struct map_figure *figure);

#endif
