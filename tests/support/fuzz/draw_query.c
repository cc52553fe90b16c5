#include "tests/support/fuzz/draw_query.h"
#include "core/file/memory_file.h"
#include "jobs/kind.h"
#include "schema/json/json.h"
#include "server/http/route/route.h"
#include "tests/support/fuzz/fuzz.h"

enum { RIGHT_MOST = 6, ODD_MOST = 10, WORDS_MOST = 4 };

/* What the names of queries may have for values, beside those that follow from the study. A name
 * that stands nowhere here is given odd values alone. */
static const struct {
    const char *name, *right[RIGHT_MOST], *odd[ODD_MOST];
} VALUES[] = {
    {"limit", {"1", "10", "1000"}, {"0", "1001", "-1", "+5", "1.5", "99999999999999999999"}},
    {"results", {"true"}, {"false", "1"}},
    {"case", {"0", "1"}, {"2", "-1", "9223372036854775806", "9223372036854775807", "0x1"}},
    {"difference",
     {"1,0", "0,1"},
     {"0,0", "0", "1,", ",", "0,9", "0,9223372036854775807", "1,0,1"}},
    {"log", {"x", "y", "xy", "none", "auto"}, {"yx", "X"}},
    {"width", {"one", "two", "85", "85mm", "40", "1000"}, {"39", "1e300", "nan", "85cm", "-85"}},
    {"format", {"json", "json", "csv", "svg", "study", "text"}, {"xml"}},
    {"field", {"gap", "pressure", "height"}, {"slope"}},
    {"load", {"0.05", "0.2", "1"}, {"1e-300", "1e300", "nan", "inf", "-0.1", "0x1p-3", "0.1x"}},
    {"name", {"a.csv"}, {"a.x3p", "-x", "a", "../a.csv", "a\nb.csv", "\xff.csv"}},
    {"layer", {NULL}, {"1", "2", "Topography"}},
    {"columns", {"auto", "map"}, {"xz", "xyz", "rows"}},
    {"dx", {"0.5um", "1um"}, {"1e300", "0", "-1um", "0.5", "1xx", "nan", "1e-300um"}},
    {"unit", {"um"}, {"nm", "m", "lightyear"}},
    {"z_unit", {"nm", "um", "m"}, {"kg"}},
    {"missing", {"none", "-9999", "-9999,32767"}, {"x", "1,", "-9999nm", "1,2,3,4,5"}},
    {"crop", {"0,0,2,2", "0,0,3,2"}, {"1,1,4,4", "0,0,1e9,1", "-1,0,2,2", "2x2"}},
    {"stride", {"1", "1,2"}, {"0", "2,", "x", "1000000"}},
    {"lines", {"none", "mean", "median", "quadratic"}, {"cubic"}},
    {"lines_along", {"x", "y"}, {"z"}},
    {"despike", {"7", "4.5"}, {"0", "true", "1e300"}},
    {"deconvolve", {"tip=1um", "tip=2um,holes"}, {"tip=0", "1", "tip=1um,x"}},
    {"transpose", {"true", "false"}, {"yes"}},
    {"rotate", {"90", "30", "-90"}, {"361", "x", "1e300"}},
    {"detrend", {"none", "mean", "plane"}, {"quadratic", "99"}},
    {"fill", {"true", "false"}, {"yes"}},
    {"degroove", {"true", "false"}, {"yes"}},
    {"denoise", {"true", "false"}, {"yes"}},
    {"filter", {"S=2um", "L=4um", "robust"}, {"1,2", "S=0", "L=1e300um", "S=-1um"}},
    {"resample", {"2", "4"}, {"2x2", "0", "1000000"}},
    {"window", {"hann", "none"}, {"tukey"}},
    {"boundary", {"periodic", "open"}, {"auto"}},
    {"trust_from", {"1um"}, {"0", "1e300um"}},
    {"trust_to", {"2um"}, {"0", "1e300um"}},
    {"hold", {"true", "false"}, {"yes"}},
};
enum { VALUES_COUNT = sizeof VALUES / sizeof *VALUES };

static const char *const ODD[] = {"",
                                  "0",
                                  "-1",
                                  "nan",
                                  "1e300",
                                  "a,b,,c",
                                  "%s%n",
                                  "\"'<&>",
                                  "\n",
                                  "\xff",
                                  "@",
                                  ":",
                                  "\xc3\xa9\xe2\x82\xac",
                                  "=",
                                  "..",
                                  "/surface/hurst"};
enum { ODD_COUNT = sizeof ODD / sizeof *ODD };

/* A value as it is drawn. */
struct value {
    struct choices *choices;
    const struct query_drawing *drawing;
    FILE *file;
};

static bool is_odd(const struct value *value, unsigned times) {
    return value->drawing->odd && choose_rarely(value->choices, times);
}

