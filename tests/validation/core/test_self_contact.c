/* Protects steep profiles of full: a symmetric groove that closes is one flank against a rigid
 * plane, which is solved here by itself; and a rough profile of slope 1 that buckles and overhangs
 * has values beyond. */
#include "tests/support/check.h"

#include "core/full/face.h"
#include "core/full/full.h"
#include "core/surface/surface.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { NODES_MOST = 320 };

struct pressed {
    struct grid grid;
    struct full *full;
    struct contact_state state;
    struct full_report report;
    double z[NODES_MOST];
};

static void open_profile(struct pressed *p, size_t n, double poisson, double growth) {
    struct error err = {0};
    struct block block = {.model = MODEL_LAYERED,
                          .poisson = poisson,
                          .height = 1,
                          .layer_growth = growth,
                          .weighting = GAP_DUAL};
    *p = (struct pressed){.grid = {.nx = n, .ny = 1, .lx = 1, .ly = 1}};
    if (full_create(&p->full, &p->grid, &block, &FULL_DEFAULTS, &err) != 0)
        fail_msg("%s", err.text);
}

static void press(struct pressed *p, double pressure) {
    struct error err = {0};
    if (full_press(p->full, pressure, &p->state, &p->report, &err) != 0)
        fail_msg("%s", err.text);
    check_close(p->report.balance, 0, 1e-8);
    assert_true(p->report.self.penetration < 1e-6);
}

/* A groove of a tenth of the cell, 0.2 deep, in an even face. */
static void open_groove(struct pressed *p, size_t n) {
    struct error err = {0};
    open_profile(p, n, 0.45, 1.3);
    for (size_t i = 0; i < n; i++) {
        double from = fabs((double)i / (double)n - 0.5);
        p->z[i] = from < 0.05 ? -0.2 * (1 - from / 0.05) : 0;
    }
    if (full_begin(p->full, p->z, &err) != 0)
        fail_msg("%s", err.text);
}

/* The groove again, without contact of the face with itself: nodes beside its middle are kept on
 * their side of it by stiff springs. Starts from u, and returns the force on one flank. */
static double plane_force(const struct pressed *p, double pressure, double *u) {
    static const double SPRING = 1e5;
    const struct newton *n = full_newton(p->full);
    const struct mesh *mesh = n->mesh;
    size_t count = mesh_degrees_of_freedom(mesh), far = mesh_far_side(mesh);
    struct tangent *tangent = NULL;
    struct factorisation *factorisation = NULL;
    struct tangent_link *link = array_create(mesh->face, sizeof *link);
    double *force = array_create(count, sizeof *force), *x = array_create(count, sizeof *x);
    double middle = (double)mesh->face / 2, left = 0, largest = 1;
    struct error err = {0};
    assert_true(link != NULL && force != NULL && x != NULL);
    if (tangent_create(&tangent, mesh, &n->material, false, &err) != 0 ||
        factorisation_create(&factorisation, mesh, &err) != 0)
        fail_msg("%s", err.text);
    for (int round = 0; round < 60 && largest > 1e-9; round++) {
        assert_true(tangent_evaluate(mesh, &n->material, u, NULL, force, tangent));
        left = 0;
        tangent->links = 0;
        for (size_t i = 1; i < mesh->face; i++) {
            double beyond = (double)i + u[2 * i] - middle;
            bool on_left = (double)i < middle;
            if ((double)i == middle || (on_left ? beyond <= 0 : beyond >= 0))
                continue;
            force[2 * i] += SPRING * beyond;
            left += on_left ? SPRING * beyond : 0;
            link[tangent->links] = (struct tangent_link){.at = {2 * i}, .stiffness = {{SPRING}}};
            for (size_t a = 1; a < LINK_MOST; a++)
                link[tangent->links].at[a] = a < 2 ? 2 * i + 1 : link[tangent->links].at[1];
            tangent->links++;
        }
        tangent->link = link;
        double down = -pressure * (double)mesh->face;
        largest = 0;
        for (size_t f = 0; f < count; f++)
            x[f] = -force[f];
        for (size_t i = far; i < mesh->nodes; i++) {
            down += x[2 * i + 1];
            x[2 * i + 1] = 0;
        }
        x[2 * far + 1] = down;
        for (size_t i = 0; i < mesh->face; i++)
            x[2 * i + 1] = n->active[i] ? 0 : x[2 * i + 1];
        for (size_t f = 0; f < count; f++)
            largest = fmax(largest, fabs(x[f]));
        if (factorisation_run(factorisation, tangent, n->active, &err) != 0 ||
            factorisation_solve(factorisation, x, &err) != 0)
            fail_msg("%s", err.text);
        double most = 0;
        for (size_t f = 0; f < count; f++)
            most = fmax(most, fabs(x[f]));
        for (size_t f = 0; f < count; f++)
            u[f] += fmin(1, 0.25 / most) * x[f];
    }
    assert_true(largest <= 1e-9);
    factorisation_destroy(&factorisation);
    tangent_destroy(&tangent);
    free(link);
    free(force);
    free(x);
    return left;
}

