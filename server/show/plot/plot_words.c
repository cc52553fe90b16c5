#include "server/show/plot/plot_words.h"
#include "core/file/plain_text.h"
#include "jobs/kind.h"
#include "schema/study/parameter.h"
#include "server/show/table/shown_cases.h"
#include <ctype.h>
#include <string.h>
#include <strings.h>

static const struct sign {
    const char *name, *text;
} GREEK[] = {{"alpha", "α"}, {"beta", "β"},  {"delta", "δ"},  {"epsilon", "ε"},
             {"eps", "ε"},   {"kappa", "κ"}, {"lambda", "λ"}, {"mu", "μ"},
             {"nu", "ν"},    {"rho", "ρ"},   {"sigma", "σ"},  {"Delta", "Δ"}};
enum { GREEK_COUNT = sizeof GREEK / sizeof *GREEK };
static const char *const LOW_DIGITS[] = {"₀", "₁", "₂", "₃", "₄", "₅", "₆", "₇", "₈", "₉"};

static void put(FILE *file, char letter) {
    const char *entity = letter == '<'   ? "&lt;"
                         : letter == '>' ? "&gt;"
                         : letter == '&' ? "&amp;"
                         : letter == '"' ? "&quot;"
                                         : NULL;
    if (entity != NULL)
        fputs(entity, file);
    else
        fputc(letter, file);
}

void svg_text(FILE *file, const char *text) {
    while (*text != '\0') {
        size_t length = text_shown(text);
        if (length == 0)
            fputc('?', file);
        for (size_t a = 0; a < length; a++)
            put(file, text[a]);
        text += length > 0 ? length : 1;
    }
}

static size_t letters_at(const char *text) {
    size_t count = 0;
    while (isalpha((unsigned char)text[count]))
        count++;
    return count;
}

/* Prints a word: a Greek letter by its name, one letter with its digit as an index. Returns how
 * long it is. */
static size_t put_word(FILE *file, const char *text) {
    size_t length = letters_at(text);
    for (size_t g = 0; g < GREEK_COUNT; g++)
        if (strlen(GREEK[g].name) == length && strncmp(text, GREEK[g].name, length) == 0) {
            fputs(GREEK[g].text, file);
            return length;
        }
    fprintf(file, "%.*s", (int)length, text);
    if (length != 1 || !isdigit((unsigned char)text[1]) || isalnum((unsigned char)text[2]))
        return length;
    fputs(LOW_DIGITS[text[1] - '0'], file);
    return 2;
}

/* Prints a root of one word without the brackets; returns how long it is, 0 where there is none. */
static size_t put_root(FILE *file, const char *text) {
    static const char NAME[] = "sqrt(";
    if (strncmp(text, NAME, strlen(NAME)) != 0)
        return 0;
    const char *inside = text + strlen(NAME), *end = inside;
    while (isalnum((unsigned char)*end))
        end++;
    fputs("√", file);
    if (*end != ')')
        return strlen(NAME) - 1; /* the bracket comes next */
    (void)put_word(file, inside);
    return (size_t)(end - text) + 1;
}

/* Prints an index (_) or a power (^); returns how long it is, 0 where nothing follows the sign. */
static size_t put_shifted(FILE *file, const char *text, int *shift) {
    bool low = text[0] == '_';
    size_t length = 1;
    while (isalnum((unsigned char)text[length]) ||
           (!low && length == 1 && strchr("+-*", text[length]) != NULL && text[length] != '\0'))
        length++;
    if (length == 1)
        return 0;
    *shift = low ? 3 : -5;
    fprintf(file, "<tspan class=\"index\" dy=\"%d\">%.*s</tspan>", *shift, (int)length - 1,
            text + 1);
    return length;
}

