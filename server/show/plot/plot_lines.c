#include "server/show/plot/plot_lines.h"
#include "server/show/summary/summary_cells.h"
#include "server/show/word_list.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The choice narrows by steps, each of which keeps no more than those before it. */
enum { KEEP_ALL, KEEP_ESTIMATES, KEEP_FINEST, KEEP_SERIES, KEEP_MODEL, KEEP_STEPS };

struct choosing {
    const struct lines_request *request;
    const struct curve *first; /* the first curve of all; NULL while it is looked for */
    bool keep[KEEP_STEPS];     /* steps that were taken */
};

static bool is_named(const struct lines_request *request, const char *name) {
    for (size_t c = 0; c < CHANNEL_COUNT; c++)
        if (request->names[c] != NULL && strcmp(request->names[c], name) == 0)
            return true;
    return false;
}

static bool is_level(const struct curve *curve, const char *level) {
    char *end;
    double number = strtod(level, &end);
    return end != level && *end == '\0' && fabs(number - curve->level) <= 1e-9 * fabs(number);
}

static bool is_named_series(const struct curve *curve) {
    return curve->series != NULL && *curve->series != '\0';
}

/* A series without a name is that of the quantity, as the legend has it. */
static bool is_series(const struct curve *curve, const char *series) {
    return strcmp(is_named_series(curve) ? curve->series : curve->quantity, series) == 0;
}

/* Says whether a curve may be drawn; matrices may not. */
static bool is_candidate(const struct choosing *choosing, const struct curve *curve) {
    const struct lines_request *request = choosing->request;
    const char *y_label = request->y_label;
    if (y_label == NULL && choosing->first != NULL)
        y_label = choosing->first->y_label;
    return strcmp(curve->quantity, request->quantity) == 0 && curve->columns == 0 &&
           (y_label == NULL || same_text(curve->y_label, y_label)) &&
           (request->model == NULL || same_text(curve->model, request->model)) &&
           (request->series == NULL || is_series(curve, request->series)) &&
           (request->level == NULL || is_level(curve, request->level));
}

/* Counts the levels of the same series that are finer; none where the request names levels, none of
 * which is then fainter than others. */
static size_t finer_levels(const struct choosing *choosing, const struct case_result *one,
                           const struct curve *curve) {
    size_t finer = 0;
    if (choosing->request->level != NULL || is_named(choosing->request, "level"))
        return 0;
    for (size_t a = 0; a < one->curve_count; a++)
        finer += one->curves[a].level > curve->level && curve_same_series(&one->curves[a], curve) &&
                 same_text(one->curves[a].model, curve->model);
    return finer;
}

static bool is_kept(const struct choosing *choosing, const struct case_result *one,
                    const struct curve *curve) {
    const bool *keep = choosing->keep;
    return is_candidate(choosing, curve) && (!keep[KEEP_ESTIMATES] || !is_bracket(curve->series)) &&
           (!keep[KEEP_FINEST] || finer_levels(choosing, one, curve) == 0) &&
           (!keep[KEEP_SERIES] || same_text(curve->series, choosing->first->series)) &&
           (!keep[KEEP_MODEL] || same_text(curve->model, choosing->first->model));
}

/* Counts the curves that are kept, and, where there is a list, fills it. */
static size_t collect(const struct study_result *study, const struct choosing *choosing,
                      struct plot_line *list) {
    size_t count = 0;
    for (size_t c = 0; c < study->case_count; c++) {
        const struct case_result *one = &study->cases[c];
        for (size_t a = 0; a < one->curve_count; a++) {
            if (!is_kept(choosing, one, &one->curves[a]))
                continue;
            if (list != NULL)
                list[count] =
                    (struct plot_line){.one = one,
                                       .curve = &one->curves[a],
                                       .coarseness = finer_levels(choosing, one, &one->curves[a])};
            count++;
        }
    }
    return count;
}

static const struct curve *first_candidate(const struct study_result *study,
                                           const struct choosing *choosing) {
    for (size_t c = 0; c < study->case_count; c++)
        for (size_t a = 0; a < study->cases[c].curve_count; a++)
            if (is_candidate(choosing, &study->cases[c].curves[a]))
                return &study->cases[c].curves[a];
    return NULL;
}

/* What curves may be chosen by, as bits of those that a quantity has. */
enum { HAS_MODEL = 1, HAS_SERIES = 2, HAS_LEVEL = 4 };

static unsigned attributes_of(const struct curve *curve) {
    return (curve->model != NULL ? HAS_MODEL : 0u) | (is_named_series(curve) ? HAS_SERIES : 0u) |
           (!isnan(curve->level) ? HAS_LEVEL : 0u);
}

/* Writes those of the attributes that a curve has: "halfspace edges 8". */
static void describe(const struct curve *curve, unsigned attributes, char *text, size_t size) {
    char word[40];
    *text = '\0';
    if ((attributes & HAS_MODEL) != 0)
        word_list_append(text, size, " ", curve->model != NULL ? curve->model : "-");
    if ((attributes & HAS_SERIES) != 0)
        word_list_append(text, size, " ", is_named_series(curve) ? curve->series : curve->quantity);
    snprintf(word, sizeof word, isnan(curve->level) ? "-" : "%.4g", curve->level);
    if ((attributes & HAS_LEVEL) != 0)
        word_list_append(text, size, " ", word);
}

