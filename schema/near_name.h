/* Of the names that there are, the one that a misspelt name was likely meant to be. */
#ifndef RUGO_SCHEMA_NEAR_NAME_H
#define RUGO_SCHEMA_NEAR_NAME_H

#include <stddef.h>

/* Initialise with {.typed = what was typed}. */
struct near_name {
    const char *typed;
    const char *name; /* borrowed from near_name_see; NULL: none is near */
    size_t distance;  /* of name */
};
/* Looks at one of the names. Letters changed, left out, put in or swapped make distance, of any
 * case; names that what was typed is a part of are near, as is one whose first letter alone was
 * typed. */
void near_name_see(struct near_name *near, const char *name);
enum { NEAR_HINT_SIZE = 128 };
/* Writes " (did you mean NAME?)", or "" where none is near, and returns it. */
const char *near_name_hint(const struct near_name *near, char hint[NEAR_HINT_SIZE]);

#endif
