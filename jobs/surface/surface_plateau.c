#include "jobs/surface/surface_plateau.h"
#include "core/surface/spectrum.h"
#include <math.h>
#include <stdlib.h>

static const double ROUNDING = 1e-9; /* relative: of numbers that should be equal */

static const char RMS_RATIO[] = "/surface/plateau/rms_ratio", OFFSET[] = "/surface/plateau/offset",
                  MATERIAL_RATIO[] = "/surface/plateau/material_ratio",
                  HURST[] = "/surface/plateau/hurst",
                  WAVELENGTH_RATIO[] = "/surface/plateau/wavelength_ratio",
                  ROLLOFF_RATIO[] = "/surface/plateau/rolloff_ratio",
                  LENGTH_RATIO[] = "/surface/plateau/length_ratio",
                  ANISOTROPY[] = "/surface/plateau/anisotropy",
                  LAY_ANGLE[] = "/surface/plateau/lay_angle";

static double number_or(struct values *values, const char *path, double usual) {
    const double number = values_number(values, path);
    return isnan(number) ? usual : number;
}

/* Returns whether a plateau is asked for; a row of one without its RMS height is a fault. */
static bool is_asked(struct values *values) {
    static const char *const OTHERS[] = {OFFSET,           MATERIAL_RATIO, HURST,
                                         WAVELENGTH_RATIO, ROLLOFF_RATIO,  LENGTH_RATIO,
                                         ANISOTROPY,       LAY_ANGLE};
    if (values_is_given(values, RMS_RATIO))
        return true;
    for (size_t a = 0; a < sizeof OTHERS / sizeof *OTHERS; a++)
        if (values_is_given(values, OTHERS[a]))
            values_fault(values, OTHERS[a], "belongs to a plateau: give its rms_ratio, too");
    return false;
}

/* What the theory of stratified faces takes for granted of the surface with the valleys. */
static void check_valleys(const struct valley_face *valleys, struct values *values) {
    if (valleys->options->heights.type != HEIGHTS_GAUSSIAN)
        values_fault(values, "/surface/heights/distribution",
                     "a stratified face is the lower of two Gaussian surfaces; allowed beside a "
                     "plateau: \"gaussian\"");
}

/* Reads how high the plateau is, by one of two rows. */
static double read_offset(double rms_ratio, struct values *values) {
    const double offset = values_number(values, OFFSET);
    const double share = values_number(values, MATERIAL_RATIO);
    if (isnan(offset) == isnan(share))
        values_fault(values, isnan(offset) ? OFFSET : MATERIAL_RATIO,
                     "give one of offset and material_ratio: how high the plateau is");
    else if (!isnan(share) && !(rms_ratio < 1))
        values_fault(values, MATERIAL_RATIO,
                     "%g: the lines of two surfaces of one RMS height do not cross; allowed with "
                     "rms_ratio 1: offset",
                     share);
    return isnan(share) ? offset : stratified_offset(rms_ratio, share);
}

static void read_lay(const struct valley_face *valleys, double length_ratio,
                     struct spectrum *spectrum, struct values *values) {
    const double anisotropy = number_or(values, ANISOTROPY, valleys->spectrum->anisotropy);
    const double degrees = values_number(values, LAY_ANGLE);
    spectrum->anisotropy = anisotropy;
    if (anisotropy > 1 && valleys->dimension == 1)
        values_fault(values, ANISOTROPY, "%g: profiles have one direction", anisotropy);
    else if (anisotropy > length_ratio * (1 + ROUNDING))
        values_fault(values, ANISOTROPY,
                     "%g: a cell of %g longest waves does not hold one that is so many times as "
                     "long",
                     anisotropy, length_ratio);
    if (anisotropy > 1)
        spectrum->lay_angle = isnan(degrees) ? valleys->spectrum->lay_angle : degrees * M_PI / 180;
}

static void read_spectrum(const struct valley_face *valleys, struct spectrum *spectrum,
                          struct values *values) {
    const bool affine = valleys->spectrum->type == SPECTRUM_SELF_AFFINE;
    const double none = (double)NAN;
    const double hurst = number_or(values, HURST, affine ? valleys->spectrum->hurst : none);
    const double ratio =
        number_or(values, WAVELENGTH_RATIO, affine ? valleys->wavelength_ratio : none);
    const double rolloff = number_or(values, ROLLOFF_RATIO, 1);
    const double length_ratio = number_or(values, LENGTH_RATIO, valleys->length_ratio);
    if (isnan(hurst))
        values_fault(values, HURST, "missing: /surface has none of its own");
    if (isnan(ratio))
        values_fault(values, WAVELENGTH_RATIO, "missing: /surface has no band of its own");
    if (rolloff > ratio * (1 + ROUNDING))
        values_fault(values, ROLLOFF_RATIO,
                     "%g is more than wavelength_ratio, %g: the roll-off lies within the band",
                     rolloff, ratio);
    const double longest = valleys->lx / length_ratio;
    *spectrum = (struct spectrum){.type = SPECTRUM_SELF_AFFINE,
                                  .hurst = hurst,
                                  .wavelength_long = longest,
                                  .wavelength_rolloff = longest / rolloff,
                                  .wavelength_short = longest / ratio,
                                  .scale = SCALE_NONE};
    read_lay(valleys, length_ratio, spectrum, values);
}

int surface_plateau_fill(struct plateau_face **out, const struct valley_face *valleys,
                         struct values *values, struct error *err) {
    const size_t before = values_fault_count(values);
    *out = NULL;
    if (!is_asked(values))
        return 0;
    struct plateau_face face = {.rms_ratio = values_number(values, RMS_RATIO),
                                .options = *valleys->options};
    check_valleys(valleys, values);
    face.offset = read_offset(face.rms_ratio, values);
    read_spectrum(valleys, &face.spectrum, values);
    if (values_fault_count(values) != before)
        return 0;
    *out = array_create(1, sizeof **out);
    if (*out == NULL)
        return error_memory(err, sizeof face, "a plateau");
    **out = face;
    return 0;
}
