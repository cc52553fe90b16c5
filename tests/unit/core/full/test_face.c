/* Protects the volume between the deformed face and the flat: against the volume of the block,
 * which fills the rest of the cell, and its change against differences. True areas, means over them
 * and gaps along normals are those of faces made of planes. */
#include "tests/support/check.h"

#include "core/full/face.h"
#include "core/random.h"
#include "tests/support/block_volume.h"
#include <stdlib.h>
#include <string.h>

struct face_work {
    struct mesh *mesh;
    double *u, *change, *gap; /* gap: from `flat` */
    double flat;
};

static double *numbers(size_t n) {
    double *x = array_create(n, sizeof *x);
    if (x == NULL)
        abort();
    return x;
}

/* A quarter of a step at most, so that no cell folds; random, but the far side moves as one. */
static void fill(const struct mesh *mesh, uint64_t seed, double *u) {
    size_t n = mesh_degrees_of_freedom(mesh), far_side = mesh_far_side(mesh);
    random_uniform((struct random_key){.seed = seed}, 0, 0, n, u);
    for (size_t f = 0; f < n; f++)
        u[f] = (u[f] - 0.5) / 2;
    for (size_t node = far_side; node < mesh->nodes; node++)
        u[mesh_vertical(mesh, node)] = u[mesh_vertical(mesh, far_side)];
}

static void measure_gap(struct face_work *w, double share) {
    for (size_t node = 0; node < w->mesh->face; node++) {
        size_t vertical = mesh_vertical(w->mesh, node);
        w->gap[node] =
            w->mesh->height[node] + w->u[vertical] + share * w->change[vertical] - w->flat;
    }
}

static void open_face(struct face_work *w, struct grid grid, double transition) {
    struct error err = {0};
    struct block block = {.poisson = 0.3, .height = 9 * grid_dx(&grid), .layer_growth = 1.3};
    *w = (struct face_work){.flat = -3};
    if (mesh_create(&w->mesh, &grid, &block, transition, &err) != 0)
        fail_msg("%s", err.text);
    size_t n = mesh_degrees_of_freedom(w->mesh), face = w->mesh->face;
    w->u = numbers(n);
    w->change = numbers(n);
    w->gap = numbers(face);
    for (size_t i = 0; i < face; i++)
        w->gap[i] = 0.4 * sin(2 * (double)i);
    if (mesh_shape(w->mesh, w->gap, &err) != 0)
        fail_msg("%s", err.text);
    fill(w->mesh, 21, w->u);
    fill(w->mesh, 22, w->change);
    measure_gap(w, 0);
}

static void close_face(struct face_work *w) {
    mesh_destroy(&w->mesh);
    free(w->u);
    free(w->change);
    free(w->gap);
}

static const struct {
    struct grid grid;
    double transition;
} CASES[] = {{{16, 1, 1, 1}, INFINITY},
             {{16, 1, 1, 1}, 1},
             {{8, 8, 1, 1}, INFINITY},
             {{8, 8, 1, 1}, 1},
             {{8, 4, 1, 0.8}, INFINITY}};
enum { CASE_COUNT = sizeof CASES / sizeof *CASES };

/* Gap and block fill the cell from the flat to the far side. Nothing but rounding may differ; over
 * the undeformed cells the mean gap is another one. */
static void gap_and_block_fill_the_cell(void **state) {
    (void)state;
    for (size_t c = 0; c < CASE_COUNT; c++) {
        struct face_work w;
        open_face(&w, CASES[c].grid, CASES[c].transition);
        size_t far_side = mesh_far_side(w.mesh);
        double area = (double)w.mesh->face * w.mesh->across;
        double top = w.mesh->height[far_side] + w.u[mesh_vertical(w.mesh, far_side)];
        double gap = top - w.flat - block_volume(w.mesh, w.u) / area, plain = 0;
        check_relative(face_mean_gap(w.mesh, w.u, w.gap), gap, 1e-12);
        for (size_t i = 0; i < w.mesh->face; i++)
            plain += w.gap[i] / (double)w.mesh->face;
        check_relative(face_mean_gap(w.mesh, NULL, w.gap), plain, 1e-12);
        assert_true(fabs(gap - plain) > 1e-5);
        close_face(&w);
    }
}

