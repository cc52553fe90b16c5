/* Protects the material of the full model: closed forms, its moduli against differences, equal and
 * nearly equal stretches, strains of all sizes, objectivity. */
#include "tests/support/check.h"

#include "core/full/material.h"
#include "core/random.h"
#include <string.h>

static const double POISSON[] = {0, 0.3, 0.49, 0.4999};
static const enum kinematics KINEMATICS[] = {KINEMATICS_HENCKY, KINEMATICS_ST_VENANT,
                                             KINEMATICS_SMALL, KINEMATICS_NEO_HOOKE};
static const enum kinematics FINITE[] = {KINEMATICS_HENCKY, KINEMATICS_ST_VENANT,
                                         KINEMATICS_NEO_HOOKE};

/* A gradient of entries up to size, the same each run. */
static void random_gradient(uint64_t draw, double size, double h[3][3]) {
    struct random_key key = {.seed = 4, .realisation = draw};
    double uniform[9];
    random_uniform(key, 0, 0, 9, uniform);
    for (size_t n = 0; n < 9; n++)
        h[n / 3][n % 3] = size * (2 * uniform[n] - 1);
}

/* Of one point, among others of an element. */
struct strained_point {
    double energy, dilatation, stress[3][3];
};
enum { HERE = 2 };

static bool strain_all(int d, const struct material *material, double h[3][3],
                       struct strained *out) {
    pointwise all[3][3];
    for (uint64_t q = 0; q < POINTS_MOST; q++) {
        double other[3][3];
        random_gradient(3000 + q, 0.2, other);
        for (int i = 0; i < 3; i++)
            for (int k = 0; k < 3; k++)
                all[i][k][q] = q == HERE ? h[i][k] : other[i][k];
    }
    return material_strain(d, material, all, out);
}

static struct strained_point strain(int d, const struct material *material, double h[3][3]) {
    struct strained all;
    assert_true(strain_all(d, material, h, &all));
    struct strained_point point = {.energy = all.energy[HERE], .dilatation = all.dilatation[HERE]};
    for (int i = 0; i < d; i++)
        for (int k = 0; k < d; k++)
            point.stress[i][k] = all.stress[i][k][HERE];
    return point;
}

/* Second variation of the energy and the pull times the dilatation, by G_ik G_jl. */
static void moduli_of(int d, const struct material *material, double h[3][3], double pull,
                      double out[9][9]) {
    static const pointwise WEIGHT = {3, 2, 0.5, 4, 5, 6, 7, 8};
    struct strained all;
    struct moduli moduli;
    assert_true(strain_all(d, material, h, &all));
    material_moduli(d, material, &all, pull, WEIGHT, &moduli);
    for (int ik = 0; ik < d * d; ik++)
        for (int jl = 0; jl < d * d; jl++) {
            out[ik][jl] = moduli.material[symmetric_index(d, ik / d, ik % d)][jl][HERE];
            if (ik / d == jl / d)
                out[ik][jl] += moduli.stress[ik % d][jl % d][HERE];
            out[ik][jl] /= WEIGHT[HERE];
        }
}

/* Hencky (1928): tau_p = 2 mu ln lambda_p + lambda ln J, plane strain's third stretch 1. Rounding
 * alone: 1e-13 of the moduli, far below the 1e-10 that is asked. */
static void hencky_has_its_closed_forms(void **state) {
    (void)state;
    for (size_t n = 0; n < 4; n++) {
        struct material material = material_of(POISSON[n], KINEMATICS_HENCKY);
        for (double stretch = 0.5; stretch < 2.1; stretch += 0.25) {
            double logarithm = log(stretch), mu = material.shear, a = material.local;
            double uniaxial[3][3] = {{stretch - 1}};
            for (int d = 2; d <= 3; d++) {
                struct strained_point p = strain(d, &material, uniaxial);
                check_close(p.stress[0][0], (2 * mu + a) * logarithm, 1e-13);
                check_close(p.stress[1][1], a * logarithm, 1e-13);
                check_close(p.energy, (mu + a / 2) * logarithm * logarithm, 1e-13);
            }
            /* Simple shear by gamma = 2 sinh e: stretches exp(+-e), axes at half of acot(gamma/2)
             * to the shear; tau = 2 mu e (cos, sin) of twice that angle. */
            double gamma = stretch, e = asinh(gamma / 2), angle = atan2(1, gamma / 2);
            double shear[3][3] = {{0, gamma}};
            for (int d = 2; d <= 3; d++) {
                struct strained_point p = strain(d, &material, shear);
                check_close(p.stress[0][0], 2 * mu * e * cos(angle), 1e-13);
                check_close(p.stress[0][1], 2 * mu * e * sin(angle), 1e-13);
                check_close(p.energy, 2 * mu * e * e, 1e-13);
                check_close(p.dilatation, 0, 1e-14);
            }
        }
    }
}

