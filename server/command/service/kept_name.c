#include "server/command/service/kept_name.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>

enum { MOMENT = 16 /* letters of 20261126T190000Z */ };

int kept_name(char path[KEPT_PATH_SIZE], const char *before, const char *behind,
              struct error *err) {
    char moment[MOMENT + 1];
    struct stat info;
    time_t now = time(NULL);
    struct tm utc = {0};
    gmtime_r(&now, &utc);
    strftime(moment, sizeof moment, "%Y%m%dT%H%M%SZ", &utc);
    int length = snprintf(path, KEPT_PATH_SIZE, "%s%s%s", before, moment, behind);
    for (int n = 2; length < KEPT_PATH_SIZE && lstat(path, &info) == 0; n++)
        length = snprintf(path, KEPT_PATH_SIZE, "%s%s-%d%s", before, moment, n, behind);
    return length < KEPT_PATH_SIZE
               ? 0
               : error_set(err, ERROR_INPUT, "the path %.200s... is too long", before);
}

static size_t digits(const char *text) {
    return strspn(text, "0123456789");
}

bool is_kept_name(const char *name, const char *before, const char *behind) {
    size_t length = strlen(before);
    if (strncmp(name, before, length) != 0)
        return false;
    name += length;
    if (digits(name) != 8 || name[8] != 'T' || digits(name + 9) != 6 || name[15] != 'Z')
        return false;
    name += MOMENT;
    if (*name == '-' && digits(name + 1) > 0)
        name += 1 + digits(name + 1);
    return strcmp(name, behind) == 0;
}

/* The time of a kept name, and the number behind it. */
static const char *moment_of(const char *name, long *number) {
    const char *at = name + strlen(name);
    while (at > name && !(at[-1] == 'Z' && at - name >= MOMENT && at[-8] == 'T'))
        at--;
    *number = at > name && *at == '-' ? strtol(at + 1, NULL, 10) : 1;
    return at > name ? at - MOMENT : name;
}

int kept_name_compare(const char *one, const char *other) {
    long a, b;
    const char *first = moment_of(one, &a), *second = moment_of(other, &b);
    int order = strncmp(first, second, MOMENT);
    return order != 0 ? order : (a > b) - (a < b);
}