/* The mean gap is a polynomial of at most third degree in the displacements: the difference over
 * 2e-3 of the change is off by its third derivative, about 1e-6. */
static void changes_are_those_of_differences(void **state) {
    (void)state;
    static const double SHARE = 1e-3;
    for (size_t c = 0; c < CASE_COUNT; c++)
        for (int deforms = 0; deforms < 2; deforms++) {
            struct face_work w;
            open_face(&w, CASES[c].grid, CASES[c].transition);
            size_t n = mesh_degrees_of_freedom(w.mesh);
            double *moved = numbers(n), at[2];
            double *u = deforms ? w.u : NULL;
            double told = face_mean_gap_change(w.mesh, u, w.gap, w.change);
            for (int side = 0; side < 2; side++) {
                double share = side == 0 ? -SHARE : SHARE;
                for (size_t f = 0; f < n; f++)
                    moved[f] = w.u[f] + share * w.change[f];
                measure_gap(&w, share);
                at[side] = face_mean_gap(w.mesh, deforms ? moved : NULL, w.gap);
            }
            check_close(told, (at[1] - at[0]) / (2 * SHARE), 1e-6);
            assert_true(fabs(told) > 1e-4);
            free(moved);
            close_face(&w);
        }
}

/* Nodes 0 and 1 in contact; the cell between them shrinks by a half, and that to the left of node 0
 * grows by as much: (1.5 + 2 x 0.5 + 1)/4. */
static void stretch_is_of_the_cells_around_touching_nodes(void **state) {
    (void)state;
    struct face_work w;
    bool active[16] = {true, true};
    open_face(&w, CASES[0].grid, INFINITY);
    memset(w.u, 0, mesh_degrees_of_freedom(w.mesh) * sizeof *w.u);
    w.u[0] = 0.5;
    check_close(face_contact_stretch(w.mesh, w.u, active), 3.5 / 4, 1e-15);
    active[0] = active[1] = false;
    assert_true(isnan(face_contact_stretch(w.mesh, w.u, active)));
    close_face(&w);
}

/* --- faces of planes --- */

static const double RISE = 0.4, RISE_ACROSS = 0.25; /* per column; per length */

/* Returns the slope of step i of n: three quarters rise, and the last one falls as much. */
static double slope_at(size_t i, size_t n, double rise) {
    return n == 1 ? 0 : i < n - n / 4 ? rise : -3 * rise;
}

/* Returns the area of the plane cell in a row and column over its projection. */
static double plane_area(const struct mesh *mesh, size_t j, size_t i) {
    double x = slope_at(i, mesh->level[0].nx, RISE);
    double y = slope_at(j, mesh->level[0].ny, RISE_ACROSS);
    return sqrt(1 + x * x + y * y);
}

/* Puts the face on planes by displacements, whatever its mesh is. Sideways all moves alike. */
static void lay_planes(struct face_work *w) {
    const struct level *face = &w->mesh->level[0];
    double down = 0;
    memset(w->u, 0, mesh_degrees_of_freedom(w->mesh) * sizeof *w->u);
    for (size_t j = 0; j < face->ny; j++) {
        double height = down;
        for (size_t i = 0; i < face->nx; i++) {
            size_t node = j * face->nx + i;
            w->u[node * (size_t)w->mesh->dimension] += 0.3;
            w->u[mesh_vertical(w->mesh, node)] = height - w->mesh->height[node];
            w->gap[node] = height - w->flat;
            height += slope_at(i, face->nx, RISE);
        }
        down += w->mesh->across * slope_at(j, face->ny, RISE_ACROSS);
    }
}

