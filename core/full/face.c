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

/* Integrates a value, linear along the cell, over positions x. */
static double line_integral(const double *x, const double *value) {
    return (x[1] - x[0]) * (value[0] + value[1]) / 2;
}

/* Returns the integral over the unit square of value (dx/ds dy/dt - dy/ds dx/dt), all three
 * bilinear in s and t: of degree 2 in each, which two Gauss points along each integrate exactly. */
static double square_integral(const double *x, const double *y, const double *value) {
    static const double POINT[2] = {0.21132486540518712, 0.78867513459481288};
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
