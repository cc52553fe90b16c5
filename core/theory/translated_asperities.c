#include "core/theory/translated_asperities.h"
#include "core/theory/asperities.h"
#include "core/theory/quadrature.h"
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

/* Area and load are integrals over values of g, from the one whose height is the separation d on,
 * of area (f - d)/f' and load (f - d)^(3/2)/f'^(1/2); of spheres a constant stands for f'. `area`
 * and `load` are as smooth as the densities of g. They are kept at the nodes of panels, and are
 * polynomials in between. */
struct panel {
    double low, high;
    double node[QUADRATURE_NODES], area[QUADRATURE_NODES], load[QUADRATURE_NODES];
};
struct translated_asperities {
    struct translated_heights heights;
    size_t count;
    bool flattens; /* curvatures go with f' */
    bool has_area;
    double basis[QUADRATURE_NODES]; /* barycentric weights of a panel's nodes */
    struct panel *panels;           /* rising, without holes; owned */
};

/* Values of g from -SCORE_MOST to it. 1e-18 of all lie outside. */
static const double SCORE_MOST = 9;

/* --- panels --- */

static int panels_create(struct translated_asperities *t, const struct translated_surface *surface,
                         struct error *err) {
    double at = -SCORE_MOST, weight[QUADRATURE_NODES];
    while (at < SCORE_MOST) {
        at = translated_panel_end(surface, at, SCORE_MOST);
        t->count++;
    }
    t->panels = array_create(t->count, sizeof *t->panels);
    if (t->panels == NULL)
        return error_memory(err, t->count * sizeof *t->panels, "summits of a law of heights");
    at = -SCORE_MOST;
    for (size_t p = 0; p < t->count; p++) {
        struct panel *panel = &t->panels[p];
        panel->low = at;
        panel->high = at = translated_panel_end(surface, at, SCORE_MOST);
        quadrature_panel(panel->low, panel->high, panel->node, weight);
    }
    return 0;
}

static void basis_fill(double *basis) {
    double node[QUADRATURE_NODES], weight[QUADRATURE_NODES];
    quadrature_panel(-2, 2, node, weight); /* of capacity 1: products stay near 1 */
    for (size_t a = 0; a < QUADRATURE_NODES; a++) {
        basis[a] = 1;
        for (size_t b = 0; b < QUADRATURE_NODES; b++)
            basis[a] /= a == b ? 1 : node[a] - node[b];
    }
}

/* Returns the polynomials of a panel at a value of g. */
static struct asperity_contact between(const struct translated_asperities *t,
                                       const struct panel *panel, double score) {
    double area = 0, load = 0, all = 0;
    for (size_t q = 0; q < QUADRATURE_NODES; q++) {
        double distance = score - panel->node[q];
        if (distance == 0)
            return (struct asperity_contact){.area = panel->area[q], .load = panel->load[q]};
        double share = t->basis[q] / distance;
        area += share * panel->area[q];
        load += share * panel->load[q];
        all += share;
    }
    return (struct asperity_contact){.area = area / all, .load = load / all};
}

/* --- elliptic summits --- */

/* The density of height and curvature s of the summits of g (nayak.c), and the factors of Hertz's
 * area and load, are those of asperities.c. */
enum { CURVATURE_PANELS = 6 };

/* Returns the integrals over s, from 0, of the shapes' areas times s^3 and loads times s^(7/2),
 * with the density of s and of the height of g. Their variable is sqrt(s). */
static struct asperity_contact over_curvatures(const struct asperity_shapes *shapes,
                                               const struct translated_surface *surface,
                                               double score) {
    struct curvature_range range = translated_curvatures_at(surface, score);
    double alpha = surface->gaussian.nayak_alpha;
    double c1 = alpha / (2 * alpha - 3), rise = sqrt(3 / (4 * alpha));
    double from = sqrt(range.low), step = (sqrt(range.high) - from) / CURVATURE_PANELS;
    struct asperity_contact sum = {0, 0};
    for (int p = 0; p < CURVATURE_PANELS; p++) {
        double root[QUADRATURE_NODES], weight[QUADRATURE_NODES];
        quadrature_panel(from + p * step, from + (p + 1) * step, root, weight);
        for (size_t q = 0; q < QUADRATURE_NODES; q++) {
            double s = root[q] * root[q], away = score - rise * s;
            double common =
                2 * root[q] * weight[q] * s * s * s * exp(-s * s / 4 - c1 * away * away);
            struct asperity_contact shape = asperity_shapes_at(shapes, s);
            sum.area += common * shape.area;
            sum.load += common * root[q] * shape.load;
        }
    }
    double density = sqrt(3 / M_PI) / 2 * sqrt(c1 / M_PI);
    return (struct asperity_contact){.area = density * sum.area, .load = density * sum.load};
}

static void ellipses_fill(struct translated_asperities *t, const struct translated_surface *surface,
                          double slope_ratio) {
    double alpha = surface->gaussian.nayak_alpha;
    struct asperity_shapes shapes;
    asperity_shapes_fill(&shapes);
    double area = sqrt(alpha) / 6;
    double load = 4 * sqrt(sqrt(3)) / (18 * M_PI * sqrt(6)) * pow(alpha, 0.75) * slope_ratio;
    for (size_t p = 0; p < t->count; p++)
        for (size_t q = 0; q < QUADRATURE_NODES; q++) {
            struct panel *panel = &t->panels[p];
            struct asperity_contact at = over_curvatures(&shapes, surface, panel->node[q]);
            panel->area[q] = area * at.area;
            panel->load[q] = load * at.load;
        }
}

/* --- spheres --- */

