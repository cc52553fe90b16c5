#include "jobs/surface/surface_grooves.h"
#include <math.h>
#include <stdlib.h>

static const char PERIOD[] = "/surface/grooves/period", ANGLE[] = "/surface/grooves/angle",
                  CROSS[] = "/surface/grooves/cross_angle", DEPTH[] = "/surface/grooves/depth",
                  SHAPE[] = "/surface/grooves/shape", AMPLITUDES[] = "/surface/grooves/amplitudes",
                  PHASES[] = "/surface/grooves/phases", PHASE[] = "/surface/grooves/phase";
static const double DEGREE = M_PI / 180;

/* Reads one family: whole numbers of periods along both sides, to OFF of a period. A fault names
 * the nearest grooves that have them. */
static void read_family(const struct grid *grid, struct values *values, const char *path,
                        double period, double degrees, struct grooves *out) {
    static const double OFF = 1e-3, ROUNDING = 1e-12;
    const bool profile = grid_is_profile(grid);
    const double angle = degrees * DEGREE, ly = profile ? 1 : grid->ly;
    const bool along_y = fabs(cos(angle)) < ROUNDING, along_x = fabs(sin(angle)) < ROUNDING;
    const double x = along_x ? 0 : sin(angle) / period;
    const double y = profile || along_y ? 0 : -cos(angle) / period;
    struct groove_fit fit = groove_fit_cell(x, y, grid->lx, ly);
    if (fit.along_x == 0 && fit.along_y == 0) {
        fit.along_x = fabs(x) * grid->lx >= fabs(y) * ly ? copysign(1, x) : 0;
        fit.along_y = fit.along_x == 0 ? copysign(1, y) : 0;
        fit.off = 1;
    }
    const double wave_x = fit.along_x / grid->lx, wave_y = fit.along_y / ly;
    const double near_angle = remainder(atan2(wave_x, -wave_y), M_PI) / DEGREE;
    out->wave_x[out->families] = wave_x;
    out->wave_y[out->families++] = wave_y;
    if (fit.off > OFF && profile)
        values_fault(values, path,
                     "%g: the cell, %g lambda_s, has %.6g periods; allowed: whole numbers, the "
                     "nearest is period %.10g (%g periods)",
                     period, grid->lx, fabs(x) * grid->lx, 1 / wave_x, fit.along_x);
    else if (fit.off > OFF)
        values_fault(
            values, path,
            "period %g at %g degrees: the cell, %g by %g lambda_s, has %.6g periods along x "
            "and %.6g along y; allowed: whole numbers, the nearest is period %.10g at "
            "%.10g degrees (%g along x, %g along y)",
            period, degrees, grid->lx, ly, fabs(x) * grid->lx, fabs(y) * ly,
            1 / hypot(wave_x, wave_y), near_angle, fabs(fit.along_x), fabs(fit.along_y));
}

static int read_harmonics(struct values *values, struct groove_profile *out, struct error *err) {
    double *amplitude = NULL, *phase = NULL;
    size_t count = 0, phases = 0;
    struct error reason = {0};
    int status = values_numbers(values, AMPLITUDES, &amplitude, &count, err);
    if (status == 0)
        status = values_numbers(values, PHASES, &phase, &phases, err);
    for (size_t h = 0; h < phases && phase != NULL; h++)
        phase[h] *= DEGREE;
    if (status == 0 && amplitude == NULL)
        values_fault(values, AMPLITUDES, "the shape harmonics needs its amplitudes");
    else if (status == 0 && phase != NULL && phases != count)
        values_fault(values, PHASES, "%zu of them, and %zu amplitudes; allowed: as many of each",
                     phases, count);
    else if (status == 0) {
        double none[GROOVE_HARMONICS_MOST] = {0};
        if (groove_profile_of_harmonics(out, count, amplitude, phase != NULL ? phase : none,
                                        &reason) != 0)
            values_fault(values, AMPLITUDES, "%s", reason.text);
    }
    free(amplitude);
    free(phase);
    return status;
}

/* What belongs to grooves alone is refused without them. */
static bool are_asked(struct values *values) {
    static const char *const PATHS[] = {DEPTH, ANGLE, CROSS, SHAPE, AMPLITUDES, PHASES, PHASE};
    if (values_is_given(values, PERIOD))
        return true;
    for (size_t p = 0; p < sizeof PATHS / sizeof *PATHS; p++)
        if (values_is_given(values, PATHS[p]))
            values_fault(values, PATHS[p], "belongs to grooves, which need their period and depth");
    return false;
}

static void check_directions(const struct grid *grid, struct values *values, double angle,
                             double cross) {
    if (grid_is_profile(grid) && !isnan(angle))
        values_fault(values, ANGLE, "%g: profiles have one direction", angle);
    if (grid_is_profile(grid) && !isnan(cross))
        values_fault(values, CROSS, "%g: profiles have one direction", cross);
    if (!isnan(cross) && fabs(remainder(cross - (isnan(angle) ? 90 : angle), 180)) < 1e-6)
        values_fault(values, CROSS, "%g: both families have the same direction", cross);
}

static void check_period(const struct grid *grid, struct values *values, double period) {
    static const double POINTS_LEAST = 4;
    const double dx = grid_dx(grid);
    if (!(period >= POINTS_LEAST * dx * (1 - 1e-9)))
        values_fault(values, PERIOD,
                     "%g: the grid has %g points a period; allowed: at least %g, a period of %g",
                     period, period / dx, POINTS_LEAST, POINTS_LEAST * dx);
}

int surface_grooves_read(struct grooves **out, const struct grid *grid, bool translated,
                         struct values *values, struct error *err) {
    const size_t before = values_fault_count(values);
    if (!are_asked(values))
        return 0;
    const double period = values_number(values, PERIOD), angle = values_number(values, ANGLE);
    const double cross = values_number(values, CROSS), depth = values_number(values, DEPTH);
    if (isnan(depth))
        values_fault(values, DEPTH, "grooves need their depth, in RMS heights of the random part");
    check_directions(grid, values, angle, cross);
    if (translated)
        values_fault(values, "/surface/heights/law",
                     "\"translation\": with grooves heights are no function of a Gaussian field; "
                     "allowed: \"iterated\"");
    check_period(grid, values, period);
    if (values_fault_count(values) != before)
        return 0;
    struct grooves *grooves = array_create(1, sizeof *grooves);
    if (grooves == NULL)
        return error_memory(err, sizeof *grooves, "grooves");
    *out = grooves;
    *grooves = (struct grooves){.depth = depth, .phase = values_number(values, PHASE)};
    read_family(grid, values, PERIOD, period, isnan(angle) ? 90 : angle, grooves);
    if (!isnan(cross))
        read_family(grid, values, CROSS, period, cross, grooves);
    grooves->profile.shape = (enum groove_shape)values_choice(values, SHAPE);
    if (grooves->profile.shape == GROOVE_HARMONICS)
        return read_harmonics(values, &grooves->profile, err);
    if (values_is_given(values, AMPLITUDES))
        values_fault(values, AMPLITUDES, "belongs to the shape harmonics");
    return 0;
}
