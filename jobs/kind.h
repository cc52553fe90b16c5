/* The interface of a kind of study. A kind reads a case's parameters, measures realisations into a
 * tally, writes the tally as bytes and reads it back, and turns it into curves. runner.h runs
 * blocks of realisations and merger.h merges them, whatever the kind: a new kind is one file that
 * fills a struct job_kind, and one line in the table of kinds.c.
 *
 * A kind has structs of its own for a case, for what its runners share, for a workspace and for a
 * tally; job_kind has their sizes. They are zeroed before they are filled, and cleared by the kind
 * in the end, also after a failure to fill them. */
#ifndef RUGO_JOBS_KIND_H
#define RUGO_JOBS_KIND_H

#include "core/random.h"
#include "core/statistics/heights/roughness.h"
#include "core/surface/surface.h"
#include "core/team.h"
#include "schema/result/block_result.h"
#include "schema/result/bytes/bytes.h"
#include "schema/result/result.h"
#include "schema/study/fault.h"
#include "schema/study/parameter.h"
#include "schema/study/study.h"
#include "schema/study/values.h"
#include <cjson/cJSON.h>
#include <stdint.h>

/* A 64-bit mark by which cases are distinguished: a hash of all values of a case, whatever the
 * order of keys and whether defaults are written out.
 *
 * Partial results are stored with it, so that a case which an earlier version could compute must
 * keep its mark. The hash is over the rows of the kind's tables, in their order: of each row its
 * number, then its value (numbers as doubles, strings as bytes). Hence:
 *
 * - rows keep their order, tables theirs within a kind, and defaults do not change;
 *
 * - a row added after results were stored is marked (parameter.h, later). Such rows have no number.
 * One whose value is its default, or absent, does not count; any other is hashed with its path,
 * behind all the numbered rows. */

/* Returns the mark of values that were made by these tables. */
uint64_t case_fingerprint(const struct values *values, const struct parameter_table *const *tables);

/* The values of all realisations of a tally, in their order: values[r * stride]. NaN: none. */
struct point_values {
    const double *values; /* borrowed */
    size_t stride;
};

/* Sums of a point of a curve that is a ratio, by groups of realisations: realisation r is in group
 * r mod POINT_GROUPS. */
enum { POINT_GROUPS = 32 };
struct point_groups {
    double counted[POINT_GROUPS], things[POINT_GROUPS];
    size_t informative; /* groups with something counted; of shares, not all */
};

struct job_merger;   /* merger.h */
struct realisations; /* realisations.h */
struct result_view;  /* schema/result/view.h */
struct surface_case; /* surface_case.h */

/* The prescribed spectrum of a case with a surface, which sets its scales; empty without one. */
struct surface_basis {
    const struct modes *modes; /* borrowed */
    struct moments moments;
};

/* A realisation to be measured. Without a surface z is NULL, and the fields behind it are empty. */
struct realisation {
    const void *study;     /* the case */
    struct random_key key; /* the number of the realisation among others */
    const double *z;       /* heights on the grid of the case */
    /* The Gaussian field on the same points that a translated surface is a function of, where the
     * kind wants it; else NULL. */
    const double *gaussian;
    struct surface_report report;
    const struct modes *modes; /* its own spectrum; NULL where it has waves beyond the band */
    /* Empty where the kind measures them itself; moments are of its own spectrum. */
    struct roughness roughness;
    struct moments moments;
    /* To be called repeatedly within a realisation that may take long: non-zero stops it with
     * ERROR_STOPPED. */
    int (*stop)(void *context);
    void *stop_context;
    /* Takes the share of the realisation's work that is done, with stop_context, from kinds whose
     * realisations may take long; may be NULL. */
    void (*progress)(void *context, double share);
};

enum { KEPT_MODELS_MOST = 8 };
/* Which steps are computed. */
struct steps_order {
    const double *z;       /* on the grid of the case */
    struct random_key key; /* of the realisation */
    const char *model; /* NULL: the most complete one, the first of those with a mesh if `meshed` */
    bool meshed;       /* models without a mesh are refused */
    size_t load_count; /* 0: all loads of the case */
    bool kept; /* of all loads of the case those alone are given that it keeps (kept_steps) */
    const double *loads; /* p/(E* h'), rising; 0: out of contact */
    /* Called repeatedly while a load is solved: non-zero stops it with ERROR_STOPPED; may be
     * NULL. */
    int (*stop)(void *context);
    void *stop_context;
};
/* Steps of realisations that a case keeps. All arrays are borrowed from the case. */
struct kept_steps {
    size_t count, load_count, model_count;
    const double *realisations; /* whole numbers, rising */
    const char *models[KEPT_MODELS_MOST];
};
struct nodal_step; /* core/nodal/nodal_step.h */
/* Takes the steps one after the other: step number `number` of `count`, from 0. Lengths are in
 * lambda_s, pressures and stresses in E* h'. What is not 0 ends the loads. */
