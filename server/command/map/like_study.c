#include "server/command/map/like_study.h"
#include "core/map/height_map.h"
#include "core/map/preparation/preparation.h"
#include "core/statistics/spectra/joint_fit.h"
#include "jobs/kind.h"
#include "jobs/like/like_fit.h"
#include "jobs/like/like_parameters.h"
#include "jobs/like/like_strata.h"
#include "jobs/maps/map_artefact_words.h"
#include "schema/json/field.h"
#include "schema/json/json.h"
#include "schema/study/override.h"
#include "server/command/map/map_file.h"
#include <cjson/cJSON.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The contact of a measured surface, measured for the studies of surfaces like it. */

/* What a study says under /surface/like before its file is fitted: a name alone, or an object of
 * the file's name, of what is to be fitted, and of the options by which commands read and prepare
 * maps, by their names. */

enum { LIKE_NUMBERS_MOST = 8, LIKE_NUMBER_SIZE = 32 };

struct like_options {
    const char *file; /* borrowed, as all texts: the first of several */
    size_t file_count;
    const char *files[JOINT_PATCHES_MOST];
    struct map_options map;
    int spectrum, heights; /* enum like_spectrum, enum like_heights */
    int contact;           /* 0: the map is pressed, too, mirrored; 1: it is not */
    int off;               /* 0: refused; 1: stated */
    int uncertainty;       /* 0: posterior; 1: none */
    bool hold;             /* the surfaces hold the map */
    size_t number_count;
    char numbers[LIKE_NUMBERS_MOST]
                [LIKE_NUMBER_SIZE]; /* texts of numbers that were given as such */
};

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

/* Adds to /surface/like of a fitted study the contact of the map. The map is pressed by the model
 * and to the loads of the sub-maps of its first case. Adds nothing where the study is not of such a
 * kind, asks for an error, or is at fault; its reader reports the fault. */
