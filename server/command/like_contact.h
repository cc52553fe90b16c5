/* The contact of a measured surface, measured for the studies of surfaces like it. */
#ifndef RUGO_SERVER_COMMAND_LIKE_CONTACT_H
#define RUGO_SERVER_COMMAND_LIKE_CONTACT_H

#include "core/map/height_map.h"
#include <cjson/cJSON.h>

/* Adds to /surface/like of a fitted study what pressing the map gives, in the way and to the loads
 * in which pieces of the surfaces of its first case are pressed. Nothing where the study is not of
 * such a kind, asks for an error, or is at fault, which its reader tells. */
int like_contact_add(cJSON *document, const struct height_map *map, struct error *err);

#endif
