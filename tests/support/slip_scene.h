/* A small problem of partial slip, and an independent solver of it: displacements by a sum over all
 * pairs of nodes, tractions node by node (Gauss and Seidel) at a given position of the flat, no
 * transform and no sets. Include after check.h. */
#ifndef RUGO_TESTS_SUPPORT_SLIP_SCENE_H
#define RUGO_TESTS_SUPPORT_SLIP_SCENE_H

#include "core/contact/slip/partial_slip.h"
#include <complex.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

struct slip_scene {
    struct grid grid;
    struct slip_options options;
    size_t n;          /* points */
    double *response;  /* 9 * n: displacement along a under a traction along b at node 0, of
                          [(3 * a + b) * n + node]; 0 across the face, 1 and 2 along x and y */
    double *z;         /* n */
    double *t, *u;     /* 3 * n: tractions and displacements of the solution */
    double *reference; /* 2 * n: displacements along the face less the flat's, at the last load */
    double flat[2];    /* displacement of the flat at the last load */
};

/* Symbols by the textbook, wave by wave; odd ones are 0 where a wave is its own mirror image. */
static inline double complex slip_symbol(const struct grid *grid, double nu, int mx, int my, int a,
                                         int b) {
    double kx = 2 * M_PI * mx / grid->lx, ky = grid->ny == 1 ? 0 : 2 * M_PI * my / grid->ly;
    double k = hypot(kx, ky), beta = (1 - 2 * nu) / (2 * (1 - nu));
    double odd[3] = {0, 2 * abs(mx) == (int)grid->nx ? 0 : kx / k,
                     2 * abs(my) == (int)grid->ny ? 0 : ky / k};
    double even[3] = {0, kx / k, ky / k};
    if (a == 0 && b == 0)
        return 2 / k;
    if (a == 0 || b == 0)
        return (a == 0 ? -1 : 1) * I * 2 * beta / k * odd[a + b];
    double product = a == b ? even[a] * even[b] : odd[a] * odd[b];
    return 2 / (k * (1 - nu)) * ((a == b ? 1 : 0) - nu * product);
}

static inline double slip_response_at(const struct slip_scene *s, int a, int b, size_t node) {
    const int nx = (int)s->grid.nx, ny = (int)s->grid.ny;
    const size_t row = node / s->grid.nx;
    const double i = (double)(node % s->grid.nx), j = (double)row;
    double sum = 0;
    for (int mx = (1 - nx) / 2; mx <= nx / 2; mx++)
        for (int my = (1 - ny) / 2; my <= ny / 2; my++) {
            double phase = 2 * M_PI * (mx * i / nx + my * j / ny);
            if (mx != 0 || my != 0)
                sum += creal(slip_symbol(&s->grid, s->options.poisson, mx, my, a, b) *
                             cexp(I * phase));
        }
    return sum / (double)s->n;
}

static inline void slip_scene_open(struct slip_scene *s, struct grid grid,
                                   struct slip_options options) {
    *s = (struct slip_scene){.grid = grid, .options = options, .n = grid_points(&grid)};
    s->response = calloc(9 * s->n, sizeof(double));
    s->z = calloc(s->n, sizeof(double));
    s->t = calloc(3 * s->n, sizeof(double));
    s->u = calloc(3 * s->n, sizeof(double));
    s->reference = calloc(2 * s->n, sizeof(double));
    if (!s->response || !s->z || !s->t || !s->u || !s->reference)
        abort();
    for (int a = 0; a < (grid.ny == 1 ? 2 : 3); a++)
        for (int b = 0; b < (grid.ny == 1 ? 2 : 3); b++)
            for (size_t i = 0; i < s->n; i++)
                s->response[(size_t)(3 * a + b) * s->n + i] = slip_response_at(s, a, b, i);
}

static inline void slip_scene_close(struct slip_scene *s) {
    free(s->response);
    free(s->z);
    free(s->t);
    free(s->u);
    free(s->reference);
}

