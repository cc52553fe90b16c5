#include "core/full/self_contact_surface.h"
#include "core/full/face.h"
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* Cosine between the normals of a node and a point that meet, at most. */
static const double OPPOSED = -0.5;
static const size_t NONE = SIZE_MAX;
enum { STEPS_LEAST = 2, PATCH_SIDE = 3 };

struct vector {
    double x[3];
};

static double dot(const double *a, const double *b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static struct vector cross(const double *a, const double *b) {
    return (struct vector){
        {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}};
}

static double size_of(const struct mesh *mesh, int axis) {
    return axis == 0 ? (double)mesh->level[0].nx : (double)mesh->level[0].ny * mesh->across;
}

/* Moves a difference across the side of the cell where that is shorter. */
static void wrap(const struct mesh *mesh, double *difference) {
    for (int axis = 0; axis < 2; axis++) {
        double size = size_of(mesh, axis);
        difference[axis] -= size * round(difference[axis] / size);
    }
}

/* Returns the node so many steps along from another; they are -1 to 1, or up to the last node. */
static size_t node_at(const struct mesh *mesh, size_t node, size_t along, size_t back) {
    size_t nx = mesh->level[0].nx, ny = mesh->level[0].ny;
    return (node / nx + ny + back) % ny * nx + (node % nx + nx + along) % nx;
}

/* Nodes of a row, at least 1. */
static size_t row_of(const struct mesh *mesh) {
    return mesh->level[0].nx > 0 ? mesh->level[0].nx : 1;
}

static struct vector position_of(const struct mesh *mesh, const double *u, size_t node) {
    size_t row = node / row_of(mesh), column = node % row_of(mesh);
    return (struct vector){{(double)column + u[3 * node],
                            (double)row * mesh->across + u[3 * node + 1],
                            mesh->height[node] + u[3 * node + 2]}};
}

/* Positions of the nodes of a patch, without jumps at the sides of the cell. */
static void fill_nodes(const struct mesh *mesh, const double *u, size_t node, size_t *nodes,
                       struct vector *positions) {
    struct vector centre = position_of(mesh, u, node);
    for (size_t a = 0; a < PATCH_NODES; a++) {
        nodes[a] = node_at(mesh, node, a % PATCH_SIDE - 1, a / PATCH_SIDE - 1);
        struct vector p = position_of(mesh, u, nodes[a]);
        for (int k = 0; k < 3; k++)
            p.x[k] -= centre.x[k];
        wrap(mesh, p.x);
        for (int k = 0; k < 3; k++)
            positions[a].x[k] = centre.x[k] + p.x[k];
    }
}

/* Steps from a node to another, the fewest across the sides of the cell. */
static void fill_steps(const struct mesh *mesh, size_t from, size_t to, long steps[2]) {
    long nx = (long)mesh->level[0].nx, ny = (long)mesh->level[0].ny;
    steps[0] = (long)(to % (size_t)nx) - (long)(from % (size_t)nx);
    steps[1] = (long)(to / (size_t)nx) - (long)(from / (size_t)nx);
    steps[0] -= 2 * steps[0] > nx ? nx : 2 * steps[0] <= -nx ? -nx : 0;
    steps[1] -= 2 * steps[1] > ny ? ny : 2 * steps[1] <= -ny ? -ny : 0;
}

/* A point of a patch: shape functions and their derivatives along s and t, and what they make of
 * the nodes. */
struct patch_point {
    size_t node[PATCH_NODES];
    double shape[PATCH_NODES], slope[2][PATCH_NODES];
    struct vector at, along[2], bend[3]; /* bend: by ss, st, tt */
    struct vector normal;                /* of length 1, out of the block */
};

static void fill_spline(double t, double shape[3], double slope[3]) {
    shape[0] = (1 - t) * (1 - t) / 2;
    shape[1] = 0.5 + t * (1 - t);
    shape[2] = t * t / 2;
    slope[0] = t - 1;
    slope[1] = 1 - 2 * t;
    slope[2] = t;
}

static struct patch_point point_of(const struct mesh *mesh, const double *u, size_t node, double s,
                                   double t) {
    static const double CURVE[PATCH_SIDE] = {1, -2, 1};
    struct patch_point p = {.node = {0}};
    struct vector positions[PATCH_NODES];
    double shape[2][PATCH_SIDE], slope[2][PATCH_SIDE];
    fill_spline(s, shape[0], slope[0]);
    fill_spline(t, shape[1], slope[1]);
    fill_nodes(mesh, u, node, p.node, positions);
    for (size_t a = 0; a < PATCH_NODES; a++) {
        size_t i = a % PATCH_SIDE, j = a / PATCH_SIDE;
        p.shape[a] = shape[0][i] * shape[1][j];
        p.slope[0][a] = slope[0][i] * shape[1][j];
        p.slope[1][a] = shape[0][i] * slope[1][j];
        double bend[3] = {CURVE[i] * shape[1][j], slope[0][i] * slope[1][j],
                          shape[0][i] * CURVE[j]};
        for (int k = 0; k < 3; k++) {
            p.at.x[k] += p.shape[a] * positions[a].x[k];
            for (int b = 0; b < 2; b++)
                p.along[b].x[k] += p.slope[b][a] * positions[a].x[k];
            for (int b = 0; b < 3; b++)
                p.bend[b].x[k] += bend[b] * positions[a].x[k];
        }
    }
    p.normal = cross(p.along[1].x, p.along[0].x);
    double length = sqrt(dot(p.normal.x, p.normal.x));
    for (int k = 0; k < 3; k++)
        p.normal.x[k] /= length;
    return p;
}

/* Returns the vector from a point to a node, the shortest one. */
static struct vector from_point(const struct mesh *mesh, const double *u, size_t node,
                                const struct vector *point) {
    struct vector from = position_of(mesh, u, node);
    for (int k = 0; k < 3; k++)
        from.x[k] -= point->x[k];
    wrap(mesh, from.x);
    return from;
}

/* --- the nearest point --- */

/* Symmetric matrices of two by two: 11, 12, 22. */
static void invert(const double matrix[3], double inverse[3]) {
    double determinant = matrix[0] * matrix[2] - matrix[1] * matrix[1];
    inverse[0] = matrix[2] / determinant;
    inverse[1] = -matrix[1] / determinant;
    inverse[2] = matrix[0] / determinant;
}

static void fill_metric(const struct patch_point *p, double metric[3]) {
    metric[0] = dot(p->along[0].x, p->along[0].x);
    metric[1] = dot(p->along[0].x, p->along[1].x);
    metric[2] = dot(p->along[1].x, p->along[1].x);
}

/* Fills the step of Newton's method towards the nearest point, or that of Gauss and Newton where
 * the distance is not convex. */
static void fill_move(const struct patch_point *p, const struct vector *from, double move[2]) {
    double metric[3], convex[3], inverse[3];
    double slope[2] = {dot(p->along[0].x, from->x), dot(p->along[1].x, from->x)};
    fill_metric(p, metric);
    for (int b = 0; b < 3; b++)
        convex[b] = metric[b] - dot(p->bend[b].x, from->x);
    double usual = metric[0] * metric[2] - metric[1] * metric[1];
    bool is_convex = convex[0] > metric[0] / 8 && convex[2] > metric[2] / 8 &&
                     convex[0] * convex[2] - convex[1] * convex[1] > usual / 64;
    invert(is_convex ? convex : metric, inverse);
    move[0] = inverse[0] * slope[0] + inverse[1] * slope[1];
    move[1] = inverse[1] * slope[0] + inverse[2] * slope[1];
}

/* Takes t beyond 0 to 1 over to the next patch. Returns the steps to it. */
static size_t pass_over(double *t) {
    size_t step = *t > 1 ? 1 : *t < 0 ? SIZE_MAX : 0;
    *t += *t > 1 ? -1 : *t < 0 ? 1 : 0;
    return step;
}

void self_contact_surface_project(const struct mesh *mesh, const double *u,
                                  struct self_pair *pair) {
    const struct self_pair before = *pair;
    struct patch_point p;
    struct vector from;
    long steps[2];
    for (int step = 0; step <= SELF_PROJECTIONS; step++) {
        double move[2];
        p = point_of(mesh, u, pair->arc, pair->at, pair->across);
        from = from_point(mesh, u, pair->node, &p.at);
        fill_move(&p, &from, move);
        if (step == SELF_PROJECTIONS || fmax(fabs(move[0]), fabs(move[1])) < 1e-14)
            break;
        pair->at += fmax(-0.5, fmin(0.5, move[0]));
        pair->across += fmax(-0.5, fmin(0.5, move[1]));
        size_t along = pass_over(&pair->at), back = pass_over(&pair->across);
        pair->arc = node_at(mesh, pair->arc, along, back);
    }
    pair->gap = dot(p.normal.x, from.x);
    fill_steps(mesh, pair->node, pair->arc, steps);
    if (labs(steps[0]) < STEPS_LEAST && labs(steps[1]) < STEPS_LEAST) {
        *pair = before;
        pair->gap = SELF_REACH;
    }
}

/* --- the search --- */

int self_contact_surface_create(struct self_contact *out, struct error *err) {
    size_t face = out->mesh->face;
    out->pair = array_create(self_pairs_most(out->mesh), sizeof *out->pair);
    out->old = array_create(self_pairs_most(out->mesh), sizeof *out->old);
    out->patch = array_create(face, sizeof *out->patch);
    out->bin = array_create(face, sizeof *out->bin);
    out->next = array_create(face, sizeof *out->next);
    out->turning = array_create(3 * face, sizeof *out->turning);
    if (out->pair != NULL && out->patch != NULL && out->old != NULL && out->bin != NULL &&
        out->next != NULL && out->turning != NULL)
        return 0;
    return error_memory(err, (size_t)self_contact_surface_bytes(out->mesh),
                        "contact of a face with itself");
}

double self_contact_surface_bytes(const struct mesh *mesh) {
    size_t node = sizeof(struct tangent_patch) + 3 * sizeof(double) + 2 * sizeof(size_t);
    return (double)(mesh->face * node + self_pairs_most(mesh) * 2 * sizeof(struct self_pair));
}

double self_contact_surface_area(const struct mesh *mesh, const double *u, size_t node) {
    struct vector side[2];
    for (size_t axis = 0; axis < 2; axis++) {
        size_t along = axis == 0, back = axis == 1;
        struct vector before = position_of(mesh, u, node_at(mesh, node, -along, -back));
        side[axis] = from_point(mesh, u, node_at(mesh, node, along, back), &before);
    }
    struct vector normal = cross(side[1].x, side[0].x);
    return sqrt(dot(normal.x, normal.x)) / 4;
}

static size_t bins_of(const struct mesh *mesh, int axis) {
    size_t bins = (size_t)(size_of(mesh, axis) / SELF_BIN);
    size_t most = axis == 0 ? mesh->level[0].nx : mesh->level[0].ny;
    return bins > most ? most : bins > 0 ? bins : 1;
}

static size_t bin_of(const struct mesh *mesh, int axis, double x) {
    double bins = (double)bins_of(mesh, axis), at = floor(x * bins / size_of(mesh, axis));
    return (size_t)fmax(0, fmin(bins - 1, at - bins * floor(at / bins)));
}

/* Files the patches by the positions of their nodes, and fills their middles. */
static void prepare(struct self_contact *self, const double *u) {
    const struct mesh *mesh = self->mesh;
    for (size_t b = 0; b < bins_of(mesh, 0) * bins_of(mesh, 1); b++)
        self->bin[b] = NONE;
    for (size_t k = mesh->face; k-- > 0;) {
        struct vector at = position_of(mesh, u, k),
                      middle = point_of(mesh, u, k, SELF_MIDDLE, SELF_MIDDLE).at;
        size_t bin = bin_of(mesh, 1, at.x[1]) * bins_of(mesh, 0) + bin_of(mesh, 0, at.x[0]);
        self->next[k] = self->bin[bin];
        self->bin[bin] = k;
        memcpy(self->turning + 3 * k, middle.x, sizeof middle.x);
    }
}

/* A path over the face in nodes, from `node` on: `count` steps that make `steps` in all. */
struct path {
    size_t node;
    long steps[2], count;
};

static size_t path_node(const struct mesh *mesh, const struct path *path, long k) {
    double part = (double)k / (double)path->count;
    return node_at(mesh, path->node, (size_t)lround(part * (double)path->steps[0]),
                   (size_t)lround(part * (double)path->steps[1]));
}

/* Fills the direction of length 1 along the face and across a path, at its node k. */
static struct vector path_across(const struct mesh *mesh, const double *u, const struct path *path,
                                 long k) {
    size_t along = (size_t)lround(-(double)path->steps[1] / (double)path->count),
           back = (size_t)lround((double)path->steps[0] / (double)path->count);
    size_t node = path_node(mesh, path, k);
    struct vector before = position_of(mesh, u, node_at(mesh, node, -along, -back));
    struct vector across = from_point(mesh, u, node_at(mesh, node, along, back), &before);
    double length = sqrt(dot(across.x, across.x));
    for (int axis = 0; axis < 3; axis++)
        across.x[axis] /= length;
    return across;
}

/* Returns the angle by which the face turns into the block from the first segment of a path to its
 * last. */
static double turning_of(const struct mesh *mesh, const double *u, const struct path *path) {
    double turned = 0;
    for (long k = 1; k < path->count; k++) {
        struct vector before = position_of(mesh, u, path_node(mesh, path, k - 1)),
                      here = position_of(mesh, u, path_node(mesh, path, k));
        struct vector one = from_point(mesh, u, path_node(mesh, path, k), &before),
                      other = from_point(mesh, u, path_node(mesh, path, k + 1), &here);
        struct vector across = path_across(mesh, u, path, k), turn = cross(one.x, other.x);
        double straight = dot(one.x, other.x) - dot(one.x, across.x) * dot(other.x, across.x);
        double bend = atan2(dot(turn.x, across.x), straight);
        turned += bend < SELF_SHARPEST - 2 * M_PI ? bend + 2 * M_PI : bend;
    }
    return turned;
}

/* Returns whether a patch is across air from a node: from one to the other the face turns
 * by about half a turn into the block. */
static bool faces(const struct mesh *mesh, const double *u, size_t node, size_t patch) {
    struct path path = {.node = node};
    fill_steps(mesh, node, patch, path.steps);
    long along = labs(path.steps[0]), back = labs(path.steps[1]);
    path.count = along > back ? along : back;
    if (path.count < STEPS_LEAST)
        return false;
    double turned = turning_of(mesh, u, &path);
    return turned > M_PI / 2 && turned < 3 * M_PI / 2;
}

/* Looks for a patch nearer than *least to a node in a bin. */
static void look_into(const struct self_contact *self, const double *u, size_t bin, size_t node,
                      double *least, size_t *nearest) {
    for (size_t k = self->bin[bin]; k != NONE; k = self->next[k]) {
        struct vector middle;
        memcpy(middle.x, self->turning + 3 * k, sizeof middle.x);
        struct vector from = from_point(self->mesh, u, node, &middle);
        double distance = dot(from.x, from.x);
        if (!(distance < *least) || !faces(self->mesh, u, node, k))
            continue;
        *least = distance;
        *nearest = k;
    }
}

/* Fills the pair of a node with the nearest patch across air. Returns whether there is one within
 * SELF_REACH. */
static bool find(const struct self_contact *self, const double *u, size_t node,
                 struct self_pair *out) {
    const struct mesh *mesh = self->mesh;
    struct vector at = position_of(mesh, u, node);
    size_t bins[2], here[2], around[2], nearest = NONE;
    double least = SELF_NEAR * SELF_NEAR;
    for (int axis = 0; axis < 2; axis++) {
        bins[axis] = bins_of(mesh, axis);
        here[axis] = bin_of(mesh, axis, at.x[axis]);
        around[axis] = bins[axis] < 3 ? bins[axis] : 3;
    }
    for (size_t k = 0; k < around[0] * around[1]; k++) {
        size_t i = (here[0] + bins[0] - 1 + k % around[0]) % bins[0],
               j = (here[1] + bins[1] - 1 + k / around[0]) % bins[1];
        look_into(self, u, j * bins[0] + i, node, &least, &nearest);
    }
    if (nearest == NONE)
        return false;
    *out =
        (struct self_pair){.node = node, .arc = nearest, .at = SELF_MIDDLE, .across = SELF_MIDDLE};
    self_contact_surface_project(mesh, u, out);
    if (!(fabs(out->gap) < SELF_REACH) || !faces(mesh, u, node, out->arc))
        return false;
    struct vector there = point_of(mesh, u, out->arc, out->at, out->across).normal;
    return dot(there.x, point_of(mesh, u, node, SELF_MIDDLE, SELF_MIDDLE).normal.x) < OPPOSED;
}

void self_contact_surface_coordinates(const struct mesh *mesh, const struct self_pair *pair,
                                      double at[SIDEWAYS]) {
    size_t row = pair->arc / row_of(mesh), column = pair->arc % row_of(mesh);
    at[0] = (double)column + pair->at;
    at[1] = (double)row + pair->across;
}

/* Fills how far a pair is from a point of the face, in patches, across the sides of the cell
 * where that is shorter. */
static void fill_since(const struct mesh *mesh, const struct self_pair *pair,
                       const double from[SIDEWAYS], double since[SIDEWAYS]) {
    const double size[SIDEWAYS] = {(double)mesh->level[0].nx, (double)mesh->level[0].ny};
    self_contact_surface_coordinates(mesh, pair, since);
    for (size_t a = 0; a < SIDEWAYS; a++) {
        since[a] -= from[a];
        since[a] -= size[a] * round(since[a] / size[a]);
    }
}

/* A pair goes on with what that had which its node had; friction does on the same fold alone. A
 * pair without friction has not slid. */
static void inherit(const struct self_contact *self, struct self_pair *pair,
                    const struct self_pair *old) {
    const struct mesh *mesh = self->mesh;
    double before[SIDEWAYS], since[SIDEWAYS];
    self_contact_surface_coordinates(mesh, pair, pair->start);
    if (old == NULL)
        return;
    pair->multiplier = old->multiplier;
    if (self->friction == 0)
        return;
    self_contact_surface_coordinates(mesh, old, before);
    fill_since(mesh, pair, before, since);
    if (fmax(fabs(since[0]), fabs(since[1])) > SELF_SAME)
        return;
    memcpy(pair->start, old->start, sizeof pair->start);
    memcpy(pair->shear_multiplier, old->shear_multiplier, sizeof pair->shear_multiplier);
    memcpy(pair->shear_before, old->shear_before, sizeof pair->shear_before);
}

void self_contact_surface_search(struct self_contact *self, const double *u) {
    size_t before = self->count, old = 0;
    self->count = 0;
    if (!face_folds(self->mesh, u))
        return;
    memcpy(self->old, self->pair, before * sizeof *self->pair);
    prepare(self, u);
    for (size_t node = 0; node < self->mesh->face; node++) {
        struct self_pair *pair = &self->pair[self->count];
        while (old < before && self->old[old].node < node)
            old++;
        if (!find(self, u, node, pair))
            continue;
        inherit(self, pair, old < before && self->old[old].node == node ? &self->old[old] : NULL);
        self->count++;
    }
}

double self_contact_surface_depth(struct self_contact *self, const double *u) {
    struct self_pair pair;
    double deepest = 0;
    if (!face_folds(self->mesh, u))
        return 0;
    prepare(self, u);
    for (size_t node = 0; node < self->mesh->face; node++)
        if (find(self, u, node, &pair))
            deepest = fmax(deepest, -pair.gap);
    return deepest;
}

/* --- forces --- */

enum { BY = 0, ALONG = 1, TURN = 3 };

/* Fills the derivative N of the gap, A_a = as N along dc/da, B_a = n . d(dc/da) by the
 * displacements, a = s, t. */
static void fill_vectors(const struct patch_point *p, size_t node, struct tangent_patch *out) {
    out->node[0] = node;
    memcpy(out->node + 1, p->node, sizeof p->node);
    for (size_t a = 0; a <= PATCH_NODES; a++)
        for (size_t k = 0; k < 3; k++) {
            double weight = a == 0 ? 1 : -p->shape[a - 1];
            out->vector[BY][3 * a + k] = weight * p->normal.x[k];
            for (size_t b = 0; b < 2; b++) {
                out->vector[ALONG + b][3 * a + k] = weight * p->along[b].x[k];
                out->vector[TURN + b][3 * a + k] = a == 0 ? 0 : p->slope[b][a - 1] * p->normal.x[k];
            }
        }
}

/* With the metric G, the bends k = n . c_ab and M = G - g k, the second derivative of the gap is
 * -(A M^-1 B + B M^-1 A + A M^-1 k G^-1 A + g B M^-1 B). */
static void fill_matrix(const struct patch_point *p, double gap, double force,
                        double matrix[PATCH_VECTORS][PATCH_VECTORS]) {
    double metric[3], bend[3], full[3], inverse[3], inverse_metric[3], left[2][2];
    fill_metric(p, metric);
    for (int b = 0; b < 3; b++) {
        bend[b] = dot(p->normal.x, p->bend[b].x);
        full[b] = metric[b] - gap * bend[b];
    }
    invert(full, inverse);
    invert(metric, inverse_metric);
    for (int a = 0; a < 2; a++)
        for (int b = 0; b < 2; b++)
            left[a][b] = inverse[a] * bend[b] + inverse[a + 1] * bend[b + 1];
    for (int a = 0; a < 2; a++)
        for (int b = 0; b < 2; b++) {
            matrix[ALONG + a][TURN + b] = matrix[TURN + a][ALONG + b] = force * inverse[a + b];
            matrix[TURN + a][TURN + b] = force * gap * inverse[a + b];
            matrix[ALONG + a][ALONG + b] =
                force * (left[a][0] * inverse_metric[b] + left[a][1] * inverse_metric[b + 1]);
        }
}

void self_contact_surface_add(const struct mesh *mesh, const double *u, double penalty, bool convex,
                              const struct self_pair *pair, double *force,
                              struct tangent_patch *patch) {
    struct patch_point p = point_of(mesh, u, pair->arc, pair->at, pair->across);
    fill_vectors(&p, pair->node, patch);
    memset(patch->matrix, 0, sizeof patch->matrix);
    patch->matrix[BY][BY] = penalty;
    if (!convex)
        fill_matrix(&p, pair->gap, pair->force, patch->matrix);
    for (size_t a = 0; a <= PATCH_NODES; a++)
        for (size_t k = 0; k < 3; k++)
            force[3 * patch->node[a] + k] -= pair->force * patch->vector[BY][3 * a + k];
}

/* --- friction --- */

/* The axes of friction at a point. */
static void fill_axes(const struct patch_point *p, struct vector axes[SIDEWAYS]) {
    double length = sqrt(dot(p->along[0].x, p->along[0].x));
    for (int k = 0; k < 3; k++)
        axes[0].x[k] = p->along[0].x[k] / length;
    axes[1] = cross(p->normal.x, axes[0].x);
}

/* What a pair slid since it started, in patches and as a vector. */
struct slide {
    double since[SIDEWAYS];
    struct vector by;
};

static struct slide slide_of(const struct mesh *mesh, const struct self_pair *pair,
                             const struct patch_point *p) {
    struct slide slide;
    fill_since(mesh, pair, pair->start, slide.since);
    for (int k = 0; k < 3; k++)
        slide.by.x[k] = slide.since[0] * p->along[0].x[k] + slide.since[1] * p->along[1].x[k];
    return slide;
}

/* Fills the force along the axes that a pair would have if it stuck, and returns its size. */
static double try_force(const struct self_pair *pair, double penalty, double trial[SIDEWAYS]) {
    for (size_t a = 0; a < SIDEWAYS; a++)
        trial[a] = pair->shear_multiplier[a] - penalty * pair->slip[a];
    return hypot(trial[0], trial[1]);
}

void self_contact_surface_slide(const struct mesh *mesh, const double *u, double penalty,
                                double friction, struct self_pair *pair) {
    struct patch_point p = point_of(mesh, u, pair->arc, pair->at, pair->across);
    struct slide slide = slide_of(mesh, pair, &p);
    struct vector axes[SIDEWAYS];
    double trial[SIDEWAYS], bound = friction * pair->force;
    fill_axes(&p, axes);
    for (size_t a = 0; a < SIDEWAYS; a++)
        pair->slip[a] = dot(axes[a].x, slide.by.x);
    double size = try_force(pair, penalty, trial);
    for (size_t a = 0; a < SIDEWAYS; a++)
        pair->shear[a] = size > bound ? bound * trial[a] / size : trial[a];
}

/* How a point changes with one value of tangent_friction: s and t, the two tangents, the normal,
 * the axes and the slide. */
struct point_change {
    double moves[SIDEWAYS];
    struct vector along[SIDEWAYS], normal, axes[SIDEWAYS], slid;
};

/* What the changes of a point are made of. M is G - g k (fill_matrix). */
struct point_terms {
    const struct patch_point *point;
    struct vector axes[SIDEWAYS];
    struct slide slide;
    double gap, metric[3], inverse[3]; /* inverses of G and of M */
};

static struct point_terms terms_of(const struct mesh *mesh, const struct self_pair *pair,
                                   const struct patch_point *p) {
    struct point_terms terms = {.point = p, .slide = slide_of(mesh, pair, p), .gap = pair->gap};
    double metric[3], full[3];
    fill_axes(p, terms.axes);
    fill_metric(p, metric);
    for (int b = 0; b < 3; b++)
        full[b] = metric[b] - pair->gap * dot(p->normal.x, p->bend[b].x);
    invert(metric, terms.metric);
    invert(full, terms.inverse);
    return terms;
}

/* Fills how s and t and the tangents change with a value: component k of the move of the node over
 * the point (vector 0) or of the change of a tangent (1, 2). */
static void change_tangents(const struct point_terms *terms, size_t vector, size_t k,
                            struct point_change *out) {
    const struct patch_point *p = terms->point;
    double pull[SIDEWAYS];
    for (size_t a = 0; a < SIDEWAYS; a++)
        pull[a] = vector == 0       ? p->along[a].x[k]
                  : vector == a + 1 ? terms->gap * p->normal.x[k]
                                    : 0;
    for (size_t a = 0; a < SIDEWAYS; a++)
        out->moves[a] = terms->inverse[a] * pull[0] + terms->inverse[a + 1] * pull[1];
    for (size_t a = 0; a < SIDEWAYS; a++)
        for (size_t i = 0; i < 3; i++)
            out->along[a].x[i] = (vector == a + 1 && i == k ? 1 : 0) +
                                 p->bend[a].x[i] * out->moves[0] +
                                 p->bend[a + 1].x[i] * out->moves[1];
}

static struct point_change change_of(const struct point_terms *terms, size_t vector, size_t k) {
    const struct patch_point *p = terms->point;
    const struct vector *axis = &terms->axes[0];
    struct point_change c = {.moves = {0}};
    double turn[SIDEWAYS], length = sqrt(dot(p->along[0].x, p->along[0].x));
    change_tangents(terms, vector, k, &c);
    for (size_t a = 0; a < SIDEWAYS; a++)
        turn[a] = dot(p->normal.x, c.along[a].x);
    double stretch = dot(axis->x, c.along[0].x);
    for (size_t i = 0; i < 3; i++) {
        for (size_t a = 0; a < SIDEWAYS; a++) {
            c.normal.x[i] -=
                p->along[a].x[i] * (terms->metric[a] * turn[0] + terms->metric[a + 1] * turn[1]);
            c.slid.x[i] += terms->slide.since[a] * c.along[a].x[i] + p->along[a].x[i] * c.moves[a];
        }
        c.axes[0].x[i] = (c.along[0].x[i] - axis->x[i] * stretch) / length;
    }
    struct vector tilted = cross(c.normal.x, axis->x), turned = cross(p->normal.x, c.axes[0].x);
    for (size_t i = 0; i < 3; i++)
        c.axes[1].x[i] = tilted.x[i] + turned.x[i];
    return c;
}

/* Returns the change of the force along the face. gap: that of the gap. */
static struct vector change_force(const struct point_terms *terms, const struct self_pair *pair,
                                  double penalty, double friction, double gap,
                                  const struct point_change *c) {
    double trial[SIDEWAYS], change[SIDEWAYS], along = 0, bound = friction * pair->force;
    double size = try_force(pair, penalty, trial);
    struct vector out = {{0}};
    for (size_t a = 0; a < SIDEWAYS; a++) {
        change[a] =
            -penalty * (dot(c->axes[a].x, terms->slide.by.x) + dot(terms->axes[a].x, c->slid.x));
        along += size > bound ? trial[a] / size * change[a] : 0;
    }
    for (size_t a = 0; a < SIDEWAYS; a++) {
        double unit = size > bound ? trial[a] / size : 0;
        if (size > bound)
            change[a] = bound / size * (change[a] - unit * along) - friction * penalty * gap * unit;
        for (size_t i = 0; i < 3; i++)
            out.x[i] += change[a] * terms->axes[a].x[i] + pair->shear[a] * c->axes[a].x[i];
    }
    return out;
}

void self_contact_surface_add_friction(const struct mesh *mesh, const double *u, double penalty,
                                       double friction, const struct self_pair *pair, double *force,
                                       struct tangent_friction *rubbing) {
    struct patch_point p = point_of(mesh, u, pair->arc, pair->at, pair->across);
    struct point_terms terms = terms_of(mesh, pair, &p);
    struct vector borne;
    rubbing->node[0] = pair->node;
    memcpy(rubbing->node + 1, p.node, sizeof p.node);
    for (size_t i = 0; i < 3; i++)
        borne.x[i] = pair->shear[0] * terms.axes[0].x[i] + pair->shear[1] * terms.axes[1].x[i];
    for (size_t a = 0; a <= PATCH_NODES; a++) {
        rubbing->weight[0][a] = a == 0 ? 1 : -p.shape[a - 1];
        for (size_t b = 0; b < SIDEWAYS; b++)
            rubbing->weight[b + 1][a] = a == 0 ? 0 : p.slope[b][a - 1];
        for (size_t i = 0; i < 3; i++)
            force[3 * rubbing->node[a] + i] -= rubbing->weight[0][a] * borne.x[i];
    }
    for (size_t v = 0; v < FRICTION_VALUES; v++) {
        struct point_change c = change_of(&terms, v / 3, v % 3);
        struct vector change =
            change_force(&terms, pair, penalty, friction, v < 3 ? p.normal.x[v] : 0, &c);
        for (size_t i = 0; i < 3; i++) {
            rubbing->matrix[i][v] = -change.x[i];
            for (size_t b = 0; b < SIDEWAYS; b++)
                rubbing->matrix[3 * (b + 1) + i][v] = borne.x[i] * c.moves[b];
        }
    }
}
