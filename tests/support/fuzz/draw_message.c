#include "tests/support/fuzz/draw_message.h"
#include "jobs/runner.h"
#include "schema/json/json.h"
#include "tests/support/fuzz/change_json.h"
#include "tests/support/fuzz/fuzz.h"
#include "worker/link/wire_report.h"

enum { COUNT_MOST = 2, REPORTS_MOST = 4, CHANGES_MOST = 2 }; /* realisations of a result */

static const char NO_TOKEN[] = "0123456789abcdef0123456789abcdef";

static cJSON *drawn_claim(struct choices *choices, bool odd) {
    static const char *const KINDS[] = {"statistics", "contact", "nothing", NULL};
    static const size_t COUNTS[] = {1, 2, 3, 100, 0, SIZE_MAX >> 11};
    static const double SECONDS[] = {0, 0.001, 5, 1e300};
    const struct claim claim = {
        .worker = odd && choose_rarely(choices, 4) ? "\xc3\xa9" : "drawn",
        .host = "here",
        .program = choose_rarely(choices, 4) ? "0.0.1" : NULL,
        .kinds = choose_rarely(choices, 3) ? KINDS + choose(choices, odd ? 4 : 2) : NULL,
        .count = COUNTS[choose(choices, odd ? 6 : 3)],
        .seconds = SECONDS[choose(choices, odd ? 4 : 3)],
        .threads = (unsigned)choose(choices, 4),
        .independent_only = choose_rarely(choices, 8),
    };
    return wire_claim(&claim);
}

/* Whether the job is of one of the studies that the service began with: small ones. */
static bool is_small(const struct served *served, const struct claimed_job *job) {
    for (size_t n = 0; n < served->studies; n++)
        if (strcmp(served->study[n].id, job->study) == 0)
            return true;
    return false;
}

/* Computes some realisations of the job, or, where it lies, of others, or of another case. */
static bool compute(struct choices *choices, struct served *served, const struct claimed_job *job,
                    bool odd, struct block_result *out) {
    struct error err = {0};
    struct job_runner *runner = NULL;
    bool lies = odd && choose_rarely(choices, 4);
    const struct claimed_job *computed = lies ? served_job(served, choices) : job;
    uint64_t most = job->count < COUNT_MOST ? job->count : COUNT_MOST;
    uint64_t first = job->first + (lies ? choose(choices, 3) : 0);
    uint64_t count = 1 + choose(choices, most);
    if (!is_small(served, computed))
        return false;
    int status = runner_create(&runner, kind_find(computed->kind), computed->parameters, NULL,
                               computed->seed, computed->sequence, &err);
    if (status == 0)
        status = runner_run(runner, first, count, NULL, out, &err);
    runner_destroy(&runner);
    return status == 0;
}

static cJSON *drawn_result(struct choices *choices, struct served *served, const char *token,
                           const struct claimed_job *job, bool odd) {
    struct block_result result = {.count = 1};
    cJSON *message = NULL;
    if (job != NULL && compute(choices, served, job, odd, &result)) {
        message = wire_result(token, &result);
    } else {
        static const double SCALARS[] = {1, 2};
        static const char *const NAMES[] = {"a", "b"};
        const struct block_result lie = {.first = choose(choices, 3),
                                         .count = choose(choices, 2),
                                         .scalar_count = 1 + choose(choices, 2),
                                         .names = NAMES,
                                         .scalars = SCALARS,
                                         .data = (const unsigned char *)"data",
                                         .size = choose(choices, 5)};
        message = wire_result(token, &lie);
    }
    block_result_clear(&result);
    return message;
}

static cJSON *drawn_report(struct choices *choices, struct served *served,
                           const struct message_drawing *drawing) {
    static const char *const REASONS[] = {"no convergence", "", "\xc3\xa9\n\t\"%s"};
    const struct claimed_job *job = drawing->job;
    const char *verb = drawing->verb;
    bool right = job != NULL && !(drawing->odd && choose_rarely(choices, 8));
    const char *token = right ? job->token : NO_TOKEN;
    bool far = drawing->odd && choose_rarely(choices, 4);
    if (strcmp(verb, wire_verb(REPORT_COMPLETE)) == 0)
        return drawn_result(choices, served, token, job, drawing->odd);
    if (strcmp(verb, wire_verb(REPORT_FAIL)) == 0)
        return wire_fail(token, REASONS[choose(choices, 3)], choose_rarely(choices, 8));
    if (strcmp(verb, wire_verb(REPORT_RELEASE)) == 0)
        return wire_release(token);
    return wire_heartbeat(token, far ? 0x1p53 : (double)choose(choices, 9) / 4);
}

static cJSON *drawn_reports(struct choices *choices, struct served *served, bool odd) {
    cJSON *message = cJSON_CreateObject(), *list = cJSON_AddArrayToObject(message, "reports");
    for (uint64_t left = choose(choices, REPORTS_MOST + 1); left > 0; left--) {
        const struct message_drawing one = {
            .verb = wire_verb((enum report_verb)choose(choices, REPORT_RELEASE + 1)),
            .job = served_job(served, choices),
            .odd = odd,
        };
        cJSON *report = drawn_report(choices, served, &one);
        double number = one.job != NULL ? (double)one.job->id : 1;
        MUST(report != NULL && cJSON_AddStringToObject(report, "verb", one.verb) != NULL);
        MUST(cJSON_AddNumberToObject(report, "job", number) != NULL);
        MUST(cJSON_AddItemToArray(list, report));
    }
    return message;
}

char *draw_message(struct choices *choices, struct served *served,
                   const struct message_drawing *drawing) {
    cJSON *message = NULL;
    if (strcmp(drawing->verb, "claim") == 0)
        message = drawn_claim(choices, drawing->odd);
    else if (strcmp(drawing->verb, "report") == 0)
        message = drawn_reports(choices, served, drawing->odd);
    else
        message = drawn_report(choices, served, drawing);
    MUST(message != NULL);
    if (drawing->odd)
        for (uint64_t left = choose(choices, CHANGES_MOST + 1); left > 0; left--)
            change_json(choices, &message);
    char *text = json_print(message);
    cJSON_Delete(message);
    MUST(text != NULL);
    return text;
}
