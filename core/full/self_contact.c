#include "core/full/self_contact.h"
#include "core/full/face.h"
#include "core/full/self_contact_surface.h"
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* E*: ten times the stiffness of a node of the face. Multipliers then take some ten rounds, but
 * pairs seldom alternate between touching and not; with 100 E* three times as many iterations of
 * Newton's were taken. */
static const double STIFFNESS = 10;
static const size_t NONE = SIZE_MAX;

int self_contact_create(struct self_contact *out, const struct mesh *mesh, struct error *err) {
    size_t face = mesh->face;
    *out = (struct self_contact){.mesh = mesh};
    if (mesh->dimension == 3) {
        int status = self_contact_surface_create(out, err);
        if (status != 0)
            self_contact_clear(out);
        return status;
    }
    out->pair = array_create(self_pairs_most(mesh), sizeof *out->pair);
    out->old = array_create(self_pairs_most(mesh), sizeof *out->old);
    out->link = array_create(self_pairs_most(mesh), sizeof *out->link);
    out->bin = array_create(face, sizeof *out->bin);
    out->next = array_create(face, sizeof *out->next);
    out->turning = array_create(2 * face, sizeof *out->turning);
    if (out->pair != NULL && out->link != NULL && out->old != NULL && out->bin != NULL &&
        out->next != NULL && out->turning != NULL)
        return 0;
    self_contact_clear(out);
    return error_memory(err, (size_t)self_contact_bytes(mesh), "contact of a face with itself");
}

void self_contact_clear(struct self_contact *self) {
    free(self->pair);
    free(self->link);
    free(self->patch);
    free(self->rubbing);
    free(self->old);
    free(self->bin);
    free(self->next);
    free(self->turning);
    *self = (struct self_contact){0};
}

int self_contact_add_friction(struct self_contact *self, double friction, struct error *err) {
    size_t face = self->mesh->face;
    self->friction = friction;
    if (self->mesh->dimension == 2 || self->rubbing != NULL)
        return 0;
    self->rubbing = array_create(face, sizeof *self->rubbing);
    return self->rubbing != NULL
               ? 0
               : error_memory(err, face * sizeof *self->rubbing, "friction of a face with itself");
}

double self_contact_bytes(const struct mesh *mesh) {
    size_t pair = 2 * sizeof(struct self_pair) + sizeof(struct tangent_link);
    size_t node = 2 * sizeof(double) + 2 * sizeof(size_t);
    return mesh->dimension == 2 ? (double)(mesh->face * node + self_pairs_most(mesh) * pair)
                                : self_contact_surface_bytes(mesh);
}

/* --- the curve --- */

struct point {
    double x, y;
};

/* Position of a node, whose number may go beyond the last. */
static struct point point_of(const struct mesh *mesh, const double *u, size_t number) {
    size_t node = number % mesh->face;
    return (struct point){(double)number + u[2 * node], mesh->height[node] + u[2 * node + 1]};
}

/* The arc around a node: its shape functions and their derivatives, and what they make of the
 * nodes. */
struct arc {
    double shape[ARC_NODES], slope[ARC_NODES];
    struct point at, along, bend;
};

static struct arc arc_of(const struct mesh *mesh, const double *u, size_t number, double t) {
    struct arc arc = {.shape = {(1 - t) * (1 - t) / 2, 0.5 + t * (1 - t), t * t / 2},
                      .slope = {t - 1, 1 - 2 * t, t}};
    static const double CURVE[ARC_NODES] = {1, -2, 1};
    size_t before = number > 0 ? number - 1 : mesh->face - 1;
    for (size_t i = 0; i < ARC_NODES; i++) {
        struct point p = point_of(mesh, u, i == 0 ? before : number + i - 1);
        p.x -= i == 0 && number == 0 ? (double)mesh->face : 0;
        arc.at.x += arc.shape[i] * p.x;
        arc.at.y += arc.shape[i] * p.y;
        arc.along.x += arc.slope[i] * p.x;
        arc.along.y += arc.slope[i] * p.y;
        arc.bend.x += CURVE[i] * p.x;
        arc.bend.y += CURVE[i] * p.y;
    }
    return arc;
}

static double dot(struct point a, struct point b) {
    return a.x * b.x + a.y * b.y;
}

/* Returns the vector from a point of an arc to a node, across the side of the cell where that is
 * nearer. */
