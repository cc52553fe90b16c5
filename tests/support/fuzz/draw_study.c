#include "tests/support/fuzz/draw_study.h"
#include "schema/json/json.h"
#include "schema/study/common.h"
#include "tests/support/fuzz/fuzz.h"
#include <math.h>

enum { LEAVES_MOST = 7, SWEEP_MOST = 4, NUMBERS_MOST = 12, NAME_SIZE = 128 };

/* How a leaf is drawn. */
struct manner {
    bool odd;     /* may be what no study has */
    size_t items; /* of lists, mostly: those of one document go together by their length */
};

/* --- values --- */

static cJSON *odd_value(struct choices *choices) {
    switch (choose(choices, 9)) {
    case 0:
        return cJSON_CreateNull();
    case 1:
        return cJSON_CreateBool(choose_rarely(choices, 2));
    case 2:
        return cJSON_CreateString("");
    case 3:
        return cJSON_CreateString("12");
    case 4:
        return cJSON_CreateObject();
    case 5:
        return cJSON_CreateArray();
    case 6:
        return cJSON_Parse("[[1], [2, 3]]");
    case 7:
        return cJSON_Parse("{\"lengths\": 2, \"rms_heights\": 3}");
    default:
        return cJSON_CreateNumber(choose_odd_number(choices, false));
    }
}

/* A number of the row's range; where it may be odd, one beyond it as well. */
static double drawn_number(struct choices *choices, const struct parameter *row,
                           struct manner manner) {
    bool whole = row->type == PARAMETER_INTEGER || row->type == PARAMETER_SEED;
    if (manner.odd && choose_rarely(choices, 4))
        return choose_odd_number(choices, false);
    double number = choose_number(choices, row->minimum, row->maximum);
    if (manner.odd && choose_rarely(choices, 8))
        number = number < 1 ? number - 1 : 2 * number;
    return whole && !manner.odd ? rint(number) : number;
}

/* As many numbers as the row takes, rising mostly, as most lists must. */
static cJSON *drawn_numbers(struct choices *choices, const struct parameter *row,
                            struct manner manner) {
    size_t most = row->items_high < NUMBERS_MOST ? row->items_high : NUMBERS_MOST;
    size_t least = row->items_low < most ? row->items_low : most;
    size_t count = manner.items;
    if (count < least || count > most || choose_rarely(choices, 4))
        count = least + choose(choices, most - least + 1);
    bool rising = !choose_rarely(choices, 8);
    cJSON *list = cJSON_CreateArray();
    double number = 0;
    if (manner.odd && choose_rarely(choices, 6))
        count = choose(choices, 3);
    for (size_t a = 0; a < count; a++) {
        double next = drawn_number(choices, row, manner);
        number = rising && a > 0 ? number + fabs(next) / 8 + 0.01 : next;
        cJSON_AddItemToArray(list, cJSON_CreateNumber(fmin(number, row->maximum)));
    }
    return list;
}

static const char *drawn_choice(struct choices *choices, const struct choice *of) {
    size_t count = 0;
    while (of[count].name != NULL)
        count++;
    return of[choose(choices, count)].name;
}

static cJSON *drawn_choices(struct choices *choices, const struct parameter *row,
                            struct manner manner) {
    cJSON *list = cJSON_CreateArray();
    for (const struct choice *one = row->choices; one->name != NULL; one++)
        if (choose_rarely(choices, 2))
            cJSON_AddItemToArray(list, cJSON_CreateString(one->name));
    if (cJSON_GetArraySize(list) == 0 || (manner.odd && choose_rarely(choices, 4)))
        cJSON_AddItemToArray(list, cJSON_CreateString(drawn_choice(choices, row->choices)));
    return list;
}

