/* A file that is whole or not there: it is written beside its place, as PATH.part-XXXXXX, and put
 * there when it is complete and on the disk.
 *
 * While it is written it is locked (flock), which the kernel ends with the process: a part that
 * nobody holds was left by a process that was killed, and part_file_create and
 * part_file_remove_left take such parts of the same path away. */
#ifndef RUGO_CORE_PART_FILE_H
#define RUGO_CORE_PART_FILE_H

#include "core/error.h"

struct part_file {
    int file;     /* empty at first, open for reading and writing */
    char *path;   /* of the part; owned; NULL: there is none (all zeros) */
    char *target; /* where it is to be; owned */
};
/* Makes an empty part; ERROR_INPUT when there is a file at path already. */
int part_file_create(struct part_file *part, const char *path, struct error *err);
/* Puts the part in its place, unless a file has come there meanwhile, and destroys it: after a
 * failure nothing of it is left. */
int part_file_publish(struct part_file *part, struct error *err);
/* Takes the part away. Accepts one that is all zeros. */
void part_file_destroy(struct part_file *part);
/* Takes away the parts of path that killed processes left. */
void part_file_remove_left(const char *path);

#endif
