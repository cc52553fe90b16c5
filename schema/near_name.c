#include "schema/near_name.h"
#include <ctype.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

enum { LONGEST = 31, FARTHEST = 2 };

static size_t least_of(size_t a, size_t b) {
    return a < b ? a : b;
}

static int lower(char letter) {
    return tolower((unsigned char)letter);
}

/* The edit distance of two names (Damerau 1964, swaps of neighbours), by rows of its table. */
static size_t distance(const char *a, const char *b) {
    size_t n = strnlen(a, LONGEST), m = strnlen(b, LONGEST), rows[3][LONGEST + 1];
    for (size_t j = 0; j <= m; j++)
        rows[0][j] = j;
    for (size_t i = 1; i <= n; i++) {
        size_t *row = rows[i % 3], *above = rows[(i - 1) % 3];
        row[0] = i;
        for (size_t j = 1; j <= m; j++) {
            bool same = lower(a[i - 1]) == lower(b[j - 1]);
            row[j] = least_of(above[j - 1] + !same, least_of(above[j], row[j - 1]) + 1);
            if (i > 1 && j > 1 && lower(a[i - 1]) == lower(b[j - 2]) &&
                lower(a[i - 2]) == lower(b[j - 1]))
                row[j] = least_of(row[j], rows[(i - 2) % 3][j - 2] + 1);
        }
    }
    return rows[n % 3][m];
}

/* What is typed whole within a name is as near as one letter. */
static size_t distance_typed(const char *typed, const char *name) {
    bool initial = typed[0] != '\0' && typed[1] == '\0' && lower(typed[0]) == lower(name[0]);
    bool part = strlen(typed) > 2 && strstr(name, typed) != NULL;
    return initial || part ? 1 : distance(typed, name);
}

void near_name_see(struct near_name *near, const char *name) {
    size_t far = distance_typed(near->typed, name), best = near->distance;
    bool near_enough = far <= 1 || (far <= FARTHEST && 3 * far <= strlen(near->typed));
    if (near->typed[0] == '\0' || !near_enough || (near->name != NULL && far >= best))
        return;
    near->name = name;
    near->distance = far;
}

const char *near_name_hint(const struct near_name *near, char hint[NEAR_HINT_SIZE]) {
    hint[0] = '\0';
    if (near->name != NULL)
        snprintf(hint, NEAR_HINT_SIZE, " (did you mean %.100s?)", near->name);
    return hint;
}
