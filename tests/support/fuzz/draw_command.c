#include "tests/support/fuzz/draw_command.h"
#include "tests/support/fuzz/fuzz.h"
#include <math.h>
#include <stdarg.h>

#define ENDINGS(name)                                                                              \
    name, name ".npy", name ".csv", name ".xyz", name ".svg", name ".png", name ".vtu",            \
        name ".pdf", name ".msh", name ".inp"
const char *const DRAWN_FILES[] = {ENDINGS("drawn-first"), ENDINGS("drawn-second"), NULL};
static const char ABSENT[] = "absent-folder/file.npy";

enum { WORD_SIZE = 512, OPTIONS_DRAWN = 7 };

/* --- words --- */

/* Words of options that are texts, plausible ones and others: # is a number, @ a whole one, ~ the
 * unit of lengths, if there is one; ended by NULL. Texts without a row here have the words of their
 * table ("one|two"), or any. */
static const struct text_words {
    const char *option; /* its name, or what help calls its value */
    const char *const *plausible, *const *odd;
} WORDS[] = {
#define LIST_OF(...) ((const char *const[]){__VA_ARGS__, NULL})
    {"NAME", LIST_OF("patch", "a/b c", "<&\"'>", "\xe5\xb9\xb3"),
     LIST_OF("-x", "", "p.npy", "p.xyz", "p.x3p", "p.gwy", "p.txt", "\xb5.csv")},
    {"NAME|NUMBER", LIST_OF("1"), LIST_OF("0", "2", "", "Height", "@", "99999999999999999999")},
    {"DX[,DY]", LIST_OF("#~", "2~", "2~,3~"),
     LIST_OF("0", "#um", "#", "1e300~", "5e-324~", "1e300m", "1e-300m", "1e-300~,1e300~", "1~,150~",
             "#,", "#,#um")},
    {"UNIT", LIST_OF("um", "nm", "\xc2\xb5m"),
     LIST_OF("m", "\xb5m", "inch", "ell", "", "#nm", "-1nm", "1e300m", "1e-300m", "5e-324m")},
    {"X0,Y0,WIDTH,HEIGHT", LIST_OF("0,0,5,4", "1,0,4,4", "0,0,@,@", "0~,0~,#~,#~"),
     LIST_OF("0,0,1,1", "@,@,@,@", "#um,#um,@,@", "0,0,1e300,1", "1e300,0,2,2", "0,0,@",
             "0.5,0,2,2")},
    {"tip=RADIUS[,holes]", LIST_OF("tip=#~", "tip=#~,holes", "#~"),
     LIST_OF("tip=0~", "tip=1e300~", "tip=5e-324~", "#um", "#", "tip=")},
    {"DEGREES", LIST_OF("90", "-90", "180", "30", "#"),
     LIST_OF("0", "360", "361", "1e-300", "5e-324", "1e300", "45.000001")},
    {"S=LENGTH,L=LENGTH,robust", LIST_OF("S=#~", "L=#~", "S=2~,L=#~", "L=#~,robust", "S=#~,robust"),
     LIST_OF("S=1e300~", "L=1e300~", "S=1e-300~", "L=5e-324~", "robust", "S=#,S=#", "S=9~,L=2~")},
    {"NX[,NY]", LIST_OF("1", "2", "2,1"), LIST_OF("0", "2,", "@,@", "99999999999999999999")},
    {"NX[,NY]|SPACING", LIST_OF("7", "@", "@,@", "16,9", "dx=#~"),
     LIST_OF("0", "1", "dx=1e300~", "dx=1e-300~", "#um", "2147483648,2147483648",
             "99999999999999999999")},
    {"LENGTH", LIST_OF("#~", "4~", "30~"), LIST_OF("0~", "1e300~", "5e-324~", "#um", "#")},
    {"loads", LIST_OF("0.1", "0.01,0.3", "0.02,#"),
     LIST_OF("#", "1e300", "1e-300", "5e-324", "1e308,1.7e308", "0.3,0.2", "0", "1e-9,1e9")},
    {"pressure", LIST_OF("#MPa", "1kPa,1GPa", "#GPa"),
     LIST_OF("#Pa", "1e300GPa", "1e-300Pa", "2MPa,1MPa", "1", "1e-12Pa,1TPa")},
    {"force", LIST_OF("#mN", "#nN", "#N/m"), LIST_OF("#N", "1e300N", "1e-300N", "1e300N/m", "1")},
    {"R|FIRST..LAST", LIST_OF("0", "@", "1..2"),
     LIST_OF("2..1", "..", "1..", "-1", "1..x", "99999999999999999")},
    {"LIST", LIST_OF("0.1", "0.01,0.3", "0.02,#"),
     LIST_OF("#", "1e300", "0.3,0.2", "0", "1e-9,1e9")},
    {"E", LIST_OF("210GPa", "#GPa"), LIST_OF("#Pa", "1e300Pa", "1e-300Pa", "1e308GPa", "210")},
    {"E*", LIST_OF("210GPa", "#GPa"), LIST_OF("#Pa", "1e300Pa", "1e-300Pa", "1e308GPa", "210")},
    {"Q", LIST_OF("summit_height_pdf", "summit_joint_pdf", "summit_curvature_pdf", "psd"),
     LIST_OF("", "summit_density", "a/b")},
    {"PATH=VALUE",
     LIST_OF("surface/hurst=[0.2,0.8]", "surface/dimension=1", "surface/wavelength_ratio=4",
             "surface/rms_slope=#", "surface/amplitudes=random", "seed=@",
             "surface/heights={\"distribution\":\"weibull_min\",\"shape\":#}",
             "surface/heights={\"distribution\":\"lognormal\",\"shape\":0.5}",
             "surface/heights={\"distribution\":\"beta\",\"skewness\":#,\"kurtosis\":2}",
             "surface/spectrum={\"type\":\"exponential_acf\"}", "surface/hurst=#"),
     LIST_OF("surface/rms_slope=1e99", "surface/rms_slope=1e-99", "surface={}", "surface=@",
             "surface/like=drawn.json", "surface/like=drawn.csv", "surface/hurst=", "=", "a",
             "seed=-1", "contact={}", "surface/spectrum={\"type\":\"table\"}")},
#undef LIST_OF
};

