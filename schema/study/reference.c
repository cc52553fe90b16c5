#include "schema/study/reference.h"
#include "schema/near_name.h"
#include "schema/study/common.h"
#include "schema/study/value.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* All writers need the kinds, and the choices of /kind that are made of them. */
struct reference {
    const struct study_kind *const *kinds; /* NULL at the end */
    struct choice *names;                  /* owned */
};

enum { CELL_SIZE = 320 };

static void describe_type(const struct parameter *row, char *text, size_t size) {
    static const char *const WORDS[] = {
        [PARAMETER_NUMBER] = "number",   [PARAMETER_INTEGER] = "integer",
        [PARAMETER_TEXT] = "text",       [PARAMETER_SEED] = "integer, or a decimal string",
        [PARAMETER_CHOICE] = "one name", [PARAMETER_CHOICES] = "one name, or a list",
        [PARAMETER_FLAG] = "flag",
    };
    if (row->type == PARAMETER_NUMBERS && row->items_low == row->items_high)
        snprintf(text, size, "%zu numbers", row->items_low);
    else if (row->type == PARAMETER_NUMBERS)
        snprintf(text, size, "%s%zu to %zu numbers", row->choices != NULL ? "a name, or " : "",
                 row->items_low, row->items_high);
    else if (row->type == PARAMETER_MEASURE)
        snprintf(text, size, "a name, or a number with its unit");
    else
        snprintf(text, size, "%s", WORDS[row->type]);
}

/* Writes what a value may be: names, a range, or both. */
static void describe_range(const struct parameter *row, char *text, size_t size) {
    char range[80], names[CELL_SIZE / 4], units[CELL_SIZE / 4];
    value_range(row, range, sizeof range);
    if (row->type == PARAMETER_MEASURE) {
        value_choices(row->choices, names, sizeof names);
        value_choices(row->units, units, sizeof units);
        snprintf(text, size, "%s; %s of %s", names, range, units);
    } else if (row->type == PARAMETER_NUMBERS && row->choices != NULL) {
        value_choices(row->choices, names, sizeof names);
        snprintf(text, size, "%s; %s", names, range);
    } else if (row->choices != NULL) {
        value_choices(row->choices, text, size);
    } else if (row->type == PARAMETER_FLAG) {
        snprintf(text, size, "true, false");
    } else if (row->type == PARAMETER_TEXT) {
        snprintf(text, size, "%.0f to %.0f characters", row->minimum, row->maximum);
    } else if (row->type == PARAMETER_SEED) {
        snprintf(text, size, "0 to 2^64 - 1");
    } else {
        snprintf(text, size, "%s", range);
    }
}

static const char *or_dash(const char *text) {
    return text != NULL ? text : "-";
}

/* Writes the default of a row; that of /realisations is the kinds' own. */
static void describe_default(const struct reference *reference, const struct parameter *row,
                             char *text, size_t size) {
    snprintf(text, size, "%s",
             row->default_text != NULL ? row->default_text : or_dash(row->default_json));
    if (row->required)
        snprintf(text, size, "required");
    if (strcmp(row->path, "/realisations") != 0)
        return;
    size_t used = 0;
    for (size_t k = 0; reference->kinds[k] != NULL && used < size; k++)
        used += (size_t)snprintf(text + used, size - used, "%s%llu (%s)", k > 0 ? ", " : "",
                                 (unsigned long long)reference->kinds[k]->default_realisations,
                                 reference->kinds[k]->name);
}

/* --- tables and their kinds --- */

static bool has_table(const struct study_kind *kind, const struct parameter_table *table) {
    for (const struct parameter_table *const *one = kind->tables; *one != NULL; one++)
        if (*one == table)
            return true;
    return false;
}

/* Returns whether an earlier kind has the table, which is then already written. */
static bool was_shown(const struct reference *reference, size_t kind,
                      const struct parameter_table *table) {
    for (size_t k = 0; k < kind; k++)
        if (has_table(reference->kinds[k], table))
            return true;
    return false;
}

