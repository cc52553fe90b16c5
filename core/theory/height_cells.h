/* Sums over points whose heights are normal about means of their own, all with one variance. The
 * means are counted in narrow cells, and each cell is distributed over bins of height at the
 * end. */
#ifndef RUGO_CORE_THEORY_HEIGHT_CELLS_H
#define RUGO_CORE_THEORY_HEIGHT_CELLS_H

#include "core/error.h"
#include "core/statistics/heights/histogram.h"

/* Cells of 1/64 of a standard deviation of heights, to 12 of them on either side. */
enum { HEIGHT_CELLS = 24 * 64 };

/* Adds weight to the two cells next to a mean, so that their weighted mean is that mean. */
void height_cells_add(double cells[HEIGHT_CELLS], double mean, double weight);
/* Returns the mean that a cell stands for. */
double height_cells_mean(size_t cell);
/* Returns the deviation of heights about the means of the cells, to which counting in two cells has
 * added its part of the variance. */
double height_cells_deviation(double variance);

/* Sums at the edges of the bins: arrays of count + 1 entries, which the caller owns. */
struct height_edges {
    double *below, *above;
    double *below_moment, *above_moment;
    const double *at; /* rising heights that stand for the edges; NULL: the edges themselves */
};
/* Fills, at the edges of the bins, the weight of heights below and above. With moments not NULL, it
 * also fills below_moment and above_moment: the sums of the cells' moments plus rise times weight
 * times (height - mean). Where edges lie on a lattice of a few parts of a cell, as those of bins
 * 0.05 wide do, each point of it takes two error functions; otherwise each pair of an edge and a
 * cell does. ERROR_MEMORY: nothing is filled. */
int height_cells_spread(const double cells[HEIGHT_CELLS], const double *moments, double variance,
                        double rise, const struct bins *bins, const struct height_edges *out,
                        struct error *err);
/* Returns the weight in bin b, from the smaller side, so that tails keep their digits. */
double height_edges_within(const double *below, const double *above, size_t b);

#endif
