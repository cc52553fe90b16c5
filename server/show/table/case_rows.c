#include "server/show/table/case_rows.h"
#include "schema/near_name.h"
#include "server/show/plot/plot_words.h"
#include "server/show/table/shown_cases.h"
#include "server/show/table/table_words.h"
#include "server/show/word_list.h"

enum { CONDITIONS_MOST = 32 };

struct condition {
    const char *pointer; /* of the cases */
    char value[TABLE_NAME_SIZE];
    bool holds; /* of the row that is asked now */
};
struct conditions {
    size_t count;
    struct condition list[CONDITIONS_MOST];
};

/* Returns the pointer that a name stands for: "hurst", "surface/hurst" or "/surface/hurst". */
static const char *find_pointer(const struct study_result *study, const char *name) {
    for (size_t c = 0; c < study->case_count; c++)
        for (size_t p = 0; p < study->cases[c].parameter_count; p++) {
            const char *pointer = study->cases[c].parameters[p].pointer;
            if (strcmp(pointer, name) == 0 || strcmp(pointer + 1, name) == 0 ||
                strcmp(last_name(pointer), name) == 0)
                return pointer;
        }
    return NULL;
}

static void describe(const struct result_parameter *value, char *text, size_t size) {
    if (value == NULL)
        snprintf(text, size, "-");
    else if (value->text != NULL)
        snprintf(text, size, "%.60s", value->text);
    else
        snprintf(text, size, "%.10g", value->number);
}

static bool fits(const struct result_parameter *value, const char *wanted) {
    if (value == NULL)
        return false;
    return value->text != NULL ? strcmp(value->text, wanted) == 0
                               : table_word_is(value->number, wanted);
}

/* Names the parameter that is nearest, and what the study sweeps. */
static int refuse_parameter(const struct study_result *study, const char *name, struct error *err) {
    char names[240] = "", hint[NEAR_HINT_SIZE];
    struct near_name near = {.typed = name};
    const cJSON *swept;
    cJSON_ArrayForEach(swept, study->swept) if (cJSON_IsString(swept)) {
        plot_near_parameter(&near, study->kind, swept->valuestring);
        word_list_add(names, sizeof names, ", ", last_name(swept->valuestring));
    }
    for (size_t c = 0; c < study->case_count; c++)
        for (size_t p = 0; p < study->cases[c].parameter_count; p++)
            plot_near_parameter(&near, study->kind, study->cases[c].parameters[p].pointer);
    return error_set(err, ERROR_INPUT,
                     "where: \"%.60s\" is no parameter of the study's cases%s; it sweeps %s", name,
                     near_name_hint(&near, hint), *names != '\0' ? names : "none");
}

static int read_condition(struct conditions *all, const struct study_result *study,
                          const char *text, size_t size, struct error *err) {
    char name[TABLE_NAME_SIZE];
    const char *equals = memchr(text, '=', size);
    size_t length = equals != NULL ? (size_t)(equals - text) : 0;
    int shown = (int)(size > 60 ? 60 : size);
    if (length == 0 || size >= sizeof name)
        return error_set(err, ERROR_INPUT,
                         "where: \"%.*s\" is not NAME=VALUE, as in hurst=0.8; several values are "
                         "hurst=0.2,hurst=0.8",
                         shown, text);
    if (all->count == CONDITIONS_MOST)
        return error_set(err, ERROR_INPUT, "where: more than %d conditions", CONDITIONS_MOST);
    struct condition *one = &all->list[all->count++];
    snprintf(name, sizeof name, "%.*s", (int)length, text);
    snprintf(one->value, sizeof one->value, "%.*s", (int)(size - length - 1), equals + 1);
    one->pointer = find_pointer(study, name);
    if (one->pointer == NULL)
        return refuse_parameter(study, name, err);
    return 0;
}

/* Returns whether, of each parameter that is named, one value fits the case. */
static bool holds(struct conditions *all, const struct case_result *one) {
    bool every = true;
    for (size_t n = 0; n < all->count; n++)
        all->list[n].holds = fits(result_parameter(one, all->list[n].pointer), all->list[n].value);
    for (size_t n = 0; n < all->count; n++) {
        bool any = false;
        for (size_t m = 0; m < all->count; m++)
            any = any ||
                  (all->list[m].holds && strcmp(all->list[m].pointer, all->list[n].pointer) == 0);
        every = every && any;
    }
    return every;
}

/* No case fits: names the values of the first parameter that has no such value, or says that they
 * do not go together. */
static int refuse(const struct conditions *all, const struct study_result *study,
                  struct error *err) {
    for (size_t n = 0; n < all->count; n++) {
        const struct condition *one = &all->list[n];
        char values[320] = "", text[64];
        bool any = false;
        for (size_t c = 0; c < study->case_count; c++) {
            const struct result_parameter *value = result_parameter(&study->cases[c], one->pointer);
            any = any || fits(value, one->value);
            describe(value, text, sizeof text);
            word_list_add(values, sizeof values, ", ", text);
        }
        if (!any)
            return error_set(err, ERROR_INPUT,
                             *one->value != '\0'
                                 ? "where: no case has %s = %.60s; there is %s"
                                 : "where: %s has no value behind the =%s; there is %s",
                             one->pointer, one->value, values);
    }
    return error_set(err, ERROR_INPUT, "where: no case has all of these values at once");
}

int case_rows_choose(const struct study_result *study, const char *const *where,
                     const struct case_result **rows, size_t *count, struct error *err) {
    struct conditions all = {0};
    int status = 0;
    *count = 0;
    for (; where != NULL && *where != NULL && status == 0; where++)
        for (const char *next = *where; status == 0 && next != NULL;) {
            size_t size = strcspn(next, ",");
            status = read_condition(&all, study, next, size, err);
            next = next[size] == ',' ? next + size + 1 : NULL;
        }
    for (size_t c = 0; c < study->case_count && status == 0; c++)
        if (holds(&all, &study->cases[c]))
            rows[(*count)++] = &study->cases[c];
    return status == 0 && *count == 0 && all.count > 0 ? refuse(&all, study, err) : status;
}
