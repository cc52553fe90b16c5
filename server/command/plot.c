/* `rugo plot`: one picture of a study's results, as SVG. */
#include "server/command/access.h"
#include "server/show/picture.h"
#include <stdio.h>

struct options {
    struct access_options place;
    int64_t case_number; /* -1: all */
    int64_t difference[2];
    const char *quantity, *x, *colour;
};
#define AT(member) offsetof(struct options, member)
static const struct option_row OPTIONS[] = {
    ACCESS_ROWS(struct options),
    {"quantity", 0, OPTION_TEXT, 0, 0, AT(quantity), "Q", NULL,
     "of curves, such as summit_height_pdf, or a scalar, such as summit_density"},
    {"x", 0, OPTION_TEXT, 0, 0, AT(x), "PARAMETER", NULL,
     "of a scalar: over this parameter (the number that the study sweeps most)"},
    {"colour", 0, OPTION_TEXT, 0, 0, AT(colour), "PARAMETER", NULL,
     "of a scalar: a colour for each value of this one"},
    {"case", 0, OPTION_INDEX, 0, 0, AT(case_number), "K", NULL, "of curves: this case only"},
    {"difference", 0, OPTION_PAIR, 0, 0, AT(difference), "A B", NULL,
     "of curves: case A less case B"},
    {0}};

/* What a picture is drawn from: a study behind an access. */
struct origin {
    struct access *access;
    const char *id;
};

static int results(const void *context, const struct result_filter *filter,
                   struct study_result *out, struct error *err) {
    const struct origin *origin = context;
    return access_results(origin->access, origin->id, filter, out, err);
}

static int difference(const void *context, const struct comparison *comparison,
                      struct study_result *out, struct error *err) {
    const struct origin *origin = context;
    return access_difference(origin->access, origin->id, comparison, out, err);
}

static int draw(struct access *access, const char *id, const struct options *options,
                struct error *err) {
    struct origin origin = {access, id};
    const struct picture_source source = {&origin, results, difference};
    const struct comparison comparison = {.minuend = (uint64_t)options->difference[0],
                                          .subtrahend = (uint64_t)options->difference[1],
                                          .quantity = options->quantity};
    const struct picture_request request = {.quantity = options->quantity,
                                            .x = options->x,
                                            .colour = options->colour,
                                            .case_number = options->case_number,
                                            .difference =
                                                options->difference[0] >= 0 ? &comparison : NULL};
    int status = picture_draw(&source, &request, stdout, err);
    return status == 0 ? output_flush(err) : status;
}

static int run(const void *values, const char *const *arguments) {
    const struct options *options = values;
    struct error err = {0};
    char id[STUDY_ID_SIZE];
    struct access *access = NULL;
    if (access_options_check("plot", &options->place) != 0)
        return EXIT_USAGE;
    if (options->quantity == NULL)
        return usage_error("plot", "--quantity is missing: the name of curves or of a scalar");
    int status = access_open(&access, &options->place, ACCESS_READ, &err);
    if (status == 0)
        status = access_find(access, arguments[0], id, &err);
    if (status == 0)
        status = draw(access, id, options, &err);
    access_close(&access);
    return status != 0 ? command_fail("plot", &err) : EXIT_DONE;
}

const struct command COMMAND_PLOT = {
    .name = "plot",
    .arguments = "ID",
    .summary = "a picture (SVG) of curves, or of a scalar over what was swept",
    .least = 1,
    .most = 1,
    .options = OPTIONS,
    .options_size = sizeof(struct options),
    .run = run,
};
