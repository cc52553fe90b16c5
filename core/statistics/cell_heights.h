/* The heights of a map counted and summed in the cells of low_modes.h. */
#ifndef RUGO_CORE_STATISTICS_CELL_HEIGHTS_H
#define RUGO_CORE_STATISTICS_CELL_HEIGHTS_H

#include "core/statistics/low_modes.h"

enum { HEIGHT_LEVELS = 127 }; /* between bins that hold about as many heights each */

struct cell_heights {
    size_t cells;
    double count;     /* of heights */
    double mean, rms; /* RMS about the mean; 0: a flat map */
    bool untilted;    /* no tilt of least squares is in them, as where it was taken out */
    size_t levels;    /* at most HEIGHT_LEVELS; fewer where heights take few values */
    /* Rising; each lies half-way between two heights. */
    double level[HEIGHT_LEVELS];
    double share[HEIGHT_LEVELS]; /* of heights below */
    double *below;               /* owned; [cell*levels + l]: how many heights are below level l */
    double *power[5];            /* owned by power[0]; power[p][cell]: sum of the p-th powers of
                                    heights about the mean */
    double *size;                /* owned by power[0]; sum of their absolute values */
};
/* Fills in for the cells of modes, of which only the lattice is used. ERROR_MEMORY, and ERROR_INPUT
 * for a map of holes alone. */
int cell_heights_create(struct cell_heights **out, const struct measured_map *map,
                        const struct low_modes *modes, struct error *err);
void cell_heights_destroy(struct cell_heights **heights);

#endif