static int like_contact_add(cJSON *document, const struct height_map *map, struct error *err) {
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

#define AT(member) offsetof(struct like_options, member)
static const struct option_row ROWS[] = {
    {"file", 0, OPTION_TEXT, 0, 0, AT(file), NULL, NULL, NULL},
    {"spectrum", 0, OPTION_CHOICE, 0, 0, AT(spectrum), "table|fit", "table", NULL},
    {"heights", 0, OPTION_CHOICE, 0, 0, AT(heights), "quantiles|fit|gaussian", "quantiles", NULL},
    {"contact", 0, OPTION_CHOICE, 0, 0, AT(contact), "mirrored|none", "mirrored", NULL},
    {"off", 0, OPTION_CHOICE, 0, 0, AT(off), "refused|stated", "refused", NULL},
    {"uncertainty", 0, OPTION_CHOICE, 0, 0, AT(uncertainty), "posterior|none", "posterior", NULL},
    {"hold", 0, OPTION_FLAG, 0, 0, AT(hold), NULL, NULL, NULL},
    MAP_OPTION_ROWS(struct like_options, map),
    {0}};

/* A member is named as the option, with underscores for dashes. */
static bool is_named(const struct option_row *row, const char *member) {
    const char *name = row->name;
    while (*name != '\0' && (*name == *member || (*name == '-' && *member == '_'))) {
        name++;
        member++;
    }
    return *name == '\0' && *member == '\0';
}

static int refuse(const cJSON *member, const char *allowed, struct error *err) {
    char *text = json_print(member);
    error_fill(err, ERROR_INPUT, "\"%.40s\": %.60s is not %.200s", member->string,
               text != NULL ? text : "?", allowed);
    free(text);
    return ERROR_INPUT;
}

/* Takes the number of a word of "text|json". */
static int take_choice(int *out, const struct option_row *row, const cJSON *member,
                       struct error *err) {
    const char *text = cJSON_GetStringValue(member), *word = row->argument;
    for (int n = 0; text != NULL && word != NULL; n++) {
        size_t length = strcspn(word, "|");
        if (strlen(text) == length && strncmp(text, word, length) == 0) {
            *out = n;
            return 0;
        }
        word = word[length] == '|' ? word + length + 1 : NULL;
    }
    return refuse(member, row->argument, err);
}

static int take_text(struct like_options *out, const char **text, const cJSON *member,
                     struct error *err) {
    *text = cJSON_GetStringValue(member);
    if (*text != NULL && **text != '\0')
        return 0;
    if (!cJSON_IsNumber(member) || out->number_count == LIKE_NUMBERS_MOST)
        return refuse(member, "a text", err);
    char *number = out->numbers[out->number_count++];
    snprintf(number, LIKE_NUMBER_SIZE, "%.17g", member->valuedouble);
    *text = number;
    return 0;
}

static int take(struct like_options *out, const struct option_row *row, const cJSON *member,
                struct error *err) {
    void *at = (char *)out + row->at;
    if (row->type == OPTION_CHOICE)
        return take_choice(at, row, member, err);
    if (row->type == OPTION_OPTIONAL && cJSON_IsBool(member)) {
        *(const char **)at = cJSON_IsTrue(member) != 0 ? row->standard : NULL;
        return 0;
    }
    if (row->type == OPTION_TEXT || row->type == OPTION_OPTIONAL)
        return take_text(out, at, member, err);
    if (!cJSON_IsBool(member))
        return refuse(member, "true or false", err);
    *(bool *)at = cJSON_IsTrue(member) != 0;
    return 0;
}

static int refuse_name(const char *name, struct error *err) {
    char known[300] = "";
    size_t used = 0;
    for (const struct option_row *row = ROWS; row->name != NULL && used < sizeof known; row++)
        used += (size_t)snprintf(known + used, sizeof known - used, "%s%s", used > 0 ? ", " : "",
                                 row->name);
    for (char *c = known; *c != '\0'; c++)
        *c = *c == '-' ? '_' : *c;
    return error_set(err, ERROR_INPUT, "unknown name \"%.60s\"; there are %s", name, known);
}

/* Takes the names of several maps of one surface. */
static int take_files(struct like_options *out, const cJSON *list, struct error *err) {
    const cJSON *name;
    out->file_count = 0;
    cJSON_ArrayForEach(name, list) {
        const char *text = cJSON_GetStringValue(name);
        if (text == NULL || *text == '\0' || out->file_count == JOINT_PATCHES_MOST)
            return error_set(err, ERROR_INPUT,
                             "a list of files has the names of 1 to %d maps of one surface",
                             (int)JOINT_PATCHES_MOST);
        out->files[out->file_count++] = text;
    }
    if (out->file_count == 0)
        return error_set(err, ERROR_INPUT, "a list without files");
    out->file = out->files[0];
    return 0;
}

/* Reads them from the value, which lends its texts. ERROR_INPUT names the member, its value and
 * what is allowed. */
static int like_options_parse(struct like_options *out, const cJSON *like, struct error *err) {
    *out = (struct like_options){.map.words.boundary = ASK_BOUNDARY_OPEN,
                                 .map.convert = MAP_CONVERT_SECONDS};
    int status = 0;
    if (cJSON_IsArray(like))
        return take_files(out, like, err);
    if (!cJSON_IsString(like) && !cJSON_IsObject(like))
        return error_set(err, ERROR_INPUT,
                         "neither the name of a file nor a list of them, nor an object with it");
    if (cJSON_IsString(like))
        out->file = like->valuestring;
    for (const cJSON *member = like->child; member != NULL && status == 0; member = member->next) {
        const struct option_row *row = ROWS;
        if (strcmp(member->string, "file") == 0 && cJSON_IsArray(member)) {
            status = take_files(out, member, err);
            continue;
        }
        while (row->name != NULL && !is_named(row, member->string))
            row++;
        status = row->name != NULL ? take(out, row, member, err) : refuse_name(member->string, err);
    }
    if (status == 0 && (out->file == NULL || *out->file == '\0'))
        status = error_set(err, ERROR_INPUT, "\"file\" is missing, the name of a measured surface");
    if (out->file_count == 0)
        out->files[out->file_count++] = out->file;
    return status;
}

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

/* Returns the origin of the map, beside the fit; borrows from the record and from steps. */
/* What was done to the map, and what the instrument left in it. */
static void write_steps(const struct preparation_record *record, char *steps) {
    char names[ARTEFACT_NAMES_SIZE];
    preparation_steps_text(record, steps, PREPARATION_STEPS_TEXT);
    map_artefact_names(names, &record->artefacts);
    const size_t used = strlen(steps);
    if (*names != '\0')
        snprintf(steps + used, PREPARATION_STEPS_TEXT - used, "%sleft in the map: %s",
                 used > 0 ? "; " : "", names);
}

static struct like_source source_of(const struct preparation_record *record, char *steps) {
    const char *bytes = preparation_text(record, "bytes");
    const char *format = preparation_text(record, "format");
    write_steps(record, steps);
    return (struct like_source){.file = preparation_text(record, "file"),
                                .sha256 = preparation_text(record, "sha256"),
                                .format = format != NULL ? format : "unknown",
                                .prepared = steps,
                                .detrend = record->detrend,
                                .bytes = bytes != NULL ? strtoull(bytes, NULL, 10) : 0};
}

/* The maps of a study, with what is known of each. */
struct maps {
    size_t count;
    struct height_map maps[JOINT_PATCHES_MOST];
    struct preparation_record records[JOINT_PATCHES_MOST];
    char steps[JOINT_PATCHES_MOST][PREPARATION_STEPS_TEXT];
    struct like_source sources[JOINT_PATCHES_MOST];
};

static void choose_source(struct like_source *source, const struct like_options *options) {
    source->spectrum = (enum like_spectrum)options->spectrum;
    source->heights = (enum like_heights)options->heights;
    source->off_stated = options->off == 1 || options->hold;
    source->hold = options->hold;
    source->uncertainty =
        options->uncertainty == 0 ? LIKE_UNCERTAINTY_POSTERIOR : LIKE_UNCERTAINTY_NONE;
}

static int read_maps(struct maps *maps, const char *study, const struct like_options *options,
                     struct error *err) {
    int status = 0;
    for (size_t m = 0; m < options->file_count && status == 0; m++) {
        char *place = place_of(study, options->files[m]);
        if (place == NULL)
            return error_memory(err, strlen(options->files[m]), "a file's name");
        status = map_options_read(&maps->maps[m], &maps->records[m], place, &options->map, err);
        if (status == 0) {
            maps->count++;
            maps->sources[m] = source_of(&maps->records[m], maps->steps[m]);
            maps->sources[m].file = options->files[m];
            choose_source(&maps->sources[m], options);
        }
        free(place);
    }
    return status;
}

/* Names the one file at fault; of several the message does. */
static int name_file(const char *study, const struct like_options *options, struct error *err) {
    char *place = options->file_count == 1 ? place_of(study, options->file) : NULL;
    int status = place != NULL ? error_context(err, "%s", place) : ERROR_INPUT;
    free(place);
    return status;
}

static int fit_maps(cJSON *document, const char *study, const struct like_options *options,
                    struct error *err) {
    struct maps *maps = array_create(1, sizeof *maps);
    if (maps == NULL)
        return error_memory(err, sizeof *maps, "maps of a surface");
    int status = read_maps(maps, study, options, err);
    const bool read = status == 0;
    if (status == 0)
        status = like_fit_together(cJSON_GetObjectItemCaseSensitive(document, "surface"),
                                   maps->count, maps->maps, maps->sources, err);
    if (status == 0 && options->contact == 0 && !options->hold)
        status = like_contact_add(document, &maps->maps[0], err);
    for (size_t m = 0; m < maps->count; m++)
        height_map_clear(&maps->maps[m]);
    free(maps);
    if (status == ERROR_INPUT && read)
        name_file(study, options, err);
    return status;
}

/* sent: the files that were sent with the study; NULL: they are read from the disk. */
static int fit_study(cJSON *document, const char *study, const struct map_options *sent,
                     struct error *err) {
    struct like_options options = {0};
    cJSON *surface = cJSON_GetObjectItemCaseSensitive(document, "surface");
    cJSON *like = cJSON_DetachItemFromObjectCaseSensitive(surface, "like");
    int status = like_options_parse(&options, like, err);
    if (sent != NULL) {
        options.map.sent = sent->sent;
        options.map.convert = sent->convert;
    }
    if (status == 0)
        status = fit_maps(document, study, &options, err);
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
        status = fit_study(document, path, NULL, err);
        if (status == 0)
            status = print(document, text, size, err);
        *fitted = status == 0;
    }
    cJSON_Delete(document);
    return status == 0 ? 0 : error_context(err, "%s", LIKE);
}

