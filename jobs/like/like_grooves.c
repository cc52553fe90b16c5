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
 * periods along the sides of the cell. turned: it is the opposite of the one that was found.
 * harmonics: what the study's grid holds of it. */
struct made {
    double along_x, along_y, period, angle;
    bool turned;
    size_t harmonics;
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
    return (struct made){fit.along_x,
                         fit.along_y,
                         1 / hypot(wave_x, wave_y),
                         angle / DEGREE,
                         sin(angle) * wave_x - cos(angle) * wave_y < 0,
                         groove_harmonics_most(cell, fit.along_x, fit.along_y)};
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

/* Names of parameters of a family. */
struct names {
    const char *period, *angle, *depth, *shape, *amplitudes, *phases;
};
static const struct names NAMES[GROOVE_FAMILIES_MOST] = {
    {"period", "angle", "depth", "shape", "amplitudes", "phases"},
    {"cross_period", "cross_angle", "cross_depth", "cross_shape", "cross_amplitudes",
     "cross_phases"}};

/* Whether its harmonics say the shape: where it has no name, or is a saw that falls along the wave
 * vector of the study. */
static bool has_harmonics(const struct map_groove *family, const struct made *made) {
    const struct groove_shape_fit *fit = &family->fit;
    return fit->shape == GROOVE_HARMONICS ||
           (fit->shape == GROOVE_SAW && fit->reversed != made->turned);
}
static size_t harmonics_found(const struct map_groove *family) {
    return family->fit.shape == GROOVE_HARMONICS ? family->fit.standing : family->lines.count;
}

/* Harmonics that the study's grid does not hold are left out. */
static bool put_shape(cJSON *grooves, const struct names *names, const struct map_groove *family,
                      const struct made *made) {
    const struct groove_shape_fit *fit = &family->fit;
    const struct groove_lines *lines = &family->lines;
    double amplitude[GROOVE_LINES_MOST], phase[GROOVE_LINES_MOST];
    if (!has_harmonics(family, made))
        return field_put_text(grooves, names->shape, GROOVE_SHAPE_NAMES[fit->shape]);
    const size_t found = harmonics_found(family);
    const size_t count = found < made->harmonics ? found : made->harmonics;
    for (size_t h = 0; h < count; h++) {
        amplitude[h] = 2 * cabs(lines->coefficient[h]);
        phase[h] = (made->turned ? -1 : 1) * carg(lines->coefficient[h]) / DEGREE;
    }
    return field_put_text(grooves, names->shape, GROOVE_SHAPE_NAMES[GROOVE_HARMONICS]) &&
           field_put(grooves, names->amplitudes, json_numbers(amplitude, count)) &&
           field_put(grooves, names->phases, json_numbers(phase, count));
}

/* unit: of depths, in that of the map. */
static bool put_family(cJSON *grooves, const struct names *names, const struct map_groove *family,
                       const struct made *made, double unit, bool profile) {
    return field_put(grooves, names->period, json_number(made->period)) &&
           field_put(grooves, names->depth, json_number(family->fit.depth / unit)) &&
           (profile || field_put(grooves, names->angle, json_number(made->angle))) &&
           put_shape(grooves, names, family, made);
}

/* Two families that differ in a map may be one on the cell. */
static int check_apart(const struct made *first, const struct made *second, struct error *err) {
    if (fabs(second->along_x) != fabs(first->along_x) ||
        second->along_y * first->along_x != first->along_y * second->along_x)
        return 0;
    return error_set(err, ERROR_INPUT,
                     "the map has two families of grooves, at %.4g degrees, that are one on the "
                     "cell of the study: give \"degroove\": true, which takes them out",
                     first->angle);
}

/* What was found of a family, and what is made of it; held: beyond the map alone. */
static size_t write_family(char *out, size_t size, const struct map_groove *family,
                           const struct made *made, const struct like_grooves_of *of) {
    const bool angled = isfinite(family->angle);
    const char *unit = of->unit, *gap = *unit != '\0' ? " " : "";
    const double period =
        of->hold ? groove_extension_period(family, of->map) : made->period * of->wavelength;
    const size_t harmonics = harmonics_found(family);
    char from[40] = "", to[40] = "", held[100] = "";
    if (angled)
        snprintf(from, sizeof from, " at %.4g degrees", family->angle / DEGREE);
    if (angled && !of->hold)
        snprintf(to, sizeof to, " at %.4g degrees", made->angle);
    if (has_harmonics(family, made) && harmonics > made->harmonics)
        snprintf(held, sizeof held, " of the %zu of %zu harmonics that its grid holds",
                 made->harmonics, harmonics);
    const int used = snprintf(
        out, size, "every %.5g%s%.10s%s, %.3g%s%.10s deep (+- %.2g %%), made every %.5g%s%.10s%s%s",
        family->period, gap, unit, from, family->fit.depth, gap, unit,
        100 * family->fit.depth_error / family->fit.depth, period, gap, unit, to, held);
    return used > 0 && (size_t)used < size ? (size_t)used : size - 1;
}

static void write_words(struct like_grooves *grooves, const struct made *made,
                        const struct like_grooves_of *of) {
    char *text = grooves->words;
    const size_t size = sizeof grooves->words;
    size_t used = (size_t)snprintf(text, size, "grooves, taken out of the law: ");
    for (size_t f = 0; f < grooves->found.families; f++) {
        if (f > 0)
            used += (size_t)snprintf(text + used, size - used, "; crossed by ");
        used += write_family(text + used, size - used, &grooves->found.family[f], &made[f], of);
    }
    snprintf(text + used, size - used, "%s, as the cell has whole numbers of periods",
             of->hold ? " beyond the map, which holds them as they are" : "");
}

int like_grooves_put(cJSON *surface, struct like_grooves *grooves, const struct like_grooves_of *of,
                     struct error *err) {
    const struct map_grooves *found = &grooves->found;
    struct made made[MAP_GROOVES_MOST] = {{0}};
    struct surface_case read;
    struct moments moments;
    int status = read_surface(&read, surface, err);
    if (status != 0)
        return status;
    status = spectrum_moments(&read.spectrum, &read.grid, &moments, err);
    for (size_t f = 0; f < found->families; f++)
        made[f] = make_fit(&found->family[f], of->map, of->wavelength, &read.grid);
    if (status == 0 && found->families > 1)
        status = check_apart(&made[0], &made[1], err);
    cJSON *object = status == 0 ? cJSON_AddObjectToObject(surface, "grooves") : NULL;
    bool put = object != NULL;
    grooves->depth_error = 0;
    for (size_t f = 0; f < found->families && put; f++) {
        const struct groove_shape_fit *fit = &found->family[f].fit;
        put = put_family(object, &NAMES[f], &found->family[f], &made[f],
                         of->wavelength * moments.rms_height, grid_is_profile(&read.grid));
        grooves->depth_error = fmax(grooves->depth_error, fit->depth_error / fit->depth);
    }
    if (status == 0 && !put)
        status = error_memory(err, sizeof *grooves, "grooves of a study");
    if (status == 0)
        write_words(grooves, made, of);
    surface_case_clear(&read);
    return status;
}
