#include "core/contact/edge/edge_area.h"
#include "core/contact/edge/edge_find.h"
#include <math.h>
#include <stdlib.h>

/* Adds to the sums, in cells, the area between the edge of a crossing and the cells of the nodes in
 * contact. yielded: so is the node inside. Where it has, or where the face ends in a side, the edge
 * stays on the border of its cell. */
static void add_crossing(const struct edge_crossing *x, const struct edge_law *law,
                         const struct contact_state *state, const double *rise, bool yielded,
                         struct edge_area *sums) {
    struct edge_found f = edge_find(x, law, rise);
    if (yielded || f.side) {
        double part = !isnan(f.lone) ? (x->profile ? 1 : 0.5) : f.part;
        sums->unknown += 0.5 * part;
        sums->unknown_sides += 1;
        return;
    }
    if (!isnan(f.lone)) { /* met once on each side: twice in a profile, four times in a surface */
        sums->straight += x->profile ? f.lone - 0.5 : (f.lone - 0.5) / 2;
        return;
    }
    sums->straight += f.part * (f.share - 0.5);
    /* The pressure grows at constant c. */
    if (state->tangent != NULL)
        sums->rate += f.part * (f.rate * state->tangent[x->inside] / state->p[x->inside]) / f.apart;
}

/* Sums over some rows. */
struct part_sums {
    struct edge_area area;
    double inside; /* nodes from whose side crossings are measured */
};

struct edge_scan {
    const struct edge_law *law; /* borrowed */
    struct grid grid;
    bool open;
    double *own;            /* grid_points: takes memory where states have no scratch */
    double *rise;           /* that of the last state, or own */
    struct part_sums *sums; /* of each part */
    struct team *team;      /* borrowed; NULL: the caller alone */
    const struct contact_state *state;
    double highest; /* pressure; where nodes have yielded, theirs */
};

/* Rows of a part: those of some ten thousand nodes. */
static size_t part_rows(const struct grid *grid) {
    return (1 << 14) / grid->nx + 1;
}

static size_t part_count(const struct grid *grid) {
    return team_parts(grid->ny, part_rows(grid));
}

int edge_scan_create(struct edge_scan **out, const struct edge_law *law, const struct grid *grid,
                     bool open, struct error *err) {
    struct edge_scan *scan = array_create(1, sizeof *scan);
    *out = NULL;
    if (scan == NULL)
        return error_memory(err, sizeof *scan, "contact areas");
    *scan = (struct edge_scan){.law = law, .grid = *grid, .open = open};
    scan->own = array_create(grid_points(grid), sizeof *scan->own);
    scan->sums = array_create(part_count(grid), sizeof *scan->sums);
    if (scan->own == NULL || scan->sums == NULL) {
        edge_scan_destroy(&scan);
        return error_memory(err, grid_points(grid) * sizeof(double), "contact areas");
    }
    *out = scan;
    return 0;
}

void edge_scan_destroy(struct edge_scan **scan) {
    if (*scan == NULL)
        return;
    free((*scan)->own);
    free((*scan)->sums);
    free(*scan);
    *scan = NULL;
}

double edge_scan_bytes(const struct grid *grid) {
    return sizeof(struct part_sums) * (double)part_count(grid);
}

void edge_scan_set_team(struct edge_scan *scan, struct team *team) {
    scan->team = team;
}

/* Adds the crossing between a node of a line and the next one, if there is one. */
static void add_between(const struct edge_scan *scan, const struct edge_family *f, size_t line,
                        size_t node, bool first, bool second, struct edge_area *sums) {
    if (first == second)
        return;
    size_t a = f->nodes + node + (first ? 0 : 1), b = f->nodes + node + (first ? 1 : 0);
    struct edge_crossing crossing = edge_crossing_at(f, line, a, b);
    bool yielded = scan->state->yielded > 0 && scan->state->p[crossing.inside] >= scan->highest;
    add_crossing(&crossing, scan->law, scan->state, scan->rise, yielded, sums);
}

/* Counts nodes and corners of a cell. Patches less holes are counted by the turns of their
 * boundary: a cell with one corner in contact turns it by a quarter, a cell with three turns it
 * back by one. The boundary ends at the sides of an open grid. */
