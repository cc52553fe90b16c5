/* The kind "contact": rough elastic blocks pressed on a rigid flat, by linear models. */
#include "jobs/block.h"
#include "jobs/case_document.h"
#include "jobs/contact/contact_curves.h"
#include "jobs/contact/contact_scalars.h"
#include "jobs/contact/contact_scene.h"
#include "jobs/contact/contact_view.h"
#include <stdlib.h>

static int check(const cJSON *parameters, struct fault_list *faults, struct job_estimate *estimate,
                 struct error *err) {
    struct contact_case study;
    size_t before = faults->count;
    int status = contact_case_read(&study, parameters, faults, err);
    if (status != 0)
        return status == ERROR_INPUT && faults->count > before ? 0 : status;
    contact_case_estimate(&study, estimate);
    contact_case_clear(&study);
    return 0;
}

/* --- what runners share --- */

struct job_shared {
    struct contact_compliances compliances;
};

static void shared_destroy(struct job_shared **out) {
    struct job_shared *shared = *out;
    if (shared == NULL)
        return;
    contact_compliances_clear(&shared->compliances);
    free(shared);
    *out = NULL;
}

static int shared_of(struct job_shared **out, const struct contact_case *study, struct error *err) {
    struct job_shared *shared = array_create(1, sizeof *shared);
    if (shared == NULL)
        return error_memory(err, sizeof *shared, "what runners share");
    int status = contact_compliances_create(&shared->compliances, study, err);
    if (status != 0)
        shared_destroy(&shared);
    *out = shared;
    return status;
}

static int shared_create(struct job_shared **out, const cJSON *parameters, struct error *err) {
    struct contact_case study;
    int status = contact_case_read(&study, parameters, NULL, err);
    if (status != 0)
        return status;
    status = shared_of(out, &study, err);
    contact_case_clear(&study);
    return status;
}

/* --- realisations --- */

struct job_runner {
    struct contact_case study;
    struct random_key key;
    struct generator *generator;
    struct moments moments; /* of the prescribed spectrum */
    struct job_shared *own; /* where none was given */
    struct contact_scene *scene;
    double *z; /* points of the own grid */
};

static void runner_destroy(struct job_runner **out) {
    struct job_runner *runner = *out;
    if (runner == NULL)
        return;
    generator_destroy(&runner->generator);
    contact_scene_destroy(&runner->scene);
    shared_destroy(&runner->own);
    contact_case_clear(&runner->study);
    free(runner->z);
    free(runner);
    *out = NULL;
}

static int runner_fill(struct job_runner *runner, const cJSON *parameters,
                       const struct job_shared *shared, struct error *err) {
    struct contact_case *study = &runner->study;
    const struct grid *grid = &study->surface.grid;
    int status = contact_case_read(study, parameters, NULL, err);
    if (status == 0)
        status = generator_create(&runner->generator, &study->surface.spectrum, grid,
                                  &study->surface.options, err);
    if (status != 0)
        return status;
    modes_moments(generator_modes(runner->generator), &runner->moments);
    if (shared == NULL) {
        status = shared_of(&runner->own, study, err);
        shared = runner->own;
    }
    if (status == 0)
        status = contact_scene_create(&runner->scene, study, &runner->moments, &shared->compliances,
                                      err);
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
    struct job_runner *runner = array_create(1, sizeof *runner);
    if (runner == NULL)
        return error_memory(err, sizeof *runner, "a runner");
    runner->key = (struct random_key){seed, case_number, 0};
    int status = runner_fill(runner, parameters, shared, err);
    if (status != 0)
        runner_destroy(&runner);
    *out = runner;
    return status;
}

/* A block of realisations being run. Whether to stop is asked between and within loads, which
 * may take minutes, as between realisations. */
struct batch {
    struct job_runner *runner;
    const struct job_control *control; /* may be NULL */
    uint64_t done;                     /* realisations */
    struct contact_tally tally;
};

static int is_stopped(void *context) {
    const struct batch *batch = context;
    return block_stopped(batch->control, batch->done);
}

static int realise(void *context, uint64_t realisation, uint64_t done, double *scalars,
                   struct error *err) {
    struct batch *batch = context;
    struct job_runner *runner = batch->runner;
    const struct grid *grid = &runner->study.surface.grid;
    struct surface_report report = {0};
    struct roughness roughness;
    struct moments moments = runner->moments;
    batch->done = done;
    runner->key.realisation = batch->tally.realisation = realisation;
    int status = generator_run(runner->generator, runner->key, runner->z, &report, err);
    if (status == 0 && !surface_case_exact(&runner->study.surface))
        status = roughness_spectral(grid, runner->z, &moments, err);
    if (status == 0)
        status =
            contact_scene_solve(runner->scene, runner->z, &batch->tally, is_stopped, batch, err);
    if (status != 0)
        return error_context(err, "realisation %llu", (unsigned long long)realisation);
    roughness_measure(grid, runner->z, &roughness);
    status = contact_scalars_measure(&batch->tally, &roughness, moments.nayak_alpha, &report,
                                     scalars, err);
    contact_tally_add(&batch->tally);
    return status;
}

static int encode(void *context, unsigned char **data, size_t *size, struct error *err) {
    struct batch *batch = context;
    return contact_tally_encode(&batch->tally, data, size, err);
}

static int run(struct job_runner *runner, uint64_t first, uint64_t count,
               const struct job_control *control, struct block_result *out, struct error *err) {
    struct batch batch = {.runner = runner, .control = control};
    const struct block_work work = {&batch, contact_scalar_count(), contact_scalar_name, realise,
                                    encode};
    int status = contact_tally_create(&batch.tally, &runner->study, err);
    if (status != 0)
        return status;
    status = block_run(&work, first, count, control, out, err);
    contact_tally_clear(&batch.tally);
    return status;
}

