#include "core/full/element.h"
#include "core/vectors.h"
#include <math.h>
#include <string.h>

#define INLINE static inline __attribute__((always_inline))

/* --- shape --- */

/* dN_a/dxi_k at a point of [-1, 1]^d. */
INLINE void parent_gradients(int d, const double at[3], double gradient[8][3]) {
    for (int a = 0; a < 1 << d; a++)
        for (int k = 0; k < d; k++) {
            double product = 1;
            for (int l = 0; l < d; l++) {
                double side = a >> l & 1 ? 0.5 : -0.5;
                product *= l == k ? side : 0.5 + side * at[l];
            }
            gradient[a][k] = product;
        }
}

INLINE double determinant(int d, double m[3][3]) {
    if (d == 2)
        return m[0][0] * m[1][1] - m[0][1] * m[1][0];
    return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
           m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
           m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

/* jacobian[k][l] = dX_l/dxi_k */
INLINE void jacobian_at(int d, const double at[3], double position[8][3], double parent[8][3],
                        double jacobian[3][3]) {
    parent_gradients(d, at, parent);
    for (int k = 0; k < d; k++)
        for (int l = 0; l < d; l++) {
            jacobian[k][l] = 0;
            for (int a = 0; a < 1 << d; a++)
                jacobian[k][l] += parent[a][k] * position[a][l];
        }
}

INLINE void invert(int d, double m[3][3], double det, double out[3][3]) {
    if (d == 2) {
        out[0][0] = m[1][1] / det;
        out[1][1] = m[0][0] / det;
        out[0][1] = -m[0][1] / det;
        out[1][0] = -m[1][0] / det;
        return;
    }
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) {
            int i1 = (i + 1) % 3, i2 = (i + 2) % 3, k1 = (k + 1) % 3, k2 = (k + 2) % 3;
            out[k][i] = (m[i1][k1] * m[i2][k2] - m[i1][k2] * m[i2][k1]) / det;
        }
}

INLINE double quality_of(int d, double position[8][3]) {
    double least = 1;
    for (int corner = 0; corner < 1 << d; corner++) {
        double at[3], parent[8][3], jacobian[3][3], edges = 1;
        for (int k = 0; k < d; k++)
            at[k] = corner >> k & 1 ? 1 : -1;
        jacobian_at(d, at, position, parent, jacobian);
        for (int k = 0; k < d; k++) {
            double square = 0;
            for (int l = 0; l < d; l++)
                square += jacobian[k][l] * jacobian[k][l];
            edges *= sqrt(square);
        }
        least = fmin(least, determinant(d, jacobian) / edges);
    }
    return least;
}

INLINE bool shape_make(int d, double position[8][3], struct element_shape *out) {
    static const double GAUSS = 0.57735026918962576; /* 1/sqrt(3) */
    out->volume = 0;
    bool positive = true;
    for (int q = 0; q < 1 << d; q++) {
        double at[3], parent[8][3], jacobian[3][3], inverse[3][3];
        for (int k = 0; k < d; k++)
            at[k] = q >> k & 1 ? GAUSS : -GAUSS;
        jacobian_at(d, at, position, parent, jacobian);
        double det = determinant(d, jacobian);
        positive = positive && det > 0;
        invert(d, jacobian, det, inverse);
        for (int a = 0; a < 1 << d; a++)
            for (int l = 0; l < d; l++) {
                out->gradient[q][a][l] = 0;
                for (int k = 0; k < d; k++)
                    out->gradient[q][a][l] += inverse[l][k] * parent[a][k];
            }
        out->weight[q] = det;
        out->volume += det;
    }
    return positive;
}

bool element_shape_make(int dimension, double position[8][3], struct element_shape *out) {
    return dimension == 2 ? shape_make(2, position, out) : shape_make(3, position, out);
}

double element_quality(int dimension, double position[8][3]) {
    return dimension == 2 ? quality_of(2, position) : quality_of(3, position);
}

