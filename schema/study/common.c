#include "schema/study/common.h"
#include "schema/study/value.h"
#include <stdlib.h>
#include <string.h>

const struct choice STUDY_RANDOM[] = {
    {"common", RANDOM_COMMON}, {"independent", RANDOM_INDEPENDENT}, {0}};

uint64_t study_sequence(enum study_random random, uint64_t case_number) {
    return random == RANDOM_COMMON ? 0 : case_number;
}

static const struct parameter ROWS[] = {
    {.path = "/name",
     .type = PARAMETER_TEXT,
     .minimum = 1,
     .maximum = 200,
     .required = true,
     .example_json = "\"roughness and load\"",
     .help = "name of the study, shown with its results"},
    {.path = "/kind",
     .type = PARAMETER_CHOICE,
     .required = true,
     .example_json = "\"statistics\"",
     .help = "what is computed; it says which of the members below the study may have"},
    {.path = "/seed",
     .type = PARAMETER_SEED,
     .minimum = 0,
     .maximum = 0x1p53,
     .default_json = "1",
     .example_json = "\"18446744073709551615\"",
     .help = "of all random numbers: the same study and seed give the same results, to the bit; "
             "seeds above 2^53, up to 2^64 - 1, are written as a decimal string"},
    {.path = "/random",
     .type = PARAMETER_CHOICE,
     .choices = STUDY_RANDOM,
     .default_json = "\"common\"",
     .example_json = "\"independent\"",
     .help = "common: all cases use the same random numbers, so that only parameters differ "
             "between them and their errors are correlated; independent: each case its own"},
    {.path = "/realisations",
     .type = PARAMETER_INTEGER,
     .minimum = 1,
     .maximum = STUDY_REALISATIONS_MOST,
     .example_json = "500",
     .help = "random surfaces of each case; the kind's own number unless given"},
    {.path = "/priority",
     .type = PARAMETER_INTEGER,
     .minimum = -PRIORITY_MOST,
     .maximum = PRIORITY_MOST,
     .default_json = "0",
     .example_json = "5",
     .help = "among the studies of one owner that wait: higher ones first, then older ones"},
};
const struct parameter_table COMMON_PARAMETERS = {"study", ROWS, sizeof ROWS / sizeof *ROWS};

struct choice *kind_choices(const struct study_kind *const *kinds) {
    size_t count = 0;
    while (kinds[count] != NULL)
        count++;
    struct choice *choices = array_create(count + 1, sizeof *choices);
    for (size_t k = 0; choices != NULL && k < count; k++)
        choices[k] = (struct choice){kinds[k]->name, (int)k};
    return choices;
}

/* Some users ask for an error where the number of realisations stands; the fault names
 * /target/error. */
static bool asks_for_error(const cJSON *realisations, struct fault_list *faults) {
    if (!cJSON_HasObjectItem(realisations, "target_error"))
        return false;
    fault_add(faults, "/realisations",
              "give a number; an error is asked for by /target/error, in its place");
    return true;
}

static int take(struct study *study, const struct parameter *row, const cJSON *value,
                const struct study_kind *const *kinds, struct error *err) {
    uint64_t seed = 0;
    if (strcmp(row->path, "/random") == 0) {
        study->random = (enum study_random)choice_find(row->choices, value->valuestring)->value;
    } else if (row->type == PARAMETER_CHOICE) {
        study->kind = kinds[choice_find(row->choices, value->valuestring)->value];
    } else if (strcmp(row->path, "/priority") == 0) {
        study->priority = (int64_t)value->valuedouble;
    } else if (row->type == PARAMETER_INTEGER) {
        study->realisations = (uint64_t)value->valuedouble;
    } else if (row->type == PARAMETER_SEED && value_seed(value, &seed)) {
        study->seed = seed;
    } else if (row->type == PARAMETER_TEXT) {
        study->name = strdup(value->valuestring);
        if (study->name == NULL)
            return error_memory(err, strlen(value->valuestring), "a study's name");
    }
    return 0;
}

/* Reads the value of a row where it is given and valid, else its default. */
static int read_row(struct study *study, const struct parameter *row, const cJSON *document,
                    const struct study_kind *const *kinds, struct fault_list *faults,
                    struct error *err) {
    const cJSON *given = json_at(document, row->path);
    if (given == NULL && row->required)
        value_missing(row, faults);
    if (given != NULL) {
        bool good = !asks_for_error(given, faults) && value_check(row, given, row->path, faults);
        return good ? take(study, row, given, kinds, err) : 0;
    }
    if (row->default_json == NULL)
        return 0;
    cJSON *usual = value_default(row);
    int status = usual != NULL ? take(study, row, usual, kinds, err)
                               : error_memory(err, strlen(row->default_json), row->path);
    cJSON_Delete(usual);
    return status;
}

int common_read(struct study *study, const cJSON *document, const struct study_kind *const *kinds,
                struct fault_list *faults, struct error *err) {
    struct choice *choices = kind_choices(kinds);
    if (choices == NULL)
        return error_memory(err, sizeof *choices, "the kinds of studies");
    int status = 0;
    for (size_t p = 0; status == 0 && p < COMMON_PARAMETERS.count; p++) {
        struct parameter row = COMMON_PARAMETERS.rows[p];
        if (row.type == PARAMETER_CHOICE && row.choices == NULL)
            row.choices = choices;
        status = read_row(study, &row, document, kinds, faults, err);
    }
    bool target = study->kind != NULL && study->kind->expand != NULL &&
                  cJSON_HasObjectItem(document, "target");
    if (target && study->realisations != 0)
        fault_add(faults, "/realisations", "a study with a target chooses their number itself");
    if (target)
        study->realisations = 0;
    else if (study->realisations == 0)
        study->realisations = study->kind != NULL ? study->kind->default_realisations : 1;
    free(choices);
    return status;
}
