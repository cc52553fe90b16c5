/* A file that is whole or absent. It is written beside its target, as PATH.part-XXXXXX, and renamed
 * when it is complete and on the disk.
 *
 * While it is written it is locked (flock), and the kernel ends the lock with the process. So a
 * part without a lock was left by a process that was killed; part_file_create and
 * part_file_remove_left remove such parts of the same path. */
#ifndef RUGO_CORE_PART_FILE_H
#define RUGO_CORE_PART_FILE_H

#include "core/error.h"

struct part_file {
    int file;     /* empty at first, open for reading and writing */
    char *path;   /* of the part; owned; NULL: there is none (all zeros) */
    char *target; /* its final path; owned */
};
/* Makes an empty part; ERROR_INPUT when there is a file at path already. */
int part_file_create(struct part_file *part, const char *path, struct error *err);
/* Renames the part to its target, unless a file has appeared there, and destroys it: after a
 * failure nothing of it is left. */
int part_file_publish(struct part_file *part, struct error *err);
/* Removes the part. Accepts one that is all zeros. */
void part_file_destroy(struct part_file *part);
/* Removes the parts of path that killed processes left. */
void part_file_remove_left(const char *path);

#endif
