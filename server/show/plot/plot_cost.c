#include "server/show/plot/plot_cost.h"
#include "server/show/plot/plot_pen.h"
#include "server/show/summary/report_series.h"
#include "server/show/summary/summary_cells.h"
#include <math.h>
#include <string.h>

enum { STEPS = 61, STYLE_SIZE = 128 };
/* A line ends where the statistical error is this part of the others, or after this many times what
 * the study took. */
static const double END_PART = 0.1, END_TIMES = 1e4;

/* A series as a law: the error after `cost` seconds is the root of the sum of squares of
 * deviation/sqrt(cost/realisation) and systematic. */
struct cost_law {
    const struct report_series *series;
    double realisation; /* CPU seconds */
    double deviation;   /* relative, of one realisation */
    double systematic;  /* relative: known errors but the statistical one */
    double spent;       /* CPU seconds a case, so far */
};

static double error_after(const struct cost_law *law, double cost) {
    return hypot(law->deviation * sqrt(law->realisation / cost), law->systematic);
}

/* Returns false where the series has no cost or no statistical error. */
static bool law_of(const struct report_series *series, struct cost_law *out) {
    double realisations = series->realisations / (double)series->cases;
    *out = (struct cost_law){.series = series,
                             .realisation = series->cpu_seconds / series->realisations,
                             .deviation = series_error(series, 0) * sqrt(realisations),
                             .spent = series->cpu_seconds / (double)series->cases};
    for (size_t s = 0; s < ERROR_SOURCES; s++) {
        double error = series_error(series, 1 + s);
        out->systematic += isnan(error) ? 0 : error;
    }
    return out->realisation > 0 && out->deviation > 0 && isfinite(out->deviation);
}

/* NaN where there is none. */
static double scalar_at(const struct case_report *one, const char *name) {
    for (size_t s = 0; s < one->scalar_count; s++)
        if (strcmp(one->scalars[s].name, name) == 0)
            return one->scalars[s].value;
    return (double)NAN;
}

/* Returns the case with the largest error reached of a study that asks for one; NULL of others. */
static const struct case_report *worst_of(const struct study_report *report) {
    const struct case_report *worst = NULL;
    double most = 0;
    for (size_t c = 0; c < report->case_count; c++) {
        double reached = scalar_at(&report->cases[c], "error_reached");
        if (isfinite(reached) && reached > most) {
            most = reached;
            worst = &report->cases[c];
        }
    }
    return worst;
}

/* Makes a law pass through the error reached, as all else that shows the study has it: at the
 * worst point, with the confidence asked for. */
static void meet_reached(struct cost_law *law, const struct case_report *worst) {
    double reached = scalar_at(worst, "error_reached"), chance = scalar_at(worst, "error_chance");
    if (!(chance > 0 && chance <= reached))
        return;
    law->deviation = chance * sqrt(law->spent / law->realisation);
    law->systematic = sqrt(reached * reached - chance * chance);
}

/* The law as a line in equal steps of the logarithm of cost. */
static void line_of(const struct cost_law *law, double x[STEPS], double y[STEPS]) {
    double end = law->realisation * pow(law->deviation / (END_PART * law->systematic), 2);
    end = fmax(fmin(end, END_TIMES * law->spent), 2 * law->spent);
    for (int k = 0; k < STEPS; k++) {
        x[k] = law->realisation * pow(end / law->realisation, (double)k / (STEPS - 1));
        y[k] = error_after(law, x[k]);
    }
}

/* The smallest error of all series after each cost. */
static void draw_front(struct plot_pen *pen, size_t count, const struct cost_law *laws) {
    static const char STYLE[] = "fill=\"none\" stroke=\"#bbb\" stroke-width=\"7\" "
                                "stroke-opacity=\".6\" stroke-linejoin=\"round\"";
    double x[STEPS], y[STEPS], low = INFINITY, high = 0;
    for (size_t a = 0; a < count; a++) {
        double line[STEPS], errors[STEPS];
        line_of(&laws[a], line, errors);
        low = fmin(low, line[0]);
        high = fmax(high, line[STEPS - 1]);
    }
    for (int k = 0; k < STEPS; k++) {
        x[k] = low * pow(high / low, (double)k / (STEPS - 1));
        y[k] = INFINITY;
        for (size_t a = 0; a < count; a++)
            if (x[k] >= laws[a].realisation * (1 - 1e-12))
                y[k] = fmin(y[k], error_after(&laws[a], x[k]));
    }
    pen_line(pen, STEPS, x, y, STYLE);
    pen_legend(pen, "least error for the cost", STYLE);
}

