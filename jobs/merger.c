#include "jobs/merger.h"
#include "jobs/partial.h"
#include "jobs/realisations.h"
#include "jobs/surface/surface_case.h"
#include <stdlib.h>
#include <string.h>

struct job_merger {
    const struct job_kind *kind;
    void *study;          /* owned, as all below: the case */
    uint64_t fingerprint; /* of the case */
    struct modes *modes;
    struct surface_basis basis;
    void *tally; /* of all blocks so far */
    struct realisations realisations;
};

static void tally_destroy(const struct job_kind *kind, void **tally) {
    if (*tally != NULL)
        kind->tally_clear(*tally);
    free(*tally);
    *tally = NULL;
}

static int tally_make(const struct job_merger *merger, void **out, struct error *err) {
    const struct job_kind *kind = merger->kind;
    void *tally = array_create(1, kind->tally_size);
    if (tally == NULL)
        return error_memory(err, kind->tally_size, "a tally");
    int status = kind->tally_create(tally, merger->study, &merger->basis, err);
    if (status != 0)
        tally_destroy(kind, &tally);
    *out = tally;
    return status;
}

void merger_destroy(struct job_merger **merger) {
    struct job_merger *gone = *merger;
    if (gone == NULL)
        return;
    tally_destroy(gone->kind, &gone->tally);
    realisations_clear(&gone->realisations);
    modes_destroy(&gone->modes);
    kind_case_destroy(gone->kind, &gone->study);
    free(gone);
    *merger = NULL;
}

static int merger_fill(struct job_merger *merger, const cJSON *parameters, struct error *err) {
    const struct job_kind *kind = merger->kind;
    int status = kind_case_create(&merger->study, kind, parameters, NULL, err);
    if (status == 0)
        status = kind_fingerprint(kind, parameters, &merger->fingerprint, err);
    if (status == 0 && kind->surface != NULL) {
        const struct surface_case *surface = kind->surface(merger->study);
        status = modes_create(&merger->modes, &surface->spectrum, &surface->grid, err);
    }
    if (status != 0)
        return status;
    merger->basis.modes = merger->modes;
    if (merger->modes != NULL)
        modes_moments(merger->modes, &merger->basis.moments);
    return tally_make(merger, &merger->tally, err);
}

int merger_create(struct job_merger **out, const struct job_kind *kind, const cJSON *parameters,
                  struct error *err) {
    struct job_merger *merger = array_create(1, sizeof *merger);
    if (merger == NULL)
        return error_memory(err, sizeof *merger, "a merger");
    merger->kind = kind;
    merger->realisations.scalar_count = kind_scalar_count(kind);
    int status = merger_fill(merger, parameters, err);
    if (status != 0)
        merger_destroy(&merger);
    *out = merger;
    return status;
}

/* Decodes a block into a new tally, which the caller destroys; NULL on failure. */
static int block_read(const struct job_merger *merger, const struct block_result *result,
                      void **out, struct error *err) {
    const struct job_kind *kind = merger->kind;
    void *tally = NULL;
    int status = realisations_check(&merger->realisations, result, err);
    if (status == 0)
        status = tally_make(merger, &tally, err);
    if (status == 0)
        status = partial_decode(kind, merger->fingerprint, result->data, result->size, tally, err);
    if (status == 0 && kind->belongs != NULL && !kind->belongs(tally, result))
        status = error_set(err, ERROR_INPUT,
                           "the partial result does not belong to the scalars beside it");
    if (status != 0)
        tally_destroy(kind, &tally);
    *out = tally;
    return status;
}

int merger_fits(const struct job_merger *merger, const struct block_result *result,
                struct error *err) {
    void *tally;
    int status = block_read(merger, result, &tally, err);
    tally_destroy(merger->kind, &tally);
    return status;
}

int merger_add(struct job_merger *merger, const struct block_result *result, struct error *err) {
    void *tally;
    int status = block_read(merger, result, &tally, err);
    if (status == 0)
        status = realisations_add(&merger->realisations, result, err);
    if (status == 0)
        status = merger->kind->merge(merger->tally, tally, err);
    tally_destroy(merger->kind, &tally);
    return status;
}

int merger_result(const struct job_merger *merger, struct case_result *out, struct error *err) {
    out->realisations = merger->realisations.count;
    int status = merger->kind->result(merger->study, &merger->basis, merger->tally,
                                      &merger->realisations, out, err);
    if (status != 0)
        result_clear(out);
    result_sampled(out, out->realisations);
    return status;
}

const void *merger_case(const struct job_merger *merger) {
    return merger->study;
}

const void *merger_tally(const struct job_merger *merger, uint64_t *realisations) {
    *realisations = merger->realisations.count;
    return merger->tally;
}

const struct realisations *merger_realisations(const struct job_merger *merger) {
    return &merger->realisations;
}

bool merger_point(const struct job_merger *merger, const struct curve *curve, size_t at,
                  struct point_values *out) {
    return merger->kind->point_values != NULL &&
           merger->kind->point_values(merger->tally, curve, at, out);
}

bool merger_groups(const struct job_merger *merger, const struct curve *curve, size_t at,
                   struct point_groups *out) {
    return merger->kind->point_groups != NULL &&
           merger->kind->point_groups(merger->tally, curve, at, out);
}

int merger_scalar(const struct job_merger *merger, size_t scalar, double *values, double *weights,
                  struct error *err) {
    const struct realisations *set = &merger->realisations;
    for (uint64_t r = 0; r < set->count; r++)
        weights[r] = 1;
    if (merger->kind->scalar_values != NULL)
        return merger->kind->scalar_values(merger->tally, set, scalar, values, weights, err);
    realisations_column(set, scalar, values);
    return 0;
}

bool merger_find_scalar(const struct job_merger *merger, const char *name, size_t *scalar) {
    const char *other;
    for (size_t a = 0; (other = merger->kind->scalar(a)) != NULL; a++)
        if (strcmp(name, other) == 0) {
            *scalar = a;
            return true;
        }
    return false;
}

static bool is_complete(const struct case_result *result) {
    for (size_t a = 0; a < result->curve_count; a++)
        for (size_t t = 0; t < result->curves[a].theory_count; t++)
            if (result->curves[a].theories[t].y == NULL)
                return false;
    return true;
}

int merger_complete(const struct job_kind *kind, const cJSON *parameters,
                    struct case_result *result, struct error *err) {
    struct job_merger *merger = NULL;
    if (kind->complete == NULL || is_complete(result))
        return 0;
    int status = merger_create(&merger, kind, parameters, err);
    if (status == 0)
        status = kind->complete(merger->study, &merger->basis, result, err);
    merger_destroy(&merger);
    return status;
}
