/* One case of a contact study, read and costed. Loads are p/(E* h'), h' the RMS slope of the
 * prescribed spectrum; lengths are in lambda_s; results are dimensionless, so that E plays no part
 * in them. */
#ifndef RUGO_JOBS_CONTACT_CONTACT_CASE_H
#define RUGO_JOBS_CONTACT_CONTACT_CASE_H

#include "core/full/material.h"
#include "core/statistics/histogram.h"
#include "jobs/contact/contact_parameters.h"
#include "jobs/contact/model.h"
#include "jobs/kind.h"
#include "jobs/like_case.h"
#include "jobs/surface_paths.h"
#include "schema/study/fault.h"

/* Tables of the kind: CONTACT_PARAMETERS, SURFACE_PARAMETERS, LIKE_PARAMETERS and others. */
extern const struct parameter_table *const CONTACT_TABLES[];

/* A mesh on which every realisation is solved: the own grid sampled at other points. */
struct contact_level {
    double points; /* a shortest wave, as given */
    struct grid grid;
    size_t stride; /* every stride-th point of the own grid each way; 0: resampled from its band */
};

/* Surfaces longer and shorter than the case's, by which the error of its cell is told
 * (contact_cell.h). */
enum contact_length { LENGTH_LONGER, LENGTH_SHORTER, CONTACT_LENGTHS };
struct contact_surfaces {
    double length;               /* over that of the case */
    struct surface_case surface; /* borrows from that of the case; its grid is that on which
                                    surfaces are generated, without points where there are none */
    struct surface_band band;    /* of a surface on it */
    struct contact_level level;  /* as fine as the probe, of this grid */
    uint64_t interval;           /* of realisations, one of which is beside such a surface; 2^n */
};

/* Surfaces found in other ways (contact_generation.h). */
struct contact_paths {
    struct contact_level level; /* that of the probe; no points: there are none */
    uint64_t interval;          /* of realisations, one of which is found again; 2^n */
};
/* Series of loads: the own surface, then one a path. */
enum { PATHS_OWN, PATHS_FOUND, PATHS_SERIES = PATHS_FOUND + SURFACE_PATHS };

struct contact_case {
    struct surface_case surface; /* and its own grid, on which realisations are generated */
    struct like_case like;       /* a measured surface that these are like */
    struct surface_band band;    /* of a realisation on its own grid */
    size_t model_count;
    const struct contact_model *models[CONTACT_MODELS_MOST]; /* in the order given */
    struct block blocks[CONTACT_MODELS_MOST];                /* one a model */
    enum kinematics kinematics;                              /* of strain */
    double transition_depth;                                 /* of columns (mesh.h) */
    double rms_slope; /* of the prescribed spectrum; 0 where no model asks for it */
    size_t level_count;
    struct contact_level levels[CONTACT_LEVELS_MOST]; /* rising: the last is the finest */
    struct contact_level probe; /* the coarse mesh of probes (contact_probe.h): half as fine as the
                                   coarsest where that leaves 4 points; no points without one */
    bool low_blocks;            /* the heights of blocks are probed */
    uint64_t probe_interval;    /* else: of realisations, one of which is probed; 2^n */
    struct contact_surfaces lengths[CONTACT_LENGTHS]; /* no points: there are none */
    struct contact_paths paths;
    /* Of a measured surface that these are like, and pressed as pieces of these are, one a load:
     * owned; NULL: nothing is pressed beside it. */
    double *like_areas, *like_gaps;
    size_t load_count;
    double *loads;                /* owned: p/(E* h'), rising, > 0 */
    bool nodes, edges, perimeter; /* estimators shown */
    bool stiffness;               /* is measured */
    double tolerance;
    size_t pdf_count;
    size_t *pdf_loads;    /* owned: loads whose pressures are counted, rising */
    struct bins pressure; /* of p/(E* h') */
};
void contact_case_clear(struct contact_case *one_case);

