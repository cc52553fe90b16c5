#include "core/full/linear/sliding_face.h"
#include "core/contact/block.h"
#include "core/full/linear/aliasing.h"
#include "core/full/linear/hessenberg.h"
#include "core/full/linear/vectors.h"
#include "core/surface/transform.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { BASIS = 24, RESTARTS = 4, AXES = 3 };

struct sliding_face {
    size_t d, face, waves, values;
    struct transform *plan[AXES]; /* owned, as all below */
    double *weight;               /* by wave: symbol of the gap weighting; NULL: 1 */
    double *compliance, *inverse; /* as preconditioner_matrices has them */
    double local;                 /* displacement along the face under a force on a node alone */
    double *basis[BASIS + 1];     /* orthonormal residuals */
    double *sum, *step;           /* values: scratch */
    struct hessenberg hessenberg;
    const struct face_conditions *conditions; /* borrowed for the time of a solution */
    double bearing[SIDEWAYS_MOST];            /* sum of the shares of all nodes */
};

/* The mean over the waves of the mean of the compliances along the face. */
static double local_compliance(const struct sliding_face *s, const struct mesh *mesh) {
    const struct level *level = &mesh->level[0];
    double sum = 0;
    for (size_t wave = 0; wave < s->waves; wave++) {
        size_t mx = wave / level->ny;
        double twice = mx == 0 || 2 * mx == level->nx ? 1 : 2;
        for (size_t i = 0; i + 1 < s->d; i++)
            sum += twice * s->compliance[(i * s->d + i) * s->waves + wave];
    }
    return sum / (double)s->face / (double)(s->d - 1);
}

static int arrays_create(struct sliding_face *s, const struct mesh *mesh,
                         enum gap_weighting weighting, struct error *err) {
    const struct level *level = &mesh->level[0];
    struct {
        double **array;
        size_t count;
    } const arrays[] = {{&s->sum, s->values},
                        {&s->step, s->values},
                        {&s->compliance, s->d * s->d * s->waves},
                        {&s->inverse, s->d * s->d * s->waves},
                        {&s->weight, weighting == GAP_STANDARD ? s->waves : 0}};
    for (size_t a = 0; a < sizeof arrays / sizeof *arrays; a++)
        if (arrays[a].count > 0 &&
            (*arrays[a].array = array_create(arrays[a].count, sizeof(double))) == NULL)
            return error_memory(err, arrays[a].count * sizeof(double), "forces along the face");
    for (size_t b = 0; b <= BASIS; b++)
        if ((s->basis[b] = array_create(s->values, sizeof(double))) == NULL)
            return error_memory(err, s->values * sizeof(double), "forces along the face");
    for (size_t wave = 0; s->weight != NULL && wave < s->waves; wave++)
        s->weight[wave] = gap_weight_symbol(wave / level->ny, level->nx) *
                          (s->d == 3 ? gap_weight_symbol(wave % level->ny, level->ny) : 1);
    return 0;
}

int sliding_face_create(struct sliding_face **out, const struct mesh *mesh,
                        const struct preconditioner *preconditioner, enum gap_weighting weighting,
                        struct error *err) {
    size_t nx = mesh->level[0].nx, ny = mesh->level[0].ny, d = (size_t)mesh->dimension;
    struct grid grid = {nx, ny, (double)nx, (double)ny * mesh->across};
    *out = NULL;
    struct sliding_face *s = array_create(1, sizeof *s);
    if (s == NULL)
        return error_memory(err, sizeof *s, "forces along the face");
    *s = (struct sliding_face){.d = d,
                               .face = mesh->face,
                               .waves = level_waves(&mesh->level[0]),
                               .values = mesh->face * d + d};
    int status = arrays_create(s, mesh, weighting, err);
    for (size_t i = 0; status == 0 && i < d; i++)
        status = transform_create(&s->plan[i], &grid, nx / 2, ny / 2, err);
    if (status == 0)
        sliding_face_renew(s, mesh, preconditioner);
    else
        sliding_face_destroy(&s);
    *out = s;
    return status;
}

