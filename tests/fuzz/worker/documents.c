/* Studies that are drawn as whole documents, for every kind: one that is taken has cases of finite
 * cost; one that is refused says where and why, each of its faults. */
#include "jobs/kind.h"
#include "schema/json/json.h"
#include "schema/study/study_reader.h"
#include "tests/support/fuzz/draw_study.h"
#include "tests/support/fuzz/fuzz.h"
#include <math.h>

static const double MEMORY = 1e9; /* bytes: what a machine may have */
enum { CASES_MOST = 2 };          /* of a study that are read: the others are like them */

static int stop(void *context) {
    int *cases = context;
    return (*cases)++ >= CASES_MOST;
}

/* A text in which a name stands twice is no JSON, and has no faults of its own. */
static bool is_json(const char *text) {
    cJSON *document = NULL;
    bool json = json_parse(text, strlen(text), NULL, &document, &(struct error){0}) == 0;
    cJSON_Delete(document);
    return json;
}

static void check_faults(const char *text, const struct fault_list *faults,
                         const struct error *err) {
    MUST(*err->text != '\0' && (faults->count > 0) == is_json(text));
    for (size_t a = 0; a < faults->count && a < FAULTS_KEPT; a++) {
        const struct fault *fault = &faults->faults[a];
        MUST(fault->pointer != NULL && (*fault->pointer == '/' || *fault->pointer == '\0'));
        MUST(fault->detail != NULL && *fault->detail != '\0');
    }
}

static void check_case(const struct study_case *one) {
    const struct study_cost *cost = &one->cost;
    MUST(cost->nx > 0 && cost->ny > 0 && one->block > 0);
    MUST(isfinite(cost->seconds) && cost->seconds >= 0);
    MUST(cost->memory_bytes > 0 && (one->component_count > 0 || cost->memory_bytes <= MEMORY));
    MUST(cost->relative_error >= 0);
    for (size_t a = 0; a < one->component_count; a++)
        check_case(&one->components[a]);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    struct choices choices = {data, size};
    char *text = draw_study(&choices, JOB_KINDS);
    int cases = 0;
    const struct study_reading reading = {
        .kinds = JOB_KINDS, .memory_limit = MEMORY, .stop = stop, .stop_context = &cases};
    struct fault_list faults = {0};
    struct study *study = NULL;
    struct error err = {0};
    int status = study_read_ext(&study, text, strlen(text), &reading, &faults, &err);
    MUST(status == 0 || status == ERROR_INPUT || status == ERROR_STOPPED);
    MUST((status == 0) == (study != NULL));
    if (status == 0)
        MUST(faults.count == 0 && study->case_count > 0);
    else if (status == ERROR_INPUT)
        check_faults(text, &faults, &err);
    for (size_t c = 0; status == 0 && c < study->case_count; c++)
        check_case(&study->cases[c]);
    study_destroy(&study);
    fault_list_clear(&faults);
    free(text);
    return 0;
}
