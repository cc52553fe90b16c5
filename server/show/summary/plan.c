#include "server/show/summary/plan.h"
#include "jobs/kind.h"
#include "jobs/target.h"
#include "schema/json/field.h"
#include "schema/study/study_reader.h"
#include <gsl/gsl_cdf.h>
#include <math.h>
#include <stdio.h>

/* Nine in ten lie between these quantiles. What all realisations take is known within this factor,
 * and what only some take in the mean to this part. There is a range where what only some take is,
 * at most, above RARE_LEAST of the rest. */
static const double LOW = 0.05, HIGH = 0.95, USUAL_FACTOR = 1.5, RARE_PART = 0.5, RARE_LEAST = 0.3;

double plan_case_seconds(const struct study_case *one) {
    uint64_t expected[TARGET_PARTS_MOST];
    double count = (double)one->realisations;
    double seconds =
        one->component_count > 0 ? target_expect(one, expected) : one->cost.seconds * count;
    for (uint64_t r = 0; r < STUDY_EARLY && r < one->realisations; r++)
        seconds += one->cost.early_seconds[r];
    return seconds + one->cost.case_seconds;
}

/* What is taken, and of this what only some realisations take: in the mean, its variance, and at
 * most. */
struct taken {
    double seconds, rare, variance, most;
};

static void add_runs(struct taken *taken, const struct study_cost *cost, double count) {
    if (!(count > 0))
        return; /* none of what may have no limit */
    taken->rare += count * cost->rare_seconds;
    taken->variance += count * cost->rare_variance;
    taken->most += count * cost->rare_most;
}

static struct taken taken_by(const struct study_case *one) {
    struct taken taken = {.seconds = plan_case_seconds(one)};
    uint64_t expected[TARGET_PARTS_MOST];
    if (one->component_count == 0)
        add_runs(&taken, &one->cost, (double)one->realisations);
    else
        (void)target_expect(one, expected);
    for (size_t a = 0; a < one->component_count; a++)
        add_runs(&taken, &one->components[a].cost, (double)expected[a]);
    return taken;
}

/* Returns a quantile of a gamma distribution; 0 where it is below 1e-6 of the mean, where GSL finds
 * none. */
static double gamma_quantile(double mean, double variance, double share) {
    static const double LEAST = -15; /* logarithm of (quantile over scale), about */
    const double shape = mean * mean / variance;
    return log(share) / shape > LEAST ? gsl_cdf_gamma_Pinv(share, shape, variance / mean) : 0;
}

/* FORMULAS.md, F17.4. */
static struct plan_range range_of(const struct taken *taken) {
    const double usual = fmax(0, taken->seconds - taken->rare), rare = taken->rare;
    const double variance = taken->variance + RARE_PART * RARE_PART * rare * rare;
    if (!(rare > 0))
        return (struct plan_range){NAN, NAN};
    const double most = fmin(gamma_quantile(rare, variance, HIGH), taken->most);
    if (most < RARE_LEAST * usual)
        return (struct plan_range){NAN, NAN};
    return (struct plan_range){usual / USUAL_FACTOR + gamma_quantile(rare, variance, LOW),
                               usual * USUAL_FACTOR + most};
}

struct plan_range plan_case_range(const struct study_case *one) {
    const struct taken taken = taken_by(one);
    return range_of(&taken);
}

struct plan_range plan_range(const struct study *study) {
    struct taken all = {0};
    for (size_t c = 0; c < study->case_count; c++) {
        const struct taken taken = taken_by(&study->cases[c]);
        all.seconds += taken.seconds;
        all.rare += taken.rare;
        all.variance += taken.variance;
        all.most += taken.most;
    }
    return range_of(&all);
}

double plan_case_error(const struct study_case *one) {
    const cJSON *asked = json_at(one->parameters, "/target/error");
    return one->component_count > 0 && asked != NULL
               ? asked->valuedouble
               : one->cost.relative_error / sqrt((double)one->realisations);
}

double plan_case_tolerance(const struct study_case *one) {
    return one->component_count > 0 ? one->components->cost.tolerance : one->cost.tolerance;
}

/* Realisations a job, as estimated. */
static uint64_t block_of(const struct study_case *one) {
    return study_block(one->realisations, one->cost.seconds, one->block);
}

uint64_t plan_case_jobs(const struct study_case *one) {
    uint64_t block = block_of(one);
    uint64_t jobs = one->component_count > 0 ? 0 : (one->realisations + block - 1) / block;
    for (size_t a = 0; a < one->component_count; a++)
        jobs += plan_case_jobs(&one->components[a]);
    return jobs;
}

/* Bytes of a worker, by the largest of what runs. */
double plan_case_bytes(const struct study_case *one) {
    double most = one->component_count > 0 ? 0 : one->cost.memory_bytes;
    for (size_t a = 0; a < one->component_count; a++)
        most = fmax(most, one->components[a].cost.memory_bytes);
    return most;
}

double plan_seconds(const struct study *study) {
    double sum = 0;
    for (size_t c = 0; c < study->case_count; c++)
        sum += plan_case_seconds(&study->cases[c]);
    return sum;
}

double plan_bytes(const struct study *study) {
    double most = 0;
    for (size_t c = 0; c < study->case_count; c++)
        most = fmax(most, plan_case_bytes(&study->cases[c]));
    return most;
}

