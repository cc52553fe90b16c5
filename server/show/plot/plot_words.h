/* Words of pictures as people write them: Greek letters, roots, primes, indices and powers. */
#ifndef RUGO_SERVER_SHOW_PLOT_PLOT_WORDS_H
#define RUGO_SERVER_SHOW_PLOT_PLOT_WORDS_H

#include "schema/near_name.h"
#include <stddef.h>
#include <stdio.h>

/* Prints a text, in which what XML reserves is escaped. */
void svg_text(FILE *file, const char *text);
/* Prints a label of mathematics for the inside of <text>: "lambda_s" with a Greek letter and an
 * index, "h'_rms" with a prime, "m0" and "A0" with an index, "sqrt(m0)" with a root sign, "L^2"
 * with a power. All else is as it stands. */
void svg_label(FILE *file, const char *label);

/* Returns the symbol of a kind's parameter for svg_label, "H" of "/surface/hurst"; its last name
 * where it has none. Borrowed from either. */
const char *plot_symbol(const char *kind, const char *pointer);
/* Shows the name of such a parameter to a name that was typed; the parameter whose symbol was
 * typed, as pictures have it, is the nearest. */
void plot_near_parameter(struct near_name *near, const char *kind, const char *pointer);
/* Writes what an axis over such a parameter says, for svg_label: "Hurst exponent H", with the unit
 * in brackets where it has one. */
void plot_parameter_label(const char *kind, const char *pointer, char *out, size_t size);
/* Writes what a title calls such a parameter: "Hurst exponent", "length ratio". */
void plot_parameter_words(const char *kind, const char *pointer, char *out, size_t size);
/* Writes "summit density" of "summit_density", with the capitals of people and of abbreviations:
 * "Persson light load", "height PDF". */
void plot_in_words(const char *name, char *out, size_t size);
/* Returns about how wide a label is, in letters. */
size_t plot_letters(const char *label);

#endif
