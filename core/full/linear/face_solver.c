#include "core/full/linear/face_solver.h"
#include "core/contact/block.h"
#include "core/full/linear/aliasing.h"
#include "core/full/linear/vectors.h"
#include <fftw3.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { ITERATIONS_MOST = 200 };

void face_solver_renew(struct face_solver *s, const struct mesh *mesh,
                       const struct preconditioner *preconditioner) {
    const double *compliance = preconditioner_compliance(preconditioner);
    size_t nx = mesh->level[0].nx, ny = mesh->level[0].ny;
    for (size_t k = 0; k < level_waves(&mesh->level[0]); k++) {
        double weight = 1;
        if (s->weight != NULL) {
            weight = gap_weight_symbol(k / ny, nx);
            if (mesh->dimension == 3)
                weight *= gap_weight_symbol(k % ny, ny);
            s->weight[k] = weight;
        }
        s->compliance[k] = compliance[k] * weight;
        s->inverse[k] = s->compliance[k] > 0 ? 1 / s->compliance[k] : 0;
    }
}

int face_solver_create(struct face_solver *out, const struct mesh *mesh,
                       const struct preconditioner *preconditioner, enum gap_weighting weighting,
                       struct error *err) {
    *out = (struct face_solver){.face = mesh->face};
    size_t nx = mesh->level[0].nx, ny = mesh->level[0].ny, waves = level_waves(&mesh->level[0]);
    struct grid grid = {nx, ny, (double)nx, (double)ny * mesh->across};
    double **const arrays[] = {&out->r,          &out->old,     &out->t,     &out->w,
                               &out->compliance, &out->inverse, &out->weight};
    size_t count = sizeof arrays / sizeof *arrays - (weighting == GAP_DUAL);
    int status = transform_create(&out->transform, &grid, nx / 2, ny / 2, err);
    for (size_t a = 0; status == 0 && a < count; a++) {
        *arrays[a] = fftw_alloc_real(a < 4 ? mesh->face : waves);
        if (*arrays[a] == NULL)
            status = error_memory(err, waves * sizeof(double), "the contact forces of the face");
    }
    if (status == 0)
        face_solver_renew(out, mesh, preconditioner);
    else
        face_solver_clear(out);
    return status;
}

void face_solver_clear(struct face_solver *s) {
    double *const arrays[] = {s->r, s->old, s->t, s->w, s->compliance, s->inverse, s->weight};
    for (size_t a = 0; a < sizeof arrays / sizeof *arrays; a++)
        fftw_free(arrays[a]);
    transform_destroy(&s->transform);
    *s = (struct face_solver){0};
}

void face_solver_weigh(const struct face_solver *s, const double *in, double *out) {
    if (s->weight != NULL)
        transform_filter(s->transform, s->weight, 1, in, out);
    else if (in != out)
        memcpy(out, in, s->face * sizeof *out);
}

static double mean_active(size_t n, const bool *active, const double *x) {
    double sum = 0;
    size_t count = 0;
    for (size_t i = 0; i < n; i++)
        if (active[i]) {
            sum += x[i];
            count++;
        }
    return count > 0 ? sum / (double)count : 0;
}

static void restrict_to(size_t n, const bool *active, double shift, double *x) {
    for (size_t i = 0; i < n; i++)
        x[i] = active[i] ? x[i] - shift : 0;
}

/* Subtracts from r its mean over the set, and sets r to 0 outside. Returns that mean, the shift. */
static double subtract_mean(struct face_solver *s, const bool *active) {
    double shift = mean_active(s->face, active, s->r);
    restrict_to(s->face, active, shift, s->r);
    return shift;
}

double face_solver_solve(struct face_solver *s, const bool *active, const double *face,
                         const double *target, double sum, double tolerance, double *forces) {
    size_t n = s->face, count = 0;
    for (size_t i = 0; i < n; i++)
        count += active[i];
    for (size_t i = 0; i < n; i++)
        forces[i] = active[i] ? sum / (double)count : 0;
    transform_filter(s->transform, s->compliance, 1, forces, s->w);
    for (size_t i = 0; i < n; i++)
        s->r[i] = target[i] - face[i] - s->w[i];
    double shift = subtract_mean(s, active);
    double first = dot(n, s->r, s->r), energy = 0;
    memset(s->t, 0, n * sizeof *s->t);
    memset(s->old, 0, n * sizeof *s->old);
    for (int iteration = 0; iteration < ITERATIONS_MOST; iteration++) {
        if (!(dot(n, s->r, s->r) > tolerance * tolerance * first))
            break;
        transform_filter(s->transform, s->inverse, 1, s->r, s->w);
        restrict_to(n, active, mean_active(n, active, s->w), s->w);
        double next = dot(n, s->w, s->r), change = next - dot(n, s->w, s->old);
        double beta = energy > 0 ? fmax(0, change / energy) : 0;
        energy = next;
        for (size_t i = 0; i < n; i++)
            s->t[i] = s->w[i] + beta * s->t[i];
        transform_filter(s->transform, s->compliance, 1, s->t, s->w);
        double curvature = dot(n, s->t, s->w);
        if (!(curvature > 0))
            break;
        double step = dot(n, s->r, s->t) / curvature;
        memcpy(s->old, s->r, n * sizeof *s->r);
        for (size_t i = 0; i < n; i++) {
            forces[i] += step * s->t[i];
            s->r[i] -= active[i] ? step * s->w[i] : 0;
        }
        shift += subtract_mean(s, active);
    }
    return shift;
}
