/* The decimal point of texts, whatever the locale of the program that has loaded librugo: with one
 * of a comma, strtod reads "0.5" as 0, and printf writes "0,5". */
#ifndef RUGO_CORE_POINT_LOCALE_H
#define RUGO_CORE_POINT_LOCALE_H

#include <locale.h>

/* Gives the calling thread, and no other, the locale "C". Returns the locale that it had, which
 * point_locale_end takes; 0 where there is no memory for it, and nothing is changed then. */
static inline locale_t point_locale_begin(void) {
    locale_t point = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    return point != (locale_t)0 ? uselocale(point) : (locale_t)0;
}

/* Gives the thread its locale back; 0 is accepted. */
static inline void point_locale_end(locale_t before) {
    if (before != (locale_t)0)
        freelocale(uselocale(before));
}

#endif
