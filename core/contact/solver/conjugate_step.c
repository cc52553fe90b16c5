#include "core/contact/solver/conjugate_step.h"
#include "core/contact/free_space.h"
#include "core/contact/solver/lines.h"
#include "core/vectors.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { LANES = CONJUGATE_GRADIENT_LANES };

/* --- arrays, and the symbols of the compliance and its inverse --- */

/* Padding nodes lie so deep that they never come into contact. */
static const double FAR = 1e30;

static size_t padded(size_t n) {
    return (n + LANES - 1) / LANES * LANES;
}

enum { ARRAYS = 10, SPARES = 2 }; /* in all, and those that are larger in free space */

double conjugate_gradient_bytes(const struct grid *grid, const struct block *block) {
    double waves = ((double)grid->nx / 2 + 1) * (double)grid->ny;
    double pyramid = grid_is_profile(grid) ? 0 : pyramid_bytes(grid);
    double results = pass_board_bytes(padded(grid_points(grid)));
    double symbols = compliance_has_weight(block) ? 2 : 1;
    return sizeof(double) *
               ((ARRAYS - SPARES) * (double)padded(grid_points(grid)) + symbols * waves) +
           transform_bytes(grid, grid->nx / 2) + pyramid + results;
}

static int arrays_create(struct conjugate_gradient *solver, struct error *err) {
    double **const arrays[ARRAYS] = {&solver->spare[0], &solver->spare[1], &solver->z, &solver->p,
                                     &solver->u,        &solver->q,        &solver->r, &solver->old,
                                     &solver->t,        &solver->w};
    for (size_t a = 0; a < ARRAYS; a++) {
        size_t count = a < SPARES ? grid_points(&solver->around) : solver->padded;
        *arrays[a] = array_create(count, sizeof(double)); /* the spare ones mostly stay untouched */
        if (*arrays[a] == NULL)
            return error_memory(err, count * sizeof(double), "a contact");
    }
    for (size_t i = solver->n; i < solver->padded; i++)
        solver->z[i] = -FAR;
    return 0;
}

/* Inverse compliance of the half-space that repeats `around`. */
static void fill_periodic_inverse(struct conjugate_gradient *solver) {
    const struct grid *grid = &solver->around;
    for (size_t mx = 0; mx <= grid->nx / 2; mx++)
        for (size_t row = 0; row < grid->ny; row++)
            solver->inverse[mx * grid->ny + row] =
                transform_wave_number(grid, mx, row) / 2 * solver->largest;
}

/* Returns the mean over all waves of a symbol that has half of them. */
static double mean_of_waves(const struct grid *waved, const double *symbol) {
    double sum = 0;
    for (size_t mx = 0; mx <= waved->nx / 2; mx++)
        for (size_t row = 0; row < waved->ny; row++)
            sum += (mx == 0 || 2 * mx == waved->nx ? 1 : 2) * symbol[mx * waved->ny + row];
    return sum / (double)grid_points(waved);
}

static int symbols_create(struct conjugate_gradient *solver, const struct compliance *compliance,
                          struct error *err) {
    size_t waves = (solver->around.nx / 2 + 1) * solver->around.ny;
    solver->inverse = array_create(waves, sizeof *solver->inverse);
    if (compliance->weight != NULL)
        solver->product = array_create(waves, sizeof *solver->product);
    if (solver->inverse == NULL || (compliance->weight != NULL && solver->product == NULL))
        return error_memory(err, 2 * waves * sizeof(double), "a contact");
    for (size_t k = 0; k < compliance->waves; k++)
        solver->largest = fmax(solver->largest, fabs(compliance->length[k]));
    solver->factor = 1 / solver->largest;
    solver->compliance = compliance->length;
    if (compliance->weight != NULL) {
        for (size_t k = 0; k < waves; k++)
            solver->product[k] = compliance->length[k] * compliance->weight[k];
        solver->compliance = solver->product;
    }
    solver->local = solver->factor * mean_of_waves(&compliance->waved, solver->compliance);
    if (compliance->open) {
        fill_periodic_inverse(solver);
        return 0;
    }
    for (size_t k = 0; k < waves; k++)
        solver->inverse[k] =
            solver->compliance[k] > 0 ? solver->largest / solver->compliance[k] : 0;
    return 0;
}

