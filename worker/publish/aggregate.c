#include "worker/publish/aggregate.h"
#include "core/file/memory_file.h"
#include "jobs/merger.h"
#include "jobs/realisations.h"
#include "jobs/units.h"
#include "schema/near_name.h"
#include "schema/result/result_json.h"
#include "schema/store/store.h"
#include "schema/study/sweep.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* --- values of single realisations at the points of published curves --- */

/* Prints commas and nulls for the realisations that are missing before one. */
static void skip_realisations(FILE *file, uint64_t *next, uint64_t number) {
    for (; *next < number; ++*next)
        fputs(*next > 0 ? ",null" : "null", file);
    if (*next > 0)
        fputc(',', file);
    ++*next;
}

/* Ten digits show which realisation is extreme; the block has all digits. */
static void print_values(FILE *file, const struct realisations *set,
                         const struct point_values *values) {
    uint64_t next = 0;
    size_t row = 0;
    fputc('[', file);
    for (size_t b = 0; b < set->block_count; b++)
        for (uint64_t r = 0; r < set->blocks[b].count; r++, row++) {
            double value = values->values[row * values->stride];
            skip_realisations(file, &next, set->blocks[b].first + r);
            if (isfinite(value))
                fprintf(file, "%.10g", value);
            else
                fputs("null", file);
        }
    fputc(']', file);
}

static int make_text(const void *context, const struct curve *curve, size_t at, char **out,
                     struct error *err) {
    const struct job_merger *merger = context;
    struct point_values values;
    struct memory_file memory;
    *out = NULL;
    if (!merger_point(merger, curve, at, &values))
        return 0;
    if (memory_file_open(&memory)) {
        print_values(memory.file, merger_realisations(merger), &values);
        *out = memory_file_close(&memory, NULL);
    }
    return *out != NULL ? 0 : error_memory(err, 0, "values of realisations");
}

struct point_texts realisation_values(const struct job_merger *merger) {
    return (struct point_texts){merger, make_text};
}

/* --- merging of the stored blocks of a case --- */

struct merging {
    const struct job_kind *kind;
    struct job_merger *merger;
};

static int merge_block(void *context, const struct block_result *block, struct error *err) {
    const struct merging *merging = context;
    int status = kind_check_names(merging->kind, block, err); /* older programs had others */
    return status != 0 ? status : merger_add(merging->merger, block, err);
}

/* More realisations may have come in since info was read; fewer are a loss. */
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

/* Merges all stored blocks of the case with this info in the order of their realisations. *out,
 * NULL on failure, is the caller's to destroy. ERROR_INPUT for blocks that cannot be merged, such
 * as damaged ones or those of an older program, and where there are fewer realisations than the
 * case counts. */
