/* `rugo verify` and `rugo repair`: whether a store is whole, and what makes it whole again. */
#include "server/command/service/verify.h"
#include "server/command/command.h"
#include "server/command/service/kept_name.h"
#include "worker/clock.h"
#include <inttypes.h>
#include <stdio.h>
#include <unistd.h>

struct options {
    const char *database;
    bool quick;
};
#define DATABASE_ROW                                                                               \
    {                                                                                              \
        "db", 0, OPTION_TEXT, 0, 0, offsetof(struct options, database), "FILE", DATABASE,          \
            "the local store"                                                                      \
    }
static const struct option_row VERIFY_OPTIONS[] = {
    DATABASE_ROW,
    {"quick", 0, OPTION_FLAG, 0, 0, offsetof(struct options, quick), NULL, NULL,
     "checksums and counters alone; blocks are not decoded"},
    {0}};
static const struct option_row REPAIR_OPTIONS[] = {DATABASE_ROW, {0}};

/* What is printed while a store is checked. */
struct telling {
    bool shown;      /* standard error shows how far it is */
    int64_t told_ms; /* when it last did */
};

static void clear_progress(struct telling *telling) {
    if (telling->shown)
        fputs("\r\033[K", stderr);
    telling->shown = false;
}

static int print_progress(void *context, const char *what, uint64_t done) {
    struct telling *telling = context;
    if (isatty(STDERR_FILENO) != 0 && clock_ms() - telling->told_ms >= 500) {
        clear_progress(telling);
        fprintf(stderr, "%s: %" PRIu64, what, done);
        fflush(stderr);
        telling->shown = true;
        telling->told_ms = clock_ms();
    }
    return atomic_load(&stop_requested);
}

static int print_flaw(void *context, const struct flaw *flaw, struct error *err) {
    (void)err;
    clear_progress(context);
    if (flaw->study[0] != '\0')
        printf("study %s", flaw->study);
    else
        printf("database");
    if (flaw->case_number >= 0)
        printf(", case %" PRId64, flaw->case_number);
    if (flaw->count == 1)
        printf(", realisation %" PRIu64, flaw->first);
    else if (flaw->count > 1)
        printf(", realisations %" PRIu64 " to %" PRIu64, flaw->first,
               flaw->first + flaw->count - 1);
    printf(": %s\n", flaw->text);
    return 0;
}

static void print_counts(const char *database, const struct verify_report *report) {
    const struct verify_counts *counts = &report->counts;
    printf("%s: %" PRIu64 " cases, %" PRIu64 " results, %" PRIu64 " published cases: ", database,
           counts->cases, counts->blocks, counts->published);
    if (counts->flaws == 0)
        printf("whole\n");
    else
        printf("%" PRIu64 " %s\n", counts->flaws, counts->flaws == 1 ? "flaw" : "flaws");
    if (counts->unsealed > 0)
        printf("%" PRIu64
               " of them have no checksum, as of an older program; rugo repair adds it\n",
               counts->unsealed);
    if (report->kept > 0)
        printf("%" PRIu64 " results are of another version of the program, which alone could merge "
               "them; what is published of their cases stands\n",
               report->kept);
}

int verify_and_print(struct store *store, const char *name, bool quick,
                     struct verify_report *report, struct error *err) {
    struct telling telling = {.told_ms = clock_ms()};
    const struct verification verification = {print_flaw, print_progress, &telling};
    int status = verify_store(store, &verification, quick, report, err);
    clear_progress(&telling);
    if (status == 0)
        print_counts(name, report);
    return status;
}

static int run_verify(const void *values, const char *const *arguments) {
    (void)arguments;
    const struct options *options = values;
    const struct store_options reading = {.read_only = true};
    struct verify_report report = {0};
    struct error err = {0};
    struct store *store = NULL;
    signals_catch();
    int status = store_open(&store, options->database, &reading, &err);
    if (status == 0)
        status = verify_and_print(store, options->database, options->quick, &report, &err);
    store_close(&store);
    if (status == 0)
        status = output_flush(&err);
    if (status != 0)
        return command_fail("verify", &err);
    return report.counts.flaws == 0 ? EXIT_DONE : EXIT_FAILED;
}

/* --- repair --- */

static void print_repair(const struct repair_report *report) {
    const struct {
        uint64_t count;
        const char *done;
    } rows[] = {{report->structure, "times the indices were made anew"},
                {report->cases, "cases have their parameters back"},
                {report->blocks, "results were given up, to be computed anew"},
                {report->published, "published cases were taken back, to be merged anew"},
                {report->counters, "counters and gaps were put right"},
                {report->sealed, "rows without a checksum have one"}};
    for (size_t r = 0; r < sizeof rows / sizeof *rows; r++)
        if (rows[r].count > 0)
            printf("%" PRIu64 " %s\n", rows[r].count, rows[r].done);
}

/* The store as it was is kept beside it. */
static int keep_copy(struct store *store, const char *database, struct error *err) {
    char path[KEPT_PATH_SIZE], beside[KEPT_PATH_SIZE];
    snprintf(beside, sizeof beside, "%s.before-repair-", database);
    int status = kept_name(path, beside, "", err);
    if (status == 0)
        status = store_snapshot(store, path, NULL, NULL, err);
    if (status == 0)
        printf("the database as it was is kept in %s\n", path);
    return status;
}

static int run_repair(const void *values, const char *const *arguments) {
    (void)arguments;
    const struct options *options = values;
    const struct store_options existing = {.existing = true};
    struct telling telling = {.told_ms = clock_ms()};
    const struct verification verification = {print_flaw, print_progress, &telling};
    struct repair_report report = {0};
    struct error err = {0};
    struct store *store = NULL;
    int status = store_open(&store, options->database, &existing, &err);
    if (status == 0)
        status = store_take_alone(store, &err);
    if (status == 0)
        status = keep_copy(store, options->database, &err);
    if (status == 0)
        status = repair_store(store, &verification, &report, &err);
    store_close(&store);
    clear_progress(&telling);
    if (status == 0) {
        print_repair(&report);
        print_counts(options->database, &report.after);
        status = output_flush(&err);
    }
    if (status != 0)
        return command_fail("repair", &err);
    return report.after.counts.flaws == 0 ? EXIT_DONE : EXIT_FAILED;
}

const struct command COMMAND_VERIFY = {
    .name = "verify",
    .arguments = "",
    .summary = "whether a results database is whole: checksums, counters, results",
    .options = VERIFY_OPTIONS,
    .options_size = sizeof(struct options),
    .run = run_verify,
};
const struct command COMMAND_REPAIR = {
    .name = "repair",
    .arguments = "",
    .summary = "make a damaged results database whole, as far as can be",
    .options = REPAIR_OPTIONS,
    .options_size = sizeof(struct options),
    .run = run_repair,
};
