/* Small odd height maps in files: as measured, and as no instrument measures them. */
#ifndef RUGO_TESTS_SUPPORT_FUZZ_DRAW_MAP_H
#define RUGO_TESTS_SUPPORT_FUZZ_DRAW_MAP_H

#include "tests/support/fuzz/choices.h"

/* Writes a map, by the ending of the name as npy, csv or xyz, mostly with `unit` of lengths where
 * it is not "" and the format has units. It has at most `side` points a side (profiles twice as
 * many), from a single point on; waves, noise, planes, steps, spikes, heights all alike, at any
 * scale from denormal to 1e308, with holes. */
void draw_map(struct choices *choices, const char *path, const char *unit, size_t side);

#endif
