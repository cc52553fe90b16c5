#include "jobs/contact/contact_measure.h"
#include "core/contact/stretch.h"
#include <math.h>

/* Stiffness beyond this, in units of E* h'/sqrt(m0), is that of full contact but for rounding; its
 * square must fit into exact sums, as that of a fit's factor. */
static const double VALUE_MOST = 1e6;

static double limited(double value) {
    return fabs(value) < VALUE_MOST ? value : (double)NAN;
}

void contact_measure(const struct contact_meter *meter, const struct contact_pressed *pressed,
                     double values[MEASURE_OWN]) {
    const struct contact_state *state = &pressed->state;
    double now = pressed->stretch;
    struct contact_area area;
    struct patches patches;
    contact_area(meter->area, state, &area);
    patches_find(meter->finder, state->p, &patches, NULL);
    for (size_t a = 0; a < MEASURE_OWN; a++)
        values[a] = NAN;
    /* Edges lie within the cells of outer nodes in contact, near which hardly any pressure acts. */
    double open_now = area.nodes < 1 ? (1 - now * area.nodes) / (1 - area.nodes) : 1;
    values[MEASURE_NODES] = now * area.nodes;
    values[MEASURE_EDGES] = stretch_fraction(area.edges, open_now);
    if (meter->scaled)
        values[MEASURE_EDGES_STRETCHED] = stretch_fraction(area.edges, pressed->open_stretch);
    values[MEASURE_PERIMETER] = stretch_fraction(area.perimeter, open_now);
    values[MEASURE_GAP] = area.mean_gap / meter->rms_height;
    values[MEASURE_NODES_LOWER] = now * area.lower;
    values[MEASURE_NODES_UPPER] = now * area.upper;
    values[MEASURE_STIFFNESS] = limited(state->stiffness * meter->rms_height / meter->rms_slope);
    values[MEASURE_PATCHES] = (double)patches.count;
    values[MEASURE_PATCH_MEAN] = now * patches.mean / meter->points;
    values[MEASURE_PATCH_LARGEST] = now * (double)patches.largest / meter->points;
    values[MEASURE_ITERATIONS] = (double)state->iterations;
    values[MEASURE_WORK] = state->work / meter->points;
    values[MEASURE_VIOLATION] = state->violation;
    values[MEASURE_PENETRATION] = state->penetration;
}

/* Running sums of least squares. */
struct line_sums {
    double n, x, y, xx, xy;
};

void contact_measure_fits(size_t n, const double *loads, const double *edges, double *kappa,
                          double *power_law_a, double *power_law_b) {
    double products = 0, squares = 0;
    struct line_sums logs = {0};
    for (size_t k = 0; k < n; k++) {
        double x = log(loads[k]), y = edges[k] > 0 ? log(edges[k]) : (double)NAN;
        products += loads[k] * edges[k];
        squares += loads[k] * loads[k];
        logs = (struct line_sums){logs.n + 1, logs.x + x, logs.y + y, logs.xx + x * x,
                                  logs.xy + x * y};
        double slope = (logs.n * logs.xy - logs.x * logs.y) / (logs.n * logs.xx - logs.x * logs.x);
        kappa[k] = edges[k] > 0 ? limited(products / squares) : (double)NAN;
        power_law_a[k] = k > 0 ? limited(exp((logs.y - slope * logs.x) / logs.n)) : (double)NAN;
        power_law_b[k] = k > 0 ? limited(slope) : (double)NAN;
    }
}
