/* `rugo prune`: deletes studies that ended long ago, for a timer to call. */
#include "core/file/plain_text.h"
#include "schema/json/field.h"
#include "server/command/access/access.h"
#include <stdio.h>
#include <string.h>
#include <time.h>

struct options {
    struct access_options place;
    int64_t days;
    bool dry;
};
#define AT(member) offsetof(struct options, member)
static const struct option_row OPTIONS[] = {
    ACCESS_ROWS(struct options),
    {"older-than", 0, OPTION_INDEX, 0, 0, AT(days), "DAYS", NULL,
     "delete what ended more than so many days ago; needed"},
    {"dry-run", 'n', OPTION_FLAG, 0, 0, AT(dry), NULL, NULL, "only list what would be deleted"},
    {0}};

enum { TIME_SIZE = 32, DAY_S = 86400, DAYS_MOST = 100000 };

/* Times of studies are texts of one form in UTC, which are in order as texts. */
static int time_before(int64_t days, char text[TIME_SIZE], struct error *err) {
    time_t then = time(NULL) - (time_t)(days * DAY_S);
    struct tm utc;
    if (gmtime_r(&then, &utc) == NULL || strftime(text, TIME_SIZE, "%Y-%m-%dT%H:%M:%SZ", &utc) == 0)
        return error_set(err, ERROR_SYSTEM, "the clock of the machine cannot be read");
    return 0;
}

static const char *text_at(const cJSON *study, const char *name) {
    char *text = cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(study, name));
    return text != NULL ? text_make_plain(text) : "";
}

static bool is_old(const cJSON *study, const char *before) {
    const char *finished = text_at(study, "finished");
    return *finished != '\0' && strcmp(finished, before) < 0;
}

struct pruning {
    struct access *access;
    const struct options *options;
    unsigned deleted, left;
};

/* One that cannot be deleted, since it goes on again or is another owner's, is reported and
 * left. */
static int prune_one(struct pruning *pruning, const cJSON *study, struct error *err) {
    const char *id = text_at(study, "id");
    cJSON *answer = NULL;
    struct error refusal = {0};
    int status = pruning->options->dry ? 0 : access_delete(pruning->access, id, &answer, &refusal);
    cJSON_Delete(answer);
    if (status != 0 && status != ERROR_STATE && status != ERROR_INPUT && status != ERROR_ABSENT) {
        *err = refusal;
        return status;
    }
    if (status != 0) {
        fprintf(stderr, "rugo prune: %s stays: %s\n", id, refusal.text);
        pruning->left++;
        return 0;
    }
    printf("%s  ended %s  %s\n", id, text_at(study, "finished"), text_at(study, "name"));
    pruning->deleted++;
    return 0;
}

static int prune(struct pruning *pruning, struct error *err) {
    char before[TIME_SIZE];
    cJSON *list = NULL;
    const cJSON *study;
    int status = time_before(pruning->options->days, before, err);
    if (status == 0)
        status = access_list(pruning->access, &list, err);
    cJSON_ArrayForEach(study, field_at(list, "studies")) {
        if (status == 0 && is_old(study, before))
            status = prune_one(pruning, study, err);
    }
    cJSON_Delete(list);
    if (status == 0)
        printf("%u studies %s\n", pruning->deleted,
               pruning->options->dry ? "would be deleted" : "deleted");
    int flushed = output_flush(status == 0 ? err : NULL);
    return status != 0 ? status : flushed;
}

static int run(const void *values, const char *const *arguments) {
    const struct options *options = values;
    struct pruning pruning = {.options = options};
    struct error err = {0};
    (void)arguments;
    if (access_options_check("prune", &options->place) != 0)
        return EXIT_USAGE;
    if (options->days < 0)
        return usage_error("prune", "--older-than DAYS is missing: a whole number in [0, %d]",
                           (int)DAYS_MOST);
    if (options->days > DAYS_MOST)
        return usage_error("prune", "--older-than %lld is not a whole number in [0, %d]",
                           (long long)options->days, (int)DAYS_MOST);
    int status = access_open(&pruning.access, &options->place, ACCESS_WRITE, &err);
    if (status == 0)
        status = prune(&pruning, &err);
    access_close(&pruning.access);
    if (status != 0)
        return command_fail("prune", &err);
    return pruning.left == 0 ? EXIT_DONE : EXIT_FAILED;
}

const struct command COMMAND_PRUNE = {
    .name = "prune",
    .arguments = "",
    .summary = "delete the studies that ended long ago, with their results",
    .options = OPTIONS,
    .options_size = sizeof(struct options),
    .run = run,
};
