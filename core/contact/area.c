/* Edges are found by edge.h on every grid line that crosses one. On a line at an angle theta to the
 * edge's normal the gap counts as gap/cos theta; the angle is that of the gradient of the signed
 * distance to the edge, which the two linear quantities p^2 and (3 gap/4)^(2/3) are. */
#include "core/contact/area.h"
#include "core/contact/edge.h"
#include <math.h>
#include <stdlib.h>

static const double PI = 3.14159265358979323846;
static const double PERIMETER = 0.11811415975623911; /* (pi - 1 + ln 2)/24 */
static const double COSINE_LEAST = 0.1;
enum { ANGLE_STEPS = 4 };

struct area_workspace {
    struct grid grid;
    struct edge_law rows, columns;
    double *rise; /* grid_points: p^2 in contact, -(3 gap/4)^(2/3) elsewhere, scaled */
};

int area_workspace_create(struct area_workspace **out, const struct compliance *compliance,
                          struct error *err) {
    const struct grid *grid = &compliance->grid;
    size_t n = grid_points(grid);
    struct area_workspace *workspace = array_create(1, sizeof *workspace);
    if (workspace != NULL)
        workspace->rise = array_create(n, sizeof *workspace->rise);
    if (workspace == NULL || workspace->rise == NULL) {
        area_workspace_destroy(&workspace);
        return error_memory(err, n * sizeof(double), "contact areas");
    }
    workspace->grid = *grid;
    int status = edge_law_make(grid, &compliance->block, false, &workspace->rows, err);
    workspace->columns = workspace->rows;
    if (status == 0 && !grid_is_profile(grid) && grid_dx(grid) != grid_dy(grid))
        status = edge_law_make(grid, &compliance->block, true, &workspace->columns, err);
    if (status != 0)
        area_workspace_destroy(&workspace);
    *out = workspace;
    return status;
}

void area_workspace_destroy(struct area_workspace **workspace) {
    if (*workspace == NULL)
        return;
    free((*workspace)->rise);
    free(*workspace);
    *workspace = NULL;
}

/* Pressures and gaps over the largest pressure: an edge does not depend on the unit, and squares
 * stay in range. */
static void fill_rise(struct area_workspace *workspace, const double *p, const double *opening) {
    size_t n = grid_points(&workspace->grid);
    double most = 0;
    for (size_t i = 0; i < n; i++)
        most = fmax(most, p[i]);
    for (size_t i = 0; i < n; i++) {
        double open = most > 0 ? cbrt(0.75 * fmax(0, opening[i]) / most) : 1;
        workspace->rise[i] = p[i] > 0 ? (p[i] / most) * (p[i] / most) : -open * open;
    }
}

/* The nodes around one edge on a grid line, from a node in contact to its neighbour out of contact.
 */
struct crossing {
    size_t inside, outside;    /* the two nodes; all names below are nodes too */
    size_t before, far_before; /* further inside */
    size_t behind;             /* further outside */
    size_t inside_left, inside_right, outside_left, outside_right; /* beside the two */
    double step, across;                                           /* spacings, along and beside */
};

/* Returns the signed distance to the edge of constant c = 1/u, u2 = u^2 and ug = u^(2/3). */
static double distance(double rise, double u2, double ug) {
    return rise > 0 ? rise * u2 : rise * ug;
}

/* Returns the cosine, without its sign, of the angle between the grid line and the edge's normal.
 */
static double crossing_cosine(const struct crossing *x, const double *rise, double p1, double g1) {
    double cosine = 1;
    for (int a = 0; a < ANGLE_STEPS; a++) {
        double gap = g1 / cbrt(cosine * cosine);
        double s = edge_guess(p1, gap);
        double u2 = s * x->step / p1, ug = cbrt(u2);
        double along =
            (distance(rise[x->inside], u2, ug) - distance(rise[x->outside], u2, ug)) / x->step;
        double beside =
            (distance(rise[x->inside_left], u2, ug) + distance(rise[x->outside_left], u2, ug) -
             distance(rise[x->inside_right], u2, ug) - distance(rise[x->outside_right], u2, ug)) /
            (4 * x->across);
        cosine = fmax(COSINE_LEAST, fabs(along) / hypot(along, beside));
    }
    return cosine;
}

/* Returns the gap over the largest pressure, given the rise of a node out of contact. */
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

