#include "server/command/map/press/press_loads.h"
#include "core/map/length_unit.h"
#include "server/command/options.h"
#include "server/show/quantity.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char REDUCED[] = "0.01,0.02,0.05,0.1,0.2,0.3";

static int parse_modulus(struct press_loads *out, const struct press_words *words,
                         struct error *err) {
    const char *text = words->effective_modulus != NULL ? words->effective_modulus : words->modulus;
    if (words->modulus != NULL && words->effective_modulus != NULL)
        return error_set(err, ERROR_INPUT,
                         "--modulus and --effective-modulus: one of the two tells the other");
    if (text == NULL)
        return 0;
    if (!quantity_parse(text, strlen(text), "Pa", &out->modulus))
        return error_set(err, ERROR_INPUT,
                         "--%s %.40s: allowed is a pressure above 0 with its unit, such as 210GPa",
                         words->modulus != NULL ? "modulus" : "effective-modulus", text);
    if (words->modulus != NULL)
        out->modulus /= 1 - words->poisson * words->poisson;
    return 0;
}

static int parse_hardness(struct press_loads *out, const struct press_words *words,
                          struct error *err) {
    double hardness;
    if (words->hardness == NULL)
        return 0;
    if (!quantity_parse(words->hardness, strlen(words->hardness), "Pa", &hardness))
        return error_set(err, ERROR_INPUT,
                         "--hardness %.40s: allowed is a pressure above 0 with its unit, such as "
                         "2GPa",
                         words->hardness);
    if (!(out->modulus > 0))
        return error_set(err, ERROR_INPUT,
                         "--hardness needs the stiffness of the block: --modulus, such as 210GPa, "
                         "or --effective-modulus");
    out->hardness = hardness / out->modulus;
    return 0;
}

/* Reads one number for both bodies, or two. */
static bool read_pair(const char *text, double pair[2]) {
    char *end;
    pair[0] = pair[1] = strtod(text, &end);
    if (end != text && *end == ',') {
        text = end + 1;
        pair[1] = strtod(text, &end);
    }
    return end != text && *end == '\0' && pair[0] > 0 && pair[1] > 0 && isfinite(pair[0]) &&
           isfinite(pair[1]);
}

static int parse_conduction(struct press_loads *out, const struct press_words *words,
                            struct error *err) {
    double pair[2];
    out->heat = words->conductivity != NULL;
    const char *text = out->heat ? words->conductivity : words->resistivity;
    if (out->heat && words->resistivity != NULL)
        return error_set(err, ERROR_INPUT, "--resistivity and --conductivity: give one of the two");
    if (text == NULL)
        return 0;
    if (!read_pair(text, pair))
        return error_set(err, ERROR_INPUT,
                         "--%s %.40s: allowed is a number above 0 in %s for both bodies, such as "
                         "%s, or one for each, with a comma between",
                         out->heat ? "conductivity" : "resistivity", text,
                         out->heat ? "W/(m K)" : "ohm m", out->heat ? "50" : "1e-7");
    out->resistivity = out->heat ? 1 / pair[0] + 1 / pair[1] : pair[0] + pair[1];
    return 0;
}

/* Reads the values of the loads; those of forces when it is known whether the map is a profile. */
static int parse_values(struct press_loads *out, const struct press_words *words,
                        struct error *err) {
    const char *loads = words->loads;
    if (words->pressure == NULL && words->force == NULL)
        return rising_numbers(loads != NULL ? loads : REDUCED, PRESS_LOADS_MOST, out->value,
                              &out->count)
                   ? 0
                   : error_set(err, ERROR_INPUT,
                               "--loads %.40s: not up to %d rising numbers above 0", loads,
                               PRESS_LOADS_MOST);
    if (!(out->modulus > 0))
        return error_set(err, ERROR_INPUT,
                         "--%s needs the stiffness of the block: --modulus, such as 210GPa, or "
                         "--effective-modulus",
                         words->force != NULL ? "force" : "pressure");
    if (words->force != NULL) {
        out->kind = LOADS_FORCE;
        return 0;
    }
    out->kind = LOADS_PRESSURE;
    int status =
        quantities_parse(words->pressure, "Pa", PRESS_LOADS_MOST, out->value, &out->count, err);
    return status == 0
               ? 0
               : error_context(err, "--pressure %.40s (up to %d rising ones, such as 1MPa,2MPa)",
                               words->pressure, PRESS_LOADS_MOST);
}

int press_loads_parse(struct press_loads *out, const struct press_words *words, struct error *err) {
    int given = (words->loads != NULL) + (words->pressure != NULL) + (words->force != NULL);
    *out = (struct press_loads){.kind = LOADS_REDUCED, .force = words->force};
    if (given > 1)
        return error_set(err, ERROR_INPUT, "--loads, --pressure, --force: give one of the three");
    int status = parse_modulus(out, words, err);
    if (status == 0)
        status = parse_hardness(out, words, err);
    if (status == 0)
        status = parse_conduction(out, words, err);
    if (status != 0)
        return status;
    status = parse_values(out, words, err);
    if (status == 0 && words->friction > 0 && out->kind != LOADS_FORCE)
        contact_loads_add(out->value, &out->count, out->value[out->count - 1]);
    out->slips = words->friction > 0;
    return status;
}

int press_loads_of_map(struct press_loads *loads, const struct height_map *map, struct error *err) {
    if (loads->kind != LOADS_FORCE)
        return 0;
    if (!length_unit_is_metre(map->xy_unit))
        return error_set(err, ERROR_INPUT,
                         "--force needs the area of the map, which has no unit of length: say "
                         "--unit and --z-unit");
    bool profile = grid_is_profile(&map->grid);
    const char *unit = profile ? "N/m" : "N";
    if (quantities_parse(loads->force, unit, PRESS_LOADS_MOST, loads->value, &loads->count, err) !=
        0)
        return error_context(err, "--force %.40s (up to %d rising ones, such as %s)", loads->force,
                             PRESS_LOADS_MOST,
                             profile ? "10N/m, as a profile has them" : "10mN,20mN");
    if (loads->slips)
        contact_loads_add(loads->value, &loads->count, loads->value[loads->count - 1]);
    return 0;
}

double press_loads_mean(const struct press_loads *loads, size_t load, double slope, double area) {
    double value = loads->value[load];
    switch (loads->kind) {
    case LOADS_PRESSURE:
        return value / loads->modulus;
    case LOADS_FORCE:
        return value / area / loads->modulus;
    case LOADS_REDUCED:
        break;
    }
    return value * slope;
}
