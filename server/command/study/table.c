/* `rugo table`: the cases of a study as a table of what was swept and what came out. */
#include "server/command/access/access.h"
#include "server/show/table/case_table.h"
#include <stdio.h>

struct options {
    struct access_options place;
    const char *columns, **where;
    int format;
};
#define AT(member) offsetof(struct options, member)
static const struct option_row OPTIONS[] = {
    ACCESS_ROWS(struct options),
    {"columns", 0, OPTION_TEXT, 0, 0, AT(columns), "LIST", NULL,
     "scalars, such as kappa, and values of curves, such as mean_gap@0.1 or "
     "contact_area:layered:nodes@0.1, with commas between; .theory, .grid, .law and sources of "
     "errors, as .model, behind one ask for what stands beside it"},
    {"where", 0, OPTION_LIST, 0, 0, AT(where), "NAME=VALUE", NULL,
     "only cases with this value, e.g. hurst=0.8; several with commas between, or given again: any "
     "of one name, all of different names"},
    {"format", 0, OPTION_CHOICE, 0, 0, AT(format), TABLE_FORMATS, "text", "what to print"},
    {0}};

static int run(const void *values, const char *const *arguments) {
    const struct options *options = values;
    const struct table_request request = {options->columns, options->where};
    char id[STUDY_ID_SIZE];
    struct error err = {0};
    struct access *access = NULL;
    if (access_options_check("table", &options->place) != 0)
        return EXIT_USAGE;
    int status = access_open(&access, &options->place, ACCESS_READ, &err);
    if (status == 0)
        status = access_find(access, "table", arguments[0], id, &err);
    if (status == 0)
        status = access_table(access, id, &request, options->format, stdout, &err);
    if (status == 0)
        status = output_flush(&err);
    access_close(&access);
    return status != 0 ? command_fail("table", &err) : EXIT_DONE;
}

const struct command COMMAND_TABLE = {
    .name = "table",
    .arguments = "ID",
    .summary = "a row a case: what was swept, then scalars or values of curves with their errors",
    .least = 1,
    .most = 1,
    .options = OPTIONS,
    .options_size = sizeof(struct options),
    .run = run,
};