int like_study_fit_sent(char **text, size_t *size, const struct map_options *sent,
                        struct error *err) {
    cJSON *document = NULL;
    if (*size > JSON_LIMITS.bytes)
        return error_set(err, ERROR_INPUT, "a study of %zu bytes; allowed: %zu", *size,
                         JSON_LIMITS.bytes);
    int status = json_parse(*text, *size, NULL, &document, err);
    if (status != 0)
        return error_context(err, "the study");
    if (!is_unfitted(json_at(document, LIKE)))
        status = error_set(err, ERROR_INPUT, "no name of a file that was sent, nor a list of them");
    if (status == 0)
        status = fit_study(document, NULL, sent, err);
    if (status == 0)
        status = print(document, text, size, err);
    cJSON_Delete(document);
    return status == 0 ? 0 : error_context(err, "%s", LIKE);
}

/* What was measured may be what no study takes, such as heights that differ by rounding alone. */
static int check_study(const cJSON *document, struct error *err) {
    char *text = json_print(document);
    struct fault_list faults = {0};
    struct study *study = NULL;
    if (text == NULL)
        return error_memory(err, 0, "a study");
    int status = kind_read_study(&study, text, strlen(text), NULL, &faults, err);
    const struct fault *first = faults.faults;
    if (status == ERROR_INPUT && first != NULL && first->pointer != NULL && first->detail != NULL)
        error_set(err, ERROR_INPUT, "%s: %s", first->pointer, first->detail);
    study_destroy(&study);
    fault_list_clear(&faults);
    free(text);
    return status == 0 ? 0 : error_context(err, "no study can be made of the map");
}

