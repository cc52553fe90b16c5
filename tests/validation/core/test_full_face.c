/* Protects what the model full reports of the face as it is under load: gap and stiffness against
 * the volume of the block, areas against those of a linear model to first order. */
#include "tests/support/check.h"

#include "core/contact/stretch.h"
#include "core/full/full.h"
#include "core/surface/surface.h"
#include "tests/support/block_volume.h"
#include "tests/support/contact_scene.h"
#include "tests/support/effort.h"

static const struct grid GRIDS[] = {{128, 1, 1, 1}, {16, 16, 1, 1}, {16, 12, 1, 0.8}};

/* A rough profile, Hurst's exponent 0.8, of 2 to 16 waves a cell; on a surface a double sine. */
static void fill_rough(struct scene *scene, double slope) {
    const struct grid *grid = &scene->grid;
    struct spectrum spectrum = {.type = SPECTRUM_SELF_AFFINE,
                                .hurst = 0.8,
                                .wavelength_long = grid->lx / 2,
                                .wavelength_rolloff = grid->lx / 2,
                                .wavelength_short = grid->lx / 16,
                                .scale = SCALE_RMS_SLOPE,
                                .scale_value = slope};
    struct generator *generator = NULL;
    struct error err = {0};
    for (size_t i = 0; i < grid_points(grid); i++) {
        size_t column = i % grid->nx, row = i / grid->nx;
        scene->z[i] = slope / (2 * M_PI) * cos(2 * M_PI * (double)column / (double)grid->nx) *
                      cos(2 * M_PI * (double)row / (double)grid->ny);
    }
    if (!grid_is_profile(grid))
        return;
    if (generator_create(&generator, &spectrum, grid, &SURFACE_DEFAULTS, &err) != 0 ||
        generator_run(generator, (struct random_key){.seed = 20260102}, scene->z, NULL, &err) != 0)
        fail_msg("%s", err.text);
    generator_destroy(&generator);
}

struct pressed {
    struct scene scene; /* the layered model of the same mesh, its heights those of both */
    struct full *full;
    struct contact_state state;
    struct full_report report;
};

static void open_rough(struct pressed *p, struct grid grid, struct block block,
                       enum kinematics kinematics, double slope) {
    struct full_options options = FULL_DEFAULTS;
    struct error err = {0};
    options.kinematics = kinematics;
    *p = (struct pressed){0};
    scene_open(&p->scene, grid, block, 1e-10);
    fill_rough(&p->scene, slope);
    scene_begin(&p->scene);
    if (full_create(&p->full, &grid, &block, &options, &err) != 0 ||
        full_begin(p->full, p->scene.z, &err) != 0)
        fail_msg("%s", err.text);
}

static void press(struct pressed *p, double pressure) {
    struct error err = {0};
    if (full_press(p->full, pressure, &p->state, &p->report, &err) != 0)
        fail_msg("%s", err.text);
}

static void close_rough(struct pressed *p) {
    full_destroy(&p->full);
    scene_close(&p->scene);
}

/* The far side less the flat is the mean height of the block and of the gap below it. */
static double gap_by_volumes(struct pressed *p) {
    const struct mesh *mesh = full_mesh(p->full);
    const double *user = full_displacement(p->full);
    size_t far_side = mesh_far_side(mesh), n = mesh_degrees_of_freedom(mesh);
    double *u = zeros(n), highest = -INFINITY;
    for (size_t f = 0; f < n; f++)
        u[f] = user[f] / mesh->unit;
    for (size_t node = 0; node < mesh->face; node++)
        highest = fmax(highest, -mesh->height[node]);
    double mean = block_volume(mesh, u) / ((double)mesh->face * mesh->across);
    double top = mesh->height[far_side] + u[mesh_vertical(mesh, far_side)];
    free(u);
    return (top + highest - mean) * mesh->unit;
}

/* Where strains are finite. The gap is a hundredth of the block's height, which is rounded: 1e-10;
 * over the undeformed face it would be 0.2 to 2.5 % less. The stiffness is that of a difference
 * over 2e-4 of the load, with changes of the active set in between: 2e-5, twice what is seen. */
