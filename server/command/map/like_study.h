/* Studies of surfaces like a measured one. The file that a study names is read and fitted where the
 * command runs. The study that is kept and sent holds the fit, and needs no file. */
#ifndef RUGO_SERVER_COMMAND_MAP_LIKE_STUDY_H
#define RUGO_SERVER_COMMAND_MAP_LIKE_STUDY_H

#include "core/map/preparation/preparation.h"
#include "core/statistics/heights/plateau.h"
#include "server/command/map/map_file.h"
#include <cjson/cJSON.h>
#include <stdbool.h>
#include <stddef.h>

/* Where the study in *text[*size], with these changes (--set, NULL-terminated or NULL), names a
 * file under /surface/like that is not fitted, replaces *text by the fitted study, with the
 * changes made, and sets *fitted. path: of the study; the file's name is relative to its folder, or
 * to the working folder where it is NULL or "-". A text that is no study stays as it is, for its
 * reader to say so. *text is the caller's, from malloc. ERROR_INPUT names the parameter or file. */
int like_study_fit(char **text, size_t *size, const char *path, const char *const *overrides,
                   bool *fitted, struct error *err);

/* Does so with a study that was sent with its files: those of sent->sent alone are read, and
 * converted as `sent` says, whatever the study does. ERROR_INPUT, too, where no file is to be
 * fitted. */
int like_study_fit_sent(char **text, size_t *size, const struct map_options *sent,
                        struct error *err);

/* Makes a study of statistics of surfaces like one map or several of one surface, each with its
 * record, fitted, for the caller to delete. strata: the law of the heights of one
 * map that is a stratified face, which the surfaces then are; NULL: they are not. hold: the
 * surfaces hold the map, which is in the study. ERROR_INPUT where its reader would refuse what was
 * measured. */
int like_study_make(cJSON **out, size_t count, const struct height_map *maps,
                    const struct preparation_record *records, const struct plateau_law *strata,
                    bool hold, struct error *err);

#endif
