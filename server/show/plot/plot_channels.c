/* Which factor of the lines of a picture is seen by panels, colours and dashes. */
#include "server/show/plot/plot_lines.h"
#include "server/show/table/shown_cases.h"
#include "server/show/view.h"
#include "server/show/word_list.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char *const CHANNEL_NAMES[CHANNEL_COUNT] = {"panel", "colour", "dash"};

/* --- factors --- */

struct plot_value factor_value(const struct plot_factor *factor, const struct plot_line *line) {
    if (factor->attribute != NULL)
        return (struct plot_value){curve_attribute_text(line->curve, factor->attribute),
                                   curve_attribute_number(line->curve, factor->attribute)};
    const struct result_parameter *value = result_parameter(line->one, factor->pointer);
    if (value == NULL)
        return (struct plot_value){NULL, NAN};
    return (struct plot_value){value->text, value->text != NULL ? (double)NAN : value->number};
}

static bool same_value(const struct plot_value *a, const struct plot_value *b) {
    return same_text(a->text, b->text) && same_number(a->number, b->number);
}

static int compare_numbers(const void *a, const void *b) {
    const struct plot_value *one = a, *other = b;
    return (one->number > other->number) - (one->number < other->number);
}

/* Gathers the values of a factor; it is left out where all lines have the same. */
static int add_factor(struct plot_lines *lines, struct plot_factor factor, struct error *err) {
    factor.values = array_create(lines->count, sizeof *factor.values);
    if (factor.values == NULL)
        return error_memory(err, lines->count * sizeof *factor.values, "values");
    factor.ordered = true;
    for (size_t n = 0; n < lines->count; n++) {
        struct plot_value value = factor_value(&factor, &lines->list[n]);
        bool met = false;
        for (size_t v = 0; v < factor.count && !met; v++)
            met = same_value(&factor.values[v], &value);
        if (met)
            continue;
        factor.values[factor.count++] = value;
        factor.ordered = factor.ordered && value.text == NULL && isfinite(value.number);
    }
    if (factor.ordered)
        qsort(factor.values, factor.count, sizeof *factor.values, compare_numbers);
    if (factor.count > 1 && lines->factor_count < FACTORS_MOST)
        lines->factors[lines->factor_count++] = factor;
    else
        free(factor.values);
    return 0;
}

static bool has_factor(const struct plot_lines *lines, const char *pointer) {
    for (size_t f = 0; f < lines->factor_count; f++)
        if (lines->factors[f].pointer != NULL && strcmp(lines->factors[f].pointer, pointer) == 0)
            return true;
    return false;
}

/* Adds the parameters of the first line's case, then those that other cases have alone. Lists go
 * with a number, such as the loads with the highest one, and are left out. */
static int add_parameters(struct plot_lines *lines, const char *left_out, struct error *err) {
    int status = 0;
    for (size_t n = 0; n < lines->count && status == 0; n++) {
        const struct case_result *one = lines->list[n].one;
        for (size_t p = 0; p < one->parameter_count && status == 0; p++) {
            const char *pointer = one->parameters[p].pointer;
            bool known = n > 0 && result_parameter(lines->list[0].one, pointer) != NULL;
            if (known || one->parameters[p].list || has_factor(lines, pointer) ||
                (left_out != NULL && strcmp(pointer, left_out) == 0))
                continue;
            status = add_factor(lines, (struct plot_factor){.pointer = pointer}, err);
        }
    }
    return status;
}

static bool is_attribute(const struct plot_factor *factor, const char *key) {
    return factor->attribute != NULL && strcmp(factor->attribute->key, key) == 0;
}

/* Returns whether levels are shown by how faint they are, since no channel shows them. */
static bool is_faintness(const struct lines_request *request, const char *key) {
    for (size_t c = 0; c < CHANNEL_COUNT; c++)
        if (request->names[c] != NULL && strcmp(request->names[c], "level") == 0)
            return false;
    return strcmp(key, "level") == 0;
}

