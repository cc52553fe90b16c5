/* Strict maxima, or minima, of a row against its neighbour rows: the inner loop of every summit
 * search. */
#ifndef RUGO_CORE_STATISTICS_SUMMITS_GRID_SUMMITS_H
#define RUGO_CORE_STATISTICS_SUMMITS_GRID_SUMMITS_H

#include <stdbool.h>
#include <stddef.h>

/* Columns i where middle[i] is above its two neighbours in the row, the points
 * above and below, and with corners the four diagonal ones; the row is periodic, nx >= 2. up and
 * down are both NULL for a profile. Writes at most nx/2 columns, rising, and returns how many. */
size_t row_summits(const double *up, const double *middle, const double *down, size_t nx,
                   bool corners, size_t *columns);
/* Does the same with the columns that are below their neighbours. */
size_t row_pits(const double *up, const double *middle, const double *down, size_t nx, bool corners,
                size_t *columns);
/* Does the same with both, in about the time of either: at most nx columns. */
size_t row_extremes(const double *up, const double *middle, const double *down, size_t nx,
                    bool corners, size_t *columns);

#endif
