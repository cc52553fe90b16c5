#include "server/command/rasterise.h"
#include "server/command/tool.h"
#include <errno.h>
#include <stdbool.h>
#include <string.h>

static int convert(const char *const *arguments, const char *svg, size_t size, FILE *out,
                   struct error *err) {
    FILE *file = tool_file(err);
    if (file == NULL)
        return ERROR_SYSTEM;
    bool written =
        fwrite(svg, 1, size, file) == size && fflush(file) == 0 && fseek(file, 0, SEEK_SET) == 0;
    int status = written ? tool_convert(arguments, fileno(file), fileno(out), err)
                         : error_set(err, ERROR_SYSTEM, "a file in memory: %s", strerror(errno));
    (void)fclose(file);
    return status == 0 ? 0
                       : error_context(err, "pixels, PDF and EPS need rsvg-convert (of librsvg, on "
                                            "Debian librsvg2-bin), a file named .svg does not");
}

int rasterise(const char *svg, size_t size, FILE *out, struct error *err) {
    static const char *const PIXELS[] = {"rsvg-convert", "--dpi-x=192", "--dpi-y=192", "--zoom=2",
                                         NULL};
    return convert(PIXELS, svg, size, out, err);
}

int print_as(const char *format, const char *svg, size_t size, FILE *out, struct error *err) {
    const char *const arguments[] = {"rsvg-convert", "--format", format, NULL};
    return convert(arguments, svg, size, out, err);
}
