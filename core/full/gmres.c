#include "core/full/gmres.h"
#include "core/full/aliasing.h"
#include "core/vectors.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { BASIS = 24, RESTARTS = 10, LANES = 8 };
/* A restart that leaves more than this share of the residual is the last one. */
static const double STALLED = 0.5;
/* Bulk over shear modulus above which pressures are unknowns of their own. */
static const double BULK_RATIO_LEAST = 10;
/* Residual of face_solver.h that is left inside the preconditioner. */
static const double FACE_TOLERANCE = 1e-3;

struct gmres {
    const struct mesh *mesh; /* borrowed */
    struct preconditioner *preconditioner;
    struct face_solver face_solver;
    struct volumetric *volumetric; /* of the flat block; NULL where pressures are not unknowns */
    size_t degrees_of_freedom, unknowns; /* the pressures of elements follow the displacements */
    double *basis[BASIS + 1];            /* orthonormal residuals */
    double *direction[BASIS];            /* preconditioned */
    double *load, *moved, *pressures;
    double *face, *target, *forces;      /* by node of the face */
    double hessenberg[BASIS + 1][BASIS]; /* made upper triangular by rotate() */
    double cosine[BASIS], sine[BASIS], right[BASIS + 1];
};

int gmres_create(struct gmres **out, const struct mesh *mesh, const struct material *material,
                 enum gap_weighting weighting, struct error *err) {
    bool pressures = gmres_needs_pressures(material);
    *out = NULL;
    struct gmres *k = array_create(1, sizeof *k);
    if (k == NULL)
        return error_memory(err, sizeof *k, "residuals");
    k->mesh = mesh;
    k->degrees_of_freedom = mesh_degrees_of_freedom(mesh);
    k->unknowns = mesh_unknowns(mesh, pressures);
    int status = pressures ? volumetric_create(&k->volumetric, mesh, true, err) : 0;
    if (status == 0)
        status = preconditioner_create(&k->preconditioner, mesh, material, k->volumetric, err);
    if (status == 0)
        status = face_solver_create(&k->face_solver, mesh, k->preconditioner, weighting, err);
    for (size_t b = 0; status == 0 && b < 2 * BASIS + 1; b++) {
        double **array = b <= BASIS ? &k->basis[b] : &k->direction[b - BASIS - 1];
        *array = array_create(k->unknowns, sizeof(double));
        if (*array == NULL)
            status = error_memory(err, k->unknowns * sizeof(double), "residuals");
    }
    double **const others[] = {&k->face, &k->target, &k->forces,
                               &k->load, &k->moved,  &k->pressures};
    for (size_t a = 0; status == 0 && a < 6; a++) {
        *others[a] = array_create(a < 3 ? mesh->face : k->unknowns, sizeof(double));
        if (*others[a] == NULL)
            status = error_memory(err, k->unknowns * sizeof(double), "residuals");
    }
    if (status != 0)
        gmres_destroy(&k);
    *out = k;
    return status;
}

void gmres_destroy(struct gmres **gmres) {
    struct gmres *k = *gmres;
    if (k == NULL)
        return;
    for (size_t b = 0; b <= BASIS; b++)
        free(k->basis[b]);
    for (size_t b = 0; b < BASIS; b++)
        free(k->direction[b]);
    free(k->face);
    free(k->target);
    free(k->forces);
    free(k->load);
    free(k->moved);
    free(k->pressures);
    volumetric_destroy(&k->volumetric);
    face_solver_clear(&k->face_solver);
    preconditioner_destroy(&k->preconditioner);
    free(k);
    *gmres = NULL;
}

double gmres_bytes(const struct mesh *mesh, const struct material *material, double iterations) {
    enum { VECTORS = 3, FACES = 7, WAVES = 5 };
    bool pressures = gmres_needs_pressures(material);
    double waves = (double)level_waves(&mesh->level[0]);
    double unknowns = (double)mesh_unknowns(mesh, pressures);
    double vectors = 2 * fmin(iterations, BASIS) + 1 + VECTORS;
    return preconditioner_bytes(mesh) + (pressures ? volumetric_bytes(mesh, true) : 0) +
           sizeof(double) * (vectors * unknowns + FACES * (double)mesh->face + WAVES * waves);
}

bool gmres_needs_pressures(const struct material *material) {
    return material->mean > BULK_RATIO_LEAST * material->shear;
}

void gmres_weigh(const struct gmres *k, const double *in, double *out) {
    face_solver_weigh(&k->face_solver, in, out);
}

/* --- vectors --- */

