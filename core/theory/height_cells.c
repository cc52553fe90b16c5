#include "core/theory/height_cells.h"
#include <math.h>

static const double CELL_WIDTH = 1.0 / 64;
static const double FIRST_CENTRE = -12;

void height_cells_add(double cells[HEIGHT_CELLS], double mean, double weight) {
    double at = (mean - FIRST_CENTRE) / CELL_WIDTH;
    at = fmin(fmax(at, 0), HEIGHT_CELLS - 1.001);
    size_t cell = (size_t)at;
    double upper = at - (double)cell;
    cells[cell] += weight * (1 - upper);
    cells[cell + 1] += weight * upper;
}

/* Sums at one edge. */
struct edge_sums {
    double below, above, below_moment, above_moment;
};

static struct edge_sums edge_sums(const double *cells, const double *moments, double deviation,
                                  double rise, double edge) {
    struct edge_sums sums = {0, 0, 0, 0};
    for (size_t cell = 0; cell < HEIGHT_CELLS; cell++) {
        if (cells[cell] == 0)
            continue;
        double a = (edge - FIRST_CENTRE - (double)cell * CELL_WIDTH) / deviation;
        double below = erfc(-a / M_SQRT2) / 2, above = erfc(a / M_SQRT2) / 2;
        sums.below += cells[cell] * below;
        sums.above += cells[cell] * above;
        if (moments == NULL)
            continue;
        /* the mean of (height - mean) below the edge is minus the normal density there */
        double slant =
            rise == 0 ? 0 : rise * cells[cell] * deviation * exp(-a * a / 2) * 0.39894228040143268;
        sums.below_moment += moments[cell] * below - slant;
        sums.above_moment += moments[cell] * above + slant;
    }
    return sums;
}

void height_cells_spread(const double cells[HEIGHT_CELLS], const double *moments, double variance,
                         double rise, const struct bins *bins, const struct height_edges *out) {
    /* Counting in two cells has added this much to the variance on the mean. */
    double added = CELL_WIDTH * CELL_WIDTH / 6;
    double deviation = sqrt(fmax(variance - added, added));
    for (size_t b = 0; b <= bins->count; b++) {
        double edge = bins->low + (double)b * bins_width(bins);
        struct edge_sums sums = edge_sums(cells, moments, deviation, rise, edge);
        out->below[b] = sums.below;
        out->above[b] = sums.above;
        if (moments == NULL)
            continue;
        out->below_moment[b] = sums.below_moment;
        out->above_moment[b] = sums.above_moment;
    }
}

double height_edges_within(const double *below, const double *above, size_t b) {
    return below[b] < above[b + 1] ? below[b + 1] - below[b] : above[b] - above[b + 1];
}