/* The points of a grid go with its level. */
static int add_attributes(struct plot_lines *lines, const struct lines_request *request,
                          struct error *err) {
    int status = 0;
    for (size_t a = 0; a < CURVE_ATTRIBUTE_COUNT && status == 0; a++) {
        const struct curve_attribute *row = &CURVE_ATTRIBUTES[a];
        if (strcmp(row->key, "points") != 0 && !is_faintness(request, row->key))
            status = add_factor(lines, (struct plot_factor){.attribute = row}, err);
    }
    return status;
}

/* --- channels --- */

static const char *factor_name(const struct plot_factor *factor) {
    return factor->attribute != NULL ? factor->attribute->key : last_name(factor->pointer);
}

static bool is_named(const struct plot_factor *factor, const char *name) {
    return strcmp(factor_name(factor), name) == 0 ||
           (factor->pointer != NULL &&
            (strcmp(factor->pointer, name) == 0 || strcmp(factor->pointer + 1, name) == 0));
}

static void give(struct plot_lines *lines, enum plot_channel_type type, size_t factor,
                 bool taken[FACTORS_MOST]) {
    struct plot_channel *channel = &lines->channels[type];
    channel->factors[channel->factor_count++] = &lines->factors[factor];
    taken[factor] = true;
}

static int refuse(const struct plot_lines *lines, const char *channel, const char *name,
                  struct error *err) {
    char names[256] = "", hint[NEAR_HINT_SIZE];
    struct near_name near = {.typed = name};
    for (size_t f = 0; f < lines->factor_count; f++) {
        size_t used = strlen(names);
        if (lines->factors[f].pointer != NULL)
            plot_near_parameter(&near, lines->kind, lines->factors[f].pointer);
        snprintf(names + used, sizeof names - used, "%s%s", used > 0 ? ", " : "",
                 factor_name(&lines->factors[f]));
    }
    return error_set(err, ERROR_INPUT,
                     "%s: \"%.60s\" does not differ between the lines%s; what differs: %s", channel,
                     name, near_name_hint(&near, hint), *names != '\0' ? names : "nothing");
}

static int give_named(struct plot_lines *lines, const struct lines_request *request,
                      bool taken[FACTORS_MOST], struct error *err) {
    for (int c = 0; c < CHANNEL_COUNT; c++) {
        size_t f = 0;
        if (request->names[c] == NULL)
            continue;
        while (f < lines->factor_count && !is_named(&lines->factors[f], request->names[c]))
            f++;
        if (f == lines->factor_count)
            return refuse(lines, CHANNEL_NAMES[c], request->names[c], err);
        if (taken[f])
            return error_set(err, ERROR_INPUT, "%s: \"%.60s\" is shown by another channel already",
                             CHANNEL_NAMES[c], request->names[c]);
        if (c == CHANNEL_DASH && lines->factors[f].count > DASHES_MOST)
            return error_set(err, ERROR_INPUT,
                             "dash: \"%.60s\" has %zu values, at most %d dashes are distinct",
                             request->names[c], lines->factors[f].count, DASHES_MOST);
        give(lines, (enum plot_channel_type)c, f, taken);
    }
    return 0;
}

/* Returns whether lines of the same value of one factor have the same of another. */
static bool determines(const struct plot_lines *lines, const struct plot_factor *one,
                       const struct plot_factor *other) {
    for (size_t v = 0; v < one->count; v++) {
        struct plot_value first = {0};
        bool met = false;
        for (size_t n = 0; n < lines->count; n++) {
            struct plot_value own = factor_value(one, &lines->list[n]);
            struct plot_value value = factor_value(other, &lines->list[n]);
            if (!same_value(&own, &one->values[v]))
                continue;
            if (met && !same_value(&first, &value))
                return false;
            first = value;
            met = true;
        }
    }
    return true;
}

