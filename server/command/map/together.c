#include "server/command/map/together.h"
#include "server/command/output_file.h"
#include "server/show/map/together_report.h"
#include <stdlib.h>

static int add_file(struct map_together *together, const char *file,
                    const struct map_options *options, struct error *err) {
    struct height_map map = {0};
    struct preparation_record record = {0};
    int status = map_options_read(&map, &record, file, options, err);
    if (status != 0)
        return status;
    status = map_together_add(together, file, &map, record.boundary, err);
    height_map_clear(&map);
    return status == 0 ? 0 : error_context(err, "%s", file);
}

static int draw(const void *together, FILE *file, struct error *err) {
    return together_draw(together, file, err);
}

int together_run(const char *const *files, const struct map_options *options, const char *report,
                 struct named_values *found, struct error *err) {
    struct map_together *together = array_create(1, sizeof *together);
    int status = together != NULL ? 0 : error_memory(err, sizeof *together, "maps of one surface");
    for (size_t f = 0; status == 0 && f < JOINT_PATCHES_MOST && files[f] != NULL; f++)
        status = add_file(together, files[f], options, err);
    if (status == 0)
        status = map_together_fit(together, err);
    if (status == 0)
        status = together_report_fill(found, together, err);
    if (status == 0 && report != NULL)
        status = output_file_draw(report, draw, together, err);
    if (together != NULL)
        map_together_clear(together);
    free(together);
    return status;
}
