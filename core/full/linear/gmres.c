#include "core/full/linear/gmres.h"
#include "core/full/linear/aliasing.h"
#include "core/full/linear/hessenberg.h"
#include "core/full/linear/sliding_face.h"
#include "core/vectors.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { BASIS = 24, RESTARTS = 10, LANES = 8 };
_Static_assert((int)BASIS *(int)RESTARTS == (int)LINEAR_ITERATIONS_MOST, "another most");
/* A restart that leaves more than this part of the residual is the last one. */
static const double STALLED = 0.5;
/* Part of lambda on the mean dilatation over the shear modulus above which pressures are unknowns
 * of their own: that of nu = 0.4502. */
static const double BULK_RATIO_LEAST = 4.8;
/* Bulk over shear modulus of the flat block, at most. Pressures of alternate signs from one element
 * to the next bear on no forces of a flat block, and on some of a rough one. The flat block answers
 * to them by its bulk modulus alone, far too much where that is large. Of 3 profiles and one
 * surface each, slopes of 0.1 to 0.5, these took the fewest iterations, within a tenth. */
static const double PROFILE_BULK_MOST = 60, SURFACE_BULK_MOST = 300;
/* The preconditioner solves the face (face_solver.h) down to this residual. */
static const double FACE_TOLERANCE = 1e-3;
/* Bytes of the directions of gmres_lengthen, at most. */
static const double LONG_BYTES = 2.5e8;
/* Shears, displacements of the flat. */
enum { BEHIND_MOST = 2 * SIDEWAYS_MOST };

struct gmres {
    const struct mesh *mesh; /* borrowed */
    struct preconditioner *preconditioner;
    struct face_solver face_solver;
    struct sliding_face *sliding_face; /* NULL without friction, as the next two */
    double *given, *borne;             /* vectors of it */
    struct volumetric *volumetric; /* of the flat block; NULL where pressures are not unknowns */
    size_t degrees_of_freedom, unknowns; /* the pressures of elements follow the displacements */
    size_t length; /* directions that there is room for: BASIS, or more (gmres_lengthen) */
    double *basis[HESSENBERG_MOST + 1]; /* orthonormal residuals */
    double *direction[HESSENBERG_MOST]; /* preconditioned */
    struct material flat;               /* of the flat block */
    struct preconditioner_drag drag;    /* of the preconditioner */
    double *load, *moved, *pressures;
    double *face, *target, *forces; /* by node of the face */
    struct hessenberg hessenberg;
};

/* Makes room for so many directions. */
static int basis_create(struct gmres *gmres, size_t length, struct error *err) {
    for (size_t b = 0; b < 2 * length + 1; b++) {
        double **array = b <= length ? &gmres->basis[b] : &gmres->direction[b - length - 1];
        if (*array == NULL)
            *array = array_create(gmres->unknowns + BEHIND_MOST, sizeof(double));
        if (*array == NULL)
            return error_memory(err, gmres->unknowns * sizeof(double), "residuals");
    }
    gmres->length = length;
    return 0;
}

int gmres_create(struct gmres **out, const struct mesh *mesh, const struct material *material,
                 enum gap_weighting weighting, struct error *err) {
    bool pressures = gmres_needs_pressures(material);
    *out = NULL;
    struct gmres *gmres = array_create(1, sizeof *gmres);
    if (gmres == NULL)
        return error_memory(err, sizeof *gmres, "residuals");
    gmres->mesh = mesh;
    gmres->degrees_of_freedom = mesh_degrees_of_freedom(mesh);
    gmres->unknowns = mesh_unknowns(mesh, pressures);
    double most = mesh->dimension == 2 ? PROFILE_BULK_MOST : SURFACE_BULK_MOST;
    gmres->flat = *material;
    gmres->flat.mean = fmin(material->mean, most * material->shear);
    int status =
        pressures ? volumetric_create(&gmres->volumetric, mesh, &gmres->flat, true, err) : 0;
    if (status == 0)
        status = preconditioner_create(&gmres->preconditioner, mesh, &gmres->flat,
                                       gmres->volumetric, err);
    if (status == 0)
        status =
            face_solver_create(&gmres->face_solver, mesh, gmres->preconditioner, weighting, err);
    if (status == 0)
        status = basis_create(gmres, BASIS, err);
    double **const others[] = {&gmres->face, &gmres->target, &gmres->forces,
                               &gmres->load, &gmres->moved,  &gmres->pressures};
    for (size_t a = 0; status == 0 && a < 6; a++) {
        *others[a] =
            array_create(a < 3 ? mesh->face : gmres->unknowns + BEHIND_MOST, sizeof(double));
        if (*others[a] == NULL)
            status = error_memory(err, gmres->unknowns * sizeof(double), "residuals");
    }
    if (status != 0)
        gmres_destroy(&gmres);
    *out = gmres;
    return status;
}

