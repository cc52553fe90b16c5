/* The files of a store: the database, its write-ahead log and their shared memory.
 *
 * SQLite finds the other two by their names alone. It replays a log of another database into this
 * one, and goes on in files whose names are gone. What can be known of that is looked at here.
 *
 * The database is never opened or closed beside SQLite: closing it would end all locks that this
 * process has on it (POSIX). It is read through the file that SQLite has open. */
#include "schema/store/store_internal.h"
#include <dirent.h>
#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

static const char *const SUFFIXES[STORE_FILES] = {"", "-wal", "-shm"};
/* In the header of a database: its page size, its pages, whose it is. */
enum {
    HEADER_SIZE = 100,
    LOG_HEADER_SIZE = 32,
    PAGE_SIZE_AT = 16,
    PAGES_AT = 28,
    APPLICATION_AT = 68
};

static bool name_file(const char *path, const char *suffix, char name[STORE_PATH_SIZE]) {
    return snprintf(name, STORE_PATH_SIZE, "%s%s", path, suffix) < STORE_PATH_SIZE;
}

static bool has_log(const char *path) {
    struct stat info;
    char log[STORE_PATH_SIZE];
    return name_file(path, "-wal", log) && stat(log, &info) == 0 && info.st_size > LOG_HEADER_SIZE;
}

/* --- before it is opened --- */

/* Finds another name of a file in its own folder; "" where there is none. */
static void find_other_name(const char *path, const struct stat *file, char name[STORE_PATH_SIZE]) {
    char folder[STORE_PATH_SIZE] = ".", at[STORE_PATH_SIZE];
    const char *slash = strrchr(path, '/'), *own = slash != NULL ? slash + 1 : path;
    *name = '\0';
    if (slash != NULL)
        snprintf(folder, sizeof folder, "%.*s", (int)(slash - path + 1), path);
    DIR *entries = opendir(folder);
    for (struct dirent *entry; entries != NULL && (entry = readdir(entries)) != NULL;) {
        struct stat info;
        if (strcmp(entry->d_name, own) != 0 &&
            snprintf(at, sizeof at, "%.*s%s", slash != NULL ? (int)(slash - path + 1) : 0, path,
                     entry->d_name) < (int)sizeof at &&
            lstat(at, &info) == 0 && info.st_ino == file->st_ino && info.st_dev == file->st_dev)
            snprintf(name, STORE_PATH_SIZE, "%s", at);
    }
    if (entries != NULL)
        closedir(entries);
}

/* Under each of its names a database would have a log of its own. */
static int check_links(const char *path, const struct stat *file, struct error *err) {
    char other[STORE_PATH_SIZE];
    char *real = file->st_nlink > 1 ? realpath(path, NULL) : NULL;
    if (real == NULL)
        return 0;
    find_other_name(real, file, other);
    free(real);
    return error_set(err, ERROR_INPUT,
                     "database %.150s has %ju names (hard links), and what is written under one is "
                     "lost to the other: remove %.150s%s",
                     path, (uintmax_t)file->st_nlink,
                     *other != '\0' ? other : "all but one; find -xdev -samefile lists them",
                     *other != '\0' ? ", or copy it instead of linking it" : "");
}

int files_check_before(const char *path, struct error *err) {
    struct stat info;
    bool log = has_log(path); /* before the database, which is there before its log */
    if (stat(path, &info) == 0)
        return check_links(path, &info, err);
    return !log ? 0
                : error_set(err, ERROR_INPUT,
                            "there is no database %.150s, but its log %.150s-wal: put the database "
                            "back, or move %.150s-wal and -shm aside",
                            path, path, path);
}

/* --- while it is opened --- */

static int file_of(struct store *store, sqlite3_file **out, struct error *err) {
    return sqlite3_file_control(store->db, "main", SQLITE_FCNTL_FILE_POINTER, out) == SQLITE_OK &&
                   (*out)->pMethods != NULL
               ? 0
               : error_set(err, ERROR_SYSTEM, "database %s has no file", store->path);
}

