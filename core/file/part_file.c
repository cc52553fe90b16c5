#include "core/file/part_file.h"
#include "core/file/file.h"
#include <errno.h>
#include <fcntl.h>
#include <glob.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#define PART_SUFFIX ".part-"
#define PART_NAME PART_SUFFIX "XXXXXX"

enum { TRIES_MOST = 100 };

static void remove_unheld(const char *part) {
    int file = open(part, O_RDWR | O_CLOEXEC | O_NOFOLLOW);
    if (file < 0)
        return;
    if (flock(file, LOCK_EX | LOCK_NB) == 0)
        (void)unlink(part);
    close(file);
}

void part_file_remove_left(const char *path) {
    glob_t found;
    char *pattern = file_pattern(path, PART_SUFFIX "??????");
    if (pattern != NULL && glob(pattern, GLOB_NOSORT, NULL, &found) == 0) {
        for (size_t n = 0; n < found.gl_pathc; n++)
            remove_unheld(found.gl_pathv[n]);
        globfree(&found);
    }
    free(pattern);
}

/* Makes the file and locks it. *held is false where the name was taken, or another process removed
 * the file between the two steps because it seemed abandoned. */
static int make_part(struct part_file *part, bool *held, struct error *err) {
    struct stat info;
    uint32_t word;
    size_t length = strlen(part->target);
    if (getrandom(&word, sizeof word, 0) != (ssize_t)sizeof word)
        return error_set(err, ERROR_SYSTEM, "no random numbers from the kernel");
    snprintf(part->path + length, sizeof PART_NAME, PART_SUFFIX "%06x", (unsigned)(word >> 8));
    *held = false;
    part->file = open(part->path, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
    if (part->file < 0)
        return errno == EEXIST
                   ? 0
                   : error_set(err, ERROR_SYSTEM, "%s: no file can be made beside it: %s",
                               part->target, strerror(errno));
    *held = flock(part->file, LOCK_EX | LOCK_NB) == 0 && fstat(part->file, &info) == 0 &&
            info.st_nlink == 1;
    if (!*held)
        close(part->file);
    return 0;
}

int part_file_create(struct part_file *part, const char *path, struct error *err) {
    struct stat info;
    bool held = false;
    *part = (struct part_file){0};
    if (lstat(path, &info) == 0)
        return error_set(err, ERROR_INPUT, "%s exists; a new file is needed", path);
    part_file_remove_left(path);
    size_t size = strlen(path) + sizeof PART_NAME;
    struct part_file made = {-1, array_create(size, 1), strdup(path)};
    int status = 0;
    if (made.path == NULL || made.target == NULL)
        status = error_memory(err, size, "the path of a file");
    else
        memcpy(made.path, path, strlen(path));
    for (int tries = 0; status == 0 && !held; tries++)
        status = tries < TRIES_MOST
                     ? make_part(&made, &held, err)
                     : error_set(err, ERROR_SYSTEM, "%s cannot be locked", made.path);
    if (status != 0) {
        free(made.path);
        free(made.target);
        return status;
    }
    *part = made;
    return 0;
}

/* Renames without replacing; where the file system cannot do that in one step, in two. */
static int rename_part(const struct part_file *part) {
    struct stat info;
    if (renameat2(AT_FDCWD, part->path, AT_FDCWD, part->target, RENAME_NOREPLACE) == 0)
        return 0;
    if (errno != EINVAL && errno != ENOSYS)
        return -1;
    if (lstat(part->target, &info) == 0) {
        errno = EEXIST;
        return -1;
    }
    return rename(part->path, part->target);
}

int part_file_publish(struct part_file *part, struct error *err) {
    int status = 0;
    if (fsync(part->file) != 0)
        status = error_set(err, ERROR_SYSTEM, "%s: %s", part->target, strerror(errno));
    else if (rename_part(part) != 0)
        status =
            error_set(err, errno == EEXIST ? ERROR_INPUT : ERROR_SYSTEM, "%s: %s", part->target,
                      errno == EEXIST ? "exists; a new file is needed" : strerror(errno));
    else
        file_sync_name(part->target);
    part_file_destroy(part); /* after a success no such path is left */
    return status;
}

void part_file_destroy(struct part_file *part) {
    if (part->path == NULL)
        return;
    (void)unlink(part->path);
    close(part->file);
    free(part->path);
    free(part->target);
    *part = (struct part_file){0};
}