int conjugate_gradient_create(struct conjugate_gradient *out, const struct compliance *compliance,
                              struct error *err) {
    const struct grid *grid = &compliance->grid;
    const struct grid *waved = &compliance->waved;
    *out = (struct conjugate_gradient){.grid = *grid,
                                       .around = *grid,
                                       .n = grid_points(grid),
                                       .hardness = INFINITY,
                                       .padded = padded(grid_points(grid))};
    if (compliance->open)
        free_space_around(grid, &out->around);
    const struct grid *around = &out->around;
    int status = transform_create(&out->transform, around, around->nx / 2, around->ny / 2, err);
    if (status == 0 && compliance->open)
        status = transform_create(&out->wide, waved, waved->nx / 2, waved->ny / 2, err);
    if (status == 0)
        status = arrays_create(out, err);
    if (status == 0)
        status = pass_board_create(&out->board, out->padded, err);
    if (status == 0 && !grid_is_profile(grid))
        status = pyramid_create(&out->pyramid, around, err);
    if (status == 0)
        status = symbols_create(out, compliance, err);
    if (status != 0)
        conjugate_gradient_clear(out);
    return status;
}

void conjugate_gradient_clear(struct conjugate_gradient *solver) {
    double *const arrays[ARRAYS] = {solver->spare[0], solver->spare[1], solver->z, solver->p,
                                    solver->u,        solver->q,        solver->r, solver->old,
                                    solver->t,        solver->w};
    for (size_t a = 0; a < ARRAYS; a++)
        free(arrays[a]);
    free(solver->product);
    free(solver->inverse);
    pass_board_clear(&solver->board);
    pyramid_clear(&solver->pyramid);
    transform_destroy(&solver->transform);
    transform_destroy(&solver->wide);
    *solver = (struct conjugate_gradient){0};
}

int conjugate_gradient_set_team(struct conjugate_gradient *solver, struct team *team,
                                struct error *err) {
    int status = transform_set_team(solver->transform, team, err);
    if (status == 0 && solver->wide != NULL)
        status = transform_set_team(solver->wide, team, err);
    if (status == 0 && !grid_is_profile(&solver->grid))
        status = pyramid_set_team(&solver->pyramid, team, err);
    if (status == 0)
        solver->board.team = team;
    return status;
}

/* --- sums, products and directions of a step --- */

/* A padded transform takes about as long as three of the grid. */
static const double WIDE_TRANSFORMS = 3;

double conjugate_lanes_sum(const double *lanes) {
    double total = 0;
    for (size_t a = 0; a < LANES; a++)
        total += lanes[a];
    return total;
}

double conjugate_lanes_most(const double *lanes) {
    double most = 0;
    for (size_t a = 0; a < LANES; a++)
        most = fmax(most, lanes[a]);
    return most;
}

/* --- products with the compliance and its inverse --- */

void conjugate_step_apply_compliance(struct conjugate_gradient *solver, const double *in,
                                     double *out) {
    if (solver->wide == NULL) {
        transform_filter(solver->transform, solver->compliance, solver->factor, in, out);
        solver->transforms += 2;
        return;
    }
    transform_filter_part(solver->wide, solver->compliance, solver->factor, solver->grid.nx,
                          solver->grid.ny, in, out);
    solver->transforms += 2 * WIDE_TRANSFORMS;
}

/* A corner of a wider grid: rows of nx values, `from_row` and `to_row` apart. */
struct corner {
    const double *from;
    double *to;
    size_t nx, ny, from_row, to_row;
};
enum { CORNER_ROWS = 32 }; /* of a part */

static void copy_rows(void *context, size_t first, size_t end, size_t thread) {
    (void)thread;
    const struct corner *c = context;
    for (size_t j = first; j < end; j++) {
        double *to = c->to + j * c->to_row;
        memcpy(to, c->from + j * c->from_row, c->nx * sizeof *to);
        if (c->to_row > c->nx)
            memset(to + c->nx, 0, (c->to_row - c->nx) * sizeof *to);
    }
}

