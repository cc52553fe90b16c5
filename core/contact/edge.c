#include "core/contact/edge.h"
#include "core/contact/contact.h"
#include <math.h>

static const double PI = 3.14159265358979323846;

/* One wave over so many steps, pressed to this part of the pressure of full contact. Neither
 * matters as long as the edges are far from each other; a longer wave would show the error of the
 * model's compliance at long waves, a shorter one the curvature of the pressure. */
enum { WAVE_STEPS = 128 };
static const double WAVE_LOAD = 0.4;

double edge_guess(double pressure_squared, double gap_rise) {
    /* s = ratio (1 - s)^3, solved for 1 - s by the hyperbolic form of Cardano's formula. */
    double ratio = pressure_squared / (gap_rise * gap_rise * gap_rise), k = sqrt(3 * ratio);
    if (!(k < 1e150))
        return 1;
    double rest = k > 1e-8 ? 2 / k * sinh(asinh(1.5 * k) / 3) : 1;
    return fmin(1, ratio * rest * rest * rest);
}

double edge_share(const struct edge_law *law, double guess) {
    double root = sqrt(guess);
    size_t low = 0, high = EDGE_PHASES - 1;
    if (!(root > law->root[low]))
        return law->share[low];
    if (!(root < law->root[high]))
        return law->share[high];
    while (high - low > 1) {
        size_t middle = (low + high) / 2;
        if (law->root[middle] <= root)
            low = middle;
        else
            high = middle;
    }
    double part = (root - law->root[low]) / (law->root[high] - law->root[low]);
    return law->share[low] + part * (law->share[high] - law->share[low]);
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

/* Presses the wave with its crest `phase` steps beyond a node, and finds the edge on its right. */
static int sample(struct contact *contact, const struct grid *strip, double phase, double *guess,
                  double *share, struct error *err) {
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
    if (inside + 1 == WAVE_STEPS)
        return error_set(err, ERROR_NUMERIC, "a single wave did not open");
    double rise = cbrt(0.75 * fmax(0, state.opening[inside + 1]) / step);
    double edge = WAVE_STEPS / PI * asin(sqrt(WAVE_LOAD)); /* Westergaard (1939) */
    *guess = edge_guess(state.p[inside] * state.p[inside], rise * rise);
    *share = phase + edge - (double)inside;
    return 0;
}

/* By insertion; samples come nearly in order. */
static void sort(struct edge_law *law) {
    for (size_t a = 1; a < EDGE_PHASES; a++)
        for (size_t b = a; b > 0 && law->share[b] < law->share[b - 1]; b--) {
            double root = law->root[b], share = law->share[b];
            law->root[b] = law->root[b - 1];
            law->share[b] = law->share[b - 1];
            law->root[b - 1] = root;
            law->share[b - 1] = share;
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
        double guess;
        status = sample(contact, &strip, (double)a / EDGE_PHASES, &guess, &out->share[a], err);
        out->root[a] = sqrt(guess);
    }
    contact_destroy(&contact);
    compliance_destroy(&compliance);
    if (status != 0)
        return error_context(err, "law of contact edges");
    sort(out);
    return 0;
}
