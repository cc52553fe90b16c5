/* The contact of one map with a rigid flat, load by load, in one of the models. */
#ifndef RUGO_SERVER_COMMAND_PRESS_SOLVER_H
#define RUGO_SERVER_COMMAND_PRESS_SOLVER_H

#include "core/contact/area.h"
#include "core/contact/patches.h"
#include "core/full/full.h"
#include "core/map/height_map.h"

enum press_model { PRESS_HALFSPACE, PRESS_LAYERED, PRESS_FULL };
enum press_boundary { PRESS_OPEN, PRESS_MIRRORED, PRESS_PERIODIC };

struct press_block {
    enum press_model model;
    enum press_boundary boundary;
    double poisson;
    double lengths; /* height of the block in lengths of the map as it is pressed; 0: infinite, of
                       meshes 1.5 */
};

/* What is known of one load; lengths over the RMS height h, pressures over E* h', areas over the
 * map's; NaN where the model does not tell. */
enum press_value {
    PRESS_LOAD,
    PRESS_EDGES,
    PRESS_NODES,
    PRESS_LOWER,
    PRESS_UPPER,
    PRESS_PERIMETER,
    PRESS_PEAK,
    PRESS_APPROACH,
    PRESS_MEAN_GAP,
    PRESS_STIFFNESS,
    PRESS_PATCHES,
    PRESS_CONTACT_NODES,
    PRESS_ITERATIONS,
    PRESS_VIOLATION,
    PRESS_VALUES
};

struct press {
    struct grid map;  /* as it was measured */
    struct grid grid; /* as it is pressed: mirrored 2nx x 2ny */
    double copies;    /* of the map in that */
    struct compliance *compliance;
    struct contact *contact; /* one of the two */
    struct full *full;
    struct area_workspace *areas;
    struct patch_finder *patches;
    double slope, height;       /* RMS, of the map */
    double full_contact;        /* least mean pressure of full contact, E*; NaN where it is not
                                   known: in free space, and of the model full */
    struct contact_state state; /* under the last load, on the grid as it is pressed */
};

/* Takes the map, which is mirrored where it is to be, and lifts it off; heights are to be whole.
 * ERROR_INPUT for a map without slopes, and for what the model or the boundary does not allow.
 * *press, {0} at first, is the caller's to clear either way. */
int press_begin(struct press *press, struct height_map *map, const struct press_block *block,
                struct error *err);
void press_clear(struct press *press);
/* Frees the solver and the state; what is known of the map stays. */
void press_release(struct press *press);
/* Presses to a mean pressure in E*. */
int press_load(struct press *press, double pressure, double values[PRESS_VALUES],
               struct error *err);

#endif
