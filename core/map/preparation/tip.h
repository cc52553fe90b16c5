/* The surface under a tip (FORMULAS.md, F18.32). The image of a surface by a tip is its dilation;
 * the erosion of the image by the tip is the highest surface that gives it, equal to the surface
 * where the tip touched it, and above it elsewhere (Villarrubia 1997). Of points of an image it is
 * so but for what lies between them. */
#ifndef RUGO_CORE_MAP_TIP_H
#define RUGO_CORE_MAP_TIP_H

#include "core/surface/grid.h"

struct tip_result {
    size_t untrusted; /* points that the tip did not reach */
    double rms;       /* root mean square of what was subtracted */
};

/* Replaces the image z by its erosion, min over r' of z(r') + |r - r'|^2/(2 radius), the tip being
 * a paraboloid and r' the points of the image, where the tip reached r also those between: the
 * least of the parabola through the nine points around. Marks the points that the tip did not reach
 * (untrusted[point] = 1, else 0; NULL: not asked for). Lengths are in one unit. Nothing is known
 * beyond the sides. Holes stay, and bound nothing. Time: proportional to the points (Felzenszwalb &
 * Huttenlocher 2012). Memory: two maps. ERROR_MEMORY, or ERROR_INPUT for 2^32 - 1 points or
 * more a side; the heights are untouched then. */
int tip_erode(const struct grid *grid, double *z, double radius, unsigned char *untrusted,
              struct tip_result *out, struct error *err);
/* Replaces a surface z by its image, max over r' of z(r') - |r - r'|^2/(2 radius). Errors as above.
 */
int tip_dilate(const struct grid *grid, double *z, double radius, struct error *err);

#endif
