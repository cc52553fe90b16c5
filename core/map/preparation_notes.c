#include "core/map/preparation_notes.h"
#include <stdio.h>
#include <string.h>

const char *preparation_text(const struct preparation_record *record, const char *name) {
    for (size_t n = 0; n < record->count; n++)
        if (strcmp(record->steps[n].name, name) == 0)
            return record->steps[n].text;
    return NULL;
}

static bool is_origin(const char *name) {
    static const char *const NAMES[] = {"file", "bytes", "sha256", "format", "layer", "program"};
    for (size_t n = 0; n < sizeof NAMES / sizeof *NAMES; n++)
        if (strcmp(NAMES[n], name) == 0)
            return true;
    return false;
}

void preparation_steps_text(const struct preparation_record *record, char *out, size_t size) {
    size_t used = 0;
    *out = '\0';
    for (size_t n = 0; n < record->count && used < size; n++)
        if (!is_origin(record->steps[n].name))
            used += (size_t)snprintf(out + used, size - used, "%s%s: %s", used > 0 ? "; " : "",
                                     record->steps[n].name, record->steps[n].text);
    for (char *c = out; *c != '\0'; c++)
        *c = *c == '_' ? ' ' : *c;
}