static void put_word(const struct value *value, const char *const *words, size_t most) {
    size_t count = 0;
    while (count < most && words[count] != NULL)
        count++;
    if (count > 0)
        fputs(words[choose(value->choices, count)], value->file);
}

/* --- what the study has --- */

/* Returns a member of a list of the contents, or of an object; NULL where there is none. */
static const cJSON *drawn_item(const struct value *value, const cJSON *list) {
    int count = cJSON_GetArraySize(list);
    return count > 0 ? cJSON_GetArrayItem(list, (int)choose(value->choices, (uint64_t)count))
                     : NULL;
}

static const cJSON *contents_at(const struct value *value, const char *name) {
    const struct served_study *study = value->drawing->study;
    return cJSON_GetObjectItemCaseSensitive(study != NULL ? study->contents : NULL, name);
}

static const char *text_of_member(const cJSON *object, const char *name) {
    const char *text = cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(object, name));
    return text != NULL ? text : "";
}

/* A parameter that the study sweeps: a member of what a case says of it, whose name is its path. */
static const cJSON *drawn_swept(const struct value *value) {
    const cJSON *one = drawn_item(value, contents_at(value, "cases"));
    return drawn_item(value, cJSON_GetObjectItemCaseSensitive(one, "swept"));
}

/* The path, whole or its last name alone, of a parameter that is swept, or of any. */
static void put_parameter(const struct value *value, const cJSON *swept) {
    size_t kinds = 0;
    while (JOB_KINDS[kinds] != NULL)
        kinds++;
    const char *path = swept != NULL ? swept->string : "/surface/hurst";
    if (is_odd(value, 2)) {
        const struct parameter_table *const *tables =
            JOB_KINDS[choose(value->choices, kinds)]->tables;
        path = parameter_row(tables, choose(value->choices, parameter_count(tables)))->path;
    }
    fputs(choose_rarely(value->choices, 2) ? strrchr(path, '/') + 1 : path, value->file);
}

/* NAME=VALUE, some of them. */
static void put_where(const struct value *value) {
    static const char *const OTHERS[] = {"0.3", "0.8", "gaussian", "", "nan", "1e300"};
    for (uint64_t left = 1 + choose(value->choices, 2); left > 0; left--) {
        const cJSON *swept = drawn_swept(value);
        put_parameter(value, swept);
        fputc(is_odd(value, 16) ? '<' : '=', value->file);
        if (is_odd(value, 3) || swept == NULL)
            put_word(value, OTHERS, sizeof OTHERS / sizeof *OTHERS);
        else if (cJSON_IsNumber(swept))
            json_print_number(value->file, swept->valuedouble);
        else
            fputs(cJSON_IsString(swept) ? swept->valuestring : "", value->file);
        fputs(left > 1 ? "," : "", value->file);
    }
}

/* A factor of a picture: a parameter, or what else distinguishes curves. */
static void put_factor(const struct value *value) {
    static const char *const ATTRIBUTES[] = {"model", "series", "level", "kinematics", "pressure"};
    if (choose_rarely(value->choices, 2))
        put_word(value, ATTRIBUTES, sizeof ATTRIBUTES / sizeof *ATTRIBUTES);
    else
        put_parameter(value, drawn_swept(value));
}

/* ":model:series", each or not. */
static void put_attributes(const struct value *value, const cJSON *curve) {
    static const char *const LISTS[] = {"models", "series", "levels"};
    for (size_t n = 0; n < sizeof LISTS / sizeof *LISTS; n++) {
        const cJSON *one = drawn_item(value, cJSON_GetObjectItemCaseSensitive(curve, LISTS[n]));
        if (one == NULL || !choose_rarely(value->choices, 4))
            continue;
        fputc(':', value->file);
        if (cJSON_IsNumber(one))
            json_print_number(value->file, one->valuedouble);
        else
            fputs(is_odd(value, 4) ? "none" : cJSON_GetStringValue(one), value->file);
    }
}

/* A scalar, QUANTITY, QUANTITY@X, QUANTITY:word:word@X. A column is no whole curve. */
static void put_quantity(const struct value *value, bool column) {
    static const char *const PLACES[] = {"0.05", "0.02", "0.2", "0", "1", "nan", "1e300", "-1", ""};
    const cJSON *curve = drawn_item(value, contents_at(value, "curves"));
    const cJSON *scalar = drawn_item(value, contents_at(value, "scalars"));
    if (is_odd(value, 8)) {
        put_word(value, ODD, ODD_COUNT);
        return;
    }
    if (curve == NULL || choose_rarely(value->choices, column ? 2 : 4)) {
        fputs(scalar != NULL ? cJSON_GetStringValue(scalar) : "rms_height", value->file);
        return;
    }
    fputs(text_of_member(curve, "quantity"), value->file);
    bool placed = is_odd(value, 4) != (column || choose_rarely(value->choices, 4));
    if (placed) {
        put_attributes(value, curve);
        fputc('@', value->file);
        put_word(value, PLACES, value->drawing->odd ? 9 : 5);
    }
}

