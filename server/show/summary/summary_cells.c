#include "server/show/summary/summary_cells.h"
#include <math.h>
#include <string.h>

void varied_headings(struct text_table *table, const struct shown_cases *shown) {
    for (size_t n = 0; n < shown->varied_count; n++)
        table_cell(table, "%s", last_name(shown->varied[n]));
}

void varied_cells(struct text_table *table, const struct shown_cases *shown, size_t c) {
    for (size_t n = 0; n < shown->varied_count; n++) {
        const struct result_parameter *value = result_parameter(shown->list[c], shown->varied[n]);
        if (value != NULL && value->text != NULL)
            table_cell(table, "%s", value->text);
        else
            table_number(table, value != NULL ? value->number : (double)NAN);
    }
}

void measured_text(double value, double error, char *out, size_t size) {
    if (!isfinite(value)) {
        snprintf(out, size, "-");
        return;
    }
    bool uncertain = error > 1e-9 * fabs(value);
    int decimals = uncertain ? 1 - (int)floor(log10(error)) : 0;
    decimals = decimals < 0 ? 0 : decimals;
    if (!uncertain)
        snprintf(out, size, "%.5g", value);
    else if (decimals > 9)
        snprintf(out, size, "%.5g +- %.2g", value, error);
    else
        snprintf(out, size, "%.*f +- %.*f", decimals, value, decimals, error);
}

void measured_cell(struct text_table *table, double value, double error) {
    char text[64];
    measured_text(value, error, text, sizeof text);
    table_cell(table, "%s", text);
}

const char *partial_text(double realisations, double valueless, char *out, size_t size) {
    out[0] = '\0';
    if (valueless > 0)
        snprintf(out, size, " (%.0f of %.0f)", realisations - valueless, realisations);
    return out;
}

void percent_cell(struct text_table *table, double share) {
    if (isnan(share))
        table_cell(table, "-");
    else
        table_cell(table, "%.2g", 100 * share);
}

void total_share_cell(struct text_table *table, double share, bool partial) {
    if (!isfinite(share))
        table_cell(table, "-");
    else
        table_cell(table, "%s%.2g", partial ? ">" : "", 100 * share);
}

void total_cell(struct text_table *table, double value, const struct total *total) {
    total_share_cell(table, total_half_width(value, total) / fabs(value), total_is_partial(total));
}

void print_total_legend(FILE *file) {
    fputs("total: the truth lies within so many percent, to 95 %, by all errors that are known "
          "(>2: others bear on it, too).\n",
          file);
}

const char *source_word(const char *const *words, size_t source) {
    return words != NULL && source < ERROR_SOURCES && words[source] != NULL
               ? words[source]
               : unknown_source_name(source);
}

static void print_sources(const char *title, size_t count, const bool *chosen,
                          const char *const *words, FILE *file) {
    size_t told = 0;
    for (size_t s = 0; s < count; s++)
        if (chosen[s])
            fprintf(file, "%s%s", told++ > 0 ? ", " : title, source_word(words, s));
    if (told > 0)
        fputs(".\n", file);
}

void print_unknown(const bool unknown[UNKNOWN_SOURCES], const char *const *words, FILE *file) {
    print_sources("Errors not known: ", UNKNOWN_SOURCES, unknown, words, file);
}

static void print_source_of(size_t count, const struct unknown_of *list, size_t source,
                            FILE *file) {
    size_t lacking = 0, named = 0;
    for (size_t n = 0; n < count; n++)
        lacking += list[n].unknown[source];
    for (size_t n = 0; n < count && lacking < count; n++)
        if (list[n].unknown[source])
            fprintf(file, "%s%s",
                    named++ == 0       ? " of "
                    : named == lacking ? " and "
                                       : ", ",
                    list[n].name);
}

void print_unknown_of(size_t count, const struct unknown_of *list, const char *const *words,
                      FILE *file) {
    bool any = false;
    for (size_t s = 0; s < UNKNOWN_SOURCES; s++) {
        size_t n = 0;
        while (n < count && !list[n].unknown[s])
            n++;
        if (n == count)
            continue;
        fprintf(file, "%s%s", any ? "; " : "Errors not known: ", source_word(words, s));
        print_source_of(count, list, s, file);
        any = true;
    }
    fputs(any ? ".\n" : "", file);
}

double error_shown(size_t source) {
    return source == ERROR_SOLVER ? SOLVER_SHOWN : ERROR_SHOWN;
}

void print_small(const bool small[ERROR_SOURCES], const char *const *words, FILE *file) {
    bool others[ERROR_SOURCES], solver[ERROR_SOURCES] = {[ERROR_SOLVER] = small[ERROR_SOLVER]};
    for (size_t s = 0; s < ERROR_SOURCES; s++)
        others[s] = small[s] && s != ERROR_SOLVER;
    print_sources("Errors below 0.01 %: ", ERROR_SOURCES, others, words, file);
    print_sources("Errors below 0.5 %: ", ERROR_SOURCES, solver, words, file);
}

void print_law_legend(FILE *file) {
    fputs("law: what the other law of heights would give (/surface/heights/law), less this; no "
          "error, and in no total.\n",
          file);
}

