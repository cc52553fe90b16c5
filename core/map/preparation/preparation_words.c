#include "core/map/preparation/preparation_words.h"
#include "core/map/length_unit.h"
#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

bool asked_length_parse(struct asked_length *out, const char *text, size_t size) {
    char number[64];
    char *end;
    double metres = 1;
    if (size == 0 || size >= sizeof number || strchr("+-.0123456789", *text) == NULL)
        return false;
    memcpy(number, text, size);
    number[size] = '\0';
    double value = strtod(number, &end);
    size_t rest = size - (size_t)(end - number);
    if (end == number || !isfinite(value) ||
        (rest > 0 && !length_unit_metres(end, strlen(end), &metres)))
        return false;
    *out = (struct asked_length){value * metres, rest > 0};
    return true;
}

/* Reads lengths separated by commas, at most `most`; *count is their number. */
static bool parse_lengths(struct asked_length *out, size_t most, size_t *count, const char *text) {
    *count = 0;
    for (;; text++) {
        size_t width = strcspn(text, ",");
        if (*count == most || !asked_length_parse(&out[*count], text, width))
            return false;
        ++*count;
        text += width;
        if (*text == '\0')
            return true;
    }
}

static int parse_units(struct preparation *out, const struct preparation_words *words,
                       struct error *err) {
    struct asked_length list[2] = {0}, one = {0};
    size_t count = 0;
    if (words->dx != NULL) {
        bool read = parse_lengths(list, 2, &count, words->dx);
        if (!read || !(list[0].value > 0) || (count == 2 && !(list[1].value > 0)) ||
            (count == 2 && list[0].has_unit != list[1].has_unit))
            return error_set(err, ERROR_INPUT,
                             "--dx %.60s: allowed are one or two lengths above 0, such as 0.5um or "
                             "0.5um,0.25um, or numbers in the unit of the map",
                             words->dx);
        out->dx = list[0];
        out->dy = count == 2 ? list[1] : (struct asked_length){0};
    }
    if (words->unit != NULL && !length_unit_metres(words->unit, strlen(words->unit), &out->unit))
        return error_set(err, ERROR_INPUT,
                         "--unit %.60s is no unit of length; allowed: m, mm, um, nm, pm, A, inch",
                         words->unit);
    if (words->z_unit == NULL)
        return 0;
    if (!length_unit_metres(words->z_unit, strlen(words->z_unit), &out->z_unit)) {
        if (!asked_length_parse(&one, words->z_unit, strlen(words->z_unit)) || !one.has_unit ||
            one.value == 0)
            return error_set(err, ERROR_INPUT,
                             "--z-unit %.60s is no unit of length; allowed: m, mm, um, nm, pm, A, "
                             "inch, or so much of one, such as 25nm",
                             words->z_unit);
        out->z_unit = one.value;
    }
    return 0;
}

static int parse_missing(struct preparation *out, const char *text, struct error *err) {
    struct asked_length list[MISSING_MOST] = {{0}};
    size_t count = 0;
    if (text == NULL)
        return 0;
    bool read = strcmp(text, "none") == 0 || parse_lengths(list, MISSING_MOST, &count, text);
    out->missing =
        (struct missing_marks){.asked = true, .count = count, .has_unit = list[0].has_unit};
    for (size_t n = 0; n < count; n++) {
        read = read && list[n].has_unit == list[0].has_unit;
        out->missing.value[n] = list[n].value;
    }
    if (read)
        return 0;
    return error_set(err, ERROR_INPUT,
                     "--missing %.60s: allowed are none, or up to %d heights with commas between, "
                     "such as -9999, all with a unit or none",
                     text, (int)MISSING_MOST);
}

static int parse_crop(struct preparation *out, const char *text, struct error *err) {
    size_t count = 0;
    if (text == NULL)
        return 0;
    bool read = parse_lengths(out->crop, 4, &count, text) && count == 4;
    for (size_t c = 0; c < 4 && read; c++) {
        const struct asked_length *length = &out->crop[c];
        read = (c < 2 ? length->value >= 0 : length->value > 0) &&
               (length->has_unit || length->value == floor(length->value));
    }
    return read ? 0
                : error_set(err, ERROR_INPUT,
                            "--crop %.60s: allowed are X0,Y0,WIDTH,HEIGHT, each a whole number of "
                            "points or a length such as 10um, width and height above 0",
                            text);
}

/* Reads one part of a filter, of `width` letters. */
static bool parse_filter_part(struct preparation *out, const char *text, size_t width) {
    static const char ROBUST[] = "robust";
    if (width == strlen(ROBUST) && strncmp(text, ROBUST, width) == 0 && !out->robust)
        return out->robust = true;
    struct asked_length *cut_off = *text == 'S'   ? &out->short_waves
                                   : *text == 'L' ? &out->long_waves
                                                  : NULL;
    return cut_off != NULL && cut_off->value == 0 && width > 2 && text[1] == '=' &&
           asked_length_parse(cut_off, text + 2, width - 2) && cut_off->value > 0;
}

static int parse_filter(struct preparation *out, const char *text, struct error *err) {
    bool read = true;
    if (text == NULL)
        return 0;
    for (const char *at = text; read; at++) {
        const size_t width = strcspn(at, ",");
        read = parse_filter_part(out, at, width);
        at += width;
        if (*at == '\0')
            break;
    }
    if (read && (out->short_waves.value > 0 || out->long_waves.value > 0))
        return 0;
    return error_set(err, ERROR_INPUT,
                     "--filter %.60s: allowed are S=LENGTH, L=LENGTH and robust with commas "
                     "between, such as S=2.5um,L=0.8mm, lengths above 0",
                     text);
}

