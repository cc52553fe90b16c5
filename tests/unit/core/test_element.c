/* Protects the finite element of the full model: the patch test on distorted meshes, forces and
 * stiffness as derivatives of the energy, rigid motion, volumes. */
#include "tests/support/check.h"

#include "core/full/element.h"
#include "core/random.h"
#include <string.h>

static const enum kinematics KINEMATICS[] = {KINEMATICS_HENCKY, KINEMATICS_ST_VENANT,
                                             KINEMATICS_SMALL};

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
    for (uint64_t draw = 0; draw < 30; draw++) {
        int d = 2 + (int)(draw % 2);
        struct solid solid = solid_of(draw % 5 == 0 ? 0.4999 : 0.3, KINEMATICS[draw / 2 % 3]);
        double moved[27][3], h[3][3], sum[3] = {0}, scale = 0;
        random_numbers(draw, 81, 0.2, &moved[0][0]);
        random_numbers(100 + draw, 9, 0.2, &h[0][0]);
        for (int e = 0; e < 1 << d; e++) {
            double position[8][3], u[8][3], force[ELEMENT_FREEDOMS];
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
            assert_true(element_evaluate(d, &solid, &element, u, NULL, NULL, force, NULL, NULL));
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
    for (uint64_t draw = 0; draw < 36; draw++) {
        int d = 2 + (int)(draw % 2), freedoms = d << d;
        struct solid solid = solid_of(draw % 4 == 0 ? 0.49 : 0.3, KINEMATICS[draw / 2 % 3]);
        double position[8][3], u[8][3], force[24], stiffness[24][24];
        struct element_shape element;
        distorted(d, draw, 0.2, position);
        shape(d, position, &element);
        random_numbers(200 + draw, 24, draw < 6 ? 0 : 0.1, &u[0][0]);
        assert_true(element_evaluate(d, &solid, &element, u, NULL, NULL, force, stiffness, NULL));
        for (int n = 0; n < freedoms; n++) {
            double low, high, before[24], after[24], *freedom = &u[n / d][n % d];
            *freedom += STEP;
            assert_true(element_evaluate(d, &solid, &element, u, NULL, &high, after, NULL, NULL));
            *freedom -= 2 * STEP;
            assert_true(element_evaluate(d, &solid, &element, u, NULL, &low, before, NULL, NULL));
            *freedom += STEP;
            check_close((high - low) / (2 * STEP), force[n], 1e-7);
            for (int m = 0; m < freedoms; m++) {
                check_close((after[m] - before[m]) / (2 * STEP), stiffness[m][n], 1e-6);
                check_close(stiffness[m][n], stiffness[n][m], 1e-13);
            }
        }
    }
}

/* A turned and shifted block: forces turn with it. */
static void a_rotated_element_gives_rotated_forces(void **state) {
    (void)state;
    for (uint64_t draw = 0; draw < 20; draw++) {
        int d = 2 + (int)(draw % 2);
        struct solid solid = solid_of(0.3, KINEMATICS[draw / 2 % 2]);
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
        assert_true(element_evaluate(d, &solid, &element, u, NULL, &energy, force, NULL, NULL));
        assert_true(element_evaluate(d, &solid, &element, turned, NULL, &same, after, NULL, NULL));
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
    struct solid solid = solid_of(0.3, KINEMATICS_HENCKY);
    double position[8][3], u[8][3] = {{0}}, force[24];
    struct element_shape element;
    distorted(2, 0, 0, position);
    shape(2, position, &element);
    u[2][1] = u[3][1] = -1.01;
    assert_false(element_evaluate(2, &solid, &element, u, NULL, NULL, force, NULL, NULL));
    u[2][1] = NAN;
    assert_false(element_evaluate(2, &solid, &element, u, NULL, NULL, force, NULL, NULL));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(patch_test),
        cmocka_unit_test(forces_and_stiffness_are_derivatives),
        cmocka_unit_test(a_rotated_element_gives_rotated_forces),
        cmocka_unit_test(bad_shapes_are_found),
        cmocka_unit_test(inside_out_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
