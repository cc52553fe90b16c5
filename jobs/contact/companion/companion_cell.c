/* The error of the finite length of the cell (FORMULAS.md, F15.7). Beside the first realisations,
 * and some of the others, surfaces on cells of the own length and on longer ones are pressed on a
 * half-space on a coarse mesh. The error is the difference of their means. They have random numbers
 * of their own; a rectangle keeps its shape.
 *
 * Such a surface is a function of the seed, its realisation and its number there, and cases that
 * share their random numbers share it. All else of it is that of the case. How many there are is
 * counted by the work that they take, as it is estimated, on any machine. Solves of small cells
 * are so cheap that the first realisations have many, and the difference a small statistical error.
 */
#include "core/cost.h"
#include "jobs/contact/case/contact_loads.h"
#include "jobs/contact/companion/companion.h"
#include "jobs/contact/contact_measure.h"
#include <gsl/gsl_cdf.h>
#include <stdlib.h>

/* The first realisations, which have the work of FIRST_SECONDS on a 3 GHz core for each length, or
 * this share of a study of usual size. */
enum { FIRST = 8, USUAL_STUDY = 20, DRAWS_LEAST = 4, DRAWS_ENOUGH = 16, DRAWS_MOST = 2048 };
static const double FIRST_SECONDS = 0.5, FIRST_SHARE = 0.14;
/* Time for the surfaces of one length from then on, over that of the case without. */
static const double TIME_SHARE = 0.06;
/* Lengths beyond which an error of the cell is small, in longest waves. */
static const double PROFILE_WAVES = 64, SURFACE_WAVES = 32;
/* Doubling the length is assumed to leave this share of an error: of profiles errors fall as 1/L or
 * slower, and not monotonically, of surfaces faster. The change on a coarse half-space stands for
 * that of other models and meshes within TRANSFER of itself. Measured by
 * tests/validation/jobs/test_contact_cells.c. */
static const double PROFILE_LEFT = 0.7, SURFACE_LEFT = 0.5, TRANSFER = 0.2;
/* These surfaces may take as much memory as the case's own on a half-space on its finest mesh, or
 * this if that is less. */
static const double BYTES_LEAST = 1e9;
static const double ROUNDING = 1e-9; /* relative: of numbers that should be integers */

struct cell {
    const struct contact_case *one_case;
    const struct companion_plan *plan;
    struct generator *generator; /* owned, as all below */
    struct coarse_solver *halfspace;
    double rms_height; /* of the surfaces */
    double *own, *z;   /* heights as generated, and on the coarse mesh */
};

/* --- the plan --- */

/* Makes the grid of a cell `length` times as long, and as wide, with the same spacing; false where
 * the numbers of points are no integers, or too large. */
static bool scale_grid(const struct grid *grid, double length, struct grid *out) {
    bool profile = grid_is_profile(grid);
    double along_x = length * (double)grid->nx, along_y = profile ? 1 : length * (double)grid->ny;
    if (fmod(along_x, 1) != 0 || fmod(along_y, 1) != 0 || along_x * along_y > SURFACE_POINTS_MOST)
        return false;
    *out = (struct grid){(size_t)along_x, (size_t)along_y, length * grid->lx, length * grid->ly};
    return true;
}

/* Surfaces that are iterated depend on the grid that they are generated on: it is as fine as
 * that of the case. Others are generated on the mesh that they are pressed on, if it holds their
 * waves. */
static bool choose_grids(const struct contact_case *one_case, struct companion_plan *out) {
    struct surface_case *surface = &out->surface;
    const struct contact_level own = coarse_level(one_case);
    out->level = own;
    *surface = one_case->surface;
    surface->length_ratio *= out->length;
    surface->length_ratio_y *= out->length;
    if (!scale_grid(&own.grid, out->length, &out->level.grid) ||
        !scale_grid(&one_case->surface.grid, out->length, &surface->grid))
        return false;
    out->band = surface_case_sampled_band(surface);
    if (!surface_case_iterated(surface) &&
        surface_band_fits(surface_case_band(surface), &out->level.grid)) {
        surface->grid = out->level.grid;
        out->level.stride = 1;
    }
    return out->level.stride > 0 || surface_band_fits(out->band, &out->level.grid);
}

