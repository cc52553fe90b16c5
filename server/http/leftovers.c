/* Copies of the store on their way to those who asked for one, and what is left of them. */
#include "core/part_file.h"
#include "server/http/service.h"
#include <errno.h>
#include <glob.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

int service_snapshot_path(const struct service *service, char path[SNAPSHOT_PATH_SIZE],
                          struct error *err) {
    if (snprintf(path, SNAPSHOT_PATH_SIZE, "%s.snapshot", service->database) < SNAPSHOT_PATH_SIZE)
        return 0;
    return error_set(err, ERROR_INPUT, "the path %.100s... is too long", service->database);
}

/* Earlier versions of the program named them DATABASE.snapshot-PROCESS-ADDRESS, and held no lock.
 */
static void remove_older(const char *path) {
    char pattern[SNAPSHOT_PATH_SIZE + 16];
    glob_t found;
    if (strpbrk(path, "*?[\\") != NULL)
        return;
    snprintf(pattern, sizeof pattern, "%s-[0-9]*-0x*", path);
    if (glob(pattern, GLOB_NOSORT, NULL, &found) != 0)
        return;
    for (size_t n = 0; n < found.gl_pathc; n++) {
        long process = strtol(found.gl_pathv[n] + strlen(path) + 1, NULL, 10);
        if (process > 0 && kill((pid_t)process, 0) != 0 && errno == ESRCH)
            (void)unlink(found.gl_pathv[n]);
    }
    globfree(&found);
}

void service_remove_left(const struct service *service) {
    char path[SNAPSHOT_PATH_SIZE];
    if (service_snapshot_path(service, path, NULL) != 0)
        return;
    part_file_remove_left(path);
    remove_older(path);
}
