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
#ifndef RUGO_CORE_FULL_HENCKY_H
#define RUGO_CORE_FULL_HENCKY_H

#include <stdbool.h>

enum kinematics { KINEMATICS_HENCKY, KINEMATICS_ST_VENANT, KINEMATICS_SMALL };

struct solid {
    enum kinematics kinematics;
    double shear;       /* Lame's mu, in E* as the next */
    double local, mean; /* parts of Lame's lambda: of the dilatation here, of its element's mean */
    bool convex;        /* moduli lack what stress can make negative in them: no tangent any more,
                           but a step along them leads downhill */
};
/* Split as the layered model's. */
struct solid solid_of(double poisson, enum kinematics kinematics);

/* A strained point; components from the dimension on are not set. */
struct strained {
    double energy;        /* E*, per reference volume */
    double dilatation;    /* of which the element takes the mean: J - 1; st_venant: sum E_p; small:
                             tr e */
    double inverse[3][3]; /* of F: gradients here are grad_X F^-1; small: 1 */
    double stress[3][3];  /* Kirchhoff's */
    double axis[3][3];    /* axis[p]: principal direction in space */
    double principal[3];  /* Kirchhoff's stress along it */
    double strain[3];     /* e_p; st_venant: E_p */
    double square[3];     /* of the stretch */
};

/* h[i][k] = du_i/dX_k. False, with nothing else promised, when the point is turned inside out. */
bool solid_strain(int dimension, const struct solid *solid, double h[3][3], struct strained *out);

/* The second variation of the energy and of pull times the dilatation is G : moduli : G, with
 * G = dH F^-1 the gradient in space of the variation:
 * moduli[i*dimension + k][j*dimension + l] multiplies G_ik G_jl. */
void solid_moduli(int dimension, const struct solid *solid, const struct strained *point,
                  double pull, double moduli[9][9]);

#endif