static struct point from_arc(const struct mesh *mesh, const double *u, size_t node,
                             const struct arc *arc) {
    struct point p = point_of(mesh, u, node);
    double x = p.x - arc->at.x;
    return (struct point){x - (double)mesh->face * round(x / (double)mesh->face), p.y - arc->at.y};
}

/* The distance of two lips along the flat. */
static void measure_lips(const struct mesh *mesh, const double *u, struct self_pair *pair) {
    double x = point_of(mesh, u, pair->arc).x - point_of(mesh, u, pair->node).x;
    pair->gap = x - (double)mesh->face * round(x / (double)mesh->face);
    pair->normal[0] = -1;
    pair->normal[1] = 0;
}

/* Fills a pair from its node, arc and t. */
static void measure_pair(const struct mesh *mesh, const double *u, struct self_pair *pair) {
    struct arc arc = arc_of(mesh, u, pair->arc, pair->at);
    struct point from = from_arc(mesh, u, pair->node, &arc);
    double length = hypot(arc.along.x, arc.along.y);
    pair->along[0] = arc.along.x;
    pair->along[1] = arc.along.y;
    pair->normal[0] = arc.along.y / length;
    pair->normal[1] = -arc.along.x / length;
    pair->bend = pair->normal[0] * arc.bend.x + pair->normal[1] * arc.bend.y;
    pair->gap = pair->normal[0] * from.x + pair->normal[1] * from.y;
}

/* Moves t to the point of the curve nearest to the node, over to other arcs where that is beyond an
 * end. Beyond the end of a fold that is on the node's own flank, which it does not meet: the gap is
 * infinite. */
static void project(const struct mesh *mesh, const double *u, struct self_pair *pair) {
    for (int step = 0; step < SELF_PROJECTIONS; step++) {
        struct arc arc = arc_of(mesh, u, pair->arc, pair->at);
        struct point from = from_arc(mesh, u, pair->node, &arc);
        double slope = dot(arc.along, from), curve = dot(arc.along, arc.along);
        double convex = curve - dot(arc.bend, from);
        double move = slope / (convex > curve / 8 ? convex : curve);
        pair->at += fmax(-0.5, fmin(0.5, move));
        if (pair->at < 0 || pair->at > 1) {
            size_t on = pair->at > 1 ? 1 : mesh->face - 1;
            pair->at += pair->at > 1 ? -1 : 1;
            pair->arc = (pair->arc + on) % mesh->face;
        }
        if (fabs(move) < 1e-14)
            break;
    }
    measure_pair(mesh, u, pair);
    struct point own = arc_of(mesh, u, pair->node, SELF_MIDDLE).along;
    if (pair->normal[0] * own.y - pair->normal[1] * own.x >= 0)
        pair->gap = INFINITY;
}

/* --- the search --- */

/* Fills the angles of segments, which begin at the nodes, over that of the first. */
static void measure_turning(struct self_contact *self, const double *u) {
    const struct mesh *mesh = self->mesh;
    struct point before = {0};
    for (size_t k = 0; k < 2 * mesh->face; k++) {
        struct point a = point_of(mesh, u, k), b = point_of(mesh, u, k + 1);
        struct point here = {b.x - a.x, b.y - a.y};
        double bend =
            atan2(before.x * here.y - before.y * here.x, before.x * here.x + before.y * here.y);
        bend -= bend > 2 * M_PI - SELF_SHARPEST ? 2 * M_PI : 0;
        self->turning[k] = k > 0 ? self->turning[k - 1] + bend : 0;
        before = here;
    }
}

static size_t bins_of(const struct mesh *mesh) {
    size_t bins = (size_t)((double)mesh->face / SELF_BIN);
    return bins > 0 ? bins : 1;
}

static size_t bin_of(const struct mesh *mesh, double x) {
    double bins = (double)bins_of(mesh), at = floor(x * bins / (double)mesh->face);
    return (size_t)fmax(0, fmin(bins - 1, at - bins * floor(at / bins)));
}

static void prepare(struct self_contact *self, const double *u) {
    const struct mesh *mesh = self->mesh;
    measure_turning(self, u);
    for (size_t b = 0; b < bins_of(mesh); b++)
        self->bin[b] = NONE;
    for (size_t k = mesh->face; k-- > 0;) {
        size_t bin = bin_of(mesh, point_of(mesh, u, k).x);
        self->next[k] = self->bin[bin];
        self->bin[bin] = k;
    }
}

/* Returns whether a node and another behind it are across air: from the segment behind the one to
 * that before the other the face turns by about half a turn to the right, into the block. Around a
 * crest it turns to the left. */
