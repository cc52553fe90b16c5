/* Characterises a map, or several of one surface, in files that the peer sends: in a process of its
 * own, a few at a time. */
#include "server/http/accept.h"
#include "server/http/route/own_process.h"
#include "server/http/route/route.h"
#include "server/http/route/sent_form.h"
#include "worker/log.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    MAPS_MOST = 2,            /* at a time */
    CPU_SECONDS = 50,         /* for one */
    WAIT_SECONDS = 55,        /* for one, below the minute that clients wait */
    MEMORY_FACTOR = 16,       /* of the largest file that is taken */
    MEMORY_LEAST = 512 << 20, /* for small ones */
    ANSWER_MOST = 64 << 20,   /* bytes: tables of large maps are a few */
    ARGUMENTS_MOST = 40 + JOINT_PATCHES_MOST,
    OPTION_SIZE = 320,
};

/* Names of a query, and the options of the command that they are. */
static const struct {
    const char *name, *option;
    bool flag; /* true or false */
} OPTIONS[] = {{"name", "name", false},          {"layer", "layer", false},
               {"columns", "columns", false},    {"dx", "dx", false},
               {"unit", "unit", false},          {"z_unit", "z-unit", false},
               {"missing", "missing", false},    {"crop", "crop", false},
               {"stride", "stride", false},      {"detrend", "detrend", false},
               {"lines", "lines", false},        {"lines_along", "lines-along", false},
               {"despike", "despike", false},    {"deconvolve", "deconvolve", false},
               {"transpose", "transpose", true}, {"rotate", "rotate", false},
               {"degroove", "degroove", true},   {"fill", "fill", true},
               {"denoise", "denoise", true},     {"filter", "filter", false},
               {"resample", "resample", false},  {"window", "window", false},
               {"boundary", "boundary", false},  {"trust_from", "trust-from", false},
               {"trust_to", "trust-to", false},  {"hold", "hold", true},
               {"together", "together", true}};
enum { OPTION_COUNT = sizeof OPTIONS / sizeof *OPTIONS };

struct command_line {
    size_t count;
    const char *arguments[ARGUMENTS_MOST];
    char texts[OPTION_COUNT][OPTION_SIZE];
    char sent[JOINT_PATCHES_MOST * 21 + 8];
};

/* Words of the query stay in their options whatever they begin with: "--name=-x". */
static void add_option(struct command_line *line, size_t n, const char *value,
                       struct fault_list *faults) {
    char pointer[32];
    snprintf(pointer, sizeof pointer, "?%s", OPTIONS[n].name);
    int length = OPTIONS[n].flag
                     ? snprintf(line->texts[n], OPTION_SIZE, "--%s", OPTIONS[n].option)
                     : snprintf(line->texts[n], OPTION_SIZE, "--%s=%s", OPTIONS[n].option, value);
    bool on = strcmp(value, "true") == 0;
    if (OPTIONS[n].flag && !on && strcmp(value, "false") != 0)
        fault_add(faults, pointer, "%.40s is not true or false", value);
    else if (length >= OPTION_SIZE)
        fault_add(faults, pointer, "longer than 300 bytes");
    else if (!OPTIONS[n].flag || on)
        line->arguments[line->count++] = line->texts[n];
}

/* What is printed, unless the query says it; a text for people alone is none of it. */
enum answer_format { ANSWER_JSON, ANSWER_SVG, ANSWER_STUDY, ANSWER_FORMATS };
static const char *const FORMATS[ANSWER_FORMATS] = {"json", "svg", "study"};

static enum answer_format read_format(struct exchange *exchange, struct fault_list *faults) {
    const char *asked = exchange_query(exchange, "format");
    const char *accept = exchange_header(exchange, "Accept");
    int format = ANSWER_JSON;
    if (asked == NULL)
        return accept_quality(accept, "image/svg+xml") > accept_quality(accept, "application/json")
                   ? ANSWER_SVG
                   : ANSWER_JSON;
    while (format < ANSWER_FORMATS && strcmp(FORMATS[format], asked) != 0)
        format++;
    if (format == ANSWER_FORMATS)
        fault_add(faults, "?format", "%.40s is not json, svg or study", asked);
    return (enum answer_format)format;
}

static const char CONVERT[] = "--convert=30"; /* seconds, below those of the whole process */

/* Returns false after an answer. */
static bool write_arguments(struct exchange *exchange, enum answer_format *format,
                            struct command_line *out) {
    static const char *const PRINT[] = {"--format=json", "--format=svg", "--format=study"};
    struct fault_list faults = {0};
    *format = read_format(exchange, &faults);
    out->count = 0;
    out->arguments[out->count++] = "rugo";
    out->arguments[out->count++] = "characterise";
    if (*format < ANSWER_FORMATS)
        out->arguments[out->count++] = PRINT[*format];
    for (size_t n = 0; n < OPTION_COUNT; n++) {
        const char *value = exchange_query(exchange, OPTIONS[n].name);
        if (value != NULL)
            add_option(out, n, value, &faults);
    }
    out->arguments[out->count++] = exchange->service->convert ? CONVERT : "--convert=0";
    const bool named = exchange_query(exchange, "name") != NULL, form = sent_form_is(exchange);
    if (!named && !form)
        fault_add(&faults, "?name", "missing: the name of the file, such as patch.x3p");
    if (named && form)
        fault_add(&faults, "?name", "the files of a form have names of their own");
    if (faults.count != 0)
        answer_problem(exchange, 422, "the query is not valid", &faults);
    fault_list_clear(&faults);
    return exchange->status == 0;
}

