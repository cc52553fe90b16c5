/* Whole command lines over small odd height maps, and over small studies, as someone types them or
 * a peer asks for them in a query: drawn by the bytes, run in this process. A command ends with one
 * of its statuses; where it fails it says why, and not that it is broken or wants memory; where it
 * does not, what it prints and writes is there, and can be read. */
#include "core/file/memory_file.h"
#include "core/file/plain_text.h"
#include "core/map/preparation/preparation_words.h"
#include "jobs/kind.h"
#include "schema/json/json.h"
#include "server/command/command.h"
#include "server/command/map/map_file.h"
#include "tests/support/fuzz/draw_command.h"
#include "tests/support/fuzz/draw_map.h"
#include "tests/support/fuzz/fuzz.h"
#include <ctype.h>
#include <expat.h>
#include <gsl/gsl_errno.h>
#include <unistd.h>

/* --- options --- */

static const struct option_row *row_of(const struct command *command, const char *name) {
    const struct option_row *row = command->options;
    while (row->name != NULL && strcmp(row->name, name) != 0)
        row++;
    return row->name != NULL ? row : NULL;
}

/* The text of an option; NULL where the command has none of this name, or it is not given. */
static const char *text_at(const struct command *command, const void *options, const char *name) {
    const struct option_row *row = row_of(command, name);
    return row != NULL && (row->type == OPTION_TEXT || row->type == OPTION_MODELS)
               ? *(const char *const *)((const char *)options + row->at)
               : NULL;
}

/* Whether an option of the words "one|two" has the value `word`. */
static bool has_choice(const struct command *command, const void *options, const char *name,
                       const char *word) {
    const struct option_row *row = row_of(command, name);
    if (row == NULL || row->type != OPTION_CHOICE)
        return false;
    const char *at = row->argument;
    for (int n = *(const int *)((const char *)options + row->at); n > 0; n--)
        at = strchr(at, '|') + 1;
    const size_t length = strcspn(at, "|");
    return length == strlen(word) && strncmp(at, word, length) == 0;
}

/* --- what would take long --- */

/* So many points are made and looked at, pressed, or meshed; more than any are refused, which takes
 * no time. */
static bool are_many(const struct command *command, const void *options, double points) {
    const char *model = text_at(command, options, "model");
    const double most = model == NULL ? 3000 : strstr(model, "full") != NULL ? 40 : 400;
    return points > most && points < 1e11;
}

/* Returns about how many points the map gets; `unit` and `dx`: of its lengths, where these are what
 * counts. */
static double new_points(const struct grid *grid, const struct preparation *asked, double unit,
                         double dx) {
    const double dy = dx * (asked->dy.value > 0 ? asked->dy.value / asked->dx.value
                                                : grid_dy(grid) / grid_dx(grid));
    const double lx = (double)grid->nx * dx * unit, ly = (double)grid->ny * dy * unit;
    const double spacing =
        asked->resample_x > 0 ? lx / (double)asked->resample_x : asked->resample_dx.value;
    const double rows = asked->resample_y > 0 ? (double)asked->resample_y : ly / spacing + 1;
    return (lx / spacing + 1) * (grid_is_profile(grid) ? 1 : rows);
}

/* Returns whether the line asks for so many new points that it takes long, and nothing else. */
static bool takes_long(const struct command *command, const void *options, const char *file) {
    const struct preparation_words words = {.dx = text_at(command, options, "dx"),
                                            .unit = text_at(command, options, "unit"),
                                            .resample = text_at(command, options, "resample")};
    struct preparation asked;
    struct height_map map = {0};
    struct error err = {0};
    if (words.resample == NULL || preparation_parse(&asked, &words, &err) != 0 ||
        map_file_read(&map, file, &err) != 0)
        return false;
    const double dx = asked.dx.value > 0 ? asked.dx.value : grid_dx(&map.grid);
    const double unit = asked.unit > 0 ? asked.unit : 1;
    const bool is_long = are_many(command, options, new_points(&map.grid, &asked, 1, dx)) ||
                         are_many(command, options, new_points(&map.grid, &asked, unit, dx));
    height_map_clear(&map);
    return is_long;
}