static inline double slip_displacement(const struct slip_scene *s, size_t a, const double *t,
                                       size_t to) {
    const size_t nx = s->grid.nx, ny = s->grid.ny, n = s->n;
    double sum = 0;
    for (size_t from = 0; from < n; from++) {
        size_t i = (to % nx + nx - from % nx) % nx, j = (to / nx + ny - from / nx) % ny;
        const double *response = s->response + 3 * a * n + j * nx + i;
        for (size_t b = 0; b < 3; b++)
            sum += t[b * n + from] == 0 ? 0 : response[b * n] * t[b * n + from];
    }
    return sum;
}

/* Takes the tractions of a state, and its displacements. */
static inline void slip_scene_take(struct slip_scene *s, const struct slip_state *state) {
    memcpy(s->t, state->p, s->n * sizeof(double));
    memcpy(s->t + s->n, state->qx, s->n * sizeof(double));
    if (state->qy != NULL)
        memcpy(s->t + 2 * s->n, state->qy, s->n * sizeof(double));
    for (size_t a = 0; a < 3; a++)
        for (size_t i = 0; i < s->n; i++)
            s->u[a * s->n + i] = slip_displacement(s, a, s->t, i);
}

/* The flat's position that nodes in contact, and stuck ones, show: approach[0], and its slide since
 * the last load but for what they had then. */
static inline void slip_scene_flat(const struct slip_scene *s, double flat[3]) {
    double contact = 0, stuck = 0;
    flat[0] = flat[1] = flat[2] = 0;
    for (size_t i = 0; i < s->n; i++) {
        double p = s->t[i], q = hypot(s->t[s->n + i], s->t[2 * s->n + i]);
        bool sticks = p > 0 && q < s->options.friction * p * (1 - 1e-9);
        contact += p > 0;
        stuck += sticks;
        flat[0] += p > 0 ? s->z[i] - s->u[i] : 0;
        for (size_t d = 0; d < 2; d++)
            flat[1 + d] += sticks ? s->u[(1 + d) * s->n + i] - s->reference[d * s->n + i] : 0;
    }
    flat[0] /= contact;
    flat[1] /= stuck;
    flat[2] /= stuck;
}

/* Slip counts from the state that was taken. */
static inline void slip_scene_settle(struct slip_scene *s, const double flat[2]) {
    for (size_t d = 0; d < 2; d++)
        for (size_t i = 0; i < s->n; i++)
            s->reference[d * s->n + i] = s->u[(1 + d) * s->n + i] - flat[d];
}

/* Solves for the tractions at a position of the flat, from 0, until they change by no more than
 * `enough`. Returns the number of sweeps. */
static inline size_t slip_scene_solve(const struct slip_scene *s, const double flat[3], double *t,
                                      double enough) {
    const size_t n = s->n;
    const double across = s->response[0], along = fmax(s->response[4 * n], s->response[8 * n]);
    double most = INFINITY;
    size_t sweep = 0;
    memset(t, 0, 3 * n * sizeof *t);
    for (; most > enough && sweep < 100000; sweep++) {
        most = 0;
        for (size_t i = 0; i < n; i++) {
            double old[3] = {t[i], t[n + i], t[2 * n + i]};
            double gap = flat[0] + slip_displacement(s, 0, t, i) - s->z[i];
            t[i] = fmax(0, t[i] - gap / across);
            for (size_t d = 0; d < 2; d++)
                t[(1 + d) * n + i] -=
                    (slip_displacement(s, 1 + d, t, i) - flat[1 + d] - s->reference[d * n + i]) /
                    along;
            double q = hypot(t[n + i], t[2 * n + i]), bound = s->options.friction * t[i];
            for (size_t d = 0; d < 3; d++) {
                t[d * n + i] *= d > 0 && q > bound ? bound / q : 1;
                most = fmax(most, fabs(t[d * n + i] - old[d]));
            }
        }
    }
    return sweep;
}

#endif