WIDE_VECTORS static double dot(size_t n, const double *a, const double *b) {
    double lanes[LANES] = {0}, sum = 0;
    size_t i = 0;
    for (; i + LANES <= n; i += LANES)
        for (size_t l = 0; l < LANES; l++)
            lanes[l] += a[i + l] * b[i + l];
    for (; i < n; i++)
        sum += a[i] * b[i];
    for (size_t l = 0; l < LANES; l++)
        sum += lanes[l];
    return sum;
}

WIDE_VECTORS static void add(size_t n, double factor, const double *x, double *y) {
    for (size_t i = 0; i < n; i++)
        y[i] += factor * x[i];
}

static void scale(size_t n, double factor, double *x) {
    for (size_t i = 0; i < n; i++)
        x[i] *= factor;
}

/* --- operator and preconditioner --- */

/* The factorisation covers the equations of the displacements alone. */
static size_t unknowns_of(const struct gmres *k, const struct linear_system *system) {
    return system->factorisation != NULL ? k->degrees_of_freedom : k->unknowns;
}

/* y = A x. Rows are forces; the far side's first node has the sum of its vertical ones; vertical
 * rows of nodes in contact are the weighted displacements of the face. */
static void operate(struct gmres *k, const struct linear_system *system, const double *x,
                    double *y) {
    const struct mesh *mesh = k->mesh;
    size_t far_side = mesh_far_side(mesh);
    double sum = 0;
    tangent_apply(system->tangent, x, y);
    if (unknowns_of(k, system) > k->degrees_of_freedom) {
        volumetric_pressures(system->tangent->volumetric, x, -1, x + k->degrees_of_freedom,
                             y + k->degrees_of_freedom);
        volumetric_forces(system->tangent->volumetric, y + k->degrees_of_freedom, 1, y);
    }
    for (size_t node = far_side; node < mesh->nodes; node++) {
        sum += y[mesh_vertical(mesh, node)];
        y[mesh_vertical(mesh, node)] = 0;
    }
    y[mesh_vertical(mesh, far_side)] = sum;
    for (size_t node = 0; node < mesh->face; node++)
        k->face[node] = x[mesh_vertical(mesh, node)];
    face_solver_weigh(&k->face_solver, k->face, k->face);
    for (size_t node = 0; node < mesh->face; node++)
        if (system->active[node])
            y[mesh_vertical(mesh, node)] = k->face[node];
}

/* x: displacements from the factorised tangent, where nodes in contact move by what r prescribes.
 */
static int precondition_factored(struct gmres *k, const struct linear_system *system,
                                 const double *r, double *x, struct error *err) {
    const struct mesh *mesh = k->mesh;
    const bool *active = system->active;
    memset(k->moved, 0, k->degrees_of_freedom * sizeof *k->moved);
    for (size_t node = 0; node < mesh->face; node++)
        if (active[node])
            k->moved[mesh_vertical(mesh, node)] = r[mesh_vertical(mesh, node)];
    tangent_apply(system->tangent, k->moved, x);
    for (size_t f = 0; f < k->degrees_of_freedom; f++)
        x[f] = r[f] - x[f];
    int status = factorisation_solve(system->factorisation, x, err);
    for (size_t node = 0; node < mesh->face; node++)
        if (active[node])
            x[mesh_vertical(mesh, node)] = r[mesh_vertical(mesh, node)];
    return status;
}

/* x: the displacements and pressures of the flat block under r. */
static void precondition_flat(struct gmres *k, const bool *active, const double *r, double *x) {
    const struct mesh *mesh = k->mesh;
    double sum = 0;
    memcpy(k->moved, r, k->degrees_of_freedom * sizeof *r);
    for (size_t node = 0; node < mesh->face; node++) {
        size_t vertical = mesh_vertical(mesh, node);
        k->target[node] = r[vertical];
        if (active[node])
            k->moved[vertical] = 0;
    }
    if (k->volumetric != NULL)
        volumetric_forces(k->volumetric, r + k->degrees_of_freedom, -1, k->moved);
    for (size_t node = 0; node < mesh->nodes; node++)
        sum += k->moved[mesh_vertical(mesh, node)];
    preconditioner_load(k->preconditioner, k->moved);
    preconditioner_face(k->preconditioner, k->face);
    face_solver_weigh(&k->face_solver, k->face, k->face);
    double shift = face_solver_solve(&k->face_solver, active, k->face, k->target, -sum,
                                     FACE_TOLERANCE, k->forces);
    preconditioner_displace(k->preconditioner, k->forces, x);
    for (size_t node = 0; node < mesh->nodes; node++)
        x[mesh_vertical(mesh, node)] += shift;
    if (k->volumetric != NULL)
        volumetric_pressures(k->volumetric, x, 1, r + k->degrees_of_freedom,
                             x + k->degrees_of_freedom);
}

/* --- minimal residuals --- */