/* --- what is printed --- */

/* A word of letters alone: "nan" stands in "-nan,", not in "nanometre". */
static bool has_word(const char *text, const char *word) {
    const size_t length = strlen(word);
    for (const char *at = text; (at = strstr(at, word)) != NULL; at += length)
        if ((at == text || isalnum((unsigned char)at[-1]) == 0) &&
            isalnum((unsigned char)at[length]) == 0)
            return true;
    return false;
}

/* Each is of what only the program itself can have done wrong. */
static void check_refusal(const char *said) {
    static const char *const BROKEN[] = {"internal",        "malformed",     "as no table has it",
                                         "cannot allocate", "out of memory", "(null)"};
    const size_t length = strlen(said);
    MUST(length > 0 && said[length - 1] == '\n');
    for (size_t b = 0; b < sizeof BROKEN / sizeof *BROKEN; b++)
        MUST(strstr(said, BROKEN[b]) == NULL);
}

static void check_xml(const char *text, size_t size) {
    XML_Parser parser = XML_ParserCreate("UTF-8");
    MUST(parser != NULL);
    MUST(XML_Parse(parser, text, (int)size, 1) == XML_STATUS_OK);
    XML_ParserFree(parser);
}

/* Values that no map and no load is too odd for; lists have one a load. */
static void check_numbers(const cJSON *document, const char *const *pointers) {
    for (size_t p = 0; pointers[p] != NULL; p++) {
        const cJSON *value = json_at(document, pointers[p]), *one = NULL;
        MUST(cJSON_IsNumber(value) || (cJSON_IsArray(value) && cJSON_GetArraySize(value) > 0));
        cJSON_ArrayForEach(one, value) MUST(cJSON_IsNumber(one));
    }
}

static void check_json(const struct command *command, const char *text, size_t size) {
    static const char *const MAP[] = {"/heights/rms", "/heights/lowest", "/grid/dx", NULL};
    static const char *const CONTACT[] = {"/rms_slope", "/load",     "/edges",       "/nodes",
                                          "/peak",      "/mean_gap", "/patch_count", NULL};
    struct error err = {0};
    cJSON *document = NULL;
    MUST(json_parse(text, size, NULL, &document, &err) == 0);
    if (command == &COMMAND_CHARACTERISE)
        check_numbers(document, MAP);
    if (command == &COMMAND_PRESS)
        check_numbers(document, CONTACT);
    cJSON_Delete(document);
}

/* What is printed as a study can be run. */
static void check_study(const char *text, size_t size) {
    struct fault_list faults = {0};
    struct study *study = NULL;
    struct error err = {0};
    MUST(kind_read_study(&study, text, size, NULL, &faults, &err) == 0);
    study_destroy(&study);
    fault_list_clear(&faults);
}

/* As the service does it: the name of a file may be any bytes. */
static void mend(char *text) {
    for (size_t length; *text != '\0'; text += length != 0 ? length : 1)
        if ((length = text_character(text)) == 0)
            *text = '?';
}

static void check_output(const struct command *command, const void *options, char *text,
                         size_t size) {
    MUST(size > 0);
    if (command == &COMMAND_GENERATE) /* heights as they are */
        return;
    mend(text);
    MUST(!has_word(text, "nan") && !has_word(text, "inf"));
    if (has_choice(command, options, "format", "svg"))
        check_xml(text, size);
    if (has_choice(command, options, "format", "json"))
        check_json(command, text, size);
    if (has_choice(command, options, "format", "study"))
        check_study(text, size);
}

/* --- files --- */

static char *read_whole(const char *path, size_t *size) {
    FILE *file = fopen(path, "rb");
    if (file == NULL)
        return NULL;
    MUST(fseek(file, 0, SEEK_END) == 0);
    long length = ftell(file);
    MUST(length > 0); /* something was written into it */
    rewind(file);
    char *text = malloc((size_t)length + 1);
    MUST(text != NULL && fread(text, 1, (size_t)length, file) == (size_t)length);
    fclose(file);
    text[length] = '\0';
    *size = (size_t)length;
    return text;
}

