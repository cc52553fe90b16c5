#include "core/instrument/unit_of.h"
#include "core/file/plain_text.h"
#include "core/map/length_unit.h"
#include <string.h>

bool unit_is_length(const char *name, double *metres) {
    return strcmp(name, "A") != 0 && length_unit_metres(name, strlen(name), metres);
}

void unit_keep(char kept[UNIT_ROOM], const char *name, double *metres) {
    *metres = 1;
    memset(kept, 0, UNIT_ROOM);
    if (unit_is_length(name, metres)) {
        kept[0] = 'm';
        return;
    }
    size_t used = 0, width;
    while (name[used] != '\0' && (width = text_shown(name + used)) > 0 && used + width < UNIT_ROOM)
        used += width;
    memcpy(kept, name, used);
}
