/* Small contact problems for tests, and an independent judge of their solutions: displacements by a
 * sum over all pairs of nodes, weights node by node, no transform. Include after check.h. */
#ifndef RUGO_TESTS_SUPPORT_CONTACT_SCENE_H
#define RUGO_TESTS_SUPPORT_CONTACT_SCENE_H

#include "core/contact/area.h"
#include "core/contact/contact.h"
#include "core/contact/patches.h"
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const struct block DEEP = {.model = MODEL_HALFSPACE, .poisson = 0.3, .height = INFINITY};

struct scene {
    struct grid grid;
    struct block block;
    double tolerance;
    struct compliance *compliance;
    struct contact *contact;
    struct area_workspace *areas;
    struct contact_state state; /* of the last load */
    double *z;                  /* grid_points */
    double *response;           /* scene_response, made where it is first asked for */
};

static inline size_t scene_points(const struct scene *scene) {
    return grid_points(&scene->grid);
}

static inline double *zeros(size_t n) {
    double *x = array_create(n, sizeof *x);
    if (x == NULL)
        abort();
    return x;
}

/* Zero heights: fill scene->z, then scene_begin. */
static inline void scene_open(struct scene *scene, struct grid grid, struct block block,
                              double tolerance) {
    struct error err = {0};
    struct contact_options options = CONTACT_DEFAULTS;
    options.tolerance = tolerance;
    *scene = (struct scene){.grid = grid, .block = block, .tolerance = tolerance};
    scene->z = zeros(scene_points(scene));
    if (compliance_create(&scene->compliance, &grid, &block, &err) != 0 ||
        contact_create(&scene->contact, scene->compliance, &options, &err) != 0 ||
        area_workspace_create(&scene->areas, scene->compliance, &err) != 0)
        fail_msg("%s", err.text);
}

static inline void scene_close(struct scene *scene) {
    area_workspace_destroy(&scene->areas);
    contact_destroy(&scene->contact);
    compliance_destroy(&scene->compliance);
    free(scene->z);
    free(scene->response);
    *scene = (struct scene){0};
}

static inline void scene_begin(struct scene *scene) {
    struct error err = {0};
    if (contact_begin(scene->contact, scene->z, &err) != 0)
        fail_msg("%s", err.text);
}

/* Fills a profile of unit length with one wave, whose crest stands `shift` steps before the first
 * node, and lifts it off. */
static inline void scene_begin_wave(struct scene *scene, double shift) {
    double points = (double)scene->grid.nx;
    for (size_t i = 0; i < scene->grid.nx; i++)
        scene->z[i] = cos(2 * M_PI * ((double)i + shift) / points);
    scene_begin(scene);
}

/* Gives the face a hardness, and begins anew. */
static inline void scene_harden(struct scene *scene, double hardness) {
    struct error err = {0};
    struct contact_options options = CONTACT_DEFAULTS;
    options.tolerance = scene->tolerance;
    options.hardness = hardness;
    contact_destroy(&scene->contact);
    if (contact_create(&scene->contact, scene->compliance, &options, &err) != 0)
        fail_msg("%s", err.text);
    scene_begin(scene);
}

static inline void scene_press(struct scene *scene, double pressure) {
    struct error err = {0};
    if (contact_press(scene->contact, pressure, &scene->state, &err) != 0)
        fail_msg("%s", err.text);
}

static inline struct contact_area scene_area(const struct scene *scene) {
    struct contact_area area;
    contact_area(scene->areas, &scene->state, &area);
    return area;
}

/* Displacement of each node for a pressure of 1 at node 0, mean 0: the sum over all waves. */
static inline double *scene_response(struct scene *scene) {
    const struct grid *grid = &scene->grid;
    if (scene->response != NULL)
        return scene->response;
    double *response = scene->response = zeros(scene_points(scene));
    for (size_t j = 0; j < grid->ny; j++)
        for (size_t i = 0; i < grid->nx; i++)
            for (size_t mx = 0; mx <= grid->nx / 2; mx++)
                for (size_t row = 0; row < grid->ny; row++) {
                    double twice = mx == 0 || 2 * mx == grid->nx ? 1 : 2; /* -mx too */
                    double phase = (double)(mx * i % grid->nx) / (double)grid->nx +
                                   (double)(row * j % grid->ny) / (double)grid->ny;
                    response[j * grid->nx + i] += twice * cos(2 * M_PI * phase) *
                                                  scene->compliance->length[mx * grid->ny + row] /
                                                  (double)scene_points(scene);
                }
    return response;
}