/* S = 2 mu E + lambda tr E, tau = F S F^T: uniaxial, and simple shear by gamma, whose E has gamma/2
 * across and gamma^2/2 along the second axis. */
static void st_venant_has_its_closed_forms(void **state) {
    (void)state;
    for (size_t n = 0; n < 4; n++) {
        struct material material = material_of(POISSON[n], KINEMATICS_ST_VENANT);
        double mu = material.shear, a = material.local;
        for (double stretch = 0.5; stretch < 2.1; stretch += 0.25)
            for (int d = 2; d <= 3; d++) {
                double square = stretch * stretch, e = (square - 1) / 2;
                double uniaxial[3][3] = {{stretch - 1}};
                struct strained_point p = strain(d, &material, uniaxial);
                check_close(p.stress[0][0], square * (2 * mu + a) * e, 1e-13);
                check_close(p.stress[1][1], a * e, 1e-13);
                check_close(p.energy, (mu + a / 2) * e * e, 1e-13);
                check_close(p.dilatation, e, 1e-14);
                double gamma = stretch, trace = square / 2, shear[3][3] = {{0, gamma}};
                p = strain(d, &material, shear);
                check_close(p.stress[0][0], (a + square * (2 * mu + a)) * trace + 2 * mu * square,
                            1e-12);
                check_close(p.stress[0][1], mu * gamma + gamma * (2 * mu + a) * trace, 1e-12);
                check_close(p.stress[1][1], (2 * mu + a) * trace, 1e-12);
                check_close(p.dilatation, trace, 1e-13);
            }
    }
}

/* tau = mu (F F^T - 1) + lambda ln J: uniaxial, and simple shear by gamma, whose stress along the
 * first axis is mu gamma^2. */
static void neo_hooke_has_its_closed_forms(void **state) {
    (void)state;
    for (size_t n = 0; n < 4; n++) {
        struct material material = material_of(POISSON[n], KINEMATICS_NEO_HOOKE);
        double mu = material.shear, a = material.local;
        for (double stretch = 0.5; stretch < 2.1; stretch += 0.25)
            for (int d = 2; d <= 3; d++) {
                double square = stretch * stretch, logarithm = log(stretch);
                double uniaxial[3][3] = {{stretch - 1}}, shear[3][3] = {{0, stretch}};
                struct strained_point p = strain(d, &material, uniaxial);
                check_close(p.stress[0][0], mu * (square - 1) + a * logarithm, 1e-13);
                check_close(p.stress[1][1], a * logarithm, 1e-13);
                check_close(p.energy,
                            mu / 2 * (square - 1 - 2 * logarithm) + a / 2 * logarithm * logarithm,
                            1e-13);
                check_close(p.dilatation, stretch - 1, 1e-14);
                p = strain(d, &material, shear);
                check_close(p.stress[0][0], mu * square, 1e-13);
                check_close(p.stress[0][1], mu * stretch, 1e-13);
                check_close(p.stress[1][1], 0, 1e-13);
                check_close(p.energy, mu / 2 * square, 1e-13);
            }
    }
}

/* Small gradients: all kinematics are one, with digits left in the strain itself. */
static void small_strains_are_linear(void **state) {
    (void)state;
    double h[3][3];
    random_gradient(1, 1e-9, h);
    for (int d = 2; d <= 3; d++) {
        struct material small = material_of(0.3, KINEMATICS_SMALL);
        struct strained_point linear = strain(d, &small, h);
        for (size_t k = 0; k < 4; k++) {
            struct material material = material_of(0.3, KINEMATICS[k]);
            struct strained_point p = strain(d, &material, h);
            for (int i = 0; i < d; i++)
                for (int j = 0; j < d; j++)
                    check_close(p.stress[i][j], linear.stress[i][j], 1e-16);
        }
    }
}

/* Points of all sizes of strain at once: each has orthonormal axes and, where small, the linear
 * stress to its own last digits. */
