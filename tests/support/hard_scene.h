/* A judge of contact under a hardness, beside that of contact_scene.h; and faces of random waves.
 */
#ifndef RUGO_TESTS_SUPPORT_HARD_SCENE_H
#define RUGO_TESTS_SUPPORT_HARD_SCENE_H

#include "tests/support/contact_scene.h"

/* What holds for every state, whatever the size of the problem: pressures from 0 to the hardness of
 * the mean asked, no gap under pressure, none below 0, and depths where the face was lowered. */
static inline void check_hard_state(const struct scene *scene, double hardness, double reach) {
    const struct contact_state *state = &scene->state;
    size_t n = scene_points(scene), nodes = 0, yielded = 0;
    for (size_t i = 0; i < n; i++) {
        nodes += state->p[i] > 0;
        yielded += state->p[i] == hardness;
        assert_true(state->p[i] >= 0 && state->p[i] <= hardness && state->depth[i] >= 0);
        if (state->p[i] > 0)
            check_close(state->opening[i], 0, reach);
        else
            assert_true(state->opening[i] >= -reach);
    }
    assert_int_equal(state->nodes, nodes);
    assert_int_equal(state->yielded, yielded);
    check_relative(mean_of(n, state->p), state->pressure, 1e-11); /* rounding of a sum */
    check_close(mean_of(n, state->depth), state->plastic_volume, reach);
    check_close(mean_of(n, state->gap), state->mean_gap, reach);
    check_relative(state->plastic_load, (double)yielded * hardness / ((double)n * state->pressure),
                   1e-12);
    assert_true(state->violation >= state->penetration && state->penetration >= 0);
    assert_true(state->stiffness >= 0 && state->unload_stiffness >= state->stiffness);
}

/* Of a periodic state: gaps by sums over all pairs of nodes. Under a load that has not been
 * exceeded yielded nodes are as deep as they are pressed. */
static inline void check_hard_contact(struct scene *scene, double hardness, bool loading) {
    const struct contact_state *state = &scene->state;
    size_t n = scene_points(scene);
    double *response = scene_response(scene), *u = zeros(n), *gap = zeros(n), *weighted = zeros(n);
    scene_displace(scene, response, state->p, u);
    double mean = mean_of(n, scene->z), highest = 0;
    for (size_t i = 0; i < n; i++)
        highest = fmax(highest, fabs(scene->z[i] - mean));
    double rounding = 1e-13 * (highest + largest(n, u)) +
                      1e-15 * (double)n * largest(n, response) * largest(n, state->p);
    double reach = scene->tolerance * largest(n, u) + rounding;
    for (size_t i = 0; i < n; i++)
        gap[i] = state->mean_gap - state->plastic_volume + u[i] - (scene->z[i] - mean);
    scene_weigh(scene, gap, weighted);
    for (size_t i = 0; i < n; i++) {
        check_close(state->gap[i], gap[i] + state->depth[i], 2 * reach);
        check_close(state->opening[i], weighted[i] + state->depth[i], 2 * reach);
        if (loading)
            check_close(state->depth[i], state->p[i] == hardness ? fmax(0, -weighted[i]) : 0,
                        2 * reach);
    }
    free(u);
    free(gap);
    free(weighted);
    check_hard_state(scene, hardness, 2 * reach);
}

/* Fills heights with waves of random phases, whose amplitudes fall with the wave number to the
 * power 1 + hurst, and a share of white noise. uniform: a stream of numbers in [0, 1). Returns the
 * RMS slope by differences. */
static inline double fill_waves(const struct grid *grid, double hurst, double noise,
                                double (*uniform)(void *context), void *context, double *z) {
    enum { WAVES = 40 };
    double wave[WAVES][4];
    for (size_t m = 0; m < WAVES; m++) {
        size_t most = 1 + m / 4;
        wave[m][0] = floor(uniform(context) * (double)(2 * most + 1)) - (double)most;
        wave[m][1] = grid->ny > 1 ? 1 + floor(uniform(context) * (double)most) : 0;
        wave[m][2] = 2 * M_PI * uniform(context);
        double length = hypot(wave[m][0], wave[m][1]);
        wave[m][3] = length > 0 ? pow(length, -1 - hurst) : 0;
    }
    for (size_t j = 0; j < grid->ny; j++)
        for (size_t i = 0; i < grid->nx; i++) {
            double height = noise * uniform(context);
            double x = (double)i / (double)grid->nx, y = (double)j / (double)grid->ny;
            for (size_t m = 0; m < WAVES; m++)
                height +=
                    wave[m][3] * cos(2 * M_PI * (wave[m][0] * x + wave[m][1] * y) + wave[m][2]);
            z[j * grid->nx + i] = height;
        }
    double sum = 0;
    for (size_t j = 0; j < grid->ny; j++)
        for (size_t i = 0; i < grid->nx; i++) {
            double here = z[j * grid->nx + i];
            double x = (z[j * grid->nx + (i + 1) % grid->nx] - here) / grid_dx(grid);
            double y =
                grid->ny > 1 ? (z[(j + 1) % grid->ny * grid->nx + i] - here) / grid_dy(grid) : 0;
            sum += x * x + y * y;
        }
    return sqrt(sum / (double)grid_points(grid));
}

#endif
