#include "core/file/whole_file.h"
#include <errno.h>
#include <fcntl.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* One byte more than a regular file has shows its end; the sizes of pipes and of files of the
 * kernel are unknown. */
static size_t first_room(int file, size_t most) {
    struct stat about;
    bool known = fstat(file, &about) == 0 && S_ISREG(about.st_mode) && about.st_size >= 0;
    size_t size = known && (uintmax_t)about.st_size < most ? (size_t)about.st_size : 0;
    return size < WHOLE_FILE_ROOM ? WHOLE_FILE_ROOM + 1 : size + 1;
}

int whole_file_take(int file, const char *name, size_t most, char **text, size_t *size,
                    struct error *err) {
    size_t room = first_room(file, most), used = 0;
    char *bytes = malloc(room + 1);
    ssize_t part = 1;
    while (bytes != NULL && part > 0 && used <= most) {
        if (used == room) {
            room *= 2;
            char *larger = realloc(bytes, room + 1);
            if (larger == NULL)
                free(bytes);
            bytes = larger;
            continue;
        }
        part = read(file, bytes + used, room - used);
        used += part > 0 ? (size_t)part : 0;
    }
    if (bytes == NULL)
        return error_memory(err, room + 1, name);
    if (part < 0 || used > most) {
        int status = part < 0
                         ? error_set(err, ERROR_SYSTEM, "%s: %s", name, strerror(errno))
                         : error_set(err, ERROR_INPUT, "%s: larger than %zu bytes", name, most);
        free(bytes);
        return status;
    }
    bytes[used] = '\0';
    *text = bytes;
    *size = used;
    return 0;
}

int whole_file_read(const char *path, size_t most, char **text, size_t *size, struct error *err) {
    int file = open(path, O_RDONLY | O_CLOEXEC);
    if (file < 0)
        return error_set(err, errno == ENOENT ? ERROR_INPUT : ERROR_SYSTEM, "%s: %s", path,
                         strerror(errno));
    int status = whole_file_take(file, path, most, text, size, err);
    (void)close(file);
    return status;
}
