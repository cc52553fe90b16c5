/* The distribution of heights on the page, with the normal one and the one that fits best. */
#include "core/surface/heights.h"
#include "server/show/map_figure.h"
#include "server/show/map_figure_internal.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Counts heights into even bins between their ends; what is drawn are densities. */
static int count_heights(struct figure_page *page, struct figure_points *out, struct error *err) {
    const struct measured_map *map = &page->map;
    size_t points = grid_points(map->grid), count = 0;
    double low = INFINITY, high = -INFINITY, unit = page->units.z;
    for (size_t n = 0; n < points; n++) {
        low = fmin(low, map->z[n]);
        high = fmax(high, map->z[n]);
        count += isnan(map->z[n]) ? 0 : 1;
    }
    double wanted = fmin(80, fmax(12, 2 * cbrt((double)count)));
    size_t bins = low < high ? (size_t)wanted : 0;
    int status = figure_points_create(out, bins, err);
    if (status != 0)
        return status;
    double width = bins > 0 ? (high - low) / (double)bins : 1;
    for (size_t b = 0; b < bins; b++)
        out->x[b] = (low + ((double)b + 0.5) * width) / unit;
    for (size_t n = 0; n < points && bins > 0; n++)
        if (!isnan(map->z[n]))
            out->y[(size_t)fmin((double)bins - 1, (map->z[n] - low) / width)] += 1;
    for (size_t b = 0; b < bins; b++)
        out->y[b] *= unit / (width * (double)count);
    return 0;
}

static void draw_steps(const struct figure_page *page, const struct figure_points *points) {
    const struct frame *frame = &page->pen.frame;
    FILE *file = page->pen.file;
    double half = points->count > 1 ? (points->x[1] - points->x[0]) / 2 : 0.5;
    fprintf(file, "<path fill=\"#c6d9e8\" stroke=\"#0b4f7d\" d=\"M%.1f %.1f",
            frame_x(frame, points->x[0] - half), frame_y(frame, 0));
    for (size_t b = 0; b < points->count; b++)
        fprintf(file, "V%.1fH%.1f", frame_y(frame, points->y[b]),
                frame_x(frame, points->x[b] + half));
    fprintf(file, "V%.1f\"/>\n", frame_y(frame, 0));
}

static double normal_density(double x, double mean, double deviation) {
    double t = (x - mean) / deviation;
    return exp(-t * t / 2) / (deviation * sqrt(2 * M_PI));
}

/* The distribution that fits best, standardised. */
struct height_law {
    struct heights heights;
    struct height_moments moments;
    char label[PLOT_LABEL_SIZE]; /* "weibull min fit" */
};

/* Reads it of the characterisation; false where there is none, or where it is the normal one. */
static bool find_law(const struct figure_page *page, struct height_law *out) {
#define LAW_NAME(type, name) name,
    static const char *const NAMES[] = {HEIGHT_DISTRIBUTIONS(LAW_NAME)};
#undef LAW_NAME
    static const char GROUP[] = "height_fit";
    const struct characterisation *found = page->figure->found;
    const char *told = characterisation_text(found, GROUP, "distribution");
    struct error unused;
    char name[64];
    int type = HEIGHTS_GAUSSIAN;
    while (told != NULL && type < HEIGHTS_QUANTILE && strcmp(NAMES[type], told) != 0)
        type++;
    if (told == NULL || type == HEIGHTS_GAUSSIAN || type == HEIGHTS_QUANTILE)
        return false;
    *out = (struct height_law){.heights = {.type = (enum heights_type)type,
                                           .shape = characterisation_value(found, GROUP, "shape")}};
    plot_spaced(told, name, sizeof name);
    snprintf(out->label, sizeof out->label, "%s fit", name);
    return heights_moments(&out->heights, &out->moments, &unused) == 0;
}

