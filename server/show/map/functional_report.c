#include "server/show/map/functional_report.h"

static const char GROUP[] = "functional", TABLE[] = "material_ratio";

/* A value by name, and that of its error. */
struct row {
    const char *const name[2];
    double value, error;
    int power;
};
#define ROW(name, from, of, by, power)                                                             \
    { {name, name "_error"}, (from)->of, (by)->of, power }

static void add_rows(struct named_values *out, size_t n, const struct row *rows, bool has_errors) {
    for (size_t r = 0; r < n; r++) {
        named_values_add_length(out, GROUP, rows[r].name[0], rows[r].value, rows[r].power);
        if (has_errors)
            named_values_add_length(out, GROUP, rows[r].name[1], rows[r].error, rows[r].power);
    }
}

/* What a line divides the curve into: of surfaces (S) and profiles (R), of a line and the secant.
 */
#define CORE(letter, ending, from, by)                                                             \
    ROW(letter "k" ending, from, k, by, 1), ROW(letter "pk" ending, from, pk, by, 1),              \
        ROW(letter "vk" ending, from, vk, by, 1), ROW(letter "mr1" ending, from, mr1, by, 0),      \
        ROW(letter "mr2" ending, from, mr2, by, 0)

static void add_profile(struct named_values *out, const struct map_functional *found) {
    const struct functional *f = &found->found, *e = &found->errors.found;
    const struct row rows[] = {CORE("R", "", &f->line, &e->line),
                               CORE("R", "_secant", &f->secant, &e->secant)};
    const struct profile_spacing *spacing = &found->spacing;
    add_rows(out, sizeof rows / sizeof *rows, rows, found->has_errors);
    named_values_add_length(out, GROUP, "RSm", spacing->rsm, 1);
    named_values_add(out, GROUP, "RSm_elements", (double)spacing->elements);
    named_values_add_length(out, GROUP, "RSm_1997", spacing->rsm_old, 1);
    named_values_add(out, GROUP, "RSm_1997_elements", (double)spacing->elements_old);
}

static void add_surface(struct named_values *out, const struct map_functional *found) {
    const struct functional *f = &found->found, *e = &found->errors.found;
    const struct ten_points *ten = &found->ten_points;
    const struct row rows[] = {
        CORE("S", "", &f->line, &e->line), CORE("S", "_secant", &f->secant, &e->secant),
        ROW("Sxp", f, xp, e, 1),           ROW("Vmp", f, vmp, e, 1),
        ROW("Vmc", f, vmc, e, 1),          ROW("Vvc", f, vvc, e, 1),
        ROW("Vvv", f, vvv, e, 1)};
    add_rows(out, sizeof rows / sizeof *rows, rows, found->has_errors);
    named_values_add_length(out, GROUP, "S5p", ten->s5p, 1);
    named_values_add_length(out, GROUP, "S5v", ten->s5v, 1);
    named_values_add_length(out, GROUP, "S10z", ten->s10z, 1);
    named_values_add(out, GROUP, "hills", (double)ten->hills);
    named_values_add(out, GROUP, "dales", (double)ten->dales);
}

void functional_report_values(struct named_values *out, const struct map_functional *found,
                              bool profile) {
    if (profile)
        add_profile(out, found);
    else
        add_surface(out, found);
}

#define LAW(letter, from, by)                                                                      \
    {                                                                                              \
        ROW(letter "pq", from, plateau_rms, by, 1), ROW(letter "vq", from, valley_rms, by, 1),     \
            ROW(letter "mq", from, ratio, by, 0), ROW("plateau_mean", from, plateau_mean, by, 1),  \
            ROW("valley_mean", from, valley_mean, by, 1)                                           \
    }

void functional_report_plateau(struct named_values *out, const struct map_functional *found,
                               bool profile) {
    const struct plateau_law *law = &found->plateau, *e = &found->errors.plateau;
    const struct row rows[2][5] = {LAW("S", law, e), LAW("R", law, e)};
    add_rows(out, 5, rows[profile ? 1 : 0], found->has_errors);
    named_values_add(out, GROUP, "plateau_residual", law->residual);
    named_values_add(out, GROUP, "normal_residual", law->line_residual);
}

int functional_report_table(struct named_values *out, const struct map_functional *found,
                            struct error *err) {
    double *ratio = named_values_column_length(out, TABLE, "ratio", MAP_RATIOS, 0);
    double *height = named_values_column_length(out, TABLE, "height", MAP_RATIOS, 1);
    if (ratio == NULL || height == NULL)
        return error_memory(err, MAP_RATIOS * sizeof *ratio, "a table of a map");
    for (size_t r = 0; r < MAP_RATIOS; r++) {
        ratio[r] = found->ratio[r];
        height[r] = found->height[r];
    }
    return 0;
}
