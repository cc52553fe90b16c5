/* The power that waves of the random part of a map have, under the window of windowed_psd.h: by
 * medians over rings of wave vectors, which single lines do not move (FORMULAS.md, F18.72). */
#ifndef RUGO_CORE_STATISTICS_GROOVES_GROOVE_BACKGROUND_H
#define RUGO_CORE_STATISTICS_GROOVES_GROOVE_BACKGROUND_H

#include "core/statistics/spectra/lay.h"
#include "core/surface/modes.h"

struct groove_background;
/* Borrows the modes (map_modes_measure). Of profiles the lay is not used. ERROR_MEMORY. */
int groove_background_create(struct groove_background **out, const struct modes *modes,
                             const struct lay *lay, struct error *err);
void groove_background_destroy(struct groove_background **background);
/* Returns the expected power of a wave of mx, my periods along the sides (any numbers). */
double groove_background_power(const struct groove_background *background, double mx, double my);
/* Returns the same where lines have been taken out, by the waves around that one: their median over
 * what their rings have, times that of its ring. Nothing is taken for granted. */
double groove_background_near(const struct groove_background *background, double mx, double my);
/* What a wave is tested as. */
enum groove_test {
    GROOVE_SOUGHT,   /* one of all waves of the map, at whole numbers of periods */
    GROOVE_HARMONIC, /* at its wave vector. Offsets of lines have waves, too, with nothing
                        along them, and it must stand out of those */
    GROOVE_ALONE     /* all that is left of grooves: out of its neighbours on each side, too */
};
/* Returns the probability of such a power or more in a wave of the random part. It compares with
 * the largest of what rings and neighbours on either side have, so that a sharp end of a spectrum
 * makes no line. */
double groove_background_p_value(const struct groove_background *background, double mx, double my,
                                 double power, enum groove_test test);

#endif
