#include "server/command/options.h"
#include "jobs/contact/model/model.h"
#include "schema/near_name.h"
#include "server/command/exit_status.h"
#include <ctype.h>
#include <errno.h>
#include <getopt.h>
#include <math.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { ROWS_MOST = 64, LONG_CODE = 256 };

int usage_error(const char *command, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    fprintf(stderr, "rugo %s: ", command);
    vfprintf(stderr, format, arguments);
    fprintf(stderr, "; see rugo %s --help\n", command);
    va_end(arguments);
    return EXIT_USAGE;
}

/* --- values --- */

static bool read_integer(const char *text, double low, double high, int64_t *out) {
    char *end = NULL;
    if (!isdigit((unsigned char)*text)) /* strtoll would skip blanks and signs */
        return false;
    errno = 0;
    long long value = strtoll(text, &end, 10);
    *out = value;
    return errno == 0 && *end == '\0' && (double)value >= low && (double)value <= high;
}

static bool read_number(const struct option_row *row, const char *text, double *out) {
    char *end = NULL;
    double value = strtod(text, &end);
    *out = value;
    bool within = row->high == 0 ? value > row->low && isfinite(value)
                                 : value >= row->low && value <= row->high;
    return end != text && *end == '\0' && within;
}

/* Returns the number of a word in "one|two|three"; -1 where it is none of them. */
static int read_choice(const char *words, const char *text) {
    size_t length = strlen(text);
    for (int n = 0;; n++) {
        size_t width = strcspn(words, "|");
        if (width == length && strncmp(words, text, width) == 0)
            return n;
        if (words[width] == '\0')
            return -1;
        words += width + 1;
    }
}

static void list_append(const char **list, const char *text) {
    while (*list != NULL)
        list++;
    *list = text;
}

static int refuse_number(const char *command, const struct option_row *row, const char *text) {
    const char *what = row->type == OPTION_NUMBER ? "number" : "whole number";
    if (row->type == OPTION_INDEX || row->type == OPTION_PAIR)
        return usage_error(command, "--%s %.40s is not a whole number of 0 or more", row->name,
                           text);
    if (row->high == 0)
        return usage_error(command, "--%s %.40s is not a number above %g", row->name, text,
                           row->low);
    return usage_error(command, "--%s %.40s is not a %s in [%.10g, %.10g]", row->name, text, what,
                       row->low, row->high);
}

/* Writes the names of the models with `between` between them, and `last` before the last one. */
static void write_models(const char *between, const char *last, char *text, size_t size) {
    const struct choice *models = CONTACT_MODEL_CHOICES;
    size_t used = 0;
    *text = '\0';
    for (size_t m = 0; models[m].name != NULL && used < size; m++) {
        const char *gap = models[m + 1].name != NULL ? between : last;
        used +=
            (size_t)snprintf(text + used, size - used, "%s%s", m > 0 ? gap : "", models[m].name);
    }
}

void option_argument(const struct option_row *row, char *text, size_t size) {
    if (row->type == OPTION_MODELS)
        write_models("|", "|", text, size);
    else
        snprintf(text, size, "%s", row->argument != NULL ? row->argument : "");
}

bool models_find(const char *text, int positions[CONTACT_MODELS_MOST], size_t *count) {
    *count = 0;
    for (;; text++) {
        const struct choice *choice = CONTACT_MODEL_CHOICES;
        size_t length = strcspn(text, ",");
        while (choice->name != NULL &&
               !(strlen(choice->name) == length && strncmp(choice->name, text, length) == 0))
            choice++;
        if (choice->name == NULL)
            return false;
        for (size_t m = 0; m < *count; m++)
            if (positions[m] == choice->value)
                return false;
        positions[(*count)++] = choice->value;
        text += length;
        if (*text == '\0')
            return true;
    }
}

static int refuse_models(const char *command, const struct option_row *row, const char *text) {
    char names[200];
    write_models(", ", " or ", names, sizeof names);
    return usage_error(command, "--%s %.40s is not %s, nor several of them with commas between",
                       row->name, text, names);
}

static int refuse_choice(const char *command, const struct option_row *row, const char *text) {
    char words[120];
    size_t used = 0;
    for (const char *c = row->argument; *c != '\0' && used + 5 < sizeof words; c++) {
        const char *part = *c == '|' ? " or " : (char[2]){*c, 0};
        used += (size_t)snprintf(words + used, sizeof words - used, "%s", part);
    }
    return usage_error(command, "--%s %.40s is not %s", row->name, text, words);
}

