/* `rugo certificate`: makes a certificate for `rugo serve`, or prints the fingerprint of one. */
#include "server/command/command.h"
#include "server/http/guard/self_signed.h"
#include <stdio.h>
#include <string.h>

struct options {
    const char **hosts;
    unsigned days;
};
#define AT(member) offsetof(struct options, member)
static const struct option_row OPTIONS[] = {
    {"host", 0, OPTION_LIST, 0, 0, AT(hosts), "NAME", NULL,
     "of new: a name or address by which clients know the server"},
    {"days", 0, OPTION_COUNT, 1, 36500, AT(days), "N", "3650", "of new: how long it is valid"},
    {0}};

static int run(const void *values, const char *const *arguments) {
    const struct options *options = values;
    const char *verb = arguments[0], *place = arguments[1];
    char fingerprint[FINGERPRINT_SIZE];
    struct error err = {0};
    int status = 0;
    if (strcmp(verb, "new") == 0)
        status = self_signed_make(place, options->hosts, options->days, fingerprint, &err);
    else if (strcmp(verb, "show") == 0)
        status = certificate_file_fingerprint(place, fingerprint, &err);
    else
        return usage_error("certificate", "\"%.40s\" is neither new nor show", verb);
    if (status == 0) {
        puts(fingerprint);
        status = output_flush(&err);
    }
    return status == 0 ? EXIT_DONE : command_fail("certificate", &err);
}

const struct command COMMAND_CERTIFICATE = {
    .name = "certificate",
    .arguments = "new DIR|show FILE",
    .summary = "make a self-signed certificate for serve, or show one's fingerprint",
    .least = 2,
    .most = 2,
    .options = OPTIONS,
    .options_size = sizeof(struct options),
    .run = run,
};
