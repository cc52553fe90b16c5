/* `rugo snapshot`: a consistent copy of the results database, also while others write to it. */
#include "core/file/file.h"
#include "server/command/access/access.h"
#include "server/command/service/kept_name.h"
#include "server/command/service/verify.h"
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

struct options {
    struct access_options place;
    unsigned keep; /* 0: all */
};
enum { KEEP_MOST = 100000 };
static const struct option_row OPTIONS[] = {
    ACCESS_ROWS(struct options),
    {"keep", 0, OPTION_COUNT, 1, KEEP_MOST, offsetof(struct options, keep), "N", NULL,
     "of the snapshots that it made in FOLDER, keep the newest N"},
    {0}};

/* Until it is verified a snapshot in a folder has this behind its name. */
#define UNVERIFIED ".unverified"

/* Snapshots of one store in a folder: FOLDER/STEM20261126T190000Z.db, with a STEM that ends in -.
 * Nobody else's files are removed. */
struct series {
    char folder[KEPT_PATH_SIZE], stem[256];
};

static void series_of(struct series *series, const char *folder, const char *database) {
    size_t length = strlen(folder);
    while (length > 1 && folder[length - 1] == '/')
        length--;
    snprintf(series->folder, sizeof series->folder, "%.*s", (int)length, folder);
    const char *path = database != NULL ? database : DATABASE, *slash = strrchr(path, '/');
    const char *name = slash != NULL ? slash + 1 : path;
    length = strlen(name) - (file_ends_in(name, ".db") ? strlen(".db") : 0);
    snprintf(series->stem, sizeof series->stem, "%.*s-", (int)length, name);
}

static int remove_file(const char *folder, const char *name, struct error *err) {
    char path[KEPT_PATH_SIZE];
    if (snprintf(path, sizeof path, "%s/%s", folder, name) < (int)sizeof path && unlink(path) == 0)
        return 0;
    return error_set(err, ERROR_SYSTEM, "the older snapshot %s/%s is not removed: %s", folder, name,
                     strerror(errno));
}

/* Removes all but the newest one and keep - 1 others, of which names show the age, and what was
 * killed before it was verified. Returns the first failure, after which it goes on. */
static int remove_oldest(const struct series *series, const char *newest, size_t keep,
                         struct error *err) {
    struct dirent **entries = NULL;
    size_t kept = 1;
    int status = 0, count = scandir(series->folder, &entries, NULL, alphasort);
    if (count < 0)
        return error_set(err, ERROR_SYSTEM, "%s: %s", series->folder, strerror(errno));
    while (count-- > 0) {
        const char *name = entries[count]->d_name;
        if (kept_name_is(name, series->stem, ".db" UNVERIFIED) ||
            (kept_name_is(name, series->stem, ".db") && strcmp(name, newest) != 0 &&
             kept++ >= keep)) {
            int removed = remove_file(series->folder, name, status == 0 ? err : NULL);
            status = status == 0 ? removed : status;
        }
        free(entries[count]);
    }
    free(entries);
    return status;
}

/* Gives a copy its name. One with a flaw is none: it is removed, and older ones stay. That of an
 * older server is left as it is. */
static int verify_copy(const char *copy, const char *path, struct error *err) {
    const struct store_options reading = {.read_only = true, .as_it_is = true};
    struct verify_report report = {0};
    struct store *store = NULL;
    int status = store_open(&store, copy, &reading, err);
    if (status == 0) {
        status = verify_and_print(store, path, false, &report, err);
    } else if (status == ERROR_STATE) {
        printf("%s: not verified, as it is of an older program\n", path);
        status = 0;
    }
    store_close(&store);
    if (status == 0 && report.counts.flaws > 0)
        status = error_set(err, ERROR_STATE,
                           "the store has flaws, and no snapshot is kept: see rugo verify and rugo "
                           "repair");
    if (status == 0 && renameat2(AT_FDCWD, copy, AT_FDCWD, path, RENAME_NOREPLACE) != 0)
        status = error_set(err, ERROR_SYSTEM, "%s: %s", path, strerror(errno));
    if (status != 0)
        (void)unlink(copy);
    return status;
}

static int copy_into_folder(struct access *access, const char *folder,
                            const struct options *options, struct error *err) {
    struct series series;
    char before[KEPT_PATH_SIZE + sizeof series.stem], path[KEPT_PATH_SIZE];
    char copy[KEPT_PATH_SIZE + sizeof UNVERIFIED];
    series_of(&series, folder, options->place.database);
    snprintf(before, sizeof before, "%s/%s", series.folder, series.stem);
    int status = kept_name(path, before, ".db", err);
    snprintf(copy, sizeof copy, "%s" UNVERIFIED, path);
    if (status == 0)
        status = access_snapshot(access, copy, err);
    if (status == 0)
        status = verify_copy(copy, path, err);
    if (status == 0 && options->keep > 0)
        status = remove_oldest(&series, path + strlen(series.folder) + 1, options->keep, err);
    return status;
}

static bool is_folder(const char *path) {
    struct stat info;
    return stat(path, &info) == 0 && S_ISDIR(info.st_mode);
}

static int run(const void *values, const char *const *arguments) {
    const struct options *options = values;
    struct error err = {0};
    struct access *access = NULL;
    bool folder = is_folder(arguments[0]);
    if (access_options_check("snapshot", &options->place) != 0)
        return EXIT_USAGE;
    if (options->keep > 0 && !folder) {
        fprintf(stderr, "rugo snapshot: --keep is for a folder, which %s is not\n", arguments[0]);
        return EXIT_USAGE;
    }
    if (options->place.server == NULL)
        signals_catch();
    int status = access_open(&access, &options->place, ACCESS_READ, &err);
    if (status == 0)
        status = folder ? copy_into_folder(access, arguments[0], options, &err)
                        : access_snapshot(access, arguments[0], &err);
    access_close(&access);
    return status == 0 ? EXIT_DONE : command_fail("snapshot", &err);
}

const struct command COMMAND_SNAPSHOT = {
    .name = "snapshot",
    .arguments = "FILE|FOLDER",
    .summary = "a consistent copy of the results database, in a folder named by its time and "
               "verified",
    .least = 1,
    .most = 1,
    .options = OPTIONS,
    .options_size = sizeof(struct options),
    .run = run,
};