/* The force on a flank, over E* times the cell. Meshes differ by where a groove of few cells
 * begins to close; the two solutions of one mesh by the smoothed face, to second order. */
static void a_groove_closes_on_its_plane(void **state) {
    (void)state;
    static const size_t NODES[] = {80, 160};
    double off[2];
    for (size_t m = 0; m < 2; m++) {
        struct pressed p;
        open_groove(&p, NODES[m]);
        press(&p, 0.2);
        press(&p, 0.6);
        const struct newton *n = full_newton(p.full);
        size_t count = mesh_degrees_of_freedom(n->mesh);
        double *u = array_create(count, sizeof *u);
        assert_non_null(u);
        memcpy(u, n->u, count * sizeof *u);
        double plane = plane_force(&p, 0.6, u), across = 0, away = 0;
        for (size_t c = 0; c < n->self.count; c++)
            across += n->self.pair[c].force * -n->self.pair[c].normal[0];
        for (size_t f = 0; f < 2 * n->mesh->face; f++)
            away = fmax(away, fabs(u[f] - n->u[f]));
        off[m] = across / plane - 1;
        print_message("%zu nodes: %zu of a flank bear %.5f E* of the cell, a plane %.5f; the face "
                      "is off by %.3f columns\n",
                      NODES[m], p.report.self.nodes, across / (double)NODES[m],
                      plane / (double)NODES[m], away);
        assert_true(p.report.self.nodes >= 3 && plane > 0);
        free(u);
        full_destroy(&p.full);
    }
    assert_true(fabs(off[0]) < 0.05 && fabs(off[1]) < 0.02 && fabs(off[1]) < fabs(off[0]));
}

/* A profile of RMS slope 1 with eight shortest waves buckles and overhangs before a load of 0.1,
 * and goes on. What full allowed before ends there. */
static void a_steep_profile_goes_on(void **state) {
    (void)state;
    enum { NODES = 128 };
    struct spectrum spectrum = {.type = SPECTRUM_SELF_AFFINE,
                                .hurst = 0.8,
                                .wavelength_long = 0.5,
                                .wavelength_rolloff = 0.5,
                                .wavelength_short = 1.0 / 16,
                                .scale = SCALE_RMS_SLOPE,
                                .scale_value = 1};
    struct generator *generator = NULL;
    struct pressed p;
    struct error err = {0};
    open_profile(&p, NODES, 0.3, 1.2);
    if (generator_create(&generator, &spectrum, &p.grid, &SURFACE_DEFAULTS, &err) != 0 ||
        generator_run(generator, (struct random_key){.seed = 7}, p.z, NULL, &err) != 0 ||
        full_begin(p.full, p.z, &err) != 0)
        fail_msg("%s", err.text);
    generator_destroy(&generator);
    full_set_overhangs(p.full, false);
    assert_int_equal(full_press(p.full, 0.1, &p.state, &p.report, &err), ERROR_NUMERIC);
    assert_non_null(strstr(err.text, "mean pressure of 0.1 E* was reached up to"));
    full_set_overhangs(p.full, true);
    press(&p, 0.1);
    size_t nodes = p.state.nodes, jumps = p.report.jumps;
    double gap = p.state.mean_gap;
    const struct newton *n = full_newton(p.full);
    assert_true(face_folds(n->mesh, n->u));
    press(&p, 0.15);
    jumps += p.report.jumps;
    assert_true(p.state.nodes > nodes && p.state.mean_gap < gap && p.state.mean_gap > 0);
    assert_true(jumps > 0);
    full_destroy(&p.full);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_groove_closes_on_its_plane),
        cmocka_unit_test(a_steep_profile_goes_on),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
