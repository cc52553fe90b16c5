/* A face that meets itself, by itself: its pairs, their forces and their tangent. */
#ifndef RUGO_TESTS_SUPPORT_FOLD_H
#define RUGO_TESTS_SUPPORT_FOLD_H

#include "core/full/self_contact.h"
#include "tests/support/check.h"
#include <stdlib.h>
#include <string.h>

enum { FOLD_MOST = 128 }; /* nodes of a face */

struct folded {
    struct mesh *mesh;
    struct tangent *tangent;
    struct self_contact self;
    double *u, *force, *change;
    bool active[FOLD_MOST];
};

static void open_fold(struct folded *f, size_t nx, size_t ny, double layer_growth) {
    struct error err = {0};
    struct grid grid = {.nx = nx, .ny = ny, .lx = (double)nx, .ly = (double)ny};
    struct block block = {.poisson = 0.3, .height = 12, .layer_growth = layer_growth};
    struct material material = material_of(block.poisson, KINEMATICS_HENCKY);
    *f = (struct folded){0};
    if (mesh_create(&f->mesh, &grid, &block, INFINITY, &err) != 0 ||
        tangent_create(&f->tangent, f->mesh, &material, false, &err) != 0 ||
        self_contact_create(&f->self, f->mesh, &err) != 0)
        fail_msg("%s", err.text);
    size_t count = mesh_degrees_of_freedom(f->mesh);
    f->u = array_create(count, sizeof *f->u);
    f->force = array_create(count, sizeof *f->force);
    f->change = array_create(count, sizeof *f->change);
    assert_true(f->u != NULL && f->force != NULL && f->change != NULL);
}

static void close_fold(struct folded *f) {
    self_contact_clear(&f->self);
    tangent_destroy(&f->tangent);
    mesh_destroy(&f->mesh);
    free(f->u);
    free(f->force);
    free(f->change);
}

/* Computes forces and tangent; returns the energy. */
static double find(struct folded *f) {
    double energy = 0;
    memset(f->force, 0, mesh_degrees_of_freedom(f->mesh) * sizeof *f->force);
    self_contact_evaluate(&f->self, false, f->u, f->force, f->tangent);
    for (size_t c = 0; c < f->self.count; c++) {
        const struct self_pair *pair = &f->self.pair[c];
        double stiffness = (pair->force - pair->multiplier) / -pair->gap;
        if (pair->force > 0)
            energy += pair->force * pair->force / (2 * stiffness);
    }
    return energy;
}

#endif
