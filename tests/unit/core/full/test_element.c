/* Protects the finite element of the full model: the patch test on distorted meshes, forces and
 * stiffness as derivatives of the energy, rigid motion, closed forms of uniform strains, volumes.
 */
#include "tests/support/check.h"

#include "core/full/element.h"
#include "core/random.h"
#include <string.h>

static const enum kinematics KINEMATICS[] = {KINEMATICS_HENCKY, KINEMATICS_ST_VENANT,
                                             KINEMATICS_SMALL, KINEMATICS_NEO_HOOKE};
static const enum kinematics FINITE[] = {KINEMATICS_HENCKY, KINEMATICS_ST_VENANT,
                                         KINEMATICS_NEO_HOOKE};

static void random_numbers(uint64_t draw, size_t n, double size, double *out) {
    struct random_key key = {.seed = 5, .realisation = draw};
    random_uniform(key, 0, 0, n, out);
    for (size_t i = 0; i < n; i++)
        out[i] = size * (2 * out[i] - 1);
}

/* A unit brick at a corner, its nodes moved by up to size. */
static void distorted(int d, uint64_t draw, double size, double position[8][3]) {
    random_numbers(draw, 24, size, &position[0][0]);
    for (int a = 0; a < 1 << d; a++)
        for (int k = 0; k < d; k++)
            position[a][k] += a >> k & 1;
}

static void shape(int d, double position[8][3], struct element_shape *out) {
    assert_true(element_shape_make(d, position, out));
}

/* All nodes of a lattice of 3^d, the middle one moved, under a uniform gradient: the forces of the
 * 2^d elements on the middle node are in balance, whatever the gradient and the kinematics. Bound:
 * rounding, far below the 1e-10 asked. */
static void patch_test(void **state) {
    (void)state;
    for (uint64_t draw = 0; draw < 40; draw++) {
        int d = 2 + (int)(draw % 2);
        struct material material =
            material_of(draw % 5 == 0 ? 0.4999 : 0.3, KINEMATICS[draw / 2 % 4]);
        double moved[27][3], h[3][3], sum[3] = {0}, scale = 0;
        random_numbers(draw, 81, 0.2, &moved[0][0]);
        random_numbers(100 + draw, 9, 0.2, &h[0][0]);
        for (int e = 0; e < 1 << d; e++) {
            double position[8][3], u[8][3], force[ELEMENT_DEGREES_OF_FREEDOM];
            struct element_shape element;
            for (int a = 0; a < 1 << d; a++) {
                int lattice = 0, power = 1;
                for (int k = 0; k < d; k++, power *= 3) {
                    position[a][k] = (e >> k & 1) + (a >> k & 1);
                    lattice += (int)position[a][k] * power;
                }
                for (int k = 0; k < d; k++)
                    position[a][k] += moved[lattice][k];
                for (int i = 0; i < d; i++) {
                    u[a][i] = 0;
                    for (int k = 0; k < d; k++)
                        u[a][i] += h[i][k] * position[a][k];
                }
            }
            shape(d, position, &element);
            assert_true(element_evaluate(d, &material, &element, u, NULL, NULL, force, NULL, NULL));
            int middle = (1 << d) - 1 - e;
            for (int i = 0; i < d; i++) {
                sum[i] += force[middle * d + i];
                scale = fmax(scale, fabs(force[middle * d + i]));
            }
        }
        for (int i = 0; i < d; i++)
            check_close(sum[i], 0, 1e-13 * scale);
    }
}

/* Central differences with steps of 1e-5 in unit elements: 1e-10 of the third derivative, 1e-11 of
 * rounding; 1e-6 is asked. */
