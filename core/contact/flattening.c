#include "core/contact/flattening.h"
#include "core/contact/solver/bounded_set.h"
#include "core/sum.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { ARRAYS = 4 };

double flattening_bytes(const struct grid *grid) {
    return sizeof(double) * ARRAYS * ((double)grid_points(grid) + CONJUGATE_GRADIENT_LANES);
}

int flattening_create(struct flattening *out, const struct conjugate_gradient *solver,
                      struct error *err) {
    double **const arrays[ARRAYS] = {&out->face, &out->depth, &out->kept, &out->resisting};
    *out = (struct flattening){.hardness = INFINITY};
    for (size_t a = 0; a < ARRAYS; a++) {
        *arrays[a] = array_create(solver->padded, sizeof(double));
        if (*arrays[a] == NULL) {
            flattening_clear(out);
            return error_memory(err, solver->padded * sizeof(double), "a contact");
        }
    }
    return 0;
}

void flattening_clear(struct flattening *f) {
    free(f->face);
    free(f->depth);
    free(f->kept);
    free(f->resisting);
    *f = (struct flattening){.hardness = INFINITY};
}

void flattening_begin(struct flattening *f, const struct conjugate_gradient *solver,
                      double hardness) {
    f->hardness = hardness;
    f->volume = f->approach = f->highest = 0;
    f->lowered = false;
    memcpy(f->face, solver->z, solver->padded * sizeof *f->face);
    memset(f->depth, 0, solver->padded * sizeof *f->depth);
    memset(f->resisting, 0, solver->padded * sizeof *f->resisting);
}

void flattening_swap(struct flattening *f, struct conjugate_gradient *solver) {
    double *tangent = solver->q;
    solver->q = f->resisting;
    f->resisting = tangent;
}

void flattening_turn(struct flattening *f, struct conjugate_gradient *solver, double mean,
                     double unit) {
    bool lowered = f->volume > 0 && mean < f->highest;
    solver->hardness = lowered ? INFINITY : f->hardness;
    if (lowered == f->lowered)
        return;
    flattening_swap(f, solver);
    for (size_t i = 0; i < solver->n; i++)
        solver->z[i] = lowered ? f->face[i] - f->depth[i] / unit : f->face[i];
    f->lowered = lowered;
}

bool flattening_limit(const struct flattening *f, struct conjugate_gradient *solver, double mean) {
    const double load = mean * (double)solver->n;
    double sum;
    size_t held = 0, last;
    /* Pressures below the hardness are scaled until they bear what the others do not; each time
     * more reach it. */
    do {
        double below = 0;
        last = held;
        held = 0;
        for (size_t i = 0; i < solver->n; i++) {
            held += solver->p[i] >= f->hardness;
            below += solver->p[i] < f->hardness ? solver->p[i] : 0;
        }
        if (held == 0)
            return false;
        double left = fmax(0, load - (double)held * f->hardness);
        double factor = below > 0 ? left / below : 1;
        sum = 0;
        for (size_t i = 0; i < solver->n; i++) {
            bool free = solver->p[i] < f->hardness;
            solver->p[i] = free ? fmin(f->hardness, factor * solver->p[i]) : f->hardness;
            sum += solver->p[i];
        }
    } while (held != last && sum < load);
    for (size_t i = 0; i < solver->n && !(fabs(sum - load) <= 1e-9 * load); i++)
        solver->p[i] = mean;
    return true;
}

size_t flattening_take(struct flattening *f, const struct conjugate_gradient *solver,
                       double approach, double mean, double unit) {
    struct sum sum = {0};
    double highest = -INFINITY, left = -INFINITY; /* before and after */
    size_t yielded = 0;
    for (size_t i = 0; i < solver->n; i++) {
        bool held = solver->p[i] >= f->hardness;
        double gap = solver->u[i] - solver->z[i] + approach;
        f->depth[i] = held ? fmax(0, -gap) * unit : 0;
        highest = fmax(highest, solver->z[i]);
        left = fmax(left, solver->z[i] - f->depth[i] / unit);
        yielded += held;
        sum_add(&sum, f->depth[i]);
    }
    f->volume = sum_value(&sum) / (double)solver->n;
    f->approach = (highest - left) * unit;
    f->highest = mean;
    return yielded;
}
