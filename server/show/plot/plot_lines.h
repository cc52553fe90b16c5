/* The lines of one picture, and what distinguishes them from each other.
 *
 * A factor is whatever differs between the lines: a parameter of their cases, the model, the
 * series, the pressure, the level. Each factor goes into one channel: the panel that a line stands
 * in, its colour, or its dashes. A request names factors for channels; the rest are given away:
 * colour to the number with most values, dashes to words of few values, panels to what is left.
 * Levels that nobody asked for are fainter the coarser they are, and take no channel. */
#ifndef RUGO_SERVER_SHOW_PLOT_PLOT_LINES_H
#define RUGO_SERVER_SHOW_PLOT_PLOT_LINES_H

#include "server/show/plot/plot_pen.h"

enum plot_channel_type { CHANNEL_PANEL, CHANNEL_COLOUR, CHANNEL_DASH, CHANNEL_COUNT };
enum { FACTORS_MOST = 24, DASHES_MOST = 6, PANELS_MOST = 12 };

/* Which curves of a quantity are wanted, and what their channels show. */
struct lines_request {
    const char *quantity;
    const char *y_label;              /* of curves in one unit; NULL: that of the first */
    const char *model;                /* this one alone; NULL: all */
    const char *series;               /* likewise */
    const char *level;                /* likewise, a number */
    const char *names[CHANNEL_COUNT]; /* of factors, "hurst" or "model"; NULL: chosen */
    const char *left_out; /* pointer of a parameter that is no factor, an x axis; NULL: none */
};

struct plot_line { /* borrows */
    const struct case_result *one;
    const struct curve *curve;
    size_t coarseness; /* levels of the series above this one: 0 for the finest */
    size_t at[CHANNEL_COUNT];
};
struct plot_value {   /* of a factor; borrows */
    const char *text; /* NULL: the number */
    double number;    /* NaN with a text of NULL: the line has none */
};
struct plot_factor {
    const char *pointer;                     /* of a parameter; NULL: an attribute */
    const struct curve_attribute *attribute; /* NULL: a parameter */
    size_t count;
    struct plot_value *values; /* owned; numbers rise, words as they are met */
    bool ordered;              /* all of them are numbers */
};
struct plot_channel {
    size_t factor_count;
    const struct plot_factor *factors[FACTORS_MOST];
    size_t count;  /* combinations of their values that there are; at least 1 */
    size_t *lines; /* the first line of each; owned */
    bool ordered;  /* one factor of numbers */
};
struct plot_lines {
    const char *kind; /* borrowed; may be NULL */
    size_t count;
    struct plot_line *list; /* owned */
    size_t factor_count;
    struct plot_factor factors[FACTORS_MOST];
    struct plot_channel channels[CHANNEL_COUNT];
    char narrowed[PLOT_LABEL_SIZE]; /* what is shown of more: "finest level"; "" for everything */
};

/* Takes curves of a study that the request wants, matrices left out. Where they are more than
 * PLOT_LINES they narrow, as far as needed, to estimates without their brackets, to the finest
 * level, to the first series, to the first model, unless a channel or the request names these.
 * Initialise with {0}; after a failure nothing is left to clear. ERROR_ABSENT where no case has the
 * quantity, ERROR_INPUT for a model, series, level or factor that there is not. */
int plot_lines_choose(struct plot_lines *lines, const struct study_result *study,
                      const struct lines_request *request, struct error *err);
/* Takes all curves of these lines, one and curve of each set, as they are. Takes over the list. */
int plot_lines_take(struct plot_lines *lines, const char *kind, struct plot_line *list,
                    size_t count, const struct lines_request *request, struct error *err);
void plot_lines_clear(struct plot_lines *lines);

/* Writes value number v of a channel for svg_label: "H = 0.8", "weibull min, layered". */
void channel_label(const struct plot_lines *lines, enum plot_channel_type channel, size_t v,
                   char *out, size_t size);
/* Writes the names of the factors of a channel: "H", "distribution". */
void channel_name(const struct plot_lines *lines, enum plot_channel_type channel, char *out,
                  size_t size);

/* What the files of the lines share. */
/* Sets `at` of all lines, and the channels. */
int plot_channels_set(struct plot_lines *lines, const struct lines_request *request,
                      struct error *err);
struct plot_value factor_value(const struct plot_factor *factor, const struct plot_line *line);

/* What a picture of lines says beside them. */
struct plot_words {
    const char *subject; /* of the title */
    const char *x, *y;   /* labels of the axes */
    const char *y_bare;  /* that of y where a small picture has no room for words; NULL: the same */
    const char *note;    /* in the legend; NULL: none */
    const struct case_result *one; /* what it has of what was swept is noted; NULL: no case's */
    bool points;                   /* x is of a few cases: each has a tick and a mark */
};

#endif
