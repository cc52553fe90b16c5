/* rugo characterise FILE FILE... --together: several maps of one surface. */
#ifndef RUGO_SERVER_COMMAND_MAP_TOGETHER_H
#define RUGO_SERVER_COMMAND_MAP_TOGETHER_H

#include "server/command/map/map_file.h"
#include "server/show/map/named_values.h"
#include <cjson/cJSON.h>
#include <stdbool.h>

/* Reads and fits the maps, NULL behind the last, each prepared by the options, and fills all
 * numbers. report: a file for the picture of their spectra; NULL: none. printed: so is that. The
 * caller clears *found in any case. Errors name the file. */
int together_run(const char *const *files, const struct map_options *options, const char *report,
                 bool printed, struct named_values *found, struct error *err);

/* Makes a study of surfaces like all of the maps (like_study.h), for the caller to delete. */
int together_study(const char *const *files, const struct map_options *options, bool hold,
                   cJSON **study, struct error *err);

#endif
