#include "jobs/block.h"

bool block_stopped(const struct job_control *control, uint64_t done) {
    return control != NULL && control->poll != NULL && control->poll(control->context, done) != 0;
}

/* Into room of the result's size. */
static int realise_all(const struct block_work *work, const struct job_control *control,
                       const struct block_result *result, double *scalars, struct error *err) {
    for (uint64_t r = 0; r < result->count; r++) {
        if (block_stopped(control, r))
            return error_set(err, ERROR_STOPPED, "stopped after %llu of %llu realisations",
                             (unsigned long long)r, (unsigned long long)result->count);
        int status = work->realise(work->context, result->first + r, r,
                                   scalars + r * work->scalar_count, err);
        if (status != 0)
            return status;
    }
    return 0;
}

static int block_fill(const struct block_work *work, const struct job_control *control,
                      struct block_result *result, struct error *err) {
    size_t row = work->scalar_count * sizeof(double);
    const char **names = array_create(work->scalar_count, sizeof *names);
    double *scalars = array_create((size_t)result->count, row);
    unsigned char *data = NULL;
    result->names = names;
    result->scalars = scalars;
    if (names == NULL || scalars == NULL)
        return error_memory(err, (size_t)result->count * row, "scalars");
    for (size_t a = 0; a < work->scalar_count; a++)
        names[a] = work->scalar(a);
    int status = realise_all(work, control, result, scalars, err);
    if (status == 0)
        status = work->encode(work->context, &data, &result->size, err);
    result->data = data;
    return status;
}

int block_run(const struct block_work *work, uint64_t first, uint64_t count,
              const struct job_control *control, struct block_result *out, struct error *err) {
    double start = job_clock();
    struct block_result result = {
        .first = first, .count = count, .scalar_count = work->scalar_count};
    if (count == 0 || count > UINT64_MAX - first)
        return error_set(err, ERROR_INPUT, "a block needs at least one realisation");
    int status = block_fill(work, control, &result, err);
    if (status != 0) {
        block_result_clear(&result);
        return status;
    }
    result.seconds = job_clock() - start;
    *out = result;
    return 0;
}
