/* Extends a map to a periodic one of twice its sides, which holds it and goes on as the law of its
 * spectrum says (FORMULAS.md, F18.49 and F18.50). */
#ifndef RUGO_CORE_MAP_EXTEND_H
#define RUGO_CORE_MAP_EXTEND_H

#include "core/map/height_map.h"
#include "core/map/preparation/detrend.h"
#include "core/statistics/grooves/map_grooves.h"
#include "core/surface/conditional.h"

struct extend_result {
    struct conditional_report draw;
    double noise;    /* RMS height to within which the map is held */
    bool noise_seen; /* in the spectrum of the map, so that it governs slopes (denoise.h); false: it
                        is a thousandth of the RMS height */
    bool law_holds;  /* the deviance of the fit (spectrum_fit.h) is within its limit */
    bool translated; /* heights are not Gaussian: normal scores (normal_scores.h) are extended, in
                        which all of the above but draw.difference is, and have the map's heights */
    struct map_grooves grooves; /* that go on (groove_extension.h), the same in all draws */
    bool drawn; /* law and heights are draws, too; false: no sub-map had any, and they are those
                   of the map */
};

/* Finds the grooves of an open map, with holes or none. Errors as of map_grooves_find(). */
int extension_grooves(struct map_grooves *out, const struct height_map *map, struct error *err);

/* Draws that hold one map, by one thread at a time. */
struct extension;
/* Fits the law of an open map, with holes or none, of what is left without its grooves; trend: what
 * was taken out of it, so that each draw has its own. Borrows the map. ERROR_INPUT for maps to
 * which no law can be fitted or that are too large; ERROR_MEMORY. */
int extension_create(struct extension **out, const struct height_map *map, enum detrend trend,
                     struct error *err);
void extension_destroy(struct extension **extension);
/* Returns the cell. */
const struct grid *extension_cell(const struct extension *extension);
/* Fills z, a value a point of the cell, with one draw: the map, but for noise and trend, is in the
 * first rows and columns, with its holes filled by the law. The law is drawn, too, as far as the
 * map leaves it open: fitted to a sub-map of a surface of the map's own law. ERROR_MEMORY; what
 * conditional_draw() fails with. */
int extension_draw(struct extension *extension, struct random_key key, double *z,
                   struct extend_result *out, struct error *err);
/* Return the peak bytes for a map of so many points, and the CPU seconds of a draw on a 3 GHz core,
 * within a factor of about 3. */
double extension_bytes(const struct grid *map);
double extension_seconds(const struct grid *map);

/* Makes one draw of the map itself; a number of the seed is one. The map is untouched after an
 * error. */
int map_extend(struct height_map *map, enum detrend trend, uint64_t seed, struct extend_result *out,
               struct error *err);

#endif
