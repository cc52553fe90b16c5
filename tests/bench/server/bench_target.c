/* Studies that ask for an error: how many points are within it, against plain sampling; and the
 * counted work of a study at 1 % of the model full against plain sampling of it. */
#include "tests/support/target_coverage.h"
#include <stdlib.h>

enum { SEEDS = 10, REFERENCES = 150 };

static const struct coverage_question QUESTIONS[] = {
    {"\"distribution\":\"gaussian\"", "halfspace", 0.8, 0.05, 1},
    {"\"distribution\":\"gaussian\"", "layered", 0.5, 0.02, 1},
    {"\"distribution\":\"weibull_min\",\"shape\":2", "halfspace", 0.8, 0.02, 1},
    {"\"distribution\":\"weibull_max\",\"shape\":2", "layered", 0.8, 0.05, 1}};

static const char COSTLY[] =
    "{\"name\":\"area\",\"kind\":\"contact\",\"seed\":1,\"target\":{\"error\":0.01},\"surface\":{"
    "\"dimension\":1,\"hurst\":0.8,\"wavelength_ratio\":8,\"rms_slope\":0.1},\"contact\":{"
    "\"model\":\"full\",\"pressures\":{\"to\":0.3,\"steps\":10}}}";

/* Points within the error asked for, and how many there are. */
static int cover(const struct coverage_question *question, int *within, int *points) {
    struct coverage_points answer, reference;
    struct coverage_question one = *question;
    double largest = 0;
    int own = 0;
    if (!coverage_ask(&one, REFERENCES, &reference))
        return 1;
    for (one.seed = 1; one.seed <= SEEDS; one.seed++) {
        if (!coverage_ask(&one, 0, &answer))
            return 1;
        for (int k = 0; k < COVERAGE_LOADS; k++)
            own += fabs(answer.y[k] - reference.y[k]) <= question->error * reference.y[k];
        largest = fmax(largest, answer.reached);
    }
    printf("%s, %s, H %g, error asked %g, told up to %.3g: %d of %d points within it; reference "
           "+-%.2g\n",
           question->heights, question->model, question->hurst, question->error, largest, own,
           SEEDS * COVERAGE_LOADS, reference.error[0] / reference.y[0]);
    *within += own;
    *points += SEEDS * COVERAGE_LOADS;
    return 0;
}

int main(void) {
    int within = 0, points = 0;
    struct coverage_points costly;
    for (size_t a = 0; a < sizeof QUESTIONS / sizeof *QUESTIONS; a++)
        if (cover(&QUESTIONS[a], &within, &points) != 0)
            return 1;
    printf("coverage: %d of %d points\n", within, points);
    if (!coverage_run(COSTLY, &costly))
        return 1;
    printf("full at 1 %%: reached %.3g, work %.3g, plain sampling for chance alone %.3g: 1/%.3g\n",
           costly.reached, costly.work, costly.plain_work, costly.plain_work / costly.work);
    return 0;
}
