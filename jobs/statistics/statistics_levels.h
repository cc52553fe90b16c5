/* Mesh levels of statistics: the same surfaces on coarser grids, of every second, fourth ... point
 * of their own grid, which are exact samples of them. The error "discretisation" is estimated from
 * the changes of curves and scalars between levels (core/statistics/uncertainty/richardson.h). */
#ifndef RUGO_JOBS_STATISTICS_STATISTICS_LEVELS_H
#define RUGO_JOBS_STATISTICS_STATISTICS_LEVELS_H

#include "core/statistics/surface_pass.h"
#include "jobs/statistics/statistics_law.h"
#include "schema/result/result.h"

/* The tallies of a case: that of the surfaces' own grid, and one for each level. */
struct statistics_levels {
    struct statistics_tally own; /* first, so that a pointer to the struct is one to it */
    size_t count;                /* of coarser levels, from fine to coarse */
    struct statistics_case cases[STATISTICS_LEVELS_MOST]; /* borrow what the case owns */
    struct statistics_tally tallies[STATISTICS_LEVELS_MOST];
    /* Sums by groups of realisations of which scalars are means, of the own grid and of each level;
     * empty without levels. */
    struct statistics_groups moments[1 + STATISTICS_LEVELS_MOST];
    struct statistics_groups pairs[PAIR_SURFACES]; /* of realisations that have the other law */
    struct statistics_groups draws[PAIR_SURFACES]; /* of those that have drawn parameters */
};
int statistics_levels_create(struct statistics_levels *out, const struct statistics_case *one_case,
                             const struct moments *moments, const struct spectra_sizes *sizes,
                             struct error *err);
void statistics_levels_clear(struct statistics_levels *levels);
/* As job_kind has them. */
void statistics_levels_put(struct bytes *bytes, const struct statistics_levels *levels);
void statistics_levels_get(struct byte_reader *reader, struct statistics_levels *levels);
bool statistics_levels_add_up(const struct statistics_levels *levels);
void statistics_levels_merge(struct statistics_levels *into, const struct statistics_levels *from);
/* Returns the bytes of all coarser levels: tallies and workspaces. */
double statistics_levels_bytes(const struct statistics_case *one_case);

/* Returns the case on the grid of a coarser level; borrows what the case owns. */
struct statistics_case statistics_level_case(const struct statistics_case *one_case, size_t level);

/* The workspace that measures the surfaces of one case on its levels. */
struct levels_workspace;
/* Borrows the case. *out is NULL where it has no levels. band: as of summit_finder_create for its
 * own grid. height: RMS height of translated surfaces. */
int levels_workspace_create(struct levels_workspace **out, const struct statistics_case *one_case,
                            struct surface_band band, double height, struct error *err);
void levels_workspace_destroy(struct levels_workspace **workspace);
/* Adds a realisation to the levels, after its own tally has it. The summits are those of its own
 * grid. Without a workspace (NULL) it does nothing. */
int levels_workspace_add(struct levels_workspace *workspace, const struct realisation *realisation,
                         const struct summit_list own[], struct statistics_levels *levels,
                         struct error *err);

/* Adds the discretisation error to curves and scalars of a result. That of summits is estimated
 * from the levels, that of constants of the spectrum is exact, and that of heights is 0. */
int statistics_levels_errors(const struct statistics_levels *levels, struct case_result *out,
                             struct error *err);

/* Positions in the sums of `moments`: first counts by side, then these sums of each side, then
 * those of all points. In z* and kappa_m/sqrt(m4). */
enum level_sum { SUM_HEIGHT, SUM_SQUARE, SUM_CUBE, SUM_FOURTH, SUM_CURVATURE, SUMS_OF_SIDE };
enum { SUM_LOWEST = SIDES * SUMS_OF_SIDE, SUM_HIGHEST, LEVEL_SUMS };

#endif
