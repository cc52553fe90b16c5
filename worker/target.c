#include "worker/target.h"
#include "worker/case_merge.h"
#include <math.h>
#include <stdlib.h>

/* A component on its way into the answer. */
struct part {
    struct case_info info;
    struct job_merger *merger;
};

static int part_read(struct store *store, const struct target_case *of, size_t at,
                     struct part *part, struct target_component *out, struct error *err) {
    const struct component *component = &of->components[at];
    int status = store_case(store, of->study, component->number, &part->info, err);
    if (status == 0)
        status = case_merge(store, of->kind, of->study, component->number, &part->info,
                            &part->merger, err);
    if (status != 0)
        return error_context(err, "component %s", component->role);
    *out = (struct target_component){.role = component->role,
                                     .seconds = component->cost.seconds,
                                     .study = merger_case(part->merger),
                                     .merger = part->merger};
    out->tally = merger_tally(part->merger, &out->done);
    return 0;
}

static void parts_clear(struct part *parts, size_t count) {
    for (size_t a = 0; parts != NULL && a < count; a++) {
        merger_destroy(&parts[a].merger);
        case_info_clear(&parts[a].info);
    }
    free(parts);
}

int target_answer(struct store *store, const struct target_case *of, uint64_t *wanted,
                  struct case_result *out, struct error *err) {
    struct part *parts = array_create(of->count, sizeof *parts);
    struct target_component *components = array_create(of->count, sizeof *components);
    int status = parts != NULL && components != NULL
                     ? 0
                     : error_memory(err, of->count * sizeof *parts, "components");
    for (size_t a = 0; a < of->count && status == 0; a++)
        status = part_read(store, of, a, &parts[a], &components[a], err);
    if (status == 0)
        status = of->kind->answer(of->info->parameters, of->count, components, wanted, out, err);
    out->realisations = 0;
    for (size_t a = 0; a < of->count && status == 0; a++)
        out->realisations += components[a].done;
    if (status != 0)
        result_clear(out);
    parts_clear(parts, of->count);
    free(components);
    return status;
}

/* Whether every realisation that was asked for is there. Where jobs failed or were cancelled there
 * is no next round, and the answer is what there is. */
static bool is_whole(const struct target_case *of) {
    uint64_t asked = 0;
    for (size_t a = 0; a < of->count; a++)
        asked += of->components[a].realisations;
    return of->info->realisations_done == asked;
}

int target_round(struct store *store, const struct target_case *of, struct case_result *out,
                 bool *grown, struct error *err) {
    uint64_t *wanted = array_create(of->count, sizeof *wanted);
    *grown = false;
    if (wanted == NULL)
        return error_memory(err, of->count * sizeof *wanted, "a round");
    int status = target_answer(store, of, wanted, out, err);
    if (status == 0 && is_whole(of)) {
        const struct scalar *reached = result_scalar(out, "error_reached");
        const struct next_round next = {.revision = of->info->revision,
                                        .error_reached =
                                            reached != NULL ? reached->value : (double)NAN,
                                        .wanted = wanted};
        status = store_grow(store, of->study, of->case_number, &next, grown, err);
    }
    if (status != 0 || *grown)
        result_clear(out);
    free(wanted);
    return status;
}
