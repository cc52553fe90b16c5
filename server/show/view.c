#include "server/show/view.h"
#include "jobs/kind.h"
#include <string.h>

static const struct result_view PLAIN = {0};

const struct result_view *view_of(const char *kind) {
    const struct job_kind *found = kind != NULL ? kind_find(kind) : NULL;
    return found != NULL && found->view != NULL ? found->view : &PLAIN;
}

const struct logarithmic_picture *view_logarithmic(const struct result_view *view,
                                                   const char *quantity) {
    const struct logarithmic_picture *picture = view->logarithmic;
    for (; picture != NULL && picture->quantity != NULL; picture++)
        if (strcmp(picture->quantity, quantity) == 0)
            return picture;
    return NULL;
}

const char *view_series_name(const struct result_view *view, const struct case_result *one,
                             const char *series) {
    const struct series_name *row = view->series_names;
    for (; row != NULL && row->series != NULL && series != NULL; row++) {
        const struct result_parameter *value =
            row->pointer != NULL ? result_parameter(one, row->pointer) : NULL;
        bool always = row->pointer == NULL;
        if (strcmp(row->series, series) == 0 && (always || (value != NULL && value->text != NULL &&
                                                            strcmp(value->text, row->value) == 0)))
            return row->name;
    }
    return NULL;
}

static const struct shown_name *find_name(const struct result_view *view, const char *name) {
    const struct shown_name *row = view->names;
    for (; row != NULL && row->name != NULL; row++)
        if (strcmp(row->name, name) == 0)
            return row;
    return NULL;
}

const char *view_words(const struct result_view *view, const char *name) {
    const struct shown_name *row = find_name(view, name);
    return row != NULL ? row->words : name;
}

const char *view_label(const struct result_view *view, const char *label) {
    const struct shown_name *row = find_name(view, label);
    return row == NULL ? label : row->label != NULL ? row->label : row->words;
}
