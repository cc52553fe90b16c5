/* Small studies whose curves are known from a calm run. */
#include "tests/support/check.h"
#include "tests/support/faults/world.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define STATISTICS(realisations, heights)                                                          \
    "\"kind\":\"statistics\",\"seed\":7,\"realisations\":" #realisations ",\"surface\":{"          \
    "\"dimension\":1,\"hurst\":0.8,\"wavelength_ratio\":4,\"length_ratio\":4,"                     \
    "\"points_per_wavelength\":8" heights "},\"statistics\":{\"bins\":{\"height\":[-4,4,20],"      \
    "\"curvature\":[-8,0,10]}}"

/* The second is the first, longer: it takes over blocks of the first, and the first may be extended
 * to it. */
static const struct {
    int64_t realisations;
    const char *text; /* behind the name */
} MODELS[WORLD_MODELS + 1] = {
    {1500, STATISTICS(1500, "")},
    {2600, STATISTICS(2600, "")},
    {1100, STATISTICS(1100, ",\"heights\":{\"distribution\":[\"gaussian\",\"weibull_max\"],"
                            "\"shape\":2,\"max_iterations\":10}")},
    {24, "\"kind\":\"contact\",\"seed\":5,\"realisations\":24,\"surface\":{\"dimension\":1,"
         "\"hurst\":0.8,\"wavelength_ratio\":8,\"length_ratio\":4,\"points_per_wavelength\":8},"
         "\"contact\":{\"model\":[\"halfspace\",\"layered\"],\"levels\":[8],\"pressures\":{"
         "\"to\":0.3,\"steps\":6}}"},
    {1, "\"kind\":\"contact\",\"seed\":5,\"realisations\":1,\"surface\":{\"dimension\":1,"
        "\"hurst\":0.8,\"wavelength_ratio\":8,\"length_ratio\":256,\"points_per_wavelength\":8},"
        "\"contact\":{\"model\":\"halfspace\",\"levels\":[8],\"pressures\":{\"to\":0.3,"
        "\"steps\":30}}"},
};

char *model_text(unsigned model, const char *name) {
    char *text = NULL;
    assert_true(asprintf(&text, "{\"name\":\"%s\",%s}", name, MODELS[model].text) > 0);
    return text;
}

int64_t model_realisations(unsigned model) {
    return MODELS[model].realisations;
}

int model_find(const char *name, int64_t realisations) {
    unsigned model = 0;
    if (sscanf(name, "m%u-", &model) != 1 || model > WORLD_LONG_MODEL)
        return -1;
    if (model == 0 && realisations == MODELS[1].realisations)
        return 1;
    return realisations == MODELS[model].realisations ? (int)model : -1;
}

const char *model_cases(const char *document) {
    return strstr(document, "\"cases\":[");
}

void models_run(unsigned count) {
    for (unsigned model = 0; model < count; model++) {
        char name[WORLD_NAME], file[WORLD_NAME], out[WORLD_NAME];
        snprintf(name, sizeof name, "calm-%u", model);
        snprintf(file, sizeof file, "calm-%u.study", model);
        snprintf(out, sizeof out, "calm-%u.out", model);
        char *text = model_text(model, name);
        spit(file, text);
        free(text);
        assert_int_equal(run_rugo("calm", (const char *[]){"run", "--db", "calm.db", file, NULL}),
                         0);
        assert_int_equal(run_rugo(name, (const char *[]){"curves", "--db", "calm.db", name, NULL}),
                         0);
        char *curves = slurp(out);
        assert_non_null(model_cases(curves));
        assert_non_null(strstr(curves, "\"curves\":[{"));
        free(curves);
    }
}
