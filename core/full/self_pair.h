/* The pairs of a face that meets itself, as contact of profiles (self_contact.h) and of surfaces
 * (self_contact_surface.h) keep them. Private to core/full. */
#ifndef RUGO_CORE_FULL_SELF_PAIR_H
#define RUGO_CORE_FULL_SELF_PAIR_H

#include "core/full/tangent.h"

/* SIDEWAYS: directions along a face, of which profiles have the first alone. */
enum { ARC_NODES = 3, SIDEWAYS = 2 };

/* Of the search, in columns: distance within which a node and an arc or a patch are a pair;
 * distance to its middle; and width of a bin. Neighbours within reach are in the same bin or beside
 * it, as arcs are filed by their node and shorter along an axis than a bin less the reach. */
#define SELF_REACH 1.0
#define SELF_NEAR 3.0
#define SELF_BIN 4.0
/* Bends of the face at a node lie in one turn: sharper than this into the block, they count as out
 * of it. */
#define SELF_SHARPEST (1.1 * M_PI)
/* Arcs or patches along an axis within which a pair is on the same fold as before. */
#define SELF_SAME 3.0
/* The middle of an arc or a patch. */
#define SELF_MIDDLE 0.5
/* Steps of Newton's method towards the nearest point. */
enum { SELF_PROJECTIONS = 20 };

/* What a pair is: a node of the left or the right flank and an arc of the other one, or two lips
 * on the flat. */
enum self_kind { SELF_LEFT, SELF_RIGHT, SELF_LIPS, SELF_KINDS };
/* Returns the pairs of a face at most: of a profile's node one of each kind, of a surface's one. */
static inline size_t self_pairs_most(const struct mesh *mesh) {
    return (mesh->dimension == 2 ? SELF_KINDS : 1) * mesh->face;
}
struct self_pair {
    size_t node, arc; /* of the face: the node, and that around which the arc is */
    enum self_kind kind;
    double across;     /* of surfaces: t along y, as at along x (self_contact_surface.h) */
    double at;         /* t, as all below at the displacements last evaluated */
    double normal[2];  /* n */
    double along[2];   /* c'(t) */
    double bend;       /* n . c''(t) */
    double multiplier; /* q */
    double gap, force;
    /* With friction: where on the curve it was at self_contact_settle, in arcs, and what it slid
     * along since then; the force on the node along c', its multiplier, and that force then. Of
     * surfaces s and t, and what is along the two axes of self_contact_surface.h. */
    double start[SIDEWAYS], slip[SIDEWAYS];
    double shear[SIDEWAYS], shear_multiplier[SIDEWAYS], shear_before[SIDEWAYS];
};

struct self_contact {
    const struct mesh *mesh; /* borrowed */
    double friction;         /* coefficient; 0 where created */
    size_t count;
    struct self_pair *pair; /* owned, as all below: by kind, and of each kind at most one a node, in
                             * their order */
    struct self_pair *old;  /* scratch of the search */
    struct tangent_link *link;        /* of pairs with a force */
    struct tangent_patch *patch;      /* in their stead, of surfaces */
    struct tangent_friction *rubbing; /* of their friction; NULL without */
    size_t *bin, *next;               /* of the search: arcs by their position along x */
    double *turning;                  /* angle of a segment over that of the first, twice around; of
                                       * surfaces the middles of patches */
};

#endif
