#include "schema/store/upkeep/store_restore.h"
#include "core/file/file.h"
#include "schema/store/store_internal.h"
#include <errno.h>
#include <fcntl.h>
#include <glob.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* What SQLite finds beside a database by its name. A journal is undone before it is moved. */
static const char *const BESIDE[] = {"-journal", "-wal", "-shm"};
enum { BESIDE_COUNT = sizeof BESIDE / sizeof *BESIDE, STEP = 1 << 20 };
/* The bytes that SQLite locks in a database: a reader holds one of the last 510. */
static const struct flock ALONE = {
    .l_type = F_WRLCK, .l_whence = SEEK_SET, .l_start = 0x40000000, .l_len = 512};

static int path_join(char path[STORE_PATH_SIZE], const char *first, const char *second,
                     const char *third, struct error *err) {
    return snprintf(path, STORE_PATH_SIZE, "%s%s%s", first, second, third) < STORE_PATH_SIZE
               ? 0
               : error_set(err, ERROR_INPUT, "the path %.200s... is too long", first);
}

static const char *name_of(const char *path) {
    const char *slash = strrchr(path, '/');
    return slash != NULL ? slash + 1 : path;
}

static bool has_bytes(const char *path, const char *suffix) {
    struct stat info;
    char name[STORE_PATH_SIZE];
    return path_join(name, path, suffix, "", NULL) == 0 && stat(name, &info) == 0 &&
           info.st_size > 0;
}

static int system_error(const char *verb, const char *path, struct error *err) {
    return error_set(err, ERROR_SYSTEM, "cannot %s %s: %s", verb, path, strerror(errno));
}

/* --- the copy --- */

static int check_backup(const char *backup, const char *database, struct stat *info,
                        struct error *err) {
    struct stat other;
    if (stat(backup, info) != 0)
        return error_set(err, errno == ENOENT ? ERROR_ABSENT : ERROR_SYSTEM, "backup %s: %s",
                         backup, strerror(errno));
    if (!S_ISREG(info->st_mode))
        return error_set(err, ERROR_INPUT, "backup %s is not a file", backup);
    if (stat(database, &other) == 0 && other.st_ino == info->st_ino && other.st_dev == info->st_dev)
        return error_set(err, ERROR_INPUT, "backup %s is the database %s itself", backup, database);
    for (size_t b = 0; b < BESIDE_COUNT - 1; b++)
        if (has_bytes(backup, BESIDE[b]))
            return error_set(err, ERROR_INPUT,
                             "backup %.150s has a log beside it, %.150s%s: it is a store that was "
                             "in use. rugo snapshot --db %.150s FILE makes a copy that can be "
                             "restored",
                             backup, backup, BESIDE[b], backup);
    return 0;
}

static int copy_bytes(int from, const char *backup, const struct part_file *part,
                      bool (*stop)(void *context), void *context, struct error *err) {
    char *bytes = array_create(STEP, 1);
    int status = bytes != NULL ? 0 : error_memory(err, STEP, "a copy");
    ssize_t got = 1;
    while (status == 0 && got > 0) {
        if (stop != NULL && stop(context)) {
            status = error_set(err, ERROR_STOPPED, "copying %s: stopped", backup);
            break;
        }
        got = read(from, bytes, STEP);
        if (got < 0)
            status = system_error("read", backup, err);
        for (ssize_t done = 0, more; status == 0 && done < got; done += more) {
            more = write(part->file, bytes + done, (size_t)(got - done));
            if (more <= 0)
                status = system_error("write", part->path, err);
        }
    }
    free(bytes);
    return status;
}

/* Whoever serves the database goes on to read it, whoever restores it. */
static int keep_owner(int file, const char *database, struct error *err) {
    struct stat info;
    char folder[STORE_PATH_SIZE];
    bool exists = stat(database, &info) == 0;
    snprintf(folder, sizeof folder, "%.*s.", (int)(name_of(database) - database), database);
    if (!exists && stat(folder, &info) != 0)
        return system_error("find folder", folder, err);
    if (fchmod(file, exists ? info.st_mode & 07777 : 0600) != 0)
        return system_error("give its mode to the copy of", database, err);
    return geteuid() != 0 || fchown(file, info.st_uid, info.st_gid) == 0
               ? 0
               : system_error("give its owner to the copy of", database, err);
}

