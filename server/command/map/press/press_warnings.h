/* What `press` warns of before it presses a map. */
#ifndef RUGO_SERVER_COMMAND_MAP_PRESS_WARNINGS_H
#define RUGO_SERVER_COMMAND_MAP_PRESS_WARNINGS_H

#include "core/map/preparation/preparation.h"

/* Names on stderr what the instrument left, noise that governs the slopes, and grooves.
 * ERROR_MEMORY and what the spectrum fails with. */
int press_warn(const char *path, const struct height_map *map,
               const struct preparation_record *record, struct error *err);

#endif
