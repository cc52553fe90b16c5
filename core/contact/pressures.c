#include "core/contact/pressures.h"
#include "core/contact/area_law.h"
#include "core/contact/edge/edge_find.h"
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* Least values: of the reach of a strip and the width of a chord, in steps, and of the cells that a
 * strip covers. Largest ones: of the law's factor on a squared pressure further inside, and of the
 * factor by which all strips together are stretched to make the area. */
static const double REACH_LEAST = 0.25, CHORD_LEAST = 0.3, CELL_LEAST = 1e-3;
static const double NEXT_MOST = 2, STRETCH_MOST = 2;
enum { CHORD_NODES = 2 };
#define NO_NODE SIZE_MAX

/* An area beside an edge over which the squared pressure (edge_fill_rise) is slope t (1 - bend t),
 * evenly distributed over 0 < t < reach. */
struct strip {
    double area; /* in cells; without that of its nodes until assign_cells */
    double slope, bend, reach;
    double part;               /* fraction of the cells of its nodes that it replaces */
    size_t nodes[CHORD_NODES]; /* or NO_NODE */
};

struct pressures {
    struct grid grid;
    const struct edge_law *law; /* borrowed */
    double *rise;               /* grid_points, as all here */
    double *covered;            /* fraction of a node's cell that strips replace */
    double *correction;         /* what the law adds to the logarithm of a squared pressure */
    struct strip *strips;       /* owned: those of the present state */
    size_t count, room;
};

/* Area in cells, and the sum over it of the pressures over the largest one. */
struct loaded_area {
    double area, force;
};

int pressures_create(struct pressures **out, const struct area_workspace *areas,
                     struct error *err) {
    const struct grid *grid = area_workspace_grid(areas);
    size_t n = grid_points(grid);
    struct pressures *pressures = array_create(1, sizeof *pressures);
    if (pressures != NULL) {
        pressures->grid = *grid;
        pressures->law = &area_workspace_law(areas)->edge;
        pressures->rise = array_create(n, sizeof *pressures->rise);
        pressures->covered = array_create(n, sizeof *pressures->covered);
        pressures->correction = array_create(n, sizeof *pressures->correction);
    }
    if (pressures == NULL || pressures->rise == NULL || pressures->covered == NULL ||
        pressures->correction == NULL) {
        pressures_destroy(&pressures);
        return error_memory(err, 3 * n * sizeof(double), "contact pressures");
    }
    *out = pressures;
    return 0;
}

void pressures_destroy(struct pressures **pressures) {
    struct pressures *p = *pressures;
    if (p == NULL)
        return;
    free(p->rise);
    free(p->covered);
    free(p->correction);
    free(p->strips);
    free(p);
    *pressures = NULL;
}

/* Edges on a line for each of its shortest waves, and those at a node, at most. At the loads where
 * most were found, on profiles of 8192 and surfaces of 192 x 192 nodes with 2 to 16 nodes a
 * shortest wave, there were 1.0 to 1.2 and 0.75 to 0.91 of H = 0.1, 0.4 to 0.5 and 0.4 to 0.7 of H
 * = 0.8. */
static const double PROFILE_EDGES = 1.3, SURFACE_EDGES = 1;
static const double PROFILE_EDGES_MOST = 0.6, SURFACE_EDGES_MOST = 0.4;

double pressures_bytes(const struct grid *grid, size_t mode_x, size_t mode_y) {
    double along_x = (double)mode_x / (double)grid->nx, along_y = (double)mode_y / (double)grid->ny;
    double strips = grid_is_profile(grid) ? fmin(PROFILE_EDGES * along_x, PROFILE_EDGES_MOST)
                                          : fmin(SURFACE_EDGES * along_x, SURFACE_EDGES_MOST) +
                                                fmin(SURFACE_EDGES * along_y, SURFACE_EDGES_MOST);
    return (24.0 + strips * (double)sizeof(struct strip)) * (double)grid_points(grid);
}

/* --- one strip --- */

static double rise_at(const struct strip *s, double t) {
    return fmax(0, s->slope * t * (1 - s->bend * t));
}

/* Returns the t up to which the squared pressure is below a value. */
static double reach_below(const struct strip *s, double rise) {
    double root = sqrt(fmax(0, 1 - 4 * s->bend * rise / s->slope));
    return fmin(2 * rise / (s->slope * (1 + root)), s->reach);
}

/* Returns the mean pressure, by Gauss's three points over the root of t. */
static double strip_mean(const struct strip *s) {
    static const double AT[3] = {0.11270166537925831, 0.5, 0.88729833462074169};
    static const double WEIGHT[3] = {5.0 / 18, 8.0 / 18, 5.0 / 18};
    double sum = 0;
    for (int a = 0; a < 3; a++)
        sum += WEIGHT[a] * 2 * AT[a] * sqrt(rise_at(s, s->reach * AT[a] * AT[a]));
    return sum;
}

