#include "schema/result/provenance.h"
#include "core/file/plain_text.h"
#include "schema/json/field.h"

static void put_known(FILE *file, const char *before, const cJSON *object, const char *key) {
    const char *text = cJSON_GetStringValue(field_at(object, key));
    if (text == NULL)
        return;
    fputs(before, file);
    text_print_plain(file, text); /* control characters are replaced, so that it stays one line */
}

static void put_run(FILE *file, const cJSON *run) {
    fprintf(file, "# computed: %.0f jobs", field_number(run, "jobs"));
    put_known(file, " on ", run, "host");
    put_known(file, " by rugo ", run, "program");
    put_known(file, ", ", run, "first");
    put_known(file, " to ", run, "last");
    fputc('\n', file);
}

/* Prints the measured surface that the surfaces of the study resemble. */
static void put_measured(FILE *file, const struct study_result *study) {
    static const char *const ITEMS[][2] = {{"# like: ", "/surface/like/file"},
                                           {", SHA-256 ", "/surface/like/sha256"},
                                           {", prepared by ", "/surface/like/prepared"}};
    const struct case_result *first = study->case_count > 0 ? &study->cases[0] : NULL;
    if (first == NULL || result_parameter(first, ITEMS[0][1]) == NULL)
        return;
    for (size_t t = 0; t < sizeof ITEMS / sizeof *ITEMS; t++) {
        const struct result_parameter *value = result_parameter(first, ITEMS[t][1]);
        if (value == NULL || value->text == NULL || *value->text == '\0')
            continue;
        fputs(ITEMS[t][0], file);
        text_print_plain(file, value->text);
    }
    fputc('\n', file);
}

void provenance_comment(FILE *file, const struct study_result *study) {
    const cJSON *provenance = study->provenance, *runs = field_at(provenance, "runs");
    if (provenance == NULL)
        return;
    fputs("# study: ", file);
    text_print_plain(file, study->name);
    fprintf(file, ", %s %s, %s", study->kind, study->id, study->state);
    put_known(file, ", seed ", provenance, "seed");
    fputs("\n# queued:", file);
    put_known(file, " ", provenance, "created");
    put_known(file, " by rugo ", provenance, "program");
    put_known(file, ", ended ", provenance, "finished");
    fputc('\n', file);
    put_measured(file, study);
    for (const cJSON *run = runs != NULL ? runs->child : NULL; run != NULL; run = run->next)
        put_run(file, run);
}