static double generation_seconds(const struct companion_plan *plan) {
    return 1e-9 * surface_case_nanoseconds(&plan->surface, NULL) *
           (double)grid_points(&plan->surface.grid);
}

static double cell_seconds(const struct contact_case *one_case, const struct companion_plan *plan) {
    return generation_seconds(plan) + coarse_solver_seconds(one_case, &plan->level.grid);
}

/* Returns the seconds by which draws are planned. */
static double planned_seconds(const struct contact_case *one_case,
                              const struct companion_plan *plan) {
    return generation_seconds(plan) + coarse_solver_planned_seconds(one_case, &plan->level.grid);
}

static double cell_bytes(const struct contact_case *one_case, const struct companion_plan *plan) {
    const struct grid *grid = &plan->level.grid;
    return surface_case_bytes(&plan->surface) + 8 * (double)grid_points(grid) +
           coarse_solver_bytes(one_case, grid);
}

/* Returns whether the grids of a cell so many times as long exist, and suit the memory. */
static bool set_length(const struct contact_case *one_case, double length,
                       struct companion_plan *out) {
    double own = surface_case_bytes(&one_case->surface) +
                 coarse_solver_bytes(one_case, &contact_case_finest(one_case)->grid);
    *out = (struct companion_plan){.length = length};
    if (one_case->surface.held != NULL)
        return false; /* the patch decides on the cell */
    return choose_grids(one_case, out) && cell_bytes(one_case, out) <= fmax(BYTES_LEAST, own);
}

/* Costs are counted as if the case had a usual number of loads: what is drawn hardly depends on the
 * loads that a study lists. Very many loads have the work of twice as many at most. */
static struct contact_case with_usual_loads(const struct contact_case *one_case) {
    enum { LOADS = 10 };
    struct contact_case usual = *one_case;
    usual.load_count = one_case->load_count > 2 * LOADS ? one_case->load_count / 2 : LOADS;
    return usual;
}

/* Returns how many draws a plan may have in the first realisations. */
static double affordable(const struct contact_case *usual, const struct companion_plan *plan) {
    double seconds =
        fmax(FIRST_SECONDS, FIRST_SHARE * USUAL_STUDY * contact_case_least_seconds(usual));
    return fmin(DRAWS_MOST, floor(seconds / planned_seconds(usual, plan)));
}

/* The first realisations have as many draws as a fixed amount of work allows. From then on
 * the time is a share of that of the case. */
static void set_draws(const struct contact_case *usual, struct companion_plan *out) {
    double draws = affordable(usual, out);
    uint64_t interval = subset_interval(planned_seconds(usual, out),
                                        TIME_SHARE * contact_case_least_seconds(usual), 1);
    out->series = 1;
    out->draws = draws >= FIRST ? (uint64_t)llround(draws / FIRST) : 1;
    out->due = (struct subset){FIRST, draws >= FIRST ? 1 : FIRST / DRAWS_LEAST, interval};
}

/* Takes the longest cell of which enough can be drawn, up to WAVES longest waves; twice the length
 * where that is longer. */
static bool plan_longer(const struct contact_case *one_case, struct companion_plan *out) {
    const struct contact_case usual = with_usual_loads(one_case);
    const struct surface_case *surface = &one_case->surface;
    double longest =
        fmax(surface->length_ratio, surface->length_ratio_y) / surface_case_times_longest(surface);
    double most = surface->dimension == 1 ? PROFILE_WAVES : SURFACE_WAVES;
    struct companion_plan plan;
    if (!set_length(&usual, 2, out))
        return false;
    for (double length = 4; length * longest <= most && set_length(&usual, length, &plan) &&
                            affordable(&usual, &plan) >= DRAWS_ENOUGH;
         length *= 2)
        *out = plan;
    set_draws(&usual, out);
    return true;
}

