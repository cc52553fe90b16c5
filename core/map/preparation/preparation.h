/* Preparation of a height map before it is measured or pressed: steps in a fixed order, each only
 * where it is requested, and a record of them. FORMULAS.md, F18.20 to F18.23, F18.30 to F18.33.
 *
 *   missing   makes holes of heights that stand for points which were not measured
 *   units     spacing, and units of lengths that the file does not have; lengths become metres
 *   crop      keeps a rectangle of the points
 *   stride    keeps every so manieth column and row, from the first on
 *   lines     subtracts from each scan line its own mean, median or polynomial
 *   despike   makes holes of points that stand out of their neighbourhood
 *   deconvolve  erodes the image by the tip that took it
 *   transpose exchanges x and y
 *   rotate    turns the map, in the largest rectangle inside
 *   detrend   subtracts a polynomial of least squares through the heights that are there
 *   degroove  takes out periodic grooves of machining
 *   fill      fills holes with the smoothest membrane through their rims
 *   denoise   takes out noise by the law of the spectrum
 *   filter    S-filter, which keeps long waves, then L-filter, which removes long waves
 *   resample  other points of the same surface
 *   extend    goes on as the law says, to a periodic map of twice the sides
 *   window    lets heights about their mean fall to 0 towards the sides
 *
 * Whether the map is open or periodic is decided after the crop and a trend that was requested by
 * name, and holds for all later steps; after `extend` or a window a map is periodic. Holes stay
 * holes in every step but `fill` and `extend`; steps that need all heights refuse them. What an
 * instrument leaves along its scan lines, single wrong points and its tip comes first, while rows
 * are as they were scanned: spikes are found beside lines without offsets, and a tip meets no
 * spikes. The map is turned next, so that trend, boundary and all later steps are those of the
 * rectangle that is measured. */
#ifndef RUGO_CORE_MAP_PREPARATION_H
#define RUGO_CORE_MAP_PREPARATION_H

#include "core/map/artefacts/map_artefacts.h"
#include "core/map/height_map.h"
#include "core/map/preparation/detrend.h"
#include "core/map/preparation/missing.h"
#include "core/map/preparation/scan_lines.h"
#include "core/statistics/measured_map.h"
#include "core/statistics/uncertainty/seam.h"
#include "core/surface/grid.h"
#include <stdint.h>

/* Lets the heights of a map fall to one height towards its sides, so that it is periodic
 * (FORMULAS.md, F18.23). */

enum map_window { MAP_WINDOW_NONE, MAP_WINDOW_HANN, MAP_WINDOW_TUKEY };

/* Replaces z, which has no holes, by w (z - <w z>/<w>), where w is 1 in the middle. Returns the
 * mean square of w over the points. */
double map_taper(const struct grid *grid, double *z, enum map_window window);

/* A length as entered: with a unit ("10um"), or as a plain number. */
struct asked_length {
    double value; /* of one with a unit: in metres */
    bool has_unit;
};

/* auto: periodic where the map is whole and its seam no rougher than the roughest part inside
 * (F18.3), else open; of a file that was converted from an instrument's format, open. */
enum asked_boundary { ASK_BOUNDARY_AUTO, ASK_BOUNDARY_OPEN, ASK_BOUNDARY_PERIODIC };
/* auto: none of a periodic map, a plane of an open one. */
enum asked_detrend {
    ASK_DETREND_AUTO,
    ASK_DETREND_NONE,
    ASK_DETREND_MEAN,
    ASK_DETREND_PLANE,
    ASK_DETREND_QUADRATIC
};

/* The requested steps; {0}: none but the two decisions, and marks of points that were not measured
 * are refused. Lengths without a unit are in that of the
 * map, those of a crop in points. */
struct preparation {
    struct missing_marks missing;
    struct asked_length dx, dy; /* spacing in place of that of the file; dx 0: not requested, dy 0:
                                   changes as dx does */
    double unit, z_unit;        /* metres in one unit of the file's lengths; 0: not requested */
    struct asked_length
        crop[4]; /* first x and y, width and height; not requested where the width is 0 */
    size_t stride_x, stride_y; /* 0: not requested */
    enum scan_lines lines;
    enum scan_axis lines_along;
    double despike;          /* robust deviations; 0: not requested */
    struct asked_length tip; /* its radius; 0: not requested */
    bool tip_holes;          /* points that the tip did not reach become holes */
    bool transpose;
    double turn; /* degrees, counter-clockwise */
    enum asked_boundary boundary;
    enum asked_detrend detrend;
    bool degroove, fill, denoise;
    struct asked_length short_waves; /* cut-off wavelength of the S-filter; 0: not requested */
    struct asked_length long_waves;  /* of the L-filter, likewise */
    bool robust;                     /* both filters */
    size_t resample_x, resample_y;   /* points; 0: not requested, resample_y 0: by the spacing */
    struct asked_length resample_dx; /* spacing; 0: not requested */
    enum map_window window;
    bool artefacts; /* what the instrument left is sought */
    bool extend;
    uint64_t extend_seed; /* of the draw */
};

enum { PREPARATION_STEPS_MOST = 29, PREPARATION_TEXT = 160 };

/* The steps that were done, and what was measured in them. */
struct preparation_record {
    enum boundary boundary;  /* how the map is to be treated */
    const char *boundary_by; /* "option", "holes", "instrument", "seam", "extension" or "window";
                                static */
    struct seam seam;        /* when the boundary was decided */
    double holes;            /* as a share of the points, before any were filled */
    enum detrend detrend;
    struct trend trend;    /* what was subtracted */
    double window_power;   /* mean square of the window over the points; 1: none */
    enum scan_lines lines; /* how scan lines were levelled, and along which axis */
    enum scan_axis lines_along;
    bool denoised; /* noise was taken out, which adds relative standard errors to RMS slope and
                      curvature, of waves down to a length */
    double denoised_slope, denoised_curvature, denoised_to;
    struct map_artefacts artefacts; /* of the map as it was scanned; where they are sought */
    size_t count;
    struct preparation_step {
        const char *name; /* "crop", "fill", ...; static; each at most once */
        char text[PREPARATION_TEXT];
    } steps[PREPARATION_STEPS_MOST]; /* in the order in which they were done */
};

/* Adds a step; `name` is static. Also for steps on a map elsewhere. */
__attribute__((format(printf, 3, 4))) void
preparation_note(struct preparation_record *record, const char *name, const char *format, ...);

/* Prepares the map in place. *record is {0} at first, or has earlier steps, and gets those that
 * were done. ERROR_INPUT names the step, its value and what is allowed, or heights or spacings that
 * are too large or too small to compute with; the map may then only be cleared. Beside the map it
 * takes at most about four times its memory, or for holes about 240 bytes each. */
int preparation_run(struct preparation_record *record, struct height_map *map,
                    const struct preparation *asked, struct error *err);

/* ERROR_INPUT, naming --unit or --z-unit, where the map has a unit of length along one of its axes
 * and none, or another, along z, so that slopes have no meaning. */
int height_map_check_units(const struct height_map *map, struct error *err);

/* Returns the text of a note; NULL where there is none. Borrowed. */
const char *preparation_text(const struct preparation_record *record, const char *name);
/* Writes the steps in one line, "crop: ...; detrend: ...": all notes but those on the origin of the
 * map (file, bytes, sha256, unpacked, format, layer, program). "" where nothing was done. */
void preparation_steps_text(const struct preparation_record *record, char *out, size_t size);
enum { PREPARATION_STEPS_TEXT = PREPARATION_STEPS_MOST * (PREPARATION_TEXT + 24) };

#endif