/* Givens' rotations make column c upper triangular. Returns the size of the residual. */
static double rotate(struct gmres *k, size_t c) {
    double(*h)[BASIS] = k->hessenberg;
    for (size_t a = 0; a < c; a++) {
        double upper = h[a][c], lower = h[a + 1][c];
        h[a][c] = k->cosine[a] * upper + k->sine[a] * lower;
        h[a + 1][c] = k->cosine[a] * lower - k->sine[a] * upper;
    }
    double size = hypot(h[c][c], h[c + 1][c]);
    k->cosine[c] = h[c][c] / size;
    k->sine[c] = h[c + 1][c] / size;
    h[c][c] = size;
    k->right[c + 1] = -k->sine[c] * k->right[c];
    k->right[c] *= k->cosine[c];
    return fabs(k->right[c + 1]);
}

static void combine(struct gmres *k, size_t n, size_t count, double *x) {
    double factor[BASIS];
    for (size_t a = count; a-- > 0;) {
        factor[a] = k->right[a];
        for (size_t b = a + 1; b < count; b++)
            factor[a] -= k->hessenberg[a][b] * factor[b];
        factor[a] /= k->hessenberg[a][a];
    }
    for (size_t a = 0; a < count; a++)
        add(n, factor[a], k->direction[a], x);
}

/* One restart from the residual in basis 0, whose size is *left: adds its solution to x and sets
 * *left to the size that remains. */
static int cycle(struct gmres *k, const struct linear_system *system, double goal, double *x,
                 double *left, size_t *iterations, struct error *err) {
    size_t n = unknowns_of(k, system), c = 0;
    scale(n, 1 / *left, k->basis[0]);
    k->right[0] = *left;
    for (double size = 1; c<BASIS && * left> goal && size > 0; c++) {
        double *next = k->basis[c + 1];
        int status = 0;
        if (system->factorisation != NULL)
            status = precondition_factored(k, system, k->basis[c], k->direction[c], err);
        else
            precondition_flat(k, system->active, k->basis[c], k->direction[c]);
        if (status != 0)
            return status;
        operate(k, system, k->direction[c], next);
        for (size_t a = 0; a <= c; a++) {
            k->hessenberg[a][c] = dot(n, next, k->basis[a]);
            add(n, -k->hessenberg[a][c], k->basis[a], next);
        }
        size = sqrt(dot(n, next, next));
        k->hessenberg[c + 1][c] = size;
        if (size > 0)
            scale(n, 1 / size, next);
        *left = rotate(k, c);
    }
    combine(k, n, c, x);
    *iterations += c;
    return 0;
}

/* Moves the block sideways as a whole, so that the first node of its far side does not move. */
static void hold(const struct gmres *k, double *x) {
    size_t d = (size_t)k->mesh->dimension, held = mesh_far_side(k->mesh) * d;
    for (size_t axis = 0; axis + 1 < d; axis++) {
        double drift = x[held + axis];
        for (size_t node = 0; node < k->mesh->nodes; node++)
            x[node * d + axis] -= drift;
    }
}

/* Subtracts the forces of the pressures from x, where the equations are solved for displacements
 * alone. */
static void eliminate_pressures(struct gmres *k, const struct linear_system *system, double *x) {
    memcpy(k->pressures, x + k->degrees_of_freedom,
           (k->unknowns - k->degrees_of_freedom) * sizeof *x);
    volumetric_forces(system->tangent->volumetric, k->pressures, -1, x);
}

int gmres_solve(struct gmres *k, const struct linear_system *system, double tolerance, double *x,
                size_t *iterations, struct error *err) {
    size_t n = unknowns_of(k, system);
    bool eliminated = n < k->unknowns;
    if (eliminated)
        eliminate_pressures(k, system, x);
    double first = sqrt(dot(n, x, x)), left = first, before = INFINITY;
    memcpy(k->load, x, n * sizeof *x);
    memcpy(k->basis[0], x, n * sizeof *x);
    memset(x, 0, n * sizeof *x);
    for (int restart = 0; restart < RESTARTS && left > tolerance * first; restart++) {
        if (restart > 0) {
            operate(k, system, x, k->basis[0]);
            for (size_t i = 0; i < n; i++)
                k->basis[0][i] = k->load[i] - k->basis[0][i];
            left = sqrt(dot(n, k->basis[0], k->basis[0]));
        }
        if (!(left <= STALLED * before))
            break;
        before = left;
        int status = cycle(k, system, tolerance * first, x, &left, iterations, err);
        if (status != 0)
            return status;
    }
    hold(k, x);
    if (eliminated)
        volumetric_pressures(system->tangent->volumetric, x, 1, k->pressures,
                             x + k->degrees_of_freedom);
    if (!(left <= tolerance * first))
        return error_set(err, ERROR_NUMERIC,
                         "the linear equations of a step of Newton's were solved to %.2g only",
                         left / first);
    return 0;
}
