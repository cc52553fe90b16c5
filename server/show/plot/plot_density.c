#include "server/show/plot/plot_density.h"
#include "server/show/plot/plot_heat.h"
#include "server/show/quantity.h"
#include "server/show/table/shown_cases.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { CELLS_A_SIDE = 45 };
/* What is less than this part of the highest value, of the matrix and of each theory, need not be
 * seen. */
static const double SEEN_PART = 0.01;

/* Theories differ by colour: their contours are many short strokes, which dashes would break. */
static const char *const STROKES[] = {"#000", "#d55e00", "#009e73", "#cc79a7"};
enum { STROKE_COUNT = sizeof STROKES / sizeof *STROKES };

/* Bins from first, in groups of `step`, `count` of them. */
struct side {
    size_t first, step, count;
};
struct density {
    const struct curve *curve;
    struct side x, y; /* rows of the matrix lie along x, columns along y */
    double *fine;     /* owned: the matrix with its empty cells */
    double *coarse;   /* owned: groups of it and of each theory, x.count * y.count values each */
    struct plot_pen pen;
};

static void density_clear(struct density *density) {
    free(density->fine);
    free(density->coarse);
}

/* --- what is drawn --- */

static double highest_of(const double *values, size_t count) {
    double highest = 0;
    for (size_t n = 0; n < count; n++)
        highest = fmax(highest, isfinite(values[n]) ? values[n] : 0);
    return highest;
}

static const double *theory_of(const struct density *density, size_t t) {
    return density->curve->theories[t].y;
}

/* Returns whether a cell of the matrix must be seen; least: for it and for its theories. */
static bool is_seen(const struct density *density, const double *least, size_t cell) {
    bool seen = density->fine[cell] > least[0];
    for (size_t t = 0; t < density->curve->theory_count; t++)
        seen =
            seen || (theory_of(density, t) != NULL && theory_of(density, t)[cell] > least[1 + t]);
    return seen;
}

static struct side side_of(size_t low, size_t high) {
    size_t bins = high - low + 1, step = (bins + CELLS_A_SIDE - 1) / CELLS_A_SIDE;
    return (struct side){low, step, (bins + step - 1) / step};
}

/* Finds the part of the matrix that holds all that must be seen; false where that is nothing. */
static bool find_sides(struct density *density) {
    const struct curve *curve = density->curve;
    size_t low[2] = {curve->n, curve->columns}, high[2] = {0, 0};
    size_t all = curve->n * curve->columns;
    double least[1 + THEORIES_MOST] = {SEEN_PART * highest_of(density->fine, all)};
    for (size_t t = 0; t < curve->theory_count; t++)
        if (theory_of(density, t) != NULL)
            least[1 + t] = SEEN_PART * highest_of(theory_of(density, t), all);
    for (size_t cell = 0; cell < all; cell++) {
        const size_t place[2] = {cell / curve->columns, cell % curve->columns};
        if (!is_seen(density, least, cell))
            continue;
        for (int a = 0; a < 2; a++) {
            low[a] = place[a] < low[a] ? place[a] : low[a];
            high[a] = place[a] > high[a] ? place[a] : high[a];
        }
    }
    if (low[0] > high[0] || low[0] == curve->n)
        return false;
    density->x = side_of(low[0], high[0]);
    density->y = side_of(low[1], high[1]);
    return true;
}

/* The mean over the bins of a group; bins beyond the matrix are empty. */
static double mean_of(const struct density *density, const double *matrix, size_t i, size_t j) {
    const struct curve *curve = density->curve;
    const struct side *x = &density->x, *y = &density->y;
    double sum = 0;
    for (size_t a = 0; a < x->step; a++)
        for (size_t b = 0; b < y->step; b++) {
            size_t row = x->first + i * x->step + a, column = y->first + j * y->step + b;
            if (row < curve->n && column < curve->columns)
                sum += matrix[row * curve->columns + column];
        }
    return sum / (double)(x->step * y->step);
}

static void join_bins(const struct density *density, const double *matrix, double *out) {
    for (size_t j = 0; j < density->y.count; j++)
        for (size_t i = 0; i < density->x.count; i++)
            out[j * density->x.count + i] = mean_of(density, matrix, i, j);
}

/* Fills the dense matrix and the joined bins. */
static int fill(struct density *density, struct error *err) {
    const struct curve *curve = density->curve;
    size_t all = curve->n * curve->columns;
    density->fine = array_create(all, sizeof *density->fine);
    if (density->fine == NULL)
        return error_memory(err, all * sizeof *density->fine, "a density");
    for (size_t cell = 0; cell < all; cell++)
        density->fine[cell] = isnan(curve->empty_y) ? 0 : curve->empty_y;
    for (size_t n = 0; n < curve->cell_count; n++)
        density->fine[curve->cells[n]] = curve->y[n];
    if (!find_sides(density))
        return error_set(err, ERROR_ABSENT, "\"%.60s\" has no values yet", curve->quantity);
    size_t cells = density->x.count * density->y.count;
    density->coarse = array_create(cells * (1 + curve->theory_count), sizeof *density->coarse);
    if (density->coarse == NULL)
        return error_memory(err, cells * sizeof *density->coarse, "a density");
    join_bins(density, density->fine, density->coarse);
    for (size_t t = 0; t < curve->theory_count; t++)
        if (theory_of(density, t) != NULL)
            join_bins(density, theory_of(density, t), density->coarse + (1 + t) * cells);
    return 0;
}

/* --- the picture --- */

