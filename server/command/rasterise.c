#include "server/command/rasterise.h"
#include "server/command/tool.h"
#include <errno.h>
#include <stdbool.h>
#include <string.h>

int rasterise(const char *svg, size_t size, FILE *out, struct error *err) {
    static const char *const ARGUMENTS[] = {"rsvg-convert", "--dpi-x=192", "--dpi-y=192",
                                            "--zoom=2", NULL};
    FILE *file = tmpfile();
    if (file == NULL)
        return error_set(err, ERROR_SYSTEM, "a temporary file: %s", strerror(errno));
    bool written =
        fwrite(svg, 1, size, file) == size && fflush(file) == 0 && fseek(file, 0, SEEK_SET) == 0;
    int status = written ? tool_convert(ARGUMENTS, fileno(file), fileno(out), err)
                         : error_set(err, ERROR_SYSTEM, "a temporary file: %s", strerror(errno));
    (void)fclose(file);
    return status == 0 ? 0
                       : error_context(err, "pixels need rsvg-convert (of librsvg, on Debian "
                                            "librsvg2-bin), a file named .svg does not");
}
