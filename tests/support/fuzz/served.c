#include "tests/support/fuzz/served.h"
#include "schema/json/json.h"
#include "tests/support/fuzz/fuzz.h"
#include "worker/link/wire.h"

static void forget_at(struct served *served, size_t n) {
    claimed_job_clear(&served->job[n]);
    served->jobs--;
    memmove(served->job + n, served->job + n + 1, (served->jobs - n) * sizeof *served->job);
}

void served_take_jobs(struct served *served, const char *answer, size_t size) {
    struct claimed_job jobs[WIRE_JOBS_MOST] = {0};
    struct error err = {0};
    cJSON *document = NULL;
    size_t count = 0;
    MUST(json_parse(answer, size, NULL, &document, &err) == 0);
    MUST(wire_jobs_read(document, jobs, WIRE_JOBS_MOST, &count, &err) == 0);
    cJSON_Delete(document);
    for (size_t n = 0; n < count; n++) {
        if (served->jobs == SERVED_JOBS)
            forget_at(served, 0);
        served->job[served->jobs++] = jobs[n];
    }
}

const struct claimed_job *served_job(struct served *served, struct choices *choices) {
    return served->jobs > 0 ? &served->job[choose(choices, served->jobs)] : NULL;
}

void served_forget_job(struct served *served, int64_t number) {
    for (size_t n = served->jobs; n > 0; n--)
        if (served->job[n - 1].id == number)
            forget_at(served, n - 1);
}

void served_forget_jobs(struct served *served) {
    while (served->jobs > 0)
        forget_at(served, served->jobs - 1);
}

void served_clear(struct served *served) {
    served_forget_jobs(served);
    for (size_t n = 0; n < served->studies; n++)
        cJSON_Delete(served->study[n].contents);
    *served = (struct served){.studies = 0};
}