struct study_kept plan_kept(const struct study *study) {
    struct study_kept sum = {.path = NULL};
    for (size_t c = 0; c < study->case_count; c++) {
        const struct study_kept *kept = &study->cases[c].cost.kept;
        sum.path = kept->path != NULL ? kept->path : sum.path;
        sum.past = kept->past > sum.past ? kept->past : sum.past;
        sum.seconds += kept->seconds;
        sum.bytes += kept->bytes;
    }
    return sum;
}

/* --- JSON --- */

/* Adds the plan of a case that asks for an error. */
static bool put_components(cJSON *document, const struct study_case *one) {
    uint64_t expected[TARGET_PARTS_MOST];
    if (one->component_count == 0)
        return true;
    cJSON *list = cJSON_AddArrayToObject(document, "components");
    (void)target_expect(one, expected);
    bool complete = list != NULL;
    for (size_t a = 0; a < one->component_count && complete; a++) {
        const struct study_case *component = &one->components[a];
        cJSON *entry = list_put_object(list);
        complete = entry != NULL && field_put_text(entry, "role", component->role) &&
                   field_put(entry, "parameters", cJSON_Duplicate(component->parameters, true)) &&
                   field_put_count(entry, "realisations", component->realisations) &&
                   field_put_count(entry, "expected", expected[a]) &&
                   field_put(entry, "seconds", json_number(component->cost.seconds));
    }
    return complete;
}

/* Adds what is known of the law of heights; nothing where there is none. */
static bool put_law(cJSON *document, const struct study_cost *cost) {
    if (!(cost->law_outside > 0))
        return true;
    return field_put(document, "law_outside", json_number(cost->law_outside)) &&
           field_put(document, "law_misfit", json_number(cost->law_misfit));
}

/* Adds what only some studies have: the depth of the fine zone, and what is known of surfaces. */
static bool put_own(cJSON *document, const struct study_case *one) {
    const struct study_cost *cost = &one->cost;
    const struct {
        const char *key;
        double number;
    } list[] = {{"fine_height", cost->fine_height},
                {"tolerance", plan_case_tolerance(one)},
                {"wavelength_ratio", cost->wavelength_ratio},
                {"hurst", cost->hurst},
                {"skewness", cost->skewness},
                {"kurtosis", cost->kurtosis != KURTOSIS_GAUSSIAN ? cost->kurtosis : 0}};
    bool complete = true;
    for (size_t a = 0; a < sizeof list / sizeof *list && complete; a++)
        complete =
            list[a].number == 0 || field_put(document, list[a].key, json_number(list[a].number));
    return complete;
}

/* Adds what files of nodes take; nothing where there are none. */
static bool put_kept(cJSON *document, const struct study_kept *kept) {
    return kept->path == NULL || (field_put(document, "kept_bytes", json_number(kept->bytes)) &&
                                  field_put(document, "kept_seconds", json_number(kept->seconds)));
}

/* Adds between what the seconds lie; nothing where they are as estimated. */
static bool put_range(cJSON *document, struct plan_range range) {
    return isnan(range.most) || (field_put(document, "seconds_least", json_number(range.least)) &&
                                 field_put(document, "seconds_most", json_number(range.most)));
}

static cJSON *case_document(const struct study *study, size_t c) {
    const struct study_case *one = &study->cases[c];
    cJSON *document = cJSON_CreateObject();
    bool complete =
        document != NULL && field_put(document, "case", cJSON_CreateNumber((double)c)) &&
        field_put(document, "parameters", cJSON_Duplicate(one->parameters, true)) &&
        field_put(document, "nx", cJSON_CreateNumber((double)one->cost.nx)) &&
        field_put(document, "ny", cJSON_CreateNumber((double)one->cost.ny)) &&
        field_put(document, "memory_bytes", json_number(plan_case_bytes(one))) &&
        field_put(document, "block", cJSON_CreateNumber((double)block_of(one))) &&
        field_put(document, "seconds", json_number(plan_case_seconds(&study->cases[c]))) &&
        put_range(document, plan_case_range(&study->cases[c])) &&
        field_put(document, "relative_error", json_number(plan_case_error(&study->cases[c]))) &&
        put_law(document, &one->cost) && put_own(document, one) &&
        put_kept(document, &one->cost.kept) && put_components(document, &study->cases[c]);
    return fields_finish(document, complete);
}

cJSON *plan_document(const struct study *study) {
    cJSON *document = cJSON_CreateObject();
    char seed[24];
    snprintf(seed, sizeof seed, "%llu", (unsigned long long)study->seed);
    bool complete =
        document != NULL && field_put(document, "name", cJSON_CreateString(study->name)) &&
        field_put(document, "kind", cJSON_CreateString(study->kind->name)) &&
        field_put(document, "seed", cJSON_CreateString(seed)) &&
        field_put(document, "random",
                  cJSON_CreateString(choice_name(STUDY_RANDOM, (int)study->random))) &&
        field_put(document, "realisations", cJSON_CreateNumber((double)study->realisations)) &&
        field_put(document, "seconds", json_number(plan_seconds(study))) &&
        put_range(document, plan_range(study)) &&
        field_put(document, "memory_bytes", json_number(plan_bytes(study))) &&
        field_put(document, "cases", cJSON_CreateArray());
    cJSON *cases = cJSON_GetObjectItemCaseSensitive(document, "cases");
    for (size_t c = 0; complete && c < study->case_count; c++)
        complete = list_put(cases, case_document(study, c));
    return fields_finish(document, complete);
}
