/* What was found of a map, in sentences: whether there are errors, whether the law of the spectrum
 * and a law of heights hold, whether the face is stratified, where waves can be trusted, what the
 * instrument left, whether directions and parts differ. */
#ifndef RUGO_SERVER_SHOW_MAP_MAP_VERDICTS_H
#define RUGO_SERVER_SHOW_MAP_MAP_VERDICTS_H

#include "server/show/map/figure/map_figure.h"

enum { VERDICTS_MOST = 18, VERDICT_SIZE = 320 };

/* Writes those that the values allow, and returns their number. */
size_t map_verdicts_list(char out[VERDICTS_MOST][VERDICT_SIZE], const struct map_figure *figure);

#endif
