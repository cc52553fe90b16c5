#include "worker/worker_name.h"

/* U+0080 to U+009F are control characters too, of two bytes. */
bool worker_name_is_plain(const char *name) {
    for (const unsigned char *at = (const unsigned char *)name; *at != 0; at++)
        if (*at < ' ' || *at == 0x7f || (*at == 0xc2 && at[1] >= 0x80 && at[1] < 0xa0))
            return false;
    return true;
}