/* Areas of one node are those of the cells around it. */
static void areas_of_planes_are_exact(void **state) {
    (void)state;
    bool active[64] = {false};
    for (size_t c = 0; c < CASE_COUNT; c++) {
        struct face_work w;
        open_face(&w, CASES[c].grid, CASES[c].transition);
        lay_planes(&w);
        const struct level *face = &w.mesh->level[0];
        double area = 0, volume = 0;
        for (size_t j = 0; j < face->ny; j++)
            for (size_t i = 0; i < face->nx; i++) {
                double here = plane_area(w.mesh, j, i);
                area += here;
                size_t right = level_node(face, j, i + 1);
                size_t back = level_node(face, j + 1, i);          /* of profiles the node itself */
                volume += here * (w.gap[right] + w.gap[back]) / 2; /* at the middle of a plane */
            }
        assert_true(isnan(face_measure_tilt(w.mesh, w.u, active).contact));
        active[0] = true;
        struct face_tilt tilt = face_measure_tilt(w.mesh, w.u, active);
        check_close(tilt.face, area / (double)w.mesh->face - 1, 1e-13);
        double around = (plane_area(w.mesh, 0, 0) + plane_area(w.mesh, 0, face->nx - 1)) / 2;
        if (face->ny > 1)
            around = around / 2 + (plane_area(w.mesh, face->ny - 1, 0) +
                                   plane_area(w.mesh, face->ny - 1, face->nx - 1)) /
                                      4;
        check_close(tilt.contact, around - 1, 1e-13);
        active[0] = false;
        check_relative(face_mean_gap_current(w.mesh, w.u, w.gap), volume / area, 1e-13);
        for (size_t i = 0; i < w.mesh->face; i++)
            w.gap[i] = 0.7;
        check_relative(face_mean_gap_current(w.mesh, w.u, w.gap), 0.7, 1e-14);
        close_face(&w);
    }
}

/* On a plane the gap along the normal is the vertical one times the root of 1 + slope^2. On the
 * ridge at node 0 the unit normals of both sides, and of all four planes, are averaged. Nodes in
 * contact keep their gaps. */
static void gaps_turn_with_the_normal(void **state) {
    (void)state;
    const bool active[64] = {[4] = true};
    for (size_t c = 0; c < CASE_COUNT; c++) {
        struct face_work w;
        open_face(&w, CASES[c].grid, CASES[c].transition);
        lay_planes(&w);
        const size_t nx = w.mesh->level[0].nx, ny = w.mesh->level[0].ny;
        size_t inner = (ny > 1 ? nx : 0) + 1;
        double before = w.gap[inner], ridge = w.gap[0], normal[3] = {0};
        w.gap[2] = 0;
        w.gap[3] = -0.1;
        w.gap[4] = 0.1;
        face_turn_gaps(w.mesh, w.u, active, w.gap);
        check_relative(w.gap[inner], before * plane_area(w.mesh, 0, 0), 1e-14);
        for (size_t a = 0; a < 4; a++) {
            size_t j = a < 2 ? 0 : ny - 1, i = a % 2 == 0 ? 0 : nx - 1;
            double area = plane_area(w.mesh, j, i);
            normal[0] += slope_at(i, nx, RISE) / area;
            normal[1] += slope_at(j, ny, RISE_ACROSS) / area;
            normal[2] += 1 / area;
        }
        double length = sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
        check_relative(w.gap[0], ridge * length / normal[2], 1e-14);
        assert_true(w.gap[0] > 1.001 * ridge);
        assert_true(w.gap[2] == 0 && w.gap[3] < -0.1 && w.gap[4] == 0.1);
        close_face(&w);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(gap_and_block_fill_the_cell),
        cmocka_unit_test(changes_are_those_of_differences),
        cmocka_unit_test(stretch_is_of_the_cells_around_touching_nodes),
        cmocka_unit_test(areas_of_planes_are_exact),
        cmocka_unit_test(gaps_turn_with_the_normal),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
