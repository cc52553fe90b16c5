#include "core/contact/edge_area.h"
#include <math.h>

static const double PI = 3.14159265358979323846;
static const double COSINE_LEAST = 0.1;
/* The squared pressure bends: p^2 = c^2 d (1 - bend d). The gap's rise does so by a fifth of it
 * beside a straight edge and not at all around a round patch, which is left out. */
static const double BEND_MOST = 0.5;
enum { ROUNDS = 4, INVERSE_STEPS = 2 };

/* The nodes around one edge on a grid line, from a node in contact to its neighbour out of contact.
 */
struct crossing {
    size_t inside, outside;    /* the two nodes; all names below are nodes too */
    size_t before, far_before; /* further inside */
    size_t inside_left, inside_right, outside_left, outside_right; /* beside the two */
    double step, across;                                           /* spacings, along and beside */
    bool row;                                                      /* along x */
};

/* Pressures and gaps over the largest pressure: an edge does not depend on the unit, and squares
 * stay in range. p^2 in contact, -(3 gap/4)^(2/3) elsewhere; gaps are in the grid's lengths. */
static void fill_rise(const struct grid *grid, const struct contact_state *state, double *rise) {
    size_t n = grid_points(grid);
    double most = 0;
    for (size_t i = 0; i < n; i++)
        most = fmax(most, state->p[i]);
    for (size_t i = 0; i < n; i++) {
        double open = most > 0 ? cbrt(0.75 * fmax(0, state->opening[i]) / most) : 1;
        rise[i] = state->p[i] > 0 ? (state->p[i] / most) * (state->p[i] / most) : -open * open;
    }
}

/* One crossing as it is found. Distances are true ones, in spacings along the normal. */
struct found {
    struct edge_direction direction;
    double cosine;  /* between the line and the normal, without its sign */
    double spacing; /* along the normal, the grid's length */
    double scale;   /* 1/c^(2/3) */
    double apart;   /* of the two nodes */
    double field;   /* distance of the inside node by its pressure, without the bend */
    double inside;  /* of the inside node */
    double bent;    /* 1 - bend d there */
};

/* Where the edge lies for the direction and the bends so far. */
static void find_edge(const struct crossing *x, const struct edge_law *law, const double *rise,
                      struct found *f) {
    double sine = sqrt(fmax(0, 1 - f->cosine * f->cosine));
    double nx = x->row ? f->cosine : sine, ny = x->row ? sine : f->cosine;
    f->direction = edge_direction(law, atan2(ny, nx));
    f->spacing = hypot(f->cosine * x->step, sine * x->across);
    f->apart = f->cosine * x->step / f->spacing;
    double squared = rise[x->inside] / f->spacing / f->bent;
    double open = fmax(0, -rise[x->outside]) / f->spacing;
    f->scale = edge_scale(&f->direction, squared, open, f->apart, f->scale);
    f->field = squared * f->scale * f->scale * f->scale;
    f->inside = edge_inside(&f->direction, f->field);
}

/* Signed distance of a node to the edge. */
static double distance_of(const struct found *f, double rise) {
    return rise > 0 ? edge_inside(&f->direction, rise / f->spacing * f->scale * f->scale * f->scale)
                    : -edge_outside(&f->direction, -rise / f->spacing * f->scale);
}

/* Cosine of the gradient of the signed distance with the line. */
static void find_cosine(const struct crossing *x, const double *rise, struct found *f) {
    double along = f->cosine;
    double beside =
        (distance_of(f, rise[x->inside_left]) + distance_of(f, rise[x->outside_left]) -
         distance_of(f, rise[x->inside_right]) - distance_of(f, rise[x->outside_right])) *
        f->spacing / (4 * x->across);
    f->cosine = fmax(COSINE_LEAST, along / hypot(along, beside));
}

/* Bend by the next node further inside; in two nodes or one, that of a chord between two edges. */
static void find_bend(const struct crossing *x, const double *rise, struct found *f) {
    double inside = fmax(0, f->inside);
    bool chord = !(rise[x->before] > 0 && rise[x->far_before] > 0);
    if (chord) {
        double share = inside / f->apart;
        double length = (rise[x->before] > 0 ? 1 : 0) + 2 * share;
        f->bent = length > 0 ? fmax(BEND_MOST, 1 - share / length) : BEND_MOST;
    } else {
        double next = f->inside + f->apart, field = fmax(0, next);
        for (int a = 0; a < INVERSE_STEPS; a++)
            field = fmax(0, field + next - edge_inside(&f->direction, field));
        /* (1 - bend next)/(1 - bend inside): what the two pressures have beyond the law's. */
        double ratio = rise[x->before] / rise[x->inside] * f->field / fmax(field, 1e-9);
        double most = BEND_MOST / fmax(next, 0.05);
        double bend = (1 - ratio) / fmax(0.2, next - ratio * inside);
        f->bent = 1 - fmin(fmax(bend, -most), most) * inside;
    }
}

/* Gap over the largest pressure, from the rise of a node out of contact. */
static double gap_of(double rise) {
    double root = sqrt(fmax(0, -rise));
    return 4.0 / 3 * root * root * root;
}

/* Half the width, in steps, of a profile's patch of one node; NaN where the inside node is not
 * alone. */
static double lone_in_profile(const struct crossing *x, const double *rise) {
    if (rise[x->before] > 0)
        return NAN;
    return edge_lone(sqrt(rise[x->inside]) * x->step, gap_of(rise[x->before]),
                     gap_of(rise[x->outside]));
}

/* Half the area, in cells, of a surface's patch of one node: an ellipse that reaches no further
 * than the nodes beside it; NaN where the inside node is not alone. */
