/* What pressing a map by models with meshes takes, before it begins: printed, and refused where it
 * is too much, with the smaller maps that fit. */
#ifndef RUGO_SERVER_COMMAND_MAP_PRESS_ROOM_H
#define RUGO_SERVER_COMMAND_MAP_PRESS_ROOM_H

#include "jobs/maps/press/map_press_cost.h"
#include <stdio.h>

struct press_room_order {
    const struct map_press *press;    /* begun */
    const struct press_block *blocks; /* one a model */
    size_t model_count;
    struct press_goals goals;
    double seconds_most; /* of CPU time of a model; 0: any */
    bool with_errors;
};
/* ERROR_INPUT where a model with a mesh takes more than this process may use, or longer than it
 * may: names what fits, by --resample or by --crop. */
int press_room_check(const struct press_room_order *order, struct error *err);
/* Prints, for each model with a mesh, the grid, nodes, memory and time; says of others that they
 * take none of it. */
void press_room_print(FILE *file, const struct press_room_order *order);
/* Returns the seconds that a model takes without errors; 0: not known. */
double press_room_seconds(const struct press_room_order *order, size_t m);

#endif
