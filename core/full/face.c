#include "core/full/face.h"
#include "core/sum.h"
#include <math.h>

/* Each cell counts once for each of its corners in contact: the integral of a shape function is the
 * same for all corners where the cell is a parallelogram, and nearly so elsewhere. */
double face_contact_stretch(const struct mesh *mesh, const double *u, const bool *active) {
    struct sum now = {0};
    size_t corners = 0, nx = mesh->level[0].nx, ny = mesh->level[0].ny;
    for (size_t j = 0; j < ny; j++)
        for (size_t i = 0; i < nx; i++) {
            size_t right = (i + 1) % nx, back = (j + 1) % ny;
            int touching = active[j * nx + i] + active[j * nx + right];
            if (mesh->dimension == 3)
                touching += active[back * nx + i] + active[back * nx + right];
            corners += (size_t)touching;
            sum_add(&now, touching * mesh_stretch(mesh, u, j, i));
        }
    return corners > 0 ? sum_value(&now) / (double)corners : NAN;
}

double face_open_stretch(const struct mesh *mesh, size_t nodes, double stretch) {
    double all = (double)mesh->face, touching = (double)nodes;
    return nodes > 0 && touching < all ? (all - stretch * touching) / (all - touching) : 1;
}

bool face_folds(const struct mesh *mesh, const double *u) {
    const struct level *face = &mesh->level[0];
    for (size_t j = 0; j < face->ny; j++)
        for (size_t i = 0; i < face->nx; i++)
            if (mesh_stretch(mesh, u, j, i) <= 0)
                return true;
    return false;
}

double face_stretch_change(const struct mesh *mesh, const double *u, const double *before) {
    const struct level *face = &mesh->level[0];
    double most = 0;
    for (size_t j = 0; j < face->ny; j++)
        for (size_t i = 0; i < face->nx; i++)
            most = fmax(most, fabs(mesh_stretch(mesh, u, j, i) - mesh_stretch(mesh, before, j, i)));
    return most;
}

double face_largest_move(const struct mesh *mesh, const double *change) {
    const size_t d = (size_t)mesh->dimension;
    double most = 0;
    for (size_t axis = 0; axis < d; axis++) {
        struct sum sum = {0};
        for (size_t node = 0; node < mesh->face && axis + 1 < d; node++)
            sum_add(&sum, change[d * node + axis]);
        double mean = sum_value(&sum) / (double)mesh->face;
        for (size_t node = 0; node < mesh->face; node++)
            most = fmax(most, fabs(change[d * node + axis] - mean));
    }
    return most;
}

/* A cell of the face; values are by corner, in the order of element.h. Of profiles the second half
 * is 0. */
struct cell {
    double x[4], y[4];   /* positions */
    double dx[4], dy[4]; /* their changes */
    double gap[4], dgap[4];
};

/* Returns component k of a node's displacement; 0 for u = NULL, and across profiles. */
static double sideways(const struct mesh *mesh, const double *u, size_t node, int k) {
    return u != NULL && k < mesh->dimension - 1 ? u[node * (size_t)mesh->dimension + (size_t)k] : 0;
}

static struct cell cell_of(const struct mesh *mesh, const double *u, const double *gap,
                           const double *change, size_t j, size_t i) {
    const struct level *face = &mesh->level[0];
    struct cell cell = {0};
    for (size_t a = 0; a < (size_t)1 << (mesh->dimension - 1); a++) {
        size_t node = level_node(face, j + (a >> 1), i + (a & 1));
        cell.x[a] = (double)(a & 1) + sideways(mesh, u, node, 0);
        cell.y[a] = (double)(a >> 1) * mesh->across + sideways(mesh, u, node, 1);
        cell.gap[a] = gap[node];
        if (change == NULL)
            continue;
        cell.dx[a] = u != NULL ? sideways(mesh, change, node, 0) : 0;
        cell.dy[a] = u != NULL ? sideways(mesh, change, node, 1) : 0;
        cell.dgap[a] = change[mesh_vertical(mesh, node)];
    }
    return cell;
}