static bool faces(const struct self_contact *self, size_t left, size_t right) {
    size_t face = self->mesh->face, number = right > left ? right : right + face;
    if (number - left < ARC_NODES - 1 || number - left > face / 2)
        return false;
    double turned = self->turning[number - 1] - self->turning[left];
    return turned < -M_PI / 2 && turned > -3 * M_PI / 2;
}

/* Returns whether an arc is across air from a node of the flank of this kind. */
static bool is_across(const struct self_contact *self, enum self_kind kind, size_t node,
                      size_t arc) {
    return arc != node && (kind == SELF_LEFT ? faces(self, node, arc) : faces(self, arc, node));
}

/* Fills the pair of a node with the nearest arc across air. Returns whether there is one within
 * SELF_REACH. */
static bool nearest(const struct self_contact *self, const double *u, enum self_kind kind,
                    size_t node, struct self_pair *out) {
    const struct mesh *mesh = self->mesh;
    size_t bins = bins_of(mesh), at = bin_of(mesh, point_of(mesh, u, node).x);
    size_t around = bins < 3 ? bins : 3;
    double least = INFINITY;
    *out = (struct self_pair){.node = node, .kind = kind};
    for (size_t side = 0; side < around; side++)
        for (size_t k = self->bin[(at + bins - 1 + side) % bins]; k != NONE; k = self->next[k]) {
            if (!is_across(self, kind, node, k))
                continue;
            struct arc arc = arc_of(mesh, u, k, SELF_MIDDLE);
            struct point from = from_arc(mesh, u, node, &arc);
            double distance = hypot(from.x, from.y);
            if (!(distance < least))
                continue;
            least = distance;
            out->arc = k;
            out->at = SELF_MIDDLE;
        }
    if (!(least < SELF_NEAR))
        return false;
    project(mesh, u, out);
    return fabs(out->gap) < SELF_REACH && is_across(self, kind, node, out->arc);
}

static size_t node_behind(const struct mesh *mesh, size_t node) {
    return node + 1 < mesh->face ? node + 1 : 0;
}

/* Returns the first node that touches the flat behind one that does; that one where none else
 * does. *over: whether the face overhangs between both. */
static size_t next_lip(const struct mesh *mesh, const double *u, const bool *active, size_t node,
                       bool *over) {
    size_t next = node;
    *over = false;
    do {
        *over = *over || mesh_stretch(mesh, u, 0, next) <= 0;
        next = node_behind(mesh, next);
    } while (!active[next] && next != node);
    return next;
}

/* Fills the pair of a lip. Returns whether there is one within SELF_REACH. */
static bool meets_lip(const struct mesh *mesh, const double *u, const bool *active, size_t node,
                      struct self_pair *out) {
    bool over = false;
    if (!active[node] || active[node_behind(mesh, node)])
        return false;
    *out = (struct self_pair){
        .node = node, .arc = next_lip(mesh, u, active, node, &over), .kind = SELF_LIPS};
    measure_lips(mesh, u, out);
    return over && out->arc != node && fabs(out->gap) < SELF_REACH;
}

/* Finds the pair of a node with an arc, or of lips. */
static bool find(const struct self_contact *self, const double *u, const bool *active,
                 enum self_kind kind, size_t node, struct self_pair *out) {
    return kind == SELF_LIPS ? meets_lip(self->mesh, u, active, node, out)
                             : nearest(self, u, kind, node, out);
}

/* Where a pair is on the curve from a point of it, in arcs. */
static double arcs_from(const struct mesh *mesh, const struct self_pair *pair, double point) {
    double from = (double)pair->arc + pair->at - point, face = (double)mesh->face;
    return from - face * round(from / face);
}

static void fill_start(const struct mesh *mesh, struct self_pair *pair) {
    if (mesh->dimension == 3)
        self_contact_surface_coordinates(mesh, pair, pair->start);
    else
        pair->start[0] = (double)pair->arc + pair->at;
}

/* A pair goes on with the multipliers of that which its node had, and with where that was; on
 * another fold there is nothing to go on from. */
static void inherit(const struct mesh *mesh, struct self_pair *pair, const struct self_pair *old) {
    fill_start(mesh, pair);
    if (old == NULL)
        return;
    pair->multiplier = old->multiplier;
    if (fabs(arcs_from(mesh, pair, (double)old->arc + old->at)) > SELF_SAME)
        return;
    pair->start[0] = old->start[0];
    pair->shear_multiplier[0] = old->shear_multiplier[0];
    pair->shear_before[0] = old->shear_before[0];
}