static void copy_corner(struct team *team, struct corner corner) {
    team_share_ranges(team, corner.ny, CORNER_ROWS, copy_rows, &corner);
}

/* Returns r in the corner of `around`, with zeros about it; where that is the grid itself, r. */
static const double *embed(struct conjugate_gradient *solver, const double *r) {
    const struct grid *grid = &solver->grid, *around = &solver->around;
    double *out = solver->spare[0];
    if (solver->wide == NULL)
        return r;
    copy_corner(solver->board.team,
                (struct corner){r, out, grid->nx, grid->ny, grid->nx, around->nx});
    memset(out + grid->ny * around->nx, 0, (around->ny - grid->ny) * around->nx * sizeof *out);
    return out;
}

void conjugate_step_take_set(struct conjugate_gradient *solver, const double *r) {
    if (!grid_is_profile(&solver->grid))
        pyramid_set(&solver->pyramid, embed(solver, r));
}

/* out = inverse compliance times r, to be read in the set r != 0 alone. */
static void precondition(struct conjugate_gradient *solver, bool continued, const double *r,
                         double *out) {
    const struct grid *grid = &solver->grid, *around = &solver->around;
    const bool profile = grid_is_profile(grid);
    double *x = solver->wide != NULL ? solver->spare[1] : out;
    const double *set = embed(solver, r);
    if (continued && profile)
        lines_continue(around->nx, set, x);
    else if (continued)
        pyramid_continue(&solver->pyramid, set, x);
    transform_filter(solver->transform, solver->inverse, 1, continued ? x : set, x);
    if (continued && profile)
        lines_transpose(around->nx, set, x);
    else if (continued)
        pyramid_transpose(&solver->pyramid, set, x);
    if (x != out)
        copy_corner(solver->board.team,
                    (struct corner){x, out, grid->nx, grid->ny, around->nx, grid->nx});
    solver->transforms += 2 * (double)grid_points(around) / (double)solver->n;
}

/* --- directions --- */

/* Sums over the set r != 0. */
enum { MEMBERS, W, R, W_R, OLD, T, W_OLD };

WIDE_VECTORS static void multiply(size_t n, const double *r, const double *w,
                                  struct pass_result *out) {
    double m[LANES] = {0}, sw[LANES] = {0}, sr[LANES] = {0}, wr[LANES] = {0};
    for (size_t i = 0; i < n; i += LANES)
        for (size_t a = 0; a < LANES; a++) {
            double in = r[i + a] != 0 ? 1 : 0, v = in * w[i + a];
            m[a] += in;
            sw[a] += v;
            sr[a] += r[i + a];
            wr[a] += v * r[i + a];
        }
    out->sum[MEMBERS] = conjugate_lanes_sum(m);
    out->sum[W] = conjugate_lanes_sum(sw);
    out->sum[R] = conjugate_lanes_sum(sr);
    out->sum[W_R] = conjugate_lanes_sum(wr);
}

WIDE_VECTORS static void multiply_old(size_t n, const double *r, const double *w, const double *old,
                                      const double *t, struct pass_result *out) {
    double so[LANES] = {0}, st[LANES] = {0}, wo[LANES] = {0};
    for (size_t i = 0; i < n; i += LANES)
        for (size_t a = 0; a < LANES; a++) {
            double in = r[i + a] != 0 ? 1 : 0, v = in * w[i + a];
            so[a] += in * old[i + a];
            st[a] += in * t[i + a];
            wo[a] += v * old[i + a];
        }
    out->sum[OLD] = conjugate_lanes_sum(so);
    out->sum[T] = conjugate_lanes_sum(st);
    out->sum[W_OLD] = conjugate_lanes_sum(wo);
}

static void multiply_block(const struct pass *pass, size_t first, size_t n,
                           struct pass_result *out) {
    const struct conjugate_gradient *s = pass->solver;
    multiply(n, s->r + first, s->w + first, out);
    if (pass->beta > 0)
        multiply_old(n, s->r + first, s->w + first, s->old + first, s->t + first, out);
}

