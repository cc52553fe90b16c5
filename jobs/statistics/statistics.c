/* The kind "statistics": summit statistics, spectra and roughness of random surfaces. */
#include "jobs/block.h"
#include "jobs/case_document.h"
#include "jobs/statistics/statistics_curves.h"
#include "jobs/statistics/statistics_scalars.h"
#include "jobs/statistics/statistics_spectra.h"
#include "jobs/statistics/statistics_view.h"
#include <stdlib.h>

static int check(const cJSON *parameters, struct fault_list *faults, struct job_estimate *estimate,
                 struct error *err) {
    struct statistics_case study;
    size_t before = faults->count;
    int status = statistics_case_read(&study, parameters, faults, err);
    if (status != 0)
        return status == ERROR_INPUT && faults->count > before ? 0 : status;
    statistics_case_estimate(&study, estimate);
    statistics_case_clear(&study);
    return 0;
}

struct job_runner {
    struct statistics_case study;
    struct random_key key;
    struct generator *generator;
    struct summit_finder *finder;
    struct spectra spectra;
    struct moments moments; /* of the prescribed spectrum */
    struct summit_list summits;
    double *z; /* grid_points */
};

static void runner_destroy(struct job_runner **out) {
    struct job_runner *runner = *out;
    if (runner == NULL)
        return;
    generator_destroy(&runner->generator);
    summit_finder_destroy(&runner->finder);
    spectra_clear(&runner->spectra);
    summit_list_clear(&runner->summits);
    statistics_case_clear(&runner->study);
    free(runner->z);
    free(runner);
    *out = NULL;
}

static int runner_fill(struct job_runner *runner, const cJSON *parameters, struct error *err) {
    struct statistics_case *study = &runner->study;
    const struct grid *grid = &study->surface.grid;
    int status = statistics_case_read(study, parameters, NULL, err);
    if (status != 0)
        return status;
    status = generator_create(&runner->generator, &study->surface.spectrum, grid,
                              &study->surface.options, err);
    if (status != 0)
        return status;
    const struct modes *modes = generator_modes(runner->generator);
    modes_moments(modes, &runner->moments);
    bool exact = surface_case_exact(&study->surface); /* else heights placed point by point */
    status = summit_finder_create(&runner->finder, grid, study->stencil, study->curvature,
                                  exact ? modes->mode_x : grid->nx / 2,
                                  exact ? modes->mode_y : grid->ny / 2, err);
    if (status == 0)
        status = spectra_create(&runner->spectra, study, modes, err);
    if (status != 0)
        return status;
    runner->z = array_create(grid_points(grid), sizeof *runner->z);
    return runner->z != NULL
               ? 0
               : error_memory(err, grid_points(grid) * sizeof *runner->z, "a surface");
}

static int runner_create(struct job_runner **out, const cJSON *parameters,
                         const struct job_shared *shared, uint64_t seed, uint64_t case_number,
                         struct error *err) {
    (void)shared;
    struct job_runner *runner = array_create(1, sizeof *runner);
    if (runner == NULL)
        return error_memory(err, sizeof *runner, "a runner");
    runner->key = (struct random_key){seed, case_number, 0};
    int status = runner_fill(runner, parameters, err);
    if (status != 0)
        runner_destroy(&runner);
    *out = runner;
    return status;
}

/* A block of realisations being run. */
struct batch {
    struct job_runner *runner;
    struct statistics_tally tally;
};

static int realise(void *context, uint64_t realisation, uint64_t done, double *scalars,
                   struct error *err) {
    struct batch *batch = context;
    struct job_runner *runner = batch->runner;
    const struct grid *grid = &runner->study.surface.grid;
    struct surface_report report = {0};
    struct roughness roughness;
    struct moments moments = runner->moments;
    (void)done;
    runner->key.realisation = realisation;
    int status = generator_run(runner->generator, runner->key, runner->z, &report, err);
    if (status == 0)
        status = summits_find(runner->finder, runner->z, &runner->summits, err);
    if (status == 0)
        status = spectra_measure(&runner->spectra, grid, runner->z, &batch->tally, err);
    if (status == 0 && !surface_case_exact(&runner->study.surface))
        status = roughness_spectral(grid, runner->z, &moments, err);
    if (status != 0)
        return error_context(err, "realisation %llu", (unsigned long long)realisation);
    roughness_measure(grid, runner->z, &roughness);
    statistics_tally_heights(&batch->tally, grid_points(grid), runner->z);
    statistics_tally_summits(&batch->tally, &runner->summits);
    statistics_scalars_measure(&runner->study, &runner->moments,
                               &(struct realisation_measures){.roughness = &roughness,
                                                              .moments = &moments,
                                                              .summits = &runner->summits,
                                                              .report = &report},
                               scalars);
    return 0;
}

static int encode(void *context, unsigned char **data, size_t *size, struct error *err) {
    struct batch *batch = context;
    return statistics_tally_encode(&batch->tally, data, size, err);
}

