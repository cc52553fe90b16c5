/* Protects contact in free space on maps of one summit: Hertz's area, peak pressure, approach and
 * stiffness (F11.3) within 0.2 % where 64 points lie across the contact, wherever its middle lies
 * between them, and the better the finer. */
#include "tests/support/check.h"

#include "tests/support/contact_scene.h"
#include "tests/support/hertz.h"
#include <stdio.h>

enum { PLACES = 3 };

/* Largest errors, relative, over positions of the summit. */
struct errors {
    double area, peak, approach, stiffness;
};

struct summit {
    double radius; /* of curvature; the contact's radius is 1 */
    bool sphere;   /* else a paraboloid */
};

static double height_of(const struct summit *summit, double r) {
    double radius = summit->radius;
    return summit->sphere ? -r * r / (radius + sqrt(radius * radius - r * r))
                          : -r * r / (2 * radius);
}

static void raise_error(double *most, double value, double expected) {
    double error = fabs(value / expected - 1);
    *most = error <= *most ? *most : error; /* a NaN stays */
}

static void press_one(const struct summit *summit, const struct grid *grid, size_t place,
                      struct errors *out) {
    struct error err = {0};
    struct compliance *compliance = NULL;
    struct contact *contact = NULL;
    struct area_workspace *areas = NULL;
    struct contact_state state;
    struct contact_area area;
    bool profile = grid_is_profile(grid);
    size_t n = grid_points(grid);
    double *z = zeros(n), radius = summit->radius, top = -INFINITY, cell = grid->lx;
    double x0 = grid->lx / 2 + grid_dx(grid) * fmod(0.618034 * (double)place, 1);
    double y0 = profile ? 0 : grid->ly / 2 + grid_dy(grid) * fmod(0.754878 * (double)place, 1);
    for (size_t j = 0; j < grid->ny; j++)
        for (size_t i = 0; i < grid->nx; i++) {
            double y = profile ? 0 : (double)j * grid_dy(grid) - y0;
            z[j * grid->nx + i] = height_of(summit, hypot((double)i * grid_dx(grid) - x0, y));
            top = fmax(top, z[j * grid->nx + i]);
        }
    /* Under these loads the radius or half-width is 1. */
    double load = profile ? M_PI / (4 * radius) : 4 / (3 * radius);
    check_close(profile ? hertz_line_half_width(load, radius) : hertz_sphere_radius(load, radius),
                1, 1e-12);
    if (!profile)
        cell *= grid->ly;
    if (compliance_create_open(&compliance, grid, &DEEP, &err) != 0 ||
        contact_create(&contact, compliance, &CONTACT_DEFAULTS, &err) != 0 ||
        area_workspace_create(&areas, compliance, &err) != 0 ||
        contact_begin(contact, z, &err) != 0 ||
        contact_press(contact, load / cell, &state, &err) != 0)
        fail_msg("%s", err.text);
    contact_area(areas, &state, &area);
    raise_error(&out->area, area.edges * cell, profile ? 2 : M_PI);
    raise_error(&out->peak, largest(n, state.p), (profile ? 0.5 : 2 / M_PI) / radius);
    /* The flat's displacement in the middle of a line contact is (2 P/pi E*) (ln(2 lx/a) + 1/2),
     * against a point lx from it; the highest point of the map is not the summit's. */
    raise_error(&out->approach, state.approach - top,
                profile ? 2 * load / M_PI * (log(2 * grid->lx) + 0.5) : 1 / radius);
    if (!profile)
        raise_error(&out->stiffness, state.stiffness * cell, 2);
    area_workspace_destroy(&areas);
    contact_destroy(&contact);
    compliance_destroy(&compliance);
    free(z);
}

/* points: across the contact. steps_y: rows a column's spacing, 0 for a profile. */
static struct errors press_summit(const struct summit *summit, size_t points, size_t steps_y) {
    struct errors errors = {0};
    size_t nx = points + points / 3;
    double length = 2.0 * (double)nx / (double)points;
    struct grid grid = {nx, steps_y > 0 ? nx * steps_y : 1, length, length};
    for (size_t place = 0; place < PLACES; place++)
        press_one(summit, &grid, place, &errors);
    printf("%zu points: area %.3f %%, peak %.3f %%, approach %.4f %%, stiffness %.3f %%\n", points,
           100 * errors.area, 100 * errors.peak, 100 * errors.approach, 100 * errors.stiffness);
    return errors;
}

static void check_below(const struct errors *errors, double most) {
    assert_true(errors->area <= most);
    assert_true(errors->peak <= most);
    assert_true(errors->approach <= most);
    assert_true(errors->stiffness <= most);
}

static void check_summit(const struct summit *summit, size_t steps_y) {
    struct errors coarse = press_summit(summit, 16, steps_y);
    struct errors fine = press_summit(summit, 64, steps_y);
    check_below(&coarse, 0.02);
    check_below(&fine, 0.002);
    assert_true(fine.area < coarse.area && fine.peak < coarse.peak);
    assert_true(fine.approach < coarse.approach);
}

static void paraboloid(void **state) {
    (void)state;
    check_summit(&(struct summit){.radius = 50}, 1);
}

static void paraboloid_on_rectangles(void **state) {
    (void)state;
    check_summit(&(struct summit){.radius = 50}, 2);
}

/* Its contact is 100 times smaller than its radius: Hertz's parabola is 1e-4 off. */
static void sphere(void **state) {
    (void)state;
    check_summit(&(struct summit){.radius = 100, .sphere = true}, 1);
}

static void cylinder(void **state) {
    (void)state;
    check_summit(&(struct summit){.radius = 50}, 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(paraboloid),
        cmocka_unit_test(paraboloid_on_rectangles),
        cmocka_unit_test(sphere),
        cmocka_unit_test(cylinder),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
