/* Asperity theories: every summit above the separation d is pressed alone, as in Hertz, by its
 * height over d. Lengths in sqrt(m0); s = kappa_m sqrt(3/m4) is the mean curvature of a summit,
 * rho = (kappa_1 - kappa_2)/(kappa_1 + kappa_2) in [0, 1) its elongation. */
#include "core/theory/asperities.h"
#include "core/theory/contact.h"
#include "core/theory/nayak.h"
#include "core/theory/quadrature.h"
#include <float.h>
#include <gsl/gsl_roots.h>
#include <gsl/gsl_sf_ellint.h>
#include <gsl/gsl_sf_erf.h>
#include <math.h>
#include <stdbool.h>

/* An integrand is negligible in double precision where it is exp(-DEPTH) of its peak. */
static const double DEPTH = 42;

/* Returns E[max(0, t - x)] of a standard normal t. */
static double first_moment(double x) {
    double density = M_SQRT1_2 / sqrt(M_PI) * exp(-x * x / 2);
    if (x < 5)
        return density - x * erfc(x * M_SQRT1_2) / 2;
    return density > 0 ? density * (1 - x / gsl_sf_hazard(x)) : 0;
}

/* Returns E[max(0, t - x)^(3/2)], t standard normal, by the trapezoidal rule, which converges
 * geometrically for entire integrands. Where hardly any t lies below x, that is the mean over t
 * itself. Elsewhere, with t - x = u^2, it is the integral over all u of
 * u^4 exp(-(u^2 + x)^2/2)/sqrt(2 pi). */
static double three_halves_moment(double x) {
    double reach = sqrt(2 * DEPTH), sum = 0;
    if (x < -12) {
        double step = reach / 14;
        for (int n = -14; n <= 14; n++)
            sum += pow(n * step - x, 1.5) * exp(-n * step * n * step / 2);
        return M_SQRT1_2 / sqrt(M_PI) * step * sum;
    }
    double step = 0.35 / sqrt(5 + fabs(x));
    double highest = x > 0 ? 2 * DEPTH / (sqrt(x * x + 2 * DEPTH) + x) : reach - x;
    int nodes = (int)(sqrt(highest) / step);
    for (int n = 1; n <= nodes; n++) {
        double square = n * step * n * step;
        sum += square * square * exp(-(square + x) * (square + x) / 2);
    }
    return M_SQRT2 / sqrt(M_PI) * step * sum; /* both signs of u */
}

/* --- Greenwood & Williamson (1966) with McCool's (1986) parameters (F13.4) --- */

struct spheres {
    double mean, deviation; /* of summit heights */
    double load, area;      /* factors of the moments */
};

static struct spheres spheres_of(double alpha) {
    double deviation = sqrt(nayak_summit_variance(alpha));
    double force = 4 / (18 * M_PI * sqrt(3)) * sqrt(3 * sqrt(M_PI) / 16);
    return (struct spheres){.mean = nayak_summit_mean(alpha),
                            .deviation = deviation,
                            .load = force * pow(alpha * deviation * deviation, 0.75),
                            .area = sqrt(3 * M_PI * alpha) / 48 * deviation};
}

static struct asperity_contact spheres_contact(const void *theory, double separation) {
    const struct spheres *t = theory;
    double x = (separation - t->mean) / t->deviation;
    return (struct asperity_contact){t->load * three_halves_moment(x), t->area * first_moment(x)};
}

/* Bush, Gibson & Thomas (1975). A summit of compression w and curvatures (s, rho) has the area
 * pi w/kappa_m f(rho) and the force (4/3) E* w^(3/2) kappa_m^(-1/2) g(rho). With the semi-axes'
 * lambda = (a - b)/(a + b), m = lambda^2, and the complete elliptic integrals B(m), D(m)
 * (K = B + D, E = B + (1 - m) D), Hertz's solution (Johnson 1985, ch. 4) becomes by Landen's
 * transformation, free of cancellation,
 *   rho = lambda (2 B + (1 - m) D)/N,  N = (1 + m) B + (1 - m) D,
 *   f = N/((1 - m) K),                 g = (pi/2) sqrt(N/K)/((1 - m) K).
 * Their densities, (1 - rho^2) rho exp(-s^2 rho^2/2) s^4 drho, are those of Longuet-Higgins (1957):
 * kappa_1 - kappa_2 is independent of height and mean curvature but for the factor
 * kappa_1 kappa_2. */

struct asperity_ellipse asperity_ellipse_at(double theta) {
    double lambda = tanh(theta / 2), less = 2 / (1 + exp(theta)); /* 1 - lambda */
    double m = lambda * lambda, rest = less * (1 + lambda);       /* 1 - m */
    double b = rest * gsl_sf_ellint_RD(0, 1, rest, GSL_PREC_DOUBLE) / 3;
    double d = rest * gsl_sf_ellint_RD(0, rest, 1, GSL_PREC_DOUBLE) / 3;   /* (1 - m) D */
    double n = (1 + m) * b + d, first = rest * b + d;                      /* first = (1 - m) K */
    double slope = (rest * b * b + (3 + m) * b * d + 2 * d * d) / (n * n); /* drho/dlambda */
    return (struct asperity_ellipse){.elongation = lambda * (2 * b + d) / n,
                                     .roundness = less * (less * b + d) / n,
                                     .rate = rest / 2 * slope,
                                     .area = n / first,
                                     .load = M_PI_2 * sqrt(n * rest / first) / first};
}

