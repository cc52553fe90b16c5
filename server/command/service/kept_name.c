#include "server/command/service/kept_name.h"
#include <stdio.h>
#include <sys/stat.h>
#include <time.h>

enum { MOMENT = 16 /* letters of 20261126T190000Z */ };

int kept_name(char path[KEPT_PATH_SIZE], const char *before, const char *after, struct error *err) {
    char moment[MOMENT + 1];
    struct stat info;
    time_t now = time(NULL);
    struct tm utc = {0};
    gmtime_r(&now, &utc);
    strftime(moment, sizeof moment, "%Y%m%dT%H%M%SZ", &utc);
    int length = snprintf(path, KEPT_PATH_SIZE, "%s%s%s", before, moment, after);
    for (int n = 2; length < KEPT_PATH_SIZE && lstat(path, &info) == 0; n++)
        length = snprintf(path, KEPT_PATH_SIZE, "%s%s-%d%s", before, moment, n, after);
    return length < KEPT_PATH_SIZE
               ? 0
               : error_set(err, ERROR_INPUT, "the path %.200s... is too long", before);
}