/* What goes with another factor, such as the kinematics with the model, needs no channel: of two
 * that go with each other the first one has it, or the one that has it by its name. */
static void skip_followers(const struct plot_lines *lines, bool taken[FACTORS_MOST]) {
    bool named[FACTORS_MOST];
    memcpy(named, taken, sizeof named);
    for (size_t f = 0; f < lines->factor_count; f++)
        for (size_t g = 0; g < lines->factor_count && !taken[f]; g++) {
            const struct plot_factor *own = &lines->factors[f], *other = &lines->factors[g];
            bool first = named[g] || g < f || !determines(lines, own, other);
            taken[f] = g != f && first && determines(lines, other, own);
        }
}

/* Returns the free factor that suits a channel best; factor_count where there is none. Colours are
 * for numbers of many values, dashes for words of few. */
static size_t best_for(const struct plot_lines *lines, enum plot_channel_type channel,
                       const bool taken[FACTORS_MOST]) {
    size_t best = lines->factor_count;
    for (size_t f = 0; f < lines->factor_count; f++) {
        const struct plot_factor *one = &lines->factors[f];
        const struct plot_factor *other = best < lines->factor_count ? &lines->factors[best] : NULL;
        if (taken[f] || (channel == CHANNEL_DASH && one->count > DASHES_MOST))
            continue;
        bool wanted = one->ordered == (channel == CHANNEL_COLOUR);
        bool other_wanted = other != NULL && other->ordered == (channel == CHANNEL_COLOUR);
        if (other == NULL || (wanted && !other_wanted) ||
            (wanted == other_wanted && one->count > other->count))
            best = f;
    }
    return best;
}

static void give_rest(struct plot_lines *lines, bool taken[FACTORS_MOST]) {
    static const enum plot_channel_type ORDER[] = {CHANNEL_COLOUR, CHANNEL_DASH};
    for (size_t c = 0; c < 2; c++) {
        size_t best = best_for(lines, ORDER[c], taken);
        if (lines->channels[ORDER[c]].factor_count == 0 && best < lines->factor_count)
            give(lines, ORDER[c], best, taken);
    }
    for (size_t f = 0; f < lines->factor_count; f++)
        if (!taken[f])
            give(lines, CHANNEL_PANEL, f, taken);
}

/* --- values of channels --- */

/* Numbers the combination of values that a line has in a channel: the last factor runs fastest. */
static size_t code_of(const struct plot_channel *channel, const struct plot_line *line) {
    size_t code = 0;
    for (size_t f = 0; f < channel->factor_count; f++) {
        const struct plot_factor *factor = channel->factors[f];
        struct plot_value value = factor_value(factor, line);
        size_t v = 0;
        while (v + 1 < factor->count && !same_value(&factor->values[v], &value))
            v++;
        code = code * factor->count + v;
    }
    return code;
}

/* Inserts a code among those that are met, which rise, and sets its index. Returns whether it is
 * new. */
static bool insert_code(size_t *codes, size_t count, size_t code, size_t *place) {
    size_t v = count;
    while (v > 0 && codes[v - 1] > code)
        v--;
    *place = v > 0 && codes[v - 1] == code ? v - 1 : v;
    if (*place < v)
        return false;
    memmove(codes + v + 1, codes + v, (count - v) * sizeof *codes);
    codes[v] = code;
    return true;
}

