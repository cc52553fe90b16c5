#include "core/full/element.h"
#include "core/vectors.h"
#include <math.h>
#include <stddef.h>

/* --- shape --- */

/* Fills parent[a][k] = dN_a/dxi_k at the points (+-reach, ...). */
INLINE void parent_gradients(int d, double reach, pointwise parent[8][3]) {
    for (int a = 0; a < 1 << d; a++)
        for (int k = 0; k < d; k++)
            for (int q = 0; q < 1 << d; q++) {
                double product = (a >> k & 1) != 0 ? 0.5 : -0.5;
                for (int l = 0; l < d; l++)
                    if (l != k)
                        product *= (((a ^ q) >> l & 1) != 0 ? 1 - reach : 1 + reach) / 2;
                parent[a][k][q] = product;
            }
}

/* Fills parent at those points, and jacobian[k][l] = dX_l/dxi_k. */
INLINE void jacobians(int d, double reach, double position[8][3], pointwise parent[8][3],
                      pointwise jacobian[3][3]) {
    parent_gradients(d, reach, parent);
    for (int k = 0; k < d; k++)
        for (int l = 0; l < d; l++)
            for (int q = 0; q < 1 << d; q++) {
                double sum = 0;
                for (int a = 0; a < 1 << d; a++)
                    sum += parent[a][k][q] * position[a][l];
                jacobian[k][l][q] = sum;
            }
}

/* Fills adjoint[l][k], the determinant times the inverse. */
INLINE void invert(int d, pointwise m[3][3], pointwise determinant, pointwise adjoint[3][3]) {
    for (int q = 0; q < 1 << d; q++) {
        if (d == 2) {
            adjoint[0][0][q] = m[1][1][q];
            adjoint[1][1][q] = m[0][0][q];
            adjoint[0][1][q] = -m[0][1][q];
            adjoint[1][0][q] = -m[1][0][q];
        } else {
            for (int i = 0; i < 3; i++)
                for (int k = 0; k < 3; k++) {
                    int i1 = (i + 1) % 3, i2 = (i + 2) % 3, k1 = (k + 1) % 3, k2 = (k + 2) % 3;
                    adjoint[k][i][q] = m[i1][k1][q] * m[i2][k2][q] - m[i1][k2][q] * m[i2][k1][q];
                }
        }
        double sum = 0;
        for (int k = 0; k < d; k++)
            sum += m[0][k][q] * adjoint[k][0][q];
        determinant[q] = sum;
    }
}

INLINE double quality_of(int d, double position[8][3]) {
    pointwise parent[8][3], jacobian[3][3], adjoint[3][3], determinant;
    double least = 1;
    jacobians(d, 1, position, parent, jacobian);
    invert(d, jacobian, determinant, adjoint);
    for (int q = 0; q < 1 << d; q++) {
        double edges = 1;
        for (int k = 0; k < d; k++) {
            double square = 0;
            for (int l = 0; l < d; l++)
                square += jacobian[k][l][q] * jacobian[k][l][q];
            edges *= sqrt(square);
        }
        least = fmin(least, determinant[q] / edges);
    }
    return least;
}

INLINE bool shape_make(int d, double position[8][3], struct element_shape *out) {
    static const double GAUSS = 0.57735026918962576; /* 1/sqrt(3) */
    pointwise parent[8][3], jacobian[3][3], adjoint[3][3], over;
    jacobians(d, GAUSS, position, parent, jacobian);
    invert(d, jacobian, out->weight, adjoint);
    for (int q = 0; q < 1 << d; q++)
        over[q] = 1 / out->weight[q];
    for (int a = 0; a < 1 << d; a++)
        for (int l = 0; l < d; l++)
            for (int q = 0; q < 1 << d; q++) {
                double sum = 0;
                for (int k = 0; k < d; k++)
                    sum += adjoint[l][k][q] * parent[a][k][q];
                out->gradient[a][l][q] = sum * over[q];
            }
    bool positive = true;
    out->volume = 0;
    for (int q = 0; q < 1 << d; q++) {
        positive = positive && out->weight[q] > 0;
        out->volume += out->weight[q];
    }
    return positive;
}

WIDE_VECTORS bool element_shape_make(int dimension, double position[8][3],
                                     struct element_shape *out) {
    return dimension == 2 ? shape_make(2, position, out) : shape_make(3, position, out);
}

