#include "core/statistics/heights/height_fit.h"
#include <gsl/gsl_cdf.h>
#include <math.h>

/* A distribution against the heights at the levels of cell_heights.h. */
struct model {
    struct heights heights;
    const struct distribution *row;
    double blur;                   /* by shares_fill */
    double x[HEIGHT_LEVELS];       /* levels about the mean, over the RMS */
    double share[HEIGHT_LEVELS];   /* of the distribution below */
    double density[HEIGHT_LEVELS]; /* of it there */
    double bend[HEIGHT_LEVELS];    /* change of `share` by the shape */
};

/* A distribution that leaves the levels out that a few stray heights are behind would have no
 * likelihood at all: so small a share of all models is spread evenly. */
static const double STRAY = 0.01;
/* Gaussian heights, which have no shape, are kept unless another's criterion is less by this. */
static const double CLEARLY = 4;
/* Number of independent heights where it is not known. */
static const double INDEPENDENT_AT_LEAST = 100;
/* The last section is 1e-3 of the logarithm of a shape; the parabola is right to 1e-6 of it. */
enum { SHAPES_TRIED = 20, NARROWINGS = 12 };

/* A tilt that is taken out of an open map is partly random, and its error blurs the distribution.
 * Eight equally frequent offsets, of mean square 1, represent it. */
enum { OFFSETS = 8 };
static const double BLUR_MOST = 0.1;
static const double OFFSET[OFFSETS] = {-1.663, -0.962, -0.530, -0.170, 0.170, 0.530, 0.962, 1.663};

/* blur: mean square of the offsets over that of the heights; the surface has as much more. */
static bool shares_fill(const struct heights *heights, double blur, size_t n, const double *x,
                        double *share) {
    struct height_moments moments;
    if (heights_moments(heights, &moments, NULL) != 0)
        return false;
    for (size_t l = 0; l < n; l++) {
        share[l] = blur > 0 ? 0 : heights_cdf(heights, &moments, x[l]);
        for (size_t o = 0; o < OFFSETS && blur > 0; o++)
            share[l] += heights_cdf(heights, &moments,
                                    (x[l] * sqrt(1 - blur) + OFFSET[o] * sqrt(blur)) / (1 - blur)) /
                        OFFSETS;
    }
    return true;
}

/* Weight of a level in Anderson and Darling's distance, by the shares of the map. */
static double weight_at(const struct cell_heights *h, size_t l) {
    double below = l > 0 ? h->share[l - 1] : 0, above = l + 1 < h->levels ? h->share[l + 1] : 1;
    return (above - below) / 2 / (h->share[l] * (1 - h->share[l]));
}

static double distance_of(const struct cell_heights *h, const double *share) {
    double total = 0;
    for (size_t l = 0; l < h->levels; l++)
        total += weight_at(h, l) * (h->share[l] - share[l]) * (h->share[l] - share[l]);
    return total;
}

static double distance_at(const struct cell_heights *h, struct model *model, double log_shape) {
    model->heights.shape =
        fmin(fmax(exp(log_shape), model->row->shape_low), model->row->shape_high);
    bool known = shares_fill(&model->heights, model->blur, h->levels, model->x, model->share);
    return known ? distance_of(h, model->share) : INFINITY;
}

/* Returns the best shape of a table, without blur, which moves it by little, or the one of the
 * table beside it that is better with it. */
static double shape_begin(const struct cell_heights *h, struct model *model, double low,
                          double high, double step) {
    const double blur = model->blur;
    double best = INFINITY, at = low;
    model->blur = 0;
    for (int n = 0; n <= SHAPES_TRIED; n++) {
        double distance = distance_at(h, model, low + n * step);
        if (distance < best) {
            best = distance;
            at = low + n * step;
        }
    }
    model->blur = blur;
    if (blur == 0)
        return at;
    best = distance_at(h, model, at);
    for (int side = -1; side <= 1; side += 2)
        for (double next = at + side * step; next > low - step / 2 && next < high + step / 2;
             next += side * step) {
            const double distance = distance_at(h, model, next);
            if (!(distance < best))
                break;
            best = distance;
            at = next;
        }
    return at;
}

/* Finds the shape of the least distance: from the best of a table by golden sections beside it, and
 * by the parabola through the last section. */
static void shape_find(const struct cell_heights *h, struct model *model) {
    const double low = log(model->row->shape_low), high = log(model->row->shape_high);
    const double step = (high - low) / SHAPES_TRIED, at = shape_begin(h, model, low, high, step);
    const double golden = (sqrt(5) - 1) / 2;
    double left = fmax(low, at - step), right = fmin(high, at + step);
    double a = right - golden * (right - left), b = left + golden * (right - left);
    double at_a = distance_at(h, model, a), at_b = distance_at(h, model, b);
    for (int n = 0; n < NARROWINGS; n++) {
        bool leftward = at_a < at_b;
        right = leftward ? b : right;
        left = leftward ? left : a;
        double next = leftward ? right - golden * (right - left) : left + golden * (right - left);
        double value = distance_at(h, model, next);
        double kept = leftward ? a : b, at_kept = leftward ? at_a : at_b;
        a = leftward ? next : kept;
        at_a = leftward ? value : at_kept;
        b = leftward ? kept : next;
        at_b = leftward ? at_kept : value;
    }
    const double middle = (left + right) / 2, half = (right - left) / 2;
    const double before = distance_at(h, model, left), behind = distance_at(h, model, right);
    const double bend = before - 2 * distance_at(h, model, middle) + behind;
    const double move = bend > 0 ? (before - behind) / (2 * bend) : 0;
    distance_at(h, model, middle + half * fmin(fmax(move, -1), 1));
}