struct steps_sink {
    int (*put)(void *context, const struct nodal_step *step, size_t number, size_t count,
               struct error *err);
    void *context;
};

/* A component of a case that asks for an error, with what is merged of it so far. */
struct target_component {
    const char *role;
    uint64_t done;  /* realisations; 0: no tally */
    double seconds; /* of one, as estimated */
    const void *study, *tally;
    const struct job_merger *merger; /* which holds both (merger.h) */
};

/* Bytes of the program, its libraries and tables that do not grow with a grid, which every estimate
 * of memory has. */
#define PROCESS_BYTES 2.4e7

struct job_kind {
    struct study_kind study;          /* what readers of studies must know; check: kind_check */
    const char *(*scalar)(size_t at); /* name of a scalar of a realisation; NULL behind the last */
    const struct result_view *view;   /* NULL: nothing special is shown */

    /* --- a case --- */
    size_t case_size;
    /* Reads a case from its effective values, lists already replaced. Adds faults that no single
     * range shows (grid too large, alpha out of reach) and returns ERROR_INPUT. faults may be NULL:
     * the first is the error in any case. memory_limit in bytes (0: none): a surface beyond it is a
     * fault, which is found before memory of that size is used. */
    int (*read)(void *study, const cJSON *parameters, double memory_limit,
                struct fault_list *faults, struct error *err);
    void (*clear)(void *study); /* NULL: nothing to clear */
    void (*estimate)(const void *study, struct study_cost *out);
    /* Returns the surface that realisations are made of; NULL for kinds without surfaces. */
    const struct surface_case *(*surface)(const void *study);
    /* Returns whether a case wants the Gaussian field of its surfaces, which are translated. NULL:
     * none does. */
    bool (*wants_gaussian)(const void *study);
    bool measures_roughness; /* the kind measures roughness and moments itself: realisations come
                                without them */

    /* --- what all runners of a case can share, such as a factorised matrix; 0 and NULL: nothing.
     * Immutable once made, read by many threads. --- */
    size_t shared_size;
    int (*shared_create)(void *shared, const void *study, struct error *err);
    void (*shared_clear)(void *shared);

    /* --- the workspace of one runner; 0 and NULL: none. Borrows its arguments. --- */
    size_t workspace_size;
    int (*workspace_create)(void *workspace, const void *study, const struct surface_basis *basis,
                            const void *shared, struct error *err);
    void (*workspace_clear)(void *workspace);
    /* Lets a team of threads work along in each realisation, with the same digits; borrowed.
     * ERROR_MEMORY. NULL: a realisation takes one thread. */
    int (*workspace_set_team)(void *workspace, struct team *team, struct error *err);

    /* --- a tally: exact sums over realisations, so that any order of merging gives the same bits.
     * Borrows its arguments. --- */
    size_t tally_size;
    int (*tally_create)(void *tally, const void *study, const struct surface_basis *basis,
                        struct error *err);
    void (*tally_clear)(void *tally);
    /* A realisation may take long enough to be stopped within it, when a part of it is in its
     * tally. A runner then passes a tally for each realisation, and merges those that end. A block
     * of another kind that is stopped in realise has no result. */
    bool stops_half_way;
    /* Adds a realisation, and fills as many scalars as the kind has; NaN: none. */
    int (*realise)(void *workspace, const struct realisation *realisation, void *tally,
                   double *scalars, struct error *err);
    /* Fails with ERROR_MEMORY alone, and then merges nothing. */
    int (*merge)(void *into, const void *from, struct error *err);
    uint64_t format, format_version; /* marks of its bytes; each kind has its own format */
    void (*put)(struct bytes *bytes, const void *tally);
    /* Reads into a new tally. Fails the reader for bytes that `put` cannot have made. */
    void (*get)(struct byte_reader *reader, void *tally);
    /* adds_up returns whether a tally that was read is consistent, belongs whether it is of these
     * scalars. Either may be NULL: then every tally passes. */
    bool (*adds_up)(const void *tally);
    bool (*belongs)(const void *tally, const struct block_result *result);