/* u[b] = sum over a of response[b - a] p[a]. */
static inline void scene_displace(const struct scene *scene, const double *response,
                                  const double *p, double *u) {
    size_t nx = scene->grid.nx, ny = scene->grid.ny, n = nx * ny;
    for (size_t b = 0; b < n; b++) {
        u[b] = 0;
        for (size_t a = 0; a < n; a++) {
            size_t i = (b % nx + nx - a % nx) % nx, j = (b / nx + ny - a / nx) % ny;
            u[b] += p[a] == 0 ? 0 : response[j * nx + i] * p[a];
        }
    }
}

/* (1, 4, 1)/6 in each direction, as the standard weighting averages a gap; a copy otherwise. */
static inline void scene_weigh(const struct scene *scene, const double *in, double *out) {
    size_t nx = scene->grid.nx, ny = scene->grid.ny;
    bool standard = scene->block.model == MODEL_LAYERED && scene->block.weighting == GAP_STANDARD;
    static const double FACTOR[3] = {1.0 / 6, 4.0 / 6, 1.0 / 6};
    for (size_t j = 0; j < ny; j++)
        for (size_t i = 0; i < nx; i++) {
            double sum = 0;
            for (size_t b = 0; b < 3; b++)
                for (size_t a = 0; a < 3; a++)
                    sum += FACTOR[a] * FACTOR[b] *
                           in[(j + ny + b - 1) % ny * nx + (i + nx + a - 1) % nx];
            out[j * nx + i] = standard ? sum : in[j * nx + i];
        }
}

static inline double largest(size_t n, const double *x) {
    double most = 0;
    for (size_t i = 0; i < n; i++)
        most = fmax(most, fabs(x[i]));
    return most;
}

static inline double mean_of(size_t n, const double *x) {
    double sum = 0;
    for (size_t i = 0; i < n; i++)
        sum += x[i];
    return sum / (double)n;
}

/* What holds for every state, whatever the size of the problem. reach: the largest violation that
 * is let pass, a length. */
static inline void check_state(const struct scene *scene, double reach) {
    const struct contact_state *state = &scene->state;
    size_t n = scene_points(scene), nodes = 0;
    for (size_t i = 0; i < n; i++) {
        assert_true(isfinite(state->p[i]) && state->p[i] >= 0);
        nodes += state->p[i] > 0;
        if (state->p[i] > 0)
            check_close(state->opening[i], 0, reach);
        else
            assert_true(state->opening[i] >= -reach);
    }
    assert_int_equal(state->nodes, nodes);
    /* 1e-12: rounding of a sum */
    check_relative(mean_of(n, state->p), state->pressure, 1e-12);
    check_close(mean_of(n, state->gap), state->mean_gap, reach);
    assert_true(state->stiffness >= 0 && (state->stiffness > 0) == (nodes > 0));
    assert_true(nodes < n || isinf(state->stiffness));
    assert_true(state->violation >= state->penetration && state->penetration >= 0);
    struct contact_area area = scene_area(scene);
    check_close(area.nodes, (double)nodes / (double)n, 1e-15);
    assert_true(0 <= area.lower && area.lower <= area.nodes && area.nodes <= area.upper);
    assert_true(area.edges >= 0 && area.edges <= 1 + 1e-12);
    assert_true(nodes == 0 || area.edges > 0);
}

/* The conditions of contact (Karush, Kuhn and Tucker), which only its one solution meets: p >= 0
 * with the mean asked, no gap under pressure, none below 0, to the tolerance of the solver. */
static inline void check_contact(struct scene *scene) {
    const struct contact_state *state = &scene->state;
    size_t n = scene_points(scene);
    double *response = scene_response(scene), *u = zeros(n), *gap = zeros(n), *weighted = zeros(n);
    scene_displace(scene, response, state->p, u);
    double mean = mean_of(n, scene->z), highest = 0;
    for (size_t i = 0; i < n; i++)
        highest = fmax(highest, fabs(scene->z[i] - mean));
    /* What the solver promises; what rounding does in it, to heights above a level far below, and
     * here to sums over all nodes. */
    double rounding = 1e-13 * (highest + largest(n, u)) + 1e-15 * largest(n, scene->z) +
                      1e-15 * (double)n * largest(n, response) * largest(n, state->p);
    double reach = scene->tolerance * largest(n, u) + rounding;
    for (size_t i = 0; i < n; i++)
        gap[i] = state->mean_gap + u[i] - (scene->z[i] - mean);
    scene_weigh(scene, gap, weighted);
    bool open = state->nodes == 0;
    for (size_t i = 0; i < n; i++) {
        check_close(state->gap[i], gap[i], reach);
        check_close(state->opening[i], weighted[i], reach);
    }
    free(u);
    free(gap);
    free(weighted);
    if (!open)
        check_state(scene, reach);
}

#endif