void asperity_shapes_fill(struct asperity_shapes *shapes) {
    /* b/a = exp(-theta): as functions of theta the logarithms of thin ellipses are straight. Panels
     * grow from the round shapes, which alone matter at high curvature; exp(-3 theta) is negligible
     * at the end. */
    static const double ENDS[ASPERITY_PANELS + 1] = {0, 0.06, 0.3, 1.2, 4, 12.5};
    for (size_t panel = 0; panel < ASPERITY_PANELS; panel++) {
        double theta[QUADRATURE_NODES], weight[QUADRATURE_NODES];
        quadrature_panel(ENDS[panel], ENDS[panel + 1], theta, weight);
        for (size_t node = 0; node < QUADRATURE_NODES; node++) {
            size_t n = panel * QUADRATURE_NODES + node;
            const struct asperity_ellipse ellipse = asperity_ellipse_at(theta[node]);
            double rho = ellipse.elongation;
            double measure = weight[node] * ellipse.rate * ellipse.roundness * (1 + rho) * rho;
            shapes->square[n] = rho * rho;
            shapes->area[n] = measure * ellipse.area;
            shapes->load[n] = measure * ellipse.load;
        }
    }
}

struct asperity_contact asperity_shapes_at(const struct asperity_shapes *shapes, double s) {
    struct asperity_contact sum = {0, 0};
    for (size_t n = 0; n < ASPERITY_SHAPES; n++) {
        double exponent = s * s / 2 * shapes->square[n];
        if (exponent > DEPTH)
            break;
        double share = exp(-exponent);
        sum.area += shapes->area[n] * share;
        sum.load += shapes->load[n] * share;
    }
    return sum;
}

/* Given s, heights are normal about rise s with the deviation below. The density of s itself is
 * sqrt(3/pi)/2 exp(-s^2/4) times that of its shapes (nayak.c). */
struct ellipses {
    struct asperity_shapes shapes;
    double c1, rise, deviation;
    double load, area; /* factors of the integrals over s */
};

static void ellipses_fill(struct ellipses *t, double alpha) {
    asperity_shapes_fill(&t->shapes);
    t->c1 = alpha / (2 * alpha - 3);
    t->rise = sqrt(3 / (4 * alpha));
    t->deviation = sqrt(0.5 / t->c1);
    double density = sqrt(3 / M_PI) / 2;
    double force = 4 * sqrt(sqrt(3)) / (18 * M_PI * sqrt(6));
    t->load = density * force * pow(alpha * t->deviation * t->deviation, 0.75);
    t->area = density * sqrt(alpha) / 6 * t->deviation;
}

/* Returns both integrands over s, already integrated over heights and shapes. */
static struct asperity_contact ellipses_of_curvature(const struct ellipses *t, double separation,
                                                     double s) {
    struct asperity_contact shapes = asperity_shapes_at(&t->shapes, s);
    double x = (separation - t->rise * s) / t->deviation;
    double common = s * s * s * exp(-s * s / 4);
    return (struct asperity_contact){shapes.load * common * sqrt(s) * three_halves_moment(x),
                                     shapes.area * common * first_moment(x)};
}

/* ellipses_add adds the integrals between two curvatures. Their integrands change around the
 * curvature `turn`, whose mean height is the separation, over a width that is small for alpha near
 * 3/2. So panels grow away from it, from width to longest. Their variable is sqrt(s), for the load
 * starts as s^(7/2). */
struct curvature_range {
    double from, to, turn, width, longest;
};
static void ellipses_add(const struct ellipses *t, double separation, struct curvature_range range,
                         struct asperity_contact *sum) {
    double sign = range.to > range.from ? 1 : -1, at = range.from;
    while (sign * (range.to - at) > 0) {
        double length = fmin(range.longest, range.width + fabs(at - range.turn));
        double next = sign * fmin(sign * range.to, sign * at + length);
        double root[QUADRATURE_NODES], weight[QUADRATURE_NODES];
        quadrature_panel(sqrt(fmin(at, next)), sqrt(fmax(at, next)), root, weight);
        for (size_t node = 0; node < QUADRATURE_NODES; node++) {
            struct asperity_contact part =
                ellipses_of_curvature(t, separation, root[node] * root[node]);
            sum->load += 2 * root[node] * weight[node] * part.load;
            sum->area += 2 * root[node] * weight[node] * part.area;
        }
        at = next;
    }
}

