#include "core/statistics/heights/plateau.h"
#include <gsl/gsl_cdf.h>
#include <math.h>

enum { TERMS = 4, LEVELS_MOST = 201, STEPS_MOST = 100, SPLIT_STEP = 4 };
enum { PLATEAU_MEAN, PLATEAU_LOG, VALLEY_MEAN, VALLEY_LOG }; /* logarithms of the RMS heights */
static const double SCORE_STEP = 0.05, HEIGHTS_BEYOND = 10;

/* Points of the curve at even scores, of which the share below is G. */
struct plot {
    size_t count;
    double unit; /* of the heights, their RMS */
    double score[LEVELS_MOST], height[LEVELS_MOST], weight[LEVELS_MOST];
};

static double density(double score) {
    return exp(-score * score / 2) / sqrt(2 * M_PI);
}

/* A score that was counted has the variance P (1 - P)/(n g^2), g being the density. */
static void plot_fill(struct plot *plot, const struct material_curve *curve) {
    struct sum squares = {0}, weights = {0};
    const double most = gsl_cdf_ugaussian_Qinv(fmin(HEIGHTS_BEYOND / (double)curve->n, 0.5));
    const size_t room = LEVELS_MOST / 2;
    const size_t beside = (size_t)fmin(most / SCORE_STEP, (double)room);
    for (size_t k = 0; k < curve->n; k++)
        sum_add(&squares, curve->z[k] * curve->z[k]);
    plot->unit = sqrt(sum_value(&squares) / (double)curve->n);
    plot->count = 2 * beside + 1;
    for (size_t l = 0; l < plot->count; l++) {
        const double score = ((double)l - (double)beside) * SCORE_STEP, g = density(score);
        const double above = gsl_cdf_ugaussian_Q(score);
        plot->score[l] = score;
        plot->height[l] = material_height(curve, above) / plot->unit;
        plot->weight[l] = g * g / (above * (1 - above));
        sum_add(&weights, plot->weight[l]);
    }
    for (size_t l = 0; l < plot->count; l++)
        plot->weight[l] /= sum_value(&weights);
}

/* The straight line height = mean + rms score of least weighted squares of some levels, and these
 * squares. */
struct straight {
    double mean, rms, squares;
};

static struct straight straight_fit(const struct plot *plot, size_t from, size_t to) {
    double w = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;
    for (size_t l = from; l < to; l++) {
        const double weight = plot->weight[l], score = plot->score[l], height = plot->height[l];
        w += weight;
        x += weight * score;
        y += weight * height;
        xx += weight * score * score;
        xy += weight * score * height;
        yy += weight * height * height;
    }
    const double slope = (xy - x * y / w) / (xx - x * x / w);
    return (struct straight){(y - slope * x) / w, slope, yy - y * y / w - slope * (xy - x * y / w)};
}

/* Finds the pair of lines, the lower one steeper, that meet the curve best; false where no pair is
 * so. */
static bool start_find(const struct plot *plot, double terms[TERMS]) {
    double least = INFINITY;
    for (size_t split = plot->count / 10 + 2; split + plot->count / 10 + 2 < plot->count;
         split += SPLIT_STEP) {
        const struct straight lower = straight_fit(plot, 0, split);
        const struct straight upper = straight_fit(plot, split, plot->count);
        if (!(upper.rms > 0 && lower.rms > upper.rms && lower.squares + upper.squares < least))
            continue;
        least = lower.squares + upper.squares;
        terms[PLATEAU_MEAN] = upper.mean;
        terms[PLATEAU_LOG] = log(upper.rms);
        terms[VALLEY_MEAN] = lower.mean;
        terms[VALLEY_LOG] = log(lower.rms);
    }
    return isfinite(least);
}

/* Returns the score that the law has at a height, and its derivatives by the terms. */
static double law_score(const double terms[TERMS], double height, double slope[TERMS]) {
    const double rms[2] = {exp(terms[PLATEAU_LOG]), exp(terms[VALLEY_LOG])};
    const double at[2] = {(height - terms[PLATEAU_MEAN]) / rms[0],
                          (height - terms[VALLEY_MEAN]) / rms[1]};
    const double above[2] = {gsl_cdf_ugaussian_Q(at[0]), gsl_cdf_ugaussian_Q(at[1])};
    const double score = gsl_cdf_ugaussian_Qinv(fmin(fmax(above[0] * above[1], 1e-290), 1 - 1e-15));
    for (int s = 0; s < 2; s++) {
        const double change = -density(at[s]) * above[1 - s] / fmax(density(score), 1e-290);
        slope[2 * s] = change / rms[s];
        slope[2 * s + 1] = change * at[s];
    }
    return score;
}