/* unit: of the bins, over the largest pressure. */
static void share_strip(const struct strip *s, const struct bins *bins, double unit, double scale,
                        double *shares) {
    size_t last = bins_find(bins, sqrt(rise_at(s, s->reach)) / unit);
    double before = 0;
    for (size_t b = 0; b <= last; b++) {
        double high = (bins->low + (double)b * bins_width(bins)) * unit;
        double t = b == last ? s->reach : reach_below(s, high * high);
        shares[b] += scale * s->area * (t - before) / s->reach;
        before = t;
    }
}

/* --- strips of a state --- */

static void add_strip(struct pressures *p, const struct strip *strip) {
    for (size_t a = 0; a < CHORD_NODES; a++)
        if (strip->nodes[a] != NO_NODE)
            p->covered[strip->nodes[a]] += strip->part;
    p->strips[p->count++] = *strip;
}

/* Nodes in contact between two open ones on a grid line. */
struct run {
    const struct edge_family *family;
    size_t line, first, count;
};

static size_t run_node(const struct run *run, size_t a) {
    return edge_node(run->family, run->line, run->first + a);
}

/* Over a short chord between two edges the pressure is an ellipse that carries the force of its
 * nodes. beyond: area beyond their cells. */
static void add_chord(struct pressures *p, const struct run *run, double part, double width,
                      double beyond) {
    double force = 0;
    for (size_t a = 0; a < run->count; a++)
        force += sqrt(p->rise[run_node(run, a)]);
    double top = 4 * force / (M_PI * width);
    add_strip(p, &(struct strip){
                     .area = beyond,
                     .slope = 4 * top * top / width,
                     .bend = 1 / width,
                     .reach = width / 2,
                     .part = part,
                     .nodes = {run_node(run, 0), run->count > 1 ? run_node(run, 1) : NO_NODE}});
}

/* A patch of one node of a surface is met in a row and in a column; the row counts. Over Hertz's
 * ellipse the squared pressure is evenly distributed. */
static void add_lone(struct pressures *p, const struct run *run, double area) {
    if (!run->family->row)
        return;
    double top = 1.5 * sqrt(p->rise[run_node(run, 0)]) / area;
    add_strip(p, &(struct strip){.area = area - 1,
                                 .slope = top * top,
                                 .reach = 1,
                                 .part = 1,
                                 .nodes = {run_node(run, 0), NO_NODE}});
}

/* The outer node of a longer run, with the half of the step to the next node that is in its
 * cell. */
static void add_border(struct pressures *p, const struct edge_crossing *x,
                       const struct edge_found *f) {
    add_strip(p, &(struct strip){.area = f->part * (f->share - 0.5),
                                 .slope = f->slope,
                                 .bend = f->bend,
                                 .reach = fmax(f->reach, REACH_LEAST),
                                 .part = f->part,
                                 .nodes = {x->inside, NO_NODE}});
    p->correction[x->before] += f->part * log(fmin(fmax(f->next, 1 / NEXT_MOST), NEXT_MOST));
}

static void add_run(struct pressures *p, const struct run *run) {
    size_t first = run->first + run->family->nodes, last = first + run->count - 1;
    struct edge_crossing low = edge_crossing_at(run->family, run->line, first, first - 1);
    struct edge_crossing high = edge_crossing_at(run->family, run->line, last, last + 1);
    struct edge_found in = edge_find(&low, p->law, p->rise);
    struct edge_found out = edge_find(&high, p->law, p->rise);
    double lone = fmax(2 * in.lone, CELL_LEAST), inner = (double)run->count - 1;
    if (!isnan(in.lone) && low.profile)
        add_chord(p, run, 1, lone, lone - 1);
    else if (!isnan(in.lone))
        add_lone(p, run, lone);
    else if (run->count <= CHORD_NODES)
        add_chord(p, run, (in.part + out.part) / 2, fmax(in.share + inner + out.share, CHORD_LEAST),
                  in.part * (in.share - 0.5) + out.part * (out.share - 0.5));
    else {
        add_border(p, &low, &in);
        add_border(p, &high, &out);
    }
}

static void add_line(struct pressures *p, const struct edge_family *family, size_t line) {
    struct run run = {.family = family, .line = line};
    size_t open = 0;
    while (open < family->nodes && p->rise[edge_node(family, line, open)] > 0)
        open++;
    for (size_t a = open + 1; open < family->nodes && a <= open + family->nodes; a++) {
        if (p->rise[edge_node(family, line, a)] > 0) {
            run.first = run.count++ == 0 ? a % family->nodes : run.first;
        } else if (run.count > 0) {
            add_run(p, &run);
            run.count = 0;
        }
    }
}