static void put_columns(const struct value *value) {
    for (uint64_t left = 1 + choose(value->choices, WORDS_MOST); left > 0; left--) {
        put_quantity(value, true);
        fputs(left > 1 ? "," : "", value->file);
    }
}

/* --- names --- */

/* A model, a series or a level of any curve of the study. */
static void put_attribute(const struct value *value, const char *list) {
    const cJSON *curve = drawn_item(value, contents_at(value, "curves"));
    const cJSON *one = drawn_item(value, cJSON_GetObjectItemCaseSensitive(curve, list));
    if (cJSON_IsNumber(one))
        json_print_number(value->file, one->valuedouble);
    else
        fputs(cJSON_IsString(one) ? one->valuestring : "layered", value->file);
}

/* Returns false where the name is none of those that depend on the study. */
static bool put_of_study(const struct value *value, const char *name) {
    const struct served *served = value->drawing->served;
    bool factor =
        strcmp(name, "colour") == 0 || strcmp(name, "dash") == 0 || strcmp(name, "panel") == 0;
    if (strcmp(name, "quantity") == 0)
        put_quantity(value, false);
    else if (strcmp(name, "columns") == 0)
        put_columns(value);
    else if (strcmp(name, "where") == 0)
        put_where(value);
    else if (strcmp(name, "x") == 0)
        put_parameter(value, drawn_swept(value));
    else if (factor)
        put_factor(value);
    else if (strcmp(name, "model") == 0)
        put_attribute(value, "models");
    else if (strcmp(name, "series") == 0)
        put_attribute(value, "series");
    else if (strcmp(name, "level") == 0)
        put_attribute(value, "levels");
    else if (strcmp(name, "after") == 0)
        fputs(served->study[choose(value->choices, served->studies)].id, value->file);
    else
        return false;
    return true;
}

static void put_value(const struct value *value, const char *name) {
    if (is_odd(value, 8)) {
        put_word(value, ODD, ODD_COUNT);
        return;
    }
    if (put_of_study(value, name))
        return;
    for (size_t n = 0; n < VALUES_COUNT; n++)
        if (strcmp(VALUES[n].name, name) == 0) {
            bool odd = is_odd(value, 2);
            put_word(value, odd ? VALUES[n].odd : VALUES[n].right, odd ? ODD_MOST : RIGHT_MOST);
            return;
        }
    put_word(value, ODD, ODD_COUNT);
}

static void put_escaped(const char *text, FILE *file) {
    for (; *text != '\0'; text++)
        if (strchr("%&=+# \n\r\"<>", *text) != NULL || (unsigned char)*text >= 0x7f)
            fprintf(file, "%%%02X", (unsigned char)*text);
        else
            fputc(*text, file);
}

static void put_pair(struct choices *choices, const struct query_drawing *drawing, const char *name,
                     FILE *file) {
    struct memory_file memory;
    MUST(memory_file_open(&memory));
    put_value(&(struct value){choices, drawing, memory.file}, name);
    char *text = memory_file_close(&memory, NULL);
    MUST(text != NULL);
    fprintf(file, "%s%s", name, drawing->odd && choose_rarely(choices, 16) ? "" : "=");
    put_escaped(text, file);
    free(text);
}

/* Whether a name is put where so many are put already. Others mean nothing without the first; a
 * load stands with a field, and a difference without much else. */
static bool is_wanted(struct choices *choices, const struct query_drawing *drawing,
                      const char *name, size_t put) {
    if (!drawing->odd && strcmp(name, "load") == 0)
        return put > 0;
    if (!drawing->odd && strcmp(name, "difference") == 0 && put > 1)
        return false;
    if (strcmp(name, "field") == 0 || strcmp(name, "z_unit") == 0)
        return choose_rarely(choices, 2);
    return name == drawing->names[0] ? choose(choices, 8) < 7 : choose_rarely(choices, 6);
}

void draw_query(struct choices *choices, const struct query_drawing *drawing, FILE *file) {
    size_t count = 0, put = 0;
    while (count < QUERY_NAMES_MOST && drawing->names[count] != NULL)
        count++;
    bool unknown = drawing->odd && choose_rarely(choices, 8);
    for (size_t n = 0; n < count + (unknown ? 1 : 0); n++) {
        const char *name = n < count ? drawing->names[n] : "nothing";
        bool wanted = is_wanted(choices, drawing, name, put);
        bool twice = drawing->odd && choose_rarely(choices, 32);
        for (unsigned times = wanted ? (twice ? 2 : 1) : 0; times > 0; times--) {
            fputc(put++ == 0 ? '?' : '&', file);
            put_pair(choices, drawing, name, file);
        }
    }
}
