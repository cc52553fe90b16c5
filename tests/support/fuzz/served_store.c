#include "tests/support/fuzz/served_store.h"
#include "jobs/kind.h"
#include "server/show/table/contents.h"
#include "tests/support/fuzz/fuzz.h"
#include "worker/publish/publish.h"
#include "worker/worker.h"
#include <unistd.h>

/* Those before the broken one end, and those behind it are not run. */
enum { ASKED = 4, BROKEN = 5 };
#define SMALL(kind, more)                                                                          \
    "\"kind\":\"" kind "\",\"seed\":7,\"surface\":{\"dimension\":1,\"wavelength_ratio\":4,"        \
    "\"length_ratio\":2,\"points_per_wavelength\":4," more
#define BINS "\"statistics\":{\"bins\":{\"height\":[-4,4,3],\"curvature\":[-8,0,2]}}"
static const char *const STUDIES[] = {
    "{\"name\":\"flat\",\"kind\":\"statistics\",\"seed\":3,\"realisations\":3,\"surface\":{"
    "\"hurst\":[0.3,0.8],\"wavelength_ratio\":4,\"length_ratio\":2,\"points_per_wavelength\":4}"
    "," BINS "}",
    "{\"name\":\"a profile\",\"realisations\":4," SMALL(
        "statistics", "\"hurst\":0.8,\"heights\":{\"distribution\":[\"gaussian\",\"weibull_max\"],"
                      "\"shape\":2,\"max_iterations\":10}},") BINS "}",
    "{\"name\":\"small\",\"realisations\":2," SMALL(
        "contact",
        "\"hurst\":0.8,\"rms_slope\":[0.1,0.3]},") "\"contact\":{\"block_height\":{\"lengths\":1},"
                                                   "\"model\":[\"halfspace\",\"layered\",\"full\"],"
                                                   "\"pressures\":{\"values\":[0.02,0.05]}}}",
    "{\"name\":\"pressed\",\"kind\":\"contact\",\"seed\":7,\"realisations\":2,\"surface\":{"
    "\"hurst\":0.8,"
    "\"wavelength_ratio\":2,\"length_ratio\":2,\"points_per_wavelength\":4},\"contact\":{"
    "\"pressures\":{"
    "\"values\":[0.02,0.2]}}}",
    "{\"name\":\"asked\",\"kind\":\"contact\",\"seed\":7,\"surface\":{\"dimension\":1,\"hurst\":0."
    "8,"
    "\"wavelength_ratio\":2,\"rms_slope\":0.1},\"target\":{\"error\":0.5},\"contact\":{\"model\":"
    "\"layered\",\"pressures\":{\"values\":[0.2]}}}",
    "{\"name\":\"broken\",\"realisations\":2," SMALL("statistics", "\"hurst\":0.2},") BINS "}",
    "{\"name\":\"waiting\",\"realisations\":1000000," SMALL("statistics", "\"hurst\":0.8},") BINS
    "}",
    "{\"name\":\"also\",\"realisations\":100000," SMALL(
        "contact", "\"hurst\":0.8,\"rms_slope\":0.1},") "\"contact\":{\"model\":\"layered\","
                                                        "\"pressures\":{\"values\":[0.05]}}}",
    "{\"name\":\"given up\",\"realisations\":5," SMALL("statistics", "\"hurst\":0.5},") BINS "}",
};
enum { STUDY_COUNT = sizeof STUDIES / sizeof *STUDIES };

static void submit(struct store *store, const char *text, struct served_study *out) {
    struct fault_list faults = {0};
    struct study *study = NULL;
    struct error err = {0};
    bool existing = false;
    MUST(kind_read_study(&study, text, strlen(text), NULL, &faults, &err) == 0);
    MUST(store_submit(store, study, NULL, out->id, &existing, &err) == 0);
    const char *space = strchr(study->name, ' ');
    snprintf(out->name, sizeof out->name, "%.*s%s%s", (int)strcspn(study->name, " "), study->name,
             space != NULL ? "%20" : "", space != NULL ? space + 1 : "");
    study_destroy(&study);
    fault_list_clear(&faults);
}

/* A job of the study fails for good. */
static void break_study(struct store *store, const char *id) {
    struct claimed_job job = {0};
    struct error err = {0};
    size_t count = 0;
    const struct claim claim = {.worker = "w", .host = "h", .study = id, .count = 1};
    MUST(store_claim(store, &claim, &job, &count, &err) == 0 && count == 1);
    MUST(store_fail(store, job.id, job.token, "no memory for it", true, &err) == 0);
    claimed_job_clear(&job);
}

/* Until all is done, also of the study that asks for an error, which is queued in rounds. */
static void work(struct store *store, const char *path, const char *asked) {
    struct publish_counts counts = {0};
    struct study_status now = {0};
    struct error err = {0};
    const struct worker_options options = {
        .source = {.database = path}, .threads = 1, .drain = true};
    for (uint64_t left = 1; left > 0; study_status_clear(&now)) {
        MUST(workers_run(&options, &err) == 0);
        MUST(publish_due(store, NULL, NULL, &counts, &err) == 0);
        MUST(store_status(store, asked, &now, &err) == 0);
        left = now.jobs_waiting;
    }
}

void served_store_make(struct served *served, const char *path) {
    struct store *store = NULL;
    struct error err = {0};
    served_store_remove(path);
    MUST(store_open(&store, path, NULL, &err) == 0);
    for (size_t n = 0; n <= BROKEN; n++)
        submit(store, STUDIES[n], &served->study[n]);
    break_study(store, served->study[BROKEN].id);
    work(store, path, served->study[ASKED].id);
    for (size_t n = BROKEN + 1; n < STUDY_COUNT; n++)
        submit(store, STUDIES[n], &served->study[n]);
    MUST(store_cancel(store, served->study[STUDY_COUNT - 1].id, &err) == 0);
    for (size_t n = 0; n < BROKEN; n++) {
        struct served_study *study = &served->study[n];
        MUST(contents_document(store, study->id, &study->contents, &err) == 0);
        MUST(cJSON_GetArraySize(cJSON_GetObjectItem(study->contents, "curves")) > 0);
    }
    served->studies = STUDY_COUNT;
    store_close(&store);
}

void served_store_remove(const char *path) {
    static const char *const PARTS[] = {"", "-wal", "-shm"};
    for (size_t n = 0; n < sizeof PARTS / sizeof *PARTS; n++) {
        char name[200];
        snprintf(name, sizeof name, "%s%s", path, PARTS[n]);
        unlink(name);
    }
}
