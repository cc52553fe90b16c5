/* The contact of one measured map with a rigid flat, load by load, by any of the models of contact
 * (jobs/contact/model/model.h), one after the other. Its measures are those of studies, and a few
 * that one solution alone has.
 *
 * Life: {0} -> begin (a map) -> lift (a model) -> load (rising) ... -> lift (the next) ... ->
 * release -> clear. map_press_loads lifts and loads. */
#ifndef RUGO_JOBS_MAPS_MAP_PRESS_H
#define RUGO_JOBS_MAPS_MAP_PRESS_H

#include "core/contact/counted_asperities.h"
#include "core/map/height_map.h"
#include "jobs/contact/case/contact_case.h"
#include "jobs/contact/contact_measure.h"
#include "jobs/contact/contact_steps.h"
#include "jobs/contact/quantity/quantity.h"
#include "schema/result/result.h"

enum press_boundary { PRESS_OPEN, PRESS_MIRRORED, PRESS_PERIODIC };

/* Returns the length of a map as it is pressed, by which heights of blocks are given, as those of
 * studies by the longer side of the cell. */
static inline double map_press_length(const struct grid *grid) {
    return grid_is_profile(grid) ? grid->lx : fmax(grid->lx, grid->ly);
}

struct press_block {
    const struct contact_model *model;
    double poisson;
    double lengths;         /* height of the block over map_press_length; 0: the model's */
    double tolerance;       /* of a solution, as in studies; 0: the model's */
    double hardness;        /* over E*; 0: it is elastic */
    double friction, angle; /* coefficient, 0: none; of the tangential load from x, radians */
    struct coating coating; /* thickness in the map's length */
    /* Of elements: where the gap is taken, the law of strains, and the depth from which columns
     * widen, in their widths, as in studies; 0: the usual one. */
    enum gap_weighting weighting;
    enum kinematics kinematics;
    double transition;
    /* With friction, where a model has it at finite strain: where the flat is, over the RMS height,
     * at so many points, so many to each turn, all of it at the last load. Borrowed; NULL: nothing
     * slides, and friction is that of lighter loads. */
    double *slide;
    size_t slide_count, slide_steps;
    bool conducts, leaks;   /* these quantities are asked for */
    bool coupled, pressing; /* slip is solved with tractions and pressures coupled; friction acts
                               while pressing */
    bool two_faces;         /* the map is the sum of two (map_counter.h) */
    bool current_areas, normal_gaps; /* as of struct contact_case */
};

/* Values of a load have the numbers of the measures of studies and of the model's own; these
 * follow. Lengths are over the RMS height h, pressures over E* h', areas over the map's. */
enum press_value {
    PRESS_LOAD = MEASURE_COUNT,
    PRESS_PEAK,
    PRESS_APPROACH,
    PRESS_CONTACT_NODES,
    PRESS_VIOLATION,
    PRESS_BGT_COUNTED, /* areas by theories of counted summits (counted_asperities.h) */
    PRESS_GW_COUNTED,
    PRESS_VALUES
};
/* Returns what a value is, but for the model's own: its curve, its unit and how it errs. */
const struct measure *press_measure(size_t value);

/* A column of tables and of JSON documents. */
struct press_column {
    const char *heading; /* in tables for people */
    const char *key;     /* in JSON */
    size_t value;
    bool fold;      /* tables for people may start a line here */
    bool uncertain; /* its errors stand in tables for people */
};
enum { PRESS_COLUMN_COUNT = 24 };
extern const struct press_column PRESS_COLUMNS[PRESS_COLUMN_COUNT];