static double law_density(const struct height_law *law, double x, double mean, double deviation) {
    static const double STEP = 1e-3; /* of the standard deviation */
    double t = (x - mean) / deviation;
    return (heights_cdf(&law->heights, &law->moments, t + STEP) -
            heights_cdf(&law->heights, &law->moments, t - STEP)) /
           (2 * STEP * deviation);
}

/* Fills densities over the bins, of the normal law and of the one that fits (NULL: none does). */
static void fill_laws(const struct figure_page *page, const struct plot_axis *x_axis,
                      const struct height_law *law, struct figure_points *out) {
    const struct characterisation *found = page->figure->found;
    double unit = page->units.z, mean = characterisation_value(found, "heights", "mean") / unit;
    double deviation = characterisation_value(found, "heights", "rms") / unit;
    for (size_t n = 0; n < out->count; n++) {
        double part = (double)n / (double)(out->count - 1);
        out->x[n] = x_axis->low + part * (x_axis->high - x_axis->low);
        out->y[n] = normal_density(out->x[n], mean, deviation);
        out->law[n] = law != NULL ? law_density(law, out->x[n], mean, deviation) : (double)NAN;
    }
}

/* Sets axes that hold the bins from end to end, and the laws; linear, from 0. */
static void set_axes(struct figure_page *page, const struct figure_points *bins,
                     const struct height_law *law, struct figure_points *laws) {
    struct frame *frame = &page->pen.frame;
    double half = bins->count > 1 ? (bins->x[1] - bins->x[0]) / 2 : 0.5;
    const struct plot_axis x_axis = {.low = bins->x[0] - half,
                                     .high = bins->x[bins->count - 1] + half};
    fill_laws(page, &x_axis, law, laws);
    frame_start(frame, false, false);
    for (size_t n = 0; n < bins->count; n++)
        frame_include_point(frame, bins->x[n], bins->y[n]);
    for (size_t n = 0; n < laws->count; n++) {
        frame_include_point(frame, laws->x[n], laws->y[n]);
        frame_include_point(frame, laws->x[n], laws->law[n]);
    }
    frame_include_point(frame, bins->x[0], 0);
    (void)frame_finish(frame); /* there are points */
    frame->x = x_axis;
}

static void draw_panel(struct figure_page *page, const struct figure_points *bins,
                       struct figure_points *laws) {
    struct height_law law = {.label = ""};
    struct frame *frame = &page->pen.frame;
    char x_label[PLOT_LABEL_SIZE], y_label[PLOT_LABEL_SIZE];
    bool fits = find_law(page, &law);
    set_axes(page, bins, fits ? &law : NULL, laws);
    figure_place(page, false, false);
    figure_axis_label(&page->units, "z", 0, 1, x_label);
    figure_axis_label(&page->units, "density", 0, -1, y_label);
    frame_draw(page->pen.file, frame, x_label, y_label);
    draw_steps(page, bins);
    pen_line(&page->pen, laws->count, laws->x, laws->y, NORMAL);
    if (fits)
        pen_line(&page->pen, laws->count, laws->x, laws->law, FITTED);
    const struct figure_mark marks[] = {{"measured", "fill=\"#c6d9e8\" stroke=\"#0b4f7d\"", true},
                                        {"normal", NORMAL, false},
                                        {law.label, FITTED, false}};
    bool right = characterisation_value(page->figure->found, "heights", "skewness") > -0.2;
    figure_legend(page, fits ? 3 : 2, marks, right, true);
    figure_heading(page, "Heights", frame->left, frame->top - FIGURE_HEADING);
}

int figure_draw_heights(struct figure_page *page, struct error *err) {
    enum { LAW_POINTS = 181 };
    struct figure_points bins, laws;
    int status = count_heights(page, &bins, err);
    if (status != 0)
        return status;
    status = figure_points_create(&laws, LAW_POINTS, err);
    if (status != 0) {
        free(bins.x);
        return status;
    }
    if (bins.count > 0)
        draw_panel(page, &bins, &laws);
    else
        figure_draw_none(page, false, false, "Heights", "all heights are the same");
    free(laws.x);
    free(bins.x);
    return 0;
}