static bool is_in_memory(const struct store *store) {
    const char *path = sqlite3_db_filename(store->db, "main");
    return path == NULL || *path == '\0';
}

static bool is_moved(struct store *store) {
    int moved = 0;
    sqlite3_file_control(store->db, "main", SQLITE_FCNTL_HAS_MOVED, &moved);
    return moved != 0;
}

static uint32_t big_endian(const unsigned char *bytes, size_t count) {
    uint32_t value = 0;
    for (size_t b = 0; b < count; b++)
        value = value << 8 | bytes[b];
    return value;
}

/* Returns the bytes that a database has by its header. */
static int64_t bytes_by_header(const unsigned char header[HEADER_SIZE]) {
    uint32_t page = big_endian(header + PAGE_SIZE_AT, 2);
    return (int64_t)(page == 1 ? 65536 : page) * big_endian(header + PAGES_AT, 4);
}

/* Others hold the lock for a fraction of a millisecond: short random sleeps starve no process. */
int store_wait(void *context, int tries) {
    (void)context;
    unsigned nanoseconds;
    if (getrandom(&nanoseconds, sizeof nanoseconds, 0) < 0)
        nanoseconds = 0;
    struct timespec pause = {0, 100000 + (long)(nanoseconds % 400000)};
    nanosleep(&pause, NULL);
    return tries < BUSY_MS * 10 / 3; /* a pause is 0.3 ms on average */
}

/* The lock is that of a reader. Nobody makes, takes away or gives up a log meanwhile. SQLite takes
 * it over with its first reading, so that nobody comes in between. */
int files_check_opened(struct store *store, bool *moved, struct error *err) {
    unsigned char header[HEADER_SIZE] = {0};
    sqlite3_file *file = NULL;
    *moved = false;
    if (is_in_memory(store))
        return 0;
    int code, status = file_of(store, &file, err);
    if (status != 0)
        return status;
    for (int tries = 0; (code = file->pMethods->xLock(file, SQLITE_LOCK_SHARED)) == SQLITE_BUSY;)
        if (store_wait(NULL, tries++) == 0)
            break;
    *moved = is_moved(store);
    if (code != SQLITE_OK || *moved)
        return code == SQLITE_OK ? 0
               : code == SQLITE_BUSY
                   ? error_set(err, ERROR_SYSTEM,
                               "the database is busy: %s was locked by another process for %d s",
                               store->path, BUSY_MS / 1000)
                   : error_set(err, ERROR_SYSTEM, "database %s cannot be locked: %s", store->path,
                               sqlite3_errstr(code));
    code = file->pMethods->xRead(file, header, sizeof header, 0);
    if (code != SQLITE_OK && code != SQLITE_IOERR_SHORT_READ)
        return error_set(err, ERROR_SYSTEM, "database %s: %s", store->path, sqlite3_errstr(code));
    const char *path = sqlite3_db_filename(store->db, "main");
    if (header[VERSIONS_AT + 1] > 1 || !has_log(path))
        return 0;
    return error_set(err, ERROR_INPUT,
                     "database %.90s has no log, such as a copy by rugo snapshot: %.90s-wal is the "
                     "log of another file that was in its place. Nothing was changed. Move "
                     "%.90s-wal and -shm aside, or put that file back",
                     store->path, path, path);
}

void files_note(struct store *store) {
    const char *path = sqlite3_db_filename(store->db, "main");
    for (size_t f = 0; f < STORE_FILES; f++) {
        struct stat info;
        char name[STORE_PATH_SIZE];
        struct store_file *file = &store->files[f];
        file->known =
            !is_in_memory(store) && name_file(path, SUFFIXES[f], name) && stat(name, &info) == 0;
        if (file->known) {
            file->device = info.st_dev;
            file->inode = info.st_ino;
        }
        if (file->known && f == 0)
            atomic_store(&store->size, info.st_size);
    }
}

/* --- while it is open --- */

