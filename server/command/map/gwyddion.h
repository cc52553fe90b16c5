/* Files of formats that this program does not read, converted by Gwyddion where it is installed. */
#ifndef RUGO_SERVER_COMMAND_MAP_GWYDDION_H
#define RUGO_SERVER_COMMAND_MAP_GWYDDION_H

#include "core/error.h"
#include <stddef.h>

enum { GWYDDION_SECONDS_MOST = 86400, GWYDDION_STEP = 160 };

struct gwyddion_file {
    char *data; /* owned: the bytes of a GWY file, followed by 0 */
    size_t size;
    char step[GWYDDION_STEP]; /* "by Gwyddion 2.62 from Alicona's AL3D" */
};

/* Has Gwyddion convert the bytes of a file, data[size] being 0, into its own format, which keeps
 * all digits and units. It runs in a folder of its own, without a screen and without the user's
 * settings, for so many seconds at most, within 512 MiB and 64 times the bytes of the file, and is
 * killed with all that it started. seconds 0: it is not asked. ERROR_INPUT names the format as far
 * as the first bytes do, and says what is missing; it is without the name of the file. */
int gwyddion_convert(struct gwyddion_file *out, const char *name, const char *data, size_t size,
                     unsigned seconds, struct error *err);
void gwyddion_file_clear(struct gwyddion_file *file);

#endif
