#include "server/command/service/secret_file.h"
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

int secret_file_check(const char *path, const struct stat *file, struct error *err) {
    mode_t open_to = file->st_mode & (file->st_uid == geteuid() ? 077 : 07);
    if (!S_ISREG(file->st_mode) || open_to == 0)
        return 0;
    return error_set(err, ERROR_INPUT,
                     "%s holds secrets and has mode %03o, open to others; chmod 600 %s makes it "
                     "its owner's alone",
                     path, (unsigned)(file->st_mode & 0777), path);
}

int secret_file_read(const char *path, bool open_too, char **text, size_t *size,
                     struct error *err) {
    struct stat about;
    int file = strcmp(path, "-") == 0 ? dup(STDIN_FILENO) : open(path, O_RDONLY | O_CLOEXEC);
    if (file < 0 || fstat(file, &about) != 0) {
        int status = error_set(err, errno == ENOENT ? ERROR_INPUT : ERROR_SYSTEM, "%s: %s", path,
                               strerror(errno));
        if (file >= 0)
            close(file);
        return status;
    }
    int status = open_too ? 0 : secret_file_check(path, &about, err);
    if (status == 0)
        status = whole_file_take(file, path, SECRET_BYTES_MOST, text, size, err);
    close(file);
    return status;
}

int secret_file_write(const char *path, const char *text, size_t size, struct error *err) {
    int file = open(path, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
    if (file < 0)
        return error_set(err, errno == EEXIST ? ERROR_INPUT : ERROR_SYSTEM, "%s: %s", path,
                         errno == EEXIST ? "exists, and is left as it is" : strerror(errno));
    errno = EIO; /* of a short write */
    bool whole = write(file, text, size) == (ssize_t)size && fsync(file) == 0;
    int reason = errno;
    if (close(file) == 0 && whole)
        return 0;
    unlink(path);
    return error_set(err, ERROR_SYSTEM, "%s: %s", path, strerror(reason));
}

/* The part is locked against another command by being there. */
int secret_file_replace(const char *path, const char *text, size_t size, struct error *err) {
    struct stat about;
    char part[PATH_MAX];
    if ((size_t)snprintf(part, sizeof part, "%s.part", path) >= sizeof part)
        return error_set(err, ERROR_INPUT, "%.80s...: a path longer than %d bytes", path, PATH_MAX);
    bool there = stat(path, &about) == 0;
    int status = secret_file_write(part, text, size, err);
    if (status != 0)
        return error_context(err, "another command changes %s, or left it unfinished", path);
    if (there &&
        (chown(part, about.st_uid, about.st_gid) != 0 || chmod(part, about.st_mode & 0777) != 0))
        status = error_set(err, ERROR_SYSTEM, "%s: cannot be given the owner of %s: %s", part, path,
                           strerror(errno));
    if (status == 0 && rename(part, path) != 0)
        status = error_set(err, ERROR_SYSTEM, "%s: %s", path, strerror(errno));
    if (status != 0)
        unlink(part);
    return status;
}