static void spheres_fill(struct translated_asperities *t, const struct translated_surface *surface,
                         double slope_ratio) {
    double alpha = surface->gaussian.nayak_alpha, mean = nayak_summit_mean(alpha);
    double variance = nayak_summit_variance(alpha);
    /* the mean curvature of summits of z over f' = 1 times that of g */
    double bent = translated_summits_expectation(surface).curvature / translated_stretch(surface) /
                  nayak_overall_curvature();
    double area = sqrt(3 * M_PI * alpha) / 48 / bent;
    double load = 4 / (18 * M_PI * sqrt(3)) * sqrt(3 * sqrt(M_PI) / 16) * pow(alpha, 0.75) /
                  sqrt(bent) * slope_ratio;
    for (size_t p = 0; p < t->count; p++)
        for (size_t q = 0; q < QUADRATURE_NODES; q++) {
            struct panel *panel = &t->panels[p];
            double away = panel->node[q] - mean;
            double density = exp(-away * away / (2 * variance)) / sqrt(2 * M_PI * variance);
            panel->area[q] = area * density;
            panel->load[q] = load * density;
        }
}

/* --- integrals over summits --- */

/* Adds the summits of a panel between two values of g, whose height is at least d. */
static void part_add(const struct translated_asperities *t, const struct panel *panel, double from,
                     double to, double d, struct asperity_contact *sum) {
    double root[QUADRATURE_NODES], weight[QUADRATURE_NODES];
    quadrature_panel(0, sqrt(to - from), root, weight);
    for (size_t q = 0; q < QUADRATURE_NODES; q++) {
        double score = from + root[q] * root[q];
        struct height_slope z = translated_heights_at(&t->heights, score);
        double over = fmax(z.height - d, 0), slope = t->flattens ? fmax(z.slope, 0) : 1;
        struct asperity_contact at = between(t, panel, score);
        double factor = 2 * root[q] * weight[q] * over;
        sum->area += factor * at.area / slope;
        sum->load += slope > 0 ? factor * at.load * sqrt(over / slope) : 0;
    }
}

/* Adds the summits of a panel above `from`. The variable of a part is the square root of the
 * distance from its lower end: loads begin with the power 3/2 of it. Parts are short, as slopes of
 * heights that are given by numbers have kinks. */
enum { PARTS = 4 };
static void panel_add(const struct translated_asperities *t, const struct panel *panel, double from,
                      double d, struct asperity_contact *sum) {
    double step = (panel->high - from) / PARTS;
    for (int p = 0; p < PARTS; p++)
        part_add(t, panel, from + p * step, p + 1 < PARTS ? from + (p + 1) * step : panel->high, d,
                 sum);
}

static struct asperity_contact contact_at(const void *theory, double separation) {
    const struct translated_asperities *t = theory;
    double first = translated_heights_inverse(&t->heights, separation);
    struct asperity_contact sum = {0, 0};
    for (size_t p = 0; p < t->count; p++)
        if (t->panels[p].high > first)
            panel_add(t, &t->panels[p], fmax(first, t->panels[p].low), separation, &sum);
    if (!t->has_area)
        sum.area = NAN;
    return sum;
}

/* The area of all summits above the mean plane converges where the last ones add nothing. */
static const double LAST_FROM = 8.5, LAST_MOST = 1e-6;

static bool area_converges(const struct translated_asperities *t) {
    struct asperity_contact all = {0, 0}, last = {0, 0};
    double first = translated_heights_inverse(&t->heights, 0);
    for (size_t p = 0; p < t->count; p++) {
        const struct panel *panel = &t->panels[p];
        if (panel->high > first)
            panel_add(t, panel, fmax(first, panel->low), 0, &all);
        if (panel->high > LAST_FROM)
            panel_add(t, panel, fmax(LAST_FROM, panel->low), 0, &last);
    }
    return isfinite(all.area) && last.area <= LAST_MOST * all.area;
}

/* --- the theories --- */

int translated_asperities_create(struct translated_asperities **out,
                                 const struct translated_surface *surface,
                                 enum translated_theory theory, struct error *err) {
    struct translated_asperities *t = array_create(1, sizeof *t);
    if (t == NULL)
        return error_memory(err, sizeof *t, "summits of a law of heights");
    const struct moments *g = &surface->gaussian, *z = &surface->reached;
    t->heights = surface->heights;
    int status = panels_create(t, surface, err);
    if (status != 0) {
        translated_asperities_destroy(&t);
        return status;
    }
    basis_fill(t->basis);
    /* the slope of g, were its deviation that of z, over that of z */
    double slope_ratio = sqrt(z->m0 / g->m0 * (g->m2 / z->m2));
    if (theory == TRANSLATED_BGT)
        ellipses_fill(t, surface, slope_ratio);
    else
        spheres_fill(t, surface, slope_ratio);
    t->flattens = theory == TRANSLATED_BGT;
    t->has_area = area_converges(t);
    *out = t;
    return 0;
}

void translated_asperities_destroy(struct translated_asperities **asperities) {
    if (*asperities == NULL)
        return;
    free((*asperities)->panels);
    free(*asperities);
    *asperities = NULL;
}

void translated_asperities_curve(const struct translated_asperities *asperities, size_t n,
                                 const double *separation, double *load, double *area) {
    asperity_curve(contact_at, asperities, n, separation, load, area);
}

double translated_asperities_area(const struct translated_asperities *asperities, double load) {
    static const double CLOSE = 1e-9; /* near a bound separations have few digits of the load */
    return load >= 1e-15 ? asperity_area_at_load(contact_at, asperities, load, CLOSE) : NAN;
}
