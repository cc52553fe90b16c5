#include "server/show/plot/plot_density.h"
#include "server/show/plot/plot_heat.h"
#include "server/show/plot/plot_layout.h"
#include "server/show/plot/plot_style.h"
#include "server/show/quantity.h"
#include "server/show/view.h"
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
    struct legend legend;
};

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

/* The matrix and its theories have one scale, up to the highest of all; but a theory that is
 * singular somewhere leaves the matrix its colours. */
static struct heat_scale scale_of(const struct density *density) {
    static const double MOST = 2; /* of the highest value of the matrix */
    size_t cells = density->x.count * density->y.count;
    double own = highest_of(density->coarse, cells);
    double all = highest_of(density->coarse, cells * (1 + density->curve->theory_count));
    return heat_scale_of_density(own > 0 ? fmin(all, MOST * own) : all);
}

/* Joins the bins of the sides, of the matrix and of each theory. */
static int join_all(struct density *density, struct error *err) {
    size_t theories = density->curve->theory_count, cells = density->x.count * density->y.count;
    free(density->coarse);
    density->coarse = array_create(cells * (1 + theories), sizeof *density->coarse);
    if (density->coarse == NULL)
        return error_memory(err, cells * sizeof *density->coarse, "a density");
    join_bins(density, density->fine, density->coarse);
    for (size_t t = 0; t < theories; t++)
        if (theory_of(density, t) != NULL)
            join_bins(density, theory_of(density, t), density->coarse + (1 + t) * cells);
    return 0;
}

/* Narrows a side to cells first to last and one more at either end, as far as there are bins. */
static struct side narrowed(const struct side *side, size_t first, size_t last, size_t bins) {
    size_t low = first > 0 ? first - 1 : 0, high = last + 2;
    size_t end = side->first + high * side->step;
    return side_of(side->first + low * side->step, (end < bins ? end : bins) - 1);
}

/* Narrows the sides to the cells that have a colour or a contour: few summits far from the others
 * would leave most of the picture blank. */
