/* Studies that ask for an error: how many of their points are within it, and within the error that
 * they report, against references of long cells and fine meshes; and what a study of the model full
 * at 1 % and 0.2 % takes against plain sampling of it, without the law difference, which is no
 * error.
 *
 * bench_target [FIRST [COUNT [SEEDS]]]: some of the questions, numbered from 1. */
#include "tests/support/target_coverage.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SEEDS = 6 };

#define GAUSSIAN "\"distribution\":\"gaussian\""
#define WEIBULL(kind, shape) "\"distribution\":\"weibull_" kind "\",\"shape\":" shape
#define LAW ",\"law\":\"translation\""
/* Areas of 0.02 to 0.6. The lightest takes most: it is left out where errors are small. */
#define LOADS "[0.01,0.03,0.1,0.3]"
#define HEAVIER "[0.03,0.1,0.3]"
#define HEAVY "[0.1,0.3]"

static const struct coverage_scene SMOOTH = {GAUSSIAN, 1, 0.8, 4, LOADS},
                                   MIDDLE = {GAUSSIAN, 1, 0.5, 2, HEAVIER},
                                   ROUGH = {GAUSSIAN, 1, 0.3, 2, LOADS},
                                   PEAKS = {WEIBULL("max", "1"), 1, 0.8, 2, LOADS},
                                   PITS = {WEIBULL("min", "1"), 1, 0.8, 2, LOADS},
                                   PITS_HEAVY = {WEIBULL("min", "1"), 1, 0.8, 2, HEAVY},
                                   LOW = {WEIBULL("min", "2"), 1, 0.6, 2, LOADS},
                                   HIGH = {WEIBULL("max", "2"), 1, 0.9, 3, HEAVIER},
                                   SURFACE = {GAUSSIAN, 2, 0.8, 2, LOADS},
                                   SURFACE_LOW = {WEIBULL("min", "2"), 2, 0.5, 2, LOADS},
                                   PRESSED = {GAUSSIAN, 2, 0.8, 2, HEAVY},
                                   PRESSED_LOW = {WEIBULL("min", "2"), 2, 0.8, 2, HEAVY};
/* Of the law of translation, which has a limit in long cells. */
static const struct coverage_scene OF_PITS = {WEIBULL("min", "1") LAW, 1, 0.8, 4, LOADS},
                                   OF_PEAKS = {WEIBULL("max", "1") LAW, 1, 0.8, 4, HEAVIER},
                                   OF_ROUGH = {WEIBULL("min", "1.5") LAW, 1, 0.5, 2, HEAVIER},
                                   OF_LOW = {WEIBULL("min", "2") LAW, 1, 0.6, 4, LOADS},
                                   OF_HIGH = {WEIBULL("max", "2") LAW, 1, 0.9, 3, HEAVIER},
                                   OF_EVEN = {WEIBULL("min", "3.602") LAW, 1, 0.8, 2, HEAVY},
                                   OF_LOGS = {"\"distribution\":\"lognormal\",\"shape\":0.5" LAW, 1,
                                              0.8, 4, HEAVIER},
                                   OF_SURFACE = {WEIBULL("min", "1") LAW, 2, 0.8, 2, HEAVIER},
                                   OF_PLATEAU = {WEIBULL("max", "1.5") LAW, 2, 0.8, 2, HEAVY};