static cJSON *drawn_measure(struct choices *choices, const struct parameter *row,
                            struct manner manner) {
    if (choose_rarely(choices, 4))
        return cJSON_CreateString(drawn_choice(choices, row->choices));
    cJSON *object = cJSON_CreateObject();
    cJSON_AddNumberToObject(object, drawn_choice(choices, row->units),
                            drawn_number(choices, row, manner));
    return object;
}

static cJSON *drawn_text(struct choices *choices, const struct parameter *row,
                         struct manner manner) {
    static const char *const TEXTS[] = {"a", "", "a\nb", "\xc3\xa9\xe2\x82\xac", "../x", "%s%n"};
    if (manner.odd)
        return cJSON_CreateString(TEXTS[choose(choices, sizeof TEXTS / sizeof *TEXTS)]);
    return row->example_json != NULL ? cJSON_Parse(row->example_json) : cJSON_CreateString("drawn");
}

/* One value of the row, no list of them. */
static cJSON *drawn_value(struct choices *choices, const struct parameter *row,
                          struct manner manner) {
    if (manner.odd && choose_rarely(choices, 3))
        return odd_value(choices);
    switch (row->type) {
    case PARAMETER_NUMBER:
    case PARAMETER_INTEGER:
    case PARAMETER_SEED:
        return cJSON_CreateNumber(drawn_number(choices, row, manner));
    case PARAMETER_TEXT:
        return drawn_text(choices, row, manner);
    case PARAMETER_CHOICE:
        return cJSON_CreateString(row->choices != NULL ? drawn_choice(choices, row->choices)
                                                       : "contact");
    case PARAMETER_FLAG:
        return cJSON_CreateBool((cJSON_bool)choose(choices, 2));
    case PARAMETER_NUMBERS:
        return row->choices != NULL && choose_rarely(choices, 2)
                   ? cJSON_CreateString(drawn_choice(choices, row->choices))
                   : drawn_numbers(choices, row, manner);
    case PARAMETER_CHOICES:
        return drawn_choices(choices, row, manner);
    case PARAMETER_MEASURE:
        return drawn_measure(choices, row, manner);
    }
    return cJSON_CreateNull();
}

/* Lists of one and of several values, where they make cases; elsewhere only as a fault. */
static cJSON *drawn_leaf(struct choices *choices, const struct parameter *row,
                         struct manner manner) {
    if (row->example_json != NULL && !manner.odd && choose_rarely(choices, 2))
        return cJSON_Parse(row->example_json);
    if (!choose_rarely(choices, 6) || (!row->sweep && !manner.odd))
        return drawn_value(choices, row, manner);
    cJSON *list = cJSON_CreateArray();
    for (uint64_t left = 1 + choose(choices, SWEEP_MOST); left > 0; left--)
        cJSON_AddItemToArray(list, drawn_value(choices, row, manner));
    return list;
}

/* --- documents --- */

/* Returns the object that holds the last name of a pointer, which is written to `name`; objects
 * that lead to it are made, in place of what is no object. */
static cJSON *holder_of(cJSON *document, const char *pointer, char name[NAME_SIZE]) {
    cJSON *object = document;
    for (const char *at = pointer + 1;;) {
        size_t length = strcspn(at, "/");
        snprintf(name, NAME_SIZE, "%.*s", (int)length, at);
        if (at[length] == '\0')
            return object;
        cJSON *next = cJSON_GetObjectItemCaseSensitive(object, name);
        if (!cJSON_IsObject(next)) {
            cJSON_DeleteItemFromObjectCaseSensitive(object, name);
            next = cJSON_AddObjectToObject(object, name);
            MUST(next != NULL);
        }
        object = next;
        at += length + 1;
    }
}

/* Takes the value; puts it in place of what is there, or beside it. */
static void put(cJSON *document, const char *pointer, cJSON *value, bool twice) {
    char name[NAME_SIZE];
    cJSON *holder = holder_of(document, pointer, name);
    MUST(value != NULL);
    if (!twice)
        cJSON_DeleteItemFromObjectCaseSensitive(holder, name);
    MUST(cJSON_AddItemToObject(holder, name, value));
}