static int finish_copy(const struct part_file *part, const char *database, struct error *err) {
    struct stat info;
    if (fstat(part->file, &info) != 0 || fsync(part->file) != 0)
        return system_error("bring to the disk", part->path, err);
    int status = store_file_check(part->file, (uint64_t)info.st_size, err);
    return status != 0 ? status : keep_owner(part->file, database, err);
}

int restore_copy(struct part_file *part, const char *backup, const char *database,
                 const char *folder, bool (*stop)(void *context), void *context,
                 struct error *err) {
    char target[STORE_PATH_SIZE];
    struct stat info;
    int file = -1;
    int status = path_join(target, folder, "/", name_of(database), err);
    if (status == 0)
        status = check_backup(backup, database, &info, err);
    if (status == 0 && (file = open(backup, O_RDONLY | O_CLOEXEC)) < 0)
        status = system_error("read", backup, err);
    if (status == 0)
        status = part_file_create(part, target, err);
    if (status == 0) {
        status = copy_bytes(file, backup, part, stop, context, err);
        if (status == 0 && (status = finish_copy(part, database, err)) != 0)
            error_context(err, "backup %.200s", backup);
        if (status != 0)
            part_file_destroy(part);
    }
    if (file >= 0)
        close(file);
    return status;
}

/* --- the files are changed --- */

static int refuse_open(int file, const char *path, struct error *err) {
    struct flock lock = ALONE;
    char line[64], program[32] = "";
    if (fcntl(file, F_OFD_GETLK, &lock) != 0 || lock.l_pid <= 0)
        return error_set(err, ERROR_STATE, "database %s is open in another process: end it first",
                         path);
    snprintf(line, sizeof line, "/proc/%ld/comm", (long)lock.l_pid);
    int comm = open(line, O_RDONLY | O_CLOEXEC);
    ssize_t length = comm < 0 ? -1 : read(comm, program, sizeof program - 1);
    program[length < 0 ? 0 : length] = '\0';
    program[strcspn(program, "\n")] = '\0';
    if (comm >= 0)
        close(comm);
    return error_set(err, ERROR_STATE, "database %s is open in process %ld%s%s: end it first", path,
                     (long)lock.l_pid, *program != '\0' ? ", " : "", program);
}

/* Locks a database as SQLite would to write it alone, by the open file, so that no closing of
 * another one unlocks it. *file is -1 where there is none. */
static int lock_database(const char *path, int *file, struct error *err) {
    struct flock lock = ALONE;
    *file = open(path, O_RDWR | O_CLOEXEC);
    if (*file < 0)
        return errno == ENOENT ? 0 : system_error("write", path, err);
    return fcntl(*file, F_OFD_SETLK, &lock) == 0 ? 0 : refuse_open(*file, path, err);
}

static int move_beside(const char *database, const char *folder, bool *moved, struct error *err) {
    char to[STORE_PATH_SIZE], from[STORE_PATH_SIZE];
    int status = path_join(to, folder, "/", name_of(database), err);
    size_t stem = strlen(to);
    for (size_t b = 0; b < BESIDE_COUNT && status == 0; b++) {
        status = path_join(from, database, BESIDE[b], "", err);
        if (status == 0 &&
            snprintf(to + stem, sizeof to - stem, "%s", BESIDE[b]) >= (int)(sizeof to - stem))
            status = error_set(err, ERROR_INPUT, "the path %.200s... is too long", folder);
        if (status == 0 && rename(from, to) == 0)
            *moved = true;
        else if (status == 0 && errno != ENOENT)
            status = system_error("move", from, err);
    }
    return status;
}

/* A change that was cut short is undone, as the next writer of the old file would have done: a
 * journal beside another file would change that one. */
static void undo_journal(const char *database) {
    sqlite3 *db = NULL;
    if (has_bytes(database, "-journal") &&
        sqlite3_open_v2(database, &db, SQLITE_OPEN_READWRITE, NULL) == SQLITE_OK)
        sqlite3_exec(db, "SELECT count(*) FROM sqlite_schema", NULL, NULL, NULL);
    sqlite3_close(db);
}

/* Until the logs of the old file are moved, store_open refuses them by this; after it, the database
 * asks for a log again. */
