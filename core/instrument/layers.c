#include "core/instrument/layers.h"
#include "core/file/plain_text.h"
#include "core/instrument/formats.h"
#include "core/instrument/unit_of.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Writes "1 'Topography' [m], 2 'Phase' [deg]" to text, and the number of the others where it does
 * not hold them all. */
static void list_layers(const struct layer *layers, size_t count, char *text, size_t room) {
    size_t used = 0;
    text[0] = '\0';
    for (size_t layer = 0; layer < count; layer++) {
        char one[80];
        snprintf(one, sizeof one, "%s%zu '%.30s' [%.12s]", layer > 0 ? ", " : "", layer + 1,
                 layers[layer].title != NULL ? layers[layer].title : "", layers[layer].z_unit);
        size_t length = strlen(one);
        if (used + length + 24 > room) {
            snprintf(text + used, room - used, " and %zu more", count - layer);
            return;
        }
        memcpy(text + used, one, length + 1);
        used += length;
    }
}

static bool by_title(const struct layer *layers, size_t count, const char *asked, size_t *out) {
    for (size_t layer = 0; layer < count; layer++)
        if (layers[layer].title != NULL && strcmp(layers[layer].title, asked) == 0) {
            *out = layer;
            return true;
        }
    return false;
}

static bool by_position(size_t count, const char *asked, size_t *out) {
    if (strspn(asked, "0123456789") != strlen(asked) || strlen(asked) < 1 || strlen(asked) > 9)
        return false;
    size_t position = strtoul(asked, NULL, 10);
    if (position < 1 || position > count)
        return false;
    *out = position - 1;
    return true;
}

void layer_say(char *said, const char *title, size_t layer, size_t count) {
    if (said == NULL)
        return;
    *said = '\0';
    if (count < 2)
        return;
    if (title != NULL)
        snprintf(said, INSTRUMENT_LAYER, "%zu '%.64s' of %zu", layer + 1, title, count);
    else
        snprintf(said, INSTRUMENT_LAYER, "%zu of %zu", layer + 1, count);
    (void)text_make_plain(said);
}

/* Returns the first layer whose unit is a length, or else the first. */
static size_t first_heights(const struct layer *layers, size_t count) {
    double metres;
    for (size_t layer = 0; layer < count; layer++)
        if (unit_is_length(layers[layer].z_unit, &metres))
            return layer;
    return 0;
}

int layer_choose(const struct layer *layers, size_t count, const char *asked, const char *others,
                 size_t *out, char *said, struct error *err) {
    if (count == 0)
        return error_set(err, ERROR_INPUT, "the file holds no layer of heights%s", others);
    if (asked == NULL)
        *out = first_heights(layers, count);
    if (asked == NULL || by_title(layers, count, asked, out) || by_position(count, asked, out)) {
        layer_say(said, layers[*out].title, *out, count);
        return 0;
    }
    char text[300];
    list_layers(layers, count, text, sizeof text);
    return error_set(err, ERROR_INPUT,
                     "the file has no layer '%.40s'; allowed: a title or number of %s%s", asked,
                     text, others);
}

int layer_check_only(const char *asked, struct error *err) {
    if (asked == NULL || strcmp(asked, "1") == 0)
        return 0;
    return error_set(err, ERROR_INPUT, "the file has no layer '%.40s'; allowed: 1, its only one",
                     asked);
}