/* Weighted squares of the law's distances; with their gradient and Gauss and Newton's matrix where
 * these are not NULL. */
static double squares_of(const struct plot *plot, const double terms[TERMS], double *gradient,
                         double (*matrix)[TERMS]) {
    double squares = 0, slope[TERMS];
    for (size_t l = 0; l < plot->count; l++) {
        const double off = law_score(terms, plot->height[l], slope) - plot->score[l];
        squares += plot->weight[l] * off * off;
        for (int a = 0; a < TERMS && gradient != NULL; a++) {
            gradient[a] += plot->weight[l] * off * slope[a];
            for (int b = 0; b < TERMS; b++)
                matrix[a][b] += plot->weight[l] * slope[a] * slope[b];
        }
    }
    return squares;
}

/* Solves matrix x = vector in place, by elimination; the matrix is positive definite. */
static void solve(double matrix[TERMS][TERMS], double vector[TERMS]) {
    for (int a = 0; a < TERMS; a++)
        for (int b = a + 1; b < TERMS; b++) {
            const double factor = matrix[b][a] / matrix[a][a];
            for (int c = a; c < TERMS; c++)
                matrix[b][c] -= factor * matrix[a][c];
            vector[b] -= factor * vector[a];
        }
    for (int a = TERMS; a-- > 0;) {
        for (int b = a + 1; b < TERMS; b++)
            vector[a] -= matrix[a][b] * vector[b];
        vector[a] /= matrix[a][a];
    }
}

/* Goes downhill from a start by steps of Levenberg (1944). Returns the least squares. */
static double descend(const struct plot *plot, double terms[TERMS]) {
    double damping = 1e-3, least = squares_of(plot, terms, NULL, NULL);
    for (int step = 0; step < STEPS_MOST && damping < 1e10; step++) {
        double gradient[TERMS] = {0}, matrix[TERMS][TERMS] = {{0}}, tried[TERMS];
        (void)squares_of(plot, terms, gradient, matrix);
        for (int a = 0; a < TERMS; a++)
            matrix[a][a] = matrix[a][a] * (1 + damping) + 1e-14;
        solve(matrix, gradient);
        for (int a = 0; a < TERMS; a++)
            tried[a] = terms[a] - gradient[a];
        const double found = squares_of(plot, tried, NULL, NULL);
        const bool better = found < least;
        damping *= better ? 0.2 : 10;
        if (!better)
            continue;
        const bool ends = least - found < 1e-12 * least;
        least = found;
        for (int a = 0; a < TERMS; a++)
            terms[a] = tried[a];
        if (ends)
            break;
    }
    return least;
}

void plateau_fit(const struct material_curve *curve, struct plateau_law *out) {
    const double none = (double)NAN;
    struct plot plot;
    double terms[TERMS] = {0};
    *out = (struct plateau_law){none, none, none, none, none, none, none};
    plot_fill(&plot, curve);
    if (plot.count < 40 || !(plot.unit > 0) || !start_find(&plot, terms))
        return;
    const struct straight one = straight_fit(&plot, 0, plot.count);
    const double least = descend(&plot, terms), line = sqrt(one.squares) / one.rms;
    const double rms[2] = {exp(terms[PLATEAU_LOG]), exp(terms[VALLEY_LOG])};
    const double knee = (terms[PLATEAU_MEAN] - terms[VALLEY_MEAN]) / (rms[1] - rms[0]);
    if (!(rms[1] > rms[0] && sqrt(least) < line && fabs(knee) < plot.score[plot.count - 1]))
        return;
    *out = (struct plateau_law){.plateau_mean = terms[PLATEAU_MEAN] * plot.unit,
                                .plateau_rms = rms[0] * plot.unit,
                                .valley_mean = terms[VALLEY_MEAN] * plot.unit,
                                .valley_rms = rms[1] * plot.unit,
                                .ratio = gsl_cdf_ugaussian_Q(knee),
                                .residual = sqrt(least),
                                .line_residual = line};
}

bool plateau_is_clear(const struct plateau_law *law) {
    static const double BETTER = 0.5, WELL = 0.2, SHARE[2] = {0.1, 0.95}; /* scores, shares */
    return law->residual < BETTER * law->line_residual && law->residual < WELL &&
           law->ratio > SHARE[0] && law->ratio < SHARE[1];
}

double plateau_ratio(const struct plateau_law *law, double height) {
    return gsl_cdf_ugaussian_Q((height - law->plateau_mean) / law->plateau_rms) *
           gsl_cdf_ugaussian_Q((height - law->valley_mean) / law->valley_rms);
}
