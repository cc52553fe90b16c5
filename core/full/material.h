/* Isotropic elasticity at one point, in two dimensions (plane strain) or three (F14.1).
 *
 * Energy per undeformed volume, with e_p the logarithms of the principal stretches and J = det F:
 *
 *   hencky:    shear sum e_p^2 + (local/2) (ln J)^2
 *   st_venant: shear sum E_p^2 + (local/2) (sum E_p)^2,  E_p = (exp(2 e_p) - 1)/2
 *   small:     shear e:e + (local/2) (tr e)^2,  e the symmetric part of the displacement gradient
 *   neo_hooke: (shear/2) sum (exp(2 e_p) - 1 - 2 e_p) + (local/2) (ln J)^2
 *
 * The rest of lambda acts on the element's mean dilatation (element.h), which is that of ln J, sum
 * E_p or tr e where the strain is uniform. To first order in the gradient all are the linear
 * material of core/contact/layered.c. Moduli are in E* = E/(1 - nu^2). Each law is a file,
 * material_NAME.c. */
#ifndef RUGO_CORE_FULL_MATERIAL_H
#define RUGO_CORE_FULL_MATERIAL_H

#include <stdbool.h>

enum kinematics { KINEMATICS_HENCKY, KINEMATICS_ST_VENANT, KINEMATICS_SMALL, KINEMATICS_NEO_HOOKE };

struct material_law;
struct material {
    const struct material_law *law; /* belongs to kinematics */
    enum kinematics kinematics;
    double shear;       /* Lame's mu, in E* */
    double local, mean; /* parts of Lame's lambda, in E*: of the local dilatation, and of the
                           element's mean dilatation */
    bool convex;        /* moduli leave out the terms of the stress: they are no exact tangent, but
                           positive definite, so that a step with them lowers the energy */
};
/* Lambda is split as in the layered model (F10.4). */
struct material material_of(double poisson, enum kinematics kinematics);

/* A value at each of the 2^dimension Gauss points of an element, which are processed together. */
enum { POINTS_MOST = 8 };
typedef double pointwise[POINTS_MOST];

/* State of strained points. Components from `dimension` on are not set. */
struct strained {
    pointwise energy;       /* E*, per undeformed volume */
    pointwise dilatation;   /* J - 1; st_venant: sum E_p; small: tr e. Its mean over the element is
                               element.h's growth */
    pointwise spread[3][3]; /* the first variation of dilatation is spread_ik G_ik, G as below */
    pointwise
        inverse[3][3]; /* inverse of F: gradients by deformed positions are grad_X F^-1; small: 1 */
    pointwise stress[3][3]; /* Kirchhoff's */
    /* of neo_hooke strain[0] is ln J, and other principal values are not set */
    pointwise axis[3][3];   /* axis[p]: principal direction in space; small, neo_hooke: axis p */
    pointwise principal[3]; /* Kirchhoff's stress along axis p */
    pointwise strain[3];    /* e_p; st_venant: E_p */
    pointwise square[3];    /* of the principal stretch */
};

/* Fills out from the displacement gradient h[i][k] = du_i/dX_k. Returns false, with undefined
 * results, when a point is inverted. */
bool material_strain(int dimension, const struct material *material, pointwise h[3][3],
                     struct strained *out);

/* Returns the number of component ik of a symmetric tensor in the order xx, yy, (zz,) xy, (xz, yz);
 * i <= k. */
enum { SYMMETRIC_MOST = 6 };
static inline int symmetric_index(int dimension, int i, int k) {
    return i == k ? i : dimension + i + k - 1;
}

/* Moduli at strained points. The second variation of the energy and of pull times the dilatation
 * is, with G = dH F^-1 the gradient of the variation by deformed positions,
 *
 *   e_ik material[symmetric_index(d, i, k)][j*d + l] G_jl + G_ik stress[k][l] G_il
 *
 * where the first sum is over k >= i and e_ik = G_ik + G_ki, e_ii = G_ii. Both are multiplied by
 * the point's weight. stress is Kirchhoff's, including that of the pull. */
struct moduli {
    pointwise material[SYMMETRIC_MOST][9];
    pointwise stress[3][3];
};
void material_moduli(int dimension, const struct material *material, const struct strained *point,
                     double pull, const pointwise weight, struct moduli *out);

/* A law is a table of functions, and each material_NAME.c fills one. For core/full alone. */
struct material_law {
    bool logarithmic;    /* an element's mean strain is ln(1 + growth), otherwise growth itself,
                            growth being the mean of strained.dilatation (element.h) */
    double growth_least; /* an element whose growth is not above this is inverted */
    /* These do what material_strain and material_moduli do. */
    bool (*strain)(int dimension, const struct material *material, pointwise h[3][3],
                   struct strained *out);
    void (*moduli)(int dimension, const struct material *material, const struct strained *point,
                   double pull, const pointwise weight, struct moduli *out);
};
extern const struct material_law MATERIAL_HENCKY, MATERIAL_ST_VENANT, MATERIAL_SMALL_STRAIN,
    MATERIAL_NEO_HOOKE;

#endif