static bool face_holds_waves(const struct surface_case *face, double length) {
    const double waves[] = {length * face->length_ratio, length * face->length_ratio_y};
    for (size_t side = 0; side < 2; side++)
        if (!(waves[side] >= 1 && fabs(waves[side] - round(waves[side])) <= ROUNDING * waves[side]))
            return false;
    return true;
}

static bool plateau_holds_waves(const struct surface_case *surface, double length) {
    const double longest = surface->plateau->spectrum.wavelength_long;
    const double ly = surface->dimension == 1 ? surface->grid.lx : surface->grid.ly;
    const struct surface_case face = {.length_ratio = surface->grid.lx / longest,
                                      .length_ratio_y = ly / longest};
    return face_holds_waves(&face, length);
}

static bool holds_waves(const struct contact_case *one_case, double length) {
    const struct surface_case *surface = &one_case->surface;
    if (surface->grooves != NULL &&
        !grooves_fit(surface->grooves, length * surface->grid.lx, length * surface->grid.ly))
        return false;
    return face_holds_waves(surface, length) &&
           (surface->counter == NULL || face_holds_waves(surface->counter, length)) &&
           (surface->plateau == NULL || plateau_holds_waves(surface, length));
}

/* Where longer cells would be too large, takes a quarter or half, whichever first holds whole
 * longest waves. */
static bool plan_shorter(const struct contact_case *one_case, struct companion_plan *out) {
    const struct contact_case usual = with_usual_loads(one_case);
    double length = holds_waves(one_case, 0.25) ? 0.25 : 0.5;
    if (contact_case_has(one_case, COMPANION_LONGER) || !holds_waves(one_case, length) ||
        !set_length(&usual, length, out))
        return false;
    set_draws(&usual, out);
    return true;
}

static bool plan_equal(const struct contact_case *one_case, struct companion_plan *out) {
    const struct contact_case usual = with_usual_loads(one_case);
    bool other = contact_case_has(one_case, COMPANION_LONGER) ||
                 contact_case_has(one_case, COMPANION_SHORTER);
    if (!other || !set_length(&usual, 1, out))
        return false;
    set_draws(&usual, out);
    return true;
}

/* --- one surface --- */

static int cell_create(void *workspace, const struct contact_case *one_case,
                       const struct companion_plan *plan, const struct moments *moments,
                       struct error *err) {
    struct cell *cell = workspace;
    const struct surface_case *surface = &plan->surface;
    size_t points = grid_points(&surface->grid), coarse = grid_points(&plan->level.grid);
    struct moments own;
    (void)moments; /* of the case's length */
    cell->one_case = one_case;
    cell->plan = plan;
    int status = generator_create(&cell->generator, &surface->spectrum, &surface->grid,
                                  &surface->options, err);
    if (status != 0)
        return status;
    modes_moments(generator_modes(cell->generator), &own);
    cell->rms_height = own.rms_height;
    status =
        coarse_solver_create(&cell->halfspace, one_case, &plan->level.grid, INFINITY, &own, err);
    if (status != 0)
        return status;
    cell->own = array_create(points, sizeof *cell->own);
    cell->z = array_create(coarse, sizeof *cell->z);
    return cell->own != NULL && cell->z != NULL
               ? 0
               : error_memory(err, (points + coarse) * sizeof *cell->z,
                              "a surface of another length");
}

static void cell_clear(void *workspace) {
    struct cell *cell = workspace;
    generator_destroy(&cell->generator);
    coarse_solver_destroy(&cell->halfspace);
    free(cell->own);
    free(cell->z);
}

/* Scales the values of a series to cells as large as the case's. Patches are counted on the area of
 * the case's own cell, and shares are of that area. */
static void scale_measures(const struct cell *cell, double *series) {
    double cells = pow(cell->plan->length, cell->one_case->surface.dimension);
    for (size_t a = 0; a < measure_paired(cell->one_case); a++)
        for (size_t k = 0; k < contact_case_slots(cell->one_case); k++)
            series[a * contact_case_slots(cell->one_case) + k] *=
                measure_factor(measure_row(a)->cell, cells);
}

