/* Options of `press` that belong to some of its models. */
#ifndef RUGO_SERVER_COMMAND_MAP_PRESS_FACE_H
#define RUGO_SERVER_COMMAND_MAP_PRESS_FACE_H

#include "jobs/maps/press/map_press.h"

/* ERROR_INPUT where --areas current or --gap-direction normal, which are of the face as it stands
 * under load and which all blocks have alike, does not go with the models, the kinematics or the
 * friction. */
int press_face_check(const struct press_block *blocks, size_t count, struct error *err);
/* ERROR_INPUT where the law of strains, the transition or the weighting of gaps is no usual one and
 * no model has it, and where a direction has no friction. */
int press_options_check(const struct press_block *blocks, size_t count, struct error *err);

#endif