/* Writes the kinds that have a table: "statistics, contact". */
static void kinds_of(const struct reference *reference, const struct parameter_table *table,
                     char *text, size_t size) {
    size_t used = 0;
    *text = '\0';
    for (size_t k = 0; reference->kinds[k] != NULL && used < size; k++)
        if (has_table(reference->kinds[k], table))
            used += (size_t)snprintf(text + used, size - used, "%s%s", used > 0 ? ", " : "",
                                     reference->kinds[k]->name);
}

typedef void table_writer(FILE *file, const struct reference *reference,
                          const struct parameter_table *table, const char *path);

/* Writes every table once: what all studies have, then those of the kinds. */
static void write_tables(FILE *file, const struct reference *reference, const char *path,
                         table_writer *write) {
    write(file, reference, &COMMON_PARAMETERS, path);
    for (size_t k = 0; reference->kinds[k] != NULL; k++)
        for (const struct parameter_table *const *table = reference->kinds[k]->tables;
             *table != NULL; table++)
            if ((*table)->count > 0 && !was_shown(reference, k, *table))
                write(file, reference, *table, path);
}

/* Returns a row as it is listed: /kind with the names of the kinds as its choices. */
static struct parameter listed_row(const struct reference *reference,
                                   const struct parameter_table *table, size_t index) {
    struct parameter row = table->rows[index];
    if (row.type == PARAMETER_CHOICE && row.choices == NULL)
        row.choices = reference->names;
    return row;
}

/* --- text --- */

static bool is_below(const char *path, const char *row) {
    size_t length = path != NULL ? strlen(path) : 0;
    return length == 0 ||
           (strncmp(row, path, length) == 0 && (row[length] == '\0' || row[length] == '/'));
}

static void print_row(FILE *file, const struct reference *reference, const struct parameter *row) {
    char type[64], range[CELL_SIZE], usual[CELL_SIZE];
    describe_type(row, type, sizeof type);
    describe_range(row, range, sizeof range);
    describe_default(reference, row, usual, sizeof usual);
    fprintf(file, "  %s\n      %s\n", row->path, row->help);
    if (row->target_refusal != NULL)
        fprintf(file, "      (%s)\n", row->target_refusal);
    fprintf(file, "      %s: %s%s%s%s\n      default: %s; example: %s%s\n", type, range,
            row->unit != NULL ? " [" : "", row->unit != NULL ? row->unit : "",
            row->unit != NULL ? "]" : "", strcmp(usual, "-") == 0 ? "none" : usual,
            or_dash(row->example_json), row->sweep ? "; a list of values makes cases" : "");
}

static void print_table(FILE *file, const struct reference *reference,
                        const struct parameter_table *table, const char *path) {
    bool headed = false;
    for (size_t p = 0; p < table->count; p++) {
        struct parameter row = listed_row(reference, table, p);
        if (!is_below(path, row.path))
            continue;
        char kinds[CELL_SIZE];
        kinds_of(reference, table, kinds, sizeof kinds);
        if (!headed)
            fprintf(file, "%s (%s)\n", table->name, *kinds != '\0' ? kinds : "every kind");
        headed = true;
        print_row(file, reference, &row);
    }
    if (headed)
        fputc('\n', file);
}

/* --- Markdown --- */

/* Prints a cell, in which '|' is escaped. */
static void print_cell(FILE *file, const char *text, bool code) {
    fputs(code ? "| `" : "| ", file);
    for (; *text != '\0'; text++) {
        if (*text == '|')
            fputc('\\', file);
        fputc(*text, file);
    }
    fputs(code ? "` " : " ", file);
}

static void markdown_row(FILE *file, const struct reference *reference,
                         const struct parameter *row) {
    char text[CELL_SIZE];
    print_cell(file, row->path, true);
    describe_type(row, text, sizeof text);
    print_cell(file, text, false);
    print_cell(file, row->sweep ? "yes" : "-", false);
    describe_range(row, text, sizeof text);
    print_cell(file, text, false);
    print_cell(file, or_dash(row->unit), false);
    describe_default(reference, row, text, sizeof text);
    print_cell(file, text, false);
    print_cell(file, row->help, false);
    if (row->target_refusal != NULL)
        fprintf(file, "(%s) ", row->target_refusal);
    print_cell(file, or_dash(row->example_json), true);
    fputs("|\n", file);
}