static int ask_for_no_log(const struct part_file *part, struct error *err) {
    return has_bytes(part->path, "-wal")
               ? error_set(err, ERROR_STATE, "%s is open in another process", part->path)
               : file_ask_for_no_log(part->file, part->path, err);
}

static int exchange(const char *copy, const char *database, bool exists, struct error *err) {
    if (renameat2(AT_FDCWD, copy, AT_FDCWD, database,
                  exists ? RENAME_EXCHANGE : RENAME_NOREPLACE) == 0)
        return 0;
    return error_set(err, ERROR_SYSTEM, "%s could not be exchanged with the copy: %s", database,
                     strerror(errno));
}

int restore_swap(struct part_file *part, const char *database, const char *folder, bool *kept,
                 struct error *err) {
    char copy[STORE_PATH_SIZE];
    int old = -1, new = -1;
    undo_journal(database);
    *kept = false;
    int status = path_join(copy, folder, "/", name_of(database), err);
    if (status == 0)
        status = lock_database(database, &old, err);
    if (status == 0)
        status = lock_database(part->path, &new, err);
    if (status == 0)
        status = ask_for_no_log(part, err);
    if (status == 0) {
        status = part_file_publish(part, err);
        if (status == 0 && (status = exchange(copy, database, old >= 0, err)) != 0)
            (void)unlink(copy);
        *kept = status == 0 && old >= 0;
        if (status == 0)
            status = move_beside(database, folder, kept, err);
        file_sync_name(copy);
        file_sync_name(database);
    }
    if (new >= 0)
        close(new);
    if (old >= 0)
        close(old);
    return status;
}

/* --- after a kill --- */

static bool expects_no_log(const char *database) {
    unsigned char versions[2] = {2, 2};
    int file = open(database, O_RDONLY | O_CLOEXEC);
    bool read = file >= 0 && pread(file, versions, sizeof versions, VERSIONS_AT) == sizeof versions;
    if (file >= 0)
        close(file);
    return read && versions[1] == 1;
}

/* The logs that a killed process left belong to the database of the newest folder. */
static int finish_in(const char *database, const char *folder, bool *finished, struct error *err) {
    char old[STORE_PATH_SIZE];
    if (path_join(old, folder, "/", name_of(database), NULL) != 0)
        return 0;
    part_file_remove_left(old);
    if (rmdir(folder) == 0 || !has_bytes(old, "") || has_bytes(old, "-wal") ||
        !expects_no_log(database) || !has_bytes(database, "-wal"))
        return 0;
    return move_beside(database, folder, finished, err);
}

int restore_finish(const char *database, bool *finished, struct error *err) {
    glob_t found;
    *finished = false;
    int file = -1, status = lock_database(database, &file, err);
    char *pattern = status == 0 ? file_pattern(database, ".before-restore-*") : NULL;
    if (pattern != NULL && glob(pattern, 0, NULL, &found) == 0) {
        for (size_t n = found.gl_pathc; n > 0 && status == 0 && !*finished; n--)
            status = finish_in(database, found.gl_pathv[n - 1], finished, err);
        globfree(&found);
    }
    if (status == 0 && pattern == NULL)
        status = error_memory(err, strlen(database), "a path");
    free(pattern);
    if (file >= 0)
        close(file);
    return status;
}

/* --- what the copy lacks --- */

int store_lacks(struct store *store, struct store *copy,
                int (*found)(void *context, const struct lacking_study *study), void *context,
                struct error *err) {
    sqlite3_stmt *row = NULL;
    int status = store_query(store, &row, err,
                             "SELECT public, name, owner, created FROM study WHERE id NOT "
                             "IN " DELETED_STUDIES " ORDER BY id",
                             "");
    int step;
    while (status == 0 && (step = store_step(store, row, err)) != 0) {
        int64_t there = 0;
        const struct lacking_study study = {
            (const char *)sqlite3_column_text(row, 0), (const char *)sqlite3_column_text(row, 1),
            (const char *)sqlite3_column_text(row, 2), (const char *)sqlite3_column_text(row, 3)};
        status = step < 0
                     ? step
                     : store_integer(copy, &there, err,
                                     "SELECT count(*) FROM study WHERE public = ?", "t", study.id);
        if (status == 0 && there == 0)
            status = found(context, &study);
    }
    return status;
}
