#include "core/file.h"
#include <errno.h>
#include <string.h>
#include <sys/stat.h>

int file_open(FILE **file, const char *path, struct error *err) {
    *file = fopen(path, "wb");
    return *file != NULL
               ? 0
               : error_set(err, ERROR_SYSTEM, "cannot open %s: %s", path, strerror(errno));
}

int file_close(FILE *file, const char *path, int status, struct error *err) {
    bool failed = ferror(file) != 0;
    if ((fclose(file) != 0 || failed) && status == 0)
        status = error_set(err, ERROR_SYSTEM, "cannot write %s: %s", path, strerror(errno));
    return status;
}

int folder_make(const char *path, struct error *err) {
    return mkdir(path, 0777) == 0 || errno == EEXIST
               ? 0
               : error_set(err, ERROR_SYSTEM, "cannot make %s: %s", path, strerror(errno));
}

bool file_ends_in(const char *path, const char *ending) {
    size_t length = strlen(path), last = strlen(ending);
    return length > last && strcmp(path + length - last, ending) == 0;
}
