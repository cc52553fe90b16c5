#include "server/show/word_list.h"
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

static const char MORE[] = "...";

static bool is_full(const char *list) {
    size_t length = strlen(list), more = strlen(MORE);
    return length >= more && strcmp(list + length - more, MORE) == 0;
}

void word_list_append(char *list, size_t size, const char *between, const char *word) {
    size_t used = strlen(list), gap = used > 0 ? strlen(between) : 0;
    if (is_full(list))
        return;
    /* with room behind it for what stands in the place of the next one */
    bool fits = used + gap + strlen(word) + strlen(between) + sizeof MORE <= size;
    snprintf(list + used, size - used, "%s%s", used > 0 ? between : "", fits ? word : MORE);
}

static bool is_listed(const char *list, const char *between, const char *word) {
    size_t length = strlen(word), gap = strlen(between);
    for (const char *at = list; at != NULL;) {
        if (strncmp(at, word, length) == 0 &&
            (at[length] == '\0' || strncmp(at + length, between, gap) == 0))
            return true;
        at = strstr(at, between);
        at = at != NULL ? at + gap : NULL;
    }
    return false;
}

void word_list_add(char *list, size_t size, const char *between, const char *word) {
    if (word != NULL && *word != '\0' && !is_listed(list, between, word))
        word_list_append(list, size, between, word);
}
