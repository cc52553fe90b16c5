/* A study: a document that was checked, with its sweeps opened into cases.
 *
 * The schema knows no kind: the caller passes a table of them, NULL at the end. */
#ifndef RUGO_SCHEMA_STUDY_STUDY_H
#define RUGO_SCHEMA_STUDY_STUDY_H

#include "schema/json/json.h"
#include "schema/study/fault.h"
#include "schema/study/parameter.h"
#include <stdint.h>

/* Whether the cases of a study share their random numbers or each has its own. Cases that share
 * them are compared realisation by realisation, and their statistical errors are correlated. */
enum study_random { RANDOM_COMMON, RANDOM_INDEPENDENT };
extern const struct choice STUDY_RANDOM[];
/* Returns the sequence of random numbers (core/random.h) that a case is made of. */
uint64_t study_sequence(enum study_random random, uint64_t case_number);

/* What a case keeps of its realisations beside its results, as files of `rugo run --out`. */
struct study_kept {
    const char *path; /* static: of the parameter that names the realisations; NULL: none */
    uint64_t past;    /* number behind the last of them */
    double seconds;   /* CPU seconds of all of them on a 3 GHz core */
    double bytes;     /* of the files, about */
};

/* Among so many first realisations more have side solves than later, so that small studies have
 * some. */
enum { STUDY_EARLY = 32 };

/* The cost of a case, estimated before anything ran. */
struct study_cost {
    size_t nx, ny;       /* grid of one realisation (the finest) */
    double memory_bytes; /* peak of one worker thread; of a kind: without result_bytes */
    double seconds;      /* CPU seconds a realisation on a 3 GHz core */
    /* Of these, what only some realisations take: in the mean, its variance between realisations,
     * and at most, INFINITY without a limit; 0: all take about the same. */
    double rare_seconds, rare_variance, rare_most;
    double case_seconds;               /* the same of a case besides: merging and publishing it */
    double early_seconds[STUDY_EARLY]; /* the same of each of the first realisations besides */
    double result_bytes;   /* of a realisation in a job's result, where they grow with these */
    double relative_error; /* standard error of the main curve after one realisation, of contact
                            * at the load where it is largest; / sqrt(n) */
    uint64_t runs_most;    /* most realisations of a job; 0: no limit but that of all jobs */
    /* Of surfaces by the law "translation": the share of m0 outside the band, and of the variance
     * in the band at other waves than asked for (FORMULAS.md, F5.11). 0 without the law. */
    double law_outside, law_misfit;
    double fine_height; /* of blocks of finite elements, in lambda_s, where it is given; else 0 */
    double tolerance;   /* of solutions of contact; else 0 */
    /* Of surfaces: what was solved for nayak_alpha, and the moments of heights, where they are
     * known; else 0. */
    double wavelength_ratio, hurst, skewness, kurtosis;
    struct study_kept kept;
};

/* The kurtosis of heights that need no word. */
#define KURTOSIS_GAUSSIAN 3.0

struct study_case;
/* What the reader must know of a kind of study. */
struct study_kind {
    const char *name;
    const struct parameter_table *const *tables; /* of its parameters; NULL at the end */
    uint64_t default_realisations;
    /* Adds faults that no single range shows (and then returns 0), and estimates the cost.
     * memory_limit in bytes (0: none): checks that would take long are left out for a case that
     * exceeds it. */
    int (*check)(const struct study_kind *kind, const cJSON *parameters, double memory_limit,
                 struct fault_list *faults, struct study_cost *cost, struct error *err);
    /* Replaces values of a case, each of which fits its row, by what they stand for, such as the
     * loads of "to" and "steps". Workers, results and the store then all have the same numbers. The
     * document says what the study sweeps. ERROR_MEMORY. NULL: nothing to replace. */
    int (*fill)(const cJSON *document, cJSON *parameters, struct error *err);
    /* Makes the components of a case that asks for an error, with their parameters, roles and
     * realisations. Takes what it chooses out of the parameters of the case. The document says what
     * the study names. Adds faults (and then returns 0). NULL: the kind takes no target. */
    int (*expand)(const cJSON *document, struct study_case *one, struct fault_list *faults,
                  struct error *err);
};

struct study_case {
    cJSON *parameters; /* owned: effective values, lists replaced, defaults filled in */
    struct study_cost cost;
    uint64_t block;        /* most realisations of a job, fewer where these take more than 5 s */
    uint64_t realisations; /* of the first round; of a component 0: runs only if needed */
    /* Of a case that asks for an error: the cases that its answer is computed from. */
    size_t component_count;
    struct study_case *components; /* owned; without components of their own */
    const char *role;              /* static; of a component in the answer; NULL: none */
    double share; /* share of the scatter of a component that enters the answer, about */
};
struct study {
    char *name;
    const struct study_kind *kind; /* borrowed from the caller's table */
    uint64_t seed;
    enum study_random random;
    uint64_t realisations; /* of each case; 0: as many as the error asked for takes */
    /* Version of the program and of the results of this kind; results of different versions are not
     * mixed. 0: no version, and results are shared with no other study. */
    uint64_t edition;
    char *owner;      /* user it belongs to; "" or NULL: nobody */
    int64_t priority; /* among the studies of its owner: higher ones first */
    size_t case_count;
    struct study_case *cases;
    char *source; /* the document as compact JSON, as it was given */
    /* swept pointers, in the order of the file (the last runs fastest), NULL-terminated */
    char **swept;
};

enum { STUDY_CASES_MOST = 10000, STUDY_REALISATIONS_MOST = 10000000, PRIORITY_MOST = 100 };

void study_destroy(struct study **study);

/* Makes the JSON Schema (draft 2020-12) of studies of these kinds; the caller deletes it. Returns
 * NULL when out of memory. */
cJSON *study_schema(const struct study_kind *const *kinds);

#endif
