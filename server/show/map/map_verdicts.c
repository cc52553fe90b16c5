#include "server/show/map/map_verdicts.h"
#include "jobs/maps/map_artefact_words.h"
#include "server/show/map/figure/map_figure_internal.h"
#include "server/show/map/groove_report.h"
#include "server/show/map/main_values.h"
#include "server/show/plot/plot_words.h"
#include <math.h>
#include <stdarg.h>
#include <string.h>

/* SURE: a p-value below it says that something differs; of three tests of a map without faults one
 * is below it in 3 % of the maps. FITS: one above it goes with a law. SPIKY: kurtosis of heights of
 * which single ones lie far from the rest; an exponential distribution has 9. */
static const double SURE = 0.01, FITS = 0.05, SPIKY = 10;

struct verdicts {
    char (*out)[VERDICT_SIZE];
    size_t count;
};

__attribute__((format(printf, 2, 3))) static void say(struct verdicts *verdicts, const char *format,
                                                      ...) {
    va_list arguments;
    if (verdicts->count == VERDICTS_MOST)
        return;
    va_start(arguments, format);
    vsnprintf(verdicts->out[verdicts->count++], VERDICT_SIZE, format, arguments);
    va_end(arguments);
}

static void judge_errors(struct verdicts *verdicts, const struct named_values *found) {
    static const char GROUP[] = "uncertainty", NONE[] = "none: ";
    const char *errors = named_text(found, GROUP, "errors");
    const double lengths = named_number(found, GROUP, "lengths_inside");
    if (errors == NULL)
        return;
    if (strncmp(errors, NONE, strlen(NONE)) == 0)
        say(verdicts, "Errors: none are known: %s.", errors + strlen(NONE));
    else
        say(verdicts,
            "Errors: +- one standard error of a patch %.3g correlation lengths wide (95 %%: %.3g "
            "of "
            "them); [ ] a 95 %% interval.",
            lengths, named_number(found, GROUP, "factor_95"));
}

/* The deviance per degree of freedom of a law that holds is about 1 (FORMULAS.md, F18.15). */
static void judge_law(struct verdicts *verdicts, const struct named_values *found) {
    static const char GROUP[] = "spectrum_fit";
    const double deviance = named_number(found, GROUP, "deviance");
    const double limit = named_number(found, GROUP, "deviance_limit");
    if (!isfinite(deviance))
        say(verdicts, "Spectrum: no self-affine law is fitted.");
    else if (deviance <= limit)
        say(verdicts, "Spectrum: the self-affine law holds (deviance %.2g).", deviance);
    else
        say(verdicts,
            "Spectrum: the self-affine law does not hold (deviance %.2g, about 1 where it does); "
            "its "
            "intervals are widened.",
            deviance);
}

static void judge_noise(struct verdicts *verdicts, const struct map_figure *figure) {
    const struct named_values *found = figure->found;
    const char *holes = figure->record->holes > 0 ? "; holes look like noise, too" : "";
    const double measured = named_number(found, "finite_difference", "rms_slope");
    const double trusted = named_number(found, "trusted", "rms_slope");
    if (!main_values_have_noise(found))
        return;
    if (map_artefacts_count(&figure->record->artefacts)) /* there is more to be said */
        say(verdicts,
            "Noise: the RMS slope is %.3g with it and %.3g without, by the law of the spectrum%s.",
            measured, trusted, holes);
    else
        say(verdicts,
            "Noise: the RMS slope is %.3g with it and %.3g without%s. Values without noise are of "
            "the "
            "law of the spectrum, for Gaussian heights; --denoise takes it out of the map.",
            measured, trusted, holes);
}

/* Skewed heights make short waves fall off that their normal scores have, up to a sharp end; true
 * where these have one. */
static bool judge_scores(struct verdicts *verdicts, const struct map_figure *figure,
                         double length) {
    static const char GROUP[] = "spectrum_fit_scores";
    const struct figure_units units = figure_units_of(figure);
    const char *gap = *units.x_name != '\0' ? " " : "";
    const double end = named_number(figure->found, GROUP, "sharp_end") / units.x;
    if (!isfinite(end))
        return false;
    say(verdicts,
        "Short waves: they fall off below %.3g%s%s, as skewed heights make them: in normal scores "
        "the spectrum ends at %.3g%s%s, with H = %.2g [%.2g, %.2g] (group %s).",
        length, gap, units.x_name, end, gap, units.x_name,
        named_number(figure->found, GROUP, "hurst"),
        named_number(figure->found, GROUP, "hurst_low"),
        named_number(figure->found, GROUP, "hurst_high"), GROUP);
    return true;
}