/* (reported - true) lies within value +- bound; NaN: not known. */
struct press_error {
    double value, bound;
};
/* One load. */
struct press_row {
    double value[PRESS_VALUES];                            /* NaN: none */
    struct press_error error[ERROR_SOURCES][PRESS_VALUES]; /* map_press_error.h */
};
/* All loads of one model. */
struct press_series {
    struct press_block block;
    double height;       /* of the block, in the map's length */
    double tolerance;    /* of the solutions */
    double full_contact; /* least mean pressure of full contact, E*; NaN: not known */
    struct press_mesh {
        size_t nodes, elements, layers; /* 0: the model has no mesh */
        double slope, quality;          /* as of struct mesh */
    } mesh;
    struct press_row *rows;   /* borrowed: room for all loads */
    struct press_row *slides; /* likewise, for the points of the path; NULL: nothing slides */
    char note[400];           /* why loads, or points of the path, have no values; "": all have */
};

struct map_press;
/* Is called after each load of map_press_loads, which ends where it fails. */
struct press_watch {
    int (*solved)(void *context, const struct map_press *press, size_t load, struct error *err);
    void *context;
};

struct map_press {
    struct grid map;       /* as it was measured */
    struct grid grid;      /* as it is pressed: mirrored 2nx x 2ny */
    double copies;         /* of the map in that */
    double slope, height;  /* RMS, of the map */
    double summit;         /* how far the summit rises above the highest point, by parabolas ... */
    double summit_unknown; /* and by how much that may be off */
    enum press_boundary boundary;
    struct team *team;            /* threads that work along; borrowed; NULL: the caller alone */
    double seconds_most;          /* CPU seconds that each block over the map may take; 0: any */
    double began;                 /* when the block was lifted, CPU seconds of the process */
    double full_contact;          /* as of a series, of the model that was lifted last */
    struct contact_state state;   /* under the last load, on the grid as it is pressed */
    struct contact_case one_case; /* of the one model, as its functions need it */
    struct compliance *compliance;
    struct contact_solver *solver;
    struct area_workspace *areas;
    struct patch_finder *patches;
    struct contact_quantities quantities;
    const struct press_watch *watch;       /* borrowed; NULL: none */
    struct counted_asperities *asperities; /* of the map as it is pressed; NULL: a profile */
};

/* Returns the case of a block over a grid that stands for the map as it is pressed: one load after
 * the other, on one mesh. The map's slopes are known. */
struct contact_case map_press_case(const struct map_press *press, const struct grid *grid,
                                   const struct press_block *block);
/* Returns ERROR_INPUT where the model does not press a map with this boundary. */
int map_press_check(enum press_boundary boundary, const struct contact_model *model,
                    struct error *err);
/* Takes the map, which is mirrored where it is to be; heights are to be whole. ERROR_INPUT for a
 * map without slopes. *press, {0} at first, is cleared by the caller in any case. */
int map_press_begin(struct map_press *press, struct height_map *map, enum press_boundary boundary,
                    struct error *err);
void map_press_clear(struct map_press *press);
/* Puts a block over the map, out of contact, in place of the one before. z: heights as they are
 * pressed. ERROR_INPUT for what the model or the boundary does not allow. */
int map_press_lift(struct map_press *press, const double *z, const struct press_block *block,
                   struct error *err);
/* Frees the solver and the state; what is known of the map stays. */
void map_press_release(struct map_press *press);
/* Presses to a mean pressure in E*. Errors of the row are NaN. */
int map_press_load(struct map_press *press, double pressure, struct press_row *row,
                   struct error *err);
/* Lifts the block of a series and presses it to all loads; then the flat slides, where it is to. On
 * failure the rows from that load on have no values, or the points of the path from there on.
 * ERROR_STOPPED: the CPU seconds were used up. */
int map_press_loads(struct map_press *press, const double *z, size_t loads, const double *pressures,
                    struct press_series *series, struct error *err);

/* What the last load left at the nodes of the map as it was measured, the first of its mirror
 * images. z: heights as they are pressed; load: as it was given; modulus: E* in Pa, pressures are
 * then in Pa, else over E* h'; 0: not known. length: unit of the map's lengths, "" where it has
 * none. *out, {0} at first, is cleared by the caller in any case. */
int map_press_step(const struct map_press *press, const double *z, double load, double modulus,
                   const char *length, struct contact_step *out, struct error *err);

#endif