static const struct coverage_question QUESTIONS[] = {{&SMOOTH, "halfspace", NULL, 0.01},
                                                     {&MIDDLE, "halfspace", NULL, 0.005},
                                                     {&ROUGH, "halfspace", NULL, 0.05},
                                                     {&PITS, "halfspace", NULL, 0.02},
                                                     {&HIGH, "halfspace", "mean_gap", 0.02},
                                                     {&LOW, "layered", NULL, 0.02},
                                                     {&PEAKS, "layered", NULL, 0.05},
                                                     {&HIGH, "layered", NULL, 0.01},
                                                     {&SMOOTH, "full", NULL, 0.02},
                                                     {&PITS_HEAVY, "full", NULL, 0.01},
                                                     {&PITS, "full", NULL, 0.05},
                                                     {&PEAKS, "full", NULL, 0.02},
                                                     {&MIDDLE, "full", "mean_gap", 0.05},
                                                     {&SURFACE, "halfspace", NULL, 0.02},
                                                     {&SURFACE_LOW, "halfspace", NULL, 0.05},
                                                     {&PRESSED, "layered", NULL, 0.05},
                                                     {&PRESSED, "full", NULL, 0.05},
                                                     {&PRESSED_LOW, "full", NULL, 0.05},
                                                     {&OF_PITS, "halfspace", NULL, 0.02},
                                                     {&OF_PEAKS, "halfspace", NULL, 0.01},
                                                     {&OF_ROUGH, "halfspace", NULL, 0.05},
                                                     {&OF_LOW, "layered", NULL, 0.02},
                                                     {&OF_HIGH, "layered", NULL, 0.01},
                                                     {&OF_LOGS, "halfspace", NULL, 0.02},
                                                     {&OF_EVEN, "full", NULL, 0.02},
                                                     {&OF_PEAKS, "full", NULL, 0.05},
                                                     {&OF_SURFACE, "halfspace", NULL, 0.05},
                                                     {&OF_PLATEAU, "layered", NULL, 0.05}};
enum { COUNT = sizeof QUESTIONS / sizeof *QUESTIONS };

/* Realisations on long cells are those of an error of 1 %; for others they are fewer or more.
 * Gaussian profiles, and translated ones, come to their limit on shorter cells than others. */
static const struct coverage_effort PROFILES = {240, 100,   40,          256,        64,
                                                16,  "[8]", "[8,16,32]", "[8,16,32]"},
                                    OTHERS = {60, 100,   40,          1024,       64,
                                              16, "[8]", "[8,16,32]", "[8,16,32]"},
                                    SURFACES = {100, 20,    16,         12,        6,
                                                1,   "[4]", "[4,8,16]", "[4,8,16]"};
enum { REALISATIONS_LEAST = 24 };

#define COSTLY(error, heights)                                                                     \
    "{\"name\":\"area\",\"kind\":\"contact\",\"seed\":1,\"target\":{\"error\":" error              \
    "},\"surface\":{\"dimension\":1,\"hurst\":0.8,\"wavelength_ratio\":8,\"rms_slope\":0.1,"       \
    "\"heights\":{" heights "}},\"contact\":{\"model\":\"full\",\"law_difference\":\"none\","      \
    "\"pressures\":{\"to\":0.3,\"steps\":10}}}"

/* Points, and those within the error asked for, within the larger of that and the error reached,
 * and within the error that the curve reports of each. The latter may be as small as that of the
 * reference; then the root of the sum of their squares is allowed. */
struct counts {
    int points, asked, reached, told;
    double cpu_seconds;
};

static void print_head(void) {
    puts("             error        points within the error");
    puts("   asked  reached reference  points  asked  reached  told  worst  work/plain    CPU");
}

/* Adds a study to the counts, and the largest of its errors over the reported ones to worst. */
static void count(const struct coverage_question *question, const struct coverage_points *answer,
                  const struct coverage_points *reference, struct counts *counts, double *worst) {
    for (int k = 0; k < answer->count; k++) {
        double off = fabs(answer->y[k] - reference->y[k]);
        double asked = question->error * fabs(reference->y[k]);
        counts->points++;
        counts->asked += off <= asked;
        counts->reached += off <= fmax(question->error, answer->reached) * fabs(reference->y[k]);
        counts->told += off <= hypot(coverage_told(answer, k), coverage_told(reference, k));
        *worst = fmax(*worst, off / asked);
    }
    counts->cpu_seconds += answer->cpu_seconds;
}

/* By load: what all seeds err by in the mean, and their scatter, in percent. */
static void print_loads(int seeds, const struct coverage_points *answers,
                        const struct coverage_points *reference) {
    printf("          by load, %%: mean error +- of the mean (reference +-, told)");
    for (int k = 0; k < reference->count; k++) {
        double y = reference->y[k], mean = 0, square = 0, told = 0;
        for (int s = 0; s < seeds; s++) {
            mean += (answers[s].y[k] / y - 1) / seeds;
            square += pow(answers[s].y[k] / y - 1, 2) / seeds;
            told = fmax(told, coverage_told(&answers[s], k) / fabs(y));
        }
        printf("; %.2f +- %.2f (%.2f, %.2f)", 100 * mean,
               100 * sqrt(fmax(0, square - mean * mean) / seeds),
               100 * coverage_told(reference, k) / fabs(y), 100 * told);
    }
    puts("");
}