static void gap_and_stiffness_are_those_of_the_face_as_pressed(void **state) {
    (void)state;
    static const double SLOPE = 0.3, STEP = 1e-4;
    for (size_t c = 0; c < 6; c++) {
        struct pressed p;
        double gap[2];
        struct block block = {.model = MODEL_LAYERED,
                              .poisson = 0.3,
                              .height = 1.5,
                              .layer_growth = 1.2,
                              .weighting = c < 3 ? GAP_DUAL : GAP_STANDARD};
        open_rough(&p, GRIDS[c % 3], block, c < 3 ? KINEMATICS_HENCKY : KINEMATICS_ST_VENANT,
                   SLOPE);
        for (double load = 0.02 * SLOPE; load < 0.2 * SLOPE; load *= 3) {
            press(&p, load);
            double told = p.state.mean_gap, stiffness = p.state.stiffness;
            check_relative(told, gap_by_volumes(&p), 1e-10);
            assert_true(told > 1.001 * mean_of(scene_points(&p.scene), p.state.gap));
            for (int side = 0; side < 2; side++) {
                press(&p, load * (side == 0 ? 1 - STEP : 1 + STEP));
                gap[side] = p.state.mean_gap;
            }
            check_relative(stiffness, 2 * STEP * load / (gap[0] - gap[1]), 2e-5);
        }
        close_rough(&p);
    }
}

/* Where strains are small the face counts as undeformed. */
static void small_strains_leave_the_face(void **state) {
    (void)state;
    for (size_t c = 0; c < 3; c++) {
        struct pressed p;
        struct block block = {
            .model = MODEL_LAYERED, .poisson = 0.3, .height = 1.5, .layer_growth = 1.2};
        open_rough(&p, GRIDS[c], block, KINEMATICS_SMALL, 0.3);
        press(&p, 0.03);
        check_relative(p.state.mean_gap, mean_of(scene_points(&p.scene), p.state.gap), 1e-12);
        close_rough(&p);
    }
}

/* The difference from the linear model's stretched area falls with the slope: it has the second
 * order of strains and the effect of sideways motion on the gap. Measured are 0.083, 0.035 and
 * 0.025 of the slope for these nu, bounds are 1.3 times that. The part that does not fall is due to
 * the mesh, 2.8e-3. The columns of one model alone widen, and its cells are strained evenly. A node
 * more or less in contact changes how fast edges seem to move with the load. At slope 0.1 the
 * undeformed area is 1.0 to 4.3 % off for the first two nu, over all loads at least one and a half
 * times as far as the stretched one. */
static void a_linear_model_knows_the_stretch(void **state) {
    (void)state;
    static const struct {
        double poisson, rest;
    } MATERIALS[] = {{0, 0.11}, {0.3, 0.05}, {0.4999, 0.035}};
    static const double SLOPES[] = {0.01, 0.03, 0.1};
    static const struct grid FINE[] = {{256, 1, 1, 1}, {32, 32, 1, 1}, {24, 16, 1, 0.8}};
    for (size_t c = 0; c < 27; c++) {
        /* Without effort each ratio is tried on one of the two surfaces, at the outer slopes. */
        if (c >= 9 && effort() == 1 && (c / 3 % 3 == 1 || c % 2 == 1))
            continue;
        struct pressed p;
        double poisson = MATERIALS[c % 3].poisson, slope = SLOPES[c / 3 % 3];
        struct block block = {.model = MODEL_LAYERED,
                              .poisson = poisson,
                              .height = 1.5,
                              .layer_growth = 1.2,
                              .weighting = GAP_DUAL};
        open_rough(&p, FINE[c / 9], block, KINEMATICS_HENCKY, slope);
        double left = 0, before = 0;
        for (double load = 0.02 * slope; load < 0.4 * slope; load *= 3) {
            struct contact_area area;
            press(&p, load);
            contact_area(p.scene.areas, &p.state, &area);
            double now = stretch_fraction(area.edges, p.report.open_stretch);
            scene_press(&p.scene, load);
            area = scene_area(&p.scene);
            double told = stretch_fraction(area.edges, stretch_open(poisson, load));
            check_relative(told, now, 2.8e-3 + MATERIALS[c % 3].rest * slope);
            left += fabs(told - now);
            before += fabs(area.edges - now);
        }
        if (poisson < 0.4 && slope > 0.05)
            assert_true(1.5 * left < before);
        close_rough(&p);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(gap_and_stiffness_are_those_of_the_face_as_pressed),
        cmocka_unit_test(small_strains_leave_the_face),
        cmocka_unit_test(a_linear_model_knows_the_stretch),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
