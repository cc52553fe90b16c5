#include "jobs/like/like_grooves.h"
#include "core/statistics/grooves/groove_extension.h"
#include "core/surface/spectrum.h"
#include "jobs/surface/surface_case.h"
#include "schema/json/field.h"
#include "schema/json/json.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const double DEGREE = M_PI / 180;

/* The wave vector of a family as the study has it, whose angle is within -90 and 90 degrees:
 * periods along the sides of the cell. turned: it is the opposite of the one that was found. */
struct made {
    double along_x, along_y, period, angle;
    bool turned;
};

static struct made make_fit(const struct map_groove *family, const struct grid *map,
                            double wavelength, const struct grid *cell) {
    const bool profile = grid_is_profile(cell);
    const double ly = profile ? 1 : cell->ly;
    const double x = family->lines.mx / map->lx * wavelength;
    const double y = profile ? 0 : family->lines.my / map->ly * wavelength;
    struct groove_fit fit = groove_fit_cell(x, y, cell->lx, ly);
    const double wave_x = fit.along_x / cell->lx, wave_y = profile ? 0 : fit.along_y / ly;
    const double angle = profile ? M_PI / 2 : remainder(atan2(wave_x, -wave_y), M_PI);
    return (struct made){fit.along_x, fit.along_y, 1 / hypot(wave_x, wave_y), angle / DEGREE,
                         sin(angle) * wave_x - cos(angle) * wave_y < 0};
}

/* Reads the surface of the study, without the file that it is to resemble. */
static int read_surface(struct surface_case *out, const cJSON *surface, struct error *err) {
    cJSON *parameters = cJSON_CreateObject();
    cJSON *copy = cJSON_Duplicate(surface, true);
    if (parameters == NULL || copy == NULL || !cJSON_AddItemToObject(parameters, "surface", copy)) {
        cJSON_Delete(copy);
        cJSON_Delete(parameters);
        return error_memory(err, sizeof *out, "a fitted surface");
    }
    cJSON_DeleteItemFromObjectCaseSensitive(copy, "like");
    int status = surface_case_read(out, parameters, NULL, err);
    cJSON_Delete(parameters);
    return status;
}

/* Writes the shape: by its harmonics where it has no name, or is a saw that falls along the wave
 * vector of the study. */
static bool put_shape(cJSON *grooves, const struct map_groove *family, bool turned) {
    const struct groove_shape_fit *fit = &family->fit;
    const struct groove_lines *lines = &family->lines;
    double amplitude[GROOVE_LINES_MOST], phase[GROOVE_LINES_MOST];
    const bool falls = fit->shape == GROOVE_SAW && fit->reversed != turned;
    if (fit->shape != GROOVE_HARMONICS && !falls)
        return field_put_text(grooves, "shape", GROOVE_SHAPE_NAMES[fit->shape]);
    const size_t count = falls ? lines->count : fit->standing;
    for (size_t h = 0; h < count; h++) {
        amplitude[h] = 2 * cabs(lines->coefficient[h]);
        phase[h] = (turned ? -1 : 1) * carg(lines->coefficient[h]) / DEGREE;
    }
    return field_put_text(grooves, "shape", GROOVE_SHAPE_NAMES[GROOVE_HARMONICS]) &&
           field_put(grooves, "amplitudes", json_numbers(amplitude, count)) &&
           field_put(grooves, "phases", json_numbers(phase, count));
}

static bool put(cJSON *surface, const struct map_groove *family, const struct made *made,
                const struct made *cross, double depth, bool profile) {
    cJSON *grooves = cJSON_AddObjectToObject(surface, "grooves");
    return grooves != NULL && field_put(grooves, "period", json_number(made->period)) &&
           field_put(grooves, "depth", json_number(depth)) &&
           (profile || field_put(grooves, "angle", json_number(made->angle))) &&
           (cross == NULL || field_put(grooves, "cross_angle", json_number(cross->angle))) &&
           put_shape(grooves, family, made->turned);
}

/* Both families of a study have one period. On a cell they have whole numbers of periods where one
 * is the mirror image of the other; off: by how many periods the second was not. */
static int mirror(struct made *cross, const struct made *first, struct error *err) {
    static const double NEAR = 1; /* periods */
    const double sign = cross->along_x * first->along_x < 0 ? -1 : 1;
    const double off_x = fabs(sign * cross->along_x - first->along_x);
    const double off_y = fabs(sign * cross->along_y + first->along_y);
    if (off_x > NEAR || off_y > NEAR)
        return error_set(
            err, ERROR_INPUT,
            "the map has crossed grooves, at %.4g and %.4g degrees, which no cell of a study has "
            "with one period: give \"degroove\": true, which takes them out",
            first->angle, cross->angle);
    *cross = *first;
    cross->along_y = -first->along_y;
    cross->angle = -first->angle;
    return 0;
}

/* What was found, and what is made of it; held: beyond the map alone, whose grooves stay. */
static void write_words(struct like_grooves *grooves, const struct made *made,
                        const struct like_grooves_of *of) {
    const struct map_groove *first = &grooves->found.family[0];
    const bool angled = isfinite(first->angle), crossed = grooves->found.families > 1;
    const char *unit = of->unit, *gap = *unit != '\0' ? " " : "";
    const double period =
        of->hold ? groove_extension_period(first, of->map) : made->period * of->wavelength;
    char from[40] = "", to[40] = "";
    if (angled)
        snprintf(from, sizeof from, " at %.4g degrees", first->angle / DEGREE);
    if (angled && !of->hold)
        snprintf(to, sizeof to, " at %.4g degrees", made->angle);
    snprintf(
        grooves->words, sizeof grooves->words,
        "grooves: every %.5g%s%.10s%s, %.3g%s%.10s deep (+- %.2g %%), taken out of the law and "
        "%s every %.5g%s%.10s%s, as the cell has whole numbers of periods%s",
        first->period, gap, unit, from, first->fit.depth, gap, unit, 100 * grooves->depth_error,
        of->hold ? "held as they are, and beyond the map made" : "made", period, gap, unit, to,
        !crossed || of->hold ? "" : ", and mirrored");
}

int like_grooves_put(cJSON *surface, struct like_grooves *grooves, const struct like_grooves_of *of,
                     struct error *err) {
    const struct grid *map = of->map;
    const double wavelength = of->wavelength;
    const struct map_groove *family = grooves->found.family;
    const bool crossed = grooves->found.families > 1;
    struct surface_case read;
    struct moments moments;
    int status = read_surface(&read, surface, err);
    if (status != 0)
        return status;
    status = spectrum_moments(&read.spectrum, &read.grid, &moments, err);
    const struct made first = make_fit(&family[0], map, wavelength, &read.grid);
    struct made cross = make_fit(&family[crossed], map, wavelength, &read.grid);
    if (status == 0 && crossed)
        status = mirror(&cross, &first, err);
    const double depth = family[0].fit.depth / wavelength / moments.rms_height;
    if (status == 0 && !put(surface, &family[0], &first, crossed ? &cross : NULL, depth,
                            grid_is_profile(&read.grid)))
        status = error_memory(err, sizeof *grooves, "grooves of a study");
    grooves->depth_error = family[0].fit.depth_error / family[0].fit.depth;
    if (status == 0)
        write_words(grooves, &first, of);
    surface_case_clear(&read);
    return status;
}
