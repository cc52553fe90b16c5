/* `rugo export`: all of a study in one archive or folder, fit to be published beside a paper. */
#include "core/file/file.h"
#include "server/command/access/access.h"
#include "server/command/output_file.h"
#include "server/command/study/export_folder.h"
#include "server/command/study/zip_folder.h"
#include "server/show/output.h"
#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { PATH_SIZE = 4096, TOP_SIZE = 80 };

struct options {
    struct access_options place;
    struct result_folder out;
};
#define AT(member) offsetof(struct options, member)
static const struct option_row OPTIONS[] = {ACCESS_ROWS(struct options),
                                            {"out", 'o', OPTION_TEXT, 0, 0, AT(out.path),
                                             "FILE.zip|DIR", NULL,
                                             "the archive, or a folder for its files (NAME.zip)"},
                                            REPLACE_ROW(AT(out.replace)),
                                            {0}};

/* Writes what a study's name may be as the name of a file: other than letters, digits, ._- are -.
 */
static void file_name(const char *name, char out[TOP_SIZE]) {
    static const char PLAIN[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._-";
    size_t size = 0;
    for (; name[size] != '\0' && size + 1 < TOP_SIZE; size++)
        out[size] = strchr(PLAIN, name[size]) != NULL ? name[size] : '-';
    out[size] = '\0';
    if (out[0] == '.' || size == 0)
        out[0] = '-';
    if (size == 0)
        out[1] = '\0';
}

/* Removes a folder with the files in it, but no folder below it. */
static void remove_folder(const char *folder) {
    char path[PATH_SIZE];
    DIR *list = opendir(folder);
    for (const struct dirent *one; list != NULL && (one = readdir(list)) != NULL;)
        if (snprintf(path, sizeof path, "%s/%s", folder, one->d_name) < (int)sizeof path)
            (void)unlink(path);
    if (list != NULL)
        (void)closedir(list);
    (void)rmdir(folder);
}

static void warn(const struct study_result *study) {
    if (strcmp(study->state, "done") != 0)
        fprintf(stderr, "rugo export: the study is %s: this is what there is of it now\n",
                study->state);
    for (size_t c = 0; c < study->case_count; c++)
        command_warn_missing("export", &study->cases[c]);
}

/* A README.txt of somebody's own, in a folder without results, is not written over. */
static int check_readme(const struct result_folder *out, struct error *err) {
    char readme[PATH_SIZE], curves[PATH_SIZE];
    if (snprintf(readme, sizeof readme, "%s/README.txt", out->path) >= (int)sizeof readme ||
        snprintf(curves, sizeof curves, "%s/curves.json", out->path) >= (int)sizeof curves)
        return error_set(err, ERROR_INPUT, "the path %.100s... is too long", out->path);
    return out->replace || access(readme, F_OK) != 0 || access(curves, F_OK) == 0
               ? 0
               : error_set(err, ERROR_INPUT,
                           "%.200s exists, and no results are beside it; name another folder by "
                           "-o, or add --replace",
                           readme);
}

static int write_folder(struct access *access, const char *id, const struct result_folder *out,
                        struct error *err) {
    struct study_result study = {0};
    const struct export_order order = {access, id, *out};
    int status = check_readme(out, err);
    if (status == 0)
        status = output_check(out->path, err);
    if (status == 0)
        status = export_folder(&order, &study, err);
    if (status == 0)
        warn(&study);
    study_result_clear(&study);
    if (status == 0)
        puts(out->path);
    return status == 0 ? output_flush(err) : status;
}

/* An archive that is there already is kept, unless it may be replaced. */
static int check_archive(const char *path, bool replace, struct error *err) {
    if (!replace && access(path, F_OK) == 0)
        return error_set(err, ERROR_INPUT, "%s exists; name another file by -o, or add --replace",
                         path);
    return output_file_check(path, err);
}

static int pack(struct access *access, const char *id, const char *folder,
                const struct result_folder *out, struct error *err) {
    const struct export_order order = {access, id, {.path = folder}};
    struct study_result study = {0};
    char name[TOP_SIZE], top[TOP_SIZE + 20], path[PATH_SIZE];
    size_t count = 0;
    int status = export_folder(&order, &study, err);
    if (status == 0) {
        file_name(study.name, name);
        snprintf(top, sizeof top, "%s-%.8s", name, study.id);
        snprintf(path, sizeof path, "%.*s", PATH_SIZE - 1, out->path != NULL ? out->path : name);
        if (out->path == NULL)
            snprintf(path, sizeof path, "%s.zip", name);
        status = check_archive(path, out->replace, err);
    }
    if (status == 0)
        status = zip_folder(folder, top, path, &count, err);
    if (status == 0)
        warn(&study);
    study_result_clear(&study);
    if (status == 0)
        printf("%s: %zu files\n", path, count);
    return status == 0 ? output_flush(err) : status;
}

/* The files of an archive are written beside it first, and removed also after an interruption. */
static int write_archive(struct access *access, const char *id, const struct result_folder *out,
                         struct error *err) {
    char folder[PATH_SIZE];
    const char *slash = out->path != NULL ? strrchr(out->path, '/') : NULL;
    int before = slash != NULL ? (int)(slash - out->path) + 1 : 0;
    int status = out->path != NULL ? check_archive(out->path, out->replace, err) : 0;
    if (status != 0)
        return status;
    if (snprintf(folder, sizeof folder, "%.*s.rugo-export-XXXXXX", before,
                 out->path != NULL ? out->path : "") >= (int)sizeof folder)
        return error_set(err, ERROR_INPUT, "the path %.100s... is too long", out->path);
    signals_catch();
    if (mkdtemp(folder) == NULL)
        return error_set(err, ERROR_SYSTEM, "cannot make folder %s: %s", folder, strerror(errno));
    status = pack(access, id, folder, out, err);
    remove_folder(folder);
    return status;
}

static bool is_other_archive(const char *path) {
    static const char *const ENDINGS[] = {".tar", ".gz", ".tgz", ".xz", ".bz2", ".7z"};
    for (size_t e = 0; e < sizeof ENDINGS / sizeof *ENDINGS; e++)
        if (file_ends_in(path, ENDINGS[e]))
            return true;
    return false;
}

static int run(const void *values, const char *const *arguments) {
    const struct options *options = values;
    const char *path = options->out.path;
    struct error err = {0};
    char id[STUDY_ID_SIZE];
    struct access *access = NULL;
    if (access_options_check("export", &options->place) != 0)
        return EXIT_USAGE;
    if (path != NULL && is_other_archive(path))
        return usage_error("export",
                           "-o %.200s: allowed are archives that end in .zip, and folders", path);
    int status = access_open(&access, &options->place, ACCESS_READ, &err);
    if (status == 0)
        status = access_find(access, "export", arguments[0], id, &err);
    if (status == 0 && path != NULL && !file_ends_in(path, ".zip"))
        status = write_folder(access, id, &options->out, &err);
    else if (status == 0)
        status = write_archive(access, id, &options->out, &err);
    access_close(&access);
    return status != 0 ? command_fail("export", &err) : EXIT_DONE;
}

const struct command COMMAND_EXPORT = {
    .name = "export",
    .arguments = "ID",
    .summary = "all of a study in one archive for a repository, or in a folder",
    .least = 1,
    .most = 1,
    .options = OPTIONS,
    .options_size = sizeof(struct options),
    .run = run,
};
