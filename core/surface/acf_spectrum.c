#include "core/surface/acf_spectrum.h"
#include <gsl/gsl_integration.h>
#include <gsl/gsl_interp.h>
#include <math.h>
#include <stdlib.h>

enum { NODES = 8 }; /* of Gauss and Legendre's rule, a panel */
/* A panel holds a third of a wave at most, of which the rule has all digits. */
static const double PANEL = 2;
enum { PANELS_MOST = 1000000 };

/* The correlation at the nodes of all panels, times their weights. */
struct nodes {
    size_t count;
    double *lag, *value; /* owned, together */
};

int acf_table_check(const struct acf_table *table, struct error *err) {
    if (table->n < 3 || table->lag[0] != 0 || table->correlation[0] != 1)
        return error_set(err, ERROR_INPUT,
                         "an autocorrelation begins with 1 at the lag 0, and has 3 lags at least");
    for (size_t a = 1; a < table->n; a++) {
        if (!(table->lag[a] > table->lag[a - 1]))
            return error_set(err, ERROR_INPUT, "lags must rise; number %zu, %g, does not", a,
                             table->lag[a]);
        if (!(fabs(table->correlation[a]) <= 1))
            return error_set(err, ERROR_INPUT, "correlation %zu = %g; allowed: [-1, 1]", a,
                             table->correlation[a]);
    }
    return 0;
}

static size_t panels_between(const struct acf_table *table, size_t a, double highest) {
    return (size_t)ceil((table->lag[a + 1] - table->lag[a]) * highest / PANEL) + 1;
}

/* Interpolates between the lags as Steffen (1990) does, which adds no extremes. */
static void nodes_fill(struct nodes *nodes, const struct acf_table *table, const gsl_interp *curve,
                       const gsl_integration_glfixed_table *rule, double highest) {
    size_t at = 0;
    for (size_t a = 0; a + 1 < table->n; a++) {
        size_t panels = panels_between(table, a, highest);
        double width = (table->lag[a + 1] - table->lag[a]) / (double)panels;
        for (size_t p = 0; p < panels; p++)
            for (size_t node = 0; node < NODES; node++, at++) {
                double low = table->lag[a] + (double)p * width, weight;
                (void)gsl_integration_glfixed_point(low, low + width, node, &nodes->lag[at],
                                                    &weight, rule);
                nodes->value[at] = weight * gsl_interp_eval(curve, table->lag, table->correlation,
                                                            nodes->lag[at], NULL);
            }
    }
}

static int nodes_create(struct nodes *nodes, const struct acf_table *table, double highest,
                        struct error *err) {
    double panels = 0;
    for (size_t a = 0; a + 1 < table->n; a++)
        panels += (table->lag[a + 1] - table->lag[a]) * highest / PANEL + 2;
    if (!(panels < PANELS_MOST))
        return error_set(err, ERROR_INPUT,
                         "the last lag holds %.3g of the shortest waves, which are too many",
                         table->lag[table->n - 1] * highest / (2 * M_PI));
    for (size_t a = 0; a + 1 < table->n; a++)
        nodes->count += NODES * panels_between(table, a, highest);
    nodes->lag = array_create(2 * nodes->count, sizeof *nodes->lag);
    gsl_interp *curve = gsl_interp_alloc(gsl_interp_steffen, table->n);
    gsl_integration_glfixed_table *rule = gsl_integration_glfixed_table_alloc(NODES);
    int status = nodes->lag != NULL && curve != NULL && rule != NULL
                     ? 0
                     : error_memory(err, 2 * nodes->count * sizeof *nodes->lag, "a transform");
    if (status == 0) {
        nodes->value = nodes->lag + nodes->count;
        (void)gsl_interp_init(curve, table->lag, table->correlation, table->n);
        nodes_fill(nodes, table, curve, rule, highest);
    }
    if (curve != NULL)
        gsl_interp_free(curve);
    if (rule != NULL)
        gsl_integration_glfixed_table_free(rule);
    return status;
}

static double transform_at(int dimension, const struct nodes *nodes, double k) {
    double sum = 0;
    for (size_t a = 0; a < nodes->count; a++)
        sum += nodes->value[a] *
               (dimension == 1 ? cos(k * nodes->lag[a]) : nodes->lag[a] * j0(k * nodes->lag[a]));
    return sum;
}

/* The variance at a wave number is the density times k on surfaces, by the rule of trapezoids. */
static double share_at(int dimension, size_t m, const double *k, size_t a) {
    double width = (a + 1 < m ? k[a + 1] : k[a]) - (a > 0 ? k[a - 1] : 0);
    return width / 2 * (dimension == 1 ? 1 : k[a]);
}

int acf_spectrum(int dimension, const struct acf_table *table, size_t m, const double *wave_number,
                 double *density, struct error *err) {
    struct nodes nodes = {0};
    double positive = 0, negative = 0, worst = 0, lowest = 0;
    int status = acf_table_check(table, err);
    if (status == 0)
        status = nodes_create(&nodes, table, wave_number[m - 1], err);
    for (size_t a = 0; a < m && status == 0; a++) {
        double value = transform_at(dimension, &nodes, wave_number[a]);
        double part = value * share_at(dimension, m, wave_number, a);
        *(part > 0 ? &positive : &negative) += fabs(part);
        if (part < lowest) {
            lowest = part;
            worst = wave_number[a];
        }
        density[a] = fmax(value, 0);
    }
    free(nodes.lag);
    if (status == 0 && !(negative <= ACF_NEGATIVE_MOST * positive))
        return error_set(err, ERROR_INPUT,
                         "no %s has this autocorrelation: its spectrum is negative for %.2g %% of "
                         "the variance, most near the wave number %.3g; allowed: %g %%",
                         dimension == 1 ? "profile" : "isotropic surface",
                         100 * negative / positive, worst, 100 * ACF_NEGATIVE_MOST);
    return status;
}
