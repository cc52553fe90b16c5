/* The loads and the material that `press` is asked for: without units, or in physical ones. */
#ifndef RUGO_SERVER_COMMAND_MAP_PRESS_LOADS_H
#define RUGO_SERVER_COMMAND_MAP_PRESS_LOADS_H

#include "core/error.h"
#include "core/map/height_map.h"
#include "jobs/contact/case/contact_loads.h"
#include <stdbool.h>
#include <stddef.h>

enum { PRESS_LOADS_MOST = 1000 };

/* As options give them; NULL: not given. */
struct press_words {
    const char *loads, *pressure, *force, *modulus, *effective_modulus;
    const char *hardness, *resistivity, *conductivity;
    double poisson, friction; /* friction 0: none */
};

struct press_loads {
    enum press_load_kind { LOADS_REDUCED, LOADS_PRESSURE, LOADS_FORCE } kind;
    size_t count;
    double value[PRESS_LOADS_MOST +
                 CONTACT_LOADS_ADDED]; /* rising: p/(E* h'), Pa, or N (of a profile N/m) */
    double modulus;                    /* E* in Pa; 0: not known */
    double hardness;                   /* over E*; 0: it is elastic */
    double resistivity;                /* of both bodies together, ohm m or m K/W; 0: not known */
    bool heat;                         /* to heat, else to current */
    bool slips;                        /* friction adds loads */
    const char *force; /* the words, read when it is known whether it is a profile's */
};

/* Friction adds loads below the highest (contact_loads_add). ERROR_INPUT names the option, its
 * value and what is allowed. */
int press_loads_parse(struct press_loads *out, const struct press_words *words, struct error *err);
/* Reads forces, N of a surface and N/m of a profile. ERROR_INPUT also where the map has no unit. */
int press_loads_of_map(struct press_loads *loads, const struct height_map *map, struct error *err);
/* Mean pressure of a load over E*; slope is h', area that of the map (of a profile its length). */
double press_loads_mean(const struct press_loads *loads, size_t load, double slope, double area);

#endif
