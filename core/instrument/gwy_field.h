/* A data field of Gwyddion: numbers on a grid with units. Private to gwy*.c. */
#ifndef RUGO_CORE_INSTRUMENT_GWY_FIELD_H
#define RUGO_CORE_INSTRUMENT_GWY_FIELD_H

#include "core/instrument/gwy_tree.h"
#include "core/map/height_map.h"

struct gwy_field {
    struct grid grid;
    const char *numbers;          /* borrowed: grid_points doubles, lowest byte first, row by row */
    const char *xy_unit, *z_unit; /* borrowed: "" where the file tells none */
};

/* Checks what a GwyDataField says against what it holds. */
int gwy_field_read(struct gwy_span object, struct gwy_field *out, struct error *err);

/* The text of one of its units, "si_unit_xy" or "si_unit_z"; "" where there is none. */
int gwy_unit_read(struct gwy_span object, const char *name, const char **out, struct error *err);

#endif
