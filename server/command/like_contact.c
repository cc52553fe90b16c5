#include "server/command/like_contact.h"
#include "jobs/kind.h"
#include "schema/json/json.h"
#include <stdlib.h>
#include <string.h>

/* Heights in lambda_s. */
static int measure(const struct study *study, const struct height_map *map, double wavelength,
                   cJSON *like, struct error *err) {
    const struct job_kind *kind = kind_of(study->kind);
    size_t points = grid_points(&map->grid);
    double *z = array_create(points, sizeof *z);
    void *one_case = NULL;
    int status = z != NULL
                     ? kind_case_create(&one_case, kind, study->cases[0].parameters, NULL, err)
                     : error_memory(err, points * sizeof *z, "a map");
    for (size_t i = 0; i < points && status == 0; i++)
        z[i] = map->z[i] / wavelength;
    if (status == 0)
        status = kind->measure_like(one_case, z, like, err);
    kind_case_destroy(kind, &one_case);
    free(z);
    return status;
}

static int read_study(struct study **out, const cJSON *document, struct error *err) {
    struct fault_list faults = {0};
    struct error reason = {0};
    char *text = json_print(document);
    if (text == NULL)
        return error_memory(err, sizeof *document, "a study");
    int status = kind_read_study(out, text, strlen(text), NULL, &faults, &reason);
    free(text);
    fault_list_clear(&faults);
    return status == 0 || status == ERROR_INPUT ? 0 : error_set(err, status, "%s", reason.text);
}

int like_contact_add(cJSON *document, const struct height_map *map, struct error *err) {
    const char *name = cJSON_GetStringValue(json_at(document, "/kind"));
    const struct job_kind *kind = name != NULL ? kind_find(name) : NULL;
    cJSON *surface = cJSON_GetObjectItemCaseSensitive(document, "surface");
    cJSON *like = cJSON_GetObjectItemCaseSensitive(surface, "like");
    struct study *study = NULL;
    if (kind == NULL || kind->measure_like == NULL || json_at(document, "/target") != NULL)
        return 0;
    if (height_map_holes(map) > 0)
        return error_set(err, ERROR_INPUT,
                         "%zu holes: the map is pressed beside the surfaces and needs all heights; "
                         "give \"fill\": true, or \"contact\": \"none\"",
                         height_map_holes(map));
    double wavelength = json_number_at(like, "/wavelength", 1);
    int status = read_study(&study, document, err);
    if (status == 0 && study != NULL)
        status = measure(study, map, wavelength, like, err);
    study_destroy(&study);
    return status;
}