static const struct parameter *row_of(const struct study_kind *kind, size_t index) {
    return index < COMMON_PARAMETERS.count
               ? &COMMON_PARAMETERS.rows[index]
               : parameter_row(kind->tables, index - COMMON_PARAMETERS.count);
}

static void put_leaf(cJSON *document, struct choices *choices, const struct parameter *row,
                     struct manner manner) {
    bool twice = manner.odd && choose_rarely(choices, 16);
    put(document, row->path, drawn_leaf(choices, row, manner), twice);
}

/* Puts a leaf, and often those of the same object beside it, many of which need each other. */
static void put_leaves(cJSON *document, struct choices *choices, const struct study_kind *kind,
                       struct manner manner) {
    size_t count = COMMON_PARAMETERS.count + parameter_count(kind->tables);
    const struct parameter *row = row_of(kind, choose(choices, count)), *other;
    size_t length = (size_t)(strrchr(row->path, '/') - row->path);
    bool nested = strchr(row->path + 1, '/') != NULL && strcspn(row->path + 1, "/") + 1 < length;
    put_leaf(document, choices, row, manner);
    if (!(nested || strncmp(row->path, "/target/", 8) == 0) || choose_rarely(choices, 3))
        return;
    for (size_t p = 0; (other = row_of(kind, p)) != NULL; p++)
        if (other != row && strncmp(other->path, row->path, length + 1) == 0 &&
            strchr(other->path + length + 1, '/') == NULL && !choose_rarely(choices, 4))
            put(document, other->path,
                other->example_json != NULL && !choose_rarely(choices, 4)
                    ? cJSON_Parse(other->example_json)
                    : drawn_leaf(choices, other, manner),
                false);
}

static void put_number(cJSON *document, const char *pointer, double value) {
    put(document, pointer, cJSON_CreateNumber(value), false);
}

/* A study that is whole, cheap and short: what is put into it finds the rest there. */
static cJSON *drawn_base(struct choices *choices, const struct study_kind *kind) {
    static const double HURSTS[] = {0.8, 0.2, 0.5, 1};
    cJSON *document = cJSON_CreateObject();
    MUST(document != NULL);
    put(document, "/name", cJSON_CreateString("drawn"), false);
    put(document, "/kind", cJSON_CreateString(kind->name), false);
    put_number(document, "/realisations", 1 + (double)choose(choices, 4));
    put_number(document, "/seed", (double)choose(choices, 256));
    put_number(document, "/surface/dimension", 1 + (double)choose(choices, 2));
    put_number(document, "/surface/hurst", HURSTS[choose(choices, 4)]);
    put_number(document, "/surface/wavelength_ratio", 2 + (double)choose(choices, 3));
    put_number(document, "/surface/length_ratio", 1 + (double)choose(choices, 4));
    put_number(document, "/surface/points_per_wavelength", 4 + 4 * (double)choose(choices, 2));
    if (choose_rarely(choices, 2))
        put_number(document, "/surface/rms_slope", 0.1);
    if (choose_rarely(choices, 2) && strcmp(kind->name, "contact") == 0)
        put(document, "/contact/pressures/values", cJSON_Parse("[0.05, 0.2]"), false);
    if (!choose_rarely(choices, 8) && strcmp(kind->name, "statistics") == 0)
        put(document, "/statistics/bins",
            cJSON_Parse("{\"height\": [-4, 4, 8], \"curvature\": [-8, 0, 8]}"), false);
    return document;
}

/* What no table has. */
static void put_unknown(cJSON *document, struct choices *choices) {
    static const char *const POINTERS[] = {"/Name", "/surface/hurts", "/surface/",
                                           "/x",    "/contact",       "/surface/heights/shape/c"};
    put(document, POINTERS[choose(choices, sizeof POINTERS / sizeof *POINTERS)], odd_value(choices),
        choose_rarely(choices, 4));
}