/* Whether the file holds a map in the format of its name, or, where an option may say another, in
 * any. */
static bool holds_map(const char *path, const char *text, size_t size, bool any_format) {
    struct height_map map = {0};
    struct error err = {0};
    int status = map_file_read(&map, path, &err);
    /* Two or three columns without a header are asked back, whatever wrote them. */
    for (int format = 0; status != 0 && format < HEIGHT_MAP_FORMATS; format++)
        if (any_format || format == (int)height_map_format_of(path))
            status = height_map_parse(&map, (enum height_map_format)format, text, size, 1, &err);
    height_map_clear(&map);
    return status == 0;
}

/* Whether it is a table of nodes, or a mesh for other programs. */
static bool is_of_nodes(const char *text) {
    static const char *const STARTS[] = {"load,node,", "$MeshFormat\n", "*HEADING\n"};
    bool is_one = false;
    for (size_t s = 0; s < sizeof STARTS / sizeof *STARTS; s++)
        is_one = is_one || strncmp(text, STARTS[s], strlen(STARTS[s])) == 0;
    return is_one;
}

static void check_file(const struct command *command, const char *path) {
    static const char PNG[] = "\x89PNG\r\n\x1a\n";
    size_t size = 0;
    char *text = read_whole(path, &size);
    if (text == NULL)
        return;
    if (*text == '<') {
        mend(text);
        check_xml(text, size);
        MUST(!has_word(text, "nan") && !has_word(text, "inf"));
    } else if (is_of_nodes(text)) {
        MUST(text[size - 1] == '\n' && !has_word(text, "nan") && !has_word(text, "inf"));
    } else if (strncmp(text, PNG, strlen(PNG)) != 0)
        MUST(holds_map(path, text, size, command == &COMMAND_GENERATE));
    free(text);
}

static void check_files(const struct command *command) {
    for (size_t f = 0; DRAWN_FILES[f] != NULL; f++)
        check_file(command, DRAWN_FILES[f]);
}

static void remove_files(const char *input) {
    for (size_t f = 0; DRAWN_FILES[f] != NULL; f++)
        (void)unlink(DRAWN_FILES[f]);
    (void)unlink(input);
}

/* --- the command --- */

struct outcome {
    bool ran; /* false: it would have taken long */
    int status;
    char *output, *said; /* owned */
    size_t size;         /* of the output */
};

/* As main.c does it, but for its standard streams, which are files in memory. */
static void run(const struct command *command, struct drawn_line *line, const char *file,
                void *options, struct outcome *out) {
    const char *arguments[ARGUMENTS_MOST] = {NULL};
    FILE *const own_output = stdout, *const own_error = stderr;
    struct memory_file output, said;
    MUST(memory_file_open(&output) && memory_file_open(&said));
    stdout = output.file;
    stderr = said.file;
    out->status = options_parse(line->count, line->words, command->options, options, command->least,
                                command->most, command->arguments, arguments);
    out->ran = out->status != EXIT_DONE || !takes_long(command, options, file);
    if (out->status == EXIT_DONE && out->ran)
        out->status = command->run(options, arguments);
    stdout = own_output;
    stderr = own_error;
    out->output = memory_file_close(&output, &out->size);
    out->said = memory_file_close(&said, NULL);
    MUST(out->output != NULL && out->said != NULL);
}

static void check(const struct command *command, const void *options, struct outcome *outcome) {
    MUST(outcome->status == EXIT_DONE || outcome->status == EXIT_FAILED ||
         outcome->status == EXIT_USAGE);
    if (outcome->status != EXIT_DONE)
        check_refusal(outcome->said);
    else {
        check_output(command, options, outcome->output, outcome->size);
        check_files(command);
    }
}

/* --- what the line is about --- */

