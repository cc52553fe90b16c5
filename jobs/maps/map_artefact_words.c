#include "jobs/maps/map_artefact_words.h"
#include "core/map/length_unit.h"
#include <math.h>
#include <stdarg.h>
#include <stdio.h>

enum { TEXT_SIZE = 80 };

struct sentences {
    char (*out)[ARTEFACT_SENTENCE_SIZE];
    size_t count;
    const char *z_unit;
};

__attribute__((format(printf, 2, 3))) static void say(struct sentences *sentences,
                                                      const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(sentences->out[sentences->count++], ARTEFACT_SENTENCE_SIZE, format, arguments);
    va_end(arguments);
}

static const char *height_text(const struct sentences *sentences, double height,
                               char text[TEXT_SIZE]) {
    double one = 1;
    const char *unit = length_unit_is_metre(sentences->z_unit) ? length_unit_readable(height, &one)
                                                               : sentences->z_unit;
    snprintf(text, TEXT_SIZE, "%.3g%s%s", height / one, *unit != '\0' ? " " : "", unit);
    return text;
}

/* Says what something does to slopes, or, where these hardly change, to curvatures. */
static const char *effect_text(double slope, double share, char text[TEXT_SIZE]) {
    static const double SEEN = 0.005;
    const double times = 1 / slope;
    if (!isfinite(times))
        snprintf(text, TEXT_SIZE, "make all of the RMS slope");
    else if (times > 2)
        snprintf(text, TEXT_SIZE, "make the RMS slope about %.2g times as large", times);
    else if (times - 1 > SEEN)
        snprintf(text, TEXT_SIZE, "make the RMS slope about %.2g %% larger", 100 * (times - 1));
    else
        snprintf(text, TEXT_SIZE, "have %.2g %% of the mean square curvature", 100 * share);
    return text;
}

static void say_steps(struct sentences *sentences, const struct height_steps *steps) {
    char step[TEXT_SIZE], effect[TEXT_SIZE];
    height_text(sentences, steps->step, step);
    if (isnan(steps->slope))
        say(sentences,
            "Steps: heights are multiples of %s, of which the map has few: its slopes are those of "
            "the steps, and no option gives others.",
            step);
    else
        say(sentences, "Steps: heights are multiples of %s, which %s. --denoise takes them out.",
            step, effect_text(steps->slope, steps->curvature, effect));
}

static void say_spikes(struct sentences *sentences, const struct map_spikes *spikes) {
    char effect[TEXT_SIZE];
    say(sentences, "Spikes: %zu, up to %.3g robust deviations off; they %s: --despike --fill.",
        spikes->count, spikes->largest, effect_text(spikes->slope, spikes->curvature, effect));
}

static void say_lines(struct sentences *sentences, const struct line_offsets *lines,
                      enum scan_axis along, bool spiky) {
    static const double LEAST = 1e-20;
    const bool along_x = along == SCAN_ALONG_X;
    char rms[TEXT_SIZE], effect[TEXT_SIZE], p_value[TEXT_SIZE];
    snprintf(p_value, sizeof p_value, lines->p_value < LEAST ? "below %.0e" : "%.1g",
             fmax(lines->p_value, LEAST));
    say(sentences, "Lines: along %s, offsets of RMS %s (p-value %s) %s: --lines %s%s.",
        along_x ? "x" : "y", height_text(sentences, lines->rms, rms), p_value,
        effect_text(lines->slope, lines->curvature, effect), spiky ? "median" : "mean",
        along_x ? "" : " --lines-along y");
}

/* Writes the options that leave the others alone; "" where there are none. */
static const char *stride_text(const struct repeated_lines *columns, int axis, bool profile,
                               char text[TEXT_SIZE]) {
    const char *stride = profile ? "2" : axis == 0 ? "2,1" : "1,2";
    *text = '\0';
    if (columns->every_second)
        snprintf(text, TEXT_SIZE, "; --stride %s%s leaves them out", stride,
                 columns->measured == 0 ? "" : ", after --crop has taken the first,");
    return text;
}

static void say_columns(struct sentences *sentences, const struct repeated_lines *columns, int axis,
                        bool profile) {
    const char *what = profile ? "Points" : axis == 0 ? "Columns" : "Rows";
    const char *which = columns->between == 0 ? "repeat their neighbours"
                        : columns->copies == 0
                            ? "are on a line between their neighbours"
                            : "repeat their neighbours or are on a line between them";
    char stride[TEXT_SIZE];
    say(sentences, "%s: %zu of %zu %s, and hold nothing of their own%s.", what,
        columns->copies + columns->between, columns->lines, which,
        stride_text(columns, axis, profile, stride));
}

size_t map_artefact_sentences(char out[ARTEFACT_SENTENCES_MOST][ARTEFACT_SENTENCE_SIZE],
                              const struct map_artefacts *artefacts, const struct grid *grid,
                              const char *z_unit, bool counted) {
    struct sentences sentences = {out, 0, z_unit};
    const bool profile = grid_is_profile(grid);
    if (map_steps_found(artefacts))
        say_steps(&sentences, &artefacts->steps);
    if (counted ? map_spikes_count(artefacts) : map_spikes_found(artefacts))
        say_spikes(&sentences, &artefacts->spikes);
    if (artefacts->lines.found)
        say_lines(&sentences, &artefacts->lines, artefacts->lines_along,
                  map_spikes_found(artefacts));
    for (int axis = 0; axis < 2; axis++) {
        const bool counts = map_columns_count(artefacts, axis);
        if (counted ? counts : map_columns_found(artefacts, axis))
            say_columns(&sentences, &artefacts->columns[axis], axis, profile);
    }
    return sentences.count;
}

void map_artefact_names(char out[ARTEFACT_NAMES_SIZE], const struct map_artefacts *artefacts) {
    const struct {
        const char *name;
        bool counts;
    } list[] = {{"height steps", map_steps_found(artefacts)},
                {"spikes", map_spikes_count(artefacts)},
                {"scan lines", artefacts->lines.found},
                {"columns", map_columns_count(artefacts, 0)},
                {"rows", map_columns_count(artefacts, 1)}};
    size_t used = 0;
    *out = '\0';
    for (size_t n = 0; n < sizeof list / sizeof *list; n++)
        if (list[n].counts)
            used += (size_t)snprintf(out + used, ARTEFACT_NAMES_SIZE - used, "%s%s",
                                     used > 0 ? ", " : "", list[n].name);
}
