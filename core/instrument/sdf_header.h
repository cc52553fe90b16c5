/* What a surface data file (ISO 25178-71, SDF) says before its heights. Private to sdf*.c. */
#ifndef RUGO_CORE_INSTRUMENT_SDF_HEADER_H
#define RUGO_CORE_INSTRUMENT_SDF_HEADER_H

#include "core/map/height_map.h"

struct sdf_header {
    size_t points, profiles;          /* along x and along y */
    double x_scale, y_scale, z_scale; /* metres from point to point, and in one of a number */
    unsigned data_type;               /* 0 to 7: SDF_TYPES */
    bool bcr; /* of the proposal (EUR 15178) that came before the standard */
};

struct sdf_type {
    const char *name;
    size_t bytes;
    double lowest, highest;
};
enum { SDF_TYPE_COUNT = 8 };
extern const struct sdf_type SDF_TYPES[SDF_TYPE_COUNT];

/* Checks counts, scales and the type, and sets the shape and the units of the map. */
int sdf_header_check(const struct sdf_header *header, struct height_map *map, struct error *err);
/* Whether a number stands for a height that was not measured: the standard's lowest of the type,
 * the proposal's highest, which programs mix. */
bool sdf_is_hole(const struct sdf_header *header, double number);

/* Each takes a whole file that begins with its mark, and fills *map; on failure *map may hold
 * heights, for the caller to clear. text[size] must be 0. */
int sdf_text_read(struct height_map *map, const char *text, size_t size, struct error *err);
int sdf_binary_read(struct height_map *map, const char *data, size_t size, struct error *err);

#endif
