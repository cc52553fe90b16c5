/* The path of the flat that `press` drags over a map with friction at finite strain. */
#ifndef RUGO_SERVER_COMMAND_MAP_PRESS_PATH_H
#define RUGO_SERVER_COMMAND_MAP_PRESS_PATH_H

#include "core/error.h"

struct press_path {
    double *at; /* owned: where the flat is, over the RMS height; the first is 0 */
    size_t count, steps;
};
/* Reads turning points, with commas between; NULL: four times the friction. steps: points to each
 * of them, 0: 30. ERROR_INPUT names the option, its value and what is allowed. */
int press_path_parse(struct press_path *out, const char *turns, unsigned steps, double friction,
                     struct error *err);
void press_path_clear(struct press_path *path);

#endif
