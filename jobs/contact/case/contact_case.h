/* One case of a contact study, with its cost. Loads are p/(E* h'), h' the RMS slope of the
 * prescribed spectrum; lengths are in lambda_s. Results are dimensionless, and do not depend on
 * E. */
#ifndef RUGO_JOBS_CONTACT_CONTACT_CASE_H
#define RUGO_JOBS_CONTACT_CONTACT_CASE_H

#include "core/contact/contact.h"
#include "core/full/full.h"
#include "core/statistics/heights/histogram.h"
#include "jobs/contact/companion/companion_plan.h"
#include "jobs/contact/model/model.h"
#include "jobs/contact/quantity/quantities_asked.h"
#include "jobs/kind.h"
#include "jobs/like/like_case.h"
#include "schema/study/fault.h"
#include "schema/study/parameter.h"

/* The most that a hardness may be, over E* h'. */
#define CONTACT_HARDNESS_MOST 1e6
enum { CONTACT_LEVELS_MOST = 8, CONTACT_LOADS_MOST = 1000, CONTACT_KEPT_MOST = 1000 };

enum height_unit { HEIGHT_RMS_HEIGHTS, HEIGHT_LENGTHS, HEIGHT_WAVELENGTHS };
enum area_estimator { AREA_NODES, AREA_EDGES, AREA_PERIMETER, AREA_ESTIMATORS };
/* Whether an error is estimated by companions (companion/companion.h). */
enum companion_choice { COMPANION_PROBED, COMPANION_NONE };

enum stiffness_choice { STIFFNESS_MEASURED, STIFFNESS_OMITTED };
enum asperities_choice { ASPERITIES_OMITTED, ASPERITIES_COUNTED };
/* Whether differences of densities of pressure are summed by realisation (contact_densities.h). */
enum pairs_choice { PAIRS_OMITTED, PAIRS_COUNTED };

/* What the loads of a study are given in; those of a case are p/(E* h'). */
enum load_unit { LOAD_UNIT_REDUCED, LOAD_UNIT_PASCAL };
/* The most that a load may be, in E* h' and as a number in either unit. */
#define CONTACT_LOAD_MOST 1e6
#define CONTACT_LOAD_NUMBER_MOST 1e15

extern const struct choice KINEMATICS_CHOICES[]; /* of enum kinematics */
extern const struct parameter_table CONTACT_PARAMETERS;
/* Tables of the kind: CONTACT_PARAMETERS, SURFACE_PARAMETERS, LIKE_PARAMETERS and others. */
extern const struct parameter_table *const CONTACT_TABLES[];

struct contact_case {
    struct surface_case surface; /* with the grid on which realisations are generated */
    struct like_case like;       /* a measured surface that these resemble */
    bool two_faces;              /* the flat has a rough face, too, which is in the surface */
    struct surface_band band;    /* by which realisations are sampled on other grids */
    size_t model_count;
    const struct contact_model *models[CONTACT_MODELS_MOST]; /* in the order given */
    struct block blocks[CONTACT_MODELS_MOST];                /* one a model */
    enum kinematics kinematics;                              /* of strain */
    double transition_depth; /* of columns (mesh.h), unless fine_height has it */
    double fine_height;      /* depth of the columns as wide as those of the face; 0: not given */
    double rms_slope;  /* of the prescribed spectrum; 0 where no model needs it, as the next */
    double rms_height; /* in the grid's unit */
    size_t level_count;
    struct contact_level levels[CONTACT_LEVELS_MOST]; /* rising: the last is the finest */
    struct companion_plan companions[COMPANION_COUNT];
    /* Contact of a measured surface that these resemble, pressed as the sub-maps of these are, by
     * load: owned; NULL: none. */
    double *like_areas, *like_gaps;
    size_t load_count;
    double *loads;                 /* owned: p/(E* h'), rising, > 0 */
    bool nodes, edges, perimeter;  /* estimators shown */
    bool stiffness;                /* is shown */
    bool tangent;                  /* solutions need it: for the stiffness, or a quantity */
    struct quantities_asked asked; /* beside these (quantity/quantity.h) */
    bool asperities;               /* theories by counted summits are wanted */
    bool unloads;                  /* the loads fall again, from the highest */
    bool slip_measured;            /* its stiffness, of each contact: where faces have lay */
    bool slip_pressing;            /* friction acts while the block is pressed: coupled slip */
    bool current_areas;            /* of full, as the next: over the face as it stands (full.h) */
    bool normal_gaps;              /* along its normal */
    double hardness;               /* over E* h', above all loads; 0: the contact is elastic */
    double yield;                  /* the same over E* */
    double friction;               /* coefficient; 0: nothing slips */
    size_t slip_load;              /* the load that is held while a tangential one rises */
    double slip_angle;             /* of the tangential load from x, in radians */
    size_t slide_count;            /* points of curves by sliding at the held load; 0: none */
    size_t slide_steps;            /* of them from one turning point to the next */
    double *slide;     /* owned: where the flat is at each, over the RMS height; the first is 0 */
    double tolerance;  /* of solutions (contact_tolerance.h) */
    double time_limit; /* counted seconds of the loads of full (full.h); 0: none */
    size_t pdf_count;
    size_t *pdf_loads;    /* owned: loads whose pressures are counted, rising */
    bool pdf_pairs;       /* on all levels, with their differences (contact_densities.h) */
    struct bins pressure; /* of p/(E* h') */
    size_t kept_count;    /* realisations whose nodes are written */
    double *kept;         /* owned: their numbers, rising */
    size_t kept_load_count;
    size_t *kept_loads; /* owned: positions among the loads, rising; NULL: all of them */
};
void contact_case_clear(struct contact_case *one_case);
/* Returns the points of a shortest wave of realisations on a grid; 4 where its waves are not known,
 * as of a map. */