static void sizes_do_not_mix(void **state) {
    (void)state;
    static const double SIZES[] = {1e-9, 0.3, 0, 1e-12, 1e-300, 1e-30, 3e-151, 1e-160};
    for (int d = 2; d <= 3; d++)
        for (size_t k = 0; k < 4; k++) {
            struct material material = material_of(0.3, KINEMATICS[k]);
            struct material small = material_of(0.3, KINEMATICS_SMALL);
            struct strained p, linear;
            pointwise h[3][3];
            for (uint64_t q = 0; q < POINTS_MOST; q++) {
                double one[3][3];
                random_gradient(q, SIZES[q], one);
                for (int i = 0; i < 3; i++)
                    for (int l = 0; l < 3; l++)
                        h[i][l][q] = one[i][l];
            }
            assert_true(material_strain(d, &material, h, &p) &&
                        material_strain(d, &small, h, &linear));
            for (int q = 0; q < 1 << d; q++)
                for (int i = 0; i < d; i++)
                    for (int l = 0; l < d; l++) {
                        double product = 0, size = SIZES[q], off = 1e-15 * size + 10 * size * size;
                        for (int m = 0; m < d; m++)
                            product += p.axis[i][m][q] * p.axis[l][m][q];
                        check_close(product, i == l, 1e-14);
                        check_close(p.stress[i][l][q], linear.stress[i][l][q], off + 1e-150);
                    }
        }
}

/* Energy under a pull at F + step G F, whose gradient in space is G. */
static double varied_energy(int d, const struct material *material, double h[3][3], double g[3][3],
                            double step, double pull) {
    double varied[3][3];
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) {
            varied[i][k] = h[i][k];
            for (int l = 0; l < d; l++) {
                double f = material->kinematics == KINEMATICS_SMALL ? l == k : h[l][k] + (l == k);
                varied[i][k] += step * g[i][l] * f;
            }
        }
    struct strained_point p = strain(d, material, varied);
    return p.energy + pull * p.dilatation;
}

/* First and second differences along a direction: steps of 3e-4 leave some 1e-8 of the third and
 * fourth derivatives, and in the second difference 1e-16/1e-7 of rounding. */
static void check_differences(int d, const struct material *material, double h[3][3],
                              double g[3][3]) {
    static const double STEP = 3e-4, PULL = 0.07;
    struct strained_point p = strain(d, material, h);
    double slope =
        (varied_energy(d, material, h, g, STEP, 0) - varied_energy(d, material, h, g, -STEP, 0)) /
        (2 * STEP);
    double before = varied_energy(d, material, h, g, -STEP, PULL);
    double after = varied_energy(d, material, h, g, STEP, PULL);
    double here = varied_energy(d, material, h, g, 0, PULL);
    double first = 0, second = 0, moduli[9][9];
    moduli_of(d, material, h, PULL, moduli);
    for (int i = 0; i < d; i++)
        for (int k = 0; k < d; k++) {
            first += p.stress[i][k] * g[i][k];
            for (int j = 0; j < d; j++)
                for (int l = 0; l < d; l++) {
                    check_close(moduli[i * d + k][j * d + l], moduli[j * d + l][i * d + k], 1e-12);
                    second += moduli[i * d + k][j * d + l] * g[i][k] * g[j][l];
                }
        }
    check_close(slope, first, 1e-6 * (1 + fabs(first)));
    check_close((after - 2 * here + before) / (STEP * STEP), second, 1e-6 * (1 + fabs(second)));
}

static void moduli_are_the_second_derivative(void **state) {
    (void)state;
    static const double SIZES[] = {0, 1e-12, 1e-8, 1e-3, 0.05, 0.3};
    for (uint64_t draw = 0; draw < 96; draw++) {
        int d = 2 + (int)(draw % 2);
        struct material material = material_of(0.3, KINEMATICS[draw / 2 % 4]);
        double h[3][3], g[3][3];
        random_gradient(draw, SIZES[draw / 16 % 6], h);
        random_gradient(1000 + draw, 0.2, g);
        check_differences(d, &material, h, g);
    }
}

/* Equal and nearly equal stretches: the moduli join up, with no jump where a formula changes. */
static void equal_stretches_are_no_exception(void **state) {
    (void)state;
    struct material material = material_of(0.3, KINEMATICS_HENCKY);
    for (int d = 2; d <= 3; d++) {
        double h[3][3] = {{0.1, 0, 0}, {0, 0.1, 0}, {0, 0, 0.1}}, equal[9][9], moduli[9][9];
        moduli_of(d, &material, h, 0.02, equal);
        double g[3][3];
        random_gradient(7, 0.2, g);
        check_differences(d, &material, h, g);
        for (double apart = 1e-16; apart < 0.03; apart *= 3) {
            h[0][0] = 0.1 + apart;
            h[0][1] = apart / 3;
            moduli_of(d, &material, h, 0.02, moduli);
            for (int m = 0; m < d * d; m++)
                for (int n = 0; n < d * d; n++)
                    check_close(moduli[m][n], equal[m][n], 1e-13 + 10 * apart);
        }
        h[0][1] = 0;
        for (double edge = 0.2499; edge < 0.2502; edge += 2e-5) { /* where the series ends */
            h[0][0] = 1.1 * exp(edge) - 1;
            check_differences(d, &material, h, g);
        }
    }
}