/* Writes what the request chooses by: "model full, level 8". */
static void describe_request(const struct lines_request *request, char *text, size_t size) {
    const char *const chosen[][2] = {
        {"model", request->model}, {"series", request->series}, {"level", request->level}};
    *text = '\0';
    for (size_t n = 0; n < sizeof chosen / sizeof *chosen; n++) {
        char word[64];
        snprintf(word, sizeof word, "%s %.40s", chosen[n][0],
                 chosen[n][1] != NULL ? chosen[n][1] : "");
        if (chosen[n][1] != NULL)
            word_list_append(text, size, ", ", word);
    }
}

/* The next curve of the quantity behind one of these numbers, which it moves on; NULL: none. */
static const struct curve *next_candidate(const struct study_result *study,
                                          const struct choosing *choosing, size_t *c, size_t *a) {
    for (; *c < study->case_count; ++*c, *a = 0)
        while (*a < study->cases[*c].curve_count) {
            const struct curve *curve = &study->cases[*c].curves[(*a)++];
            if (is_candidate(choosing, curve))
                return curve;
        }
    return NULL;
}

/* No curve is wanted: names what curves of the quantity have of that by which they are chosen, or
 * says that none has the quantity. */
static int refuse(const struct study_result *study, const struct lines_request *request,
                  struct error *err) {
    static const char *const NAMES[] = {"model", "series", "level"}; /* in the order of the bits */
    const struct lines_request plain = {.quantity = request->quantity, .y_label = request->y_label};
    const struct choosing choosing = {.request = &plain};
    const struct curve *curve;
    char words[320] = "", word[96], names[32] = "", asked[160];
    unsigned attributes = 0;
    bool any = false;
    for (size_t c = 0, a = 0; (curve = next_candidate(study, &choosing, &c, &a)) != NULL;) {
        attributes |= attributes_of(curve);
        any = true;
    }
    if (!any)
        return error_set(err, ERROR_ABSENT, "no case has the quantity \"%.60s\"",
                         request->quantity);
    describe_request(request, asked, sizeof asked);
    if (attributes == 0)
        return error_set(err, ERROR_INPUT,
                         "no curve of %.60s is of %s: its curves have no model, series or level",
                         request->quantity, asked);
    for (size_t c = 0, a = 0; (curve = next_candidate(study, &choosing, &c, &a)) != NULL;) {
        describe(curve, attributes, word, sizeof word);
        word_list_add(words, sizeof words, "; ", word);
    }
    for (unsigned n = 0; n < sizeof NAMES / sizeof *NAMES; n++)
        if ((attributes & 1u << n) != 0)
            word_list_append(names, sizeof names, " ", NAMES[n]);
    return error_set(err, ERROR_INPUT, "no curve of %.60s is of %s; there is (%s): %s",
                     request->quantity, asked, names, words);
}

/* Says what a step that left something out has kept. */
static void note(struct plot_lines *lines, const struct choosing *choosing, int step) {
    const struct curve *first = choosing->first; /* a series without a name is the quantity's */
    const char *series = is_named_series(first) ? first->series : first->quantity;
    char model[64];
    const char *const words[KEEP_STEPS] = {
        [KEEP_ESTIMATES] = "without brackets",
        [KEEP_FINEST] = "finest level",
        [KEEP_SERIES] = series,
        [KEEP_MODEL] =
            model_text(choosing->first->model, choosing->first->kinematics, model, sizeof model)};
    size_t used = strlen(lines->narrowed);
    snprintf(lines->narrowed + used, sizeof lines->narrowed - used, "%s%.60s", used > 0 ? ", " : "",
             words[step]);
}

static size_t narrow(struct plot_lines *lines, const struct study_result *study,
                     struct choosing *choosing) {
    static const char *const NAMES[KEEP_STEPS] = {[KEEP_ESTIMATES] = "series",
                                                  [KEEP_FINEST] = "level",
                                                  [KEEP_SERIES] = "series",
                                                  [KEEP_MODEL] = "model"};
    size_t found = collect(study, choosing, NULL);
    for (int step = KEEP_ESTIMATES; step < KEEP_STEPS && found > PLOT_LINES; step++) {
        if (is_named(choosing->request, NAMES[step]))
            continue;
        choosing->keep[step] = true;
        size_t kept = collect(study, choosing, NULL);
        if (kept < found)
            note(lines, choosing, step);
        found = kept;
    }
    return found;
}

int plot_lines_choose(struct plot_lines *lines, const struct study_result *study,
                      const struct lines_request *request, struct error *err) {
    struct choosing choosing = {.request = request};
    *lines = (struct plot_lines){.kind = study->kind};
    choosing.first = first_candidate(study, &choosing);
    if (choosing.first == NULL)
        return refuse(study, request, err);
    size_t count = narrow(lines, study, &choosing);
    lines->list = array_create(count, sizeof *lines->list);
    if (lines->list == NULL)
        return error_memory(err, count * sizeof *lines->list, "lines");
    lines->count = collect(study, &choosing, lines->list);
    int status = plot_channels_set(lines, request, err);
    if (status != 0)
        plot_lines_clear(lines);
    return status;
}

int plot_lines_take(struct plot_lines *lines, const char *kind, struct plot_line *list,
                    size_t count, const struct lines_request *request, struct error *err) {
    *lines = (struct plot_lines){.kind = kind, .list = list, .count = count};
    int status = plot_channels_set(lines, request, err);
    if (status != 0)
        plot_lines_clear(lines);
    return status;
}

void plot_lines_clear(struct plot_lines *lines) {
    for (size_t f = 0; f < lines->factor_count; f++)
        free(lines->factors[f].values);
    for (size_t c = 0; c < CHANNEL_COUNT; c++)
        free(lines->channels[c].lines);
    free(lines->list);
    *lines = (struct plot_lines){0};
}
