/* The distribution of heights on the page, with the normal one and the one that fits best. */
#include "server/show/map/figure/map_figure.h"
#include "server/show/map/figure/map_figure_internal.h"
#include <math.h>
#include <stdlib.h>

/* The counted heights as densities, in the unit of the page. */
static int fill_bins(const struct figure_page *page, struct figure_points *out, struct error *err) {
    const struct map_histogram *histogram = &page->figure->measured->histogram;
    double unit = page->units.z;
    int status = figure_points_create(out, histogram->count, err);
    for (size_t b = 0; b < histogram->count && status == 0; b++) {
        out->x[b] = (histogram->low + ((double)b + 0.5) * histogram->width) / unit;
        out->y[b] = histogram->counts[b] * (unit / (histogram->width * histogram->total));
    }
    return status;
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

/* The distribution that fits best. */
struct fitted_law {
    struct map_height_law law;
    char label[PLOT_LABEL_SIZE]; /* "weibull min fit" */
};

/* Returns false where there is none, or where it is the normal one. */
static bool find_law(const struct figure_page *page, struct fitted_law *out) {
    char name[64];
    const char *fitted = named_text(page->figure->found, "height_fit", "distribution");
    if (fitted == NULL || !map_height_law_find(&out->law, page->figure->measured))
        return false;
    plot_in_words(fitted, name, sizeof name);
    snprintf(out->label, sizeof out->label, "%s fit", name);
    return true;
}

/* Fills densities over the bins, of the normal law and of the one that fits (NULL: none does). */
static void fill_laws(const struct figure_page *page, const struct plot_axis *x_axis,
                      const struct fitted_law *law, struct figure_points *out) {
    const struct named_values *found = page->figure->found;
    double unit = page->units.z, mean = named_number(found, "heights", "mean") / unit;
    double deviation = named_number(found, "heights", "rms") / unit;
    for (size_t n = 0; n < out->count; n++) {
        double part = (double)n / (double)(out->count - 1);
        out->x[n] = x_axis->low + part * (x_axis->high - x_axis->low);
        out->y[n] = normal_density(out->x[n], mean, deviation);
        out->law[n] = law != NULL ? map_height_law_density(&law->law, out->x[n], mean, deviation)
                                  : (double)NAN;
    }
}

/* Sets axes that hold the bins from end to end, and the laws; linear, from 0. */
static void set_axes(struct figure_page *page, const struct figure_points *bins,
                     const struct fitted_law *law, struct figure_points *laws) {
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
    struct fitted_law law = {.label = ""};
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
    bool right = named_number(page->figure->found, "heights", "skewness") > -0.2;
    figure_legend(page, fits ? 3 : 2, marks, right, true);
    figure_heading(page, "Heights", frame->left, frame->top - FIGURE_HEADING);
}

int figure_draw_heights(struct figure_page *page, struct error *err) {
    enum { LAW_POINTS = 181 };
    struct figure_points bins, laws;
    int status = fill_bins(page, &bins, err);
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
