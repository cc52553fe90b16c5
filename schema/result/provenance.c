#include "schema/result/provenance.h"
#include "schema/json/field.h"

/* Prints a text on one line, whatever is in it. */
static void put_line(FILE *file, const char *text) {
    for (; *text != '\0'; text++)
        fputc((unsigned char)*text < ' ' ? ' ' : *text, file);
}

static void put_known(FILE *file, const char *before, const cJSON *object, const char *key) {
    const char *text = cJSON_GetStringValue(field_at(object, key));
    if (text == NULL)
        return;
    fputs(before, file);
    put_line(file, text);
}

static void put_run(FILE *file, const cJSON *run) {
    fprintf(file, "# computed: %.0f jobs", field_number(run, "jobs"));
    put_known(file, " on ", run, "host");
    put_known(file, " by rugo ", run, "program");
    put_known(file, ", ", run, "first");
    put_known(file, " to ", run, "last");
    fputc('\n', file);
}

void provenance_comment(FILE *file, const struct study_result *study) {
    const cJSON *provenance = study->provenance, *runs = field_at(provenance, "runs");
    if (provenance == NULL)
        return;
    fputs("# study: ", file);
    put_line(file, study->name);
    fprintf(file, ", %s %s, %s", study->kind, study->id, study->state);
    put_known(file, ", seed ", provenance, "seed");
    fputs("\n# queued:", file);
    put_known(file, " ", provenance, "created");
    put_known(file, " by rugo ", provenance, "program");
    put_known(file, ", ended ", provenance, "finished");
    fputc('\n', file);
    for (const cJSON *run = runs != NULL ? runs->child : NULL; run != NULL; run = run->next)
        put_run(file, run);
}