    /* Appends scalars, curves and notes to a result. */
    int (*result)(const void *study, const struct surface_basis *basis, const void *tally,
                  const struct realisations *realisations, struct case_result *out,
                  struct error *err);
    /* Answers a case that asks for an error (study.expand): how many realisations each component is
     * to have in all, none below what is done, and the answer so far with the scalar
     * "error_reached". Depends on its arguments alone. NULL where expand is. */
    int (*answer)(const cJSON *parameters, size_t count, const struct target_component *components,
                  uint64_t *wanted, struct case_result *out, struct error *err);
    /* --- differences of cases by pairs of realisations --- */
    /* Finds the values of realisations whose mean point `at` of a curve is; false where they are
     * not kept. NULL: of no curve. */
    bool (*point_values)(const void *tally, const struct curve *curve, size_t at,
                         struct point_values *out);
    /* Finds the sums by groups of a point without values of single realisations; false where
     * neither are kept. NULL: of no curve. */
    bool (*point_groups)(const void *tally, const struct curve *curve, size_t at,
                         struct point_groups *out);
    /* Fills for each realisation, in their order, the value and the weight (1 before the call)
     * whose weighted mean a scalar is. NULL: plain means of the scalars of realisations. */
    int (*scalar_values)(const void *tally, const struct realisations *realisations, size_t scalar,
                         double *values, double *weights, struct error *err);

    /* Makes the theories of which curves of such a case have the name alone. NULL: there are
     * none. */
    int (*complete)(const void *study, const struct surface_basis *basis,
                    struct case_result *result, struct error *err);
    /* Presses a realisation, of which the case, z and stop are used, to p/(E* h') > 0. Returns the
     * gap, in the units of z, and the pressures over E* h', a value for each point. NULL for kinds
     * without contact. */
    int (*press)(const struct realisation *realisation, double pressure, double *gap,
                 double *pressures, struct error *err);
    /* Presses a surface by one model of the case, on its finest mesh, to rising loads, and puts
     * each step. NULL for kinds without contact. */
    int (*press_steps)(const void *study, const struct steps_order *order,
                       const struct steps_sink *sink, struct error *err);
    /* Returns which steps of which realisations the case keeps as files. NULL: none. */
    struct kept_steps (*kept)(const void *study);
    /* Measures a measured surface as the sub-maps of realisations are measured, and adds the
     * results to the object "like" of the study. z is on the grid of a sub-map (like_case.h). Does
     * nothing where the case cuts no sub-maps. NULL for kinds that measure only what like_fit
     * does. */
    int (*measure_like)(const void *study, const double *z, struct cJSON *like, struct error *err);
};

/* All kinds, in a fixed order, NULL at the end; each is the head of a struct job_kind. kinds.c
 * holds only this table: a program that defines its own has the kinds that it names there. */
extern const struct study_kind *const JOB_KINDS[];
/* Defines the table from a list: #define LIST(KIND) KIND(STATISTICS_KIND) KIND(CONTACT_KIND) */
#define JOB_KIND_DECLARE(kind) extern const struct job_kind kind;
#define JOB_KIND_HEAD(kind) &(kind).study,
#define JOB_KIND_TABLE(LIST)                                                                       \
    LIST(JOB_KIND_DECLARE)                                                                         \
    const struct study_kind *const JOB_KINDS[] = {LIST(JOB_KIND_HEAD) NULL};

/* Return the kind of an entry of the table, and that of a name: NULL for an unknown one. */
const struct job_kind *kind_of(const struct study_kind *study);
const struct job_kind *kind_find(const char *name);
/* Returns a hash of the version of the program and of the format of a kind
 * (schema/study/study.h). */
uint64_t kind_edition(const struct job_kind *kind);
/* Returns the bytes that cases may need: 0.9 of the memory that the process may use, which is that
 * of the machine, of its control groups or of Slurm (allotment.h); 0: not known. */
double kind_memory_limit(void);
/* Reads a study of these kinds. A case may need kind_memory_limit bytes. */
int kind_read_study(struct study **out, const char *text, size_t size, const char *const *overrides,
                    struct fault_list *faults, struct error *err);
/* Reads likewise until stop ends it (study_read_ext). */
int kind_read_study_until(struct study **out, const char *text, size_t size,
                          int (*stop)(void *context), void *context, struct fault_list *faults,
                          struct error *err);
/* Reads a case into memory of its own, zeroed and filled; kind_case_destroy accepts NULL. */
int kind_case_create(void **out, const struct job_kind *kind, const cJSON *parameters,
                     struct fault_list *faults, struct error *err);
void kind_case_destroy(const struct job_kind *kind, void **study);
/* Adds the faults of a case (and then returns 0), or estimates its cost. */
int kind_check(const struct study_kind *head, const cJSON *parameters, double memory_limit,
               struct fault_list *faults, struct study_cost *cost, struct error *err);
/* Computes the mark of a case in its partial results. */
int kind_fingerprint(const struct job_kind *kind, const cJSON *parameters, uint64_t *out,
                     struct error *err);
/* Return the number of scalars of a realisation, and whether a result has these: ERROR_INPUT. */
size_t kind_scalar_count(const struct job_kind *kind);
int kind_check_names(const struct job_kind *kind, const struct block_result *result,
                     struct error *err);

#endif
