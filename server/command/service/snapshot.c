/* `rugo snapshot`: a consistent copy of the results database, also while others write to it. */
#include "server/command/access/access.h"

struct options {
    struct access_options place;
};
static const struct option_row OPTIONS[] = {ACCESS_ROWS(struct options), {0}};

static int run(const void *values, const char *const *arguments) {
    const struct options *options = values;
    struct error err = {0};
    struct access *access = NULL;
    if (access_options_check("snapshot", &options->place) != 0)
        return EXIT_USAGE;
    if (options->place.server == NULL)
        signals_catch();
    int status = access_open(&access, &options->place, ACCESS_READ, &err);
    if (status == 0)
        status = access_snapshot(access, arguments[0], &err);
    access_close(&access);
    return status == 0 ? EXIT_DONE : command_fail("snapshot", &err);
}

const struct command COMMAND_SNAPSHOT = {
    .name = "snapshot",
    .arguments = "FILE",
    .summary = "a consistent copy of the results database",
    .least = 1,
    .most = 1,
    .options = OPTIONS,
    .options_size = sizeof(struct options),
    .run = run,
};
