/* What `press` may measure on the face as it stands under load. */
#ifndef RUGO_SERVER_COMMAND_MAP_PRESS_FACE_H
#define RUGO_SERVER_COMMAND_MAP_PRESS_FACE_H

#include "jobs/maps/press/map_press.h"

/* ERROR_INPUT where --areas current or --gap-direction normal, which all blocks have alike, does
 * not go with the models, the kinematics or the friction. */
int press_face_check(const struct press_block *blocks, size_t count, struct error *err);

#endif
