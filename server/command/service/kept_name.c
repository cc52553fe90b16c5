#include "server/command/service/kept_name.h"
#include <ctype.h>
#include <stdio.h>
#include <string.h>
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

bool kept_name_is(const char *name, const char *before, const char *after) {
    static const char FORM[] = "00000000T000000Z";
    size_t length = strlen(before);
    if (strncmp(name, before, length) != 0)
        return false;
    name += length;
    for (const char *f = FORM; *f != '\0'; f++, name++)
        if (*f == '0' ? isdigit((unsigned char)*name) == 0 : *name != *f)
            return false;
    if (*name == '-')
        name += 1 + strspn(name + 1, "0123456789");
    return strcmp(name, after) == 0;
}
