#include "server/command/map/press/press_warnings.h"
#include "core/statistics/grooves/map_grooves.h"
#include "jobs/maps/map_artefact_words.h"
#include "jobs/maps/map_noise.h"
#include <stdio.h>

/* Of larger maps the spectrum would take longer than a load. */
static bool is_left_out(const struct height_map *map, const struct preparation_record *record) {
    enum { POINTS_SEEN = 1 << 20 };
    return grid_points(&map->grid) > POINTS_SEEN || record->window_power < 1;
}

/* Slopes with noise in them are no measure of loads; press takes the map as it is. */
static int warn_of_noise(const char *path, const struct height_map *map,
                         const struct preparation_record *record, struct error *err) {
    const struct measured_map measured = {&map->grid, map->z, record->boundary};
    struct map_noise noise;
    if (is_left_out(map, record))
        return 0;
    int status = map_noise_measure(&noise, &measured, err);
    if (status == 0 && noise.governs)
        fprintf(stderr,
                "rugo press: warning: %s: noise governs the slopes, whose RMS is %.3g with it and "
                "%.3g without; --denoise takes it out (`rugo characterise` shows it)\n",
                path, noise.slope, noise.without);
    return status;
}

/* Theories beside the contact are those of random faces. */
static int warn_of_grooves(const char *path, const struct height_map *map,
                           const struct preparation_record *record, struct error *err) {
    const struct measured_map measured = {&map->grid, map->z, record->boundary};
    struct map_grooves grooves;
    if (is_left_out(map, record))
        return 0;
    int status = map_grooves_find(&grooves, &measured, err);
    if (status == 0 && grooves.families > 0)
        fprintf(stderr,
                "rugo press: warning: %s: the map has grooves, for which theories of random faces "
                "do not hold; `rugo characterise` shows them, --degroove takes them out\n",
                path);
    return status;
}

/* So are those that hold what the instrument left. */
static void warn_of_artefacts(const char *path, const struct height_map *map,
                              const struct preparation_record *record) {
    char sentences[ARTEFACT_SENTENCES_MOST][ARTEFACT_SENTENCE_SIZE];
    const size_t count =
        map_artefact_sentences(sentences, &record->artefacts, &map->grid, map->z_unit, true);
    for (size_t n = 0; n < count; n++)
        fprintf(stderr, "rugo press: warning: %s: %s\n", path, sentences[n]);
}

int press_warn(const char *path, const struct height_map *map,
               const struct preparation_record *record, struct error *err) {
    warn_of_artefacts(path, map, record);
    int status = warn_of_noise(path, map, record, err);
    return status == 0 ? warn_of_grooves(path, map, record, err) : status;
}
