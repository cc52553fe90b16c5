/* What an instrument left in a map, in sentences: its size, what it does to slopes, and the option
 * that takes it out. */
#ifndef RUGO_JOBS_MAPS_MAP_ARTEFACT_WORDS_H
#define RUGO_JOBS_MAPS_MAP_ARTEFACT_WORDS_H

#include "core/map/preparation/preparation.h"

enum { ARTEFACT_SENTENCES_MOST = 5, ARTEFACT_SENTENCE_SIZE = 240, ARTEFACT_NAMES_SIZE = 80 };

/* Writes a sentence for each that was found, or, where `counted`, for each that counts in slopes or
 * curvatures (map_artefacts.h); returns their number. z_unit: of heights. */
size_t map_artefact_sentences(char out[ARTEFACT_SENTENCES_MOST][ARTEFACT_SENTENCE_SIZE],
                              const struct map_artefacts *artefacts, const struct grid *grid,
                              const char *z_unit, bool counted);
/* Writes those that count, "height steps, spikes"; "" where there are none. */
void map_artefact_names(char out[ARTEFACT_NAMES_SIZE], const struct map_artefacts *artefacts);

#endif