static void forces_and_stiffness_are_derivatives(void **state) {
    (void)state;
    static const double STEP = 1e-5;
    for (uint64_t draw = 0; draw < 48; draw++) {
        int d = 2 + (int)(draw % 2), degrees_of_freedom = d << d;
        struct material material =
            material_of(draw % 5 == 0 ? 0.49 : 0.3, KINEMATICS[draw / 2 % 4]);
        double position[8][3], u[8][3], force[24], stiffness[24][24];
        struct element_shape element;
        distorted(d, draw, 0.2, position);
        shape(d, position, &element);
        random_numbers(200 + draw, 24, draw < 8 ? 0 : 0.1, &u[0][0]);
        assert_true(
            element_evaluate(d, &material, &element, u, NULL, NULL, force, stiffness, NULL));
        for (int n = 0; n < degrees_of_freedom; n++) {
            double low, high, before[24], after[24], *value = &u[n / d][n % d];
            *value += STEP;
            assert_true(
                element_evaluate(d, &material, &element, u, NULL, &high, after, NULL, NULL));
            *value -= 2 * STEP;
            assert_true(
                element_evaluate(d, &material, &element, u, NULL, &low, before, NULL, NULL));
            *value += STEP;
            check_close((high - low) / (2 * STEP), force[n], 1e-7);
            for (int m = 0; m < degrees_of_freedom; m++) {
                check_close((after[m] - before[m]) / (2 * STEP), stiffness[m][n], 1e-6);
                check_close(stiffness[m][n], stiffness[n][m], 1e-13);
            }
        }
    }
}

/* A turned and shifted block: forces turn with it. */
static void a_rotated_element_gives_rotated_forces(void **state) {
    (void)state;
    for (uint64_t draw = 0; draw < 24; draw++) {
        int d = 2 + (int)(draw % 2);
        struct material material = material_of(0.3, FINITE[draw / 2 % 3]);
        double position[8][3], u[8][3], turned[8][3], force[24], after[24], energy, same;
        double c = cos(1 + (double)draw), s = sin(1 + (double)draw);
        double r[3][3] = {{c, -s, 0}, {s, c, 0}, {0, 0, 1}};
        struct element_shape element;
        distorted(d, draw, 0.2, position);
        shape(d, position, &element);
        random_numbers(300 + draw, 24, 0.15, &u[0][0]);
        for (int a = 0; a < 1 << d; a++)
            for (int i = 0; i < d; i++) {
                turned[a][i] = 0.5 - position[a][i];
                for (int k = 0; k < d; k++)
                    turned[a][i] += r[i][k] * (position[a][k] + u[a][k]);
            }
        assert_true(element_evaluate(d, &material, &element, u, NULL, &energy, force, NULL, NULL));
        assert_true(
            element_evaluate(d, &material, &element, turned, NULL, &same, after, NULL, NULL));
        check_close(same, energy, 1e-13);
        for (int a = 0; a < 1 << d; a++)
            for (int i = 0; i < d; i++) {
                double expected = 0;
                for (int k = 0; k < d; k++)
                    expected += r[i][k] * force[a * d + k];
                check_close(after[a * d + i], expected, 1e-13);
            }
    }
}

/* Kirchhoff's stress (small: the stress) by components, and the energy, of a uniform strain. */
struct uniform {
    double h[3][3];
    double energy, across, normal[3]; /* across: 0, d - 1 */
};

/* The vertical axis stretched. */
static struct uniform uniaxial(int d, enum kinematics k, double mu, double lambda, double stretch) {
    struct uniform u = {.h = {{0}}};
    double square = k == KINEMATICS_ST_VENANT ? stretch * stretch : 1;
    double e = k == KINEMATICS_HENCKY      ? log(stretch)
               : k == KINEMATICS_ST_VENANT ? (square - 1) / 2
                                           : stretch - 1;
    u.h[d - 1][d - 1] = stretch - 1;
    for (int i = 0; i < d; i++)
        u.normal[i] = i == d - 1 ? square * (2 * mu + lambda) * e : lambda * e;
    u.energy = (mu + lambda / 2) * e * e;
    if (k != KINEMATICS_NEO_HOOKE)
        return u;
    for (int i = 0; i < d; i++)
        u.normal[i] = lambda * log(stretch) + (i == d - 1 ? mu * (stretch * stretch - 1) : 0);
    u.energy = mu / 2 * (stretch * stretch - 1 - 2 * log(stretch)) +
               lambda / 2 * log(stretch) * log(stretch);
    return u;
}

/* All axes stretched alike. */
static struct uniform swollen(int d, enum kinematics k, double mu, double lambda, double stretch) {
    struct uniform u = uniaxial(d, k, mu, lambda, stretch);
    double square = k == KINEMATICS_ST_VENANT ? stretch * stretch : 1;
    double e = u.normal[d - 1] / (square * (2 * mu + lambda));
    for (int i = 0; i < d; i++) {
        u.h[i][i] = stretch - 1;
        u.normal[i] = square * (2 * mu + d * lambda) * e;
    }
    u.energy = d * (mu + d * lambda / 2) * e * e;
    if (k != KINEMATICS_NEO_HOOKE)
        return u;
    double trace = d * log(stretch);
    for (int i = 0; i < d; i++)
        u.normal[i] = mu * (stretch * stretch - 1) + lambda * trace;
    u.energy = mu / 2 * (d * (stretch * stretch - 1) - 2 * trace) + lambda / 2 * trace * trace;
    return u;
}