void sliding_face_renew(struct sliding_face *s, const struct mesh *mesh,
                        const struct preconditioner *preconditioner) {
    preconditioner_matrices(preconditioner, s->compliance, s->inverse);
    s->local = local_compliance(s, mesh);
}

void sliding_face_destroy(struct sliding_face **handle) {
    struct sliding_face *s = *handle;
    if (s == NULL)
        return;
    for (size_t i = 0; i < AXES; i++)
        transform_destroy(&s->plan[i]);
    for (size_t b = 0; b <= BASIS; b++)
        free(s->basis[b]);
    free(s->weight);
    free(s->compliance);
    free(s->inverse);
    free(s->sum);
    free(s->step);
    free(s);
    *handle = NULL;
}

size_t sliding_face_values(const struct sliding_face *s) {
    return s->values;
}

/* --- waves --- */

/* Multiplies all components by a matrix a wave; the vertical ones by the weight before or after it.
 * in and out may be the same. */
static void multiply(struct sliding_face *s, const double *matrix, bool divides, const double *in,
                     double *out) {
    size_t d = s->d, n = s->waves;
    double complex *spectrum[AXES];
    for (size_t i = 0; i < d; i++) {
        transform_forward(s->plan[i], in + i * s->face);
        spectrum[i] = transform_spectrum(s->plan[i]);
    }
    double complex *vertical = transform_spectrum(s->plan[d - 1]);
    for (size_t wave = 0; wave < n; wave++) {
        double complex t[AXES], sum[AXES] = {0};
        double weight = s->weight != NULL ? s->weight[wave] : 1;
        for (size_t j = 0; j + 1 < d; j++)
            t[j] = -I * spectrum[j][wave];
        t[d - 1] = vertical[wave] / (divides ? weight : 1);
        for (size_t i = 0; i < d; i++)
            for (size_t j = 0; j < d; j++)
                sum[i] += matrix[(i * d + j) * n + wave] * t[j];
        for (size_t i = 0; i + 1 < d; i++)
            spectrum[i][wave] = I * sum[i];
        vertical[wave] = sum[d - 1] * (divides ? 1 : weight);
    }
    for (size_t i = 0; i < d; i++)
        transform_inverse(s->plan[i], out + i * s->face);
}

/* --- nodes --- */

static enum face_node does(const struct sliding_face *s, size_t node) {
    return s->conditions->node[node];
}

static const double *direction_of(const struct sliding_face *s, size_t node) {
    return s->conditions->direction + node * (s->d - 1);
}

/* Returns the part of v along a sliding node's direction. */
static double along(const struct sliding_face *s, size_t node, const double *v) {
    const double *direction = direction_of(s, node);
    double sum = 0;
    for (size_t k = 0; k + 1 < s->d; k++)
        sum += direction[k] * v[k * s->face + node];
    return sum;
}

/* out = the given values that forces and motions x have. */
static void apply(struct sliding_face *s, const double *x, double *out) {
    const struct face_conditions *of = s->conditions;
    size_t d = s->d, face = s->face, motions = d * face;
    multiply(s, s->compliance, false, x, out);
    memset(out + motions, 0, d * sizeof *out);
    for (size_t node = 0; node < face; node++) {
        double *vertical = out + (d - 1) * face + node;
        if (does(s, node) == NODE_FREE) {
            for (size_t k = 0; k < d; k++)
                out[k * face + node] = 0;
            continue;
        }
        *vertical += x[motions + d - 1];
        for (size_t k = 0; k + 1 < d; k++)
            out[k * face + node] -= x[motions + k];
        for (size_t k = 0; k < d; k++)
            out[motions + k] += x[k * face + node];
        if (does(s, node) == NODE_STICKS)
            continue;
        const double *direction = direction_of(s, node);
        double turn = of->turn[node], slip = along(s, node, out), force = along(s, node, x);
        for (size_t k = 0; k + 1 < d; k++) {
            double across = out[k * face + node] - direction[k] * slip;
            double own = x[k * face + node];
            out[k * face + node] = own -
                                   turn * (own - direction[k] * force - of->stiffness * across) -
                                   of->friction * direction[k] * x[(d - 1) * face + node];
        }
    }
    for (size_t k = 0; k + 1 < d; k++)
        out[motions + k] =
            of->drive[k].shear * out[motions + k] + of->drive[k].flat * x[motions + k];
}