static void judge_short_waves(struct verdicts *verdicts, const struct map_figure *figure) {
    static const char GROUP[] = "spectrum_fit";
    const struct figure_units units = figure_units_of(figure);
    const char *by = named_text(figure->found, GROUP, "trusted_to_by");
    const double length = named_number(figure->found, GROUP, "trusted_to") / units.x;
    const char *gap = *units.x_name != '\0' ? " " : "";
    if (by == NULL || !isfinite(length))
        return;
    if (strcmp(by, SPECTRUM_END_NAMES[SPECTRUM_END_NOISE]) == 0)
        say(verdicts, "Short waves: below %.3g%s%s they are noise.", length, gap, units.x_name);
    else if (strcmp(by, SPECTRUM_END_NAMES[SPECTRUM_END_LOW_PASS]) == 0 &&
             !judge_scores(verdicts, figure, length))
        say(verdicts,
            "Short waves: below %.3g%s%s they fall off as in an instrument that does not transmit "
            "them%s; slopes, curvatures and summits lack them.",
            length, gap, units.x_name, figure->record->holes > 0 ? ", or as holes make them" : "");
    else if (strcmp(by, SPECTRUM_END_NAMES[SPECTRUM_END_CUTOFF]) == 0)
        say(verdicts, "Short waves: the spectrum ends at %.3g%s%s.", length, gap, units.x_name);
}

static void judge_heights(struct verdicts *verdicts, const struct map_figure *figure) {
    const struct named_values *found = figure->found;
    const struct map_artefacts *artefacts = &figure->record->artefacts;
    static const char GROUP[] = "height_fit";
    const char *law = named_text(found, GROUP, "distribution");
    const double p_value = named_number(found, GROUP, "p_value");
    const double kurtosis = named_number(found, "heights", "kurtosis");
    char name[64];
    if (kurtosis > SPIKY && !map_spikes_found(artefacts))
        say(verdicts, "Heights: kurtosis %.3g, 3 of Gaussian ones: %s.", kurtosis,
            artefacts->sought ? "some parts lie far from the rest, and no single points"
                              : "single points lie far from the rest, as spikes do");
    if (law == NULL)
        return;
    plot_in_words(law, name, sizeof name);
    if (!isfinite(p_value))
        say(verdicts, "Heights: nearest to %s; without errors there is no p-value.", name);
    else if (p_value >= FITS)
        say(verdicts, "Heights: %s holds (p-value %.2g).", name, p_value);
    else
        say(verdicts, "Heights: no law of one shape holds; the nearest is %s (p-value %.2g).", name,
            p_value);
}

/* Of honed faces: what a study takes to make such ones. */
static void judge_strata(struct verdicts *verdicts, const struct named_values *found) {
    static const char GROUP[] = "functional";
    const char letter = isfinite(named_number(found, GROUP, "Rpq")) ? 'R' : 'S';
    const double plateau = named_number(found, GROUP, letter == 'R' ? "Rpq" : "Spq");
    const double valleys = named_number(found, GROUP, letter == 'R' ? "Rvq" : "Svq");
    const double ratio = named_number(found, GROUP, letter == 'R' ? "Rmq" : "Smq");
    const struct plateau_law law = {.ratio = ratio,
                                    .residual = named_number(found, GROUP, "plateau_residual"),
                                    .line_residual = named_number(found, GROUP, "normal_residual")};
    if (plateau_is_clear(&law))
        say(verdicts,
            "Heights: two laws fit better than one: a plateau above valleys, which meet at %.3g %% "
            "of the points (%cmq). Studies make such faces by \"plateau\": {\"rms_ratio\": %.3g, "
            "\"material_ratio\": %.3g} in /surface; --format study writes one with both spectra.",
            100 * ratio, letter, plateau / valleys, ratio);
}

