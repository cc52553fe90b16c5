#include "jobs/runner.h"
#include "jobs/clock.h"
#include "jobs/partial.h"
#include "jobs/surface/surface_case.h"
#include <math.h>
#include <stdlib.h>

/* --- what runners share --- */

struct job_shared {
    const struct job_kind *kind;
    void *content; /* owned */
};

static int shared_make(struct job_shared **out, const struct job_kind *kind, const void *study,
                       struct error *err) {
    struct job_shared *shared = array_create(1, sizeof *shared);
    if (shared == NULL)
        return error_memory(err, sizeof *shared, "what runners share");
    shared->kind = kind;
    shared->content = array_create(1, kind->shared_size);
    int status = shared->content != NULL
                     ? kind->shared_create(shared->content, study, err)
                     : error_memory(err, kind->shared_size, "what runners share");
    if (status != 0)
        job_shared_destroy(&shared);
    *out = shared;
    return status;
}

int job_shared_create(struct job_shared **out, const struct job_kind *kind, const cJSON *parameters,
                      struct error *err) {
    void *study = NULL;
    *out = NULL;
    if (kind->shared_create == NULL)
        return 0;
    int status = kind_case_create(&study, kind, parameters, NULL, err);
    if (status != 0)
        return status;
    status = shared_make(out, kind, study, err);
    kind_case_destroy(kind, &study);
    return status;
}

void job_shared_destroy(struct job_shared **shared) {
    if (*shared == NULL)
        return;
    if ((*shared)->content != NULL)
        (*shared)->kind->shared_clear((*shared)->content);
    free((*shared)->content);
    free(*shared);
    *shared = NULL;
}

const void *job_shared_content(const struct job_shared *shared) {
    return shared->content;
}

/* --- a runner --- */

struct job_runner {
    const struct job_kind *kind;
    void *study;                        /* owned, as all below: the case */
    const struct surface_case *surface; /* its part; NULL without */
    uint64_t fingerprint;               /* of the case */
    struct random_key key;
    struct generator *generator;
    struct extension *extension; /* of surfaces that hold a patch, in place of it; else NULL */
    struct surface_basis basis;  /* of the generator */
    struct job_shared *own;      /* where none was given */
    void *workspace;
    double *z;         /* points of the own grid */
    double *gaussian;  /* likewise, where the case wants it; else NULL */
    struct team *team; /* borrowed; NULL: none */
};

void runner_destroy(struct job_runner **runner) {
    struct job_runner *gone = *runner;
    if (gone == NULL)
        return;
    if (gone->workspace != NULL)
        gone->kind->workspace_clear(gone->workspace);
    free(gone->workspace);
    free(gone->z);
    free(gone->gaussian);
    job_shared_destroy(&gone->own);
    generator_destroy(&gone->generator);
    extension_destroy(&gone->extension);
    kind_case_destroy(gone->kind, &gone->study);
    free(gone);
    *runner = NULL;
}

int runner_set_team(struct job_runner *runner, struct team *team, struct error *err) {
    runner->team = team;
    if (runner->kind->workspace_set_team == NULL)
        return 0;
    int status = runner->generator != NULL ? generator_set_team(runner->generator, team, err) : 0;
    return status != 0 ? status : runner->kind->workspace_set_team(runner->workspace, team, err);
}

static int surface_make(struct job_runner *runner, struct error *err) {
    const struct surface_case *surface = runner->surface;
    size_t points = grid_points(&surface->grid);
    int status = generator_create(&runner->generator, &surface->spectrum, &surface->grid,
                                  &surface->options, err);
    if (status != 0)
        return status;
    const struct held_patch *held = surface->held;
    if (held != NULL)
        status = extension_create(&runner->extension, &held->map, held->trend, err);
    if (status != 0)
        return status;
    runner->basis.modes = generator_modes(runner->generator);
    modes_moments(runner->basis.modes, &runner->basis.moments);
    runner->z = array_create(points, sizeof *runner->z);
    bool wanted =
        runner->kind->wants_gaussian != NULL && runner->kind->wants_gaussian(runner->study);
    if (wanted)
        runner->gaussian = array_create(points, sizeof *runner->gaussian);
    generator_keep_gaussian(runner->generator, runner->gaussian);
    return runner->z != NULL && (!wanted || runner->gaussian != NULL)
               ? 0
               : error_memory(err, points * sizeof *runner->z, "a surface");
}