/* Fills density and bend by central differences. */
static void slopes_fill(const struct cell_heights *h, struct model *model) {
    static const double STEP = 1e-4;
    double x[HEIGHT_LEVELS], before[HEIGHT_LEVELS] = {0}, behind[HEIGHT_LEVELS] = {0};
    struct heights heights = model->heights;
    for (int side = -1; side <= 1; side += 2) {
        for (size_t l = 0; l < h->levels; l++)
            x[l] = model->x[l] + side * STEP;
        shares_fill(&heights, model->blur, h->levels, x, side < 0 ? before : behind);
    }
    for (size_t l = 0; l < h->levels; l++)
        model->density[l] = (behind[l] - before[l]) / (2 * STEP);
    for (size_t l = 0; l < h->levels; l++)
        model->bend[l] = 0;
    if (model->row->shape_means == NULL)
        return;
    double low = fmax(model->heights.shape * (1 - STEP), model->row->shape_low);
    double high = fmin(model->heights.shape * (1 + STEP), model->row->shape_high);
    heights.shape = low;
    shares_fill(&heights, model->blur, h->levels, model->x, before);
    heights.shape = high;
    shares_fill(&heights, model->blur, h->levels, model->x, behind);
    for (size_t l = 0; l < h->levels; l++)
        model->bend[l] = (behind[l] - before[l]) / (high - low);
}

/* What a set of heights, each with a weight, changes: their weights, weighted deviations from the
 * mean and squares of these, and weights below each level. */
struct part {
    double count, first, second;
    double below[HEIGHT_LEVELS];
};

/* Turns it, in place, into the change of the difference between shares of map and model at each
 * level, with mean, RMS and shape fitted; returns that of the shape. */
static double part_fit(const struct cell_heights *h, const struct model *model, struct part *part) {
    double mean = part->first / h->rms, along = 0, size = 0;
    double rms = (part->second / (h->rms * h->rms) - part->count) / 2;
    for (size_t l = 0; l < h->levels; l++) {
        part->below[l] +=
            model->density[l] * (mean + model->x[l] * rms) - h->share[l] * part->count;
        along += weight_at(h, l) * model->bend[l] * part->below[l];
        size += weight_at(h, l) * model->bend[l] * model->bend[l];
    }
    double shape = size > 0 ? along / size : 0;
    for (size_t l = 0; l < h->levels; l++)
        part->below[l] -= model->bend[l] * shape;
    return shape;
}

static void part_of_mode(const struct cell_heights *h, const struct low_modes *modes, size_t m,
                         struct part *part) {
    *part = (struct part){.count = low_mode_amplitude(modes, m, h->power[0]) / h->count,
                          .first = low_mode_amplitude(modes, m, h->power[1]) / h->count,
                          .second = low_mode_amplitude(modes, m, h->power[2]) / h->count};
    for (size_t cell = 0; cell < h->cells; cell++)
        for (size_t l = 0; l < h->levels; l++)
            part->below[l] += modes->value[m][cell] * h->below[cell * h->levels + l] / h->count;
}

/* Products of the parts of two modes, summed over levels. */
static double parts_product(const struct cell_heights *h, const struct part *a,
                            const struct part *b) {
    double total = 0;
    for (size_t l = 0; l < h->levels; l++)
        total += weight_at(h, l) * a->below[l] * b->below[l];
    return total;
}

/* The distance due to sampling: its mean, that of one height alone, and the number of squares of
 * Gaussian numbers that it is distributed as. */
struct chance {
    double mean, single, squares;
    double shape; /* standard error */
};

/* Distance that independent heights would have, times their number: the mean over heights of what
 * one of them changes. */
static double single_distance(const struct cell_heights *h, const struct model *model) {
    double total = 0;
    for (size_t bin = 0; bin <= h->levels; bin++) {
        struct part part = {.count = 1};
        double low = bin > 0 ? h->share[bin - 1] : 0;
        double share = (bin < h->levels ? h->share[bin] : 1) - low;
        double left = bin > 0 ? model->x[bin - 1] : model->x[0];
        double y = h->rms * (bin < h->levels ? (left + model->x[bin]) / 2 : left);
        part.first = y;
        part.second = y * y;
        for (size_t l = bin; l < h->levels; l++)
            part.below[l] = 1;
        part_fit(h, model, &part);
        total += share * parts_product(h, &part, &part);
    }
    return total;
}