static void markdown_table(FILE *file, const struct reference *reference,
                           const struct parameter_table *table, const char *path) {
    char kinds[CELL_SIZE];
    (void)path;
    kinds_of(reference, table, kinds, sizeof kinds);
    fprintf(file, "\n## %s\n\nOf studies of %s%s.\n\n", table->name,
            *kinds == '\0' ? "every kind" : "the kinds ", kinds);
    fputs("| path | type | sweeps | range | unit | default | meaning | example |\n"
          "| --- | --- | --- | --- | --- | --- | --- | --- |\n",
          file);
    for (size_t p = 0; p < table->count; p++) {
        struct parameter row = listed_row(reference, table, p);
        markdown_row(file, reference, &row);
    }
}

static const char INTRODUCTION[] =
    "# The study file\n\n"
    "<!-- Written by `rugo help study --format markdown` from the tables that read a study. -->\n\n"
    "A study is one JSON object. The parameters below are named by their path in it: "
    "`/surface/hurst` is\n`{\"surface\": {\"hurst\": 0.8}}`. Names that are not here are faults, "
    "and so are values out of their range; `rugo check`\nprints all of them at once, with the path "
    "and what is allowed. Where there are none, it prints all faults of values that do\nnot go "
    "together, such as loads that do not rise.\n\n"
    "```json\n"
    "{\n"
    "  \"name\": \"roughness and load\",\n"
    "  \"kind\": \"statistics\",\n"
    "  \"seed\": 7,\n"
    "  \"realisations\": 500,\n"
    "  \"surface\": {\"hurst\": [0.2, 0.5, 0.8], \"wavelength_ratio\": 16}\n"
    "}\n"
    "```\n\n"
    "**Sweeps.** Where the column \"sweeps\" says yes, a list of values in place of one makes "
    "cases: one of each value, and with several\nlists one of each combination, up to %d. They "
    "are numbered from 0 in the order of the file, the last list running fastest. A\nvalue that is "
    "an array itself, such as bins, is swept by a list of arrays.\n\n"
    "**Realisations.** Each case is computed on so many random surfaces; curves are their means, "
    "with standard errors that fall with\nthe root of their number. Realisation r of a case is the "
    "same surface whatever the number of realisations and workers.\n\n"
    "**Asking for an error.** In place of `realisations`, a study may have `\"target\": "
    "{\"error\": "
    "0.01}`: relative, at a confidence\nof 0.95. Of a contact study it is of every point of the "
    "curve, "
    "all sources together. What the study names is kept, and counts as part of\nthe question; what "
    "it "
    "leaves out of `/contact/levels` and `/surface/points_per_wavelength`, "
    "`/surface/length_ratio`, "
    "`/contact/tolerance`\nand `/contact/block_height` is chosen, and so are the realisations, in "
    "rounds. Of a statistics study it is the statistical error alone, and the\nrealisations are "
    "chosen. `rugo "
    "check` prints the plan and what it is expected to cost.\n\n"
    "**Random numbers.** All follow from the seed and the realisation: the same study gives the "
    "same results, to the bit. Realisation\nr of every case is made of the same random numbers, "
    "and "
    "a wave has the same phase in every case that has it, counted by its wave\nnumber in units of "
    "2 "
    "pi/L. So cases that differ in `/contact` alone see the same surfaces, and cases that differ "
    "in "
    "`hurst`, `shape`,\nscale or `wavelength_ratio` surfaces of the same phases: what differs "
    "between cases is their parameters alone, and their errors are correlated.\nWith `\"random\": "
    "\"independent\"` each case has random numbers of its own.\n\n"
    "**Limits.** A study has at most %d cases, with 20 million values in all. A "
    "case has at most %d realisations,\na surface 2^31 points, a mesh of the model full 2.7e8 "
    "nodes. A case must fit into nine tenths of the memory of the\nmachine that reads the "
    "study. A server refuses a study whose check takes more than a second of CPU time.\n\n"
    "Lengths are in units of lambda_s, the shortest wavelength. `-` as a unit: a pure number or "
    "none; as a default: absent unless given.\n";

/* --- together --- */

static int reference_open(struct reference *out, const struct study_kind *const *kinds,
                          struct error *err) {
    *out = (struct reference){kinds, kind_choices(kinds)};
    return out->names != NULL ? 0 : error_memory(err, sizeof *out->names, "kinds");
}

