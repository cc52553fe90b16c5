/* What a study says under /surface/like before its file is fitted: a name alone, or an object of
 * the file's name, of what is to be fitted, and of the options by which commands read and prepare
 * maps, by their names. */
#ifndef RUGO_SERVER_COMMAND_LIKE_OPTIONS_H
#define RUGO_SERVER_COMMAND_LIKE_OPTIONS_H

#include "jobs/like_parameters.h"
#include "server/command/map_file.h"
#include <cjson/cJSON.h>

enum { LIKE_NUMBERS_MOST = 8, LIKE_NUMBER_SIZE = 32 };

struct like_options {
    const char *file; /* borrowed, as all texts */
    struct map_options map;
    int spectrum, heights; /* enum like_spectrum, enum like_heights */
    int contact;           /* 0: the map is pressed, too, mirrored; 1: it is not */
    size_t number_count;
    char numbers[LIKE_NUMBERS_MOST]
                [LIKE_NUMBER_SIZE]; /* texts of numbers that were given as such */
};
/* Reads them from the value, which lends its texts. ERROR_INPUT names the member, its value and
 * what is allowed. */
int like_options_parse(struct like_options *out, const cJSON *like, struct error *err);

#endif