/* Two Gauss points along an axis of the unit square, of weight 1/2 each. */
static const double POINT[2] = {0.21132486540518712, 0.78867513459481288};

/* Integrates a value, linear along the cell, over positions x. */
static double line_integral(const double *x, const double *value) {
    return (x[1] - x[0]) * (value[0] + value[1]) / 2;
}

/* Returns the integral over the unit square of value (dx/ds dy/dt - dy/ds dx/dt), all three
 * bilinear in s and t: of degree 2 in each, which two Gauss points along each integrate exactly. */
static double square_integral(const double *x, const double *y, const double *value) {
    double sum = 0;
    for (int q = 0; q < 4; q++) {
        double s = POINT[q & 1], t = POINT[q >> 1];
        double xs = (1 - t) * (x[1] - x[0]) + t * (x[3] - x[2]);
        double ys = (1 - t) * (y[1] - y[0]) + t * (y[3] - y[2]);
        double xt = (1 - s) * (x[2] - x[0]) + s * (x[3] - x[1]);
        double yt = (1 - s) * (y[2] - y[0]) + s * (y[3] - y[1]);
        double here =
            (1 - t) * ((1 - s) * value[0] + s * value[1]) + t * ((1 - s) * value[2] + s * value[3]);
        sum += here * (xs * yt - ys * xt) / 4;
    }
    return sum;
}

double face_mean_gap(const struct mesh *mesh, const double *u, const double *gap) {
    struct sum sum = {0};
    for (size_t j = 0; j < mesh->level[0].ny; j++)
        for (size_t i = 0; i < mesh->level[0].nx; i++) {
            struct cell c = cell_of(mesh, u, gap, NULL, j, i);
            sum_add(&sum, mesh->dimension == 2 ? line_integral(c.x, c.gap)
                                               : square_integral(c.x, c.y, c.gap));
        }
    return sum_value(&sum) / ((double)mesh->face * mesh->across);
}

double face_mean_gap_change(const struct mesh *mesh, const double *u, const double *gap,
                            const double *change) {
    struct sum sum = {0};
    for (size_t j = 0; j < mesh->level[0].ny; j++)
        for (size_t i = 0; i < mesh->level[0].nx; i++) {
            struct cell c = cell_of(mesh, u, gap, change, j, i);
            if (mesh->dimension == 2)
                sum_add(&sum, line_integral(c.x, c.dgap) + line_integral(c.dx, c.gap));
            else
                sum_add(&sum, square_integral(c.x, c.y, c.dgap) +
                                  square_integral(c.dx, c.y, c.gap) +
                                  square_integral(c.x, c.dy, c.gap));
        }
    return sum_value(&sum) / ((double)mesh->face * mesh->across);
}

/* --- the face with its slopes --- */

/* Fills the positions of a cell's corners, in the order of element.h. */
static void corners_of(const struct mesh *mesh, const double *u, size_t j, size_t i,
                       double corner[4][3]) {
    for (size_t a = 0; a < (size_t)1 << (mesh->dimension - 1); a++) {
        size_t node = level_node(&mesh->level[0], j + (a >> 1), i + (a & 1));
        corner[a][0] = (double)(a & 1) + sideways(mesh, u, node, 0);
        corner[a][1] = (double)(a >> 1) * mesh->across + sideways(mesh, u, node, 1);
        corner[a][2] = mesh->height[node] + u[mesh_vertical(mesh, node)];
    }
}