static void judge_directions(struct verdicts *verdicts, const struct named_values *found) {
    static const char GROUP[] = "isotropy";
    const double p_value = named_number(found, GROUP, "p_value");
    if (!isfinite(p_value))
        return;
    const double ratio = named_number(found, "spectrum_fit", "lay_ratio");
    const bool grooved = isfinite(named_number(found, "grooves", "period"));
    if (p_value >= SURE)
        say(verdicts, "Directions: none differs (p-value %.2g).", p_value);
    else if (grooved && !isfinite(ratio))
        say(verdicts, "Directions: they differ (p-value %.2g), as grooves make them.", p_value);
    else if (isfinite(ratio))
        say(verdicts,
            "Directions: they differ (p-value %.2g): waves are %.3g times as long at %.3g degrees "
            "from x as across. The law of the spectrum is that of waves across.",
            p_value, ratio, named_number(found, "spectrum_fit", "lay_angle"));
    else
        say(verdicts,
            "Directions: they differ (p-value %.2g): slopes by a factor of %.3g. The law of the "
            "spectrum takes the map as isotropic, so that its intervals do not hold.",
            p_value, named_number(found, GROUP, "slope_ratio"));
}

static void judge_parts(struct verdicts *verdicts, const struct named_values *found) {
    const double p_value = named_number(found, "stationarity", "p_value");
    if (!isfinite(p_value))
        return;
    if (p_value >= SURE)
        say(verdicts, "Parts: none differs (p-value %.2g).", p_value);
    else
        say(verdicts,
            "Parts: they differ (p-value %.2g), as with a form, a step or two kinds of surface; "
            "see "
            "--detrend quadratic and --crop.",
            p_value);
}

static void judge_form(struct verdicts *verdicts, const struct map_figure *figure) {
    const struct map_form *form = &figure->measured->form;
    const struct figure_units units = figure_units_of(figure);
    const char *gap = *units.z_name != '\0' ? " " : "";
    if (map_form_found(form))
        say(verdicts,
            "Form: a bow is left, RMS %.3g%s%s (%.3g %% of the mean square height; p-value %.2g). "
            "--detrend quadratic takes it out.",
            form->height / units.z, gap, units.z_name, 100 * form->share, form->p_value);
}

static void judge_grooves(struct verdicts *verdicts, const struct map_figure *figure) {
    const struct map_grooves *grooves = &figure->measured->grooves;
    const struct figure_units units = figure_units_of(figure);
    const struct groove_units lengths = {units.x, units.z, units.x_name, units.z_name};
    char sentence[VERDICT_SIZE - 24];
    for (size_t f = 0; f < grooves->families; f++) {
        groove_sentence(&grooves->family[f], &lengths, sentence, sizeof sentence);
        say(verdicts, "Grooves: %s%s.", f > 0 ? "and " : "", sentence);
    }
    if (grooves->families > 0)
        say(verdicts,
            "Spectrum and law are those of the map without its grooves (--degroove), "
            "whose RMS height is %.3g%s%s.",
            figure->measured->rest_height / units.z, *units.z_name != '\0' ? " " : "",
            units.z_name);
}

static void judge_artefacts(struct verdicts *verdicts, const struct map_figure *figure) {
    const struct map_artefacts *artefacts = &figure->record->artefacts;
    char sentences[ARTEFACT_SENTENCES_MOST][ARTEFACT_SENTENCE_SIZE];
    const size_t count = map_artefact_sentences(sentences, artefacts, &figure->map->grid,
                                                figure->map->z_unit, false);
    for (size_t n = 0; n < count; n++)
        say(verdicts, "%s", sentences[n]);
    if (artefacts->sought && map_artefacts_count(artefacts))
        say(verdicts, "Rows marked * hold these artefacts, or follow from them: trust them when "
                      "these are out.");
}

size_t map_verdicts_list(char out[VERDICTS_MOST][VERDICT_SIZE], const struct map_figure *figure) {
    struct verdicts verdicts = {out, 0};
    judge_errors(&verdicts, figure->found);
    judge_form(&verdicts, figure);
    judge_grooves(&verdicts, figure);
    judge_law(&verdicts, figure->found);
    judge_short_waves(&verdicts, figure);
    judge_noise(&verdicts, figure);
    judge_artefacts(&verdicts, figure);
    judge_heights(&verdicts, figure);
    judge_strata(&verdicts, figure->found);
    judge_directions(&verdicts, figure->found);
    judge_parts(&verdicts, figure->found);
    return verdicts.count;
}