void gmres_destroy(struct gmres **handle) {
    struct gmres *gmres = *handle;
    if (gmres == NULL)
        return;
    for (size_t b = 0; b <= HESSENBERG_MOST; b++)
        free(gmres->basis[b]);
    for (size_t b = 0; b < HESSENBERG_MOST; b++)
        free(gmres->direction[b]);
    free(gmres->face);
    free(gmres->target);
    free(gmres->forces);
    free(gmres->load);
    free(gmres->moved);
    free(gmres->pressures);
    free(gmres->given);
    free(gmres->borne);
    sliding_face_destroy(&gmres->sliding_face);
    volumetric_destroy(&gmres->volumetric);
    face_solver_clear(&gmres->face_solver);
    preconditioner_destroy(&gmres->preconditioner);
    free(gmres);
    *handle = NULL;
}

int gmres_add_friction(struct gmres *gmres, enum gap_weighting weighting, struct error *err) {
    if (gmres->sliding_face != NULL)
        return 0;
    int status = sliding_face_create(&gmres->sliding_face, gmres->mesh, gmres->preconditioner,
                                     weighting, err);
    if (status != 0)
        return status;
    size_t values = sliding_face_values(gmres->sliding_face);
    gmres->given = array_create(values, sizeof *gmres->given);
    gmres->borne = array_create(values, sizeof *gmres->borne);
    return gmres->given != NULL && gmres->borne != NULL
               ? 0
               : error_memory(err, 2 * values * sizeof *gmres->given, "forces along the face");
}

/* Returns the directions that there is room for when it is lengthened. */
static size_t long_length(size_t unknowns) {
    double most = LONG_BYTES / (2 * sizeof(double) * (double)unknowns);
    size_t length = most < HESSENBERG_MOST ? (size_t)most : HESSENBERG_MOST;
    return length > BASIS ? length : BASIS;
}

int gmres_lengthen(struct gmres *gmres, struct error *err) {
    size_t length = long_length(gmres->unknowns);
    return length > gmres->length ? basis_create(gmres, length, err) : 0;
}

size_t gmres_friction_unknowns(const struct gmres *gmres) {
    return gmres->unknowns + 2 * ((size_t)gmres->mesh->dimension - 1);
}

double gmres_bytes(const struct mesh *mesh, const struct material *material, double iterations,
                   bool lengthened) {
    enum { VECTORS = 3, FACES = 7, WAVES = 5 };
    bool pressures = gmres_needs_pressures(material);
    double waves = (double)level_waves(&mesh->level[0]);
    double unknowns = (double)mesh_unknowns(mesh, pressures);
    double directions =
        lengthened ? (double)long_length(mesh_unknowns(mesh, pressures)) : fmin(iterations, BASIS);
    double vectors = 2 * directions + 1 + VECTORS;
    return preconditioner_bytes(mesh) + (pressures ? volumetric_bytes(mesh, true) : 0) +
           sizeof(double) * (vectors * unknowns + FACES * (double)mesh->face + WAVES * waves);
}

bool gmres_needs_pressures(const struct material *material) {
    return material->mean > BULK_RATIO_LEAST * material->shear;
}