static void count_corners(bool in, bool right, bool back, bool across, struct edge_area *sums) {
    int corners = in + right + back + across;
    sums->nodes += in;
    sums->lower += corners == 4;
    sums->upper += corners > 0;
    sums->patches += corners == 1 ? 0.25 : corners == 3 ? -0.25 : 0;
    sums->sides += (in != right) + (in != back);
}

/* Adds a row of crossings and of cells with their corners. The square of a tiny pressure may be 0,
 * so that crossings are found by rises and nodes counted by pressures. */
static void scan_row(const struct edge_scan *scan, size_t j, struct part_sums *part) {
    const size_t nx = scan->grid.nx, ny = scan->grid.ny;
    const bool profile = ny == 1, last = scan->open && j + 1 == ny;
    const size_t row = j * nx, next = (last ? j : (j + 1) % ny) * nx;
    const double *rise = scan->rise, *p = scan->state->p;
    struct edge_family rows = edge_rows(&scan->grid), columns = edge_columns(&scan->grid);
    rows.open = columns.open = scan->open;
    for (size_t i = 0; i < nx; i++) {
        bool end = i + 1 == nx, in = rise[row + i] > 0;
        size_t i2 = !end ? i + 1 : scan->open ? i : 0;
        count_corners(p[row + i] > 0, p[row + i2] > 0, p[next + i] > 0, p[next + i2] > 0,
                      &part->area);
        part->inside += in;
        if (!(end && scan->open))
            add_between(scan, &rows, j, i, in, rise[row + i2] > 0, &part->area);
        if (!profile && !last)
            add_between(scan, &columns, i, j, in, rise[next + i] > 0, &part->area);
    }
}

static void scan_rows(void *context, size_t first, size_t end, size_t thread) {
    (void)thread;
    const struct edge_scan *scan = context;
    struct part_sums sums = {0};
    for (size_t j = first; j < end; j++)
        scan_row(scan, j, &sums);
    scan->sums[first / part_rows(&scan->grid)] = sums;
}

static void fill_rows(void *context, size_t first, size_t end, size_t thread) {
    (void)thread;
    const struct edge_scan *scan = context;
    size_t nx = scan->grid.nx;
    edge_fill_rise(scan->state, scan->highest, scan->law->stiffness, first * nx, end * nx,
                   scan->rise);
}

void edge_area_measure(struct edge_scan *scan, const struct contact_state *state,
                       struct edge_area *out) {
    const size_t points = grid_points(&scan->grid);
    const double n = (double)points;
    struct part_sums total = {0};
    struct edge_area *area = &total.area;
    scan->state = state;
    scan->rise = state->scratch != NULL ? state->scratch : scan->own;
    scan->highest = edge_highest_pressure(points, state->p);
    team_share_ranges(scan->team, scan->grid.ny, part_rows(&scan->grid), fill_rows, scan);
    team_share_ranges(scan->team, scan->grid.ny, part_rows(&scan->grid), scan_rows, scan);
    for (size_t part = 0; part < part_count(&scan->grid); part++) {
        const struct edge_area *sums = &scan->sums[part].area;
        total.inside += scan->sums[part].inside;
        area->straight += sums->straight;
        area->rate += sums->rate;
        area->patches += sums->patches;
        area->nodes += sums->nodes;
        area->lower += sums->lower;
        area->upper += sums->upper;
        area->sides += sums->sides;
        area->unknown += sums->unknown;
        area->unknown_sides += sums->unknown_sides;
    }
    /* A profile has neither cells nor sides of them. */
    const bool profile = grid_is_profile(&scan->grid);
    *out = (struct edge_area){.straight = (total.inside + area->straight) / n,
                              .rate = area->rate / n,
                              .patches = profile ? 0 : area->patches / n,
                              .nodes = area->nodes / n,
                              .lower = area->lower / n,
                              .upper = area->upper / n,
                              .sides = profile ? 0 : area->sides / n,
                              .unknown = area->unknown / n,
                              .unknown_sides = profile ? 0 : area->unknown_sides / n};
}
