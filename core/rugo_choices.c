/* Implements the names of choices of rugo.h. */
#include "core/rugo.h"
#include <string.h>

struct choice {
    const char *name;
    int value;
};
#define CHOICE(type, name, value) {name, value},
static const struct choice SPECTRA[] = {RUGO_SPECTRA(CHOICE){NULL, 0}};
static const struct choice DISTRIBUTIONS[] = {RUGO_DISTRIBUTIONS(CHOICE){NULL, 0}};
static const struct choice SUMMIT_RULES[] = {RUGO_SUMMIT_RULES(CHOICE){NULL, 0}};
static const struct choice TRENDS[] = {RUGO_TRENDS(CHOICE){NULL, 0}};
static const struct choice MODELS[] = {RUGO_MODELS(CHOICE){NULL, 0}};

static const struct {
    const char *name;
    const struct choice *choices; /* the last one has no name */
} LISTS[] = {{"spectra", SPECTRA},
             {"distributions", DISTRIBUTIONS},
             {"summit_rules", SUMMIT_RULES},
             {"trends", TRENDS},
             {"models", MODELS}};

const char *rugo_choice(const char *list, size_t n, int *value) {
    size_t l = 0;
    while (l < sizeof LISTS / sizeof *LISTS && strcmp(LISTS[l].name, list) != 0)
        l++;
    if (l == sizeof LISTS / sizeof *LISTS)
        return NULL;
    const struct choice *choice = LISTS[l].choices;
    for (size_t before = 0; before < n && choice->name != NULL; before++)
        choice++;
    if (choice->name != NULL && value != NULL)
        *value = choice->value;
    return choice->name;
}