/* The vertical axis stretched by s, then sheared sideways by gamma s: F = [1 gamma; 0 s]. St
 * Venant: tau = F S F^T. Hencky: F F^T is m + D with D traceless and D^2 = r^2, its logarithm
 * ln s + D atanh(r/m)/r. Neo-Hooke: mu (F F^T - 1) + lambda ln s. */
static struct uniform sheared(int d, enum kinematics k, double mu, double lambda, double s) {
    const double gamma = 0.3;
    int v = d - 1;
    struct uniform u = {.h = {{0}}};
    u.h[0][v] = gamma;
    u.h[v][v] = s - 1;
    if (k == KINEMATICS_SMALL) {
        u.normal[0] = u.normal[1] = lambda * (s - 1);
        u.normal[v] = (2 * mu + lambda) * (s - 1);
        u.across = mu * gamma;
        u.energy = (mu + lambda / 2) * (s - 1) * (s - 1) + mu / 2 * gamma * gamma;
    } else if (k == KINEMATICS_ST_VENANT) {
        double e = (gamma * gamma + s * s - 1) / 2, down = (2 * mu + lambda) * e;
        u.normal[1] = lambda * e; /* of the third axis in 3D */
        u.normal[0] = lambda * e + 2 * gamma * mu * gamma + gamma * gamma * down;
        u.normal[v] = s * s * down;
        u.across = s * (mu * gamma + gamma * down);
        u.energy = (mu + lambda / 2) * e * e + mu / 2 * gamma * gamma;
    } else if (k == KINEMATICS_NEO_HOOKE) {
        double l = log(s), square = gamma * gamma;
        u.normal[1] = lambda * l;
        u.normal[0] = mu * square + lambda * l;
        u.normal[v] = mu * (s * s - 1) + lambda * l;
        u.across = mu * gamma * s;
        u.energy = mu / 2 * (square + s * s - 1 - 2 * l) + lambda / 2 * l * l;
    } else {
        double m = (1 + gamma * gamma + s * s) / 2, r = sqrt(m * m - s * s), l = log(s);
        double t = atanh(r / m), half = (1 + gamma * gamma - s * s) / 2;
        u.normal[1] = lambda * l;
        u.normal[0] = (mu + lambda) * l + mu * t / r * half;
        u.normal[v] = (mu + lambda) * l - mu * t / r * half;
        u.across = mu * t / r * gamma * s;
        u.energy = mu / 2 * (l * l + t * t) + lambda / 2 * l * l;
    }
    return u;
}

/* The material's closed forms with the whole of lambda, from the energy and the forces of a
 * distorted element: the sum of force times position (small strains: position before) is the stress
 * times the volume. */
static void uniform_strain_is_the_solids(void **state) {
    (void)state;
    static struct uniform (*const STRAIN[])(int, enum kinematics, double, double,
                                            double) = {uniaxial, swollen, sheared};
    static const double STRETCHES[] = {0.8, 0.95, 1 - 1e-7, 1.3};
    for (size_t c = 0; c < (size_t)2 * 4 * 3 * 4; c++) {
        int d = 2 + (int)(c % 2);
        enum kinematics kinematics = KINEMATICS[c / 2 % 4];
        struct material material = material_of(0.3, kinematics);
        struct uniform expected = STRAIN[c / 8 % 3](
            d, kinematics, material.shear, material.local + material.mean, STRETCHES[c / 24]);
        double position[8][3], u[8][3], force[ELEMENT_DEGREES_OF_FREEDOM], energy;
        struct element_shape element;
        distorted(d, c, 0.2, position);
        shape(d, position, &element);
        for (int a = 0; a < 1 << d; a++)
            for (int i = 0; i < d; i++) {
                u[a][i] = 0;
                for (int k = 0; k < d; k++)
                    u[a][i] += expected.h[i][k] * position[a][k];
            }
        assert_true(element_evaluate(d, &material, &element, u, NULL, &energy, force, NULL, NULL));
        check_close(energy, element.volume * expected.energy, 1e-14);
        for (int i = 0; i < d; i++)
            for (int k = 0; k < d; k++) {
                double stress = 0, across = i == 0 && k == d - 1 ? expected.across : 0;
                if (k == 0 && i == d - 1)
                    across = expected.across;
                for (int a = 0; a < 1 << d; a++)
                    stress += force[a * d + i] *
                              (position[a][k] + (kinematics == KINEMATICS_SMALL ? 0 : u[a][k]));
                check_close(stress, element.volume * (i == k ? expected.normal[i] : across), 1e-14);
            }
    }
    struct uniform pressed = uniaxial(2, KINEMATICS_ST_VENANT, 0.35, 0.525, 0.8);
    check_close(pressed.normal[1], -0.14112, 1e-15);
}

