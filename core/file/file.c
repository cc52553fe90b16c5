#include "core/file/file.h"
#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

int folder_make(const char *path, struct error *err) {
    return mkdir(path, 0777) == 0 || errno == EEXIST
               ? 0
               : error_set(err, ERROR_SYSTEM, "cannot make folder %s: %s", path, strerror(errno));
}

void file_sync_name(const char *path) {
    char *folder = strdup(path);
    if (folder == NULL)
        return;
    char *slash = strrchr(folder, '/');
    if (slash != NULL)
        slash[slash == folder] = '\0';
    int file = open(slash != NULL ? folder : ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (file >= 0) {
        (void)fsync(file);
        close(file);
    }
    free(folder);
}

char *file_pattern(const char *path, const char *ending) {
    size_t length = strlen(path), used = 0, last = strlen(ending) + 1;
    char *pattern = array_create(2 * length + last, 1);
    if (pattern == NULL)
        return NULL;
    for (size_t n = 0; n < length; n++) {
        if (strchr("*?[]\\", path[n]) != NULL)
            pattern[used++] = '\\';
        pattern[used++] = path[n];
    }
    memcpy(pattern + used, ending, last);
    return pattern;
}

bool file_ends_in(const char *path, const char *ending) {
    size_t length = strlen(path), last = strlen(ending);
    return length > last && strcasecmp(path + length - last, ending) == 0;
}