/* --- merging --- */

struct job_merger {
    struct contact_case study;
    struct modes *modes;
    struct moments moments;
    struct contact_tally tally; /* of all blocks so far */
    struct realisations realisations;
};

static void merger_destroy(struct job_merger **out) {
    struct job_merger *merger = *out;
    if (merger == NULL)
        return;
    contact_tally_clear(&merger->tally);
    realisations_clear(&merger->realisations);
    modes_destroy(&merger->modes);
    contact_case_clear(&merger->study);
    free(merger);
    *out = NULL;
}

static int merger_create(struct job_merger **out, const cJSON *parameters, struct error *err) {
    struct job_merger *merger = array_create(1, sizeof *merger);
    if (merger == NULL)
        return error_memory(err, sizeof *merger, "a merger");
    const struct surface_case *surface = &merger->study.surface;
    merger->realisations.scalar_count = contact_scalar_count();
    int status = contact_case_read(&merger->study, parameters, NULL, err);
    if (status == 0)
        status = modes_create(&merger->modes, &surface->spectrum, &surface->grid, err);
    if (status == 0) {
        modes_moments(merger->modes, &merger->moments);
        status = contact_tally_create(&merger->tally, &merger->study, err);
    }
    if (status != 0)
        merger_destroy(&merger);
    *out = merger;
    return status;
}

/* Whether the scalars, the tally and the notes of a block tell of the same realisations. */
static int check_block(const struct block_result *result, const struct contact_tally *tally,
                       struct error *err) {
    const struct contact_case *study = tally->study;
    double scalars = 0, tallied = 0;
    for (uint64_t r = 0; r < result->count; r++)
        scalars += result->scalars[r * result->scalar_count + CONTACT_SCALAR_ITERATIONS];
    for (size_t k = 0; k < study->load_count; k++)
        tallied += contact_tally_total(tally, MEASURE_ITERATIONS,
                                       contact_case_cell(study, 0, study->level_count - 1, k));
    bool within = true;
    for (size_t n = 0; n < notes_kept(&tally->notes); n++)
        within = within && tally->notes.kept[n].realisation - result->first < result->count;
    if (tally->realisations != result->count || !(scalars == tallied) || !within)
        return error_set(err, ERROR_INPUT,
                         "the partial result does not belong to the scalars beside it");
    return 0;
}

/* Decodes a block that the merger could take; *tally is the caller's to clear, also on failure. */
static int read_block(const struct job_merger *merger, const struct block_result *result,
                      struct contact_tally *tally, struct error *err) {
    *tally = (struct contact_tally){0};
    int status = realisations_check(&merger->realisations, result, err);
    if (status == 0)
        status = contact_tally_create(tally, &merger->study, err);
    if (status == 0)
        status = contact_tally_decode(tally, result->data, result->size, err);
    return status ? status : check_block(result, tally, err);
}

static int fits(const struct job_merger *merger, const struct block_result *result,
                struct error *err) {
    struct contact_tally tally;
    int status = read_block(merger, result, &tally, err);
    contact_tally_clear(&tally);
    return status;
}

static int merge(struct job_merger *merger, const struct block_result *result, struct error *err) {
    struct contact_tally tally;
    int status = read_block(merger, result, &tally, err);
    if (status == 0)
        status = realisations_add(&merger->realisations, result, err);
    if (status == 0)
        contact_tally_merge(&merger->tally, &tally);
    contact_tally_clear(&tally);
    return status;
}

static int curves(struct job_merger *merger, cJSON **out, struct error *err) {
    cJSON *scalars = NULL, *list = NULL;
    int status = contact_scalars_json(&merger->study, &merger->moments, &merger->realisations,
                                      &scalars, err);
    if (status == 0)
        status = contact_curves(&merger->study, merger->modes, &merger->moments, &merger->tally,
                                &list, err);
    if (status != 0) {
        cJSON_Delete(scalars);
        return status;
    }
    return case_document(merger->realisations.count, scalars, list, &merger->tally.notes, out, err);
}

/* --- a mesh to look at --- */

/* The first model that has one writes it. */
static int write_case_mesh(const char *path, const struct contact_case *study, const double *z,
                           double pressure, struct error *err) {
    for (size_t m = 0; m < study->model_count; m++)
        if (study->models[m]->write_mesh != NULL)
            return study->models[m]->write_mesh(path, study, m, z, pressure, err);
    size_t t = 0;
    while (CONTACT_MODELS[t] != NULL && CONTACT_MODELS[t]->write_mesh == NULL)
        t++;
    return error_set(err, ERROR_INPUT, "--mesh needs \"%s\" among /contact/model",
                     CONTACT_MODELS[t] != NULL ? CONTACT_MODELS[t]->name : "a model with a mesh");
}

static int write_mesh(const char *path, const cJSON *parameters, const double *z, double pressure,
                      struct error *err) {
    struct contact_case study;
    int status = contact_case_read(&study, parameters, NULL, err);
    if (status != 0)
        return status;
    status = write_case_mesh(path, &study, z, pressure, err);
    contact_case_clear(&study);
    return status;
}

const struct job_kind CONTACT_KIND = {
    .name = "contact",
    .tables = CONTACT_TABLES,
    .default_realisations = 20,
    .scalar = contact_scalar_name,
    .view = &CONTACT_VIEW,
    .check = check,
    .shared_create = shared_create,
    .shared_destroy = shared_destroy,
    .runner_create = runner_create,
    .runner_destroy = runner_destroy,
    .run = run,
    .merger_create = merger_create,
    .merger_destroy = merger_destroy,
    .fits = fits,
    .merge = merge,
    .curves = curves,
    .write_mesh = write_mesh,
};