static const struct text_words *words_of(const struct option_row *row) {
    for (size_t w = 0; w < sizeof WORDS / sizeof *WORDS; w++)
        if (strcmp(WORDS[w].option, row->name) == 0 ||
            (row->argument != NULL && strcmp(WORDS[w].option, row->argument) == 0))
            return &WORDS[w];
    return NULL;
}

/* A word while it is put together; what does not fit is left out. */
struct word {
    size_t size;
    char text[WORD_SIZE];
};

__attribute__((format(printf, 2, 3))) static void put(struct word *word, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    int length = vsnprintf(word->text + word->size, WORD_SIZE - word->size, format, arguments);
    va_end(arguments);
    MUST(length >= 0);
    word->size +=
        (size_t)length < WORD_SIZE - word->size ? (size_t)length : WORD_SIZE - 1 - word->size;
}

/* One of the patterns, filled in. */
static void put_pattern(struct word *word, struct choices *choices, const char *const *patterns,
                        const char *unit) {
    size_t count = 0;
    while (patterns[count] != NULL)
        count++;
    const char *pattern = patterns[choose(choices, count)];
    for (; *pattern != '\0'; pattern++)
        if (*pattern == '#')
            put(word, "%.4g", choose_number(choices, 0.01, 30));
        else if (*pattern == '@')
            put(word, "%u", (unsigned)choose(choices, 25));
        else if (*pattern == '~')
            put(word, "%s", unit);
        else
            put(word, "%c", *pattern);
}

/* Neither NaN nor infinity can be spelt, which outputs are searched for, nor a path. */
static void put_any_text(struct word *word, struct choices *choices) {
    static const char LETTERS[] = "0123456789.,+-eE=:;umxSLpP %s\n\t\x7f\xc3\xa4\xff\"\\<&[{";
    const bool is_long = choose_rarely(choices, 8);
    for (size_t left = choose(choices, 12) * (is_long ? 40 : 1); left > 0; left--)
        put(word, "%c", LETTERS[choose(choices, sizeof LETTERS - 1)]);
}

