#include "core/theory/height_cells.h"
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

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

double height_cells_mean(size_t cell) {
    return FIRST_CENTRE + (double)cell * CELL_WIDTH;
}

double height_cells_deviation(double variance) {
    double added = CELL_WIDTH * CELL_WIDTH / 6;
    return sqrt(fmax(variance - added, added));
}

/* Of heights that are normal about a mean, which is a number of deviations below an edge: the
 * shares below and above the edge, and the normal density there. */
struct share {
    double below, above, density;
};
static struct share share_at(double a) {
    return (struct share){erfc(-a / M_SQRT2) / 2, erfc(a / M_SQRT2) / 2,
                          exp(-a * a / 2) * 0.39894228040143268};
}

/* Shares by the distance from a cell to an edge, in parts of a cell. */
struct share_table {
    const double *cells;
    const double *at;     /* heights of the edges; NULL: those of the bins */
    size_t first, end;    /* cells outside this range are empty */
    double deviation;     /* of heights about the mean of their cell */
    long parts;           /* of a cell; 0: edges lie on no lattice of parts, and shares is NULL */
    long edge, edge_step; /* parts from the first cell to the first edge, from edge to edge */
    long nearest;         /* distance of shares[0] */
    struct share *shares; /* owned */
};

enum { PARTS_MOST = 20 };
static bool is_whole(double x) {
    return fabs(x - rint(x)) < 1e-9;
}

/* Finds the lattice of the edges. */
static void table_align(struct share_table *table, const struct bins *bins) {
    double step = bins_width(bins) / CELL_WIDTH, edge = (bins->low - FIRST_CENTRE) / CELL_WIDTH;
    double last = edge + step * (double)bins->count;
    if (!(fabs(edge) <= HEIGHT_CELLS && fabs(last) <= 2 * HEIGHT_CELLS))
        return; /* bins far from all heights */
    for (long parts = 1; parts <= PARTS_MOST && table->parts == 0; parts++)
        if (is_whole(step * (double)parts) && is_whole(edge * (double)parts)) {
            table->parts = parts;
            table->edge = lrint(edge * (double)parts);
            table->edge_step = lrint(step * (double)parts);
        }
}

static int table_create(struct share_table *table, const double *cells, double deviation,
                        const struct bins *bins, const double *at, struct error *err) {
    *table =
        (struct share_table){.cells = cells, .at = at, .end = HEIGHT_CELLS, .deviation = deviation};
    while (table->first < table->end && cells[table->first] == 0)
        table->first++;
    while (table->end > table->first && cells[table->end - 1] == 0)
        table->end--;
    if (at == NULL)
        table_align(table, bins);
    if (table->parts == 0 || table->end == table->first)
        return 0;
    long farthest = table->edge + (long)bins->count * table->edge_step;
    farthest -= (long)table->first * table->parts;
    table->nearest = table->edge - (long)(table->end - 1) * table->parts;
    size_t count = (size_t)(farthest - table->nearest) + 1;
    table->shares = array_create(count, sizeof *table->shares);
    if (table->shares == NULL)
        return error_memory(err, count * sizeof *table->shares, "normal shares");
    double part = CELL_WIDTH / (double)table->parts / deviation;
    for (size_t a = 0; a < count; a++)
        table->shares[a] = share_at((double)(table->nearest + (long)a) * part);
    return 0;
}

static struct share table_find(const struct share_table *table, const struct bins *bins, size_t b,
                               size_t cell) {
    if (table->shares != NULL)
        return table->shares[table->edge + (long)b * table->edge_step - (long)cell * table->parts -
                             table->nearest];
    double edge = table->at != NULL ? table->at[b] : bins->low + (double)b * bins_width(bins);
    return share_at((edge - FIRST_CENTRE - (double)cell * CELL_WIDTH) / table->deviation);
}

/* Sums at one edge. */
struct edge_sums {
    double below, above, below_moment, above_moment;
};

static struct edge_sums edge_sums(const struct share_table *table, const double *moments,
                                  double rise, const struct bins *bins, size_t b) {
    struct edge_sums sums = {0, 0, 0, 0};
    for (size_t cell = table->first; cell < table->end; cell++) {
        double weight = table->cells[cell];
        if (weight == 0)
            continue;
        struct share share = table_find(table, bins, b, cell);
        sums.below += weight * share.below;
        sums.above += weight * share.above;
        if (moments == NULL)
            continue;
        /* the mean of (height - mean) below the edge is minus the normal density there */
        double slant = rise == 0 ? 0 : rise * weight * table->deviation * share.density;
        sums.below_moment += moments[cell] * share.below - slant;
        sums.above_moment += moments[cell] * share.above + slant;
    }
    return sums;
}

int height_cells_spread(const double cells[HEIGHT_CELLS], const double *moments, double variance,
                        double rise, const struct bins *bins, const struct height_edges *out,
                        struct error *err) {
    struct share_table table;
    int status = table_create(&table, cells, height_cells_deviation(variance), bins, out->at, err);
    if (status != 0)
        return status;
    for (size_t b = 0; b <= bins->count; b++) {
        struct edge_sums sums = edge_sums(&table, moments, rise, bins, b);
        out->below[b] = sums.below;
        out->above[b] = sums.above;
        if (moments == NULL)
            continue;
        out->below_moment[b] = sums.below_moment;
        out->above_moment[b] = sums.above_moment;
    }
    free(table.shares);
    return 0;
}

double height_edges_within(const double *below, const double *above, size_t b) {
    return below[b] < above[b + 1] ? below[b + 1] - below[b] : above[b] - above[b + 1];
}