/* Accepts "surface.hurst" and "surface/hurst" for "/surface/hurst". */
static void path_read(const char *given, char *path, size_t size) {
    snprintf(path, size, "%s%s", *given == '/' ? "" : "/", given);
    for (char *at = path; *given != '/' && *at != '\0'; at++)
        if (*at == '.')
            *at = '/';
}

static bool is_known(const struct reference *reference, const char *path) {
    for (size_t p = 0; p < COMMON_PARAMETERS.count; p++)
        if (is_below(path, COMMON_PARAMETERS.rows[p].path))
            return true;
    const struct parameter *row;
    for (size_t k = 0; reference->kinds[k] != NULL; k++)
        for (size_t p = 0; (row = parameter_row(reference->kinds[k]->tables, p)) != NULL; p++)
            if (is_below(path, row->path))
                return true;
    return false;
}

/* What was likely meant by a path that is none: of paths whose last names are as near, one in the
 * object that was typed, then the shortest. */
struct near_path {
    const char *typed, *last; /* its last name */
    char path[POINTER_SIZE];  /* "": none is near */
    size_t distance;
    bool same_object;
};

static void see_path(struct near_path *near, const char *path) {
    struct near_name last = {.typed = near->last};
    const char *name = strrchr(path, '/') + 1;
    const size_t before = (size_t)(near->last - near->typed);
    near_name_see(&last, name);
    if (last.name == NULL)
        return;
    bool same = (size_t)(name - path) == before && strncmp(path, near->typed, before) == 0;
    bool nearer = *near->path == '\0' || last.distance < near->distance;
    bool tie = !nearer && last.distance == near->distance;
    if (!nearer && !(tie && same > near->same_object) &&
        !(tie && same == near->same_object && strlen(path) < strlen(near->path)))
        return;
    snprintf(near->path, sizeof near->path, "%s", path);
    near->distance = last.distance;
    near->same_object = same;
}

/* Sees a parameter, and the objects that it is in. */
static void see_paths(struct near_path *near, const char *path) {
    char object[POINTER_SIZE];
    snprintf(object, sizeof object, "%s", path);
    for (char *slash = strchr(object + 1, '/'); slash != NULL; slash = strchr(slash + 1, '/')) {
        *slash = '\0';
        see_path(near, object);
        *slash = '/';
    }
    see_path(near, path);
}

/* path: as path_read has it; given: as it was typed. */
static int refuse_path(const struct reference *reference, const char *path, const char *given,
                       struct error *err) {
    struct near_path near = {.typed = path, .last = strrchr(path, '/') + 1};
    const struct parameter *row;
    for (size_t p = 0; p < COMMON_PARAMETERS.count; p++)
        see_paths(&near, COMMON_PARAMETERS.rows[p].path);
    for (size_t k = 0; reference->kinds[k] != NULL; k++)
        for (size_t p = 0; (row = parameter_row(reference->kinds[k]->tables, p)) != NULL; p++)
            see_paths(&near, row->path);
    return error_set(err, ERROR_INPUT, "a study has no parameter \"%.100s\"%s%.100s%s", given,
                     *near.path != '\0' ? " (did you mean " : "", near.path,
                     *near.path != '\0' ? "?)" : "");
}

int reference_print(FILE *file, const struct study_kind *const *kinds, const char *path,
                    struct error *err) {
    struct reference reference;
    char below[POINTER_SIZE] = "";
    int status = reference_open(&reference, kinds, err);
    if (status != 0)
        return status;
    if (path != NULL)
        path_read(path, below, sizeof below);
    if (path == NULL || is_known(&reference, below))
        write_tables(file, &reference, below, print_table);
    else
        status = refuse_path(&reference, below, path, err);
    free(reference.names);
    return status;
}

int reference_markdown(FILE *file, const struct study_kind *const *kinds, struct error *err) {
    struct reference reference;
    int status = reference_open(&reference, kinds, err);
    if (status != 0)
        return status;
    fprintf(file, INTRODUCTION, STUDY_CASES_MOST, STUDY_CASES_MOST, STUDY_REALISATIONS_MOST);
    write_tables(file, &reference, NULL, markdown_table);
    free(reference.names);
    return 0;
}
