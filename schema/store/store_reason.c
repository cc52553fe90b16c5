/* Why the files of a store cannot be opened, read or written. SQLite says "unable to open database
 * file", "attempt to write a readonly database" or "disk I/O error" alone. */
#include "schema/store/store_internal.h"
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

static bool may(const char *path, int how) {
    return faccessat(AT_FDCWD, path, how, AT_EACCESS) == 0;
}

/* Names the first folder of the path that is not there or cannot be entered. */
static int check_folders(const char *path, struct error *err) {
    char folder[STORE_PATH_SIZE];
    for (const char *slash = strchr(path, '/'); slash != NULL; slash = strchr(slash + 1, '/')) {
        snprintf(folder, sizeof folder, "%.*s", (int)(slash - path) + 1, path);
        if (may(folder, X_OK))
            continue;
        if (errno == ENOENT)
            return error_set(err, ERROR_SYSTEM, "database %.200s: there is no folder %.200s", path,
                             folder);
        return error_set(err, ERROR_SYSTEM,
                         "database %.180s: user %u cannot enter folder %.180s: %s", path,
                         (unsigned)geteuid(), folder, strerror(errno));
    }
    return 0;
}

/* Checks one file or folder of the database, which need not be there. */
static int check_file(const char *path, const char *file, int how, const char *verb,
                      struct error *err) {
    struct stat info;
    if (may(file, how) || errno == ENOENT)
        return 0;
    int reason = errno;
    if (reason == EROFS)
        return error_set(err, ERROR_SYSTEM,
                         "database %.200s cannot be written: %.200s is on a file system that is "
                         "mounted read-only",
                         path, file);
    if (stat(file, &info) != 0)
        return error_set(err, ERROR_SYSTEM, "database %.200s: %.200s: %s", path, file,
                         strerror(errno));
    return error_set(err, ERROR_SYSTEM,
                     "database %.130s: user %u may not %s %.130s, which belongs to user %u and has "
                     "mode %03o: %s. Run as its owner, or name another database",
                     path, (unsigned)geteuid(), verb, file, (unsigned)info.st_uid,
                     (unsigned)(info.st_mode & 0777), strerror(reason));
}

/* The folder of a path, with its slash. */
static void folder_of(const char *path, char folder[STORE_PATH_SIZE]) {
    const char *slash = strrchr(path, '/');
    snprintf(folder, STORE_PATH_SIZE, "%.*s", slash != NULL ? (int)(slash - path) + 1 : 1,
             slash != NULL ? path : ".");
}

/* SQLite makes log and shared memory beside the file, which is where a link leads to. */
static int check_writing(const char *path, const char *file, struct error *err) {
    static const char *const BESIDE[] = {"-wal", "-shm", "-journal"};
    char name[STORE_PATH_SIZE];
    int status = check_file(path, file, W_OK, "write", err);
    folder_of(file, name);
    if (status == 0)
        status = check_file(path, name, W_OK, "make files in folder", err);
    for (size_t b = 0; status == 0 && b < sizeof BESIDE / sizeof *BESIDE; b++) {
        snprintf(name, sizeof name, "%s%s", file, BESIDE[b]);
        status = check_file(path, name, R_OK | W_OK, "write", err);
    }
    return status;
}

static int refuse_reader(const char *path, const char *file, struct error *err) {
    char folder[STORE_PATH_SIZE];
    folder_of(file, folder);
    if (!may(folder, W_OK) && errno == EROFS)
        return error_set(err, ERROR_SYSTEM,
                         "database %.130s cannot be read here: readers, too, need %.130s-wal and "
                         "-shm beside it, and its file system is mounted read-only. Read a copy in "
                         "another folder",
                         path, path);
    return error_set(err, ERROR_SYSTEM,
                     "database %.150s cannot be read here: readers, too, need %.150s-wal and -shm "
                     "beside it, and permission to write them. Read as its owner, or read a copy "
                     "by rugo snapshot",
                     path, path);
}

/* Returns 0 where nothing is found that this user may not do. */
static int check_all(const struct store *store, int reason, struct error *err) {
    struct stat info;
    const char *path = store->path;
    int status = check_folders(path, err);
    if (status == 0)
        status = check_file(path, path, R_OK, "read", err);
    if (status != 0)
        return status;
    char *real = lstat(path, &info) == 0 && S_ISLNK(info.st_mode) ? realpath(path, NULL) : NULL;
    const char *file = real != NULL ? real : path;
    if (!store->options.read_only)
        status = check_writing(path, file, err);
    else if (reason == 0)
        status = refuse_reader(path, file, err);
    free(real);
    return status;
}

int store_refused(const struct store *store, int reason, const char *what, struct error *err) {
    bool files_lack = reason == EMFILE || reason == ENFILE; /* this comes before permissions */
    int status = files_lack ? 0 : check_all(store, reason, err);
    return status != 0 ? status
                       : error_set(err, ERROR_SYSTEM, "database %.300s cannot be used: %s",
                                   store->path, reason != 0 ? strerror(reason) : what);
}

int disk_error(int reason, const char *database, const char *what, struct error *err) {
    struct rlimit limit;
    switch (reason) {
    case ENOSPC:
        return error_set(err, ERROR_SYSTEM, "the disk of database %s is full", database);
    case EDQUOT:
        return error_set(err, ERROR_SYSTEM,
                         "the disk quota of user %u is used up: database %s cannot grow",
                         (unsigned)geteuid(), database);
    case EFBIG:
        if (getrlimit(RLIMIT_FSIZE, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY)
            return error_set(err, ERROR_LIMIT,
                             "database %s cannot grow: this process may write files of up to %llu "
                             "bytes (ulimit -f). Raise the limit, and start the program anew",
                             database, (unsigned long long)limit.rlim_cur);
        return error_set(err, ERROR_SYSTEM,
                         "database %s cannot grow: its file system has no larger "
                         "files",
                         database);
    default:
        return error_set(err, ERROR_SYSTEM, "database %s: %s", database, what);
    }
}
