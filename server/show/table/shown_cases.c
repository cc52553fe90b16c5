#include "server/show/table/shown_cases.h"
#include <stdlib.h>
#include <string.h>

/* --- what was swept --- */

const struct result_parameter *parameter_at(const struct case_result *one, const char *pointer,
                                            size_t place) {
    if (place < one->parameter_count && strcmp(one->parameters[place].pointer, pointer) == 0)
        return &one->parameters[place];
    return result_parameter(one, pointer);
}

bool parameter_same(const struct result_parameter *a, const struct result_parameter *b) {
    if (a == NULL || b == NULL)
        return a == b;
    if (a->text != NULL && b->text != NULL)
        return strcmp(a->text, b->text) == 0;
    return a->text == b->text && a->number == b->number;
}

/* Returns whether some case has another value than the first one at its parameter p. */
static bool varies(const struct shown_cases *shown, size_t p) {
    const struct result_parameter *first = &shown->list[0]->parameters[p];
    for (size_t c = 1; c < shown->count; c++)
        if (!parameter_same(first, parameter_at(shown->list[c], first->pointer, p)))
            return true;
    return false;
}

static bool is_varied(const struct shown_cases *shown, const char *pointer) {
    for (size_t n = 0; n < shown->varied_count; n++)
        if (strcmp(shown->varied[n], pointer) == 0)
            return true;
    return false;
}

static void find_varied(struct shown_cases *shown) {
    for (size_t c = 0; c < shown->count; c++) {
        const struct case_result *one = shown->list[c];
        for (size_t p = 0; p < one->parameter_count && shown->varied_count < COLUMNS_MOST; p++) {
            const char *pointer = one->parameters[p].pointer;
            bool candidate =
                c == 0 ? varies(shown, p) : parameter_at(shown->list[0], pointer, p) == NULL;
            if (candidate && !one->parameters[p].list && !is_varied(shown, pointer))
                shown->varied[shown->varied_count++] = pointer;
        }
    }
}

/* --- from results and reports --- */

static bool is_partial(const struct case_result *one) {
    for (size_t a = 0; a < one->curve_count; a++) {
        const struct curve *curve = &one->curves[a];
        for (size_t n = 0; n < curve->n && curve_is_partial(curve); n++)
            if (curve->valueless[n] > 0)
                return true;
    }
    return false;
}

bool shown_of_results(const struct study_result *study, struct shown_cases *out) {
    *out = (struct shown_cases){.list = array_create(study->case_count, sizeof *out->list)};
    if (out->list == NULL)
        return false;
    out->count = study->case_count;
    for (size_t c = 0; c < out->count; c++) {
        out->list[c] = &study->cases[c];
        out->partial = out->partial || is_partial(&study->cases[c]);
    }
    find_varied(out);
    return true;
}

bool shown_of_report(const struct study_report *report, struct shown_cases *out) {
    *out = (struct shown_cases){.list = array_create(report->case_count, sizeof *out->list)};
    if (out->list == NULL)
        return false;
    out->count = report->case_count;
    for (size_t c = 0; c < out->count; c++) {
        const struct case_report *one = &report->cases[c];
        out->list[c] = &one->about;
        for (size_t a = 0; a < one->curve_count; a++)
            out->partial = out->partial || one->curves[a].valueless > 0;
    }
    find_varied(out);
    return true;
}

void shown_clear(struct shown_cases *shown) {
    free(shown->list);
    *shown = (struct shown_cases){0};
}

/* --- lines of text --- */

const char *last_name(const char *pointer) {
    const char *slash = strrchr(pointer, '/');
    return slash != NULL ? slash + 1 : pointer;
}

void print_swept(const struct shown_cases *shown, size_t c, FILE *file) {
    for (size_t n = 0; n < shown->varied_count; n++) {
        const struct result_parameter *value = result_parameter(shown->list[c], shown->varied[n]);
        if (value != NULL && value->text != NULL)
            fprintf(file, "%s, ", value->text);
        else if (value != NULL)
            fprintf(file, "%s %.5g, ", last_name(value->pointer), value->number);
    }
}

void print_notes(const struct shown_cases *shown, size_t most, FILE *file) {
    uint64_t all = 0, printed = 0;
    for (size_t c = 0; c < shown->count; c++)
        all += shown->list[c]->notes_all;
    if (all > 0)
        fprintf(file, "\nnotes: %llu\n", (unsigned long long)all);
    for (size_t c = 0; c < shown->count; c++) {
        const struct case_result *one = shown->list[c];
        for (size_t n = 0; n < one->note_count && printed < most; n++, printed++)
            fprintf(file, "case %llu, realisation %llu: %s\n", (unsigned long long)one->case_number,
                    (unsigned long long)one->notes[n].realisation, one->notes[n].text);
    }
    if (printed < all)
        fprintf(file, "and %llu more\n", (unsigned long long)(all - printed));
}

void print_missing(const struct shown_cases *shown, FILE *file) {
    bool first = true;
    for (size_t c = 0; c < shown->count; c++) {
        if (shown->list[c]->error == NULL)
            continue;
        fprintf(file, "%sno results: %s\n", first ? "\n" : "", shown->list[c]->error);
        first = false;
    }
}

void print_partial(const struct shown_cases *shown, const char *x, FILE *file) {
    if (shown->partial)
        fprintf(file,
                "\n(n of N): only n of N realisations have a value at the %s; of a curve, at the "
                "%s with fewest\n",
                x, x);
}