/* A rotation after the strain turns the stress and leaves the energy. */
static void a_rotation_turns_the_stress(void **state) {
    (void)state;
    for (uint64_t draw = 0; draw < 20; draw++)
        for (int d = 2; d <= 3; d++) {
            struct material material = material_of(0.3, FINITE[draw % 3]);
            double c = cos((double)draw), s = sin((double)draw), h[3][3], turned[3][3];
            double r[3][3] = {{c, -s, 0}, {s, c, 0}, {0, 0, 1}};
            random_gradient(draw, 0.25, h);
            struct strained_point before = strain(d, &material, h);
            for (int i = 0; i < 3; i++)
                for (int k = 0; k < 3; k++) {
                    turned[i][k] = -(i == k);
                    for (int l = 0; l < 3; l++)
                        turned[i][k] += r[i][l] * (h[l][k] + (l == k));
                }
            struct strained_point after = strain(d, &material, turned);
            check_close(after.energy, before.energy, 1e-13);
            for (int i = 0; i < d; i++)
                for (int k = 0; k < d; k++) {
                    double expected = 0;
                    for (int l = 0; l < d; l++)
                        for (int m = 0; m < d; m++)
                            expected += r[i][l] * before.stress[l][m] * r[k][m];
                    check_close(after.stress[i][k], expected, 1e-13);
                }
        }
}

/* Convex moduli: those of the tangent where there is no stress, and no negative energy in any
 * direction under any. */
static void convex_moduli_lead_downhill(void **state) {
    (void)state;
    for (uint64_t draw = 0; draw < 200; draw++) {
        int d = 2 + (int)(draw % 2);
        struct material material = material_of(0.3, FINITE[draw / 2 % 3]), convex = material;
        double h[3][3], g[3][3], moduli[9][9], energy = 0;
        convex.convex = true;
        random_gradient(draw, draw < 6 ? 0 : 0.3, h);
        random_gradient(2000 + draw, 1, g);
        moduli_of(d, &convex, h, draw < 6 ? 0 : 0.5 * (double)(draw % 7) - 1.5, moduli);
        for (int m = 0; m < d * d; m++)
            for (int n = 0; n < d * d; n++)
                energy += moduli[m][n] * g[m / d][m % d] * g[n / d][n % d];
        assert_true(energy > -1e-12);
        if (draw < 6) {
            double tangent[9][9];
            moduli_of(d, &material, h, 0, tangent);
            for (int m = 0; m < d * d; m++)
                for (int n = 0; n < d * d; n++)
                    check_close(moduli[m][n], tangent[m][n], 1e-14);
        }
    }
}

static void what_is_inside_out_is_refused(void **state) {
    (void)state;
    struct material material = material_of(0.3, KINEMATICS_HENCKY);
    struct strained point;
    double flat[3][3] = {{-1}}, beyond[3][3] = {{-1.5}}, twice[3][3] = {{-2, 0, 0}, {0, -2, 0}};
    assert_false(strain_all(2, &material, flat, &point));
    assert_false(strain_all(3, &material, beyond, &point));
    check_close(strain(2, &material, twice).energy, 0, 1e-30); /* half a turn, no strain */
    double lost[3][3] = {{NAN}};
    assert_false(strain_all(2, &material, lost, &point));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hencky_has_its_closed_forms),
        cmocka_unit_test(st_venant_has_its_closed_forms),
        cmocka_unit_test(neo_hooke_has_its_closed_forms),
        cmocka_unit_test(small_strains_are_linear),
        cmocka_unit_test(sizes_do_not_mix),
        cmocka_unit_test(moduli_are_the_second_derivative),
        cmocka_unit_test(equal_stretches_are_no_exception),
        cmocka_unit_test(a_rotation_turns_the_stress),
        cmocka_unit_test(convex_moduli_lead_downhill),
        cmocka_unit_test(what_is_inside_out_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
