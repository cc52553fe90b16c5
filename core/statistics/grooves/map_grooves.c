#include "core/statistics/grooves/map_grooves.h"
#include "core/statistics/heights/roughness.h"
#include "core/statistics/spectra/windowed_psd.h"
#include "core/statistics/uncertainty/map_directions.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* What is searched: a map under the window and its waves. */
struct search {
    const struct measured_map *map;
    double *z; /* heights, of which families are taken out; owned, as all below */
    double *windowed;
    struct modes modes;
    struct groove_background *background;
    double waves; /* that are tested */
};

static void search_forget(struct search *search) {
    groove_background_destroy(&search->background);
    free(search->modes.power);
    search->modes.power = NULL;
}

static void search_clear(struct search *search) {
    search_forget(search);
    free(search->z);
    free(search->windowed);
}

/* Measures the waves of what is left of the heights, and what they have by a lay. */
static int search_measure(struct search *search, const struct lay *lay, struct error *err) {
    const struct measured_map left = {search->map->grid, search->z, BOUNDARY_OPEN};
    double power;
    search_forget(search);
    int status = windowed_heights(&left, search->windowed, &power, err);
    if (status == 0)
        status = map_modes_measure(left.grid, search->windowed, &search->modes, err);
    return status == 0 ? groove_background_create(&search->background, &search->modes, lay, err)
                       : status;
}

static int search_create(struct search *search, const struct measured_map *map, struct error *err) {
    const size_t points = grid_points(map->grid);
    *search = (struct search){.map = map};
    search->z = array_create(points, sizeof *search->z);
    search->windowed = array_create(points, sizeof *search->windowed);
    if (search->z == NULL || search->windowed == NULL)
        return error_memory(err, 2 * points * sizeof *search->z, "a map without its grooves");
    memcpy(search->z, map->z, points * sizeof *search->z);
    search->waves = (double)points / 2;
    return search_measure(search, &LAY_NONE, err);
}

/* Returns the probability of such a wave anywhere among all: two are tested for each, as lines lie
 * between them. */
static double p_value_at(const struct search *search, double mx, double my, double power,
                         enum groove_test test) {
    const double one = groove_background_p_value(search->background, mx, my, power, test);
    return fmin(2 * search->waves * one, 1);
}

/* Lines that the map has at whole numbers of periods, the likeliest first. */
struct candidate {
    double p_value, power;
    long mx, my;
};

/* Returns whether a wave is of what is left of a family: beside one of its harmonics, also of those
 * that the grid folds back, and weaker than that of the sharpest shape may be. */
static bool is_left_of(const struct search *search, const struct map_groove *family, double mx,
                       double my, double power) {
    enum { HARMONICS = 200 };
    static const double BESIDE = 2.5, MEAN = 0.5; /* of the window along an axis */
    const struct grid *grid = search->map->grid;
    const double nx = (double)grid->nx, ny = (double)grid->ny;
    const double first = creal(family->lines.coefficient[0] * conj(family->lines.coefficient[0])) *
                         pow(MEAN, grid_is_profile(grid) ? 2 : 4);
    for (int h = 1; h <= HARMONICS && power < 4 * first / (h * h); h++)
        for (int sign = -1; sign <= 1; sign += 2)
            if (fabs(remainder(mx - sign * h * family->lines.mx, nx)) < BESIDE &&
                fabs(remainder(my - sign * h * family->lines.my, ny)) < BESIDE)
                return true;
    return false;
}

static bool is_left(const struct search *search, const struct map_grooves *grooves, double mx,
                    double my, double power) {
    for (size_t f = 0; f < grooves->families; f++)
        if (is_left_of(search, &grooves->family[f], mx, my, power))
            return true;
    return false;
}

/* Finds the wave that is least likely without grooves: of those that are certainly lines, the
 * strongest, as harmonics are weaker. */
static struct candidate find_candidate(const struct search *search,
                                       const struct map_grooves *grooves) {
    const struct modes *modes = &search->modes;
    const bool profile = grid_is_profile(&modes->grid);
    const double least = profile ? 2. * MAP_GROOVES_PERIODS : MAP_GROOVES_PERIODS;
    static const double CERTAIN = 1e-12;
    struct candidate best = {.p_value = 1};
    for (long mx = 0; mx < (long)modes->mode_x; mx++)
        for (long my = profile ? 0 : -(long)modes->mode_y + 1; my < (long)modes->mode_y + profile;
             my++) {
            if (hypot((double)mx, (double)my) < least || (mx == 0 && my < 0))
                continue;
            const double power = modes_power(modes, (size_t)mx, my);
            const double expected =
                groove_background_power(search->background, (double)mx, (double)my);
            if (!(power > 4 * expected)) /* of no interest, and soon seen */
                continue;
            const double p =
                fmax(p_value_at(search, (double)mx, (double)my, power, GROOVE_SOUGHT), CERTAIN);
            if (p < 1 && is_left(search, grooves, (double)mx, (double)my, power))
                continue;
            if (p < best.p_value || (p == best.p_value && p < 1 && power > best.power))
                best = (struct candidate){p, power, mx, my};
        }
    return best;
}