static int workspace_make(struct job_runner *runner, const struct job_shared *shared,
                          struct error *err) {
    const struct job_kind *kind = runner->kind;
    if (kind->workspace_create == NULL)
        return 0;
    runner->workspace = array_create(1, kind->workspace_size);
    if (runner->workspace == NULL)
        return error_memory(err, kind->workspace_size, "a workspace");
    return kind->workspace_create(runner->workspace, runner->study, &runner->basis,
                                  shared != NULL ? shared->content : NULL, err);
}

static int runner_fill(struct job_runner *runner, const cJSON *parameters,
                       const struct job_shared *shared, struct error *err) {
    const struct job_kind *kind = runner->kind;
    int status = kind_case_create(&runner->study, kind, parameters, NULL, err);
    if (status == 0)
        status = kind_fingerprint(kind, parameters, &runner->fingerprint, err);
    if (status == 0 && kind->surface != NULL) {
        runner->surface = kind->surface(runner->study);
        status = surface_make(runner, err);
    }
    if (status == 0 && shared == NULL && kind->shared_create != NULL) {
        status = shared_make(&runner->own, kind, runner->study, err);
        shared = runner->own;
    }
    return status != 0 ? status : workspace_make(runner, shared, err);
}

int runner_create(struct job_runner **out, const struct job_kind *kind, const cJSON *parameters,
                  const struct job_shared *shared, uint64_t seed, uint64_t sequence,
                  struct error *err) {
    struct job_runner *runner = array_create(1, sizeof *runner);
    if (runner == NULL)
        return error_memory(err, sizeof *runner, "a runner");
    runner->kind = kind;
    runner->key = (struct random_key){seed, sequence, 0};
    int status = runner_fill(runner, parameters, shared, err);
    if (status != 0)
        runner_destroy(&runner);
    *out = runner;
    return status;
}

/* --- a block --- */

/* What a block in progress passes to the call that may stop it. */
struct progress {
    const struct job_control *control; /* may be NULL */
    uint64_t done;
    double share;  /* of the realisation at work, below 1 */
    bool measured; /* that realisation has been passed to the kind, with the tally */
};

static void take_share(void *context, double share) {
    static const double SHARE_MOST = 0.999; /* it has not ended */
    struct progress *progress = context;
    progress->share = share > 0 ? fmin(share, SHARE_MOST) : 0;
}

static int is_stopped(void *context) {
    const struct progress *progress = context;
    const struct job_control *control = progress->control;
    return control != NULL && control->poll != NULL &&
           control->poll(control->context, (double)progress->done + progress->share) != 0;
}

static int surface_measure(const struct job_runner *runner, struct realisation *realisation,
                           struct error *err) {
    const struct surface_case *surface = runner->surface;
    roughness_measure(&surface->grid, runner->z, &realisation->roughness);
    if (realisation->modes == NULL)
        return roughness_spectral(&surface->grid, runner->z, &realisation->moments, err);
    realisation->moments = runner->basis.moments;
    if (!surface_case_exact(surface))
        modes_moments(realisation->modes, &realisation->moments);
    return 0;
}

/* Iterations towards heights may take long: they may be stopped, as the kind may. */
static int surface_generate(struct job_runner *runner, struct realisation *realisation,
                            struct error *err) {
    realisation->z = runner->z;
    realisation->gaussian = runner->gaussian;
    struct extend_result done;
    realisation->report = (struct surface_report){.end = END_DIRECT};
    generator_set_stop(runner->generator, realisation->stop, realisation->stop_context);
    int status =
        runner->extension != NULL
            ? extension_draw(runner->extension, runner->key, runner->z, &done, err)
            : generator_run(runner->generator, runner->key, runner->z, &realisation->report, err);
    if (status != 0)
        return status;
    if (surface_case_band_limited(runner->surface))
        realisation->modes = generator_drawn(runner->generator);
    return runner->kind->measures_roughness ? 0 : surface_measure(runner, realisation, err);
}

static int realise(struct job_runner *runner, uint64_t number, struct progress *progress,
                   void *tally, double *scalars, struct error *err) {
    runner->key.realisation = number;
    struct realisation realisation = {.study = runner->study,
                                      .key = runner->key,
                                      .stop = is_stopped,
                                      .stop_context = progress,
                                      .progress = take_share};
    int status = runner->surface != NULL ? surface_generate(runner, &realisation, err) : 0;
    progress->measured = status == 0;
    if (status == 0)
        status = runner->kind->realise(runner->workspace, &realisation, tally, scalars, err);
    return status != 0 ? error_context(err, "realisation %llu", (unsigned long long)number) : 0;
}

