#include "server/command/map/together.h"
#include "server/command/map/like_study.h"
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

struct page {
    const struct map_together *together;
    const struct named_values *found;
};

static int draw(const void *context, FILE *file, struct error *err) {
    const struct page *page = context;
    return together_draw(page->together, page->found, file, err);
}

int together_run(const char *const *files, const struct map_options *options, const char *report,
                 bool printed, struct named_values *found, struct error *err) {
    struct map_together *together = array_create(1, sizeof *together);
    int status = together != NULL ? 0 : error_memory(err, sizeof *together, "maps of one surface");
    for (size_t f = 0; status == 0 && f < JOINT_PATCHES_MOST && files[f] != NULL; f++)
        status = add_file(together, files[f], options, err);
    if (status == 0)
        status = map_together_fit(together, err);
    if (status == 0)
        status = together_report_fill(found, together, err);
    const struct page page = {together, found};
    if (status == 0 && report != NULL)
        status = output_file_draw(report, draw, &page, err);
    if (status == 0 && printed)
        status = draw(&page, stdout, err);
    if (together != NULL)
        map_together_clear(together);
    free(together);
    return status;
}

/* The maps of a study. */
struct maps {
    size_t count;
    struct height_map map[JOINT_PATCHES_MOST];
    struct preparation_record record[JOINT_PATCHES_MOST];
};

int together_study(const char *const *files, const struct map_options *options, bool hold,
                   cJSON **study, struct error *err) {
    struct maps *maps = array_create(1, sizeof *maps);
    int status = maps != NULL ? 0 : error_memory(err, sizeof *maps, "maps of one surface");
    for (size_t f = 0; status == 0 && f < JOINT_PATCHES_MOST && files[f] != NULL; f++) {
        status = map_options_read(&maps->map[f], &maps->record[f], files[f], options, err);
        maps->count += status == 0 ? 1 : 0;
    }
    if (status == 0)
        status = like_study_make(study, maps->count, maps->map, maps->record, NULL, hold, err);
    for (size_t m = 0; maps != NULL && m < maps->count; m++)
        height_map_clear(&maps->map[m]);
    free(maps);
    return status;
}
