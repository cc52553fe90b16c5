#include "server/command/like_study.h"
#include "core/map/preparation_notes.h"
#include "jobs/like_fit.h"
#include "schema/json/field.h"
#include "schema/json/json.h"
#include "schema/study/override.h"
#include "server/command/like_contact.h"
#include "server/command/like_options.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char LIKE[] = "/surface/like";

/* Whether it names a file that is not fitted: a text, or an object without the file's digest. */
static bool is_unfitted(const cJSON *like) {
    return like != NULL && !(cJSON_IsObject(like) && cJSON_HasObjectItem(like, "sha256"));
}

/* --- the file --- */

/* The name of the file as the command finds it; caller frees. NULL when out of memory. */
static char *place_of(const char *study, const char *file) {
    const char *slash = study != NULL ? strrchr(study, '/') : NULL;
    char *place = NULL;
    int folder = slash != NULL && *file != '/' ? (int)(slash - study) + 1 : 0;
    return asprintf(&place, "%.*s%s", folder, folder > 0 ? study : "", file) < 0 ? NULL : place;
}

/* What is told of the map beside the fit; borrows from the record and from steps. */
static struct like_source source_of(const struct preparation_record *record, char *steps) {
    const char *bytes = preparation_text(record, "bytes");
    const char *format = preparation_text(record, "format");
    preparation_steps_text(record, steps, PREPARATION_STEPS_TEXT);
    return (struct like_source){.file = preparation_text(record, "file"),
                                .sha256 = preparation_text(record, "sha256"),
                                .format = format != NULL ? format : "unknown",
                                .prepared = steps,
                                .detrend = record->detrend,
                                .bytes = bytes != NULL ? strtoull(bytes, NULL, 10) : 0};
}

static int fit_map(cJSON *document, const char *place, const struct like_options *options,
                   struct error *err) {
    struct height_map map = {0};
    struct preparation_record record = {0};
    char steps[PREPARATION_STEPS_TEXT];
    int status = map_options_read(&map, &record, place, &options->map, err);
    if (status != 0)
        return status;
    struct like_source source = source_of(&record, steps);
    source.file = options->file;
    source.spectrum = (enum like_spectrum)options->spectrum;
    source.heights = (enum like_heights)options->heights;
    status = like_fit(cJSON_GetObjectItemCaseSensitive(document, "surface"), &map, &source, err);
    if (status == 0 && options->contact == 0)
        status = like_contact_add(document, &map, err);
    height_map_clear(&map);
    return status == 0 ? 0 : error_context(err, "%s", place);
}

static int fit_study(cJSON *document, const char *study, struct error *err) {
    struct like_options options = {0};
    cJSON *surface = cJSON_GetObjectItemCaseSensitive(document, "surface");
    cJSON *like = cJSON_DetachItemFromObjectCaseSensitive(surface, "like");
    int status = like_options_parse(&options, like, err);
    char *place = status == 0 ? place_of(study, options.file) : NULL;
    if (status == 0 && place == NULL)
        status = error_memory(err, strlen(options.file), "a file's name");
    if (status == 0)
        status = fit_map(document, place, &options, err);
    free(place);
    cJSON_Delete(like);
    return status;
}

/* --- the study --- */

static int print(const cJSON *document, char **text, size_t *size, struct error *err) {
    char *fitted = json_print(document);
    if (fitted == NULL)
        return error_memory(err, *size, "a fitted study");
    free(*text);
    *text = fitted;
    *size = strlen(fitted);
    return 0;
}

/* Reads the study with its changes; *document NULL where it is none, or its changes cannot be made.
 */
static int open_study(cJSON **document, const char *text, size_t size, const char *const *overrides,
                      struct error *err) {
    struct error reason = {0};
    int status = json_parse(text, size, NULL, document, &reason);
    for (size_t a = 0; status == 0 && overrides != NULL && overrides[a] != NULL; a++)
        status = override_apply(*document, overrides[a], &reason);
    if (status == 0)
        return 0;
    cJSON_Delete(*document);
    *document = NULL;
    return status == ERROR_INPUT ? 0 : error_set(err, status, "%s", reason.text);
}

int like_study_fit(char **text, size_t *size, const char *path, const char *const *overrides,
                   bool *fitted, struct error *err) {
    cJSON *document = NULL;
    *fitted = false;
    int status = open_study(&document, *text, *size, overrides, err);
    if (status == 0 && document != NULL && is_unfitted(json_at(document, LIKE))) {
        status = fit_study(document, path, err);
        if (status == 0)
            status = print(document, text, size, err);
        *fitted = status == 0;
    }
    cJSON_Delete(document);
    return status == 0 ? 0 : error_context(err, "%s", LIKE);
}

int like_study_make(cJSON **out, const struct height_map *map,
                    const struct preparation_record *record, struct error *err) {
    enum { REALISATIONS = 100, NAME_SIZE = 80 };
    char steps[PREPARATION_STEPS_TEXT], name[NAME_SIZE];
    const struct like_source source = source_of(record, steps);
    cJSON *study = cJSON_CreateObject();
    snprintf(name, sizeof name, "like %.70s", source.file != NULL ? source.file : "a map");
    cJSON *surface = NULL;
    if (study != NULL && field_put_text(study, "name", name) &&
        field_put_text(study, "kind", "statistics") &&
        cJSON_AddNumberToObject(study, "realisations", REALISATIONS) != NULL)
        surface = cJSON_AddObjectToObject(study, "surface");
    int status =
        surface != NULL ? like_fit(surface, map, &source, err) : error_memory(err, 0, "a study");
    if (status == 0)
        *out = study;
    else
        cJSON_Delete(study);
    return status;
}
