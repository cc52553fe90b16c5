/* How much of a map is measured. */
#ifndef RUGO_JOBS_MAPS_MAP_EXTENT_H
#define RUGO_JOBS_MAPS_MAP_EXTENT_H

/* MAP_MAIN: the main values and the verdicts on them, without what nobody would see beside them: of
 * summits those of nine points and of functional parameters the two strata alone, no interpolated
 * moments, hills, scales and tables. Numbers that are left out are NaN, tables empty or NaN. */
enum map_extent { MAP_MAIN, MAP_WHOLE };

#endif
