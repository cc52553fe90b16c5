/* Protects the area under load that linear models report: against the strain of each node. */
#include "tests/support/check.h"

#include "core/contact/stretch.h"
#include "tests/support/contact_scene.h"

/* Under a pressure p a half-space strains by -(1 - 2 nu)/(1 - nu) p; in the cell the mean is taken
 * off. The nodes in contact cover the sum of what each covers then: all of the pressure acts on
 * them, so that it is one number for any shape of the contact, to rounding. */
static void nodes_strained_one_by_one_cover_the_fraction(void **state) {
    (void)state;
    static const struct grid GRIDS[] = {{64, 1, 1, 1}, {16, 12, 1, 0.75}};
    static const double NU[] = {0, 0.25, 0.49};
    for (size_t c = 0; c < 6; c++) {
        struct scene scene;
        double yields = (1 - 2 * NU[c % 3]) / (1 - NU[c % 3]), pressure = 0.002;
        scene_open(&scene, GRIDS[c / 3], DEEP, 1e-10);
        size_t n = scene_points(&scene);
        for (size_t i = 0; i < n; i++)
            scene.z[i] = 0.01 * sin(1.7 * (double)i) + 0.01 * cos(0.3 * (double)i);
        scene_begin(&scene);
        scene_press(&scene, pressure);
        double now = 0;
        for (size_t i = 0; i < n; i++)
            if (scene.state.p[i] > 0)
                now += (1 - yields * (scene.state.p[i] - pressure)) / (double)n;
        double fraction = scene_area(&scene).nodes;
        assert_true(fraction > 0.02 && fraction < 0.5);
        check_relative(stretch_fraction(fraction, stretch_open(NU[c % 3], pressure)), now, 1e-12);
        assert_true(now < fraction * (1 - 1e-3) || yields < 0.1);
        scene_close(&scene);
    }
}

static void ends(void **state) {
    (void)state;
    assert_true(stretch_fraction(1, 1.03) == 1);
    assert_true(stretch_fraction(0.3, 1) == 0.3);
    assert_true(stretch_first_order(0.6, 1 + STRETCH_MOST) ==
                stretch_fraction(0.6, 1 + STRETCH_MOST));
    assert_true(isnan(stretch_first_order(0.6, 1.01 + STRETCH_MOST)));
    assert_true(isnan(stretch_first_order(0.3, 1.22))); /* what touches shrinks by 0.51 of it */
    assert_true(stretch_free(0.3, 1.14) > 0.15 && isnan(stretch_free(0.3, 1.16)));
    assert_true(isnan(stretch_first_order(0.3, stretch_open(0.3, 2147483648.0))));
    check_close(stretch_open(0.5, 0.1), 1, 1e-15);
    check_close(stretch_open(0, 0.1), 1.1, 1e-15);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nodes_strained_one_by_one_cover_the_fraction),
        cmocka_unit_test(ends),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
