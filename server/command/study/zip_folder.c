#include "server/command/study/zip_folder.h"
#include "server/command/command.h"
#include <dirent.h>
#include <errno.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <zip.h>

enum {
    PATH_SIZE = 4096,
    DOS_DATE = 1 << 5 | 1, /* 1980-01-01, the first that an archive can hold */
    RIGHTS = 0100644,      /* a file, rw-r--r-- */
};

static int by_name(const struct dirent **a, const struct dirent **b) {
    return strcmp((*a)->d_name, (*b)->d_name); /* the same order in every locale */
}

static int is_entry(const struct dirent *entry) {
    return entry->d_name[0] != '.';
}

static int refuse(zip_t *zip, const char *name, struct error *err) {
    return error_set(err, ERROR_SYSTEM, "archive: %s: %s", name, zip_strerror(zip));
}

static int add_file(zip_t *zip, const char *path, const char *name, struct error *err) {
    zip_source_t *source = zip_source_file(zip, path, 0, -1);
    if (source == NULL)
        return refuse(zip, name, err);
    zip_int64_t entry = zip_file_add(zip, name, source, ZIP_FL_ENC_UTF_8);
    if (entry < 0) {
        zip_source_free(source);
        return refuse(zip, name, err);
    }
    zip_uint64_t at = (zip_uint64_t)entry;
    bool good = zip_file_set_dostime(zip, at, 0, DOS_DATE, 0) == 0 &&
                zip_file_set_external_attributes(zip, at, 0, ZIP_OPSYS_UNIX,
                                                 (zip_uint32_t)RIGHTS << 16) == 0 &&
                zip_set_file_compression(zip, at, ZIP_CM_DEFLATE, 9) == 0;
    return good ? 0 : refuse(zip, name, err);
}

/* Adds one file; leaves out what is none. */
static int add_entry(zip_t *zip, const char *folder, const char *top, const char *name,
                     size_t *count, struct error *err) {
    char path[PATH_SIZE], inside[512];
    struct stat about;
    if (snprintf(path, sizeof path, "%s/%s", folder, name) >= (int)sizeof path)
        return error_set(err, ERROR_INPUT, "the path %.100s... is too long", folder);
    if (stat(path, &about) != 0)
        return error_set(err, ERROR_SYSTEM, "%s: %s", path, strerror(errno));
    if (!S_ISREG(about.st_mode))
        return 0;
    snprintf(inside, sizeof inside, "%.200s/%.255s", top, name);
    ++*count;
    return add_file(zip, path, inside, err);
}

static int add_all(zip_t *zip, const char *folder, const char *top, size_t *count,
                   struct error *err) {
    struct dirent **list = NULL;
    int entries = scandir(folder, &list, is_entry, by_name), status = 0;
    if (entries < 0)
        return error_set(err, ERROR_SYSTEM, "folder %s: %s", folder, strerror(errno));
    for (int e = 0; e < entries; e++) {
        if (status == 0)
            status = add_entry(zip, folder, top, list[e]->d_name, count, err);
        free(list[e]);
    }
    free(list);
    return status;
}

static int is_stopped(zip_t *zip, void *context) {
    (void)zip;
    return stop_is_requested(context);
}

int zip_folder(const char *folder, const char *top, const char *path, size_t *count,
               struct error *err) {
    int code = 0;
    zip_error_t fault;
    *count = 0;
    zip_t *zip = zip_open(path, ZIP_CREATE | ZIP_TRUNCATE, &code);
    if (zip == NULL) {
        zip_error_init_with_code(&fault, code);
        int status = error_set(err, ERROR_SYSTEM, "%s: %s", path, zip_error_strerror(&fault));
        zip_error_fini(&fault);
        return status;
    }
    int status = add_all(zip, folder, top, count, err);
    if (status == 0 && zip_register_cancel_callback_with_state(zip, is_stopped, NULL, NULL) != 0)
        status = refuse(zip, path, err);
    /* Closing writes it beside its path, and renames it when it is whole. */
    if (status == 0 && zip_close(zip) == 0)
        return 0;
    if (status == 0)
        status = zip_error_code_zip(zip_get_error(zip)) == ZIP_ER_CANCELLED
                     ? error_set(err, ERROR_STOPPED, "stopped")
                     : refuse(zip, path, err);
    zip_discard(zip);
    return status;
}