static void narrow(struct density *density) {
    size_t nx = density->x.count, cells = nx * density->y.count;
    size_t low[2] = {SIZE_MAX, SIZE_MAX}, high[2] = {0, 0};
    double least = scale_of(density).bounds[0];
    for (size_t n = 0; n < cells * (1 + density->curve->theory_count); n++) {
        const size_t place[2] = {n % cells % nx, n % cells / nx};
        for (int a = 0; a < 2 && density->coarse[n] >= least; a++) {
            low[a] = place[a] < low[a] ? place[a] : low[a];
            high[a] = place[a] > high[a] ? place[a] : high[a];
        }
    }
    if (low[0] > high[0])
        return;
    density->x = narrowed(&density->x, low[0], high[0], density->curve->n);
    density->y = narrowed(&density->y, low[1], high[1], density->curve->columns);
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
    int status = join_all(density, err);
    if (status != 0)
        return status;
    narrow(density);
    return join_all(density, err);
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

/* A stroke of the legend, or of the contours themselves. */
static void theory_style(size_t t, char style[LEGEND_STYLE_SIZE]) {
    snprintf(style, LEGEND_STYLE_SIZE, "class=\"theory\" stroke=\"%s\" stroke-linecap=\"round\"",
             STROKES[t % STROKE_COUNT]);
}

static void draw_theories(struct density *density, const struct heat_scale *scale) {
    for (size_t t = 0; t < density->curve->theory_count; t++) {
        char style[LEGEND_STYLE_SIZE];
        struct heat_cells cells = cells_of(density, 1 + t);
        if (theory_of(density, t) == NULL)
            continue;
        theory_style(t, style);
        heat_contours(&density->pen, &cells, scale, style);
    }
}

static void name_theories(struct density *density, const struct result_view *view) {
    for (size_t t = 0; t < density->curve->theory_count; t++) {
        char style[LEGEND_STYLE_SIZE], label[PLOT_LABEL_SIZE], name[81];
        if (theory_of(density, t) == NULL)
            continue;
        theory_style(t, style);
        plot_in_words(view_words(view, density->curve->theories[t].name), name, sizeof name);
        snprintf(label, sizeof label, "theory: %s", name);
        legend_add(&density->legend, label, style);
    }
}

/* Names the levels, the highest first, below what they are of. */
static void name_levels(struct legend *legend, const struct heat_scale *scale,
                        const char *heading) {
    legend_add(legend, heading, "");
    for (size_t level = scale->count; level > 0; level--) {
        char style[HEAT_STYLE_SIZE], label[HEAT_LABEL_SIZE];
        heat_level(scale, level - 1, style, label);
        legend_add(legend, label, style);
    }
}

/* Notes what one of an axis is in its physical unit. */
static void note_unit(struct legend *legend, const char *label, const struct physical_unit *unit) {
    char text[PLOT_LABEL_SIZE];
    if (unit->unit == NULL)
        return;
    unit_note(label, unit->symbol, unit->unit, unit->scale, text, sizeof text);
    legend_add(legend, text, "");
}

static void fill_legend(struct density *density, const struct study_result *study,
                        const struct case_result *one, const struct heat_scale *scale) {
    const struct curve *curve = density->curve;
    name_levels(&density->legend, scale, curve->y_label);
    name_theories(density, view_of(study->kind));
    plot_legend_case(&density->legend, study, one);
    note_unit(&density->legend, curve->x_label, &curve->x_unit);
    note_unit(&density->legend, curve->x2_label, &curve->x2_unit);
}

/* Writes "summit joint PDF, pits, case 1". */
static void make_subject(const struct study_result *study, const struct case_result *one,
                         const struct curve *curve, char subject[PLOT_LABEL_SIZE]) {
    const struct result_view *view = view_of(study->kind);
    bool serial = curve->series != NULL && *curve->series != '\0';
    char quantity[41], series[41];
    plot_in_words(view_words(view, curve->quantity), quantity, sizeof quantity);
    plot_in_words(serial ? view_words(view, curve->series) : "", series, sizeof series);
    snprintf(subject, PLOT_LABEL_SIZE, "%s%s%s, case %llu", quantity, serial ? ", " : "", series,
             (unsigned long long)one->case_number);
}

static void draw(struct density *density, const struct study_result *study,
                 const struct case_result *one, double millimetres) {
    struct plot_pen *pen = &density->pen;
    const struct curve *curve = density->curve;
    const struct result_view *view = view_of(study->kind);
    const struct heat_scale scale = scale_of(density);
    struct heat_cells cells = cells_of(density, 0);
    struct plot_layout layout = {0};
    char subject[PLOT_LABEL_SIZE];
    make_subject(study, one, curve, subject);
    fill_legend(density, study, one, &scale);
    plot_lay_out(&layout, 1, 1, &density->legend, millimetres);
    frame_set(&pen->frame, cells.x, cells.y, false);
    plot_place(&layout, 0, &pen->frame);
    pen_head_sized(pen, &layout.size);
    pen_study(pen, study);
    (millimetres > 0 ? pen_subject : pen_title)(pen, study->name, subject);
    heat_draw(pen, &cells, &scale);
    frame_draw(pen->file, &pen->frame, view_label(view, curve->x_label),
               view_label(view, curve->x2_label));
    draw_theories(density, &scale);
    legend_draw(&density->legend, pen->file, layout.scale, layout.legend_left, layout.legend_top,
                layout.legend_width);
    fputs("</svg>\n", pen->file);
}

int plot_density(const struct study_result *study, const struct case_result *one,
                 const struct curve *curve, double millimetres, FILE *file, struct error *err) {
    struct density *density = calloc(1, sizeof *density);
    if (density == NULL)
        return error_memory(err, sizeof *density, "a picture");
    density->curve = curve;
    density->pen.file = file;
    int status = fill(density, err);
    if (status == 0)
        draw(density, study, one, millimetres);
    free(density->fine);
    free(density->coarse);
    free(density);
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