static double lone_in_surface(const struct crossing *x, const double *rise) {
    if (rise[x->before] > 0 || rise[x->inside_left] > 0 || rise[x->inside_right] > 0)
        return NAN;
    double force = sqrt(rise[x->inside]) * x->step * x->across;
    double along =
        edge_lone_axis(force / x->step, gap_of(rise[x->before]), gap_of(rise[x->outside]));
    double beside = edge_lone_axis(force / x->across, gap_of(rise[x->inside_left]),
                                   gap_of(rise[x->inside_right]));
    return fmin(1, 0.5 * PI * along * beside);
}

/* Returns the derivative of the edge's distance by the mean pressure: that of a pressure which
 * grows at one c. */
static double find_rate(const struct crossing *x, const struct contact_state *state,
                        const struct found *f) {
    if (state->tangent == NULL)
        return 0;
    return edge_inside_slope(&f->direction, f->field) * state->tangent[x->inside] /
           state->p[x->inside];
}

/* Adds to the sums, in cells, what the edge of a crossing encloses beyond the cells of the nodes in
 * contact. */
static void add_crossing(const struct crossing *x, const struct edge_law *law,
                         const struct contact_state *state, const double *rise, bool profile,
                         struct edge_area *sums) {
    double lone = profile ? lone_in_profile(x, rise) : lone_in_surface(x, rise);
    if (!isnan(lone)) { /* met once on a side: twice in a profile, four times in a surface */
        sums->straight += profile ? lone - 0.5 : (lone - 0.5) / 2;
        return;
    }
    struct found f = {.cosine = 1, .bent = 1};
    double part = 1;
    for (int a = 0; a < ROUNDS; a++) {
        find_edge(x, law, rise, &f);
        part = f.cosine * f.cosine;
        if (a + 1 == ROUNDS)
            break;
        find_bend(x, rise, &f);
        if (!profile)
            find_cosine(x, rise, &f);
    }
    double share = fmin(fmax(f.inside / f.apart, -1), 2);
    sums->straight += part * (share - 0.5);
    sums->rate += part * find_rate(x, state, &f) / f.apart;
}

/* One of the two families of grid lines: nodes of a line are `along` apart, lines `beside`. */
struct family {
    size_t lines, nodes;  /* lines, nodes of a line */
    size_t along, beside; /* steps in the array */
    double step, across;  /* lengths */
    bool row;
};

static size_t node_at(const struct family *f, size_t line, size_t node) {
    return line % f->lines * f->beside + node % f->nodes * f->along;
}

/* From node a of the line to node b, one step forth or back (nodes counted modulo the line). */
static struct crossing crossing_at(const struct family *f, size_t line, size_t a, size_t b) {
    size_t back = a + 2 * f->nodes - (b - a);
    return (struct crossing){.inside = node_at(f, line, a),
                             .outside = node_at(f, line, b),
                             .before = node_at(f, line, back),
                             .far_before = node_at(f, line, back - (b - a)),
                             .inside_left = node_at(f, line + 1, a),
                             .outside_left = node_at(f, line + 1, b),
                             .inside_right = node_at(f, line + f->lines - 1, a),
                             .outside_right = node_at(f, line + f->lines - 1, b),
                             .step = f->step,
                             .across = f->across,
                             .row = f->row};
}

static void add_family(const struct family *f, const struct edge_law *law,
                       const struct contact_state *state, const double *rise,
                       struct edge_area *sums) {
    for (size_t line = 0; line < f->lines; line++)
        for (size_t node = 0; node < f->nodes; node++) {
            bool first = rise[node_at(f, line, node)] > 0;
            bool second = rise[node_at(f, line, node + 1)] > 0;
            if (first == second)
                continue;
            size_t a = f->nodes + node + (first ? 0 : 1), b = f->nodes + node + (first ? 1 : 0);
            struct crossing crossing = crossing_at(f, line, a, b);
            add_crossing(&crossing, law, state, rise, f->lines == 1, sums);
        }
}

/* Patches less holes, by the corners that their boundary turns: cells with one corner in contact
 * turn it by a quarter, cells with three back by one; and the sides of the boundary. */
static void count_boundary(const struct grid *grid, const double *p, struct edge_area *sums) {
    size_t nx = grid->nx, ny = grid->ny;
    for (size_t j = 0; j < ny; j++)
        for (size_t i = 0; i < nx; i++) {
            size_t i2 = (i + 1) % nx, j2 = (j + 1) % ny;
            bool in = p[j * nx + i] > 0, right = p[j * nx + i2] > 0, back = p[j2 * nx + i] > 0;
            int corners = in + right + back + (p[j2 * nx + i2] > 0);
            sums->patches += corners == 1 ? 0.25 : corners == 3 ? -0.25 : 0;
            sums->sides += (in != right) + (in != back);
        }
}

void edge_area_measure(const struct edge_law *law, const struct grid *grid,
                       const struct contact_state *state, double *rise, struct edge_area *out) {
    double dx = grid_dx(grid), dy = grid_dy(grid), n = (double)grid_points(grid);
    struct family rows = {grid->ny, grid->nx, 1, grid->nx, dx, dy, true};
    struct family columns = {grid->nx, grid->ny, grid->nx, 1, dy, dx, false};
    fill_rise(grid, state, rise);
    *out = (struct edge_area){0};
    for (size_t i = 0; i < grid_points(grid); i++)
        out->nodes += rise[i] > 0;
    out->straight = out->nodes;
    add_family(&rows, law, state, rise, out);
    if (!grid_is_profile(grid)) {
        add_family(&columns, law, state, rise, out);
        count_boundary(grid, state->p, out);
    }
    *out = (struct edge_area){.straight = out->straight / n,
                              .rate = out->rate / n,
                              .patches = out->patches / n,
                              .nodes = out->nodes / n,
                              .sides = out->sides / n};
}