double element_quality(int dimension, double position[8][3]) {
    return dimension == 2 ? quality_of(2, position) : quality_of(3, position);
}

/* --- energy, forces, stiffness --- */

/* The node is the innermost index. */
typedef double nodes[ELEMENT_NODES];

struct field {
    struct strained point;
    pointwise gradient[8][3]; /* by deformed positions, [a][k][q] */
    nodes across[8][3];       /* the same, [q][k][a] */
    nodes growth_gradient[3]; /* [i][a]: V d growth/du of node a, component i */
    double growth;            /* mean over the element of strained.dilatation */
};

/* Sets out[i][a] to the integral of tensor_ik grad_k N_a. */
INLINE void divergence(int d, const pointwise weight, pointwise tensor[3][3], nodes across[8][3],
                       nodes out[3]) {
    for (int i = 0; i < d; i++) {
        nodes sum = {0};
        for (int q = 0; q < 1 << d; q++)
            for (int k = 0; k < d; k++) {
                double part = weight[q] * tensor[i][k][q];
                for (int a = 0; a < 1 << d; a++)
                    sum[a] += part * across[q][k][a];
            }
        for (int a = 0; a < 1 << d; a++)
            out[i][a] = sum[a];
    }
}

/* Fills h[i][k] = du_i/dX_k. */
INLINE void displacement_gradient(int d, const struct element_shape *shape, double u[8][3],
                                  pointwise h[3][3]) {
    for (int i = 0; i < d; i++)
        for (int k = 0; k < d; k++)
            for (int q = 0; q < 1 << d; q++) {
                double sum = 0;
                for (int a = 0; a < 1 << d; a++)
                    sum += u[a][i] * shape->gradient[a][k][q];
                h[i][k][q] = sum;
            }
}

INLINE bool field_make(int d, const struct material *material, const struct element_shape *shape,
                       double u[8][3], struct field *f) {
    pointwise h[3][3];
    displacement_gradient(d, shape, u, h);
    if (!material_strain(d, material, h, &f->point))
        return false;
    double growth = 0;
    for (int q = 0; q < 1 << d; q++)
        growth += shape->weight[q] * f->point.dilatation[q];
    for (int a = 0; a < 1 << d; a++)
        for (int i = 0; i < d; i++)
            for (int q = 0; q < 1 << d; q++) {
                double sum = 0;
                for (int k = 0; k < d; k++)
                    sum += shape->gradient[a][k][q] * f->point.inverse[k][i][q];
                f->gradient[a][i][q] = sum;
            }
    for (int q = 0; q < 1 << d; q++)
        for (int k = 0; k < d; k++)
            for (int a = 0; a < 1 << d; a++)
                f->across[q][k][a] = f->gradient[a][k][q];
    divergence(d, shape->weight, f->point.spread, f->across, f->growth_gradient);
    f->growth = growth / shape->volume;
    return f->growth > material->law->growth_least;
}

/* The mean dilatation's energy over V, the stress `pull` that it adds (positive outward) and its
 * stiffness times V, as functions of its growth; the derivative `slope` of its strain e by growth,
 * and the pressure mean e. */
struct mean_dilatation {
    double energy, pull, stiffness, slope, bound;
};

INLINE struct mean_dilatation mean_dilatation_of(const struct material *material, double growth,
                                                 const double *pressure) {
    bool logarithmic = material->law->logarithmic;
    double strain = logarithmic ? log1p(growth) : growth,
           slope = logarithmic ? 1 / (1 + growth) : 1;
    double bound = material->mean * strain, p = pressure != NULL ? *pressure : bound;
    return (struct mean_dilatation){.energy = bound * strain / 2,
                                    .pull = p * slope,
                                    .stiffness =
                                        (material->mean - (logarithmic ? p : 0)) * slope * slope,
                                    .slope = slope,
                                    .bound = bound};
}

/* For one node: t[i*d + k][j] is the derivative of the first Piola-Kirchhoff stress ik, in space,
 * by the node's displacement j. */