/* Ends of a side: those of its first and last bins, whose centres are even. */
static void ends_of(const struct side *side, const double *centres, size_t n, double ends[2]) {
    double width = n > 1 ? (centres[n - 1] - centres[0]) / (double)(n - 1) : 1;
    ends[0] = centres[0] + ((double)side->first - 0.5) * width;
    ends[1] = ends[0] + (double)(side->step * side->count) * width;
}

static struct heat_cells cells_of(const struct density *density, size_t which) {
    const struct curve *curve = density->curve;
    struct heat_cells cells = {.nx = density->x.count, .ny = density->y.count};
    ends_of(&density->x, curve->x, curve->n, cells.x);
    ends_of(&density->y, curve->x2, curve->columns, cells.y);
    cells.values = density->coarse + which * cells.nx * cells.ny;
    return cells;
}

/* The matrix and its theories have one scale, up to the highest of all. */
static struct heat_scale scale_of(const struct density *density) {
    size_t cells = density->x.count * density->y.count;
    return heat_scale_of_density(
        highest_of(density->coarse, cells * (1 + density->curve->theory_count)));
}

static void draw_theories(struct density *density, const struct heat_scale *scale) {
    for (size_t t = 0; t < density->curve->theory_count; t++) {
        char style[96], label[PLOT_LABEL_SIZE], name[81];
        struct heat_cells cells = cells_of(density, 1 + t);
        if (theory_of(density, t) == NULL)
            continue;
        snprintf(style, sizeof style, "class=\"theory\" stroke=\"%s\" stroke-linecap=\"round\"",
                 STROKES[t % STROKE_COUNT]);
        plot_in_words(density->curve->theories[t].name, name, sizeof name);
        snprintf(label, sizeof label, "theory: %s", name);
        heat_contours(&density->pen, &cells, scale, style);
        pen_legend(&density->pen, label, style);
    }
}

/* Notes what distinguishes the case from the others of the study, a line each. */
static void note_case(struct plot_pen *pen, const struct study_result *study,
                      const struct case_result *one) {
    struct shown_cases shown;
    char text[PLOT_LABEL_SIZE];
    if (!shown_of_results(study, &shown))
        return;
    for (size_t n = 0; n < shown.varied_count; n++) {
        const struct result_parameter *value = result_parameter(one, shown.varied[n]);
        if (value == NULL)
            continue;
        char name[61], word[61];
        plot_in_words(last_name(value->pointer), name, sizeof name);
        plot_in_words(value->text != NULL ? value->text : "", word, sizeof word);
        if (value->text != NULL)
            snprintf(text, sizeof text, "%s: %s", name, word);
        else
            snprintf(text, sizeof text, "%s: %.5g", name, value->number);
        pen_note(pen, text);
    }
    shown_clear(&shown);
}

/* Notes what one of an axis is in its physical unit. */
static void note_unit(struct plot_pen *pen, const char *label, const struct physical_unit *unit) {
    char text[PLOT_LABEL_SIZE];
    if (unit->unit == NULL)
        return;
    unit_note(label, unit->symbol, unit->unit, unit->scale, text, sizeof text);
    pen_note(pen, text);
}

static void draw(struct density *density, const struct study_result *study,
                 const struct case_result *one) {
    struct plot_pen *pen = &density->pen;
    const struct curve *curve = density->curve;
    const struct heat_scale scale = scale_of(density);
    struct heat_cells cells = cells_of(density, 0);
    char subject[PLOT_LABEL_SIZE], quantity[41];
    bool serial = curve->series != NULL && *curve->series != '\0';
    plot_in_words(curve->quantity, quantity, sizeof quantity);
    snprintf(subject, sizeof subject, "%s%s%.16s, case %llu", quantity, serial ? ", " : "",
             serial ? curve->series : "", (unsigned long long)one->case_number);
    frame_set(&pen->frame, cells.x, cells.y, false);
    pen_head(pen, PEN_WIDTH);
    pen_study(pen, study);
    pen_title(pen, study->name, subject);
    heat_draw(pen, &cells, &scale);
    frame_draw(pen->file, &pen->frame, curve->x_label, curve->x2_label);
    heat_legend(pen, &scale, curve->y_label);
    draw_theories(density, &scale);
    note_case(pen, study, one);
    note_unit(pen, curve->x_label, &curve->x_unit);
    note_unit(pen, curve->x2_label, &curve->x2_unit);
    fputs("</svg>\n", pen->file);
}

int plot_density(const struct study_result *study, const struct case_result *one,
                 const struct curve *curve, FILE *file, struct error *err) {
    struct density density = {.curve = curve, .pen = {.file = file}};
    int status = fill(&density, err);
    if (status == 0)
        draw(&density, study, one);
    density_clear(&density);
    return status;
}

int density_curve(const struct case_result *one, const char *quantity, const char *series,
                  const struct curve **out, struct error *err) {
    char words[160] = "";
    *out = NULL;
    for (size_t a = 0; a < one->curve_count; a++) {
        const struct curve *curve = &one->curves[a];
        if (curve->columns == 0 || strcmp(curve->quantity, quantity) != 0)
            continue;
        const char *own = curve->series != NULL ? curve->series : "";
        if (series == NULL || strcmp(own, series) == 0) {
            *out = curve;
            return 0;
        }
        size_t used = strlen(words);
        snprintf(words + used, sizeof words - used, "%s\"%.40s\"", used > 0 ? ", " : "", own);
    }
    if (*words == '\0')
        return 0;
    return error_set(err, ERROR_INPUT, "%.60s has no series \"%.60s\"; allowed: %s", quantity,
                     series, words);
}
