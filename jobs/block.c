#include "jobs/block.h"

bool block_stopped(const struct job_control *control, uint64_t done) {
    return control != NULL && control->poll != NULL && control->poll(control->context, done) != 0;
}

static int realise_all(const struct block_work *work, const struct job_control *control,
                       struct job_result *result, struct error *err) {
    for (uint64_t r = 0; r < result->count; r++) {
        if (block_stopped(control, r))
            return error_set(err, ERROR_STOPPED, "stopped after %llu of %llu realisations",
                             (unsigned long long)r, (unsigned long long)result->count);
        int status = work->realise(work->context, result->first + r, r,
                                   result->scalars + r * work->scalar_count, err);
        if (status != 0)
            return status;
    }
    return work->encode(work->context, &result->data, &result->size, err);
}

int block_run(const struct block_work *work, uint64_t first, uint64_t count,
              const struct job_control *control, struct job_result *out, struct error *err) {
    double start = job_clock();
    struct job_result result = {.first = first, .count = count, .scalar_count = work->scalar_count};
    if (count == 0 || count > UINT64_MAX - first)
        return error_set(err, ERROR_INPUT, "a block needs at least one realisation");
    size_t row = work->scalar_count * sizeof(double);
    result.scalars = array_create((size_t)count, row);
    if (result.scalars == NULL)
        return error_memory(err, (size_t)count * row, "scalars");
    int status = realise_all(work, control, &result, err);
    if (status != 0) {
        job_result_clear(&result);
        return status;
    }
    result.seconds = job_clock() - start;
    *out = result;
    return 0;
}