/* Adds the pairs of one kind to count others, with the multipliers of the old ones, which begin at
 * *old. */
static size_t add_pairs(struct self_contact *self, const double *u, const bool *active,
                        enum self_kind kind, size_t before, size_t *old, size_t count) {
    const struct self_pair *had = self->old;
    for (size_t node = 0; node < self->mesh->face; node++) {
        while (*old < before && had[*old].kind == kind && had[*old].node < node)
            ++*old;
        if (!find(self, u, active, kind, node, &self->pair[count]))
            continue;
        bool same = *old < before && had[*old].kind == kind && had[*old].node == node;
        inherit(self->mesh, &self->pair[count++], same ? &had[*old] : NULL);
    }
    while (*old < before && had[*old].kind == kind)
        ++*old;
    return count;
}

void self_contact_search(struct self_contact *self, const double *u, const bool *active) {
    size_t before = self->count, old = 0, count = 0;
    if (self->mesh->dimension == 3) {
        self_contact_surface_search(self, u);
        return;
    }
    self->count = 0;
    if (!face_folds(self->mesh, u))
        return;
    memcpy(self->old, self->pair, before * sizeof *self->pair);
    prepare(self, u);
    for (enum self_kind kind = 0; kind < SELF_KINDS; kind++)
        count = add_pairs(self, u, active, kind, before, &old, count);
    self->count = count;
}

double self_contact_depth(struct self_contact *self, const double *u, const bool *active) {
    struct self_pair pair;
    double deepest = 0;
    if (self->mesh->dimension == 3)
        return self_contact_surface_depth(self, u);
    if (!face_folds(self->mesh, u))
        return 0;
    prepare(self, u);
    for (size_t node = 0; node < self->mesh->face; node++) {
        for (enum self_kind kind = 0; kind < SELF_KINDS; kind++)
            if (find(self, u, active, kind, node, &pair))
                deepest = fmax(deepest, -pair.gap);
    }
    return deepest;
}

/* --- forces --- */

/* As link_of, of lips. */
static struct tangent_link lips_of(const struct self_pair *pair, double by[LINK_MOST]) {
    struct tangent_link link = {.at = {2 * pair->node, 2 * pair->arc}};
    memset(by, 0, LINK_MOST * sizeof *by);
    by[0] = -1;
    by[1] = 1;
    /* The others repeat the first degree of freedom, with 0. */
    for (size_t i = 2; i < LINK_MOST; i++)
        link.at[i] = link.at[0];
    for (size_t i = 0; i < 2; i++)
        for (size_t j = 0; j < 2; j++)
            link.stiffness[i][j] = STIFFNESS * by[i] * by[j];
    return link;
}

/* Fills by, the derivative N of the gap. With A = as N along c', and B = n . dc' by the
 * displacements, the second derivative is -(A B^T + B A^T + (n . c''/|c'|^2) A A^T + g B B^T)/m, m
 * = |c'|^2 - g n . c''. */
static struct tangent_link link_of(const struct mesh *mesh, const double *u,
                                   const struct self_pair *pair, bool convex,
                                   double by[LINK_MOST]) {
    struct tangent_link link;
    struct arc arc = arc_of(mesh, u, pair->arc, pair->at);
    double along[LINK_MOST], turn[LINK_MOST], square = dot(arc.along, arc.along);
    double bends = convex ? 0 : pair->force / (square - pair->gap * pair->bend);
    for (size_t a = 0; a <= ARC_NODES; a++)
        for (size_t k = 0; k < 2; k++) {
            size_t node = a == 0 ? pair->node : (pair->arc + mesh->face + a - 2) % mesh->face;
            double weight = a == 0 ? 1 : -arc.shape[a - 1];
            link.at[2 * a + k] = 2 * node + k;
            by[2 * a + k] = weight * pair->normal[k];
            along[2 * a + k] = weight * pair->along[k];
            turn[2 * a + k] = a == 0 ? 0 : arc.slope[a - 1] * pair->normal[k];
        }
    for (size_t i = 0; i < LINK_MOST; i++)
        for (size_t j = 0; j < LINK_MOST; j++)
            link.stiffness[i][j] =
                STIFFNESS * by[i] * by[j] +
                bends * (along[i] * turn[j] + turn[i] * along[j] +
                         pair->bend / square * along[i] * along[j] + pair->gap * turn[i] * turn[j]);
    return link;
}