/* Returns the key of a draw. Sequences of cases have none of the bits by which these differ. */
static struct random_key key_of(const struct companion_plan *plan, struct random_key key,
                                size_t draw) {
    enum { EQUAL_BIT = 61, SHORTER_BIT = 62, LONGER_BIT = 63, DRAW_BIT = 40 };
    int bit = plan->length > 1 ? LONGER_BIT : plan->length < 1 ? SHORTER_BIT : EQUAL_BIT;
    key.sequence ^= UINT64_C(1) << bit | (uint64_t)draw << DRAW_BIT;
    return key;
}

static int cell_solve(void *workspace, const struct contact_surface *surface,
                      struct contact_tally *tally, struct companion_tally *out,
                      const struct contact_stopper *stopper, struct error *err) {
    const struct cell *cell = workspace;
    const struct companion_plan *plan = cell->plan;
    const struct random_key key = key_of(plan, surface->key, out->draw);
    double *series = companion_series(tally->one_case, out, 0);
    generator_set_stop(cell->generator, stopper->stop, stopper->context);
    int status = generator_run(cell->generator, key, cell->own, NULL, err);
    if (status == 0)
        status = contact_level_sample(&plan->level, &plan->surface,
                                      &(struct level_source){cell->rms_height, key}, cell->own,
                                      cell->z, err);
    if (status == 0)
        status = coarse_solver_press(cell->halfspace, cell->z, series, stopper, err);
    if (status == 0)
        scale_measures(cell, series);
    return status;
}

/* --- the error --- */

/* The mean on the own length less that on another one, over the former. */
struct change {
    double value, interval; /* within +- interval at 95 % */
    double standard_error;
};

/* The mean of a measure over draws. */
struct sample {
    struct estimate mean;
    double freedom; /* of its standard error */
};

static struct sample sample_of(const struct contact_tally *tally, enum contact_measure measure,
                               enum companion_name length, size_t load) {
    return (struct sample){contact_tally_companion(tally, length, 0, measure, load),
                           (double)contact_tally_draws(tally, length, 0, measure, load) - 1};
}

/* Few draws show their scatter badly. It is at least that of the own length, which has more draws,
 * over the root of the ratio of the cells' areas. */
static void support(struct sample *few, const struct sample *many, double cells) {
    enum { FREEDOM_ENOUGH = 7 };
    double expected =
        many->mean.standard_error * sqrt((many->freedom + 1) / (few->freedom + 1) / cells);
    if (few->freedom >= FREEDOM_ENOUGH || many->freedom <= few->freedom)
        return;
    few->mean.standard_error = fmax(few->mean.standard_error, expected);
    few->freedom = many->freedom;
}

/* Returns the half width of the interval of 95 % of a difference of two means (Welch 1947). */
static double welch(const struct sample *a, const struct sample *b) {
    static const double QUANTILE = 0.975;
    double va = pow(a->mean.standard_error, 2), vb = pow(b->mean.standard_error, 2);
    double freedom = (va + vb) * (va + vb) / (va * va / a->freedom + vb * vb / b->freedom);
    return va + vb > 0 ? gsl_cdf_tdist_Pinv(QUANTILE, freedom) * sqrt(va + vb) : 0 * (va + vb);
}

static struct change change_of(const struct contact_tally *tally, enum contact_measure measure,
                               enum companion_name length, size_t load) {
    const struct contact_case *one_case = tally->one_case;
    struct sample own = sample_of(tally, measure, COMPANION_EQUAL, load);
    struct sample other = sample_of(tally, measure, length, load);
    double y = fabs(own.mean.value);
    if (!(own.freedom > 0 && other.freedom > 0 && y > 0))
        return (struct change){NAN, NAN, NAN};
    support(&other, &own, pow(one_case->companions[length].length, one_case->surface.dimension));
    return (struct change){(own.mean.value - other.mean.value) / own.mean.value,
                           welch(&own, &other) / y,
                           hypot(own.mean.standard_error, other.mean.standard_error) / y};
}

