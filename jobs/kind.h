/* What one unit of work is. A kind reads its parameters, runs realisations, encodes a partial
 * result, merges partial results and turns them into curves. A new kind is one file that fills a
 * struct job_kind, and one line in the table of kind.c.
 *
 * Life of a job: check -> shared_create (once a case and process) -> runner_create -> run (blocks,
 * one thread a runner) -> runner_destroy -> shared_destroy;
 * of a curve: merger_create -> add (in any order: the same bits) -> curves -> merger_destroy. */
#ifndef RUGO_JOBS_KIND_H
#define RUGO_JOBS_KIND_H

#include "core/error.h"
#include "schema/result/block_result.h"
#include "schema/study/fault.h"
#include "schema/study/parameter.h"
#include <cjson/cJSON.h>
#include <stdint.h>

/* What a case costs; rough, before anything ran. */
struct job_estimate {
    size_t nx, ny;         /* grid of one realisation (the finest) */
    double memory_bytes;   /* peak of one worker thread */
    double seconds;        /* CPU seconds a realisation on a 3 GHz core */
    double relative_error; /* standard error of the main curve after one realisation; / sqrt(n) */
};

/* Asked between realisations, and again and again within one that may take long: how many of the
 * block are done; non-zero stops with ERROR_STOPPED. */
struct job_control {
    int (*poll)(void *context, uint64_t done);
    void *context;
};

struct result_view;
struct job_shared;
struct job_runner;
struct job_merger;

struct job_kind {
    const char *name;
    const struct parameter_table *const *tables; /* of its parameters; NULL at the end */
    uint64_t default_realisations;
    /* Name of a scalar of one realisation; NULL behind the last. */
    const char *(*scalar)(size_t at);
    const struct result_view *view; /* schema/result/view.h; NULL: nothing special is shown */

    /* Parameters of one case: the study's object of effective values, lists already replaced. Adds
     * faults that no single range shows (grid too large, alpha out of reach) and estimates the
     * cost. */
    int (*check)(const cJSON *parameters, struct fault_list *faults, struct job_estimate *estimate,
                 struct error *err);
    /* What all runners of a case can share, such as a factorised matrix: immutable once made, read
     * by many threads. Both NULL for kinds that share nothing. */
    int (*shared_create)(struct job_shared **out, const cJSON *parameters, struct error *err);
    void (*shared_destroy)(struct job_shared **shared);
    /* Borrows shared, of the same parameters, as long as it lives; NULL where the kind shares
     * nothing, or for the runner to make its own. */
    int (*runner_create)(struct job_runner **out, const cJSON *parameters,
                         const struct job_shared *shared, uint64_t seed, uint64_t case_number,
                         struct error *err);
    void (*runner_destroy)(struct job_runner **runner);
    /* Runs realisations first .. first + count - 1 into out (untouched on failure). */
    int (*run)(struct job_runner *runner, uint64_t first, uint64_t count,
               const struct job_control *control, struct block_result *out, struct error *err);

    int (*merger_create)(struct job_merger **out, const cJSON *parameters, struct error *err);
    void (*merger_destroy)(struct job_merger **merger);
    /* Whether merge would take the block: 0 or its error. Changes nothing, so that many threads may
     * ask one merger. */
    int (*fits)(const struct job_merger *merger, const struct block_result *result,
                struct error *err);
    /* Decodes and adds one block; ERROR_INPUT for data that is not this case's (nothing added). */
    int (*merge)(struct job_merger *merger, const struct block_result *result, struct error *err);
    /* {"realisations": n, "scalars": {...}, "curves": [...]} as in openapi.yaml; caller deletes. */
    int (*curves)(struct job_merger *merger, cJSON **out, struct error *err);

    /* Writes what the case is solved on, for the surface z of its own grid, pressed to p/(E* h')
     * where that is above 0, as a VTU file. Lengths in lambda_s, pressures and stresses in E* h'.
     * Nothing is written on failure. NULL for kinds without meshes. */
    int (*write_mesh)(const char *path, const cJSON *parameters, const double *z, double pressure,
                      struct error *err);
};

/* How many scalars a realisation has, and whether these of a result are they: ERROR_INPUT. */
size_t kind_scalar_count(const struct job_kind *kind);
int kind_check_names(const struct job_kind *kind, const struct block_result *result,
                     struct error *err);

/* Seconds on a clock that never steps: for block_result.seconds. */
double job_clock(void);

/* All kinds, in a fixed order; kind_find gives NULL for an unknown name. */
extern const struct job_kind *const JOB_KINDS[];
extern const size_t JOB_KIND_COUNT;
const struct job_kind *kind_find(const char *name);

#endif
