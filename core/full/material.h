/* Isotropic elasticity at one point, in two or three dimensions (two: plane strain).
 *
 * Energy per reference volume, with e_p the logarithms of the principal stretches and J = det F:
 *
 *   hencky:    shear sum e_p^2 + (local/2) (ln J)^2
 *   st_venant: shear sum E_p^2 + (local/2) (sum E_p)^2,  E_p = (exp(2 e_p) - 1)/2
 *   small:     shear e:e + (local/2) (tr e)^2,  e the symmetric part of the displacement gradient
 *
 * and the part of lambda that sees the element's mean dilatation alone (element.h), which is that
 * of ln J, sum E_p or tr e where the strain is uniform. To first order in the gradient all are the
 * linear material of core/contact/layered.c. Moduli in E* = E/(1 - nu^2). */
#ifndef RUGO_CORE_FULL_MATERIAL_H
#define RUGO_CORE_FULL_MATERIAL_H

#include <stdbool.h>

enum kinematics { KINEMATICS_HENCKY, KINEMATICS_ST_VENANT, KINEMATICS_SMALL };

struct material_law;
struct material {
    const struct material_law *law; /* belongs to kinematics */
    enum kinematics kinematics;
    double shear;       /* Lame's mu, in E* as the next */
    double local, mean; /* parts of Lame's lambda: of the dilatation here, of its element's mean */
    bool convex;        /* moduli lack what stress adds to them: no tangent any more, but a step
                           along them leads downhill */
};
/* Split as the layered model's. */
struct material material_of(double poisson, enum kinematics kinematics);

/* A value at each Gauss point of an element, 2^dimension of them: all are worked on at once. */
enum { POINTS_MOST = 8 };
typedef double pointwise[POINTS_MOST];

/* Strained points; components from the dimension on are not set. */
struct strained {
    pointwise energy;     /* E*, per reference volume */
    pointwise dilatation; /* whose mean the element takes: J - 1; st_venant: sum E_p; small: tr e */
    pointwise spread[3][3];  /* its first variation is spread_ik G_ik, G as below */
    pointwise inverse[3][3]; /* of F: gradients here are grad_X F^-1; small: 1 */
    pointwise stress[3][3];  /* Kirchhoff's */
    pointwise axis[3][3];    /* axis[p]: principal direction in space */
    pointwise principal[3];  /* Kirchhoff's stress along it */
    pointwise strain[3];     /* e_p; st_venant: E_p */
    pointwise square[3];     /* of the stretch */
};

/* h[i][k] = du_i/dX_k. False, with nothing else promised, when a point is turned inside out. */
bool material_strain(int dimension, const struct material *material, pointwise h[3][3],
                     struct strained *out);

/* Components of a symmetric tensor: xx, yy, (zz,) xy, (xz, yz). */
enum { SYMMETRIC_MOST = 6 };
static inline int symmetric_index(int dimension, int i, int k) {
    return i == k ? i : dimension + i + k - 1;
}

/* The second variation of the energy and of pull times the dilatation is, with G = dH F^-1 the
 * gradient in space of the variation,
 *
 *   e_ik material[symmetric_index(d, i, k)][j*d + l] G_jl + G_ik stress[k][l] G_il
 *
 * the first sum over k >= i, where e_ik = G_ik + G_ki, e_ii = G_ii. Each times the point's
 * weight. stress is Kirchhoff's, with that of the pull. */
struct moduli {
    pointwise material[SYMMETRIC_MOST][9];
    pointwise stress[3][3];
};
void material_moduli(int dimension, const struct material *material, const struct strained *point,
                     double pull, const pointwise weight, struct moduli *out);

#endif