/* Returns 0, or 1 where a study fails. */
static int cover(const struct coverage_question *question, int seeds, struct counts *all) {
    struct coverage_points answers[64], reference;
    struct counts own = {0};
    double worst = 0, reached = 0, work = 0, plain = 0, error = 0;
    const char *heights = question->scene->heights;
    bool limited = strcmp(heights, GAUSSIAN) == 0 || strstr(heights, "translation") != NULL;
    struct coverage_effort effort = question->scene->dimension > 1 ? SURFACES
                                    : limited                      ? PROFILES
                                                                   : OTHERS;
    effort.realisations =
        (int)fmax(REALISATIONS_LEAST, 0.01 / question->error * effort.realisations);
    if (!coverage_reference(question, &effort, &reference))
        return 1;
    for (int s = 0; s < seeds; s++) {
        if (!coverage_ask(question, s + 1, &answers[s]) || answers[s].count != reference.count)
            return 1;
        count(question, &answers[s], &reference, &own, &worst);
        reached = fmax(reached, answers[s].reached);
        work += answers[s].work;
        plain += answers[s].plain_work;
    }
    for (int k = 0; k < reference.count; k++)
        error = fmax(error, reference.standard_error[k] / fabs(reference.y[k]));
    printf("%7.3g%% %7.3g%% %8.2g%% %7d %6d %8d %5d %6.2f %11.2g %4.0f s  %s, %s, %s, {%s}, H %g, "
           "ratio %g; reference %.0f s\n",
           100 * question->error, 100 * reached, 100 * error, own.points, own.asked, own.reached,
           own.told, worst, work / plain, own.cpu_seconds,
           question->scene->dimension == 1 ? "2D" : "3D", question->model,
           question->quantity != NULL ? question->quantity : "contact_area",
           question->scene->heights, question->scene->hurst, question->scene->wavelength_ratio,
           reference.cpu_seconds);
    print_loads(seeds, answers, &reference);
    fflush(stdout);
    all->points += own.points;
    all->asked += own.asked;
    all->reached += own.reached;
    all->told += own.told;
    all->cpu_seconds += own.cpu_seconds + reference.cpu_seconds;
    return 0;
}

static int cost(const char *name, const char *text) {
    struct coverage_points points;
    if (!coverage_run(text, "contact_area", "full", "edges", &points))
        return 1;
    printf("%s, full: reached %.3g %%, work %.3g, plain sampling %.3g: 1/%.3g; %.0f s of "
           "CPU\n",
           name, 100 * points.reached, points.work, points.plain_work,
           points.plain_work / points.work, points.cpu_seconds);
    return 0;
}

int main(int argc, char **argv) {
    long first = argc > 1 ? strtol(argv[1], NULL, 10) - 1 : 0;
    long last = argc > 2 ? first + strtol(argv[2], NULL, 10) : COUNT;
    long seeds = argc > 3 ? strtol(argv[3], NULL, 10) : SEEDS;
    struct counts all = {0};
    if (first < 0 || last > COUNT || seeds < 1 || seeds > 64)
        return 2;
    print_head();
    for (long a = first; a < last; a++)
        if (cover(&QUESTIONS[a], (int)seeds, &all) != 0) {
            printf("question %ld: a study failed\n", a + 1);
            return 1;
        }
    printf("of %d points %d are within the error asked, %d within it or what was reached, %d "
           "within what is told of them; %.0f s of CPU\n",
           all.points, all.asked, all.reached, all.told, all.cpu_seconds);
    if (argc > 1)
        return 0;
    return cost("Gaussian, 1 %", COSTLY("0.01", GAUSSIAN)) != 0 ||
           cost("Weibull minimum, C = 1, 1 %", COSTLY("0.01", WEIBULL("min", "1"))) != 0 ||
           cost("Weibull minimum, C = 1, 0.2 %", COSTLY("0.002", WEIBULL("min", "1"))) != 0;
}