static struct asperity_contact ellipses_contact(const void *theory, double separation) {
    const struct ellipses *t = theory;
    if (separation > 40) /* exp(-d^2/2) underflows; farther out, panels would vanish in rounding */
        return (struct asperity_contact){0, 0};
    /* The integrand's exponent is -s^2/4 - C1 max(0, d - rise s)^2: for d > 0 it is -d^2/2 at its
     * peak s = 2 rise d, with the second derivative -C1 as far as the turn. */
    double turn = separation / t->rise, above = fmax(separation, 0);
    double peak = 2 * t->rise * above, reach = sqrt(2 * DEPTH / t->c1);
    double low = separation > 0 ? fmax(0, peak - reach) : 0;
    double high =
        separation > 0 && peak + reach < turn ? peak + reach : 2 * sqrt(above * above / 2 + DEPTH);
    double start = fmin(fmax(turn, low), high), width = 2 * t->deviation / t->rise;
    struct asperity_contact sum = {0, 0};
    ellipses_add(t, separation, (struct curvature_range){start, high, turn, width, 3.5}, &sum);
    ellipses_add(t, separation,
                 (struct curvature_range){start, low, turn, width, 2.5 / sqrt(t->c1)}, &sum);
    return (struct asperity_contact){t->load * sum.load, t->area * sum.area};
}

/* --- curves and their inversion, for both theories --- */

static bool in_domain(double alpha) {
    return alpha > 1.5 && isfinite(alpha);
}

void asperity_curve(asperity_contact_at *at, const void *theory, size_t n, const double *separation,
                    double *load, double *area) {
    for (size_t i = 0; i < n; i++) {
        struct asperity_contact contact = {NAN, NAN};
        if (theory != NULL && isfinite(separation[i]))
            contact = at(theory, separation[i]);
        load[i] = contact.load;
        area[i] = contact.area;
    }
}

void bgt_curve(double alpha, size_t n, const double *separation, double *load, double *area) {
    struct ellipses ellipses;
    if (in_domain(alpha))
        ellipses_fill(&ellipses, alpha);
    asperity_curve(ellipses_contact, in_domain(alpha) ? &ellipses : NULL, n, separation, load,
                   area);
}

void gw_mccool_curve(double alpha, size_t n, const double *separation, double *load, double *area) {
    struct spheres spheres = spheres_of(alpha);
    asperity_curve(spheres_contact, in_domain(alpha) ? &spheres : NULL, n, separation, load, area);
}

struct inversion {
    asperity_contact_at *at;
    const void *theory;
    double load, close;   /* required, and how near its logarithm must be */
    double closest, area; /* smallest |logarithm of the load over it| so far, the area there */
};

static double excess(double separation, void *context) {
    struct inversion *inversion = context;
    struct asperity_contact contact = inversion->at(inversion->theory, separation);
    /* Loads of Gaussian heights underflow at separations near 38. */
    double logarithm = log(fmax(contact.load, DBL_MIN) / inversion->load);
    if (fabs(logarithm) < inversion->closest) {
        inversion->closest = fabs(logarithm);
        inversion->area = contact.area;
    }
    return logarithm;
}

/* Finds the separation of the required load between one whose load is not below it and one whose
 * load is not above it. */
static void approach(struct inversion *inversion, double low, double high) {
    gsl_root_fsolver *solver = gsl_root_fsolver_alloc(gsl_root_fsolver_brent);
    if (solver == NULL)
        return;
    gsl_function function = {excess, inversion};
    int status = gsl_root_fsolver_set(solver, &function, low, high);
    for (int step = 0; status == 0 && inversion->closest > inversion->close && step < 100; step++)
        status = gsl_root_fsolver_iterate(solver);
    gsl_root_fsolver_free(solver);
}

/* Between these loads, separations of Gaussian heights are far from where loads underflow or
 * overflow, and below the last of these. */
static const double LEAST_LOAD = 1e-250, GREATEST_LOAD = 1e6, GAUSSIAN_MOST = 40;

double asperity_area_at_load(asperity_contact_at *at, const void *theory, double load,
                             double close) {
    if (!(load >= LEAST_LOAD && load <= GREATEST_LOAD))
        return NAN;
    struct inversion inversion = {at, theory, load, close, INFINITY, NAN};
    double low = 0, high = 0;
    while (excess(high, &inversion) > 0) {
        low = high;
        high = high < GAUSSIAN_MOST ? high + 1 : 2 * high;
    }
    while (excess(low, &inversion) < 0) {
        high = low;
        low = 2 * low - 1;
    }
    if (inversion.closest > close)
        approach(&inversion, low, high);
    return inversion.closest <= close ? inversion.area : NAN;
}

/* The fraction changes no faster than the load, so that its relative error is no larger. */
static const double CLOSE = 1e-12;

double bgt_area(double load, double alpha) {
    if (!in_domain(alpha))
        return NAN;
    struct ellipses ellipses;
    ellipses_fill(&ellipses, alpha);
    return asperity_area_at_load(ellipses_contact, &ellipses, load, CLOSE);
}

double gw_mccool_area(double load, double alpha) {
    if (!in_domain(alpha))
        return NAN;
    struct spheres spheres = spheres_of(alpha);
    return asperity_area_at_load(spheres_contact, &spheres, load, CLOSE);
}