double contact_case_wave(const struct contact_case *one_case, const struct grid *grid);

static inline const struct contact_level *contact_case_finest(const struct contact_case *one_case) {
    return &one_case->levels[one_case->level_count - 1];
}
/* Returns how many bins pressures have, with under- and overflow. */
static inline size_t contact_case_bins(const struct contact_case *one_case) {
    return one_case->pressure.count + 2;
}
/* Return how many values a measure has room for in a model and level, and those that it has: one a
 * load, or a point of curves by sliding. */
static inline size_t contact_case_slots(const struct contact_case *one_case) {
    return one_case->slide_count > one_case->load_count ? one_case->slide_count
                                                        : one_case->load_count;
}
static inline size_t contact_case_values(const struct contact_case *one_case, enum measure_by by) {
    return by == BY_SLIDING ? one_case->slide_count : one_case->load_count;
}
/* Return the index of a model, level and load (or point), these running fastest, and the number of
 * these cells. */
static inline size_t contact_case_cell(const struct contact_case *one_case, size_t model,
                                       size_t level, size_t load) {
    return (model * one_case->level_count + level) * contact_case_slots(one_case) + load;
}
static inline size_t contact_case_cells(const struct contact_case *one_case) {
    return contact_case_cell(one_case, one_case->model_count, 0, 0);
}
/* Return the number of points of a curve, and the load of point i, by sliding the point itself; by
 * slip loads fall. */
static inline size_t contact_case_points(const struct contact_case *one_case, enum measure_by by) {
    return by == BY_SLIP ? one_case->slip_load : contact_case_values(one_case, by);
}
static inline size_t contact_case_point(const struct contact_case *one_case, enum measure_by by,
                                        size_t i) {
    return by == BY_SLIP ? one_case->slip_load - 1 - i : i;
}
/* Returns whether the case has a companion. */
static inline bool contact_case_has(const struct contact_case *one_case,
                                    enum companion_name companion) {
    return one_case->companions[companion].series > 0;
}

/* Returns whether the blocks have a coating, which is that of all models. */
static inline bool contact_case_is_coated(const struct contact_case *one_case) {
    return one_case->model_count > 0 && block_is_coated(&one_case->blocks[0]);
}
/* Returns a bound of the relative change of a measure by the height of a model's block. It is
 * several times the relative difference of compliance from a half-space, at the longest wave of the
 * cell. */
double contact_case_block_bound(const struct contact_case *one_case, size_t model);

/* Returns the most complete of the models, of which the others differ by their errors. */
size_t contact_case_complete(const struct contact_case *one_case);
/* Returns the depth on a mesh from which columns become wider, in widths of the wide ones. */
double contact_case_transition(const struct contact_case *one_case, const struct grid *grid);
/* Returns how the case has the model full solved on a grid, and the same with the limit of what the
 * loads on this block may take. */
struct full_options contact_case_full_options(const struct contact_case *one_case,
                                              const struct grid *grid);
struct full_options contact_case_limited_options(const struct contact_case *one_case,
                                                 const struct grid *grid,
                                                 const struct block *block);
/* Returns whether there is friction and a model that has it at finite strain. */
bool contact_case_slides(const struct contact_case *one_case);
/* Returns how far the flat has gone on its path at point i, over the RMS height. */
double contact_case_slid(const struct contact_case *one_case, size_t i);
/* Return whether the surface has a scale, and its RMS height and slope by the prescribed spectrum,
 * in lambda_s; NaN without a scale. */
bool contact_case_has_scale(const struct contact_case *one_case);
int contact_case_scale(const struct contact_case *one_case, double *rms_height, double *rms_slope,
                       struct error *err);

/* Returns whether the areas of a model are reported as they are under load. */
bool contact_case_stretches(const struct contact_case *one_case, size_t model);

/* Returns how the case has linear models solved. */
struct contact_options contact_case_options(const struct contact_case *one_case);
/* Returns the CPU seconds of a linear model on a grid of any length, as estimated, with so many
 * densities of pressure: of all loads, and under a hardness with what yields and loads that fall
 * again. */
double contact_case_linear_seconds(const struct contact_case *one_case, const struct grid *grid,
                                   bool elements, size_t densities);
/* Returns the least planned seconds of a realisation, without its companions. A choice that changes
 * values must not depend on whether memory suffices for a better estimate. */
double contact_case_least_seconds(const struct contact_case *one_case);

#endif