/* Adds a realisation to the tally. A kind that may stop within a realisation adds it to a tally of
 * its own first, so that no part of it is merged. */
static int realise_into(struct job_runner *runner, uint64_t number, struct progress *progress,
                        void *tally, double *scalars, struct error *err) {
    const struct job_kind *kind = runner->kind;
    if (!kind->stops_half_way)
        return realise(runner, number, progress, tally, scalars, err);
    void *one = array_create(1, kind->tally_size);
    if (one == NULL)
        return error_memory(err, kind->tally_size, "a tally");
    int status = kind->tally_create(one, runner->study, &runner->basis, err);
    if (status == 0)
        status = realise(runner, number, progress, one, scalars, err);
    if (status == 0)
        status = kind->merge(tally, one, err);
    kind->tally_clear(one);
    free(one);
    return status;
}

/* Runs the realisations of a block into a result with room for them. After a stop the count of the
 * result is that of the realisations that are done; ERROR_STOPPED where none is. */
static int realise_all(struct job_runner *runner, const struct job_control *control,
                       struct block_result *result, void *tally, double *scalars,
                       struct error *err) {
    struct progress progress = {.control = control};
    bool whole = true; /* the tally is of the realisations that are done */
    int status = 0;
    for (uint64_t r = 0; r < result->count && status == 0; r += status == 0) {
        progress.done = r;
        progress.share = 0;
        if (is_stopped(&progress) != 0) {
            status = error_set(err, ERROR_STOPPED, "stopped after %llu of %llu realisations",
                               (unsigned long long)r, (unsigned long long)result->count);
        } else {
            status = realise_into(runner, result->first + r, &progress, tally,
                                  scalars + r * result->scalar_count, err);
            whole = status == 0 || !progress.measured || runner->kind->stops_half_way;
        }
        progress.done += status == 0;
    }
    if (status == ERROR_STOPPED && whole && progress.done > 0) {
        result->count = progress.done;
        return 0;
    }
    return status;
}

static int block_fill(struct job_runner *runner, const struct job_control *control, void *tally,
                      struct block_result *result, struct error *err) {
    const struct job_kind *kind = runner->kind;
    size_t row = result->scalar_count * sizeof(double);
    const char **names = array_create(result->scalar_count, sizeof *names);
    double *scalars = array_create((size_t)result->count, row);
    unsigned char *data = NULL;
    result->names = names;
    result->scalars = scalars;
    if (names == NULL || scalars == NULL)
        return error_memory(err, (size_t)result->count * row, "scalars");
    for (size_t a = 0; a < result->scalar_count; a++)
        names[a] = kind->scalar(a);
    int status = realise_all(runner, control, result, tally, scalars, err);
    if (status == 0)
        status = partial_encode(kind, runner->fingerprint, tally, &data, &result->size, err);
    result->data = data;
    return status;
}

/* Returns the processor time so far of this thread and of those that share its realisations. */
static double cpu_seconds(const struct job_runner *runner) {
    return clock_seconds(CLOCK_THREAD_CPUTIME_ID) + team_cpu_seconds(runner->team);
}

int runner_run(struct job_runner *runner, uint64_t first, uint64_t count,
               const struct job_control *control, struct block_result *out, struct error *err) {
    const struct job_kind *kind = runner->kind;
    double start = clock_seconds(CLOCK_MONOTONIC);
    double cpu_start = cpu_seconds(runner);
    struct block_result result = {
        .first = first, .count = count, .scalar_count = kind_scalar_count(kind)};
    if (count == 0)
        return error_set(err, ERROR_INPUT, "a block needs at least one realisation");
    if (count > UINT64_MAX - first)
        return error_set(
            err, ERROR_INPUT,
            "a block of %llu realisations from number %llu on: numbers are below 2^64 - 1",
            (unsigned long long)count, (unsigned long long)first);
    void *tally = array_create(1, kind->tally_size);
    if (tally == NULL)
        return error_memory(err, kind->tally_size, "a tally");
    int status = kind->tally_create(tally, runner->study, &runner->basis, err);
    if (status == 0)
        status = block_fill(runner, control, tally, &result, err);
    kind->tally_clear(tally);
    free(tally);
    if (status != 0) {
        block_result_clear(&result);
        return status;
    }
    result.seconds = clock_seconds(CLOCK_MONOTONIC) - start;
    result.cpu_seconds = cpu_seconds(runner) - cpu_start;
    *out = result;
    return 0;
}
