/* The requested preparation of a map as texts, as they stand on a command line or in a query. */
#ifndef RUGO_CORE_MAP_PREPARATION_WORDS_H
#define RUGO_CORE_MAP_PREPARATION_WORDS_H

#include "core/map/preparation/preparation.h"

/* In the order of the enums in preparation.h: */
#define MAP_BOUNDARIES "auto|open|periodic"
#define MAP_DETREND_NAME(type, name, value) "|" name
#define MAP_DETRENDS "auto|none" RUGO_TRENDS(MAP_DETREND_NAME)
#define MAP_WINDOWS "none|hann|tukey"
#define MAP_LINES "none|mean|median|linear|quadratic"
#define MAP_LINES_ALONG "x|y"

#define MAP_DESPIKE "8" /* deviations, unless others are given */
#define MAP_EXTEND "1"  /* draw, likewise */

/* NULL: not requested. */
struct preparation_words {
    const char *dx;       /* "0.5um", "0.5", "0.5um,0.25um" */
    const char *unit;     /* "um": of x and y */
    const char *z_unit;   /* "nm", "25nm": of z, or the length of one of the file's units */
    const char *missing;  /* "-9999", "-9999,32767", "-9999nm", "none": heights of no point */
    const char *crop;     /* "X0,Y0,WIDTH,HEIGHT", points or lengths with units */
    const char *stride;   /* "2", "2,1" */
    const char *resample; /* "512", "512,256", "0.5um", "dx=0.5" */
    const char *filter;   /* "S=2.5um,L=0.8mm,robust", each part at most once */
    const char *despike;  /* "8": robust deviations */
    const char *tip;      /* "tip=10nm", "tip=10nm,holes" */
    const char *rotate;   /* "30": degrees */
    const char *extend;   /* "1": number of the draw */
    int boundary, detrend, window, lines, lines_along; /* the enums of preparation.h */
    bool degroove, fill, denoise, transpose;
};

/* ERROR_INPUT names the option, its value and what is allowed. */
int preparation_parse(struct preparation *out, const struct preparation_words *words,
                      struct error *err);

/* Reads "10um" or "10", with nothing behind it; returns false where it is no finite number, or its
 * unit is none of length. */
bool asked_length_parse(struct asked_length *out, const char *text, size_t size);

#endif