/* Returns the force across the direction of a sliding node whose change (face_conditions.h) is 1,
 * where it slips by what that force alone moves it. */
static double turning_force(const struct sliding_face *s, size_t node) {
    double turn = s->conditions->turn[node];
    return 1 / (1 - turn + turn * s->conditions->stiffness * s->local);
}

/* Returns the share of a force along an axis that a node takes up. */
static double share_of(const struct sliding_face *s, size_t node, size_t axis) {
    const struct face_conditions *of = s->conditions;
    if (face_node_slides(does(s, node))) {
        double e = direction_of(s, node)[axis];
        return of->turn[node] * of->stiffness * s->local * turning_force(s, node) * (1 - e * e);
    }
    return does(s, node) == NODE_STICKS ? 1 : 0;
}

/* Adds to slip what a residual of a node in contact slips, by the share of the node. */
static void add_slip(const struct sliding_face *s, const double *residual, size_t node,
                     double slip[SIDEWAYS_MOST]) {
    bool slides = face_node_slides(does(s, node));
    double drop = slides ? along(s, node, residual) : 0;
    double slips = slides ? s->local * turning_force(s, node) : 1;
    for (size_t k = 0; k + 1 < s->d; k++)
        slip[k] +=
            slips * (residual[k * s->face + node] - (slides ? drop * direction_of(s, node)[k] : 0));
}

/* Fills the motions that a residual has on average. */
static void find_motions(const struct sliding_face *s, const double *residual, double *motions) {
    const struct face_conditions *of = s->conditions;
    size_t d = s->d, face = s->face, contact = 0;
    double vertical = 0, slip[SIDEWAYS_MOST] = {0};
    for (size_t node = 0; node < face; node++) {
        if (does(s, node) == NODE_FREE)
            continue;
        contact++;
        vertical += residual[(d - 1) * face + node];
        add_slip(s, residual, node, slip);
    }
    motions[d - 1] = vertical / (double)contact;
    for (size_t k = 0; k + 1 < d; k++)
        motions[k] = of->drive[k].flat != 0 ? residual[d * face + k] / of->drive[k].flat
                     : s->bearing[k] > 0    ? -slip[k] / s->bearing[k]
                                            : 0;
}

/* r = the residual of what is held, moved by the motions. */
static void take_motions(const struct sliding_face *s, const double *residual,
                         const double *motions, double *r) {
    size_t d = s->d, face = s->face;
    for (size_t node = 0; node < face; node++) {
        bool touches = does(s, node) != NODE_FREE, sticks = does(s, node) == NODE_STICKS;
        for (size_t k = 0; k + 1 < d; k++)
            r[k * face + node] = sticks ? residual[k * face + node] + motions[k] : 0;
        r[(d - 1) * face + node] = touches ? residual[(d - 1) * face + node] - motions[d - 1] : 0;
    }
}

/* Forces of sliding nodes: the friction of their pressures, and what turns them. */
static void slide(const struct sliding_face *s, const double *residual, size_t node, double *out) {
    const struct face_conditions *of = s->conditions;
    const double *direction = direction_of(s, node);
    const double *flat = out + s->d * s->face;
    double given = along(s, node, residual), moved = 0;
    double friction = of->friction * out[(s->d - 1) * s->face + node];
    for (size_t k = 0; k + 1 < s->d; k++)
        moved += direction[k] * flat[k];
    for (size_t k = 0; k + 1 < s->d; k++) {
        double across = residual[k * s->face + node] - direction[k] * given +
                        of->turn[node] * of->stiffness * (flat[k] - direction[k] * moved);
        out[k * s->face + node] =
            direction[k] * (given + friction) + across * turning_force(s, node);
    }
}