static int run(struct job_runner *runner, uint64_t first, uint64_t count,
               const struct job_control *control, struct block_result *out, struct error *err) {
    struct batch batch = {.runner = runner};
    const struct block_work work = {&batch, SCALAR_COUNT, statistics_scalar_name, realise, encode};
    int status =
        statistics_tally_create(&batch.tally, &runner->study, &runner->moments,
                                runner->spectra.densities, runner->spectra.correlations, err);
    if (status != 0)
        return status;
    status = block_run(&work, first, count, control, out, err);
    statistics_tally_clear(&batch.tally);
    return status;
}

struct job_merger {
    struct statistics_case study;
    struct modes *modes;
    struct moments moments;
    struct statistics_tally tally; /* of all blocks so far */
    struct realisations realisations;
};

static void merger_destroy(struct job_merger **out) {
    struct job_merger *merger = *out;
    if (merger == NULL)
        return;
    statistics_tally_clear(&merger->tally);
    realisations_clear(&merger->realisations);
    modes_destroy(&merger->modes);
    statistics_case_clear(&merger->study);
    free(merger);
    *out = NULL;
}

static int tally_like(const struct job_merger *merger, struct statistics_tally *out,
                      struct error *err) {
    return statistics_tally_create(out, &merger->study, &merger->moments,
                                   spectra_densities(&merger->study),
                                   spectra_correlations(&merger->study), err);
}

static int merger_create(struct job_merger **out, const cJSON *parameters, struct error *err) {
    struct job_merger *merger = array_create(1, sizeof *merger);
    if (merger == NULL)
        return error_memory(err, sizeof *merger, "a merger");
    merger->realisations.scalar_count = SCALAR_COUNT;
    int status = statistics_case_read(&merger->study, parameters, NULL, err);
    if (status == 0)
        status = modes_create(&merger->modes, &merger->study.surface.spectrum,
                              &merger->study.surface.grid, err);
    if (status == 0) {
        modes_moments(merger->modes, &merger->moments);
        status = tally_like(merger, &merger->tally, err);
    }
    if (status != 0)
        merger_destroy(&merger);
    *out = merger;
    return status;
}

/* Whether the scalars and the tally of a block tell of the same realisations. */
static int check_block(const struct block_result *result, const struct statistics_tally *tally,
                       struct error *err) {
    double summits = 0;
    for (uint64_t r = 0; r < result->count; r++)
        summits += result->scalars[r * SCALAR_COUNT + SCALAR_SUMMITS];
    if (tally->summits.realisations != result->count || !(summits == (double)tally->summits.sum))
        return error_set(err, ERROR_INPUT,
                         "the partial result does not belong to the scalars beside it");
    return 0;
}

/* Decodes a block that the merger could take; *tally is the caller's to clear, also on failure. */
static int read_block(const struct job_merger *merger, const struct block_result *result,
                      struct statistics_tally *tally, struct error *err) {
    *tally = (struct statistics_tally){0};
    int status = realisations_check(&merger->realisations, result, err);
    if (status == 0)
        status = tally_like(merger, tally, err);
    if (status == 0)
        status = statistics_tally_decode(tally, result->data, result->size, err);
    return status ? status : check_block(result, tally, err);
}

static int fits(const struct job_merger *merger, const struct block_result *result,
                struct error *err) {
    struct statistics_tally tally;
    int status = read_block(merger, result, &tally, err);
    statistics_tally_clear(&tally);
    return status;
}

static int merge(struct job_merger *merger, const struct block_result *result, struct error *err) {
    struct statistics_tally tally;
    int status = read_block(merger, result, &tally, err);
    if (status == 0)
        status = realisations_add(&merger->realisations, result, err);
    if (status == 0)
        statistics_tally_merge(&merger->tally, &tally);
    statistics_tally_clear(&tally);
    return status;
}

static int curves(struct job_merger *merger, cJSON **out, struct error *err) {
    cJSON *scalars = NULL, *list = NULL;
    int status = statistics_scalars_json(&merger->study, &merger->moments, &merger->realisations,
                                         &scalars, err);
    if (status == 0)
        status = statistics_curves(&merger->study, merger->modes, &merger->moments, &merger->tally,
                                   &list, err);
    if (status != 0) {
        cJSON_Delete(scalars);
        return status;
    }
    return case_document(merger->realisations.count, scalars, list, NULL, out, err);
}

const struct job_kind STATISTICS_KIND = {
    .name = "statistics",
    .tables = STATISTICS_TABLES,
    .default_realisations = 1000,
    .scalar = statistics_scalar_name,
    .view = &STATISTICS_VIEW,
    .check = check,
    .runner_create = runner_create,
    .runner_destroy = runner_destroy,
    .run = run,
    .merger_create = merger_create,
    .merger_destroy = merger_destroy,
    .fits = fits,
    .merge = merge,
    .curves = curves,
};