/* Fills what a pair slides and the force along it, within friction of that across. */
static void measure_shear(const struct self_contact *self, const double *u,
                          struct self_pair *pair) {
    if (self->mesh->dimension == 3) {
        if (self->friction > 0)
            self_contact_surface_slide(self->mesh, u, STIFFNESS, self->friction, pair);
        return;
    }
    bool slides = self->friction > 0 && pair->kind != SELF_LIPS;
    double bound = self->friction * pair->force;
    double size = hypot(pair->along[0], pair->along[1]);
    pair->slip[0] = slides ? arcs_from(self->mesh, pair, pair->start[0]) * size : 0;
    pair->shear[0] =
        slides ? fmax(-bound, fmin(bound, pair->shear_multiplier[0] - STIFFNESS * pair->slip[0]))
               : 0;
}

/* Fills along, the derivative of the force along the arc over that force, and adds its stiffness.
 * With A, B and m of link_of, weights W of the points, and t = c'/|c'|: t advances by dt = (A + g
 * B)/m, the slip by |c'| dt and its share of d|c'|, and t turns by (B + n . c'' dt)/|c'|. */
static void add_shear(const struct self_contact *self, const double *u,
                      const struct self_pair *pair, const double by[LINK_MOST],
                      double along[LINK_MOST], struct tangent_link *link) {
    struct arc arc = arc_of(self->mesh, u, pair->arc, pair->at);
    const double size = hypot(arc.along.x, arc.along.y);
    const double unit[2] = {arc.along.x / size, arc.along.y / size};
    const double since = pair->slip[0] / size, bends = unit[0] * arc.bend.x + unit[1] * arc.bend.y;
    const double bound = self->friction * pair->force;
    const bool sticks = fabs(pair->shear_multiplier[0] - STIFFNESS * pair->slip[0]) <= bound;
    double advance[LINK_MOST], grow[LINK_MOST], turn[LINK_MOST], weight[LINK_MOST];
    double change[LINK_MOST];
    for (size_t i = 0; i < LINK_MOST; i++) {
        size_t a = i / 2, k = i % 2;
        double slope = a == 0 ? 0 : arc.slope[a - 1], across = slope * pair->normal[k];
        weight[i] = a == 0 ? 1 : -arc.shape[a - 1];
        along[i] = weight[i] * unit[k];
        advance[i] =
            (along[i] * size + pair->gap * across) / (size * size - pair->gap * pair->bend);
        grow[i] = slope * unit[k] + bends * advance[i];
        turn[i] = (across + pair->bend * advance[i]) / size;
        change[i] = -STIFFNESS * (sticks ? size * advance[i] + since * grow[i]
                                         : copysign(self->friction, pair->shear[0]) * by[i]);
    }
    for (size_t i = 0; i < LINK_MOST; i++)
        for (size_t j = 0; j < LINK_MOST; j++) {
            size_t a = i / 2, k = i % 2;
            double moves = a == 0 ? 0 : -arc.slope[a - 1] * unit[k] * advance[j];
            moves += weight[i] * pair->normal[k] * turn[j];
            link->stiffness[i][j] -= along[i] * change[j] + pair->shear[0] * moves;
        }
}

/* As self_contact_evaluate, of surfaces. */
static void evaluate_surface(struct self_contact *self, bool convex, const double *u, double *force,
                             struct tangent *tangent) {
    tangent->patch = self->patch;
    tangent->rubbing = self->rubbing;
    tangent->patches = tangent->rubbings = 0;
    for (size_t c = 0; c < self->count; c++) {
        struct self_pair *pair = &self->pair[c];
        self_contact_surface_project(self->mesh, u, pair);
        pair->force = fmax(0, pair->multiplier - STIFFNESS * pair->gap);
        measure_shear(self, u, pair);
        if (pair->force == 0)
            continue;
        self_contact_surface_add(self->mesh, u, STIFFNESS, convex, pair, force,
                                 &self->patch[tangent->patches++]);
        if (self->friction > 0)
            self_contact_surface_add_friction(self->mesh, u, STIFFNESS, self->friction, pair, force,
                                              &self->rubbing[tangent->rubbings++]);
    }
}