static void label_of(const struct curve *place, char label[PLOT_LABEL_SIZE]) {
    char model[64];
    model_text(place->model, place->kinematics, model, sizeof model);
    size_t used = (size_t)snprintf(label, PLOT_LABEL_SIZE, "%.60s", model);
    if (!isnan(place->level))
        used +=
            (size_t)snprintf(label + used, PLOT_LABEL_SIZE - used, ", level %.4g", place->level);
    if (place->series != NULL && *place->series != '\0')
        snprintf(label + used, PLOT_LABEL_SIZE - used, ", %.60s", place->series);
}

static void draw_law(struct plot_pen *pen, const struct cost_law *law, size_t colour) {
    double x[STEPS], y[STEPS], error = error_after(law, law->spent);
    char style[STYLE_SIZE], label[PLOT_LABEL_SIZE];
    snprintf(style, sizeof style, "class=\"curve\" stroke=\"%s\" stroke-width=\"1.8\"",
             PEN_COLOURS[colour]);
    line_of(law, x, y);
    pen_line(pen, STEPS, x, y, style);
    if (pen_reaches(pen, law->spent, error))
        fprintf(pen->file, "<circle cx=\"%.2f\" cy=\"%.2f\" r=\"4\" fill=\"%s\"/>\n",
                frame_x(&pen->frame, law->spent), frame_y(&pen->frame, error), PEN_COLOURS[colour]);
    label_of(law->series->place, label);
    pen_legend(pen, label, style);
}

/* Names the sources of error that bear on a main curve, and of which nothing is known. */
static void note_unknown(struct plot_pen *pen, const struct study_report *report) {
    char text[PLOT_LABEL_SIZE] = "not known: ";
    size_t listed = 0;
    for (enum error_source s = 0; s < ERROR_SOURCES; s++) {
        bool unknown = false;
        for (size_t c = 0; c < report->case_count; c++) {
            const struct curve_report *main = report->cases[c].main;
            unknown = unknown || (main != NULL && main->applies[s] && isnan(main->errors[s]));
        }
        if (unknown && listed++ > 0)
            strncat(text, ", ", sizeof text - strlen(text) - 1);
        if (unknown)
            strncat(text, ERROR_SOURCE_ROWS[s].name, sizeof text - strlen(text) - 1);
    }
    if (listed > 0)
        pen_note(pen, text);
}

/* The laws that the picture shows: those of the estimator that comes first, since others read the
 * same solves, and at most as many as there are colours. */
static size_t choose_laws(const struct series_list *list, struct cost_law laws[PLOT_LINES]) {
    size_t count = 0;
    for (size_t s = 0; s < list->count && count < PLOT_LINES; s++)
        if (same_text(list->rows[s].place->series, list->rows[0].place->series) &&
            law_of(&list->rows[s], &laws[count]))
            count++;
    return count;
}

static void draw(struct plot_pen *pen, const struct study_report *report, size_t count,
                 const struct cost_law *laws) {
    frame_start(&pen->frame, true, true);
    for (size_t a = 0; a < count; a++) {
        double x[STEPS], y[STEPS];
        line_of(&laws[a], x, y);
        frame_include(&pen->frame, STEPS, x, y);
    }
    if (!frame_finish(&pen->frame))
        return;
    frame_draw(pen->file, &pen->frame, "CPU time a case (s)",
               worst_of(report) != NULL ? "largest relative error" : "relative error");
    draw_front(pen, count, laws);
    for (size_t a = 0; a < count; a++)
        draw_law(pen, &laws[a], a);
    pen_note(pen, "circles: this study");
    note_unknown(pen, report);
}

int plot_cost(const struct study_report *report, FILE *file, struct error *err) {
    struct plot_pen pen = {.file = file};
    struct series_list list = {0};
    struct cost_law laws[PLOT_LINES];
    char subject[PLOT_LABEL_SIZE] = "";
    for (size_t c = 0; c < report->case_count; c++) {
        const struct curve_report *main = report->cases[c].main;
        series_add_case(&list, &report->cases[c]);
        if (*subject == '\0' && main != NULL) {
            char quantity[61];
            plot_in_words(main->place.quantity, quantity, sizeof quantity);
            snprintf(subject, sizeof subject, "error of %s by cost", quantity);
        }
    }
    size_t count = choose_laws(&list, laws);
    const struct case_report *worst = worst_of(report);
    for (size_t a = 0; a < count && worst != NULL; a++)
        if (isnan(laws[a].series->place->level))
            meet_reached(&laws[a], worst);
    if (count == 0)
        return error_set(err, ERROR_ABSENT,
                         "study %s has no model whose cost and error are known yet", report->id);
    pen_head(&pen, PEN_WIDTH + 80);
    pen_study(&pen, &(const struct study_result){.id = report->id,
                                                 .name = report->name,
                                                 .kind = report->kind,
                                                 .state = report->state,
                                                 .random = report->random,
                                                 .swept = report->swept,
                                                 .provenance = report->provenance});
    pen_title(&pen, report->name, subject);
    draw(&pen, report, count, laws);
    fputs("</svg>\n", file);
    return 0;
}