/* Takes away what the document has, an object of its leaves or one of them. */
static void take_leaf(cJSON *document, struct choices *choices) {
    cJSON *object = document;
    for (size_t depth = 0; depth < 3; depth++) {
        int count = cJSON_GetArraySize(object);
        cJSON *member = cJSON_GetArrayItem(object, (int)choose(choices, (uint64_t)count));
        if (!cJSON_IsObject(member) || choose_rarely(choices, 8)) {
            cJSON_Delete(cJSON_DetachItemViaPointer(object, member));
            return;
        }
        object = member;
    }
}

/* Gives leaves of documents that are to be plausible what they need. */
static void give_partners(cJSON *document) {
    static const char *const NEEDS[][3] = {
        {"/counter_surface", "/counter_surface/hurst", "0.5"},
        {"/counter_surface", "/counter_surface/wavelength_ratio", "2"},
        {"/counter_surface", "/surface/rms_slope", "0.1"},
        {"/counter_surface", "/counter_surface/rms_slope", "0.1"},
        {"/counter_surface/poisson", "/counter_surface/young", "2"},
        {"/counter_surface/young", "/contact/block_height", "\"infinite\""},
        {"/counter_surface/heights/second_shape", "/counter_surface/heights/distribution",
         "\"beta\""},
        {"/counter_surface/heights/second_shape", "/counter_surface/heights/shape", "2"},
        {"/counter_surface/heights/kurtosis", "/counter_surface/heights/distribution", "\"beta\""},
        {"/counter_surface/heights/kurtosis", "/counter_surface/heights/skewness", "0.1"},
        {"/counter_surface/heights/kurtosis", "/counter_surface/heights/kurtosis", "2.2"},
        {"/counter_surface/heights/tolerances", "/counter_surface/heights/tolerance", "0.01"},
        {"/counter_surface/heights/law", "/counter_surface/heights/law", "\"iterated\""},
        {"/counter_surface/spectrum/correlation", "/counter_surface/spectrum/lag", "[0, 1, 2, 4]"},
        {"/counter_surface/spectrum/correlation", "/counter_surface/spectrum/correlation",
         "[1, 0.6, 0.2, 0]"},
        {"/counter_surface", "/contact/law_difference", "\"none\""},
        {"/counter_surface", "/contact/model", "\"halfspace\""},
        {"/surface/plateau/rms_ratio", "/surface/plateau/offset", "-0.5"},
        {"/surface/plateau/hurst", "/surface/plateau/offset", "-0.5"},
        {"/surface/plateau/wavelength_ratio", "/surface/plateau/offset", "-0.5"},
        {"/surface/plateau/rolloff_ratio", "/surface/plateau/offset", "-0.5"},
        {"/surface/plateau/length_ratio", "/surface/plateau/offset", "-0.5"},
        {"/surface/plateau/anisotropy", "/surface/plateau/offset", "-0.5"},
        {"/surface/plateau/lay_angle", "/surface/plateau/offset", "-0.5"},
        {"/surface/plateau", "/surface/plateau/rms_ratio", "0.25"},
        {"/surface/plateau", "/surface/heights/distribution", "\"gaussian\""},
        {"/surface/plateau/material_ratio", "/surface/plateau/rms_ratio", "0.25"},
        {"/surface/heights/second_shape", "/surface/heights/distribution", "\"beta\""},
        {"/surface/heights/second_shape", "/surface/heights/shape", "2"},
        {"/surface/heights/kurtosis", "/surface/heights/distribution", "\"beta\""},
        {"/surface/heights/kurtosis", "/surface/heights/skewness", "0.1"},
        {"/surface/heights/kurtosis", "/surface/heights/kurtosis", "2.2"},
        {"/surface/grooves", "/surface/grooves/period", "4"},
        {"/surface/grooves", "/surface/grooves/depth", "1"},
        {"/surface/grooves/angle", "/surface/dimension", "2"},
        {"/surface/grooves/cross_angle", "/surface/dimension", "2"},
        {"/surface/grooves/cross_depth", "/surface/grooves/cross_period", "8"},
        {"/surface/grooves/cross_shape", "/surface/grooves/cross_period", "8"},
        {"/surface/grooves/cross_phases", "/surface/grooves/cross_amplitudes", "[1, 0.2]"},
        {"/surface/grooves/cross_phases", "/surface/grooves/cross_phases", "[0, 45]"},
        {"/surface/grooves/cross_amplitudes", "/surface/grooves/cross_shape", "\"harmonics\""},
        {"/surface/grooves/cross_amplitudes", "/surface/grooves/cross_period", "8"},
        {"/surface/grooves/phases", "/surface/grooves/amplitudes", "[1, 0.3]"},
        {"/surface/grooves/phases", "/surface/grooves/phases", "[0, 90]"},
        {"/surface/grooves/amplitudes", "/surface/grooves/shape", "\"harmonics\""},
        {"/surface/unit", "/surface/rms_slope", "0.1"},
        {"/contact/resistivity", "/contact/conductance", "true"},
        {"/contact/conductivity", "/contact/conductance", "true"},
        {"/contact/leak", "/surface/dimension", "2"},
        {"/contact/hardness", "/contact/pressures", "{\"values\": [0.05, 0.2]}"},
        {"/contact/hardness", "/contact/hardness", "0.5"},
        {"/contact/unload", "/contact/hardness", "0.5"},
        {"/contact/unload", "/contact/pressures", "{\"values\": [0.05, 0.2]}"},
        {"/contact/slip", "/contact/friction", "0.2"},
        {"/contact/slip/pressing", "/contact/slip/coupling", "true"},
        {"/contact/slip/coupling", "/contact/model", "\"halfspace\""},
        {"/contact/slip/to", "/contact/slip/to", "[0.5]"},
        {"/contact/slip/to", "/contact/slip/steps", "4"},
        {"/contact/slip/to", "/surface/dimension", "1"},
        {"/contact/slip/to", "/surface/rms_slope", "0.1"},
        {"/contact/slip/to", "/contact/model", "\"full\""},
        {"/contact/slip/steps", "/contact/slip/steps", "4"},
        {"/contact/slip/steps", "/surface/dimension", "1"},
        {"/contact/slip/steps", "/surface/rms_slope", "0.1"},
        {"/contact/slip/steps", "/contact/model", "\"full\""},
        {"/contact/slip/pressure", "/contact/slip/pressure", "0.1"},
        {"/contact/slip/pressure", "/contact/pressures", "{\"values\": [0.05, 0.2]}"},
        {"/contact/pressures/unit", "/surface/rms_slope", "0.1"},
        {"/contact/pressures/unit", "/contact/pressures/values", "[0.05, 0.2]"},
        {"/contact/pressures/unit", "/contact/pressure_pdf", "{}"},
        {"/contact/time_limit", "/surface/rms_slope", "0.1"},
        {"/contact/time_limit", "/contact/model", "\"full\""},
        {"/contact/areas", "/surface/rms_slope", "0.1"},
        {"/contact/areas", "/contact/model", "\"full\""},
        {"/contact/areas", "/contact/kinematics", "\"hencky\""},
        {"/contact/gap_direction", "/surface/rms_slope", "0.1"},
        {"/contact/gap_direction", "/contact/model", "\"full\""},
        {"/contact/gap_direction", "/contact/kinematics", "\"hencky\""},
        {"/contact/block_fine_height", "/surface/rms_slope", "0.1"},
        {"/contact/block_fine_height", "/contact/model", "\"full\""},
        {"/contact/block_fine_height", "/contact/block_height", "{\"lengths\": 1}"},
        {"/contact/block_fine_height", "/contact/transition_depth", "8"},
        {"/surface/heights/tolerances", "/surface/heights/tolerance", "0.01"},
        {"/surface/heights/tolerances", "/surface/heights/law", "\"iterated\""},
        {"/surface/spectrum/correlation", "/surface/spectrum/lag", "[0, 1, 2, 4]"},
        {"/surface/spectrum/correlation", "/surface/spectrum/correlation", "[1, 0.6, 0.2, 0]"},
    };
    for (size_t n = 0; n < sizeof NEEDS / sizeof *NEEDS; n++)
        if (json_at(document, NEEDS[n][0]) != NULL)
            put(document, NEEDS[n][1], cJSON_Parse(NEEDS[n][2]), false);
}

