#include "core/file/written_file.h"
#include <errno.h>
#include <fcntl.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define PART_SUFFIX ".rugo-part"

/* Whether a file of this path may take the place of what is there; *mode is that of the file. */
static bool may_replace(const char *path, mode_t *mode) {
    struct stat there;
    *mode = 0;
    if (lstat(path, &there) != 0)
        return errno == ENOENT;
    *mode = there.st_mode & 07777;
    return S_ISREG(there.st_mode) && there.st_nlink == 1 && there.st_uid == geteuid() &&
           access(path, W_OK) == 0;
}

static char *name_part(const char *path) {
    size_t size = strlen(path) + sizeof PART_SUFFIX;
    char *part = array_create(size, 1);
    if (part != NULL)
        snprintf(part, size, "%s%s", path, PART_SUFFIX);
    return part;
}

/* Opens the part, or returns NULL with the reason in errno. */
static FILE *open_part(const char *part, mode_t mode) {
    int file = open(part, O_WRONLY | O_CREAT | O_TRUNC | O_NOFOLLOW | O_CLOEXEC, 0666);
    FILE *stream = file < 0 ? NULL : fdopen(file, "wb");
    if (stream != NULL && (mode == 0 || fchmod(file, mode) == 0))
        return stream;
    int reason = errno;
    if (file >= 0)
        (void)unlink(part);
    if (stream != NULL)
        (void)fclose(stream);
    else if (file >= 0)
        (void)close(file);
    errno = reason;
    return NULL;
}

static void clear(struct written_file *file) {
    free(file->path);
    free(file->part);
    *file = (struct written_file){.stream = NULL};
}

int written_file_open(struct written_file *file, const char *path, struct error *err) {
    mode_t mode;
    bool beside = may_replace(path, &mode);
    *file = (struct written_file){.path = strdup(path), .part = beside ? name_part(path) : NULL};
    if (file->path == NULL || (beside && file->part == NULL)) {
        clear(file);
        return error_memory(err, strlen(path), "the path of a file");
    }
    if (beside)
        file->stream = open_part(file->part, mode);
    if (beside && file->stream == NULL && errno != ENOSPC && errno != EDQUOT) {
        free(file->part);
        file->part = NULL;
    }
    if (file->part == NULL)
        file->stream = fopen(path, "wb");
    if (file->stream != NULL) {
        errno = 0; /* for the reason of a write that fails before the last one */
        return 0;
    }
    int status = error_set(err, ERROR_SYSTEM, "cannot open %s: %s", path, strerror(errno));
    clear(file);
    return status;
}

int written_file_close(struct written_file *file, int status, struct error *err) {
    bool failed = ferror(file->stream) != 0;
    if (fclose(file->stream) != 0)
        failed = true;
    if (!failed && status == 0 && file->part != NULL && rename(file->part, file->path) != 0)
        failed = true;
    if (failed && status == 0)
        status = error_set(err, ERROR_SYSTEM, "cannot write %s: %s", file->path,
                           strerror(errno != 0 ? errno : EIO));
    if (status != 0 && file->part != NULL)
        (void)unlink(file->part);
    clear(file);
    return status;
}
