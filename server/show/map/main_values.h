/* The main parameters of a map with what is known of their errors, in the order in which the page
 * for print and the screen show them. */
#ifndef RUGO_SERVER_SHOW_MAP_MAIN_VALUES_H
#define RUGO_SERVER_SHOW_MAP_MAIN_VALUES_H

#include "server/show/map/figure/map_figure.h"
#include "server/show/map/figure/map_figure_internal.h"

enum { MAIN_VALUES_MOST = 44, MAIN_VALUE_SIZE = 96 };

struct main_value {
    const char *label;          /* "RMS slope"; static */
    bool untrusted;             /* it holds what the instrument left, or follows from that */
    bool said;                  /* the screen leaves it to a sentence */
    char text[MAIN_VALUE_SIZE]; /* rounded to its error */
    char unit[UNIT_TEXT_SIZE];  /* for svg_label; "" where none is known */
};
/* Returns whether noise governs the slopes and curvatures of the map. */
bool main_values_have_noise(const struct named_values *found);
/* Lists those that the map has, and returns their number. plus_minus stands before an error. */
size_t main_values_list(struct main_value out[MAIN_VALUES_MOST], const struct map_figure *figure,
                        const char *plus_minus);

/* Returns how many decimals show an error to two digits; -1: too many, or none is known. */
int decimals_of_error(double error);

#endif
