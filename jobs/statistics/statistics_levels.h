/* Mesh levels of statistics: the same surfaces seen on coarser grids, every second, fourth ...
 * point of their own grid, which are exact samples of them. How curves and scalars change from
 * level to level tells what they owe to the grid (core/statistics/richardson.h): the error
 * "discretisation".
 */
#ifndef RUGO_JOBS_STATISTICS_STATISTICS_LEVELS_H
#define RUGO_JOBS_STATISTICS_STATISTICS_LEVELS_H

#include "core/statistics/surface_pass.h"
#include "jobs/statistics/statistics_tally.h"
#include "schema/result/result.h"

/* What the kind keeps of realisations: the tally of their own grid, and one for each level. */
struct statistics_levels {
    struct statistics_tally own; /* stands first: a pointer to all is one to it */
    size_t count;                /* of coarser levels, from fine to coarse */
    struct statistics_case cases[STATISTICS_LEVELS_MOST]; /* borrow what the case owns */
    struct statistics_tally tallies[STATISTICS_LEVELS_MOST];
    /* Sums by groups of realisations that scalars are means of, of the own grid and of each level;
     * nothing without levels. */
    struct statistics_groups moments[1 + STATISTICS_LEVELS_MOST];
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
/* Of all levels but the own grid: of tallies and of workspaces. */
double statistics_levels_bytes(const struct statistics_case *one_case);

/* The case as a coarser level sees it, which borrows what it owns. */
struct statistics_case statistics_level_case(const struct statistics_case *one_case, size_t level);

/* What measures the surfaces of one case on its levels. */
struct levels_workspace;
/* Borrows the case. *out is NULL where it has no levels. mode_x, mode_y as of summit_finder_create
 * for its own grid. */
int levels_workspace_create(struct levels_workspace **out, const struct statistics_case *one_case,
                            size_t mode_x, size_t mode_y, struct error *err);
void levels_workspace_destroy(struct levels_workspace **workspace);
/* Adds a realisation to the levels, whose own tally has it already: z on the own grid, with the
 * summits found there. workspace may be NULL: nothing is done. */
int levels_workspace_add(struct levels_workspace *workspace, uint64_t realisation, const double *z,
                         const struct summit_list own[], struct statistics_levels *levels,
                         struct error *err);

/* Tells the discretisation error of curves and scalars of a result: of summits by the levels, of
 * constants of the spectrum exactly, of heights that there is none. */
int statistics_levels_errors(const struct statistics_levels *levels, struct case_result *out,
                             struct error *err);

/* Where the sums of `moments` stand: counts by side; of each side these sums, then those of all
 * points. In z* and kappa_m/sqrt(m4). */
enum level_sum { SUM_HEIGHT, SUM_SQUARE, SUM_CUBE, SUM_FOURTH, SUM_CURVATURE, SUMS_OF_SIDE };
enum { SUM_LOWEST = SIDES * SUMS_OF_SIDE, SUM_HIGHEST, LEVEL_SUMS };

#endif