static bool has_patch(const struct case_result *one) {
    bool has = false;
    for (size_t a = 0; a < one->curve_count; a++)
        has = has || one->curves[a].errors[ERROR_PATCH].applies;
    for (size_t s = 0; s < one->scalar_count; s++)
        has = has || one->scalars[s].errors[ERROR_PATCH].applies;
    return has;
}

void print_patch_legend(const struct shown_cases *shown, FILE *file) {
    bool any = false;
    for (size_t c = 0; c < shown->count; c++)
        any = any || has_patch(shown->list[c]);
    if (any)
        fputs("patch: surfaces like the measured one, less that which it was cut from "
              "(/surface/like/uncertainty).\n",
              file);
}

static void print_off(const struct shown_cases *shown, const char *name, const char *what,
                      FILE *file) {
    double most = HEIGHTS_OFF;
    const struct case_result *worst = NULL;
    for (size_t c = 0; c < shown->count; c++) {
        const struct scalar *off = result_scalar(shown->list[c], name);
        if (off != NULL && off->value > most) {
            most = off->value;
            worst = shown->list[c];
        }
    }
    if (worst != NULL)
        fprintf(file,
                "%s up to %.2g %% off what was asked for (%s, case %llu): iterated surfaces do not "
                "reach both.\n",
                what, 100 * most, name, (unsigned long long)worst->case_number);
}

/* Says in which cases surfaces stopped before their errors were as small as was asked for. */
static void print_stopped(const struct shown_cases *shown, FILE *file) {
    enum { NAMED_MOST = 6 };
    size_t count = 0;
    for (size_t c = 0; c < shown->count; c++) {
        const struct scalar *within = result_scalar(shown->list[c], "generator_converged");
        if (within == NULL || !(within->value < 1) || ++count > NAMED_MOST)
            continue;
        fprintf(file, "%s%llu",
                count == 1 ? "Iterated surfaces end above /surface/heights/tolerance in cases "
                           : ", ",
                (unsigned long long)shown->list[c]->case_number);
        if (within->value > 0)
            fprintf(file, " (%.2g %% of them)", 100 * (1 - within->value));
    }
    if (count > NAMED_MOST)
        fprintf(file, " and %zu more", count - NAMED_MOST);
    fputs(count > 0 ? ": eps_h, eps_s are what they reach.\n" : "", file);
}

void print_heights(const struct shown_cases *shown, FILE *file) {
    print_stopped(shown, file);
    print_off(shown, "eps_h", "Heights are", file);
    print_off(shown, "eps_s", "The spectrum is", file);
}

const char *model_text(const char *model, const char *kinematics, char *out, size_t size) {
    model = model != NULL ? model : "-";
    if (kinematics != NULL)
        snprintf(out, size, "%s (%s)", model, kinematics);
    else
        snprintf(out, size, "%s", model);
    return out;
}

static bool ends_with(const char *text, const char *end) {
    size_t length = strlen(text), tail = strlen(end);
    return length >= tail && strcmp(text + length - tail, end) == 0;
}

bool is_bracket(const char *series) {
    return series != NULL && (ends_with(series, "_lower") || ends_with(series, "_upper"));
}

void duration_text(double seconds, char *out, size_t size) {
    if (isnan(seconds))
        snprintf(out, size, "-");
    else if (seconds > 0 && seconds < 0.1)
        snprintf(out, size, "%.3g ms", 1000 * seconds);
    else if (seconds < 100)
        snprintf(out, size, "%.3g s", seconds);
    else if (seconds < 6000)
        snprintf(out, size, "%.0f min %02.0f s", floor(seconds / 60), floor(fmod(seconds, 60)));
    else
        snprintf(out, size, "%.0f h %02.0f min", floor(seconds / 3600),
                 floor(fmod(seconds, 3600) / 60));
}

void realisations_text(double realisations, char *out, size_t size) {
    bool whole = realisations == floor(realisations);
    snprintf(out, size, whole ? "%.0f" : "%.2f", realisations);
}

void work_time_text(const struct work_time *time, char *out, size_t size) {
    char clock[48], cpu[48];
    duration_text(time->seconds, clock, sizeof clock);
    duration_text(time->cpu_seconds, cpu, sizeof cpu);
    snprintf(out, size, "%s of CPU time in %s of workers' time", cpu, clock);
}

void print_without_cpu(const struct work_time *time, FILE *file) {
    if (time->jobs_without_cpu > 0)
        fprintf(file, "Jobs whose CPU time is not known, so that the clock stands for it: %llu.\n",
                (unsigned long long)time->jobs_without_cpu);
}

void print_random(const char *random, size_t cases, FILE *file) {
    if (cases > 1 && random != NULL && strcmp(random, "common") == 0)
        fputs("Cases are made of the same random numbers: their errors are correlated.\n", file);
}

void duration_cell(struct text_table *table, double seconds) {
    char text[48];
    duration_text(seconds, text, sizeof text);
    table_cell(table, "%s", text);
}

const struct case_report *report_of(const struct study_report *report,
                                    const struct case_result *one) {
    size_t c = one->case_number;
    bool known = report != NULL && c < report->case_count &&
                 report->cases[c].about.case_number == one->case_number;
    return known ? &report->cases[c] : NULL;
}
