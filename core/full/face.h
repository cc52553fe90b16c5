/* Areas and volumes of the face under load: its cells as displaced, projected on the flat or
 * with their slopes. Projected cells tile the periodic cell, whose area stays. Private to
 * core/full.
 *
 * u: displacements (mesh_degrees_of_freedom values, or more); lengths are in the mesh's unit. */
#ifndef RUGO_CORE_FULL_FACE_H
#define RUGO_CORE_FULL_FACE_H

#include "core/full/mesh.h"

/* Returns the mean relative area of the cells around the nodes in contact (active: by node of the
 * face); NaN where there are none. */
double face_contact_stretch(const struct mesh *mesh, const double *u, const bool *active);

/* Returns the same of the nodes out of contact, where that of so many nodes in contact is
 * `stretch`; 1 where there are none of either. The cells tile the periodic cell, whose area stays.
 */
double face_open_stretch(const struct mesh *mesh, size_t nodes, double stretch);

/* Returns whether a cell of the face is turned away from the flat. The contact condition compares
 * heights alone, so that the face could pass through itself there. */
bool face_folds(const struct mesh *mesh, const double *u);
/* Returns the largest change of the relative area of a cell between two states. */
double face_stretch_change(const struct mesh *mesh, const double *u, const double *before);
/* Returns the largest change of a displacement of the face along an axis; of those along the face,
 * over the mean. */
double face_largest_move(const struct mesh *mesh, const double *change);
/* The largest such change that a step may make: beyond it the face may have folded on its course.
 */
#define FACE_CHANGE_MOST 0.25

/* Returns the volume between the face and the flat over the area of the periodic cell, which is
 * exact for gaps that are bilinear between nodes. gap: by node of the face. u may be NULL: the
 * cells are undeformed. */
double face_mean_gap(const struct mesh *mesh, const double *u, const double *gap);
/* Returns the change of the mean gap, to first order, when the displacements change by `change` and
 * the flat stays; with u = NULL the cells stay too. */
double face_mean_gap_change(const struct mesh *mesh, const double *u, const double *gap,
                            const double *change);

/* Areas of the face as it stands under load, with its slopes, over the same projected on the flat,
 * less 1: 0 where it is flat. */
struct face_tilt {
    double face;    /* of all cells */
    double contact; /* of the nodes in contact, by the integrals of their shape functions over it;
                       NaN where there are none */
};
/* Cells of surfaces are bilinear: their areas are those of 2 Gauss points a direction, exact where
 * a cell is plane. active: by node of the face. */
struct face_tilt face_measure_tilt(const struct mesh *mesh, const double *u, const bool *active);
/* Returns the mean of gaps over the face as it stands, with its slopes. */
double face_mean_gap_current(const struct mesh *mesh, const double *u, const double *gap);
/* Divides the gaps of nodes out of contact by the cosine between the vertical and the normal of the
 * node, the mean of the unit normals of the cells around it: where the ray along the normal meets
 * the flat. Signs stay as they are, and so do the gaps of nodes in contact, which the standard
 * weighting closes in the mean alone: the mesh's error is known by them. NaN where the normal does
 * not point to the flat, which faces that do not fold exclude. */
void face_turn_gaps(const struct mesh *mesh, const double *u, const bool *active, double *gap);

#endif