/* --- energy, forces, stiffness --- */

struct field {
    struct strained point[8];
    double gradient[8][8][3]; /* in space */
    double bulk[8][3];        /* V d growth/du */
    double growth;            /* mean of the points' dilatation */
};

/* Of the dilatation at a point by a node's displacement along axis i: for J - 1, J grad; for tr E,
 * F grad_X; for tr e, grad_X. grad: in space. */
INLINE double swelling(int d, enum kinematics kinematics, const struct strained *point,
                       const double h[3], const double grad_reference[3], const double grad[3],
                       int i) {
    if (kinematics == KINEMATICS_HENCKY)
        return (1 + point->dilatation) * grad[i];
    double sum = grad_reference[i];
    for (int k = 0; k < d && kinematics == KINEMATICS_ST_VENANT; k++)
        sum += h[k] * grad_reference[k];
    return sum;
}

INLINE bool field_make(int d, const struct solid *solid, const struct element_shape *shape,
                       double u[8][3], struct field *f) {
    double growth = 0;
    memset(f->bulk, 0, sizeof f->bulk);
    for (int q = 0; q < 1 << d; q++) {
        struct strained *point = &f->point[q];
        double h[3][3] = {{0}};
        for (int a = 0; a < 1 << d; a++)
            for (int i = 0; i < d; i++)
                for (int k = 0; k < d; k++)
                    h[i][k] += u[a][i] * shape->gradient[q][a][k];
        if (!solid_strain(d, solid, h, point))
            return false;
        growth += shape->weight[q] * point->dilatation;
        for (int a = 0; a < 1 << d; a++)
            for (int i = 0; i < d; i++) {
                double sum = 0;
                for (int k = 0; k < d; k++)
                    sum += shape->gradient[q][a][k] * point->inverse[k][i];
                f->gradient[q][a][i] = sum;
            }
        for (int a = 0; a < 1 << d; a++)
            for (int i = 0; i < d; i++)
                f->bulk[a][i] +=
                    shape->weight[q] * swelling(d, solid->kinematics, point, h[i],
                                                shape->gradient[q][a], f->gradient[q][a], i);
    }
    f->growth = growth / shape->volume;
    return solid->kinematics == KINEMATICS_ST_VENANT || f->growth > -1;
}

/* Of the mean dilatation: its energy over V, the pull outward and what it adds to the stiffness,
 * times V, all by its growth; the slope of its strain e by growth, and the pressure that it
 * makes. */
struct bulk {
    double energy, pull, stiffness, slope, bound;
};

INLINE struct bulk bulk_of(const struct solid *solid, double growth, const double *pressure) {
    bool hencky = solid->kinematics == KINEMATICS_HENCKY;
    double strain = hencky ? log1p(growth) : growth, slope = hencky ? 1 / (1 + growth) : 1;
    double bound = solid->mean * strain, p = pressure != NULL ? *pressure : bound;
    return (struct bulk){.energy = bound * strain / 2,
                         .pull = p * slope,
                         .stiffness = (solid->mean - (hencky ? p : 0)) * slope * slope,
                         .slope = slope,
                         .bound = bound};
}

INLINE void forces(int d, const struct element_shape *shape, const struct field *f,
                   const struct bulk *bulk, double *force) {
    for (int a = 0; a < 1 << d; a++)
        for (int i = 0; i < d; i++)
            force[a * d + i] = bulk->pull * f->bulk[a][i];
    for (int q = 0; q < 1 << d; q++)
        for (int a = 0; a < 1 << d; a++)
            for (int i = 0; i < d; i++) {
                double sum = 0;
                for (int k = 0; k < d; k++)
                    sum += f->point[q].stress[i][k] * f->gradient[q][a][k];
                force[a * d + i] += shape->weight[q] * sum;
            }
}

/* Of nodes a and b, [b][i][j][a]: the innermost loops run over a. */
typedef double blocks[ELEMENT_NODES][3][3][ELEMENT_NODES];

