/* One realisation of a case as a map: its heights, or the gap or the pressures under a load. */
#ifndef RUGO_JOBS_SURFACE_REALISATION_MAP_H
#define RUGO_JOBS_SURFACE_REALISATION_MAP_H

#include "core/random.h"
#include "jobs/kind.h"

enum map_field { MAP_HEIGHT, MAP_GAP, MAP_PRESSURE, MAP_FIELDS };
extern const char *const MAP_FIELD_NAMES[MAP_FIELDS]; /* "height", "gap", "pressure" */

struct map_order {
    const struct job_kind *kind;
    const cJSON *parameters; /* of the case */
    struct random_key key;   /* of the realisation (core/random.h) */
    enum map_field field;
    double load;        /* p/(E* h'), for gap and pressure */
    double points_most; /* larger maps are refused */
    /* Called repeatedly while heights are iterated and a contact is solved: non-zero stops it with
     * ERROR_STOPPED; may be NULL. */
    int (*stop)(void *context);
    void *stop_context;
};

/* Generates a surface of the case; the caller frees *z, heights on surface->grid, x fastest. */
int realisation_surface(const struct surface_case *surface, struct random_key key, double **z,
                        struct surface_report *report, struct error *err);

/* Fills *out with an array of the points of *grid, x fastest, which the caller frees. Heights and
 * gaps are in the units of the surface, pressures over E* h'. ERROR_INPUT for a map that is too
 * large, a kind without contact, or an invalid load; ERROR_NUMERIC where no surface or contact is
 * found. */
int realisation_map(const struct map_order *order, struct grid *grid, double **out,
                    struct error *err);

#endif