/* A line may be a harmonic: returns by how much to divide its wave vector, so that lines between
 * its own multiples, which stand out as surely, are multiples, too. */
static size_t divisor_of(const struct search *search, const struct groove_map *map, double mx,
                         double my) {
    enum { MOST = 6 };
    static const double SURE = 0.01, STRONG = 0.1; /* of the line's own power */
    const struct grid *grid = map->grid;
    const double least = STRONG * groove_power(map, mx, my);
    for (size_t n = MOST; n > 1; n--) {
        if (hypot(mx, my) / (double)n < MAP_GROOVES_PERIODS)
            continue;
        for (size_t j = 1; j < 3 * n; j++) {
            size_t a = j, b = n;
            while (b != 0) {
                const size_t rest = a % b;
                a = b;
                b = rest;
            }
            const double part = (double)j / (double)n, x = part * mx, y = part * my;
            if (a != 1 || fabs(x) >= (double)grid->nx / 2 - 1 ||
                (!grid_is_profile(grid) && fabs(y) >= (double)grid->ny / 2 - 1))
                continue;
            const double power = groove_power(map, x, y);
            if (power > least && 2 * MOST * MOST *
                                         groove_background_p_value(search->background, x, y, power,
                                                                   GROOVE_HARMONIC) <
                                     SURE)
                return n;
        }
    }
    return 1;
}

/* --- a family --- */

static void family_fill(struct map_groove *out, const struct grid *grid) {
    const struct groove_lines *lines = &out->lines;
    const bool profile = grid_is_profile(grid);
    const double kx = lines->mx / grid->lx, ky = profile ? 0 : lines->my / grid->ly;
    const double k = hypot(kx, ky);
    out->period = 1 / k;
    out->period_error = out->period * lines->stretch_error;
    out->angle = profile ? (double)NAN : remainder(atan2(kx, -ky), M_PI);
    out->angle_error = profile ? (double)NAN : lines->angle_error;
    if (out->angle <= -M_PI / 2 + out->angle_error) /* along y, to its error */
        out->angle = M_PI / 2;
    out->periods = hypot(lines->mx, profile ? 0 : lines->my);
    out->mean_square = 0;
    for (size_t h = 0; h < lines->count; h++)
        out->mean_square += 2 * creal(lines->coefficient[h] * conj(lines->coefficient[h]));
}

static void family_take(const struct map_groove *family, const struct grid *grid, double *z) {
    groove_family_add(&family->lines, &family->fit, grid, -1, 0, z);
}

/* Fits the family of a candidate, and takes it out of the heights. */
static int family_find(struct map_groove *out, struct search *search,
                       const struct candidate *candidate, struct error *err) {
    const struct groove_map map = {search->map->grid, search->windowed};
    double mx = (double)candidate->mx, my = (double)candidate->my;
    groove_refine(&map, &mx, &my);
    const double part = 1 / (double)divisor_of(search, &map, mx, my);
    groove_lines_fit(&out->lines, &map, search->background, part * mx, part * my);
    groove_shape_find(&out->fit, &out->lines);
    if (out->fit.p_value < GROOVE_SHAPE_LEVEL)
        groove_shape_forget(&out->fit, &out->lines);
    family_fill(out, search->map->grid);
    groove_family_add(&out->lines, &out->fit, search->map->grid, -1, GROOVE_JUMP, search->z);
    return search_measure(search, &LAY_NONE, err);
}

/* Finds the lay of what is left; LAY_NONE of profiles. */
static int find_lay(struct lay *out, const struct search *search, struct error *err) {
    const struct spectrum_fit_request by_the_map = {0};
    const struct measured_map left = {search->map->grid, search->z, search->map->boundary};
    struct map_directions directions;
    struct map_spectrum *circles = NULL;
    *out = LAY_NONE;
    if (grid_is_profile(left.grid))
        return 0;
    int status = map_spectrum_create(&circles, &left, err);
    if (status == 0)
        status = map_directions_find(&directions, &left, circles, err);
    if (status == 0)
        status = map_directions_lay(out, &directions, circles, &by_the_map, err);
    map_spectrum_destroy(&circles);
    return status;
}

/* Fits a family anew, with what waves have along the lay of the rest; false where it does not stand
 * out of that. */