static bool study_begin(cJSON *study, const char *file, size_t count, bool hold) {
    enum { REALISATIONS = 100, DRAWS = 16, NAME_SIZE = 100 };
    char name[NAME_SIZE];
    int used = snprintf(name, sizeof name, "like %.70s", file != NULL ? file : "a map");
    if (count > 1)
        snprintf(name + used, sizeof name - (size_t)used, " and %zu more", count - 1);
    return field_put_text(study, "name", name) && field_put_text(study, "kind", "statistics") &&
           cJSON_AddNumberToObject(study, "realisations", hold ? DRAWS : REALISATIONS) != NULL;
}

/* Writes both laws of a stratified map, and says so in its steps. */
static int put_strata(cJSON *surface, const struct height_map *map,
                      const struct plateau_law *strata, char steps[PREPARATION_STEPS_TEXT],
                      struct error *err) {
    char words[LIKE_STRATA_TEXT];
    int status = like_strata_put(surface, map, strata, words, err);
    const size_t used = strlen(steps);
    if (status == 0)
        snprintf(steps + used, PREPARATION_STEPS_TEXT - used, "%s%s", used > 0 ? "; " : "", words);
    return status;
}

int like_study_make(cJSON **out, size_t count, const struct height_map *maps,
                    const struct preparation_record *records, const struct plateau_law *strata,
                    bool hold, struct error *err) {
    struct sources {
        struct like_source source[JOINT_PATCHES_MOST];
        char steps[JOINT_PATCHES_MOST][PREPARATION_STEPS_TEXT];
    } *of = array_create(1, sizeof *of);
    cJSON *study = cJSON_CreateObject(), *surface = NULL;
    for (size_t m = 0; m < count && of != NULL; m++) {
        of->source[m] = source_of(&records[m], of->steps[m]);
        of->source[m].off_stated = true; /* by the study that is written */
        of->source[m].hold = hold;
        of->source[m].uncertainty = LIKE_UNCERTAINTY_POSTERIOR;
    }
    if (study != NULL && of != NULL && study_begin(study, of->source[0].file, count, hold))
        surface = cJSON_AddObjectToObject(study, "surface");
    int status = surface != NULL ? 0 : error_memory(err, 0, "a study");
    if (status == 0 && strata != NULL)
        status = put_strata(surface, &maps[0], strata, of->steps[0], err);
    if (status == 0)
        status = like_fit_together(surface, count, maps, of->source, err);
    free(of);
    if (status == 0)
        status = check_study(study, err);
    if (status == 0)
        *out = study;
    else
        cJSON_Delete(study);
    return status;
}