INLINE void stresses_by(int d, pointwise gradient[3], struct moduli *m, pointwise t[9][3]) {
    for (int i = 0; i < d; i++)
        for (int k = 0; k < d; k++)
            for (int j = 0; j < d; j++)
                for (int q = 0; q < 1 << d; q++) {
                    double sum = 0;
                    for (int l = 0; l < d; l++)
                        sum += m->material[symmetric_index(d, i, k)][j * d + l][q] * gradient[l][q];
                    t[i * d + k][j][q] = sum;
                }
    for (int k = 0; k < d; k++)
        for (int q = 0; q < 1 << d; q++) {
            double sum = 0;
            for (int l = 0; l < d; l++)
                sum += m->stress[k][l][q] * gradient[l][q];
            for (int i = 0; i < d; i++)
                t[i * d + k][i][q] += sum;
        }
}

/* Adds to out[i][j][a] the integral of grad_k N_a t_ikj. */
INLINE void blocks_add(int d, pointwise t[9][3], nodes across[8][3], nodes out[3][3]) {
    for (int q = 0; q < 1 << d; q++)
        for (int i = 0; i < d; i++)
            for (int j = 0; j < d; j++)
                for (int a = 0; a < 1 << d; a++) {
                    double sum = 0;
                    for (int k = 0; k < d; k++)
                        sum += across[q][k][a] * t[i * d + k][j][q];
                    out[i][j][a] += sum;
                }
}

INLINE void stiffnesses(int d, const struct material *material, const struct element_shape *shape,
                        struct field *f, const struct mean_dilatation *mean,
                        double (*stiffness)[ELEMENT_DEGREES_OF_FREEDOM]) {
    struct moduli moduli;
    double factor = mean->stiffness / shape->volume;
    material_moduli(d, material, &f->point, mean->pull, shape->weight, &moduli);
    for (int b = 0; b < 1 << d; b++) {
        nodes block[3][3];
        pointwise t[9][3];
        for (int i = 0; i < d; i++)
            for (int j = 0; j < d; j++)
                for (int a = 0; a < 1 << d; a++)
                    block[i][j][a] = factor * f->growth_gradient[j][b] * f->growth_gradient[i][a];
        stresses_by(d, f->gradient[b], &moduli, t);
        blocks_add(d, t, f->across, block);
        for (int a = 0; a <= b; a++)
            for (int i = 0; i < d; i++)
                for (int j = 0; j < d; j++)
                    stiffness[a * d + i][b * d + j] = stiffness[b * d + j][a * d + i] =
                        block[i][j][a];
    }
}

INLINE bool evaluate(int d, const struct material *material, const struct element_shape *shape,
                     double u[8][3], const double *pressure, double *energy, double *force,
                     double (*stiffness)[ELEMENT_DEGREES_OF_FREEDOM],
                     struct element_volumetric *out) {
    struct field f;
    if (!field_make(d, material, shape, u, &f))
        return false;
    struct mean_dilatation mean = mean_dilatation_of(material, f.growth, pressure);
    if (energy != NULL) {
        *energy = shape->volume * mean.energy;
        for (int q = 0; q < 1 << d; q++)
            *energy += shape->weight[q] * f.point.energy[q];
    }
    if (force != NULL) {
        nodes inner[3];
        divergence(d, shape->weight, f.point.stress, f.across, inner);
        for (int a = 0; a < 1 << d; a++)
            for (int i = 0; i < d; i++)
                force[a * d + i] = inner[i][a] + mean.pull * f.growth_gradient[i][a];
    }
    if (stiffness != NULL)
        stiffnesses(d, material, shape, &f, &mean, stiffness);
    if (out != NULL) {
        out->stiffness = material->mean / shape->volume;
        out->bound = mean.bound;
        for (int a = 0; a < 1 << d; a++)
            for (int i = 0; i < d; i++)
                out->gradient[a * d + i] = mean.slope * f.growth_gradient[i][a];
    }
    return true;
}

WIDE_VECTORS bool element_evaluate(int dimension, const struct material *material,
                                   const struct element_shape *shape, double u[8][3],
                                   const double *pressure, double *energy, double *force,
                                   double (*stiffness)[ELEMENT_DEGREES_OF_FREEDOM],
                                   struct element_volumetric *volumetric) {
    return dimension == 2
               ? evaluate(2, material, shape, u, pressure, energy, force, stiffness, volumetric)
               : evaluate(3, material, shape, u, pressure, energy, force, stiffness, volumetric);
}