static bool family_stands(struct map_groove *family, const struct search *search,
                          const struct groove_map *map) {
    family->p_value = 1;
    for (size_t h = 1; h <= family->lines.count; h++) {
        const double mx = (double)h * family->lines.mx, my = (double)h * family->lines.my;
        family->p_value = fmin(family->p_value,
                               p_value_at(search, mx, my, groove_power(map, mx, my), GROOVE_ALONE));
    }
    return family->p_value < MAP_GROOVES_LEVEL;
}

/* --- all --- */

/* Weaker ones are what the points fold back of others, which no mean profile takes out. */
static const double SHARE_LEAST = 2e-4; /* of the mean square height: 0.04 RMS heights deep */

static double mean_square_of(const struct measured_map *map) {
    struct average mean = {0}, squares = {0}; /* heights lie about 0 */
    for (size_t n = 0; n < grid_points(map->grid); n++) {
        average_add(&mean, map->z[n]);
        average_add(&squares, map->z[n] * map->z[n]);
    }
    return average_value(&squares) - average_value(&mean) * average_value(&mean);
}

/* Estimates all families beside each other and beside what is left: each anew beside the last
 * estimates of the others. */
static int estimate(struct map_grooves *grooves, struct search *search, struct lay *lay,
                    struct error *err) {
    enum { ROUNDS = 2 };
    const struct grid *grid = search->map->grid;
    int status = 0;
    for (int round = 0; round < ROUNDS && status == 0; round++) {
        status = find_lay(lay, search, err);
        if (status == 0)
            status = search_measure(search, lay, err);
        for (size_t f = 0; f < grooves->families && status == 0; f++) {
            struct map_groove *family = &grooves->family[f];
            status = groove_family_estimate(&family->lines, &family->fit, grid, search->background,
                                            lay, search->z, err);
            family_fill(family, grid);
        }
    }
    return status == 0 ? search_measure(search, lay, err) : status;
}

/* Judges each family beside what is left of all, to which it is added. */
static int judge(struct map_grooves *out, struct search *search, double *windowed,
                 struct error *err) {
    const struct grid *grid = search->map->grid;
    const struct groove_map map = {grid, windowed};
    const size_t points = grid_points(grid);
    double *z = array_create(points, sizeof *z), power;
    const double total = mean_square_of(search->map);
    size_t kept = 0;
    if (z == NULL)
        return error_memory(err, points * sizeof *z, "a map without its grooves");
    int status = 0;
    for (size_t f = 0; f < out->families && status == 0; f++) {
        struct map_groove family = out->family[f];
        const struct measured_map one = {grid, z, BOUNDARY_OPEN};
        memcpy(z, search->z, points * sizeof *z);
        groove_family_add(&family.lines, &family.fit, grid, 1, GROOVE_JUMP, z);
        status = windowed_heights(&one, windowed, &power, err);
        if (status == 0 && family.mean_square > SHARE_LEAST * total &&
            family_stands(&family, search, &map))
            out->family[kept++] = family;
    }
    out->families = kept;
    free(z);
    return status;
}

int map_grooves_find(struct map_grooves *out, const struct measured_map *map, struct error *err) {
    enum { SIDE_LEAST = 4 * MAP_GROOVES_PERIODS };
    static const double WORTH = 0.02; /* a closer look */
    struct search search;
    struct lay lay = LAY_NONE;
    *out = (struct map_grooves){0};
    if (map->grid->nx < SIDE_LEAST || (!grid_is_profile(map->grid) && map->grid->ny < SIDE_LEAST))
        return 0;
    int status = search_create(&search, map, err);
    while (status == 0 && out->families < MAP_GROOVES_MOST) {
        const struct candidate candidate = find_candidate(&search, out);
        if (!(candidate.p_value < WORTH))
            break;
        status = family_find(&out->family[out->families], &search, &candidate, err);
        out->families++;
    }
    if (status == 0 && out->families > 0)
        status = estimate(out, &search, &lay, err);
    if (status == 0 && out->families > 0) {
        double *windowed = array_create(grid_points(map->grid), sizeof *windowed);
        status = windowed != NULL
                     ? judge(out, &search, windowed, err)
                     : error_memory(err, grid_points(map->grid) * sizeof *windowed, "a map");
        free(windowed);
    }
    search_clear(&search);
    return status;
}

void map_grooves_take(const struct map_grooves *grooves, const struct grid *grid, double *z) {
    for (size_t f = 0; f < grooves->families; f++)
        family_take(&grooves->family[f], grid, z);
}

int map_grooves_rest(double **rest, const struct map_grooves *grooves, const struct grid *grid,
                     const double *z, struct error *err) {
    const size_t points = grid_points(grid);
    *rest = array_create(points, sizeof **rest);
    if (*rest == NULL)
        return error_memory(err, points * sizeof **rest, "a map without its grooves");
    memcpy(*rest, z, points * sizeof **rest);
    map_grooves_take(grooves, grid, *rest);
    return 0;
}