/* At rest all kinematics have one stiffness, and small displacements its forces. */
static void small_strains_are_linear(void **state) {
    (void)state;
    for (uint64_t draw = 0; draw < 12; draw++) {
        int d = 2 + (int)(draw % 2), degrees_of_freedom = d << d;
        double poisson = draw < 6 ? 0.3 : 0.4999;
        struct material material = material_of(poisson, KINEMATICS_SMALL);
        double position[8][3], u[8][3] = {{0}}, linear[24][24], force[24], stiffness[24][24];
        struct element_shape element;
        distorted(d, draw, 0.2, position);
        shape(d, position, &element);
        assert_true(element_evaluate(d, &material, &element, u, NULL, NULL, NULL, linear, NULL));
        material = material_of(poisson, FINITE[draw / 2 % 3]);
        assert_true(element_evaluate(d, &material, &element, u, NULL, NULL, NULL, stiffness, NULL));
        random_numbers(400 + draw, 24, 1e-12, &u[0][0]);
        assert_true(element_evaluate(d, &material, &element, u, NULL, NULL, force, NULL, NULL));
        double size = (material.local + material.mean) / 0.525;
        for (int m = 0; m < degrees_of_freedom; m++) {
            double expected = 0;
            for (int n = 0; n < degrees_of_freedom; n++) {
                check_close(stiffness[m][n], linear[m][n], 1e-14 * size);
                expected += linear[m][n] * u[n / d][n % d];
            }
            check_close(force[m], expected, 1e-22 * size);
        }
    }
}

static void bad_shapes_are_found(void **state) {
    (void)state;
    struct element_shape element;
    for (int d = 2; d <= 3; d++) {
        double position[8][3];
        distorted(d, 0, 0, position);
        shape(d, position, &element);
        check_close(element.volume, 1, 1e-15);
        check_close(element_quality(d, position), 1, 1e-15);
        for (int a = 0; a < 1 << d; a++) /* sheared to 45 degrees */
            position[a][0] += position[a][d - 1];
        check_close(element_quality(d, position), sqrt(0.5), 1e-15);
        for (int a = 0; a < 1 << d; a++)
            position[a][0] *= -1;
        assert_false(element_shape_make(d, position, &element));
        assert_true(element_quality(d, position) < 0);
        distorted(d, 0, 0, position);
        position[0][0] = position[0][1] = 1.2; /* a corner folded in: convex no more */
        assert_true(element_quality(d, position) < 0);
    }
}

static void inside_out_is_refused(void **state) {
    (void)state;
    struct material material = material_of(0.3, KINEMATICS_HENCKY);
    double position[8][3], u[8][3] = {{0}}, force[24];
    struct element_shape element;
    distorted(2, 0, 0, position);
    shape(2, position, &element);
    u[2][1] = u[3][1] = -1.01;
    assert_false(element_evaluate(2, &material, &element, u, NULL, NULL, force, NULL, NULL));
    u[2][1] = NAN;
    assert_false(element_evaluate(2, &material, &element, u, NULL, NULL, force, NULL, NULL));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(patch_test),
        cmocka_unit_test(forces_and_stiffness_are_derivatives),
        cmocka_unit_test(a_rotated_element_gives_rotated_forces),
        cmocka_unit_test(uniform_strain_is_the_solids),
        cmocka_unit_test(small_strains_are_linear),
        cmocka_unit_test(bad_shapes_are_found),
        cmocka_unit_test(inside_out_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
