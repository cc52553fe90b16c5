#include "jobs/surface/surface_grooves.h"
#include <math.h>
#include <stdlib.h>

/* Parameters of a family. */
enum { PERIOD, ANGLE, DEPTH, SHAPE, AMPLITUDES, PHASES, NAMES };
static const char *const FIRST[NAMES] = {"/surface/grooves/period",     "/surface/grooves/angle",
                                         "/surface/grooves/depth",      "/surface/grooves/shape",
                                         "/surface/grooves/amplitudes", "/surface/grooves/phases"};
static const char *const CROSS[NAMES] = {
    "/surface/grooves/cross_period",     "/surface/grooves/cross_angle",
    "/surface/grooves/cross_depth",      "/surface/grooves/cross_shape",
    "/surface/grooves/cross_amplitudes", "/surface/grooves/cross_phases"};
static const char PHASE[] = "/surface/grooves/phase";
static const double DEGREE = M_PI / 180;

/* Reads one family: whole numbers of periods along both sides, to OFF of a period. A fault names
 * the nearest grooves that have them. */
static void read_waves(const struct grid *grid, struct values *values, const char *path,
                       double period, double degrees, struct groove_family *out) {
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
    out->wave_x = wave_x;
    out->wave_y = wave_y;
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

static int read_harmonics(struct values *values, const char *const *names,
                          struct groove_profile *out, struct error *err) {
    double *amplitude = NULL, *phase = NULL;
    size_t count = 0, phases = 0;
    struct error reason = {0};
    int status = values_numbers(values, names[AMPLITUDES], &amplitude, &count, err);
    if (status == 0)
        status = values_numbers(values, names[PHASES], &phase, &phases, err);
    for (size_t h = 0; h < phases && phase != NULL; h++)
        phase[h] *= DEGREE;
    if (status == 0 && amplitude == NULL)
        values_fault(values, names[AMPLITUDES], "the shape harmonics needs its amplitudes");
    else if (status == 0 && phase != NULL && phases != count)
        values_fault(values, names[PHASES],
                     "%zu of them, and %zu amplitudes; allowed: as many of each", phases, count);
    else if (status == 0) {
        double none[GROOVE_HARMONICS_MOST] = {0};
        if (groove_profile_of_harmonics(out, count, amplitude, phase != NULL ? phase : none,
                                        &reason) != 0)
            values_fault(values, names[AMPLITUDES], "%s", reason.text);
    }
    free(amplitude);
    free(phase);
    return status;
}

/* What belongs to the shape harmonics alone is refused with another. */
static void refuse_harmonics(struct values *values, const char *const *names, const char *reason) {
    static const int ALONE[] = {AMPLITUDES, PHASES};
    for (size_t n = 0; n < sizeof ALONE / sizeof *ALONE; n++)
        if (values_is_given(values, names[ALONE[n]]))
            values_fault(values, names[ALONE[n]], "%s", reason);
}

static int read_profile(struct values *values, const char *const *names, struct groove_profile *out,
                        struct error *err) {
    out->shape = (enum groove_shape)values_choice(values, names[SHAPE]);
    if (out->shape == GROOVE_HARMONICS)
        return read_harmonics(values, names, out, err);
    refuse_harmonics(values, names, "belongs to the shape harmonics");
    return 0;
}

static void refuse_all(struct values *values, const char *const *names, const char *reason) {
    for (size_t n = 0; n < NAMES; n++)
        if (values_is_given(values, names[n]))
            values_fault(values, names[n], "%s", reason);
}

static bool is_crossed(struct values *values) {
    return values_is_given(values, CROSS[ANGLE]) || values_is_given(values, CROSS[PERIOD]);
}

/* What belongs to grooves alone is refused without them, and so for the second family. */
static bool are_asked(struct values *values) {
    static const char REASON[] = "belongs to grooves, which need their period and depth";
    if (values_is_given(values, FIRST[PERIOD])) {
        if (!is_crossed(values))
            refuse_all(values, CROSS,
                       "belongs to a second family, which needs its cross_angle or cross_period");
        return true;
    }
    refuse_all(values, FIRST, REASON);
    refuse_all(values, CROSS, REASON);
    if (values_is_given(values, PHASE))
        values_fault(values, PHASE, "%s", REASON);
    return false;
}

static double or_else(double value, double other) {
    return isnan(value) ? other : value;
}

static void check_directions(const struct grid *grid, struct values *values) {
    const char *const *of[] = {FIRST, CROSS};
    for (size_t f = 0; f < 2; f++) {
        const double angle = values_number(values, of[f][ANGLE]);
        if (grid_is_profile(grid) && !isnan(angle))
            values_fault(values, of[f][ANGLE], "%g: profiles have one direction", angle);
    }
}

static void check_period(const struct grid *grid, struct values *values, const char *path,
                         double period) {
    static const double POINTS_LEAST = 4;
    const double dx = grid_dx(grid);
    if (!(period >= POINTS_LEAST * dx * (1 - 1e-9)))
        values_fault(values, path,
                     "%g: the grid has %g points a period; allowed: at least %g, a period of %g",
                     period, period / dx, POINTS_LEAST, POINTS_LEAST * dx);
}

static void check_harmonics(const struct grid *grid, struct values *values, const char *path,
                            const struct groove_family *family) {
    const struct groove_profile *profile = &family->profile;
    const size_t held =
        groove_harmonics_most(grid, family->wave_x * grid->lx, family->wave_y * grid->ly);
    size_t most = profile->shape == GROOVE_HARMONICS ? profile->count : 0;
    while (most > 0 && cabs(profile->coefficient[most - 1]) == 0)
        most--;
    if (most > held)
        values_fault(values, path,
                     "harmonic %zu: the grid has two points a wave of it along a side, or fewer; "
                     "allowed: harmonics up to %zu",
                     most, held);
}

/* Reads the first family. */
static int read_first(struct grooves *out, const struct grid *grid, struct values *values,
                      struct error *err) {
    const double period = values_number(values, FIRST[PERIOD]);
    out->families = 1;
    out->family[0].depth = values_number(values, FIRST[DEPTH]);
    check_period(grid, values, FIRST[PERIOD], period);
    read_waves(grid, values, FIRST[PERIOD], period,
               or_else(values_number(values, FIRST[ANGLE]), 90), &out->family[0]);
    int status = read_profile(values, FIRST, &out->family[0].profile, err);
    if (status == 0)
        check_harmonics(grid, values, FIRST[AMPLITUDES], &out->family[0]);
    return status;
}

/* Reads the second one: what it does not give is that of the first. */
static int read_cross(struct grooves *out, const struct grid *grid, struct values *values,
                      struct error *err) {
    static const double SAME = 1e-9;
    struct groove_family *second = &out->family[1];
    const double angle = or_else(values_number(values, FIRST[ANGLE]), 90);
    const double cross = or_else(values_number(values, CROSS[ANGLE]), angle);
    const double own = values_number(values, CROSS[PERIOD]);
    const double period = or_else(own, values_number(values, FIRST[PERIOD]));
    const char *path = isnan(own) ? CROSS[ANGLE] : CROSS[PERIOD];
    *second = out->family[0];
    out->families = 2;
    second->depth = or_else(values_number(values, CROSS[DEPTH]), second->depth);
    if (fabs(remainder(cross - angle, 180)) < 1e-6 &&
        fabs(period - values_number(values, FIRST[PERIOD])) < SAME * period)
        values_fault(values, path, "%g: both families have the same direction and period",
                     isnan(own) ? cross : own);
    check_period(grid, values, path, period);
    read_waves(grid, values, path, period, cross, second);
    const bool shaped = values_is_given(values, CROSS[SHAPE]);
    int status = shaped ? read_profile(values, CROSS, &second->profile, err) : 0;
    if (!shaped)
        refuse_harmonics(values, CROSS, "belongs to the cross_shape harmonics");
    if (status == 0)
        check_harmonics(grid, values, shaped ? CROSS[AMPLITUDES] : path, second);
    return status;
}

int surface_grooves_read(struct grooves **out, const struct grid *grid, bool translated,
                         struct values *values, struct error *err) {
    const size_t before = values_fault_count(values);
    if (!are_asked(values))
        return 0;
    if (isnan(values_number(values, FIRST[DEPTH])))
        values_fault(values, FIRST[DEPTH],
                     "grooves need their depth, in RMS heights of the random part");
    check_directions(grid, values);
    if (translated)
        values_fault(values, "/surface/heights/law",
                     "\"translation\": with grooves heights are no function of a Gaussian field; "
                     "allowed: \"iterated\"");
    if (values_fault_count(values) != before)
        return 0;
    struct grooves *grooves = array_create(1, sizeof *grooves);
    if (grooves == NULL)
        return error_memory(err, sizeof *grooves, "grooves");
    *out = grooves;
    grooves->phase = values_number(values, PHASE);
    int status = read_first(grooves, grid, values, err);
    return status == 0 && is_crossed(values) ? read_cross(grooves, grid, values, err) : status;
}