void gmres_weigh(const struct gmres *gmres, const double *in, double *out) {
    face_solver_weigh(&gmres->face_solver, in, out);
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
static size_t unknowns_of(const struct gmres *gmres, const struct linear_system *system) {
    if (system->friction != NULL)
        return gmres_friction_unknowns(gmres);
    return system->factorisation != NULL ? gmres->degrees_of_freedom : gmres->unknowns;
}

/* Turns forces y along the face under x into the rows of a node in contact. */
static void operate_node(const struct gmres *gmres, const struct face_conditions *friction,
                         size_t node, const double *x, double *y) {
    size_t sideways = (size_t)gmres->mesh->dimension - 1, at = node * (sideways + 1);
    const double *flat = x + gmres->unknowns + sideways, *e = friction->direction + node * sideways;
    double slip[SIDEWAYS_MOST], force = 0, slid = 0, pressure = y[at + sideways];
    for (size_t k = 0; k < sideways; k++) {
        slip[k] = x[at + k] - flat[k];
        slid += e[k] * slip[k];
        force += e[k] * y[at + k];
    }
    for (size_t k = 0; k < sideways; k++) {
        double across = y[at + k] - e[k] * force - friction->stiffness * (slip[k] - e[k] * slid);
        y[at + k] =
            friction->node[node] == NODE_STICKS
                ? slip[k]
                : y[at + k] - friction->turn[node] * across - friction->friction * e[k] * pressure;
    }
}

/* The rows of y along the face and behind the others, of which y has forces. */
static void operate_friction(const struct gmres *gmres, const struct face_conditions *friction,
                             const double *x, double *y) {
    const struct mesh *mesh = gmres->mesh;
    size_t sideways = (size_t)mesh->dimension - 1, far_side = mesh_far_side(mesh);
    const double *shear = x + gmres->unknowns, *flat = shear + sideways;
    double *mean = y + gmres->unknowns, nodes = (double)(mesh->nodes - far_side);
    for (size_t node = 0; node < mesh->face; node++)
        if (friction->node[node] != NODE_FREE)
            operate_node(gmres, friction, node, x, y);
    for (size_t k = 0; k < sideways; k++) {
        mean[k] = 0;
        for (size_t node = far_side; node < mesh->nodes; node++) {
            y[node * (sideways + 1) + k] += shear[k] / nodes;
            mean[k] += x[node * (sideways + 1) + k] / nodes;
        }
        mean[sideways + k] =
            friction->drive[k].flat * flat[k] + friction->drive[k].shear * shear[k];
    }
}

static bool touches(const struct linear_system *system, size_t node) {
    return system->friction != NULL ? system->friction->node[node] != NODE_FREE
                                    : system->active[node];
}

/* y = A x. Rows are forces. The first node of the far side has the sum of the far side's vertical
 * ones; vertical rows of nodes in contact are the weighted displacements of the face. */
static void operate(struct gmres *gmres, const struct linear_system *system, const double *x,
                    double *y) {
    const struct mesh *mesh = gmres->mesh;
    size_t far_side = mesh_far_side(mesh);
    double sum = 0;
    tangent_apply(system->tangent, x, y);
    if (gmres->volumetric != NULL && system->factorisation == NULL) {
        volumetric_pressures(system->tangent->volumetric, x, -1, x + gmres->degrees_of_freedom,
                             y + gmres->degrees_of_freedom);
        volumetric_forces(system->tangent->volumetric, y + gmres->degrees_of_freedom, 1, y);
        volumetric_scale(system->tangent->volumetric, system->tangent->volumetric->row,
                         y + gmres->degrees_of_freedom, y + gmres->degrees_of_freedom);
    }
    for (size_t node = far_side; node < mesh->nodes; node++) {
        sum += y[mesh_vertical(mesh, node)];
        y[mesh_vertical(mesh, node)] = 0;
    }
    y[mesh_vertical(mesh, far_side)] = sum;
    for (size_t node = 0; node < mesh->face; node++)
        gmres->face[node] = x[mesh_vertical(mesh, node)];
    face_solver_weigh(&gmres->face_solver, gmres->face, gmres->face);
    if (system->friction != NULL)
        operate_friction(gmres, system->friction, x, y);
    for (size_t node = 0; node < mesh->face; node++)
        if (touches(system, node))
            y[mesh_vertical(mesh, node)] = gmres->face[node];
    for (int k = 0; system->pinned && k + 1 < mesh->dimension; k++)
        y[far_side * (size_t)mesh->dimension + (size_t)k] =
            x[far_side * (size_t)mesh->dimension + (size_t)k];
}

/* x: displacements by the factorised tangent, with the displacements of nodes in contact prescribed
 * by r. */
static int precondition_factored(struct gmres *gmres, const struct linear_system *system,
                                 const double *r, double *x, struct error *err) {
    const struct mesh *mesh = gmres->mesh;
    const bool *active = system->active;
    memset(gmres->moved, 0, gmres->degrees_of_freedom * sizeof *gmres->moved);
    for (size_t node = 0; node < mesh->face; node++)
        if (active[node])
            gmres->moved[mesh_vertical(mesh, node)] = r[mesh_vertical(mesh, node)];
    tangent_apply(system->tangent, gmres->moved, x);
    for (size_t f = 0; f < gmres->degrees_of_freedom; f++)
        x[f] = r[f] - x[f];
    int status = factorisation_solve(system->factorisation, x, err);
    for (size_t node = 0; node < mesh->face; node++)
        if (active[node])
            x[mesh_vertical(mesh, node)] = r[mesh_vertical(mesh, node)];
    return status;
}

/* Fills the pressures that r has of elements, and subtracts their forces from moved. */
static void bear_pressures(struct gmres *gmres, const double *r) {
    if (gmres->volumetric == NULL)
        return;
    volumetric_scale(gmres->volumetric, 1 / gmres->volumetric->row, r + gmres->degrees_of_freedom,
                     gmres->pressures);
    volumetric_forces(gmres->volumetric, gmres->pressures, -1, gmres->moved);
}

/* Fills x with the displacements and pressures of the flat block under r. */
static void preconditioner_apply_flat(struct gmres *gmres, const bool *active, const double *r,
                                      double *x) {
    const struct mesh *mesh = gmres->mesh;
    double sum = 0;
    memcpy(gmres->moved, r, gmres->degrees_of_freedom * sizeof *r);
    for (size_t node = 0; node < mesh->face; node++) {
        size_t vertical = mesh_vertical(mesh, node);
        gmres->target[node] = r[vertical];
        if (active[node])
            gmres->moved[vertical] = 0;
    }
    bear_pressures(gmres, r);
    for (size_t node = 0; node < mesh->nodes; node++)
        sum += gmres->moved[mesh_vertical(mesh, node)];
    preconditioner_load(gmres->preconditioner, gmres->moved);
    preconditioner_face(gmres->preconditioner, gmres->face);
    face_solver_weigh(&gmres->face_solver, gmres->face, gmres->face);
    double shift = face_solver_solve(&gmres->face_solver, active, gmres->face, gmres->target, -sum,
                                     FACE_TOLERANCE, gmres->forces);
    preconditioner_displace(gmres->preconditioner, gmres->forces, x);
    for (size_t node = 0; node < mesh->nodes; node++)
        x[mesh_vertical(mesh, node)] += shift;
    if (gmres->volumetric != NULL)
        volumetric_pressures(gmres->volumetric, x, 1, gmres->pressures,
                             x + gmres->degrees_of_freedom);
}

/* Fills what the flat block's face is to do under r, less what it does under moved, the forces on
 * all nodes but those of the contact; sum has theirs. */
static void give_face(struct gmres *gmres, const struct face_conditions *friction, const double *r,
                      const double *sum) {
    const struct mesh *mesh = gmres->mesh;
    size_t d = (size_t)mesh->dimension, face = mesh->face;
    double *given = gmres->given, *vertical = given + (d - 1) * face;
    const double *mean = r + gmres->unknowns, *drives = mean + d - 1;
    preconditioner_face_all(gmres->preconditioner, given);
    face_solver_weigh(&gmres->face_solver, vertical, vertical);
    for (size_t node = 0; node < face; node++) {
        const double *e = friction->direction + node * (d - 1);
        bool free = friction->node[node] == NODE_FREE, sticks = friction->node[node] == NODE_STICKS;
        double turns = sticks ? 1 : friction->turn[node] * friction->stiffness, slid = 0;
        for (size_t k = 0; k + 1 < d; k++)
            slid += sticks ? 0 : e[k] * (given[k * face + node] + mean[k]);
        for (size_t k = 0; k + 1 < d; k++) {
            double slip = given[k * face + node] + mean[k] - (sticks ? 0 : e[k] * slid);
            given[k * face + node] = free ? 0 : r[node * d + k] - turns * slip;
        }
        vertical[node] = free ? 0 : r[node * d + d - 1] - vertical[node];
    }
    for (size_t k = 0; k + 1 < d; k++)
        given[d * face + k] = drives[k] - friction->drive[k].shear * sum[k];
    given[d * face + d - 1] = -sum[d - 1];
}

/* Subtracts the drag's forces from the shears. */
static void bear_drag(const struct gmres *gmres, const double *x, double *shears) {
    size_t d = (size_t)gmres->mesh->dimension;
    for (size_t node = 0; gmres->drag.of > 0 && node < gmres->mesh->nodes; node++)
        for (size_t k = 0; k + 1 < d; k++)
            shears[k] -= gmres->drag.of * x[node * d + k];
}

/* The same with friction. Without drag forces along the far side balance those on the other nodes,
 * so that its mean does not move (preconditioner.h); with drag it is held. What the drag bears is
 * left out of what drives the flat's shear. */
static void precondition_friction(struct gmres *gmres, const struct face_conditions *friction,
                                  const double *r, double *x) {
    const struct mesh *mesh = gmres->mesh;
    size_t d = (size_t)mesh->dimension, face = mesh->face, far_side = mesh_far_side(mesh);
    double sum[SIDEWAYS_MOST + 1] = {0}, nodes = (double)(mesh->nodes - far_side);
    double move[SIDEWAYS_MOST + 1], *behind = x + gmres->unknowns;
    memcpy(gmres->moved, r, gmres->degrees_of_freedom * sizeof *r);
    for (size_t node = 0; node < face; node++)
        for (size_t k = 0; friction->node[node] != NODE_FREE && k < d; k++)
            gmres->moved[node * d + k] = 0;
    bear_pressures(gmres, r);
    for (size_t node = 0; node < mesh->nodes; node++)
        for (size_t k = 0; k < d; k++)
            sum[k] += gmres->moved[node * d + k];
    for (size_t node = far_side; node < mesh->nodes; node++)
        for (size_t k = 0; k + 1 < d; k++)
            gmres->moved[node * d + k] -= sum[k] / nodes;
    preconditioner_load(gmres->preconditioner, gmres->moved);
    give_face(gmres, friction, r, sum);
    sliding_face_solve(gmres->sliding_face, friction, gmres->given, FACE_TOLERANCE, gmres->borne);
    preconditioner_displace_all(gmres->preconditioner, gmres->borne, x);
    for (size_t k = 0; k + 1 < d; k++) {
        double borne = 0;
        for (size_t node = 0; node < face; node++)
            borne += gmres->borne[k * face + node];
        behind[k] = sum[k] + borne;
        behind[d - 1 + k] = gmres->borne[d * face + k];
        move[k] = r[gmres->unknowns + k] - (gmres->drag.held ? 0 : borne / nodes);
    }
    move[d - 1] = gmres->borne[d * face + d - 1];
    for (size_t node = 0; node < mesh->nodes; node++)
        for (size_t k = 0; k < d; k++)
            x[node * d + k] += move[k];
    bear_drag(gmres, x, behind);
    if (gmres->volumetric != NULL)
        volumetric_pressures(gmres->volumetric, x, 1, gmres->pressures,
                             x + gmres->degrees_of_freedom);
}

/* --- minimal residuals --- */

static void combine(struct gmres *gmres, size_t n, size_t count, double *x) {
    double factor[HESSENBERG_MOST];
    hessenberg_solve(&gmres->hessenberg, count, factor);
    for (size_t a = 0; a < count; a++)
        add(n, factor[a], gmres->direction[a], x);
}

/* One restart from the residual in basis 0, whose size is *left, of `most` iterations at most: adds
 * its solution to x and sets *left to the size that remains. */
static int cycle(struct gmres *gmres, const struct linear_system *system, double goal, size_t most,
                 double *x, double *left, size_t *iterations, struct error *err) {
    size_t n = unknowns_of(gmres, system), c = 0;
    const size_t length = system->lengthy ? gmres->length : BASIS;
    scale(n, 1 / *left, gmres->basis[0]);
    gmres->hessenberg.right[0] = *left;
    for (double size = 1; c < length && c<most && * left> goal && size > 0; c++) {
        double *next = gmres->basis[c + 1];
        int status = 0;
        if (system->stop != NULL && system->stop(system->context) != 0)
            return error_set(err, ERROR_STOPPED, "stopped after %zu iterations of linear equations",
                             *iterations + c);
        if (system->factorisation != NULL)
            status =
                precondition_factored(gmres, system, gmres->basis[c], gmres->direction[c], err);
        else if (system->friction != NULL)
            precondition_friction(gmres, system->friction, gmres->basis[c], gmres->direction[c]);
        else
            preconditioner_apply_flat(gmres, system->active, gmres->basis[c], gmres->direction[c]);
        if (status != 0)
            return status;
        operate(gmres, system, gmres->direction[c], next);
        for (size_t a = 0; a <= c; a++) {
            gmres->hessenberg.h[a][c] = dot(n, next, gmres->basis[a]);
            add(n, -gmres->hessenberg.h[a][c], gmres->basis[a], next);
        }
        size = sqrt(dot(n, next, next));
        gmres->hessenberg.h[c + 1][c] = size;
        if (size > 0)
            scale(n, 1 / size, next);
        *left = hessenberg_rotate(&gmres->hessenberg, c);
    }
    combine(gmres, n, c, x);
    *iterations += c;
    return 0;
}

/* Moves the block sideways as a whole, so that the first node of its far side does not move. */
static void hold(const struct gmres *gmres, double *x) {
    size_t d = (size_t)gmres->mesh->dimension, held = mesh_far_side(gmres->mesh) * d;
    for (size_t axis = 0; axis + 1 < d; axis++) {
        double drift = x[held + axis];
        for (size_t node = 0; node < gmres->mesh->nodes; node++)
            x[node * d + axis] -= drift;
    }
}

/* Subtracts the forces of the pressures from x, where the equations are solved for displacements
 * alone. Rows that prescribe displacements stay, and those of the far side have one sum. */
static void eliminate_pressures(struct gmres *gmres, const struct linear_system *system,
                                double *x) {
    const struct mesh *mesh = gmres->mesh;
    const struct volumetric *volumetric = system->tangent->volumetric;
    size_t d = (size_t)mesh->dimension, far_side = mesh_far_side(mesh);
    double *forces = gmres->moved, sum = 0;
    memset(forces, 0, gmres->degrees_of_freedom * sizeof *forces);
    volumetric_scale(volumetric, 1 / volumetric->row, x + gmres->degrees_of_freedom,
                     gmres->pressures);
    volumetric_forces(volumetric, gmres->pressures, -1, forces);
    for (size_t node = 0; node < mesh->face; node++)
        if (system->active[node])
            forces[mesh_vertical(mesh, node)] = 0;
    for (size_t node = far_side; node < mesh->nodes; node++) {
        sum += forces[mesh_vertical(mesh, node)];
        forces[mesh_vertical(mesh, node)] = 0;
    }
    forces[mesh_vertical(mesh, far_side)] = sum;
    for (size_t k = 0; system->pinned && k + 1 < d; k++)
        forces[far_side * d + k] = 0;
    add(gmres->degrees_of_freedom, 1, forces, x);
}

/* Gives the flat block the drag of the equations. */
static int set_drag(struct gmres *gmres, const struct linear_system *system, struct error *err) {
    const struct preconditioner_drag drag = {.of = system->drag,
                                             .held = system->drag > 0 && system->friction != NULL};
    if (system->factorisation != NULL ||
        (drag.of == gmres->drag.of && drag.held == gmres->drag.held))
        return 0;
    int status =
        preconditioner_set_drag(gmres->preconditioner, &gmres->flat, gmres->volumetric, drag, err);
    if (status != 0)
        return status;
    gmres->drag = drag;
    face_solver_renew(&gmres->face_solver, gmres->mesh, gmres->preconditioner);
    if (gmres->sliding_face != NULL)
        sliding_face_renew(gmres->sliding_face, gmres->mesh, gmres->preconditioner);
    return 0;
}

int gmres_solve(struct gmres *gmres, const struct linear_system *system, double tolerance,
                double *x, size_t *iterations, struct error *err) {
    size_t n = unknowns_of(gmres, system);
    bool eliminated = system->factorisation != NULL && gmres->volumetric != NULL;
    int status = set_drag(gmres, system, err);
    if (status != 0)
        return status;
    if (eliminated)
        eliminate_pressures(gmres, system, x);
    double first = sqrt(dot(n, x, x)), left = first, before = INFINITY;
    const size_t most = system->most > 0 ? system->most : LINEAR_ITERATIONS_MOST;
    const size_t end = *iterations + most;
    memcpy(gmres->load, x, n * sizeof *x);
    memcpy(gmres->basis[0], x, n * sizeof *x);
    memset(x, 0, n * sizeof *x);
    for (int restart = 0; restart < RESTARTS && left > tolerance * first; restart++) {
        if (restart > 0) {
            operate(gmres, system, x, gmres->basis[0]);
            for (size_t i = 0; i < n; i++)
                gmres->basis[0][i] = gmres->load[i] - gmres->basis[0][i];
            left = sqrt(dot(n, gmres->basis[0], gmres->basis[0]));
        }
        if (!(left <= STALLED * before) || *iterations >= end)
            break;
        before = left;
        status =
            cycle(gmres, system, tolerance * first, end - *iterations, x, &left, iterations, err);
        if (status != 0)
            return status;
    }
    if (system->friction == NULL && system->drag == 0)
        hold(gmres, x);
    if (eliminated)
        volumetric_pressures(system->tangent->volumetric, x, 1, gmres->pressures,
                             x + gmres->degrees_of_freedom);
    if (!(left <= tolerance * first))
        return error_set(err, ERROR_NUMERIC,
                         "the linear equations of a step of Newton's were solved to %.2g only",
                         left / first);
    return 0;
}
