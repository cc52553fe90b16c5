#include "core/statistics/angular_spectrum.h"
#include <math.h>

/* Under Hann's window waves beside each other are alike; this many count as one along an axis:
 * 1 + 2 (2/3)^2 + 2 (1/6)^2. */
static const double ALIKE_WINDOWED = 35.0 / 18;

struct sector {
    double power, expected, squares; /* squares of what is expected */
};

/* The half turn begins half a sector before -pi/2, so that both axes are in the middle of one. */
static size_t sector_of(double x, double y) {
    double turn = atan2(y, x) / M_PI + 0.5 + 0.5 / ANGULAR_SECTORS;
    return (size_t)(turn * ANGULAR_SECTORS) % ANGULAR_SECTORS;
}

/* cell: what densities are of a mode's power. */
static void mode_add(const struct map_spectrum *s, size_t mx, long my, double cell,
                     struct sector sectors[ANGULAR_KINDS][ANGULAR_SECTORS]) {
    const struct grid *grid = &s->modes.grid;
    double x = (double)mx * (s->side / grid->lx), y = (double)my * (s->side / grid->ly);
    size_t ring = (size_t)(hypot(x, y) + 0.5);
    if (ring < 1 || ring >= s->rings)
        return;
    double power = modes_power(&s->modes, mx, my) * cell / s->power, expected = s->density[ring];
    for (int kind = 0; kind < ANGULAR_KINDS; kind++) {
        struct sector *sector = &sectors[kind][sector_of(x, y)];
        double weight = kind == ANGULAR_SLOPES ? x * x + y * y : 1;
        sector->power += weight * power;
        sector->expected += weight * expected;
        sector->squares += weight * expected * weight * expected;
    }
}

void angular_spectrum_measure(const struct map_spectrum *s, struct angular_spectrum *out) {
    const struct grid *grid = &s->modes.grid;
    struct sector sectors[ANGULAR_KINDS][ANGULAR_SECTORS] = {0};
    long most_y = (long)(grid->ny - 1) / 2;
    double cell = grid->lx * grid->ly / (4 * M_PI * M_PI);
    for (size_t mx = 0; 2 * mx < grid->nx; mx++)
        for (long my = mx > 0 ? -most_y : 1; my <= most_y; my++)
            mode_add(s, mx, my, cell, sectors);
    double alike = s->windowed ? ALIKE_WINDOWED * ALIKE_WINDOWED : 1;
    for (size_t n = 0; n < ANGULAR_SECTORS; n++) {
        out->angle[n] = M_PI * ((double)n / ANGULAR_SECTORS - 0.5);
        for (int kind = 0; kind < ANGULAR_KINDS; kind++) {
            const struct sector *sector = &sectors[kind][n];
            double power = sector->expected > 0 ? sector->power / sector->expected : (double)NAN;
            out->power[kind][n] = power;
            out->error[kind][n] = power * sqrt(alike * sector->squares) / sector->expected;
        }
    }
}

double angular_spectrum_peak(const struct angular_spectrum *spectrum) {
    double angle = (double)NAN, most = -INFINITY;
    for (size_t n = 0; n < ANGULAR_SECTORS; n++)
        if (spectrum->power[ANGULAR_HEIGHTS][n] > most) {
            most = spectrum->power[ANGULAR_HEIGHTS][n];
            angle = spectrum->angle[n];
        }
    return angle;
}