/* What is sent: one file, with its name in the query, or those of a form, whose names are of the
 * form. Returns false after an answer. */
static bool add_source(struct exchange *exchange, struct command_line *line,
                       struct sent_form *form) {
    struct error err = {0};
    const bool several = sent_form_is(exchange);
    if (several && sent_form_take(form, exchange, &err) != 0) {
        answer_mend(err.text); /* the name of a file may be any bytes */
        answer_error(exchange, &err);
        return false;
    }
    size_t used = (size_t)snprintf(line->sent, sizeof line->sent, "--sent=");
    for (size_t f = 0; f < form->count; f++)
        used += (size_t)snprintf(line->sent + used, sizeof line->sent - used, "%s%zu",
                                 f > 0 ? "," : "", form->sizes[f]);
    line->arguments[line->count++] = several ? line->sent : "-";
    if (several)
        line->arguments[line->count++] = "--";
    for (size_t f = 0; f < form->count; f++)
        line->arguments[line->count++] = form->names[f];
    line->arguments[line->count] = NULL;
    return true;
}

/* Of a file, or of the query: without the words that a terminal has use for. */
static void answer_refusal(struct exchange *exchange, char *said) {
    static const char BEGIN[] = "rugo characterise: ", END[] = "; see rugo characterise --help";
    char *text = strncmp(said, BEGIN, strlen(BEGIN)) == 0 ? said + strlen(BEGIN) : said;
    char *end = strstr(text, END), detail[640];
    bool large = strstr(text, "cannot allocate") != NULL;
    if (end != NULL)
        *end = '\0';
    snprintf(detail, sizeof detail, "%s%s", *text != '\0' ? text : "the file cannot be read",
             large ? ": more memory than a map may take here; crop or resample it" : "");
    answer_mend(detail);
    answer_problem(exchange, 422, detail, NULL);
}

static void answer_broken(struct exchange *exchange) {
    const struct log_about about = {.request = exchange->path, .status = 500};
    log_line(LEVEL_ERROR, &about, "a process for a peer's file broke down");
    answer_problem(exchange, 500, "the program broke down over this file: please report it", NULL);
}

static void answer_end(struct exchange *exchange, struct own_process_result *result,
                       enum answer_format format) {
    char detail[160];
    switch (result->end) {
    case OWN_PROCESS_STOPPED:
        answer_problem(exchange, 503, "the server ends, or the peer has left", NULL);
        break;
    case OWN_PROCESS_LATE:
        snprintf(detail, sizeof detail,
                 "the map takes longer than the %d s that it may take here: crop it, or use rugo "
                 "characterise",
                 CPU_SECONDS);
        answer_problem(exchange, 422, detail, NULL);
        break;
    case OWN_PROCESS_LARGE:
        snprintf(detail, sizeof detail,
                 "the answer is longer than the %d MiB that it may have here: crop or resample the "
                 "map, or use rugo characterise",
                 ANSWER_MOST >> 20);
        answer_problem(exchange, 422, detail, NULL);
        break;
    case OWN_PROCESS_BROKEN:
        answer_broken(exchange);
        break;
    case OWN_PROCESS_DONE:
        if (result->status != 0) {
            answer_refusal(exchange, result->said);
            break;
        }
        answer_mend(result->output); /* the name of a file may be any bytes */
        answer_text(exchange, 200, format == ANSWER_SVG ? "image/svg+xml" : "application/json",
                    result->output);
        result->output = NULL;
        break;
    }
}

void handle_characterise(struct exchange *exchange, const char *id) {
    enum answer_format format;
    struct own_process_result result;
    struct command_line line;
    struct error err = {0};
    (void)id;
    if (!write_arguments(exchange, &format, &line))
        return;
    if (exchange->body_size == 0) {
        answer_problem(exchange, 400,
                       "a body is needed: the bytes of the file, or a form with several", NULL);
        return;
    }
    struct sent_form form = {0};
    if (!add_source(exchange, &line, &form)) {
        sent_form_clear(&form);
        return;
    }
    uint64_t memory = MEMORY_FACTOR * (uint64_t)exchange->body_most;
    const struct own_process process = {.arguments = line.arguments,
                                        .input = exchange->body,
                                        .input_size = exchange->body_size,
                                        .memory_bytes =
                                            memory > MEMORY_LEAST ? memory : MEMORY_LEAST,
                                        .cpu_seconds = CPU_SECONDS,
                                        .wait_seconds = WAIT_SECONDS,
                                        .output_most = ANSWER_MOST,
                                        .stop = exchange_is_lost,
                                        .context = exchange};
    if (own_process_run(&process, &result, &err) != 0)
        answer_error(exchange, &err);
    else {
        answer_end(exchange, &result, format);
        answer_header(exchange, "Vary", "Accept, Authorization");
        free(result.output);
    }
    sent_form_clear(&form);
}

bool characterise_enter(struct exchange *exchange) {
    exchange->body_most = exchange->service->map_bytes;
    if (exchange->body_most == 0) {
        answer_problem(exchange, 403, "this server takes no files: see serve --map-size", NULL);
        return false;
    }
    if (atomic_fetch_add(&exchange->service->files, 1) < MAPS_MOST) {
        exchange->has_file = true;
        return true;
    }
    atomic_fetch_sub(&exchange->service->files, 1);
    answer_problem(exchange, 503, "other files are being looked at; try again", NULL);
    answer_header(exchange, "Retry-After", "1");
    return false;
}

void characterise_leave(struct exchange *exchange) {
    if (exchange->has_file)
        atomic_fetch_sub(&exchange->service->files, 1);
    exchange->has_file = false;
}
