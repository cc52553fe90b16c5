#include "core/contact/edge.h"
#include "core/contact/contact.h"
#include <math.h>

static const double PI = 3.14159265358979323846;

/* The wave has WAVE_STEPS grid points and is pressed to WAVE_LOAD of the pressure of full contact.
 * Neither matters as long as the edges are far from each other; a longer wave would show the error
 * of the model's compliance at long waves, a shorter one the curvature of the pressure. */
enum { WAVE_STEPS = 128 };
static const double WAVE_LOAD = 0.4;
static const double BEND_MOST = 0.5;
enum { BEND_STEPS = 2, ANGLE_STEPS = 40 };

double edge_guess(double pressure_squared, double gap_rise) {
    /* Solves s = ratio (1 - s)^3 for 1 - s by the hyperbolic form of Cardano's formula. */
    double ratio = pressure_squared / (gap_rise * gap_rise * gap_rise), k = sqrt(3 * ratio);
    if (!(k < 1e150))
        return 1;
    double rest = k > 1e-8 ? 2 / k * sinh(asinh(1.5 * k) / 3) : 1;
    return fmin(1, ratio * rest * rest * rest);
}

/* Interpolates values of the law at a root; outside of the samples the nearest one counts. */
static double interpolate(const struct edge_law *law, const double *values, double root) {
    size_t low = 0, high = EDGE_PHASES - 1;
    if (!(root > law->root[low]))
        return values[low];
    if (!(root < law->root[high]))
        return values[high];
    while (high - low > 1) {
        size_t middle = (low + high) / 2;
        if (law->root[middle] <= root)
            low = middle;
        else
            high = middle;
    }
    double part = (root - law->root[low]) / (law->root[high] - law->root[low]);
    return values[low] + part * (values[high] - values[low]);
}

double edge_share(const struct edge_law *law, double pressure_squared, double before,
                  double gap_rise) {
    double root = sqrt(edge_guess(pressure_squared, gap_rise));
    double share = interpolate(law, law->share, root);
    if (!(before > 0))
        return share;
    /* p^2 = c^2 d (1 + bend d): the law holds for c^2 d. */
    for (int a = 0; a < BEND_STEPS; a++) {
        double straight = interpolate(law, law->before, root) * pressure_squared;
        double bend = fmin(fmax(before / straight - 1, -BEND_MOST), BEND_MOST);
        root = sqrt(edge_guess(pressure_squared / (1 + bend * fmax(0, share)), gap_rise));
        share = interpolate(law, law->share, root);
    }
    return share;
}

/* t with sinh(2t)/2 - t = y >= 0, by Newton's method from above, where it is monotone. */
static double hertz_angle(double y) {
    double t = fmin(cbrt(1.5 * y), 0.5 * asinh(4 * y + 4));
    for (int a = 0; a < ANGLE_STEPS && t > 0; a++) {
        double sine = sinh(t), step = (0.5 * sinh(2 * t) - t - y) / (2 * sine * sine);
        t -= step;
        if (!(fabs(step) > 1e-12 * t))
            break;
    }
    return t;
}

double edge_lone(double force, double gap_left, double gap_right) {
    /* At a distance x = a cosh t from the middle of a contact of half-width a the gap is
     * (2 force/(pi E*)) (sinh(2t)/2 - t) (Johnson 1985, section 4.2); the two nodes are 2 steps
     * apart. */
    double scale = PI / (2 * force);
    return 2 / (cosh(hertz_angle(scale * fmax(0, gap_left))) +
                cosh(hertz_angle(scale * fmax(0, gap_right))));
}

/* r >= 1 with r ((r^2 - 2) acos(1/r) + sqrt(r^2 - 1)) = y >= 0, by Newton's method from above,
 * where it is monotone. */
static double hertz_ratio(double y) {
    double r = 2 + cbrt(y);
    for (int a = 0; a < ANGLE_STEPS && r > 1; a++) {
        double angle = acos(1 / r), root = sqrt((r - 1) * (r + 1));
        double value = r * ((r * r - 2) * angle + root) - y;
        double step = value / ((3 * r * r - 2) * angle + 3 * root);
        r -= step;
        if (!(fabs(step) > 1e-12 * r))
            break;
    }
    return fmax(1, r);
}