static double crossing_share(const struct crossing *x, const struct edge_law *law,
                             const double *rise, bool profile) {
    double lone = profile ? lone_in_profile(x, rise) : lone_in_surface(x, rise);
    /* In a profile another patch, two steps away, bends the gap beside this one. */
    bool crowded = profile && (rise[x->far_before] > 0 || rise[x->behind] > 0);
    if (!isnan(lone) && !crowded)
        return lone;
    double unit = cbrt(x->step);
    double p1 = rise[x->inside], g1 = fmax(0, -rise[x->outside]) / (unit * unit);
    if (!profile && g1 > 0) {
        double cosine = crossing_cosine(x, rise, p1, g1);
        g1 /= cbrt(cosine * cosine);
    }
    bool known = rise[x->before] > 0 && rise[x->far_before] > 0; /* in two nodes it does harm */
    double share = edge_share(law, p1, known ? rise[x->before] : 0, g1);
    /* For a node alone on its line no length is below 0 or below that of the patch of one node.
     * Elsewhere an edge may well lie before the node inside, which then has a small pressure. */
    return rise[x->before] > 0 ? share : fmax(fmax(0, lone), share);
}

/* One of the two families of grid lines: nodes of a line are `along` apart, lines `beside`. */
struct family {
    size_t lines, nodes;  /* lines, nodes of a line */
    size_t along, beside; /* steps in the array */
    double step, across;  /* lengths */
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
                             .behind = node_at(f, line, b + (b - a)),
                             .inside_left = node_at(f, line + 1, a),
                             .outside_left = node_at(f, line + 1, b),
                             .inside_right = node_at(f, line + f->lines - 1, a),
                             .outside_right = node_at(f, line + f->lines - 1, b),
                             .step = f->step,
                             .across = f->across};
}

/* Returns the share of all lines that is in contact. */
static double family_share(const struct family *f, const struct edge_law *law, const double *rise) {
    double steps = 0;
    for (size_t line = 0; line < f->lines; line++)
        for (size_t node = 0; node < f->nodes; node++) {
            bool first = rise[node_at(f, line, node)] > 0;
            bool second = rise[node_at(f, line, node + 1)] > 0;
            if (first && second) {
                steps += 1;
            } else if (first || second) {
                size_t a = f->nodes + node + (first ? 0 : 1), b = f->nodes + node + (first ? 1 : 0);
                struct crossing crossing = crossing_at(f, line, a, b);
                steps += crossing_share(&crossing, law, rise, f->lines == 1);
            }
        }
    return steps / ((double)f->lines * (double)f->nodes);
}

/* Counts the sides of nodes in contact that face open ones, along x and y. */
static void count_sides(const struct grid *grid, const double *p, size_t sides[2]) {
    size_t nx = grid->nx, ny = grid->ny;
    sides[0] = sides[1] = 0;
    for (size_t j = 0; j < ny; j++)
        for (size_t i = 0; i < nx; i++) {
            bool in = p[j * nx + i] > 0;
            sides[0] += in != (p[j * nx + (i + 1) % nx] > 0);
            sides[1] += in != (p[(j + 1) % ny * nx + i] > 0);
        }
}

static void count_nodes(const struct grid *grid, const double *p, struct contact_area *out) {
    size_t nx = grid->nx, ny = grid->ny, nodes = 0, all = 0, any = 0;
    for (size_t j = 0; j < ny; j++)
        for (size_t i = 0; i < nx; i++) {
            size_t i2 = (i + 1) % nx, j2 = (j + 1) % ny;
            bool a = p[j * nx + i] > 0, b = p[j * nx + i2] > 0;
            bool c = p[j2 * nx + i] > 0, d = p[j2 * nx + i2] > 0;
            nodes += a;
            all += a && b && c && d;
            any += a || b || c || d;
        }
    double n = (double)grid_points(grid);
    out->nodes = (double)nodes / n;
    out->lower = (double)all / n;
    out->upper = (double)any / n;
}

void contact_area(struct area_workspace *workspace, const double *p, const double *opening,
                  struct contact_area *out) {
    const struct grid *grid = &workspace->grid;
    double dx = grid_dx(grid), dy = grid_dy(grid);
    struct family rows = {grid->ny, grid->nx, 1, grid->nx, dx, dy};
    count_nodes(grid, p, out);
    fill_rise(workspace, p, opening);
    out->edges = family_share(&rows, &workspace->rows, workspace->rise);
    out->perimeter = NAN;
    if (grid_is_profile(grid))
        return;
    struct family columns = {grid->nx, grid->ny, grid->nx, 1, dy, dx};
    size_t sides[2];
    out->edges = 0.5 * (out->edges + family_share(&columns, &workspace->columns, workspace->rise));
    count_sides(grid, p, sides);
    /* A side across x is dy long, and the correction acts along x over dx; for sides across y it is
     * the other way round. */
    double missed = PERIMETER * (double)(sides[0] + sides[1]) / (double)grid_points(grid);
    out->perimeter = out->nodes - missed;
}
