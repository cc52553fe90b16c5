#include "server/show/summary_status.h"
#include "server/show/document.h"
#include "server/show/summary_cells.h"

/* Of a job; without one, of a case whose curves could not be published. */
static void print_failure(const cJSON *failure, FILE *file) {
    double first = number_of(failure, "first");
    if (!cJSON_IsNumber(member(failure, "job")))
        fprintf(file, "  not published: case %.0f: %s\n", number_of(failure, "case"),
                text_of(failure, "reason", "-"));
    else
        fprintf(file,
                "  failed: case %.0f, realisations %.0f to %.0f, %.0f attempts, worker %s: %s\n",
                number_of(failure, "case"), first, first + number_of(failure, "count") - 1,
                number_of(failure, "attempts"), text_of(failure, "worker", "-"),
                text_of(failure, "reason", "-"));
}

void summary_of_status(const cJSON *status, FILE *file) {
    const cJSON *jobs = member(status, "jobs"), *realisations = member(status, "realisations");
    char left[48], spent[48];
    duration_text(number_of(status, "seconds_left"), left, sizeof left);
    duration_text(number_of(status, "seconds"), spent, sizeof spent);
    fprintf(file, "%s  %s  %s  %s\n", text_of(status, "id", "-"), text_of(status, "name", "-"),
            text_of(status, "kind", "-"), text_of(status, "state", "-"));
    fprintf(file, "  realisations %.0f of %.0f, jobs %.0f of %.0f (%.0f running, %.0f failed)\n",
            number_of(realisations, "done"), number_of(realisations, "total"),
            number_of(jobs, "done"), number_of(jobs, "total"), number_of(jobs, "running"),
            number_of(jobs, "failed"));
    fprintf(file, "  workers %.0f, spent %s, left %s\n", number_of(status, "workers"), spent, left);
    for (const cJSON *failure = first_of(status, "failures"); failure != NULL;
         failure = failure->next)
        print_failure(failure, file);
}

void summary_of_list(const cJSON *studies, FILE *file) {
    struct text_table table = {.columns = 6};
    static const char *const HEADINGS[] = {"id", "name", "kind", "state", "done %", "created"};
    for (size_t h = 0; h < 6; h++)
        table_cell(&table, "%s", HEADINGS[h]);
    for (const cJSON *s = first_of(studies, "studies"); s != NULL; s = s->next) {
        const cJSON *realisations = member(s, "realisations");
        table_cell(&table, "%s", text_of(s, "id", "-"));
        table_cell(&table, "%s", text_of(s, "name", "-"));
        table_cell(&table, "%s", text_of(s, "kind", "-"));
        table_cell(&table, "%s", text_of(s, "state", "-"));
        table_cell(&table, "%.1f",
                   100 * number_of(realisations, "done") / number_of(realisations, "total"));
        table_cell(&table, "%s", text_of(s, "created", "-"));
    }
    table_print(&table, file);
    table_clear(&table);
}