/* Sets t to w - w_mean + beta (t - t_mean) in the set, to 0 outside. */
WIDE_VECTORS static void redirect(size_t n, const double *r, const double *w, double w_mean,
                                  double beta, double t_mean, double *t) {
    for (size_t i = 0; i < n; i++) {
        double direction = w[i] - w_mean + beta * (t[i] - t_mean);
        t[i] = r[i] != 0 ? direction : 0;
    }
}

/* The same where beta is 0: t may hold anything. */
WIDE_VECTORS static void direct_anew(size_t n, const double *r, const double *w, double w_mean,
                                     double *t) {
    for (size_t i = 0; i < n; i++) {
        double direction = w[i] - w_mean;
        t[i] = r[i] != 0 ? direction : 0;
    }
}

static void redirect_block(const struct pass *pass, size_t first, size_t n,
                           struct pass_result *out) {
    (void)out;
    const struct conjugate_gradient *s = pass->solver;
    if (pass->beta > 0)
        redirect(n, s->r + first, s->w + first, pass->w_mean, pass->beta, pass->t_mean,
                 s->t + first);
    else
        direct_anew(n, s->r + first, s->w + first, pass->w_mean, s->t + first);
}

void conjugate_step_direct(struct conjugate_gradient *solver, struct step_memory *memory) {
    precondition(solver, memory->continued, solver->r, solver->w);
    struct pass pass = {.solver = solver, .beta = memory->energy > 0 ? 1 : 0};
    struct pass_result s = pass_run(&solver->board, &pass, multiply_block);
    pass.w_mean = s.sum[W] / s.sum[MEMBERS];
    pass.t_mean = s.sum[T] / s.sum[MEMBERS];
    double energy = s.sum[W_R] - pass.w_mean * s.sum[R];
    double change = energy - (s.sum[W_OLD] - pass.w_mean * s.sum[OLD]);
    pass.beta = memory->energy > 0 ? fmax(0, change / memory->energy) : 0;
    pass_run(&solver->board, &pass, redirect_block);
    memory->energy = energy;
    double *last = solver->old;
    solver->old = solver->r;
    solver->r = last;
    conjugate_step_apply_compliance(solver, solver->t, solver->w);
}

enum { ABOVE, BELOW };

WIDE_VECTORS static void least_along(size_t n, const double *r, const double *t, const double *w,
                                     struct pass_result *out) {
    double above[LANES] = {0}, below[LANES] = {0};
    for (size_t i = 0; i < n; i += LANES)
        for (size_t a = 0; a < LANES; a++) {
            above[a] += r[i + a] * t[i + a];
            below[a] += t[i + a] * w[i + a];
        }
    out->sum[ABOVE] = conjugate_lanes_sum(above);
    out->sum[BELOW] = conjugate_lanes_sum(below);
}

static void least_block(const struct pass *pass, size_t first, size_t n, struct pass_result *out) {
    const struct conjugate_gradient *s = pass->solver;
    least_along(n, s->old + first, s->t + first, s->w + first, out);
}

double conjugate_step_length(struct conjugate_gradient *solver) {
    struct pass_result s = pass_run(&solver->board, &(struct pass){.solver = solver}, least_block);
    return s.sum[BELOW] > 0 ? s.sum[ABOVE] / s.sum[BELOW] : 0;
}

/* --- scales --- */

static void scale_block(const struct pass *pass, size_t first, size_t n, struct pass_result *out) {
    (void)out;
    for (size_t i = first; i < first + n; i++)
        pass->scaled[i] *= pass->step;
}

void conjugate_step_scale(struct conjugate_gradient *solver, double mean, double sum, double *x) {
    const struct pass pass = {
        .solver = solver, .step = mean * (double)solver->n / sum, .scaled = x};
    pass_run(&solver->board, &pass, scale_block);
}

double conjugate_step_highest(const struct conjugate_gradient *solver) {
    double highest = 0;
    for (size_t i = 0; i < solver->n; i++)
        highest = fmax(highest, fabs(solver->z[i]));
    return highest;
}