/* Reads a whole number of points, 1 to 2^31, and moves *at behind it. */
static bool parse_points(size_t *out, const char **at) {
    char *end;
    if (!isdigit((unsigned char)**at))
        return false;
    const unsigned long long points = strtoull(*at, &end, 10);
    *at = end;
    *out = (size_t)points;
    return points > 0 && points <= 1ULL << 31;
}

/* Reads one such number along x, or also one along y. */
static bool parse_points_along(size_t *x, size_t *y, const char *text) {
    bool read = parse_points(x, &text);
    if (read && *text == ',') {
        text++;
        read = parse_points(y, &text);
    }
    return read && *text == '\0';
}

static int parse_stride(struct preparation *out, const char *text, struct error *err) {
    if (text == NULL)
        return 0;
    bool read = parse_points_along(&out->stride_x, &out->stride_y, text);
    out->stride_y = out->stride_y > 0 ? out->stride_y : out->stride_x;
    if (read)
        return 0;
    return error_set(err, ERROR_INPUT,
                     "--stride %.60s: allowed are one or two whole numbers above 0, such as 2 or "
                     "2,1 for every second column",
                     text);
}

static int parse_resample(struct preparation *out, const char *text, struct error *err) {
    struct asked_length *spacing = &out->resample_dx;
    if (text == NULL)
        return 0;
    const bool named = strncmp(text, "dx=", 3) == 0;
    const char *length = named ? text + 3 : text;
    if (asked_length_parse(spacing, length, strlen(length)) && (named || spacing->has_unit) &&
        spacing->value > 0)
        return 0;
    *spacing = (struct asked_length){0};
    if (parse_points_along(&out->resample_x, &out->resample_y, text) && out->resample_x > 1)
        return 0;
    return error_set(err, ERROR_INPUT,
                     "--resample %.60s: allowed are a number of points along x or along both, such "
                     "as 512 or 512,256, or a spacing such as 0.5um or dx=0.5",
                     text);
}

/* Reads a number with nothing behind it. */
static bool parse_number(double *out, const char *text) {
    char *end;
    if (strchr("+-.0123456789", *text) == NULL)
        return false;
    *out = strtod(text, &end);
    return end != text && *end == '\0' && isfinite(*out);
}

static int parse_despike(struct preparation *out, const char *text, struct error *err) {
    if (text == NULL || (parse_number(&out->despike, text) && out->despike >= 1))
        return 0;
    return error_set(err, ERROR_INPUT,
                     "--despike %.60s: allowed is a number of robust deviations, 1 or more", text);
}

static int parse_tip(struct preparation *out, const char *text, struct error *err) {
    static const char NAME[] = "tip=", HOLES[] = ",holes";
    if (text == NULL)
        return 0;
    const char *radius = strncmp(text, NAME, strlen(NAME)) == 0 ? text + strlen(NAME) : text;
    const size_t width = strcspn(radius, ",");
    out->tip_holes = strcmp(radius + width, HOLES) == 0;
    if (asked_length_parse(&out->tip, radius, width) && out->tip.value > 0 &&
        (out->tip_holes || radius[width] == '\0'))
        return 0;
    return error_set(err, ERROR_INPUT,
                     "--deconvolve %.60s: allowed are tip=RADIUS and tip=RADIUS,holes, the radius "
                     "a length above 0 such as 10nm",
                     text);
}

static int parse_turn(struct preparation *out, const char *text, struct error *err) {
    if (text == NULL || (parse_number(&out->turn, text) && fabs(out->turn) <= 360))
        return 0;
    return error_set(err, ERROR_INPUT,
                     "--rotate %.60s: allowed are degrees, -360 to 360, counter-clockwise", text);
}

static int parse_extend(struct preparation *out, const char *text, struct error *err) {
    char *end = NULL;
    if (text == NULL)
        return 0;
    errno = 0;
    out->extend = true;
    out->extend_seed = isdigit((unsigned char)*text) ? strtoull(text, &end, 10) : 0;
    if (end != NULL && *end == '\0' && errno == 0)
        return 0;
    return error_set(err, ERROR_INPUT,
                     "--extend %.60s: allowed is the number of a draw, 0 to 2^64 - 1", text);
}

int preparation_parse(struct preparation *out, const struct preparation_words *words,
                      struct error *err) {
    struct preparation asked = {.boundary = (enum asked_boundary)words->boundary,
                                .detrend = (enum asked_detrend)words->detrend,
                                .window = (enum map_window)words->window,
                                .degroove = words->degroove,
                                .fill = words->fill,
                                .denoise = words->denoise,
                                .lines = (enum scan_lines)words->lines,
                                .lines_along = (enum scan_axis)words->lines_along,
                                .transpose = words->transpose};
    int status = parse_units(&asked, words, err);
    if (status == 0)
        status = parse_missing(&asked, words->missing, err);
    if (status == 0)
        status = parse_crop(&asked, words->crop, err);
    if (status == 0)
        status = parse_stride(&asked, words->stride, err);
    if (status == 0)
        status = parse_despike(&asked, words->despike, err);
    if (status == 0)
        status = parse_tip(&asked, words->tip, err);
    if (status == 0)
        status = parse_turn(&asked, words->rotate, err);
    if (status == 0)
        status = parse_filter(&asked, words->filter, err);
    if (status == 0)
        status = parse_resample(&asked, words->resample, err);
    if (status == 0)
        status = parse_extend(&asked, words->extend, err);
    if (status == 0)
        *out = asked;
    return status;
}