/* Takes "1,0". */
static int take_pair(const char *command, const struct option_row *row, void *values,
                     const char *text) {
    int64_t *pair = (int64_t *)((char *)values + row->at);
    const char *parts[2] = {text, strchr(text, ',')};
    char first[24];
    if (parts[1] == NULL)
        return usage_error(command, "--%s needs two values", row->name);
    snprintf(first, sizeof first, "%.*s", (int)(parts[1]++ - text), text);
    parts[0] = first;
    for (int p = 0; p < 2; p++)
        if (!read_integer(parts[p], 0, 0x1p62, &pair[p]))
            return refuse_number(command, row, parts[p]);
    return 0;
}

static int take_value(const char *command, const struct option_row *row, void *values,
                      const char *text) {
    void *value = (char *)values + row->at;
    int64_t whole = 0;
    int choice = 0, positions[CONTACT_MODELS_MOST];
    size_t models;
    switch (row->type) {
    case OPTION_FLAG:
        *(bool *)value = true;
        return 0;
    case OPTION_MODELS:
        if (!models_find(text, positions, &models))
            return refuse_models(command, row, text);
        *(const char **)value = text;
        return 0;
    case OPTION_TEXT:
    case OPTION_OPTIONAL:
        *(const char **)value = text;
        return 0;
    case OPTION_LIST:
        list_append(*(const char ***)value, text);
        return 0;
    case OPTION_COUNT:
        if (!read_integer(text, row->low, row->high, &whole))
            return refuse_number(command, row, text);
        *(unsigned *)value = (unsigned)whole;
        return 0;
    case OPTION_INDEX:
        if (!read_integer(text, 0, 0x1p62, (int64_t *)value))
            return refuse_number(command, row, text);
        return 0;
    case OPTION_PAIR:
        return take_pair(command, row, values, text);
    case OPTION_NUMBER:
        return read_number(row, text, value) ? 0 : refuse_number(command, row, text);
    case OPTION_CHOICE:
        choice = read_choice(row->argument, text);
        if (choice < 0)
            return refuse_choice(command, row, text);
        *(int *)value = choice;
        return 0;
    }
    return EXIT_USAGE;
}

/* Lists get room for as many values as there are words on the command line. */
static int take_defaults(int argc, const char *command, const struct option_row *rows,
                         void *values) {
    for (; rows->name != NULL; rows++) {
        void *value = (char *)values + rows->at;
        int status = 0;
        if (rows->type == OPTION_LIST &&
            (*(const char ***)value = calloc((size_t)argc + 1, sizeof(char *))) == NULL) {
            fprintf(stderr, "rugo %s: out of memory\n", command);
            return EXIT_FAILED;
        }
        if (rows->type == OPTION_INDEX || rows->type == OPTION_PAIR)
            *(int64_t *)value = -1;
        if (rows->type == OPTION_PAIR)
            ((int64_t *)value)[1] = -1;
        if (rows->standard != NULL && rows->type != OPTION_OPTIONAL)
            status = take_value(command, rows, values, rows->standard);
        if (status != 0)
            return status;
    }
    return 0;
}

void options_clear(const struct option_row *rows, void *values) {
    for (; rows->name != NULL; rows++)
        if (rows->type == OPTION_LIST)
            free(*(const char ***)((char *)values + rows->at));
}

/* --- names --- */

/* What an option of one command is called in another. */
static const struct {
    const char *typed, *name;
} ELSEWHERE[] = {{"threads", "workers"}, {"workers", "threads"}, {"output", "out"}};

/* Returns the name that this table has for an option of another one; else what was typed. */
static const char *name_here(const struct option_row *rows, const char *typed) {
    for (; rows->name != NULL; rows++)
        for (size_t n = 0; n < sizeof ELSEWHERE / sizeof *ELSEWHERE; n++)
            if (strcmp(ELSEWHERE[n].typed, typed) == 0 &&
                strcmp(ELSEWHERE[n].name, rows->name) == 0)
                return rows->name;
    return typed;
}