/* Returns how far a load is from another, in factors of two; two points of sliding are half as far
 * as that. */
static double apart(const struct contact_case *one_case, enum measure_by by, size_t k,
                    size_t load) {
    return by == BY_SLIDING ? fabs((double)k - (double)load) / 2
                            : fabs(log2(one_case->loads[k] / one_case->loads[load]));
}

/* Returns the own change of a load, or the part of that of a load around it that exceeds its
 * interval if that is larger, since a change vanishes where its sign changes. That part counts the
 * less the farther the load is, and from a factor of two on not at all. */
static double change_around(const struct contact_case *one_case, enum measure_by by,
                            const struct change *changes, size_t load) {
    double most = fabs(changes[load].value);
    for (size_t k = 0; k < contact_case_values(one_case, by); k++) {
        double weight = 1 - apart(one_case, by, k, load);
        if (weight > 0)
            most = fmax(most, weight * (fabs(changes[k].value) - changes[k].interval));
    }
    return most;
}

/* Returns the error over the value. What a longer cell leaves of an error bounds it on both sides;
 * the change to a shorter one has no sign for longer ones. */
static struct contact_error error_of(const struct contact_case *one_case, enum measure_by by,
                                     const struct change *changes, double length, size_t load) {
    const struct change *own = &changes[load];
    double around = change_around(one_case, by, changes, load);
    double whole =
        contact_error_left(length, one_case->surface.dimension == 1 ? PROFILE_LEFT : SURFACE_LEFT);
    double left = length > 1 ? fmax(whole - 1, TRANSFER) : whole;
    double factor = length > 1 ? 1 : whole;
    return (struct contact_error){.value = length > 1 ? own->value : 0 * own->value,
                                  .bound = hypot(factor * own->interval, left * around),
                                  .standard_error = factor * own->standard_error,
                                  .order = NAN};
}

static bool cell_applies(const struct contact_case *one_case, size_t model) {
    (void)one_case, (void)model;
    return true;
}

/* The relative change of a half-space on a coarse mesh stands for that of other models and
 * meshes. */
static bool cell_errors(const struct contact_tally *tally, enum contact_measure measure,
                        size_t model, struct contact_error *out) {
    const struct contact_case *one_case = tally->one_case;
    const enum measure_by by = measure_row(measure)->by;
    size_t n = contact_case_values(one_case, by), finest = one_case->level_count - 1;
    enum companion_name length =
        contact_case_has(one_case, COMPANION_LONGER) ? COMPANION_LONGER : COMPANION_SHORTER;
    struct change changes[CONTACT_LOADS_MOST + CONTACT_LOADS_ADDED];
    bool any = false;
    if (!contact_case_has(one_case, COMPANION_EQUAL))
        return false;
    for (size_t k = 0; k < n; k++)
        changes[k] = change_of(tally, measure, length, k);
    for (size_t k = 0; k < n; k++) {
        double y = contact_mean(tally, measure, model, finest, k).value;
        out[k] = error_of(one_case, by, changes, one_case->companions[length].length, k);
        out[k].value *= y;
        out[k].bound *= fabs(y);
        out[k].standard_error *= fabs(y);
        any = any || !isnan(out[k].value);
    }
    return any;
}

COMPANION_DEFINE(LONGER, "a longer cell", "/contact/cell_error", ERROR_CELL, plan_longer,
                 struct cell, cell_create, cell_clear, cell_bytes, cell_seconds, cell_solve,
                 cell_applies, cell_errors, NULL)
COMPANION_DEFINE(SHORTER, "a shorter cell", "/contact/cell_error", ERROR_CELL, plan_shorter,
                 struct cell, cell_create, cell_clear, cell_bytes, cell_seconds, cell_solve,
                 cell_applies, cell_errors, NULL)
COMPANION_DEFINE(EQUAL, "another cell as long", "/contact/cell_error", ERROR_CELL, plan_equal,
                 struct cell, cell_create, cell_clear, cell_bytes, cell_seconds, cell_solve,
                 cell_applies, cell_errors, NULL)