void self_contact_evaluate(struct self_contact *self, bool convex, const double *u, double *force,
                           struct tangent *tangent) {
    size_t links = 0;
    double by[LINK_MOST], along[LINK_MOST] = {0};
    if (self->mesh->dimension == 3) {
        evaluate_surface(self, convex, u, force, tangent);
        return;
    }
    for (size_t c = 0; c < self->count; c++) {
        struct self_pair *pair = &self->pair[c];
        if (pair->kind == SELF_LIPS)
            measure_lips(self->mesh, u, pair);
        else
            project(self->mesh, u, pair);
        pair->force = fmax(0, pair->multiplier - STIFFNESS * pair->gap);
        measure_shear(self, u, pair);
        if (pair->force == 0)
            continue;
        struct tangent_link *link = &self->link[links++];
        *link =
            pair->kind == SELF_LIPS ? lips_of(pair, by) : link_of(self->mesh, u, pair, convex, by);
        if (self->friction > 0 && pair->kind != SELF_LIPS)
            add_shear(self, u, pair, by, along, link);
        for (int i = 0; i < LINK_MOST; i++)
            force[link->at[i]] -= pair->force * by[i] + pair->shear[0] * along[i];
    }
    tangent->link = self->link;
    tangent->links = links;
}

double self_contact_renew(struct self_contact *self, const double *u, const bool *active) {
    double change = 0;
    for (size_t c = 0; c < self->count; c++) {
        self->pair[c].multiplier = self->pair[c].force;
        memcpy(self->pair[c].shear_multiplier, self->pair[c].shear, sizeof self->pair[c].shear);
    }
    self_contact_search(self, u, active);
    for (size_t c = 0; c < self->count; c++) {
        struct self_pair *pair = &self->pair[c];
        const double *shear = pair->shear_multiplier;
        double force = pair->multiplier;
        pair->force = fmax(0, force - STIFFNESS * pair->gap);
        measure_shear(self, u, pair);
        change = fmax(change, fmax(fabs(pair->force - force),
                                   hypot(pair->shear[0] - shear[0], pair->shear[1] - shear[1])));
    }
    return change;
}

/* Change of forces over the largest contact force below which they have settled, and rounds until
 * then. */
static const double SETTLED = 1e-7;
enum { ROUNDS_MOST = 60 };

int self_contact_round(struct self_contact *self, const double *u, const bool *active,
                       double tolerance, double largest, struct self_rounds *rounds, bool *met,
                       struct error *err) {
    size_t before = self->count;
    double left = self_contact_renew(self, u, active);
    rounds->settled = left <= fmax(SETTLED, tolerance) * largest;
    *met = before > 0 || self->count > 0;
    if (!*met || ++rounds->count <= ROUNDS_MOST)
        return 0;
    return error_set(err, ERROR_NUMERIC,
                     "contact of the face with itself does not settle: after %d rounds its "
                     "forces change by %.2g of the largest force",
                     ROUNDS_MOST, left / largest);
}

void self_contact_settle(struct self_contact *self) {
    for (size_t c = 0; c < self->count; c++) {
        struct self_pair *pair = &self->pair[c];
        fill_start(self->mesh, pair);
        memset(pair->slip, 0, sizeof pair->slip);
        memcpy(pair->shear_before, pair->shear, sizeof pair->shear);
    }
}

double self_contact_dissipation(const struct self_contact *self) {
    double sum = 0;
    for (size_t c = 0; c < self->count; c++) {
        const struct self_pair *pair = &self->pair[c];
        for (size_t k = 0; k < SIDEWAYS; k++)
            sum -= (pair->shear[k] + pair->shear_before[k]) / 2 * pair->slip[k];
    }
    return sum;
}

struct self_measure self_contact_measure(struct self_contact *self, const double *u,
                                         const bool *active) {
    const struct mesh *mesh = self->mesh;
    struct self_measure out = {.penetration =
                                   self->count > 0 ? self_contact_depth(self, u, active) : 0};
    for (size_t c = 0; c < self->count; c++) {
        const struct self_pair *pair = &self->pair[c];
        if (!(pair->force > 0))
            continue;
        out.force += pair->force;
        out.nodes++;
        if (mesh->dimension == 3) {
            out.length += self_contact_surface_area(mesh, u, pair->node);
            continue;
        }
        struct point before = point_of(mesh, u, pair->node + mesh->face - 1),
                     here = point_of(mesh, u, pair->node + mesh->face),
                     after = point_of(mesh, u, pair->node + mesh->face + 1);
        out.length += (hypot(here.x - before.x, here.y - before.y) +
                       hypot(after.x - here.x, after.y - here.y)) /
                      2;
    }
    return out;
}