/* One of "one|two|three", or of "FILE.svg|FILE.png" with another word in place of FILE. */
static void put_alternative(struct word *word, struct choices *choices, const char *text) {
    size_t count = 1;
    for (const char *at = text; *at != '\0'; at++)
        count += *at == '|' ? 1 : 0;
    for (uint64_t skipped = choose(choices, count); skipped > 0; skipped--)
        text = strchr(text, '|') + 1;
    put(word, "%.*s", (int)strcspn(text, "|"), text);
}

/* --- files --- */

static bool names_file(const struct option_row *row) {
    return row->argument != NULL && strncmp(row->argument, "FILE", 4) == 0;
}

static bool names_folder(const struct option_row *row) {
    return row->argument != NULL && strcmp(row->argument, "DIR") == 0;
}

/* Mostly one of "FILE.svg|FILE.png" as help shows them, else any of the files. */
static void put_file(struct word *word, struct choices *choices, const char *shown) {
    size_t count = 0;
    if (strchr(shown, '.') != NULL && choose(choices, 8) != 7) {
        struct word one = {0};
        put_alternative(&one, choices, shown);
        put(word, "%s%s", DRAWN_FILES[0], strchr(one.text, '.'));
        return;
    }
    while (DRAWN_FILES[count] != NULL)
        count++;
    const size_t file = choose(choices, count + 1);
    put(word, "%s", file < count ? DRAWN_FILES[file] : ABSENT);
}

/* --- values --- */

static void put_plausible(struct word *word, struct choices *choices, const struct option_row *row,
                          const char *unit) {
    const struct text_words *words = words_of(row);
    char models[120];
    switch (row->type) {
    case OPTION_FLAG:
        break;
    case OPTION_COUNT:
        put(word, "%.0f", choose_number(choices, row->low, fmin(row->high, row->low + 8)));
        break;
    case OPTION_INDEX:
        put(word, "%u", (unsigned)choose(choices, 4));
        break;
    case OPTION_PAIR:
        put(word, "%u,", (unsigned)choose(choices, 4));
        put(word, "%u", (unsigned)choose(choices, 4));
        break;
    case OPTION_NUMBER:
        put(word, "%.3g", choose_number(choices, row->low, row->high == 0 ? 10 : row->high));
        break;
    case OPTION_CHOICE:
        put_alternative(word, choices, row->argument);
        break;
    case OPTION_MODELS:
        option_argument(row, models, sizeof models);
        put_alternative(word, choices, models);
        break;
    case OPTION_OPTIONAL:
        if (choose(choices, 2) == 1)
            put(word, "%.3g", choose_number(choices, 1, 10));
        break;
    case OPTION_TEXT:
    case OPTION_LIST:
        if (words != NULL)
            put_pattern(word, choices, words->plausible, unit);
        else if (strchr(row->argument, '|') != NULL)
            put_alternative(word, choices, row->argument);
        else
            put_any_text(word, choices);
    }
}

static void put_odd(struct word *word, struct choices *choices, const struct option_row *row,
                    const char *unit) {
    const bool one_sided = row->high == 0;
    /* Texts may be quoted, where NaN and infinity are looked for. */
    const bool is_text =
        row->type == OPTION_TEXT || row->type == OPTION_MODELS || row->type == OPTION_LIST;
    const struct text_words *words = words_of(row);
    if (words != NULL && choose(choices, 4) != 3) {
        put_pattern(word, choices, words->odd, unit);
        return;
    }
    switch (choose(choices, 8)) {
    case 0:
        put(word, "%.17g", row->low);
        break;
    case 1:
        put(word, "%.17g", one_sided ? 1e308 : row->high);
        break;
    case 2:
        put(word, "%.17g", nextafter(row->low, -INFINITY));
        break;
    case 3:
        put(word, "%.17g", one_sided ? -1 : nextafter(row->high, INFINITY));
        break;
    case 4:
        put(word, "%.17g", choose_odd_number(choices, !is_text));
        break;
    case 5: /* nothing at all */
        break;
    case 6:
        put_plausible(word, choices, row, unit);
        put(word, "%c", "x,. "[choose(choices, 4)]);
        break;
    default:
        put_any_text(word, choices);
    }
}