static void cross(const double *a, const double *b, double *out) {
    for (int k = 0; k < 3; k++)
        out[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

static double length_of(const double *a) {
    return sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
}

/* Fills the integrals of the shape functions over a cell. */
static void true_areas(const struct mesh *mesh, const double *u, size_t j, size_t i, double *area) {
    double c[4][3] = {{0}}, along[3], back[3], normal[3];
    corners_of(mesh, u, j, i, c);
    if (mesh->dimension == 2) {
        area[0] = area[1] = hypot(c[1][0] - c[0][0], c[1][2] - c[0][2]) / 2;
        return;
    }
    area[0] = area[1] = area[2] = area[3] = 0;
    for (int q = 0; q < 4; q++) {
        double s = POINT[q & 1], t = POINT[q >> 1];
        for (int k = 0; k < 3; k++) {
            along[k] = (1 - t) * (c[1][k] - c[0][k]) + t * (c[3][k] - c[2][k]);
            back[k] = (1 - s) * (c[2][k] - c[0][k]) + s * (c[3][k] - c[1][k]);
        }
        cross(along, back, normal);
        for (int a = 0; a < 4; a++)
            area[a] += length_of(normal) / 4 * ((a & 1) != 0 ? s : 1 - s) * (a > 1 ? t : 1 - t);
    }
}

struct face_tilt face_measure_tilt(const struct mesh *mesh, const double *u, const bool *active) {
    const struct level *face = &mesh->level[0];
    const size_t corners = (size_t)1 << (mesh->dimension - 1);
    struct sum all = {0}, touching = {0}, projected = {0};
    double area[4];
    for (size_t j = 0; j < face->ny; j++)
        for (size_t i = 0; i < face->nx; i++) {
            size_t count = 0;
            true_areas(mesh, u, j, i, area);
            for (size_t a = 0; a < corners; a++) {
                sum_add(&all, area[a]);
                if (!active[level_node(face, j + (a >> 1), i + (a & 1))])
                    continue;
                count++;
                sum_add(&touching, area[a]);
            }
            sum_add(&projected, (double)count * mesh_stretch(mesh, u, j, i));
        }
    double cell = mesh->across / (double)corners;
    return (struct face_tilt){.face = sum_value(&all) / ((double)mesh->face * mesh->across) - 1,
                              .contact =
                                  sum_value(&projected) != 0
                                      ? sum_value(&touching) / (cell * sum_value(&projected)) - 1
                                      : (double)NAN};
}

double face_mean_gap_current(const struct mesh *mesh, const double *u, const double *gap) {
    const struct level *face = &mesh->level[0];
    struct sum all = {0}, sum = {0};
    double area[4];
    for (size_t j = 0; j < face->ny; j++)
        for (size_t i = 0; i < face->nx; i++) {
            true_areas(mesh, u, j, i, area);
            for (size_t a = 0; a < (size_t)1 << (mesh->dimension - 1); a++) {
                sum_add(&all, area[a]);
                sum_add(&sum, area[a] * gap[level_node(face, j + (a >> 1), i + (a & 1))]);
            }
        }
    return sum_value(&sum) / sum_value(&all);
}

/* Adds the unit normal of a cell, which points up where the cell is not turned over. */
static void add_normal(const struct mesh *mesh, const double *u, size_t j, size_t i, double *sum) {
    double c[4][3] = {{0}}, one[3], other[3] = {0, 1, 0}, normal[3];
    bool surface = mesh->dimension == 3;
    corners_of(mesh, u, j, i, c);
    for (int k = 0; k < 3; k++) {
        one[k] = surface ? c[3][k] - c[0][k] : c[1][k] - c[0][k];
        other[k] = surface ? c[2][k] - c[1][k] : other[k];
    }
    cross(one, other, normal);
    double length = length_of(normal);
    for (int k = 0; k < 3; k++)
        sum[k] += normal[k] / length;
}

void face_turn_gaps(const struct mesh *mesh, const double *u, const bool *active, double *gap) {
    const size_t nx = mesh->level[0].nx, ny = mesh->level[0].ny;
    for (size_t j = 0; j < ny; j++)
        for (size_t i = 0; i < nx; i++) {
            double normal[3] = {0};
            if (active[j * nx + i])
                continue;
            for (size_t a = 0; a < (size_t)1 << (mesh->dimension - 1); a++)
                add_normal(mesh, u, (j + ny - (a >> 1)) % ny, (i + nx - (a & 1)) % nx, normal);
            double cosine = normal[2] / length_of(normal);
            gap[j * nx + i] /= cosine > 0 ? cosine : (double)NAN;
        }
}
