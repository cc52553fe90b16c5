/* The contact of one measured map with a rigid flat, load by load, by any of the models of contact
 * (jobs/contact/model/model.h). Its measures are those of studies, and a few that one solution
 * alone has.
 *
 * Life: {0} -> begin (a map) -> load (rising) ... -> release -> clear. */
#ifndef RUGO_JOBS_MAPS_MAP_PRESS_H
#define RUGO_JOBS_MAPS_MAP_PRESS_H

#include "core/map/height_map.h"
#include "jobs/contact/contact_case.h"
#include "jobs/contact/contact_measure.h"
#include "schema/result/result.h"

enum press_boundary { PRESS_OPEN, PRESS_MIRRORED, PRESS_PERIODIC };

struct press_block {
    const struct contact_model *model;
    enum press_boundary boundary;
    double poisson;
    double lengths; /* height of the block in lengths of the map as it is pressed; 0: the model's */
};

/* What is known of one load; lengths over the RMS height h, pressures over E* h', areas over the
 * map's; NaN where the model does not give them. */
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
/* The unit of a value, by which it is taken from one map to another. */
enum press_unit { PRESS_NUMBER, PRESS_SHARE, PRESS_PRESSURE, PRESS_LENGTH };
struct press_column {
    const char *heading;          /* in tables for people */
    const char *key;              /* in JSON */
    const char *y_label;          /* of its curve */
    enum contact_measure measure; /* MEASURE_OWN: none of a study's */
    enum press_unit unit;
    bool uncertain; /* its error by the points is estimated (map_press_error.h) */
};
extern const struct press_column PRESS_COLUMNS[PRESS_VALUES];

/* One load. */
struct press_row {
    double value[PRESS_VALUES];
    double error[PRESS_VALUES];      /* by the points; NaN: not known */
    double measured[MEASURE_OWN];    /* all measures of studies, of the map */
    double own[MODEL_MEASURES_MOST]; /* the model's own measures; NaN: none */
};

struct map_press {
    struct grid map;              /* as it was measured */
    struct grid grid;             /* as it is pressed: mirrored 2nx x 2ny */
    double copies;                /* of the map in that */
    double slope, height;         /* RMS, of the map */
    double full_contact;          /* least mean pressure of full contact, E*; NaN: not known */
    struct contact_state state;   /* under the last load, on the grid as it is pressed */
    struct contact_case one_case; /* of the one model, as its functions need it */
    struct compliance *compliance;
    struct contact_solver *solver;
    struct area_workspace *areas;
    struct patch_finder *patches;
};

/* Takes the map, which is mirrored where it is to be, and lifts it off; heights are to be whole.
 * ERROR_INPUT for a map without slopes, and for what the model or the boundary does not allow.
 * *press, {0} at first, is cleared by the caller in any case. */
int map_press_begin(struct map_press *press, struct height_map *map,
                    const struct press_block *block, struct error *err);
void map_press_clear(struct map_press *press);
/* Frees the solver and the state; what is known of the map stays. */
void map_press_release(struct map_press *press);
/* Presses to a mean pressure in E*. Errors of the row are NaN. */
int map_press_load(struct map_press *press, double pressure, struct press_row *row,
                   struct error *err);

/* Appends a curve for each column, in their order, to *out, {0} at first, which the caller clears
 * in any case: x is the load, and the error of discretisation is a bound. Measures that
 * studies show beside follow, and the model's own curves. ERROR_MEMORY. */
int map_press_result(struct case_result *out, const struct map_press *press, size_t loads,
                     const struct press_row *rows, struct error *err);

#endif