/* Adds one Gauss point: gradient . moduli . gradient. */
INLINE void stiffness_add(int d, double weight, double gradient[8][3], double moduli[9][9],
                          blocks out) {
    double across[3][ELEMENT_NODES] = {{0}};
    for (int a = 0; a < 1 << d; a++)
        for (int k = 0; k < d; k++)
            across[k][a] = gradient[a][k];
    for (int b = 0; b < 1 << d; b++) {
        double t[9][3] = {{0}};
        for (int ik = 0; ik < d * d; ik++)
            for (int j = 0; j < d; j++) {
                double sum = 0;
                for (int l = 0; l < d; l++)
                    sum += moduli[ik][j * d + l] * gradient[b][l];
                t[ik][j] = weight * sum;
            }
        for (int i = 0; i < d; i++)
            for (int j = 0; j < d; j++)
                for (int a = 0; a < 1 << d; a++) {
                    double sum = 0;
                    for (int k = 0; k < d; k++)
                        sum += across[k][a] * t[i * d + k][j];
                    out[b][i][j][a] += sum;
                }
    }
}

INLINE void stiffnesses(int d, const struct solid *solid, const struct element_shape *shape,
                        struct field *f, const struct bulk *bulk,
                        double (*stiffness)[ELEMENT_FREEDOMS]) {
    blocks sum;
    for (int b = 0; b < 1 << d; b++)
        for (int i = 0; i < d; i++)
            for (int j = 0; j < d; j++)
                for (int a = 0; a < 1 << d; a++)
                    sum[b][i][j][a] =
                        bulk->stiffness / shape->volume * f->bulk[a][i] * f->bulk[b][j];
    for (int q = 0; q < 1 << d; q++) {
        double moduli[9][9];
        solid_moduli(d, solid, &f->point[q], bulk->pull, moduli);
        stiffness_add(d, shape->weight[q], f->gradient[q], moduli, sum);
    }
    for (int b = 0; b < 1 << d; b++)
        for (int a = 0; a <= b; a++)
            for (int i = 0; i < d; i++)
                for (int j = 0; j < d; j++)
                    stiffness[a * d + i][b * d + j] = stiffness[b * d + j][a * d + i] =
                        sum[b][i][j][a];
}

INLINE bool evaluate(int d, const struct solid *solid, const struct element_shape *shape,
                     double u[8][3], const double *pressure, double *energy, double *force,
                     double (*stiffness)[ELEMENT_FREEDOMS], struct element_bulk *out) {
    struct field f;
    if (!field_make(d, solid, shape, u, &f))
        return false;
    struct bulk bulk = bulk_of(solid, f.growth, pressure);
    if (energy != NULL) {
        *energy = shape->volume * bulk.energy;
        for (int q = 0; q < 1 << d; q++)
            *energy += shape->weight[q] * f.point[q].energy;
    }
    if (force != NULL)
        forces(d, shape, &f, &bulk, force);
    if (stiffness != NULL)
        stiffnesses(d, solid, shape, &f, &bulk, stiffness);
    if (out != NULL) {
        out->stiffness = solid->mean / shape->volume;
        out->bound = bulk.bound;
        for (int a = 0; a < 1 << d; a++)
            for (int i = 0; i < d; i++)
                out->gradient[a * d + i] = bulk.slope * f.bulk[a][i];
    }
    return true;
}

WIDE_VECTORS bool element_evaluate(int dimension, const struct solid *solid,
                                   const struct element_shape *shape, double u[8][3],
                                   const double *pressure, double *energy, double *force,
                                   double (*stiffness)[ELEMENT_FREEDOMS],
                                   struct element_bulk *bulk) {
    return dimension == 2 ? evaluate(2, solid, shape, u, pressure, energy, force, stiffness, bulk)
                          : evaluate(3, solid, shape, u, pressure, energy, force, stiffness, bulk);
}
