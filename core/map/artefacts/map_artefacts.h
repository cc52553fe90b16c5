/* What an instrument leaves in a map: steps of height, spikes, offsets of scan lines, and columns
 * and rows that hold nothing of their own; with what each changes of slopes (FORMULAS.md, F18.39 to
 * F18.43). */
#ifndef RUGO_CORE_MAP_ARTEFACTS_MAP_ARTEFACTS_H
#define RUGO_CORE_MAP_ARTEFACTS_MAP_ARTEFACTS_H

#include "core/map/artefacts/height_steps.h"
#include "core/map/artefacts/line_offsets.h"
#include "core/map/artefacts/repeated_lines.h"

/* Points that do not go with their neighbours. */
struct map_spikes {
    size_t count;
    double largest;   /* robust deviations of the farthest from what its neighbours predict; 0 */
    double slope;     /* RMS slope without them over that with them */
    double curvature; /* their share in the mean square of second differences */
};

struct map_artefacts {
    bool sought;
    struct height_steps steps; /* what they do is to the map without spikes, as of lines */
    struct map_spikes spikes;
    struct line_offsets lines;        /* along the axis that shows them more */
    enum scan_axis lines_along;       /* which that is */
    struct repeated_lines columns[2]; /* columns, of a profile its points, and rows */
    bool smoothed; /* a filter or other points came later, which take the steps out, too */
};

/* What is in the heights as they were stored: steps, columns and rows. *out is {0} at first.
 * Memory: half a megabyte. ERROR_MEMORY. */
int map_artefacts_find_stored(const struct grid *grid, const double *z, struct map_artefacts *out,
                              struct error *err);
/* What is in them after scan lines were levelled and spikes removed, where this was asked for:
 * spikes and lines. Memory: two maps. ERROR_MEMORY. */
int map_artefacts_find_left(const struct grid *grid, const double *z, struct map_artefacts *out,
                            struct error *err);

/* Return whether an artefact was found, and, where single points and lines are found too, whether
 * it counts in slopes or curvatures (differences.h). Steps and lines count where they are found. */
bool map_steps_found(const struct map_artefacts *artefacts);
bool map_spikes_found(const struct map_artefacts *artefacts);
bool map_spikes_count(const struct map_artefacts *artefacts);
bool map_columns_found(const struct map_artefacts *artefacts, int axis);
bool map_columns_count(const struct map_artefacts *artefacts, int axis);
/* Returns whether any of them counts. */
bool map_artefacts_count(const struct map_artefacts *artefacts);
/* Returns whether one that counts also bends the spectrum. Steps and spikes are noise in it, which
 * a law takes out where it finds any. */
bool map_artefacts_bend(const struct map_artefacts *artefacts, bool noise_found);
/* Returns the RMS slope without steps, spikes and offsets that were found over that with them; NaN:
 * not known. */
double map_artefacts_slope(const struct map_artefacts *artefacts);

#endif
