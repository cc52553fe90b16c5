/* The choice of a file's layer, for all formats that hold several. */
#ifndef RUGO_CORE_INSTRUMENT_LAYERS_H
#define RUGO_CORE_INSTRUMENT_LAYERS_H

#include "core/error.h"
#include <stddef.h>

struct layer {
    const char *title;  /* borrowed; NULL: none */
    const char *z_unit; /* borrowed; "" where the file has none */
};

/* Sets *out, from 0, to the layer of this title or, where none has it, of this number, counted from
 * 1. With asked NULL it is the first whose unit is a length, or else the first. ERROR_INPUT lists
 * the layers present, and then `others`, which may be "". said: as that of layer_say(). */
int layer_choose(const struct layer *layers, size_t count, const char *asked, const char *others,
                 size_t *out, char *said, struct error *err);

/* Writes which of several layers it is, from 0: "1 'Amplitude' of 2"; "" where there is one. title:
 * NULL: none. said: INSTRUMENT_LAYER bytes, or NULL. */
void layer_say(char *said, const char *title, size_t layer, size_t count);

/* Checks a request for a file with one layer, which has no title. */
int layer_check_only(const char *asked, struct error *err);

#endif
