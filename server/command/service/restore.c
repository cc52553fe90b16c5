/* `rugo restore`: a backup becomes the store, and what was there is kept in a folder beside it. */
#include "schema/store/upkeep/store_restore.h"
#include "server/command/command.h"
#include "server/command/service/kept_name.h"
#include "server/command/service/verify.h"
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

struct options {
    const char *database;
    bool dry_run;
};
static const struct option_row OPTIONS[] = {
    {"db", 0, OPTION_TEXT, 0, 0, offsetof(struct options, database), "FILE", DATABASE,
     "the local store"},
    {"dry-run", 'n', OPTION_FLAG, 0, 0, offsetof(struct options, dry_run), NULL, NULL,
     "check the backup and list what it lacks; change nothing"},
    {0}};

/* The copy is opened to write: an older one is brought up to date before it is the store. */
static int open_copy(struct store **copy, const char *path, const char *backup, struct error *err) {
    const struct store_options existing = {.existing = true};
    struct verify_report report = {0};
    int status = store_open(copy, path, &existing, err);
    if (status == 0)
        status = verify_and_print(*copy, backup, false, &report, err);
    if (status == 0 && report.counts.flaws > 0)
        status =
            error_set(err, ERROR_STATE,
                      "backup %.200s is not whole, and was not restored: take an older one, or "
                      "rugo repair --db a copy of it first",
                      backup);
    return status;
}

static int print_study(void *context, const struct lacking_study *study) {
    uint64_t *count = context;
    if ((*count)++ == 0)
        printf("studies that the backup lacks, to be submitted again:\n");
    printf("%s  %s  %s%s%s\n", study->id, study->created, study->name,
           *study->owner != '\0' ? "  of " : "", study->owner);
    return 0;
}

/* What is to be replaced may be damaged: then it is said that nothing is known of it. */
static int list_lacking(const char *database, struct store *copy, struct error *err) {
    const struct store_options reading = {.read_only = true};
    struct stat info;
    struct store *store = NULL;
    struct error reason = {0};
    uint64_t count = 0;
    if (lstat(database, &info) != 0)
        return 0;
    int status = store_open(&store, database, &reading, &reason);
    if (status == 0)
        status = store_lacks(store, copy, print_study, &count, &reason);
    store_close(&store);
    if (status != 0 && status != ERROR_STOPPED) {
        printf("which studies the backup lacks is not known: %s\n", reason.text);
        return 0;
    }
    if (status == 0 && count == 0)
        printf("the backup has all studies of %s\n", database);
    if (status != 0)
        *err = reason;
    return status;
}

static int check_and_list(const struct part_file *part, const char *backup, const char *database,
                          struct error *err) {
    struct store *copy = NULL;
    int status = open_copy(&copy, part->path, backup, err);
    if (status == 0)
        status = list_lacking(database, copy, err);
    store_close(&copy);
    return status;
}

static void print_end(const char *database, const char *backup, const char *folder, bool kept) {
    printf("%s is restored from %s\n", database, backup);
    if (kept)
        printf("what was there is in %s\n", folder);
}

/* Makes the folder that keeps what is there, and holds the copy until then. */
static int make_folder(char folder[KEPT_PATH_SIZE], const char *database, bool dry_run,
                       struct error *err) {
    char before[KEPT_PATH_SIZE];
    bool finished = false;
    int status = dry_run ? 0 : restore_finish(database, &finished, err);
    if (finished)
        printf("logs of an older file, which a restore that was cut short had left, are with it\n");
    if (status != 0)
        return status;
    if (snprintf(before, sizeof before, "%s.before-restore-", database) >= (int)sizeof before)
        return error_set(err, ERROR_INPUT, "the path %.200s... is too long", database);
    status = kept_name(folder, before, "", err);
    if (status == 0 && mkdir(folder, 0700) != 0)
        status = error_set(err, ERROR_SYSTEM, "cannot make folder %s: %s", folder, strerror(errno));
    return status;
}

static int restore(const char *database, const char *backup, bool dry_run, struct error *err) {
    char folder[KEPT_PATH_SIZE];
    struct part_file part = {0};
    bool kept = false;
    int status = make_folder(folder, database, dry_run, err);
    if (status != 0)
        return status;
    status = restore_copy(&part, backup, database, folder, stop_is_requested, NULL, err);
    if (status == 0)
        status = check_and_list(&part, backup, database, err);
    if (status == 0 && !dry_run)
        status = restore_swap(&part, database, folder, &kept, err);
    part_file_destroy(&part);
    if (!kept)
        (void)rmdir(folder); /* nothing is in it */
    if (status == 0 && !dry_run)
        print_end(database, backup, folder, kept);
    return status != 0 ? status : output_flush(err);
}

static int run(const void *values, const char *const *arguments) {
    const struct options *options = values;
    struct error err = {0};
    signals_catch();
    struct stat info;
    bool link = lstat(options->database, &info) == 0 && S_ISLNK(info.st_mode);
    char *real = link ? realpath(options->database, NULL) : NULL; /* the link stays one */
    int status =
        restore(real != NULL ? real : options->database, arguments[0], options->dry_run, &err);
    free(real);
    return status == 0 ? EXIT_DONE : command_fail("restore", &err);
}

const struct command COMMAND_RESTORE = {
    .name = "restore",
    .arguments = "BACKUP",
    .summary = "make a snapshot the store again; what was there is kept",
    .least = 1,
    .most = 1,
    .options = OPTIONS,
    .options_size = sizeof(struct options),
    .run = run,
};