static size_t put_next(FILE *file, const char *text, bool inside_word) {
    size_t length = inside_word ? 0 : put_root(file, text);
    if (length > 0)
        return length;
    if (!inside_word && isalpha((unsigned char)*text))
        return put_word(file, text);
    if (text[0] == '\'') {
        fputs(text[1] == '\'' ? "″" : "′", file);
        return text[1] == '\'' ? 2 : 1;
    }
    if (*text == '-' && !inside_word && (text[1] == '\0' || !isdigit((unsigned char)text[1]))) {
        fputs("−", file);
        return 1;
    }
    size_t width = text_character(text); /* of several bytes, which stay together */
    for (size_t a = 0; a < (width > 1 ? width : 1); a++)
        put(file, text[a]);
    return width > 1 ? width : 1;
}

void svg_label(FILE *file, const char *label) {
    int shift = 0;
    for (const char *next = label; *next != '\0';) {
        size_t length = 0;
        if (next > label && (*next == '_' || *next == '^'))
            length = put_shifted(file, next, &shift);
        else if (shift != 0 && *next != ' ') { /* back to the line; a space would be lost in it */
            fprintf(file, "<tspan dy=\"%d\">", -shift);
            length = put_next(file, next, false);
            fputs("</tspan>", file);
            shift = 0;
        }
        if (length == 0)
            length = put_next(file, next, next > label && isalnum((unsigned char)next[-1]));
        next += length;
    }
}

static const struct parameter *row_of(const char *kind, const char *pointer) {
    const struct job_kind *known = kind != NULL ? kind_find(kind) : NULL;
    return known != NULL ? parameter_find(known->study.tables, pointer, NULL) : NULL;
}

const char *plot_symbol(const char *kind, const char *pointer) {
    const struct parameter *row = row_of(kind, pointer);
    return row != NULL && row->symbol != NULL ? row->symbol : last_name(pointer);
}

void plot_near_parameter(struct near_name *near, const char *kind, const char *pointer) {
    near_name_see(near, last_name(pointer));
    if (strcmp(plot_symbol(kind, pointer), near->typed) == 0) {
        near->name = last_name(pointer);
        near->distance = 0;
    }
}

void plot_parameter_words(const char *kind, const char *pointer, char *out, size_t size) {
    const struct parameter *row = row_of(kind, pointer);
    if (row != NULL && row->title != NULL)
        snprintf(out, size, "%s", row->title);
    else
        plot_in_words(last_name(pointer), out, size);
}

void plot_parameter_label(const char *kind, const char *pointer, char *out, size_t size) {
    const struct parameter *row = row_of(kind, pointer);
    char words[80];
    plot_parameter_words(kind, pointer, words, sizeof words);
    bool symbol = row != NULL && row->symbol != NULL, unit = row != NULL && row->unit != NULL;
    snprintf(out, size, "%s%s%s%s%s%s", words, symbol ? " " : "", symbol ? row->symbol : "",
             unit ? " (" : "", unit ? row->unit : "", unit ? ")" : "");
}

/* Sets the capitals of a word of so many letters, where it has any. */
static void capitals_set(char *word, size_t length) {
    static const char *const WORDS[] = {
        "ACF", "Archard", "BGT",     "CDF", "GW",      "Gaussian",   "McCool",   "Nayak",
        "PDF", "PSD",     "Persson", "RMS", "Weibull", "Williamson", "Greenwood"};
    for (size_t w = 0; w < sizeof WORDS / sizeof *WORDS; w++)
        if (strlen(WORDS[w]) == length && strncasecmp(WORDS[w], word, length) == 0)
            memcpy(word, WORDS[w], length);
}

void plot_in_words(const char *name, char *out, size_t size) {
    snprintf(out, size, "%s", name);
    while (*out != '\0') {
        size_t length = strcspn(out, "_ ");
        capitals_set(out, length);
        out += length;
        if (*out == '_')
            *out = ' ';
        out += *out != '\0';
    }
}

size_t plot_letters(const char *label) {
    size_t count = 0;
    while (*label != '\0') {
        size_t length = letters_at(label);
        for (size_t g = 0; g < GREEK_COUNT; g++)
            if (strlen(GREEK[g].name) == length && strncmp(label, GREEK[g].name, length) == 0) {
                label += length - 1;
                break;
            }
        count++;
        label++;
    }
    return count;
}