/* Numbers the combinations that there are, by rising code. */
static int number_values(struct plot_lines *lines, enum plot_channel_type type, struct error *err) {
    struct plot_channel *channel = &lines->channels[type];
    size_t *firsts = array_create(lines->count, sizeof *firsts), place;
    size_t *codes = array_create(lines->count, sizeof *codes);
    channel->lines = firsts;
    channel->ordered = channel->factor_count == 1 && channel->factors[0]->ordered;
    for (size_t n = 0; n < lines->count && firsts != NULL && codes != NULL; n++) {
        size_t code = code_of(channel, &lines->list[n]);
        lines->list[n].at[type] = code; /* until all are known */
        if (!insert_code(codes, channel->count, code, &place))
            continue;
        memmove(firsts + place + 1, firsts + place, (channel->count - place) * sizeof *firsts);
        firsts[place] = n;
        channel->count++;
    }
    for (size_t n = 0; n < lines->count && firsts != NULL && codes != NULL; n++) {
        (void)insert_code(codes, channel->count, lines->list[n].at[type], &place);
        lines->list[n].at[type] = place;
    }
    int status = firsts != NULL && codes != NULL
                     ? 0
                     : error_memory(err, lines->count * sizeof *codes, "values");
    free(codes);
    return status;
}

int plot_channels_set(struct plot_lines *lines, const struct lines_request *request,
                      struct error *err) {
    bool taken[FACTORS_MOST] = {false};
    int status = add_parameters(lines, request->left_out, err);
    if (status == 0)
        status = add_attributes(lines, request, err);
    if (status == 0)
        status = give_named(lines, request, taken, err);
    if (status == 0) {
        skip_followers(lines, taken);
        give_rest(lines, taken);
    }
    for (int c = 0; c < CHANNEL_COUNT && status == 0; c++)
        status = number_values(lines, (enum plot_channel_type)c, err);
    return status;
}

/* --- labels --- */

/* Returns what a series shows, where all lines of a value of a channel agree in it, or NULL. */
static const char *shown_series(const struct plot_lines *lines, enum plot_channel_type channel,
                                size_t v) {
    const struct result_view *view = view_of(lines->kind);
    const char *name = NULL;
    bool met = false;
    for (size_t n = 0; n < lines->count; n++) {
        const struct plot_line *line = &lines->list[n];
        if (line->at[channel] != v)
            continue;
        const char *own = view_series_name(view, line->one, line->curve->series);
        if (met && own != name)
            return NULL;
        name = own;
        met = true;
    }
    return name;
}

void channel_label(const struct plot_lines *lines, enum plot_channel_type channel, size_t v,
                   char *out, size_t size) {
    const struct plot_channel *own = &lines->channels[channel];
    const struct result_view *view = view_of(lines->kind);
    *out = '\0';
    for (size_t f = 0; f < own->factor_count; f++) {
        const struct plot_factor *factor = own->factors[f];
        struct plot_value value = factor_value(factor, &lines->list[own->lines[v]]);
        char text[96];
        const char *series =
            is_attribute(factor, "series") ? shown_series(lines, channel, v) : NULL;
        if (series != NULL)
            plot_in_words(series, text, sizeof text);
        else if (value.text != NULL && *value.text != '\0')
            plot_in_words(view_words(view, value.text), text, sizeof text);
        else if (is_attribute(factor, "series") && value.text != NULL)
            plot_in_words(view_words(view, lines->list[own->lines[v]].curve->quantity), text,
                          sizeof text);
        else if (value.text != NULL || isnan(value.number))
            snprintf(text, sizeof text, "no %.60s", factor_name(factor));
        else if (is_attribute(factor, "pressure"))
            snprintf(text, sizeof text, "at %.4g", value.number);
        else if (factor->attribute != NULL)
            snprintf(text, sizeof text, "%.30s %.4g", factor->attribute->key, value.number);
        else
            snprintf(text, sizeof text, "%.60s = %.5g", plot_symbol(lines->kind, factor->pointer),
                     value.number);
        word_list_append(out, size, ", ", text);
    }
}

void channel_name(const struct plot_lines *lines, enum plot_channel_type channel, char *out,
                  size_t size) {
    const struct plot_channel *own = &lines->channels[channel];
    *out = '\0';
    for (size_t f = 0; f < own->factor_count; f++)
        word_list_append(out, size, ", ",
                         own->factors[f]->attribute != NULL
                             ? own->factors[f]->attribute->key
                             : plot_symbol(lines->kind, own->factors[f]->pointer));
}
