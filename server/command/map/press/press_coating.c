#include "server/command/map/press/press_coating.h"
#include "core/map/length_unit.h"
#include "server/show/quantity.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { PARTS_MOST = 3 };

/* The words between the commas. */
struct words {
    size_t count, size[PARTS_MOST];
    const char *of[PARTS_MOST];
};

static bool split(const char *text, struct words *out) {
    *out = (struct words){0};
    for (const char *from = text; out->count < PARTS_MOST; from++) {
        size_t size = strcspn(from, ",");
        out->of[out->count] = from;
        out->size[out->count++] = size;
        from += size;
        if (*from == '\0')
            return out->count >= 2;
    }
    return false;
}

/* Reads a number alone. */
static bool number_of(const char *text, size_t size, double *out) {
    char *end;
    double value = strtod(text, &end);
    if (size == 0 || end != text + size || !isfinite(value))
        return false;
    *out = value;
    return true;
}

static int refuse(struct error *err, const char *text, const char *allowed) {
    return error_set(err, ERROR_INPUT, "--coating %.60s: %s", text, allowed);
}

static int parse_thickness(struct coating *out, const struct words *words, const char *text,
                           const struct height_map *map, struct error *err) {
    bool metres = length_unit_is_metre(map->xy_unit);
    if (metres && !quantity_parse(words->of[0], words->size[0], "m", &out->thickness))
        return refuse(err, text,
                      "the thickness is a length above 0 with its unit, such as 200nm,0.5");
    if (!metres &&
        !(number_of(words->of[0], words->size[0], &out->thickness) && out->thickness > 0))
        return refuse(err, text,
                      "the thickness is a number above 0 in the lengths of the map, which have no "
                      "unit");
    return 0;
}

static int parse_modulus(struct coating *out, const struct words *words, const char *text,
                         const struct press_words *of, struct error *err) {
    double base, pressure;
    if (number_of(words->of[1], words->size[1], &out->modulus)) {
        if (out->modulus >= COATING_LEAST && out->modulus <= COATING_MOST)
            return 0;
        return refuse(err, text, "the modulus over that of the block is 0.001 to 1000");
    }
    if (!quantity_parse(words->of[1], words->size[1], "Pa", &pressure))
        return refuse(err, text,
                      "the modulus is a number, over that of the block, or a pressure with its "
                      "unit, such as 4GPa");
    if (of->modulus == NULL || !quantity_parse(of->modulus, strlen(of->modulus), "Pa", &base))
        return refuse(err, text,
                      "a modulus with a unit needs that of the block: --modulus, such as 210GPa");
    out->modulus = pressure / base;
    if (out->modulus >= COATING_LEAST && out->modulus <= COATING_MOST)
        return 0;
    return refuse(err, text, "the modulus is 0.001 to 1000 times that of the block");
}

int press_coating_parse(struct coating *out, const char *text, const struct press_words *words,
                        const struct height_map *map, struct error *err) {
    struct words parts;
    *out = (struct coating){0};
    if (text == NULL)
        return 0;
    struct coating coating = {.poisson = words->poisson};
    if (!split(text, &parts))
        return refuse(err, text,
                      "allowed is THICKNESS,MODULUS or THICKNESS,MODULUS,POISSON, such as "
                      "200nm,0.5,0.4");
    int status = parse_thickness(&coating, &parts, text, map, err);
    if (status == 0)
        status = parse_modulus(&coating, &parts, text, words, err);
    if (status == 0 && parts.count == PARTS_MOST &&
        !(number_of(parts.of[2], parts.size[2], &coating.poisson) && coating.poisson >= 0 &&
          coating.poisson <= 0.4999))
        status = refuse(err, text, "Poisson's ratio is 0 to 0.4999");
    if (status == 0)
        *out = coating;
    return status;
}