/* A target asks for an error in place of realisations: pairs that exclude each other are taken
 * apart in documents that are to be plausible. */
static void part_pairs(cJSON *document) {
    static const char *const PAIRS[][2] = {
        {"/target", "/realisations"},
        {"/surface/nayak_alpha", "/surface/wavelength_ratio"},
        {"/surface/rms_height", "/surface/rms_slope"},
        {"/surface/plateau/offset", "/surface/plateau/material_ratio"},
        {"/counter_surface", "/surface/plateau"},
        {"/counter_surface", "/surface/grooves"},
        {"/surface/plateau", "/surface/grooves"},
        {"/counter_surface/nayak_alpha", "/counter_surface/wavelength_ratio"},
        {"/counter_surface/rms_height", "/counter_surface/rms_slope"},
        {"/surface/heights/kurtosis", "/surface/heights/shape"},
        {"/counter_surface/heights/kurtosis", "/counter_surface/heights/shape"},
        {"/counter_surface/heights/kurtosis", "/counter_surface/heights/second_shape"},
        {"/counter_surface/heights/shape", "/counter_surface/heights/skewness"},
        {"/surface/heights/kurtosis", "/surface/heights/second_shape"},
        {"/surface/heights/shape", "/surface/heights/skewness"},
        {"/contact/pressures/values", "/contact/pressures/steps"},
        {"/contact/pressures/values", "/contact/pressures/to"},
        {"/contact/slip/to", "/contact/slip/coupling"},
        {"/contact/slip/to", "/contact/hardness"},
        {"/contact/slip/to", "/surface/grooves/angle"},
        {"/contact/slip/to", "/surface/grooves/cross_angle"},
    };
    for (size_t p = 0; p < sizeof PAIRS / sizeof *PAIRS; p++) {
        char name[NAME_SIZE];
        if (json_at(document, PAIRS[p][0]) != NULL && json_at(document, PAIRS[p][1]) != NULL)
            cJSON_DeleteItemFromObjectCaseSensitive(holder_of(document, PAIRS[p][1], name), name);
    }
}

char *draw_study(struct choices *choices, const struct study_kind *const *kinds) {
    size_t kind_count = 0;
    while (kinds[kind_count] != NULL)
        kind_count++;
    const struct study_kind *kind = kinds[choose(choices, kind_count)];
    bool plausible = choose(choices, 2) == 0;
    cJSON *document = drawn_base(choices, kind);
    struct manner manner = {.items = 2 + choose(choices, 4)};
    for (uint64_t left = choose(choices, LEAVES_MOST + 1); left > 0; left--) {
        manner.odd = !plausible && choose_rarely(choices, 3);
        put_leaves(document, choices, kind, manner);
    }
    if (!plausible && choose_rarely(choices, 3))
        take_leaf(document, choices);
    if (plausible) {
        put(document, "/name", cJSON_CreateString("drawn"), false);
        put(document, "/kind", cJSON_CreateString(kind->name), false);
        give_partners(document);
        part_pairs(document);
    } else if (choose_rarely(choices, 6))
        put_unknown(document, choices);
    char *text = json_print(document);
    cJSON_Delete(document);
    MUST(text != NULL);
    return text;
}
