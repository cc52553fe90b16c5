#include "server/command/map/sent_files.h"
#include <errno.h>
#include <stdlib.h>
#include <string.h>

/* Reads a number of bytes and what ends it, a comma or the end of the list. */
static int read_size(const char **list, size_t most, size_t *out, struct error *err) {
    char *end;
    errno = 0;
    const unsigned long long size = strtoull(*list, &end, 10);
    if (**list < '0' || **list > '9' || (*end != ',' && *end != '\0'))
        return error_set(err, ERROR_INPUT, "--sent takes sizes in bytes such as 120,77, not %.40s",
                         *list);
    if (errno != 0 || size > most)
        return error_set(err, ERROR_INPUT,
                         "--sent: %llu bytes of a file; standard input has %zu left", size, most);
    *out = (size_t)size;
    *list = *end == ',' ? end + 1 : end;
    return 0;
}

int sent_files_take(struct sent_files *out, char *text, size_t size, const char *sizes,
                    const char *const *names, struct error *err) {
    *out = (struct sent_files){.text = text, .size = size};
    size_t at = 0;
    int status = 0;
    while (status == 0 && names[out->count] != NULL && out->count < JOINT_PATCHES_MOST) {
        size_t of_file;
        status = read_size(&sizes, size - at, &of_file, err);
        if (status == 0) {
            at += of_file;
            out->names[out->count] = names[out->count];
            out->ends[out->count++] = at;
        }
    }
    if (status == 0 && (*sizes != '\0' || names[out->count] != NULL))
        status = error_set(err, ERROR_INPUT, "--sent has a size for each of up to %d files",
                           (int)JOINT_PATCHES_MOST);
    return status;
}

void sent_files_clear(struct sent_files *files) {
    free(files->text);
    *files = (struct sent_files){0};
}

static int copy(const struct sent_files *files, const char *name, size_t from, size_t to,
                char **text, size_t *size, struct error *err) {
    char *copied = malloc(to - from + 1);
    if (copied == NULL)
        return error_memory(err, to - from, name);
    memcpy(copied, files->text + from, to - from);
    copied[to - from] = '\0';
    *text = copied;
    *size = to - from;
    return 0;
}

int sent_files_read(const struct sent_files *files, const char *name, char **text, size_t *size,
                    struct error *err) {
    for (size_t f = 0; f < files->count; f++)
        if (strcmp(files->names[f], name) == 0)
            return copy(files, name, f > 0 ? files->ends[f - 1] : 0, files->ends[f], text, size,
                        err);
    return error_set(err, ERROR_INPUT, "%.80s: no file of this name was sent", name);
}

int sent_files_study(const struct sent_files *files, char **text, size_t *size, struct error *err) {
    const size_t begin = files->count > 0 ? files->ends[files->count - 1] : 0;
    return copy(files, "the study", begin, files->size, text, size, err);
}
