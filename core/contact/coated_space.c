#include "core/contact/coated_space.h"
#include "core/contact/coating.h"
#include "core/theory/quadrature.h"
#include <gsl/gsl_sf_bessel.h>
#include <math.h>
#include <stdlib.h>

/* The part of a wave number k that long waves have is erfc((k - middle)/width)/2 with the middle
 * at 5 widths, which is 1 to 1e-12 at k = 0. What is left has a kernel below exp(-(width r/2)^2). A
 * width of 10 over the padding makes that exp(-25). */
static const double WIDTHS = 5, WIDTH_OVER_REACH = 10;
/* Least padding: long waves are then longer than two spacings. */
static const double REACH_LEAST = 32;
/* Steps of the table over the shortest of the long waves, over 2 pi, and radians of its wave that a
 * panel of quadrature spans. */
static const double STEP = 0.125, PANEL_RADIANS = 6;
enum { HALVINGS = 24 }; /* panels towards k = 0, where the excess varies on many scales */

/* Beyond a distance r a width of 10/r makes exp(-25), too. So farther samples are of fewer waves:
 * octave o of the table has all waves, steps and distances of the first one, the waves divided and
 * the others multiplied by 2^o. It is used from its middle on. The size of a table then grows with
 * the logarithm of the sides' ratio, and its octaves share their Bessel functions. */
enum { OCTAVES_MOST = 64 };

struct coated_space {
    struct block block;
    double middle, width;
    double step;          /* of the first octave */
    size_t count;         /* samples of an octave */
    size_t octaves;       /* OCTAVES_MOST at most */
    double *value, *rise; /* owned, [octave * count + n]: the long waves at these distances, and the
                             derivative times the step */
};

double coated_space_reach(const struct grid *grid) {
    return REACH_LEAST * grid_widest_spacing(grid);
}

static double long_part(const struct coated_space *space, double k) {
    return 0.5 * erfc((k - space->middle) / space->width);
}

double coated_space_near(const struct coated_space *space, double k) {
    double part = 0.5 * erfc((space->middle - k) / space->width);
    return part > 0 ? part * coating_excess(k, &space->block) : 0;
}

/* Fills sizes, by octave: of a node of quadrature at k in the first one. */
static void size_waves(const struct coated_space *space, bool profile, double k, double weight,
                       double *size) {
    for (size_t o = 0; o < space->octaves; o++) {
        double part = ldexp(1, -(int)o), wave = part * k;
        double own =
            part * weight * long_part(space, k) * coating_excess(wave, &space->block) / M_PI;
        size[o] = profile ? own : own * wave / 2;
    }
}

/* Adds the waves from low to high, in the first octave, to all samples. */
static void add_panel(struct coated_space *space, bool profile, double low, double high) {
    double node[QUADRATURE_NODES], weight[QUADRATURE_NODES], size[OCTAVES_MOST];
    quadrature_panel(low, high, node, weight);
    for (size_t a = 0; a < QUADRATURE_NODES; a++) {
        double k = node[a];
        size_waves(space, profile, k, weight[a], size);
        for (size_t n = 0; n < space->count; n++) {
            double phase = k * space->step * (double)n;
            double value = profile ? cos(phase) : gsl_sf_bessel_J0(phase);
            double rise = k * space->step * (profile ? sin(phase) : gsl_sf_bessel_J1(phase));
            for (size_t o = 0; o < space->octaves; o++) {
                space->value[o * space->count + n] += size[o] * value;
                space->rise[o * space->count + n] -= size[o] * rise;
            }
        }
    }
}

static void fill(struct coated_space *space, bool profile) {
    double highest = space->middle + WIDTHS * space->width;
    double farthest = space->step * (double)space->count;
    size_t panels = (size_t)ceil(highest * farthest / PANEL_RADIANS);
    double panel = highest / (double)panels;
    add_panel(space, profile, 0, ldexp(panel, -HALVINGS));
    for (int half = HALVINGS; half > 0; half--)
        add_panel(space, profile, ldexp(panel, -half), ldexp(panel, 1 - half));
    for (size_t p = 1; p < panels; p++)
        add_panel(space, profile, (double)p * panel, (double)(p + 1) * panel);
}

int coated_space_create(struct coated_space **out, const struct grid *grid,
                        const struct grid *padded, const struct block *block, struct error *err) {
    const bool profile = grid_is_profile(grid);
    double reach = padded->lx - grid->lx, width = padded->lx, height = profile ? 0 : padded->ly;
    struct coated_space *space = array_create(1, sizeof *space);
    *out = NULL;
    if (space == NULL)
        return error_memory(err, sizeof *space, "the compliance of a coating");
    if (!profile)
        reach = fmin(reach, padded->ly - grid->ly);
    space->block = *block;
    space->width = WIDTH_OVER_REACH / reach;
    space->middle = WIDTHS * space->width;
    space->step = STEP / (space->middle + WIDTHS * space->width);
    double farthest = hypot(width, height) / 2;
    space->count = (size_t)(fmin(farthest, 2 * reach) / space->step) + 2;
    space->octaves = 1 + (size_t)fmax(0, ceil(log2(farthest / (2 * reach))));
    size_t samples = space->octaves * space->count;
    space->value = array_create(samples, sizeof *space->value);
    space->rise = array_create(samples, sizeof *space->rise);
    if (space->value == NULL || space->rise == NULL) {
        size_t bytes = 2 * samples * sizeof(double);
        coated_space_destroy(&space);
        return error_memory(err, bytes, "the compliance of a coating");
    }
    fill(space, profile);
    *out = space;
    return 0;
}

void coated_space_destroy(struct coated_space **space) {
    if (*space == NULL)
        return;
    free((*space)->value);
    free((*space)->rise);
    free(*space);
    *space = NULL;
}

/* Between samples, by the cubic of their values and derivatives. */
double coated_space_far(const struct coated_space *space, double distance) {
    double at = distance / space->step, last = (double)(space->count - 2);
    size_t octave = 0;
    for (; octave + 1 < space->octaves && at > last; octave++)
        at /= 2;
    size_t n = (size_t)fmin(at, last);
    const double t = at - (double)n, s = 1 - t;
    const double *value = space->value + octave * space->count + n;
    const double *rise = space->rise + octave * space->count + n;
    return s * s * ((1 + 2 * t) * value[0] + t * rise[0]) +
           t * t * ((1 + 2 * s) * value[1] - s * rise[1]);
}