double edge_lone_axis(double force, double gap_left, double gap_right) {
    /* At a distance r a from the middle of a contact of radius a the gap is (3 force/(4 pi E* a))
     * ((r^2 - 2) acos(1/r) + sqrt(r^2 - 1)) (Johnson 1985, section 3.4). */
    double scale = 4 * PI / (3 * force);
    return 2 / (hertz_ratio(scale * fmax(0, gap_left)) + hertz_ratio(scale * fmax(0, gap_right)));
}

/* A strip of the grid with one wave along x, two nodes wide where the grid is a surface. */
static struct grid strip_of(const struct grid *grid, bool columns) {
    double along = columns ? grid_dy(grid) : grid_dx(grid);
    double across = columns ? grid_dx(grid) : grid_dy(grid);
    bool profile = grid_is_profile(grid);
    return (struct grid){.nx = WAVE_STEPS,
                         .ny = profile ? 1 : 2,
                         .lx = WAVE_STEPS * along,
                         .ly = profile ? WAVE_STEPS * along : 2 * across};
}

/* Presses the wave with its crest `phase` steps beyond a node, and measures the edge on its right.
 */
static int sample(struct contact *contact, const struct grid *strip, double phase, double *root,
                  double *before, double *share, struct error *err) {
    double z[2 * WAVE_STEPS], step = grid_dx(strip), amplitude = step;
    struct contact_state state;
    for (size_t j = 0; j < strip->ny; j++)
        for (size_t i = 0; i < WAVE_STEPS; i++)
            z[j * WAVE_STEPS + i] = amplitude * cos(2 * PI * ((double)i - phase) / WAVE_STEPS);
    int status = contact_begin(contact, z, err);
    if (status == 0)
        status = contact_press(contact, WAVE_LOAD * PI * amplitude / strip->lx, &state, err);
    if (status != 0)
        return status;
    size_t inside = 0;
    while (inside + 1 < WAVE_STEPS && state.p[inside + 1] > 0)
        inside++;
    if (inside == 0 || inside + 1 == WAVE_STEPS)
        return error_set(err, ERROR_NUMERIC, "the edge of a single wave was not found");
    double rise = cbrt(0.75 * fmax(0, state.opening[inside + 1]) / step);
    double edge = WAVE_STEPS / PI * asin(sqrt(WAVE_LOAD)); /* Westergaard (1939) */
    double p = state.p[inside], next = state.p[inside - 1];
    *root = sqrt(edge_guess(p * p, rise * rise));
    *before = next * next / (p * p);
    *share = phase + edge - (double)inside;
    return 0;
}

static void swap(double *values, size_t a, size_t b) {
    double value = values[a];
    values[a] = values[b];
    values[b] = value;
}

/* Sorts by insertion, since samples come nearly in order. */
static void sort(struct edge_law *law) {
    for (size_t a = 1; a < EDGE_PHASES; a++)
        for (size_t b = a; b > 0 && law->share[b] < law->share[b - 1]; b--) {
            swap(law->root, b, b - 1);
            swap(law->before, b, b - 1);
            swap(law->share, b, b - 1);
        }
    for (size_t a = 1; a < EDGE_PHASES; a++)
        law->root[a] = fmax(law->root[a], law->root[a - 1]);
}

int edge_law_make(const struct grid *grid, const struct block *block, bool columns,
                  struct edge_law *out, struct error *err) {
    struct grid strip = strip_of(grid, columns);
    struct block deep = *block;
    struct compliance *compliance = NULL;
    struct contact *contact = NULL;
    deep.height = block->model == MODEL_HALFSPACE ? INFINITY : 1.5 * strip.lx;
    int status = compliance_create(&compliance, &strip, &deep, err);
    if (status == 0)
        status = contact_create(&contact, compliance, &CONTACT_DEFAULTS, err);
    for (size_t a = 0; status == 0 && a < EDGE_PHASES; a++) {
        status = sample(contact, &strip, (double)a / EDGE_PHASES, &out->root[a], &out->before[a],
                        &out->share[a], err);
    }
    contact_destroy(&contact);
    compliance_destroy(&compliance);
    if (status != 0)
        return error_context(err, "law of contact edges");
    sort(out);
    return 0;
}
