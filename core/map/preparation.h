/* What is done to a height map before it is measured or pressed: steps in one order, each only
 * where it is asked for, and a record of what was done. FORMULAS.md, F18.20 to F18.23.
 *
 *   units     spacing, and units of lengths that the file does not tell; lengths become metres
 *   crop      a rectangle of the points stays
 *   detrend   a polynomial of least squares over the heights that are there is taken out
 *   fill      holes become the smoothest membrane through their rims
 *   filter    S-filter, which keeps long waves, then L-filter, which takes long waves out
 *   resample  other points of the same surface
 *   window    heights about their mean fall to 0 towards the sides
 *
 * What the map is taken as, open or periodic, is decided behind the crop and a trend that was asked
 * for by name, and holds for all later steps; behind a window a map is periodic. Holes stay holes
 * in every step but `fill`; steps that need all heights refuse them. */
#ifndef RUGO_CORE_MAP_PREPARATION_H
#define RUGO_CORE_MAP_PREPARATION_H

#include "core/map/detrend.h"
#include "core/map/height_map.h"
#include "core/map/taper.h"
#include "core/statistics/measured_map.h"
#include "core/statistics/seam.h"

/* A length as somebody wrote it: with a unit ("10um"), or as a plain number. */
struct asked_length {
    double value; /* of one with a unit: in metres */
    bool has_unit;
};

/* auto: periodic where the map is whole and its seam no rougher than the roughest place inside
 * (F18.3), else open. */
enum asked_boundary { ASK_BOUNDARY_AUTO, ASK_BOUNDARY_OPEN, ASK_BOUNDARY_PERIODIC };
/* auto: none of a periodic map, a plane of an open one. */
enum asked_detrend {
    ASK_DETREND_AUTO,
    ASK_DETREND_NONE,
    ASK_DETREND_MEAN,
    ASK_DETREND_PLANE,
    ASK_DETREND_QUADRATIC
};

/* What is asked for; {0}: nothing but the two decisions. Lengths without a unit are in that of the
 * map, those of a crop in points. */
struct preparation {
    struct asked_length dx, dy;  /* spacing in place of that of the file; dx 0: not asked for,
                                    dy 0: changes as dx does */
    double unit, z_unit;         /* metres in one unit of the file's lengths; 0: not asked for */
    struct asked_length crop[4]; /* first x and y, width and height; not asked for where the
                                    width is 0 */
    enum asked_boundary boundary;
    enum asked_detrend detrend;
    bool fill;
    struct asked_length short_waves; /* cut-off wavelength of the S-filter; 0: not asked for */
    struct asked_length long_waves;  /* of the L-filter, likewise */
    bool robust;                     /* both filters */
    size_t resample_x, resample_y;   /* points; 0: not asked for, resample_y 0: by the spacing */
    struct asked_length resample_dx; /* spacing; 0: not asked for */
    enum map_window window;
};

enum { PREPARATION_STEPS_MOST = 16, PREPARATION_TEXT = 160 };

/* What was done, and what was seen on the way. */
struct preparation_record {
    enum boundary boundary;  /* what the map is to be taken as */
    const char *boundary_by; /* "option", "holes", "seam" or "window"; static */
    struct seam seam;        /* when it was decided */
    double holes;            /* share of the points, before any were filled */
    enum detrend detrend;
    struct trend trend;  /* what was taken out */
    double window_power; /* mean square of the window over the points; 1: none */
    size_t count;
    struct preparation_step {
        const char *name; /* "crop", "fill", ...; static; each at most once */
        char text[PREPARATION_TEXT];
    } steps[PREPARATION_STEPS_MOST]; /* in the order in which they were done */
};

/* Adds a step; `name` is static. For what is done to a map elsewhere, too. */
__attribute__((format(printf, 3, 4))) void
preparation_note(struct preparation_record *record, const char *name, const char *format, ...);

/* Prepares the map in place. *record, {0} at first or with steps of before, tells what was done.
 * ERROR_INPUT names the step, its value and what is allowed; the map is then to be cleared alone.
 * Beside the map it takes at most about four times its memory, or for holes about 240 bytes
 * each. */
int preparation_run(struct preparation_record *record, struct height_map *map,
                    const struct preparation *asked, struct error *err);

/* ERROR_INPUT, naming --unit or --z-unit, where the map has a unit of length along one of its axes
 * and none, or another, along z, so that slopes have no meaning. */
int height_map_check_units(const struct height_map *map, struct error *err);

#endif