static int unknown_option(const char *command, const struct option_row *rows, const char *given) {
    char typed[64];
    snprintf(typed, sizeof typed, "%.*s", (int)strcspn(given, "="), given);
    const bool is_long = strncmp(typed, "--", 2) == 0;
    struct near_name near = {.typed = is_long ? name_here(rows, typed + 2) : typed};
    for (; rows->name != NULL && is_long; rows++)
        near_name_see(&near, rows->name);
    if (near.name != NULL)
        return usage_error(command, "unknown option %.60s (did you mean --%s?)", typed, near.name);
    return usage_error(command, "unknown option %.60s", typed);
}

/* Fills in getopt's own names of the table. */
static void fill_names(const struct option_row *rows, struct option *names, char *letters) {
    *letters++ = ':'; /* distinguish a missing argument from an unknown option */
    for (int r = 0; rows[r].name != NULL && r < ROWS_MOST; r++) {
        int argument = rows[r].type == OPTION_FLAG       ? no_argument
                       : rows[r].type == OPTION_OPTIONAL ? optional_argument
                                                         : required_argument;
        *names++ = (struct option){rows[r].name, argument, NULL, LONG_CODE + r};
        if (rows[r].letter == 0)
            continue;
        *letters++ = rows[r].letter;
        if (argument == required_argument)
            *letters++ = ':';
    }
    *letters = 0;
    *names = (struct option){NULL, 0, NULL, 0};
}

static const struct option_row *find_row(const struct option_row *rows, int code) {
    if (code >= LONG_CODE)
        return &rows[code - LONG_CODE];
    while (rows->name != NULL && rows->letter != code)
        rows++;
    return rows;
}

/* What getopt refused: it keeps a short option in optopt, and the code of a long one that came with
 * a value it does not take. */
static int refused(char **argv, const struct option_row *rows) {
    if (optopt >= LONG_CODE)
        return usage_error(argv[0], "--%s takes no value", rows[optopt - LONG_CODE].name);
    if (optopt != 0)
        return usage_error(argv[0], "unknown option -%c", optopt);
    return unknown_option(argv[0], rows, argv[optind - 1]);
}

/* --- the command line --- */

static int take_arguments(int argc, char **argv, int least, int most, const char *names,
                          const char **arguments) {
    int count = argc - optind;
    if (count < least)
        return usage_error(argv[0], "%s: rugo %s %s",
                           least == 1 ? "an argument is missing" : "arguments are missing", argv[0],
                           names);
    if (count > most)
        return usage_error(argv[0], "unexpected argument %.60s", argv[optind + most]);
    for (int i = 0; i < most; i++)
        arguments[i] = i < count ? argv[optind + i] : NULL;
    return 0;
}

static bool is_number(const char *text) {
    char *end;
    strtod(text, &end);
    return end != text && *end == '\0';
}

/* Takes the value of an option, of a pair with the word behind it where it is written as two. */
static int take_option(int argc, char **argv, const struct option_row *row, void *values) {
    char pair[80];
    if (row->type == OPTION_OPTIONAL && optarg == NULL) {
        const bool follows = optind < argc && is_number(argv[optind]);
        return take_value(argv[0], row, values, follows ? argv[optind++] : row->standard);
    }
    if (row->type != OPTION_PAIR || strchr(optarg, ',') != NULL || optind >= argc)
        return take_value(argv[0], row, values, optarg);
    snprintf(pair, sizeof pair, "%.38s,%.38s", optarg, argv[optind++]);
    return take_value(argv[0], row, values, pair);
}

int options_parse(int argc, char **argv, const struct option_row *rows, void *values, int least,
                  int most, const char *named, const char **arguments) {
    struct option names[ROWS_MOST + 1];
    char letters[2 * ROWS_MOST + 2];
    int status = take_defaults(argc, argv[0], rows, values);
    fill_names(rows, names, letters);
    opterr = 0;
    optind = 0; /* from the start, also for a second command line */
    for (int code; status == 0 && (code = getopt_long(argc, argv, letters, names, NULL)) != -1;)
        if (code == '?')
            status = refused(argv, rows);
        else if (code == ':')
            status = usage_error(argv[0], "%.60s needs a value", argv[optind - 1]);
        else
            status = take_option(argc, argv, find_row(rows, code), values);
    return status != 0 ? status : take_arguments(argc, argv, least, most, named, arguments);
}