static inline const struct contact_level *contact_case_finest(const struct contact_case *one_case) {
    return &one_case->levels[one_case->level_count - 1];
}
/* Returns how many bins pressures have, with under- and overflow. */
static inline size_t contact_case_bins(const struct contact_case *one_case) {
    return one_case->pressure.count + 2;
}
/* Model, level and load as one number, loads running fastest; and how many there are. */
static inline size_t contact_case_cell(const struct contact_case *one_case, size_t model,
                                       size_t level, size_t load) {
    return (model * one_case->level_count + level) * one_case->load_count + load;
}
static inline size_t contact_case_cells(const struct contact_case *one_case) {
    return contact_case_cell(one_case, one_case->model_count, 0, 0);
}
static inline bool contact_case_is_probed(const struct contact_case *one_case) {
    return one_case->probe.grid.nx > 0;
}
static inline bool contact_case_has_length(const struct contact_case *one_case,
                                           enum contact_length length) {
    return one_case->lengths[length].surface.grid.nx > 0;
}
/* Behind these, of the probe: the half-space (block 0) and, where blocks are low, the block of each
 * model, by load. */
static inline size_t contact_case_probe_blocks(const struct contact_case *one_case) {
    if (!contact_case_is_probed(one_case))
        return 0;
    return one_case->low_blocks ? one_case->model_count + 1 : 1;
}
static inline size_t contact_case_probe_cell(const struct contact_case *one_case, size_t block,
                                             size_t load) {
    return contact_case_cells(one_case) + block * one_case->load_count + load;
}
static inline bool contact_case_has_paths(const struct contact_case *one_case) {
    return one_case->paths.level.grid.nx > 0;
}
/* Behind these, of the surfaces of another length, by load. */
static inline size_t contact_case_length_cell(const struct contact_case *one_case,
                                              enum contact_length length, size_t load) {
    size_t series = contact_case_probe_blocks(one_case);
    for (enum contact_length other = 0; other < length; other++)
        series += contact_case_has_length(one_case, other);
    return contact_case_probe_cell(one_case, series, load);
}
/* And behind these, of the surfaces found in other ways and of the own one beside them, by load. */
static inline size_t contact_case_path_cell(const struct contact_case *one_case, size_t series,
                                            size_t load) {
    return contact_case_length_cell(one_case, CONTACT_LENGTHS, 0) + series * one_case->load_count +
           load;
}
static inline bool contact_case_has_like(const struct contact_case *one_case) {
    return one_case->like_areas != NULL;
}
/* And behind these, of the mirrored pieces, by load; and how many cells there are in all. */
static inline size_t contact_case_like_cell(const struct contact_case *one_case, size_t load) {
    return contact_case_path_cell(one_case, contact_case_has_paths(one_case) ? PATHS_SERIES : 0,
                                  0) +
           load;
}
static inline size_t contact_case_all_cells(const struct contact_case *one_case) {
    return contact_case_like_cell(one_case,
                                  contact_case_has_like(one_case) ? one_case->load_count : 0);
}

/* By how much the height of a model's block changes what is measured, relative to it, at most:
 * several times what the compliance of the longest wave of the cell lacks of that of a half-space.
 */
double contact_case_block_bound(const struct contact_case *one_case, size_t model);
/* Beyond this a block's height is probed (contact_probe.h). */
#define CONTACT_BLOCK_LOW 1e-4

/* The position of the cheapest model that has a value of every realisation; model_count without
 * one. */
size_t contact_case_control(const struct contact_case *one_case);

/* The most complete of the models: that from which the errors of the others are counted. */
size_t contact_case_complete(const struct contact_case *one_case);
/* Returns whether the surface has lengths of its own, and its RMS height and slope by the
 * prescribed spectrum, in lambda_s; NaN where it has none. */
bool contact_case_has_scale(const struct contact_case *one_case);
int contact_case_scale(const struct contact_case *one_case, double *rms_height, double *rms_slope,
                       struct error *err);

/* Returns whether the areas of a model are told as they are under load. */
bool contact_case_stretches(const struct contact_case *one_case, size_t model);

/* CPU seconds that a realisation takes at least, without what stands beside it: a choice that
 * changes values must not depend on whether there is memory for a better estimate. */
double contact_case_least_seconds(const struct contact_case *one_case);
/* Estimates memory, time and error of one realisation before anything ran. */
void contact_case_estimate(const struct contact_case *one_case, struct study_cost *out);

#endif
