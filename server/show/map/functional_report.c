#include "server/show/map/functional_report.h"

static const char GROUP[] = "functional", TABLE[] = "material_ratio";

/* Names of what a line divides the curve into, of surfaces and profiles. */
struct core_names {
    const char *k, *pk, *vk, *mr1, *mr2;
};

static void add_core(struct named_values *out, const struct core_names *names,
                     const struct material_core *core) {
    named_values_add_length(out, GROUP, names->k, core->k, 1);
    named_values_add_length(out, GROUP, names->pk, core->pk, 1);
    named_values_add_length(out, GROUP, names->vk, core->vk, 1);
    named_values_add(out, GROUP, names->mr1, core->mr1);
    named_values_add(out, GROUP, names->mr2, core->mr2);
}

static void add_profile(struct named_values *out, const struct map_functional *found) {
    static const struct core_names LINE = {"Rk", "Rpk", "Rvk", "Rmr1", "Rmr2"};
    static const struct core_names SECANT = {"Rk_secant", "Rpk_secant", "Rvk_secant", "Rmr1_secant",
                                             "Rmr2_secant"};
    const struct profile_spacing *spacing = &found->spacing;
    add_core(out, &LINE, &found->found.line);
    add_core(out, &SECANT, &found->found.secant);
    named_values_add_length(out, GROUP, "RSm", spacing->rsm, 1);
    named_values_add(out, GROUP, "RSm_elements", (double)spacing->elements);
    named_values_add_length(out, GROUP, "RSm_1997", spacing->rsm_old, 1);
    named_values_add(out, GROUP, "RSm_1997_elements", (double)spacing->elements_old);
}

static void add_surface(struct named_values *out, const struct map_functional *found) {
    static const struct core_names LINE = {"Sk", "Spk", "Svk", "Smr1", "Smr2"};
    static const struct core_names SECANT = {"Sk_secant", "Spk_secant", "Svk_secant", "Smr1_secant",
                                             "Smr2_secant"};
    const struct functional *f = &found->found;
    const struct ten_points *ten = &found->ten_points;
    const struct {
        const char *name;
        double value;
    } lengths[] = {{"Sxp", f->xp},  {"Vmp", f->vmp},   {"Vmc", f->vmc},   {"Vvc", f->vvc},
                   {"Vvv", f->vvv}, {"S5p", ten->s5p}, {"S5v", ten->s5v}, {"S10z", ten->s10z}};
    add_core(out, &LINE, &f->line);
    add_core(out, &SECANT, &f->secant);
    for (size_t n = 0; n < sizeof lengths / sizeof *lengths; n++)
        named_values_add_length(out, GROUP, lengths[n].name, lengths[n].value, 1);
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

void functional_report_plateau(struct named_values *out, const struct plateau_law *law,
                               bool profile) {
    named_values_add_length(out, GROUP, profile ? "Rpq" : "Spq", law->plateau_rms, 1);
    named_values_add_length(out, GROUP, profile ? "Rvq" : "Svq", law->valley_rms, 1);
    named_values_add(out, GROUP, profile ? "Rmq" : "Smq", law->ratio);
    named_values_add_length(out, GROUP, "plateau_mean", law->plateau_mean, 1);
    named_values_add_length(out, GROUP, "valley_mean", law->valley_mean, 1);
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