static size_t count_edges(const struct pressures *p, const struct edge_family *family) {
    size_t count = 0;
    for (size_t line = 0; line < family->lines; line++)
        for (size_t node = 0; node < family->nodes; node++)
            count += (p->rise[edge_node(family, line, node)] > 0) !=
                     (p->rise[edge_node(family, line, node + 1)] > 0);
    return count;
}

static int reserve(struct pressures *p, size_t count, struct error *err) {
    if (count <= p->room)
        return 0;
    free(p->strips);
    p->room = 0;
    p->strips = array_create(count, sizeof *p->strips);
    if (p->strips == NULL)
        return error_memory(err, count * sizeof *p->strips, "contact pressures");
    p->room = count;
    return 0;
}

static int find_strips(struct pressures *p, struct error *err) {
    struct edge_family family[2] = {edge_rows(&p->grid), edge_columns(&p->grid)};
    size_t families = grid_is_profile(&p->grid) ? 1 : 2, edges = 0, n = grid_points(&p->grid);
    for (size_t a = 0; a < families; a++)
        edges += count_edges(p, &family[a]);
    int status = reserve(p, edges, err);
    if (status != 0)
        return status;
    p->count = 0;
    memset(p->covered, 0, n * sizeof *p->covered);
    memset(p->correction, 0, n * sizeof *p->correction);
    for (size_t a = 0; a < families; a++)
        for (size_t line = 0; line < family[a].lines; line++)
            add_line(p, &family[a], line);
    return 0;
}

/* --- all of the contact --- */

/* Gives strips the cells of their nodes; where several strips meet in a node, they share its
 * cell. */
static struct loaded_area assign_cells(struct pressures *p) {
    struct loaded_area all = {0};
    for (size_t a = 0; a < p->count; a++) {
        struct strip *s = &p->strips[a];
        for (size_t b = 0; b < CHORD_NODES; b++)
            if (s->nodes[b] != NO_NODE)
                s->area += s->part / fmax(1, p->covered[s->nodes[b]]);
        s->area = fmax(CELL_LEAST * s->part, s->area);
        all.area += s->area;
        all.force += s->area * strip_mean(s);
    }
    return all;
}

/* Return the part of a node's cell that no strip replaces, and its pressure over the largest
 * one. */
static double cell_left(const struct pressures *p, size_t i) {
    return p->rise[i] > 0 ? fmax(0, 1 - p->covered[i]) : 0;
}

static double pressure_of(const struct pressures *p, size_t i) {
    return sqrt(p->rise[i] * exp(p->correction[i]));
}

int pressures_share(struct pressures *pressures, const struct contact_state *state, double area,
                    const struct bins *bins, double unit, double *shares, struct error *err) {
    const size_t n = grid_points(&pressures->grid);
    if (state->yielded > 0)
        return error_set(err, ERROR_INPUT,
                         "areas by pressure where %zu nodes have yielded; allowed: none, as edges "
                         "beside them follow no law",
                         state->yielded);
    double most = edge_highest_pressure(n, state->p);
    edge_fill_rise(state, most, pressures->law->stiffness, 0, n, pressures->rise);
    int status = find_strips(pressures, err);
    if (status != 0)
        return status;
    memset(shares, 0, (bins->count + 2) * sizeof *shares);
    if (!(most > 0))
        return 0;
    struct loaded_area strips = assign_cells(pressures), nodes = {0};
    for (size_t i = 0; i < n; i++) {
        double left = cell_left(pressures, i);
        nodes.area += left;
        nodes.force += left > 0 ? left * pressure_of(pressures, i) : 0;
    }
    /* Strips are stretched to make the area, within limits, and all pressures are scaled to make
     * the load. */
    double stretch = strips.area > 0 ? (area * (double)n - nodes.area) / strips.area : 1;
    stretch = fmin(fmax(stretch, 1 / STRETCH_MOST), STRETCH_MOST);
    double scale = area / (nodes.area + stretch * strips.area);
    double force = scale * (nodes.force + stretch * strips.force);
    double bin_unit = force > 0 ? unit * force / state->pressure : unit / most;
    for (size_t a = 0; a < pressures->count; a++)
        share_strip(&pressures->strips[a], bins, bin_unit, scale * stretch, shares);
    for (size_t i = 0; i < n; i++)
        if (cell_left(pressures, i) > 0)
            shares[bins_find(bins, pressure_of(pressures, i) / bin_unit)] +=
                scale * cell_left(pressures, i);
    return 0;
}
