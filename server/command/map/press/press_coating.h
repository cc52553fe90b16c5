/* The coating that `press` is asked for. */
#ifndef RUGO_SERVER_COMMAND_MAP_PRESS_COATING_H
#define RUGO_SERVER_COMMAND_MAP_PRESS_COATING_H

#include "core/contact/block.h"
#include "core/map/height_map.h"
#include "server/command/map/press/press_loads.h"

/* Reads "THICKNESS,MODULUS[,POISSON]"; NULL: no coating. The thickness has a unit where the map's
 * lengths have one, and is then in it. The modulus is Young's over that of the block, or a pressure
 * where --modulus gives the block's. Without a ratio of Poisson the block's is taken. ERROR_INPUT
 * names the option, its value and what is allowed. */
int press_coating_parse(struct coating *out, const char *text, const struct press_words *words,
                        const struct height_map *map, struct error *err);

#endif
