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

int case_merge(struct store *store, const struct job_kind *kind, const char *study,
               uint64_t case_number, const cJSON *parameters, struct job_merger **out,
               struct error *err) {
    struct merging merging = {.kind = kind};
    int status = merger_create(&merging.merger, kind, parameters, err);
    if (status == 0)
        status = store_results(store, study, case_number, merge_block, &merging, err);
    if (status != 0)
        merger_destroy(&merging.merger);
    *out = merging.merger;
    return status;
}
