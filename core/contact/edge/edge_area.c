#include "core/contact/edge/edge_area.h"
#include "core/contact/edge/edge_find.h"
#include <math.h>

/* Adds to the sums, in cells, the area between the edge of a crossing and the cells of the nodes in
 * contact. */
static void add_crossing(const struct edge_crossing *x, const struct edge_law *law,
                         const struct contact_state *state, const double *rise,
                         struct edge_area *sums) {
    struct edge_found f = edge_find(x, law, rise);
    if (!isnan(f.lone)) { /* met once on each side: twice in a profile, four times in a surface */
        sums->straight += x->profile ? f.lone - 0.5 : (f.lone - 0.5) / 2;
        return;
    }
    sums->straight += f.part * (f.share - 0.5);
    /* The pressure grows at constant c. */
    if (state->tangent != NULL)
        sums->rate += f.part * (f.rate * state->tangent[x->inside] / state->p[x->inside]) / f.apart;
}

static void add_family(const struct edge_family *f, const struct edge_law *law,
                       const struct contact_state *state, const double *rise,
                       struct edge_area *sums) {
    for (size_t line = 0; line < f->lines; line++)
        for (size_t node = 0; node < f->nodes - (f->open ? 1 : 0); node++) {
            bool first = rise[edge_node(f, line, node)] > 0;
            bool second = rise[edge_node(f, line, node + 1)] > 0;
            if (first == second)
                continue;
            size_t a = f->nodes + node + (first ? 0 : 1), b = f->nodes + node + (first ? 1 : 0);
            struct edge_crossing crossing = edge_crossing_at(f, line, a, b);
            add_crossing(&crossing, law, state, rise, sums);
        }
}

/* Counts patches less holes by the turns of their boundary: a cell with one corner in contact turns
 * it by a quarter, a cell with three turns it back by one. Counts the sides of the boundary, too.
 * It ends at the sides of an open grid. */
static void count_boundary(const struct grid *grid, bool open, const double *p,
                           struct edge_area *sums) {
    size_t nx = grid->nx, ny = grid->ny;
    for (size_t j = 0; j < ny; j++)
        for (size_t i = 0; i < nx; i++) {
            size_t i2 = open && i + 1 == nx ? i : (i + 1) % nx;
            size_t j2 = open && j + 1 == ny ? j : (j + 1) % ny;
            bool in = p[j * nx + i] > 0, right = p[j * nx + i2] > 0, back = p[j2 * nx + i] > 0;
            int corners = in + right + back + (p[j2 * nx + i2] > 0);
            sums->patches += corners == 1 ? 0.25 : corners == 3 ? -0.25 : 0;
            sums->sides += (in != right) + (in != back);
        }
}

void edge_area_measure(const struct edge_law *law, const struct grid *grid, bool open,
                       const struct contact_state *state, double *rise, struct edge_area *out) {
    double n = (double)grid_points(grid);
    struct edge_family rows = edge_rows(grid), columns = edge_columns(grid);
    rows.open = columns.open = open;
    edge_fill_rise(grid, state, rise);
    *out = (struct edge_area){0};
    for (size_t i = 0; i < grid_points(grid); i++)
        out->nodes += rise[i] > 0;
    out->straight = out->nodes;
    add_family(&rows, law, state, rise, out);
    if (!grid_is_profile(grid)) {
        add_family(&columns, law, state, rise, out);
        count_boundary(grid, open, state->p, out);
    }
    *out = (struct edge_area){.straight = out->straight / n,
                              .rate = out->rate / n,
                              .patches = out->patches / n,
                              .nodes = out->nodes / n,
                              .sides = out->sides / n};
}