static int case_merge(struct store *store, const struct job_kind *kind, const char *study,
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

/* Cases that ask for an error: merges their components into an answer, and plans rounds. */

/* A case with components, as the store has it. */
struct target_case {
    const struct job_kind *kind;
    const char *study;
    uint64_t case_number;
    const struct case_info *info;
    size_t count;
    struct component *components; /* owned, by components_free */
};

/* A component that is being merged into the answer. */
struct part {
    struct case_info info;
    struct job_merger *merger;
};

static int part_read(struct store *store, const struct target_case *of, size_t at,
                     struct part *part, struct target_component *out, struct error *err) {
    const struct component *component = &of->components[at];
    int status = store_any_case(store, of->study, component->number, &part->info, err);
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

/* Merges what the components have into an empty result. wanted has room for count numbers: the
 * realisations that each component is to have in all. */
static int target_answer(struct store *store, const struct target_case *of, uint64_t *wanted,
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
    result_sampled(out, out->realisations);
    if (status != 0)
        result_clear(out);
    parts_clear(parts, of->count);
    free(components);
    return status;
}

/* Returns whether every realisation that was asked for is there. After failed or cancelled jobs
 * there is no next round, and the answer is computed from what there is. */
static bool is_whole(const struct target_case *of) {
    uint64_t asked = 0;
    for (size_t a = 0; a < of->count; a++)
        asked += of->components[a].realisations;
    return of->info->realisations_done == asked;
}

/* Does the same after all jobs of the components have ended, and queues what is missing. *grown:
 * something was queued; then the case is not to be published yet, and out is cleared. */
static int target_round(struct store *store, const struct target_case *of, struct case_result *out,
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

/* --- merging --- */

int aggregate_merge(struct store *store, const struct aggregate *aggregate, uint64_t case_number,
                    const struct case_info *info, struct job_merger **out,
                    struct case_result *result, struct error *err) {
    int status =
        case_merge(store, aggregate->kind, aggregate->about.id, case_number, info, out, err);
    if (status == 0)
        status = merger_result(*out, result, err);
    if (status != 0) {
        merger_destroy(out);
        return error_context(err, "case %llu", (unsigned long long)case_number);
    }
    return 0;
}

static int merge_case(struct store *store, const struct aggregate *aggregate, uint64_t case_number,
                      const struct case_info *info, struct case_result *out, struct error *err) {
    struct job_merger *merger = NULL;
    int status = aggregate_merge(store, aggregate, case_number, info, &merger, out, err);
    merger_destroy(&merger);
    return status;
}

/* Merges the answer of a case that asks for an error from its components; *found is false where it
 * has none. grown as in target_round; NULL: the answer alone. */
static int answer_case(struct store *store, const struct aggregate *aggregate, uint64_t case_number,
                       const struct case_info *info, struct case_result *out, bool *found,
                       bool *grown, struct error *err) {
    struct target_case of = {.kind = aggregate->kind,
                             .study = aggregate->about.id,
                             .case_number = case_number,
                             .info = info};
    *found = false;
    if (aggregate->kind->answer == NULL || aggregate->about.realisations > 0)
        return 0;
    int status = store_components(store, of.study, case_number, &of.components, &of.count, err);
    if (status != 0 || of.count == 0)
        return status;
    *found = true;
    uint64_t *wanted = array_create(of.count, sizeof *wanted);
    if (wanted == NULL)
        status = error_memory(err, of.count * sizeof *wanted, "components");
    else if (grown != NULL)
        status = target_round(store, &of, out, grown, err);
    else
        status = target_answer(store, &of, wanted, out, err);
    free(wanted);
    components_free(of.components, of.count);
    return status;
}

/* --- a study --- */

int aggregate_begin(struct store *store, const char *study, struct aggregate *out,
                    struct error *err) {
    struct aggregate found = {0};
    int status = store_status_counted(store, study, &found.about, err);
    if (status != 0)
        return status;
    found.kind = kind_find(found.about.kind);
    if (found.kind == NULL) {
        status =
            error_set(err, ERROR_INPUT, "this program knows no kind '%.64s'", found.about.kind);
        aggregate_end(&found);
        return status;
    }
    *out = found;
    return 0;
}

void aggregate_end(struct aggregate *aggregate) {
    study_status_clear(&aggregate->about);
    aggregate->kind = NULL;
}

/* --- a case --- */

/* Merges a case that is not published at this revision. */
static int fresh_result(struct store *store, const struct aggregate *aggregate,
                        uint64_t case_number, const struct case_info *info,
                        const struct published_part *part, struct case_result *out,
                        struct error *err) {
    bool found = false;
    if (info->realisations_done == 0)
        return 0; /* without a merger, since a study may have ten thousand such cases */
    int status = store_published(store, aggregate->about.id, case_number, info->revision, part, out,
                                 &found, err);
    if (status == 0 && !found)
        status = answer_case(store, aggregate, case_number, info, out, &found, NULL, err);
    if (status == 0 && found) /* curves alone do not say of how many they are */
        result_sampled(out, info->realisations_done);
    if (status != 0 || found)
        return status;
    return merge_case(store, aggregate, case_number, info, out, err);
}

/* Merges as fresh_result does. Where the stored results cannot be read or merged the result has an
 * error, and 0 is returned. */
static int result_or_error(struct store *store, const struct aggregate *aggregate,
                           uint64_t case_number, const struct case_info *info,
                           const struct published_part *part, struct case_result *out,
                           struct error *err) {
    struct error reason = {0};
    int status = fresh_result(store, aggregate, case_number, info, part, out, &reason);
    if (status == 0)
        return 0;
    if (!publish_is_final(status))
        return error_set(err, status, "%s", reason.text);
    result_clear(out); /* merging may have begun to fill it */
    out->realisations = info->realisations_done;
    out->error = result_text(out, reason.text);
    return out->error != NULL ? 0 : error_memory(err, sizeof reason.text, "the fault of a case");
}

static bool has_quantity(const struct case_result *result, const char *quantity) {
    return result_curve(result, quantity) != NULL;
}

int quantity_absent(const struct case_result *result, const char *quantity, struct error *err) {
    char names[256] = "", hint[NEAR_HINT_SIZE];
    struct near_name near = {.typed = quantity};
    if (result_scalar(result, quantity) != NULL)
        return error_set(err, ERROR_INPUT,
                         "%.64s is a scalar, which has no curve: rugo table --columns %.64s (over "
                         "HTTP, /table?columns=%.64s) has it, as have curves of no one quantity",
                         quantity, quantity, quantity);
    for (size_t a = 0; a < result->curve_count; a++) {
        const char *name = result->curves[a].quantity;
        size_t length = strlen(names);
        if (&result->curves[a] == result_curve(result, name)) /* the first of it */
            snprintf(names + length, sizeof names - length, "%s%s", length > 0 ? ", " : "", name);
        near_name_see(&near, name);
    }
    for (size_t s = 0; s < result->scalar_count; s++)
        near_name_see(&near, result->scalars[s].name);
    return error_set(err, ERROR_INPUT, "no quantity '%.64s' in this study%s; it has %s", quantity,
                     near_name_hint(&near, hint), names[0] != '\0' ? names : "none");
}

/* Refuses a quantity that the case does not have. Reads all curves, to name those that it has. */
static int refuse_quantity(struct store *store, const struct aggregate *aggregate,
                           uint64_t case_number, const struct case_info *info, const char *quantity,
                           struct error *err) {
    const struct published_part all = {0};
    struct case_result result = {0};
    int status = fresh_result(store, aggregate, case_number, info, &all, &result, err);
    if (status == 0)
        status = quantity_absent(&result, quantity, err);
    result_clear(&result);
    return status;
}

/* Adds the parameters to a result, leaves what the filter selects, and completes its theories. */
static int finish_result(struct store *store, const struct aggregate *aggregate,
                         uint64_t case_number, const struct result_filter *filter,
                         const struct case_info *info, struct case_result *result,
                         struct error *err) {
    const char *quantity = filter->part.quantity;
    result->case_number = case_number;
    result_keep(result, quantity, filter->part.scalars_only);
    int status = result_set_parameters(result, info->parameters, err);
    bool begun = info->realisations_done > 0;
    if (status != 0 || result->error != NULL)
        return status;
    if (begun && quantity != NULL && !has_quantity(result, quantity))
        status = refuse_quantity(store, aggregate, case_number, info, quantity, err);
    if (status == 0 && filter->complete)
        status = merger_complete(aggregate->kind, info->parameters, result, err);
    if (status == 0)
        units_set(result);
    return status;
}

int aggregate_case(struct store *store, const struct aggregate *aggregate, uint64_t case_number,
                   const struct result_filter *filter, struct case_result *out, struct error *err) {
    struct case_info info = {0};
    struct case_result result = {0};
    int status = store_case(store, aggregate->about.id, case_number, &info, err);
    if (status != 0)
        return status;
    status = result_or_error(store, aggregate, case_number, &info, &filter->part, &result, err);
    if (status == 0)
        status = finish_result(store, aggregate, case_number, filter, &info, &result, err);
    case_info_clear(&info);
    if (status != 0)
        result_clear(&result);
    else
        *out = result;
    return status;
}

void merged_case_clear(struct merged_case *merged) {
    merger_destroy(&merged->merger);
    result_clear(&merged->result);
    *merged = (struct merged_case){0};
}

int aggregate_prepare(struct store *store, const char *study, uint64_t case_number,
                      struct merged_case *out, struct error *err) {
    struct aggregate aggregate;
    struct case_info info = {0};
    *out = (struct merged_case){.case_number = case_number};
    int status = aggregate_begin(store, study, &aggregate, err);
    if (status != 0) /* an unknown kind is no fault of the case: another program knows it */
        return status == ERROR_INPUT ? (err->code = ERROR_STATE) : status;
    snprintf(out->study, sizeof out->study, "%s", aggregate.about.id);
    status = store_case(store, study, case_number, &info, err);
    out->revision = info.revision;
    bool found = false;
    if (status == 0)
        status = answer_case(store, &aggregate, case_number, &info, &out->result, &found,
                             &out->nothing, err);
    if (status == 0 && !found)
        status =
            aggregate_merge(store, &aggregate, case_number, &info, &out->merger, &out->result, err);
    case_info_clear(&info);
    aggregate_end(&aggregate);
    return status;
}

int aggregate_write(struct store *store, const struct merged_case *merged, struct error *err) {
    if (merged->nothing)
        return 0;
    if (merged->merger == NULL)
        return store_publish(store, merged->study, merged->case_number, merged->revision,
                             &merged->result, err);
    const struct point_texts texts = realisation_values(merged->merger);
    return store_publish_points(store, merged->study, merged->case_number, merged->revision,
                                &merged->result, &texts, err);
}

/* --- reports --- */

static void spend(struct case_report *report, const struct case_cost *cost) {
    case_report_spend(report, &cost->time);
    report->about.case_number = cost->case_number;
    report->about.realisations = cost->realisations_done;
    report->realisations_total = cost->realisations;
    report->jobs = cost->jobs;
    report->attempts = cost->attempts;
}

/* Reads the published report of a case, or makes it now. */
static int read_report(struct store *store, const struct aggregate *aggregate, uint64_t case_number,
                       const struct case_info *info, struct case_report *out, struct error *err) {
    const struct published_part all = {0};
    struct case_result result = {0};
    bool found = false;
    int status = store_published_report(store, aggregate->about.id, case_number, info->revision,
                                        out, &found, err);
    if (status != 0 || found)
        return status;
    status = result_or_error(store, aggregate, case_number, info, &all, &result, err);
    if (status == 0)
        status = case_report_make(out, &result, err);
    result_clear(&result);
    return status;
}

int aggregate_case_report(struct store *store, const struct aggregate *aggregate,
                          uint64_t case_number, struct case_report *out, struct error *err) {
    struct case_info info = {0};
    struct case_cost cost;
    struct case_report report = {0};
    int status = store_cost(store, aggregate->about.id, case_number, &cost, err);
    if (status == 0)
        status = store_case(store, aggregate->about.id, case_number, &info, err);
    if (status != 0)
        return status;
    status = read_report(store, aggregate, case_number, &info, &report, err);
    if (status == 0)
        status = result_set_parameters(&report.about, info.parameters, err);
    case_info_clear(&info);
    if (status != 0) {
        case_report_clear(&report);
        return status;
    }
    spend(&report, &cost);
    *out = report;
    return 0;
}

/* --- whole studies --- */

/* Reads the swept pointers of a study, and its provenance. */
static int read_origin(struct store *store, const struct aggregate *aggregate,
                       struct study_result *out, struct error *err) {
    cJSON *document = NULL;
    int status = store_provenance(store, aggregate->about.id, &out->provenance, err);
    if (status == 0)
        status = store_document(store, aggregate->about.id, &document, err);
    if (status == 0 && (out->swept = sweep_pointers(&aggregate->kind->study, document)) == NULL)
        status = error_memory(err, 0, "the swept parameters of a study");
    cJSON_Delete(document);
    return status;
}

int aggregate_head(struct store *store, const struct aggregate *aggregate, struct study_result *out,
                   struct error *err) {
    const struct study_status *about = &aggregate->about;
    out->id = strdup(about->id);
    out->name = strdup(about->name);
    out->kind = strdup(about->kind);
    out->state = strdup(about->state);
    out->random = strdup(choice_name(STUDY_RANDOM, (int)about->random));
    bool done = out->id != NULL && out->name != NULL && out->kind != NULL && out->state != NULL &&
                out->random != NULL;
    return done ? read_origin(store, aggregate, out, err)
                : error_memory(err, STUDY_ID_SIZE, "the head of a study");
}

int aggregate_refuse(const struct case_result *result, struct error *err) {
    return error_set(err, ERROR_INPUT, "%s", result->error);
}

static int read_cases(struct store *store, const struct aggregate *aggregate,
                      const struct result_filter *filter, struct study_result *study,
                      struct error *err) {
    bool one = filter->case_number >= 0;
    uint64_t first = one ? (uint64_t)filter->case_number : 0;
    uint64_t end = one ? first + 1 : aggregate->about.cases;
    bool answered = false;
    study->cases = array_create((size_t)(end - first), sizeof *study->cases);
    int status = aggregate_head(store, aggregate, study, err);
    if (status == 0 && study->cases == NULL)
        status = error_memory(err, (size_t)(end - first) * sizeof *study->cases, "results");
    for (uint64_t c = first; c < end && status == 0; c++) {
        struct case_result *result = &study->cases[study->case_count];
        status = aggregate_case(store, aggregate, c, filter, result, err);
        study->case_count += status == 0;
        answered = answered || (status == 0 && result->error == NULL);
    }
    if (status == 0 && study->case_count > 0 && !answered)
        status = aggregate_refuse(&study->cases[0], err);
    return status;
}

int aggregate_study(struct store *store, const char *study, const struct result_filter *filter,
                    struct study_result *out, struct error *err) {
    struct aggregate aggregate;
    struct study_result result = {0};
    int status = aggregate_begin(store, study, &aggregate, err);
    if (status != 0)
        return status;
    status = read_cases(store, &aggregate, filter, &result, err);
    aggregate_end(&aggregate);
    if (status != 0)
        study_result_clear(&result);
    else
        *out = result;
    return status;
}

int aggregate_report(struct store *store, const char *study, struct study_report *out,
                     struct error *err) {
    struct aggregate aggregate;
    struct study_report report = {0};
    struct study_result head = {0};
    bool answered = false;
    int status = aggregate_begin(store, study, &aggregate, err);
    if (status != 0)
        return status;
    report.time = aggregate.about.time;
    report.cases = array_create((size_t)aggregate.about.cases, sizeof *report.cases);
    status = aggregate_head(store, &aggregate, &head, err);
    study_report_take_head(&report, &head);
    if (status == 0 && report.cases == NULL)
        status = error_memory(err, (size_t)aggregate.about.cases * sizeof *report.cases, "reports");
    for (uint64_t c = 0; c < aggregate.about.cases && status == 0; c++) {
        struct case_report *one = &report.cases[report.case_count];
        status = aggregate_case_report(store, &aggregate, c, one, err);
        report.case_count += status == 0;
        answered = answered || (status == 0 && one->about.error == NULL);
    }
    if (status == 0 && report.case_count > 0 && !answered)
        status = aggregate_refuse(&report.cases[0].about, err);
    aggregate_end(&aggregate);
    if (status != 0)
        study_report_clear(&report);
    else
        *out = report;
    return status;
}
