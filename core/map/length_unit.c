#include "core/map/length_unit.h"
#include <math.h>
#include <string.h>
#include <strings.h>

static const struct length_unit {
    const char *name;
    double metres;
} UNITS[] = {{"m", 1},
             {"dm", 1e-1},
             {"cm", 1e-2},
             {"mm", 1e-3},
             {"\xc2\xb5m", 1e-6}, /* micro sign */
             {"\xce\xbcm", 1e-6}, /* Greek mu */
             {"\xb5m", 1e-6},     /* micro sign of Latin-1 */
             {"um", 1e-6},
             {"nm", 1e-9},
             {"pm", 1e-12},
             {"A", 1e-10},
             {"\xc3\x85", 1e-10},     /* A with ring */
             {"\xe2\x84\xab", 1e-10}, /* angstrom sign */
             {"\xc5", 1e-10},         /* A with ring of Latin-1 */
             {"km", 1e3},
             {"in", 0.0254},
             {"\xc2\xb5in", 2.54e-8},
             {"\xce\xbcin", 2.54e-8},
             {"uin", 2.54e-8}};
/* Words, with an s in the plural or none, in capitals or not. */
static const struct length_unit WORDS[] = {{"metre", 1},
                                           {"meter", 1},
                                           {"centimetre", 1e-2},
                                           {"centimeter", 1e-2},
                                           {"millimetre", 1e-3},
                                           {"millimeter", 1e-3},
                                           {"micrometre", 1e-6},
                                           {"micrometer", 1e-6},
                                           {"micron", 1e-6},
                                           {"nanometre", 1e-9},
                                           {"nanometer", 1e-9},
                                           {"picometre", 1e-12},
                                           {"picometer", 1e-12},
                                           {"angstrom", 1e-10},
                                           {"angstroem", 1e-10},
                                           {"\xc3\xa5ngstr\xc3\xb6m", 1e-10},
                                           {"\xc3\x85ngstr\xc3\xb6m", 1e-10},
                                           {"inch", 0.0254},
                                           {"inche", 0.0254},
                                           {"microinch", 2.54e-8},
                                           {"microinche", 2.54e-8},
                                           {"thou", 2.54e-5},
                                           {"mil", 2.54e-5}};
enum {
    UNIT_COUNT = sizeof UNITS / sizeof UNITS[0],
    WORD_COUNT = sizeof WORDS / sizeof WORDS[0],
};

bool length_unit_metres(const char *name, size_t size, double *metres) {
    while (size > 0 && strchr(" \t\r\n", *name) != NULL && *name != '\0') {
        name++;
        size--;
    }
    while (size > 0 && (name[size - 1] == '\0' || strchr(" \t\r\n", name[size - 1]) != NULL))
        size--;
    for (size_t u = 0; u < UNIT_COUNT; u++)
        if (strlen(UNITS[u].name) == size && memcmp(UNITS[u].name, name, size) == 0) {
            *metres = UNITS[u].metres;
            return true;
        }
    for (size_t w = 0; w < WORD_COUNT; w++) {
        const size_t length = strlen(WORDS[w].name);
        bool plural = size == length + 1 && (name[length] | 32) == 's';
        if ((size == length || plural) && strncasecmp(WORDS[w].name, name, length) == 0) {
            *metres = WORDS[w].metres;
            return true;
        }
    }
    return false;
}

const char *length_unit_readable(double metres, double *metres_in_one) {
    static const struct length_unit READABLE[] = {
        {"m", 1}, {"mm", 1e-3}, {"\xc2\xb5m", 1e-6}, {"nm", 1e-9}, {"pm", 1e-12}};
    size_t u = 0;
    while (u < 4 && fabs(metres) < READABLE[u].metres)
        u++;
    *metres_in_one = READABLE[u].metres;
    return READABLE[u].name;
}

const char *length_unit_typed(double metres) {
    for (size_t u = 0; u < UNIT_COUNT; u++)
        if (UNITS[u].metres == metres && (unsigned char)*UNITS[u].name < 0x80)
            return UNITS[u].name;
    return NULL;
}

bool length_unit_is_metre(const char *unit) {
    return strcmp(unit, "m") == 0;
}
