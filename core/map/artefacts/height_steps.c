#include "core/map/artefacts/height_steps.h"
#include <gsl/gsl_sort.h>
#include <math.h>
#include <stdlib.h>

enum { SAMPLE_MOST = 1 << 16, FEWEST = 20, CLUSTER_LEAST = 4, SAMPLE_A_CLUSTER = 8192 };

/* Sizes of second differences along x, in rising order. */
struct sample {
    size_t count;
    double *value; /* owned */
    double rms;
};

static int sample_create(struct sample *out, const struct grid *grid, const double *z,
                         struct error *err) {
    const size_t inside = grid->nx > 2 ? grid->nx - 2 : 0, all = inside * grid->ny;
    const size_t step = (all / SAMPLE_MOST + 1) | 1; /* odd: takes even and odd columns */
    double total = 0;
    *out = (struct sample){.value = array_create(all / step + 1, sizeof *out->value)};
    if (out->value == NULL)
        return error_memory(err, (all / step + 1) * sizeof *out->value, "second differences");
    for (size_t n = 0; n < all; n += step) {
        const double value = fabs(second_difference(z + n / inside * grid->nx + n % inside + 1, 1));
        if (isnan(value))
            continue;
        out->value[out->count++] = value;
        total += value * value;
    }
    out->rms = out->count > 0 ? sqrt(total / (double)out->count) : 0;
    gsl_sort(out->value, 1, out->count);
    return 0;
}

/* Returns the mean of the lowest values above 0 that are the same but for rounding and are many
 * enough; 0: there are none. */
static double cluster_find(const struct sample *sample, double rounding) {
    const double *value = sample->value;
    const size_t need = CLUSTER_LEAST + sample->count / SAMPLE_A_CLUSTER;
    for (size_t first = 0, last; first < sample->count; first = last) {
        double total = value[first];
        for (last = first + 1; last < sample->count && value[last] - value[last - 1] <= rounding;
             last++)
            total += value[last];
        if (value[first] > 4 * rounding && last - first >= need)
            return total / (double)(last - first);
    }
    return 0;
}

/* Returns the step of which nearly all values are multiples; 0: there is none. */
static double step_find(const struct sample *sample, double rounding) {
    static const double NEAR = 0.02, NEARLY_ALL = 0.95, LEAST = 1e-3;
    double step = cluster_find(sample, rounding), squares = 0, products = 0;
    size_t on = 0, above = 0;
    if (!(step > LEAST * sample->rms) || rounding > NEAR * step)
        return 0;
    for (size_t n = 0; n < sample->count; n++) {
        const double value = sample->value[n], times = round(value / step);
        if (value <= rounding)
            continue;
        above++;
        if (fabs(value - times * step) > fmax(NEAR * step, 2 * rounding))
            continue;
        on++;
        squares += times * times; /* the step is refined by multiples as they grow */
        products += times * value;
        step = squares > 0 ? products / squares : step;
    }
    return above >= FEWEST && (double)on >= NEARLY_ALL * (double)above ? step : 0;
}

double height_steps_variance(double first, double mean, double step) {
    enum { TERMS = 100, HALVINGS = 60 };
    double low = 0, high = first;
    for (int n = 0; n < HALVINGS; n++) {
        const double variance = (low + high) / 2, fall = 2 * M_PI * M_PI * variance / (step * step);
        double found = variance + step * step / 6;
        for (int k = 1; k <= TERMS; k++)
            found -= step * step / (M_PI * M_PI * k * k) * exp(-fall * k * k) *
                     cos(2 * M_PI * k * mean / step);
        if (found < first)
            low = variance;
        else
            high = variance;
    }
    return (low + high) / 2;
}

void height_steps_weigh(const struct grid *grid, const struct map_differences *differences,
                        struct height_steps *steps) {
    static const double COARSE = 1.5; /* of the RMS height: levels are then too few */
    const struct differences *axis = differences->axis;
    const int axes = grid_is_profile(grid) ? 1 : 2;
    const double noise = steps->step * steps->step / 2;
    double with[2] = {0}, without[2] = {0};
    steps->curvature = 0;
    steps->slope = 1;
    for (int a = 0; a < axes && steps->step > 0; a++) {
        with[a] = axis[a].first;
        without[a] = height_steps_variance(axis[a].first, axis[a].mean, steps->step);
        steps->curvature = fmax(steps->curvature, fmin(noise / axis[a].second, 1));
    }
    if (!(steps->step < COARSE * differences->rms_height))
        steps->slope = (double)NAN;
    else if (steps->step > 0)
        steps->slope = sqrt(differences_square(grid, without) / differences_square(grid, with));
}

int height_steps_find(const struct grid *grid, const double *z,
                      const struct map_differences *differences, struct height_steps *out,
                      struct error *err) {
    /* of heights in 53 and in 24 bits, which second differences add up */
    static const double ROUNDING[] = {0x1p-49, 0x1p-22};
    struct sample sample;
    *out = (struct height_steps){.slope = 1};
    int status = sample_create(&sample, grid, z, err);
    if (status != 0)
        return status;
    for (int n = 0; n < 2 && out->step == 0 && sample.rms > 0; n++)
        out->step = step_find(&sample, ROUNDING[n] * differences->highest);
    free(sample.value);
    return 0;
}
