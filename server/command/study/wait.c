/* `rugo wait`: returns when a study has ended. */
#include "server/command/study/question.h"
#include "server/command/study/watch.h"
#include "server/show/summary/progress.h"
#include "server/show/summary/summary_status.h"
#include "worker/clock.h"
#include <stdio.h>
#include <string.h>

struct options {
    struct access_options place;
    unsigned timeout_s;
};
static const struct option_row OPTIONS[] = {ACCESS_ROWS(struct options),
                                            {"timeout", 0, OPTION_COUNT, 1, SECONDS_MOST,
                                             offsetof(struct options, timeout_s), "SECONDS", NULL,
                                             "wait no longer than this, and fail then"},
                                            {0}};

/* Looks until the study has ended, until the time is over or until a signal comes. */
static int wait_for_end(struct watch *watch, unsigned timeout_s, struct progress_bar *bar,
                        cJSON **progress, struct error *err) {
    int64_t until_ms = clock_ms() + 1000 * (int64_t)timeout_s;
    for (bool first = true;; first = false) {
        int status = watch_look(watch, first, progress, err);
        if (status == 0 && *progress != NULL)
            progress_of_document(bar, *progress);
        if (status != 0 || (*progress != NULL && watch_has_ended(*progress)))
            return status;
        cJSON_Delete(*progress);
        *progress = NULL;
        if (timeout_s > 0 && clock_ms() >= until_ms)
            return error_set(err, ERROR_STATE, "study %s has not ended within %u s", watch->id,
                             timeout_s);
        if (!watch_pause())
            return error_set(err, ERROR_STOPPED, "stopped");
    }
}

static int ask(struct access *access, const char *id, const void *values, cJSON **out,
               struct error *err) {
    const struct options *options = values;
    struct watch watch = {.command = "wait", .access = access, .id = id};
    struct progress_bar bar = {.command = "wait"};
    signals_catch();
    int status = wait_for_end(&watch, options->timeout_s, &bar, out, err);
    progress_end(&bar);
    return status;
}

/* A study that did not get done, or has no value, is no success. */
static int show(const cJSON *progress, const char *id, const void *options, struct error *err) {
    int status = show_progress(progress, id, options, err);
    const char *state = cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(progress, "state"));
    if (status == 0 && strcmp(state, "done") != 0)
        status = error_set(err, ERROR_STATE, "study %s is %s", id, state);
    else if (status == 0 && status_has_no_value(progress))
        status =
            error_set(err, ERROR_NUMERIC, "study %s is done, and no realisation has a value", id);
    return status;
}

static int run(const void *values, const char *const *arguments) {
    static const struct question QUESTION = {"wait", ACCESS_READ, false, ask, show};
    const struct options *options = values;
    return question_answer(&QUESTION, &options->place, arguments[0], options);
}

const struct command COMMAND_WAIT = {
    .name = "wait",
    .arguments = "ID",
    .summary = "wait until a study has ended; fails where it is not done",
    .least = 1,
    .most = 1,
    .options = OPTIONS,
    .options_size = sizeof(struct options),
    .run = run,
};
