/* `rugo submit`: queues a study and prints its id. */
#include "schema/json/field.h"
#include "server/command/access/access.h"
#include "server/command/input_file.h"
#include "server/command/map/like_study.h"
#include "worker/link/client.h"
#include <stdio.h>
#include <stdlib.h>

struct options {
    struct access_options place;
    const char **sets;
    const char *key;
    unsigned timeout_s;
};
static const struct option_row OPTIONS[] = {
    ACCESS_ROWS(struct options),
    {"set", 0, OPTION_LIST, 0, 0, offsetof(struct options, sets), "PATH=VALUE", NULL, SET_HELP},
    {"key", 0, OPTION_TEXT, 0, 0, offsetof(struct options, key), "KEY", NULL,
     "queue the study once, however often it is submitted with this key (one is made unless "
     "given)"},
    {"timeout", 0, OPTION_COUNT, 1, SECONDS_MOST, offsetof(struct options, timeout_s), "SECONDS",
     "30", "with --server, how long to repeat the request without an answer"},
    {0}};

static int print_id(const cJSON *document, struct error *err) {
    const char *id = cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(document, "id"));
    if (id == NULL)
        return error_set(err, ERROR_SYSTEM, "the server's answer has no id");
    double taken = field_number(document, "realisations_done");
    if (taken > 0)
        fprintf(stderr,
                "rugo submit: %.0f realisations were there already, of a study with fewer\n",
                taken);
    puts(id);
    return output_flush(err);
}

/* As a server takes it. */
static int check_key(const char *key, struct error *err) {
    if (key == NULL || key_is_good(key))
        return 0;
    return error_set(err, ERROR_INPUT, "--key has 1 to %d visible ASCII characters", KEY_MOST);
}

static int submit(const struct options *options, const char *file, struct fault_list *faults,
                  struct error *err) {
    struct access *access = NULL;
    char *text = NULL;
    size_t size;
    cJSON *document = NULL;
    bool fitted = false;
    int status = check_key(options->key, err);
    if (status == 0)
        status = input_file_read(file, JSON_LIMITS.bytes, &text, &size, err);
    if (status == 0)
        status = like_study_fit(&text, &size, file, options->sets, &fitted, err);
    if (status == 0)
        status = access_open(&access, &options->place, ACCESS_CREATE, err);
    if (status == 0)
        status = access_submit(access,
                               &(struct submission){.text = text,
                                                    .size = size,
                                                    .overrides = fitted ? NULL : options->sets,
                                                    .key = options->key,
                                                    .timeout_s = options->timeout_s},
                               &document, faults, err);
    if (status == ERROR_INPUT)
        error_context(err, "%s", file);
    if (status == 0)
        status = print_id(document, err);
    cJSON_Delete(document);
    access_close(&access);
    free(text);
    return status;
}

static int run(const void *values, const char *const *arguments) {
    const struct options *options = values;
    struct error err = {0};
    struct fault_list faults = {0};
    if (access_options_check("submit", &options->place) != 0)
        return EXIT_USAGE;
    int status = submit(options, arguments[0], &faults, &err);
    int result = command_end("submit", status, arguments[0], &faults, &err);
    fault_list_clear(&faults);
    return result;
}

const struct command COMMAND_SUBMIT = {
    .name = "submit",
    .arguments = "STUDY.json",
    .summary = "queue a study and print its id",
    .least = 1,
    .most = 1,
    .options = OPTIONS,
    .options_size = sizeof(struct options),
    .run = run,
};