/* out = about the forces and motions that take off a residual. */
static void precondition(struct sliding_face *s, const double *residual, double *out) {
    const struct face_conditions *of = s->conditions;
    size_t d = s->d, face = s->face, contact = 0;
    double *motions = out + d * face, sum[AXES] = {0};
    find_motions(s, residual, motions);
    take_motions(s, residual, motions, s->sum);
    multiply(s, s->inverse, true, s->sum, out);
    for (size_t node = 0; node < face; node++) {
        bool touches = does(s, node) != NODE_FREE;
        contact += touches;
        out[(d - 1) * face + node] *= touches ? 1 : 0;
        sum[d - 1] += out[(d - 1) * face + node];
    }
    double lacks = (residual[d * face + d - 1] - sum[d - 1]) / (double)contact;
    for (size_t node = 0; node < face; node++) {
        bool sticks = does(s, node) == NODE_STICKS;
        out[(d - 1) * face + node] += does(s, node) != NODE_FREE ? lacks : 0;
        for (size_t k = 0; !sticks && k + 1 < d; k++)
            out[k * face + node] = 0;
        if (!sticks && does(s, node) != NODE_FREE)
            slide(s, residual, node, out);
        for (size_t k = 0; k + 1 < d; k++)
            sum[k] += out[k * face + node];
    }
    for (size_t k = 0; k + 1 < d; k++) {
        if (of->drive[k].flat != 0 || !(s->bearing[k] > 0))
            continue;
        double each = (residual[d * face + k] / of->drive[k].shear - sum[k]) / s->bearing[k];
        for (size_t node = 0; node < face; node++)
            out[k * face + node] += each * share_of(s, node, k);
    }
}

/* --- minimal residuals --- */

static void add(size_t n, double factor, const double *x, double *y) {
    for (size_t i = 0; i < n; i++)
        y[i] += factor * x[i];
}

static void scale(size_t n, double factor, double *x) {
    for (size_t i = 0; i < n; i++)
        x[i] *= factor;
}

/* One restart from the residual in basis 0. Returns what is left of it. */
static double cycle(struct sliding_face *s, double goal, double left, double *out) {
    size_t n = s->values, c = 0;
    double factor[BASIS];
    scale(n, 1 / left, s->basis[0]);
    s->hessenberg.right[0] = left;
    for (double size = 1; c < BASIS && left > goal && size > 0; c++) {
        double *next = s->basis[c + 1];
        precondition(s, s->basis[c], s->step);
        apply(s, s->step, next);
        for (size_t a = 0; a <= c; a++) {
            s->hessenberg.h[a][c] = dot(n, next, s->basis[a]);
            add(n, -s->hessenberg.h[a][c], s->basis[a], next);
        }
        size = sqrt(dot(n, next, next));
        s->hessenberg.h[c + 1][c] = size;
        if (size > 0)
            scale(n, 1 / size, next);
        left = hessenberg_rotate(&s->hessenberg, c);
    }
    hessenberg_solve(&s->hessenberg, c, factor);
    memset(s->basis[BASIS], 0, n * sizeof(double));
    for (size_t a = 0; a < c; a++)
        if (a < BASIS)
            add(n, factor[a], s->basis[a], s->basis[BASIS]);
    precondition(s, s->basis[BASIS], s->step);
    add(n, 1, s->step, out);
    return left;
}

void sliding_face_solve(struct sliding_face *s, const struct face_conditions *conditions,
                        const double *given, double tolerance, double *out) {
    size_t n = s->values;
    double first = sqrt(dot(n, given, given)), left = first;
    s->conditions = conditions;
    for (size_t k = 0; k + 1 < s->d; k++) {
        s->bearing[k] = 0;
        for (size_t node = 0; node < s->face; node++)
            s->bearing[k] += share_of(s, node, k);
    }
    memset(out, 0, n * sizeof *out);
    memcpy(s->basis[0], given, n * sizeof *given);
    for (int restart = 0; restart < RESTARTS && left > tolerance * first; restart++) {
        if (restart > 0) {
            apply(s, out, s->basis[0]);
            for (size_t i = 0; i < n; i++)
                s->basis[0][i] = given[i] - s->basis[0][i];
            left = sqrt(dot(n, s->basis[0], s->basis[0]));
        }
        left = cycle(s, tolerance * first, left, out);
    }
}