int store_check_names(const struct store *store, struct error *err) {
    const char *path = sqlite3_db_filename(store->db, "main");
    for (size_t f = 0; f < STORE_FILES; f++) {
        struct stat info;
        char name[STORE_PATH_SIZE];
        const struct store_file *file = &store->files[f];
        if (!file->known || !name_file(path, SUFFIXES[f], name))
            continue;
        bool gone = stat(name, &info) != 0;
        if (!gone && info.st_dev == file->device && info.st_ino == file->inode)
            continue;
        if (f == 0)
            return error_set(err, ERROR_SYSTEM,
                             "database %.200s is %s: nothing is written until that very file is "
                             "back, or the program is started anew",
                             store->path, gone ? "gone" : "another file than the one opened");
        return error_set(err, ERROR_SYSTEM,
                         "%s of database %.150s was moved, deleted or replaced: %.150s is %s. Put "
                         "it back, or end this program in order, not by kill -9: it writes what is "
                         "left of it to the database",
                         f == 1 ? "the log" : "the shared memory", store->path, name,
                         gone ? "gone" : "another file");
    }
    return 0;
}

/* Returns whether a file that was larger has fewer pages than its header says. A checkpoint writes
 * the header first, and the pages within a moment. */
static bool is_cut(struct store *store, int64_t size) {
    enum { LOOKS = 50, PAUSE_NS = 10000000 };
    unsigned char header[HEADER_SIZE] = {0};
    sqlite3_file *file = NULL;
    bool cut = file_of(store, &file, NULL) == 0;
    for (int looks = 0; cut && looks < LOOKS; looks++) {
        sqlite3_int64 now = size;
        if (looks > 0)
            nanosleep(&(struct timespec){0, PAUSE_NS}, NULL);
        cut = file->pMethods->xRead(file, header, sizeof header, 0) != SQLITE_OK;
        cut = file->pMethods->xFileSize(file, &now) == SQLITE_OK &&
              (cut || now < bytes_by_header(header));
    }
    return cut;
}

int store_check_size(struct store *store, struct store *opened, struct error *err) {
    struct stat info;
    const char *path = sqlite3_db_filename(opened->db, "main");
    int64_t seen = atomic_load(&opened->size);
    if (!opened->files[0].known || stat(path, &info) != 0 || info.st_size == seen)
        return 0;
    if (info.st_size < seen && (store == NULL || is_cut(store, info.st_size)))
        return error_set(err, ERROR_SYSTEM,
                         "database %.200s was cut to %jd bytes while it was open, of %jd or more: "
                         "restore a copy, then start the program anew",
                         opened->path, (intmax_t)info.st_size, (intmax_t)seen);
    atomic_store(&opened->size, info.st_size);
    return 0;
}

int files_check(struct store *store, struct error *err) {
    int status = store_check_names(store, err);
    return status != 0 ? status : store_check_size(store, store, err);
}

int file_ask_for_no_log(int file, const char *path, struct error *err) {
    static const unsigned char VERSIONS[] = {1, 1};
    if (pwrite(file, VERSIONS, sizeof VERSIONS, VERSIONS_AT) != (ssize_t)sizeof VERSIONS)
        return error_set(err, ERROR_SYSTEM, "%s: %s", path, strerror(errno));
    return 0;
}

/* --- what a stranger sent, or a backup is --- */

/* SQLite documents the header in "Database File Format", 1.3. */
int store_file_check(int file, uint64_t size, struct error *err) {
    unsigned char head[HEADER_SIZE];
    if (pread(file, head, HEADER_SIZE, 0) != HEADER_SIZE ||
        memcmp(head, "SQLite format 3", 16) != 0)
        return error_set(err, ERROR_SYSTEM, "these bytes are no database");
    if (big_endian(head + APPLICATION_AT, 4) != APPLICATION_ID)
        return error_set(err, ERROR_SYSTEM, "these bytes are a database of another program");
    int64_t bytes = bytes_by_header(head);
    if ((uint64_t)bytes != size)
        return error_set(err, ERROR_SYSTEM,
                         "these %llu bytes are a database of %lld by its header: it is not whole",
                         (unsigned long long)size, (long long)bytes);
    return 0;
}
