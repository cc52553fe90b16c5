#include "worker/case_merge.h"

struct merging {
    const struct job_kind *kind;
    struct job_merger *merger;
};

static int merge_block(void *context, const struct block_result *block, struct error *err) {
    const struct merging *merging = context;
    int status = kind_check_names(merging->kind, block, err); /* of an older program: others */
    return status != 0 ? status : merger_add(merging->merger, block, err);
}

/* More may have come in since the case was asked for; fewer are a loss. */
static int check_count(const struct job_merger *merger, const struct case_info *info,
                       struct error *err) {
    uint64_t count = 0;
    (void)merger_tally(merger, &count);
    if (count >= info->realisations_done)
        return 0;
    return error_set(err, ERROR_INPUT,
                     "%llu realisations are counted as done, and the results stored are of %llu; "
                     "rugo repair computes what is missing",
                     (unsigned long long)info->realisations_done, (unsigned long long)count);
}

int case_merge(struct store *store, const struct job_kind *kind, const char *study,
               uint64_t case_number, const struct case_info *info, struct job_merger **out,
               struct error *err) {
    struct merging merging = {.kind = kind};
    int status = merger_create(&merging.merger, kind, info->parameters, err);
    if (status == 0)
        status = store_results(store, study, case_number, merge_block, &merging, err);
    if (status == 0)
        status = check_count(merging.merger, info, err);
    if (status != 0)
        merger_destroy(&merging.merger);
    *out = merging.merger;
    return status;
}