static const char STUDY[] = "drawn.json";
static const char *const STUDIES[] = {
    "{\"name\":\"surfaces\",\"kind\":\"statistics\",\"realisations\":2,\"surface\":{\"hurst\":0.8,"
    "\"wavelength_ratio\":2,\"length_ratio\":2,\"points_per_wavelength\":4}}",
    "{\"name\":\"profiles\",\"kind\":\"statistics\",\"realisations\":2,\"surface\":{\"dimension\":"
    "1,"
    "\"hurst\":[0.2,0.8],\"wavelength_ratio\":4,\"length_ratio\":2},\"statistics\":{\"bins\":"
    "{\"height\":[-3,3,6],\"curvature\":[-6,0,6]}}}",
    "{\"name\":\"blocks\",\"kind\":\"contact\",\"realisations\":1,\"surface\":{\"dimension\":1,"
    "\"hurst\":0.8,\"wavelength_ratio\":2,\"length_ratio\":1,\"points_per_wavelength\":4,"
    "\"rms_slope\":0.1},\"contact\":{\"model\":\"full\",\"block_height\":{\"rms_heights\":40},"
    "\"pressures\":{\"to\":0.1,\"steps\":1}}}"};

static void write_study(const char *text) {
    FILE *file = fopen(STUDY, "wb");
    MUST(file != NULL && fputs(text, file) >= 0);
    MUST(fclose(file) == 0);
}

/* Points a side: what is pressed takes time, most of all where blocks are meshed on it. */
static size_t side_of(const struct drawn_line *line, struct choices *choices) {
    const bool large = choose_rarely(choices, 8); /* enough to be thinned for errors */
    for (int w = 0; w < line->count; w++)
        if (strstr(line->words[w], "full") != NULL)
            return 5;
    return strcmp(line->words[0], COMMAND_PRESS.name) != 0 ? 24 : large ? 17 : 8;
}

static void draw_input(struct choices *choices, const char *file, const struct line_request *about,
                       const struct drawn_line *line) {
    if (file == STUDY)
        write_study(STUDIES[choose(choices, sizeof STUDIES / sizeof *STUDIES)]);
    else
        draw_map(choices, file, about->unit, side_of(line, choices));
    /* Of commands that are given "-". */
    MUST(strcmp(about->input, "-") != 0 || freopen(file, "rb", stdin) != NULL);
}

/* --- the target --- */

static void draw_and_run(const struct command *command, struct choices *choices) {
    static const char *const MAPS[] = {"drawn.csv", "drawn.npy", "drawn.xyz"};
    const bool of_map = strncmp(command->arguments, "FILE", strlen("FILE")) == 0;
    const char *file = of_map ? MAPS[choose(choices, sizeof MAPS / sizeof *MAPS)] : STUDY;
    const bool piped = choose_rarely(choices, 8), has_unit = choose(choices, 2) == 1;
    const struct line_request request = {.command = command->name,
                                         .arguments = command->arguments,
                                         .rows = command->options,
                                         .input = piped ? "-" : file,
                                         .unit = has_unit ? "um" : ""};
    struct drawn_line line;
    struct outcome outcome = {0};
    void *options = array_create(1, command->options_size);
    MUST(options != NULL);
    remove_files(file); /* of a run that was broken off */
    draw_line(&line, choices, &request);
    draw_input(choices, file, &request, &line);
    run(command, &line, file, options, &outcome);
    if (outcome.ran)
        check(command, options, &outcome);
    options_clear(command->options, options);
    drawn_line_clear(&line);
    remove_files(file);
    free(options);
    free(outcome.output);
    free(outcome.said);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    static const struct command *const DRAWN[] = {
        &COMMAND_CHARACTERISE, &COMMAND_CHARACTERISE, &COMMAND_CHARACTERISE,
        &COMMAND_CONVERT,      &COMMAND_CONVERT,      &COMMAND_PRESS,
        &COMMAND_PRESS,        &COMMAND_GENERATE,     &COMMAND_THEORY};
    struct choices choices = {data, size};
    gsl_set_error_handler_off();
    (void)setenv("PATH", "", 1); /* pages become pixels by another program, which takes long */
    draw_and_run(DRAWN[choose(&choices, sizeof DRAWN / sizeof *DRAWN)], &choices);
    return 0;
}
