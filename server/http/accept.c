#include "server/http/accept.h"
#include <ctype.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* Returns the q among the parameters of a range. */
static double weight(const char *parameters, size_t size) {
    for (const char *at = parameters; at < parameters + size; at++) {
        if (*at != ';')
            continue;
        const char *name = at + 1 + strspn(at + 1, " \t");
        if (tolower((unsigned char)*name) == 'q' && name[1] == '=')
            return strtod(name + 2, NULL);
    }
    return 1;
}

/* How closely a range fits: 0 not at all, 1 as any type, 2 by the part before the slash, 3. */
static int fit_of(const char *range, size_t length, const char *type) {
    size_t major = strcspn(type, "/") + 1;
    if (length == strlen(type) && strncasecmp(range, type, length) == 0)
        return 3;
    if (length == major + 1 && range[major] == '*' && strncasecmp(range, type, major) == 0)
        return 2;
    return (length == 3 && memcmp(range, "*/*", 3) == 0) || (length == 1 && *range == '*');
}

double accept_quality(const char *accept, const char *type) {
    double quality = accept != NULL ? 0 : 1;
    int closest = 0;
    while (accept != NULL && *accept != '\0') {
        accept += strspn(accept, ", \t");
        size_t size = strcspn(accept, ","), length = strcspn(accept, ",; \t");
        int fit = fit_of(accept, length, type);
        if (fit > closest) {
            closest = fit;
            quality = weight(accept + length, size - length);
        }
        accept += size;
    }
    return quality;
}
