/* `rugo submit`: queues a study and prints its id. */
#include "schema/json/field.h"
#include "server/command/access.h"
#include <stdio.h>
#include <stdlib.h>

struct options {
    struct access_options place;
    const char **sets;
};
static const struct option_row OPTIONS[] = {
    ACCESS_ROWS(struct options),
    {"set", 0, OPTION_LIST, 0, 0, offsetof(struct options, sets), "PATH=VALUE", NULL, SET_HELP},
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

static int submit(const struct options *options, const char *file, struct fault_list *faults,
                  struct error *err) {
    struct access *access = NULL;
    char *text = NULL;
    size_t size;
    cJSON *document = NULL;
    int status = file_read(file, JSON_LIMITS.bytes, &text, &size, err);
    if (status == 0)
        status = access_open(&access, &options->place, ACCESS_CREATE, err);
    if (status == 0)
        status = access_submit(access, text, size, options->sets, &document, faults, err);
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
    int result = status == 0        ? EXIT_DONE
                 : faults.count > 0 ? command_fail_faults(arguments[0], &faults)
                                    : command_fail("submit", &err);
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
