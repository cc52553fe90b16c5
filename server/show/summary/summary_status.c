#include "server/show/summary/summary_status.h"
#include "core/file/plain_text.h"
#include "schema/json/field.h"
#include "server/show/summary/summary_cells.h"
#include <math.h>
#include <string.h>

/* What came from elsewhere is made fit for a terminal in its place. */
static const char *text_of(const cJSON *object, const char *key) {
    char *text = cJSON_GetStringValue(field_at(object, key));
    return text != NULL ? text_make_plain(text) : "-";
}

/* Returns NaN for what is absent or no number. */
static double number_of(const cJSON *object, const char *key) {
    const cJSON *number = field_at(object, key);
    return cJSON_IsNumber(number) ? number->valuedouble : (double)NAN;
}

/* Prints the failure of a job; without one, that of a case that could not be published. */
static void print_failure(const cJSON *failure, FILE *file) {
    const char *reason = text_of(failure, "reason");
    double one = number_of(failure, "case"), first = number_of(failure, "first");
    if (!cJSON_IsNumber(field_at(failure, "job"))) {
        fprintf(file, "  not published: case %.0f: %s\n", one, reason);
        return;
    }
    fprintf(
        file,
        "  failed: case %.0f, realisations %.0f to %.0f, %.0f attempts, %.0f losses, worker %s: "
        "%s\n",
        one, first, first + number_of(failure, "count") - 1, number_of(failure, "attempts"),
        fmax(0, number_of(failure, "losses")), text_of(failure, "worker"), reason);
}

/* Writes the time left, and what it is with. */
static void print_left(const cJSON *status, char *text, size_t size) {
    double seconds = number_of(status, "seconds_left");
    char duration[48];
    duration_text(seconds, duration, sizeof duration);
    const char *state = text_of(status, "state");
    bool ahead = strcmp(state, "queued") == 0;
    if (isnan(seconds) && (ahead || strcmp(state, "running") == 0))
        snprintf(text, size, "not known, as nobody works");
    else
        snprintf(text, size, "%s%s", duration, ahead ? " with what is in front of it" : "");
}

/* Prints the position of a study that waits. */
static void print_line(const cJSON *status, FILE *file) {
    double place = number_of(status, "place"), starts = number_of(status, "starts_in");
    char when[48];
    if (isnan(place))
        return;
    duration_text(starts, when, sizeof when);
    fprintf(file, "  position %.0f in line, ", place);
    if (isnan(starts))
        fprintf(file, "no worker is at work; rugo work starts one\n");
    else if (starts < 1)
        fprintf(file, "starts with the next job\n");
    else
        fprintf(file, "starts in about %s\n", when);
}

void summary_of_status(const cJSON *status, FILE *file) {
    const cJSON *jobs = field_at(status, "jobs"), *realisations = field_at(status, "realisations");
    struct work_time time;
    char left[96], spent[112], done[32];
    work_time_read(status, (uint64_t)fmax(number_of(jobs, "done"), 0), &time);
    print_left(status, left, sizeof left);
    work_time_text(&time, spent, sizeof spent);
    fprintf(file, "%s  %s  %s  %s\n", text_of(status, "id"), text_of(status, "name"),
            text_of(status, "kind"), text_of(status, "state"));
    fputc(' ', file);
    if (!isnan(number_of(status, "share")))
        fprintf(file, " %.1f %% of the work,", 100 * number_of(status, "share"));
    realisations_text(number_of(realisations, "done") + fmax(0, number_of(status, "part")), done,
                      sizeof done);
    fprintf(file, " realisations %s of %.0f, jobs %.0f of %.0f (%.0f running, %.0f failed)\n", done,
            number_of(realisations, "total"), number_of(jobs, "done"), number_of(jobs, "total"),
            number_of(jobs, "running"), number_of(jobs, "failed"));
    fprintf(file, "  workers %.0f, spent %s, left %s\n", number_of(status, "workers"), spent, left);
    print_line(status, file);
    if (time.seconds > 0)
        print_without_cpu(&time, file);
    if (!isnan(number_of(status, "error_reached")))
        fprintf(file, "  error reached %.3g %%\n", 100 * number_of(status, "error_reached"));
    if (number_of(status, "cases_valueless") > 0)
        fprintf(file, "  no realisation has a value in %.0f of %.0f cases: %s\n",
                number_of(status, "cases_valueless"), number_of(status, "cases"),
                text_of(status, "valueless_note"));
    const cJSON *failure;
    cJSON_ArrayForEach(failure, field_at(status, "failures")) {
        print_failure(failure, file);
    }
}

bool status_has_no_value(const cJSON *status) {
    return number_of(status, "cases_valueless") > 0 &&
           !(number_of(status, "cases_valueless") < number_of(status, "cases"));
}

void summary_of_list(const cJSON *studies, FILE *file) {
    struct text_table table = {.columns = 7};
    static const char *const HEADINGS[] = {"id",    "name",   "owner",  "kind",
                                           "state", "done %", "created"};
    for (size_t h = 0; h < 7; h++)
        table_cell(&table, "%s", HEADINGS[h]);
    const cJSON *study;
    cJSON_ArrayForEach(study, field_at(studies, "studies")) {
        static const char *const TEXTS[] = {"id", "name", "owner", "kind", "state"};
        for (size_t n = 0; n < sizeof TEXTS / sizeof *TEXTS; n++)
            table_cell(&table, "%s", text_of(study, TEXTS[n]));
        table_cell(&table, "%.1f", 100 * number_of(study, "share"));
        table_cell(&table, "%s", text_of(study, "created"));
    }
    table_print(&table, file);
    table_clear(&table);
}
