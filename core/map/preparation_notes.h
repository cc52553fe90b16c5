/* What a record of a preparation (preparation.h) says by name. */
#ifndef RUGO_CORE_MAP_PREPARATION_NOTES_H
#define RUGO_CORE_MAP_PREPARATION_NOTES_H

#include "core/map/preparation.h"

/* Returns the text of a note; NULL where there is none. Borrowed. */
const char *preparation_text(const struct preparation_record *record, const char *name);
/* Writes the steps in one line, "crop: ...; detrend: ...": all notes but those of where the map
 * comes from (file, bytes, sha256, format, layer, program). "" where nothing was done. */
void preparation_steps_text(const struct preparation_record *record, char *out, size_t size);
enum { PREPARATION_STEPS_TEXT = PREPARATION_STEPS_MOST * (PREPARATION_TEXT + 24) };

#endif