static void chance_measure(const struct cell_heights *h, const struct low_modes *modes,
                           const struct model *model, struct chance *out) {
    struct part parts[LOW_MODES_MOST];
    double cross = 0, products = 0, n = (double)modes->count;
    *out = (struct chance){0};
    for (size_t m = 0; m < modes->count; m++) {
        part_of_mode(h, modes, m, &parts[m]);
        out->shape += pow(part_fit(h, model, &parts[m]), 2) / n;
        double own = parts_product(h, &parts[m], &parts[m]);
        for (size_t other = 0; other < m; other++) {
            cross += pow(parts_product(h, &parts[m], &parts[other]), 2);
            products += own * parts_product(h, &parts[other], &parts[other]);
        }
        out->mean += own / n;
    }
    /* With mean and RMS fitted, what is left is of third order. */
    out->mean *= modes->excess[3];
    out->shape = sqrt(modes->excess[3] * out->shape);
    out->squares = fmin(fmax(products / cross, 1), n);
    out->single = single_distance(h, model);
}

/* Mean logarithm of the likelihood of a height to be in its bin. */
static double likelihood(const struct cell_heights *h, const struct model *model) {
    double total = 0;
    for (size_t bin = 0; bin <= h->levels; bin++) {
        double share = (bin < h->levels ? h->share[bin] : 1) - (bin > 0 ? h->share[bin - 1] : 0);
        double expected =
            (bin < h->levels ? model->share[bin] : 1) - (bin > 0 ? model->share[bin - 1] : 0);
        total += share * log((1 - STRAY) * expected + STRAY * share);
    }
    return total;
}

/* Two tilts, each of which takes as much out of the heights as a slow wave has. */
static double blur_of(const struct cell_heights *h, const struct low_modes *modes) {
    double share = low_modes_variance(modes, h->power[1], h->count) / (h->rms * h->rms);
    return modes->open && h->untilted ? fmin(2 * share, BLUR_MOST) : 0;
}

static void fit_one(const struct cell_heights *h, const struct low_modes *modes,
                    enum heights_type type, struct height_fit *out, double *independent,
                    double *mean_likelihood) {
    struct model model = {.heights = {.type = type}, .row = heights_distribution(type)};
    for (size_t l = 0; l < h->levels; l++)
        model.x[l] = (h->level[l] - h->mean) / h->rms;
    bool shaped = model.row->shape_means != NULL;
    model.blur = shaped && modes != NULL ? blur_of(h, modes) : 0;
    if (shaped)
        shape_find(h, &model);
    else
        shares_fill(&model.heights, model.blur, h->levels, model.x, model.share);
    out->shape = shaped ? model.heights.shape : (double)NAN;
    out->distance = distance_of(h, model.share);
    *mean_likelihood = likelihood(h, &model);
    if (modes == NULL)
        return;
    struct chance chance;
    slopes_fill(h, &model);
    chance_measure(h, modes, &model, &chance);
    out->p_value =
        gsl_cdf_fdist_Q(out->distance / chance.mean, chance.squares, (double)modes->count);
    double reach = low_modes_factor(modes->count) * chance.shape / out->shape;
    bool inside =
        out->shape > 1.001 * model.row->shape_low && out->shape < 0.999 * model.row->shape_high;
    out->shape_low = shaped && inside ? out->shape * exp(-reach) : (double)NAN;
    out->shape_high = shaped && inside ? out->shape * exp(reach) : (double)NAN;
    *independent = chance.single / chance.mean;
}

static void best_choose(const double *likelihoods, struct height_fits *out) {
    double independent = isnan(out->independent) ? INDEPENDENT_AT_LEAST : out->independent;
    double least = INFINITY;
    for (size_t n = 0; n < HEIGHTS_QUANTILE; n++) {
        struct height_fit *fit = &out->list[n];
        double criterion = 2 * (isnan(fit->shape) ? 0 : 1) - 2 * independent * likelihoods[n];
        fit->aic = isnan(out->independent) ? out->independent : criterion;
        if (criterion < least - (out->best == HEIGHTS_GAUSSIAN && n > 0 ? CLEARLY : 0)) {
            least = criterion;
            out->best = n;
        }
    }
}

void height_fit_measure(const struct cell_heights *heights, const struct low_modes *modes,
                        struct height_fits *out) {
    double likelihoods[HEIGHTS_QUANTILE] = {0}, independent[HEIGHTS_QUANTILE], none = (double)NAN;
    out->best = HEIGHTS_GAUSSIAN;
    out->independent = none;
    size_t nearest = 0;
    for (size_t n = 0; n < HEIGHTS_QUANTILE; n++) {
        out->list[n] =
            (struct height_fit){(enum heights_type)n, none, none, none, none, none, none};
        independent[n] = none;
        if (heights->levels < 2)
            continue;
        fit_one(heights, modes, (enum heights_type)n, &out->list[n], &independent[n],
                &likelihoods[n]);
        nearest = out->list[n].distance < out->list[nearest].distance ? n : nearest;
    }
    out->independent = independent[nearest];
    if (heights->levels >= 2)
        best_choose(likelihoods, out);
}
