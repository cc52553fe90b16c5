/* What a model with a mesh takes to press a map, before anything is pressed, and how large a map
 * may be. Estimates are those of studies (core/cost.h): within a factor of about 2, more where the
 * face is steep or nearly all of it touches. */
#ifndef RUGO_JOBS_MAPS_MAP_PRESS_COST_H
#define RUGO_JOBS_MAPS_MAP_PRESS_COST_H

#include "jobs/maps/press/map_press.h"

struct press_cost {
    struct grid pressed;  /* mirrored where the map is */
    double nodes;         /* of the mesh, about; 0: such a block cannot be meshed */
    double bytes;         /* of the process */
    double seconds;       /* of CPU time on a 3 GHz core, of all loads and the path of the flat */
    double error_seconds; /* beside these, of every second point */
};

/* Returns whether a cost is known: the model has a mesh. */
bool press_cost_is_known(const struct contact_model *model);
/* Loads that a map is to be pressed to. */
struct press_goals {
    size_t count;
    double *loads; /* borrowed: rising, in E* h' */
};
/* Estimates what the loads take on so many points of the map as it was measured, with their
 * spacing, in the mean: steep faces jump, and one may take many times as long. press: begun. The
 * model is one whose cost is known. */
struct press_cost press_cost_of(const struct map_press *press, const struct press_block *block,
                                const struct press_goals *goals, size_t nx, size_t ny);

/* What pressing may take; 0: any. */
struct press_room {
    double bytes, seconds;
    bool with_errors; /* the seconds of every second point count */
};
bool press_cost_fits(const struct press_cost *cost, const struct press_room *room);
/* Finds the points along the sides of the largest map of the same shape that fits; false where not
 * even PRESS_SIDE_LEAST along the shorter side do. */
enum { PRESS_SIDE_LEAST = 16 };
bool press_cost_largest(const struct map_press *press, const struct press_block *block,
                        const struct press_goals *goals, const struct press_room *room, size_t *nx,
                        size_t *ny);

#endif