/* --- the line --- */

static void append(struct drawn_line *line, const char *text) {
    if (line->count == LINE_MOST)
        return;
    MUST((line->words[line->count++] = strdup(text)) != NULL);
}

/* As "--name value", "--name=value", "-n value", or cut short, "--nam=value". */
static void append_option(struct drawn_line *line, struct choices *choices,
                          const struct option_row *row, const struct word *value, bool odd) {
    const bool valued = row->type != OPTION_FLAG;
    const size_t length = strlen(row->name);
    struct word word = {0};
    if (row->letter != 0 && choose(choices, 2) == 1)
        put(&word, "-%c", row->letter);
    else
        put(&word, "--%.*s", (int)(odd && choose_rarely(choices, 8) ? 1 + length / 2 : length),
            row->name);
    if (word.text[1] == '-' &&
        (valued ? choose(choices, 2) == 0 : odd && choose_rarely(choices, 4))) {
        put(&word, "=%s", value->text);
        append(line, word.text);
        return;
    }
    append(line, word.text);
    if (valued && !(odd && choose_rarely(choices, 16)))
        append(line, value->text);
}

static void draw_option(struct drawn_line *line, struct choices *choices,
                        const struct line_request *request, bool wild) {
    const struct option_row *rows = request->rows;
    size_t count = 0;
    struct word value = {0};
    while (rows[count].name != NULL)
        count++;
    const struct option_row *row = &rows[choose(choices, count)];
    const bool odd = wild && !names_file(row) && choose(choices, 2) == 0;
    if (names_folder(row))
        return;
    if (names_file(row))
        put_file(&value, choices, row->argument);
    else if (odd)
        put_odd(&value, choices, row, request->unit);
    else
        put_plausible(&value, choices, row, request->unit);
    append_option(line, choices, row, &value, odd);
    if (odd && choose_rarely(choices, 8))
        append_option(line, choices, row, &value, false);
}

/* The input where help shows FILE or STUDY.json, a file to write elsewhere. */
static void draw_arguments(struct drawn_line *line, struct choices *choices,
                           const struct line_request *request, bool wild) {
    for (const char *at = request->arguments; at != NULL && *at != '\0';) {
        const size_t length = strcspn(at, " ");
        const bool is_optional = *at == '[';
        struct word word = {0};
        if (strncmp(at, "OUT", 3) == 0)
            put_file(&word, choices, at);
        else
            put(&word, "%s", wild && choose_rarely(choices, 16) ? ABSENT : request->input);
        if (!(is_optional && choose(choices, 4) == 0) && !(wild && choose_rarely(choices, 16)))
            append(line, word.text);
        at += length + strspn(at + length, " ");
    }
    if (wild && choose_rarely(choices, 16))
        append(line, "--unknown");
    if (wild && choose_rarely(choices, 16))
        append(line, "more");
}

void draw_line(struct drawn_line *out, struct choices *choices,
               const struct line_request *request) {
    const bool wild = choose(choices, 3) == 2, arguments_first = choose(choices, 2) == 1;
    *out = (struct drawn_line){0};
    append(out, request->command);
    if (arguments_first)
        draw_arguments(out, choices, request, wild);
    for (uint64_t left = choose(choices, OPTIONS_DRAWN + 1); left > 0; left--)
        draw_option(out, choices, request, wild);
    if (!arguments_first)
        draw_arguments(out, choices, request, wild);
    out->words[out->count] = NULL;
}

void drawn_line_clear(struct drawn_line *line) {
    for (int w = 0; w < line->count; w++)
        free(line->words[w]);
    *line = (struct drawn_line){0};
}
