/* What one unit of work is. A kind reads a case's parameters, measures realisations into a tally,
 * writes that tally as bytes and reads it back, and turns it into curves. runner.h runs blocks of
 * realisations and merger.h merges them, whatever the kind: a new kind is one file that fills a
 * struct job_kind, and one line in the table of kinds.c.
 *
 * What a kind keeps (a case, what its runners share, a workspace, a tally) are structs of its own,
 * whose sizes it tells. They are zeroed before they are filled, and cleared by the kind in the end,
 * also where the filling failed half way. */
#ifndef RUGO_JOBS_KIND_H
#define RUGO_JOBS_KIND_H

#include "core/random.h"
#include "core/statistics/roughness.h"
#include "core/surface/surface.h"
#include "schema/result/block_result.h"
#include "schema/result/bytes.h"
#include "schema/result/result.h"
#include "schema/study/fault.h"
#include "schema/study/parameter.h"
#include "schema/study/study.h"
#include <cjson/cJSON.h>
#include <stdint.h>

/* Of each realisation of a tally, in their order: values[r * stride]. NaN: none. */
struct point_values {
    const double *values; /* borrowed */
    size_t stride;
};

/* Of a point of a curve that is a ratio: its sums by groups of realisations, realisation r in group
 * r mod POINT_GROUPS. */
enum { POINT_GROUPS = 32 };
struct point_groups {
    double counted[POINT_GROUPS], things[POINT_GROUPS];
    size_t telling; /* groups that show a scatter: with something counted, of shares not all */
};

struct job_merger;   /* merger.h */
struct realisations; /* realisations.h */
struct result_view;  /* schema/result/view.h */
struct surface_case; /* surface_case.h */

/* The prescribed spectrum of a case with a surface, which sets its scales; empty without. */
struct surface_basis {
    const struct modes *modes; /* borrowed */
    struct moments moments;
};

/* A realisation to be measured. Without a surface z is NULL, and what is behind it empty. */
struct realisation {
    const void *study;     /* the case */
    struct random_key key; /* its number among others */
    const double *z;       /* heights on the own grid of the case */
    struct surface_report report;
    struct roughness roughness; /* empty where the kind measures it itself */
    struct moments moments;     /* of its own spectrum: the prescribed one where that is exact */
    /* To be asked again and again within one that may take long: non-zero stops it with
     * ERROR_STOPPED. */
    int (*stop)(void *context);
    void *stop_context;
};

/* A component of a case that asks for an error, merged as far as it has come. */
struct target_component {
    const char *role;
    uint64_t done;  /* realisations; 0: no tally */
    double seconds; /* of one, as estimated */
    const void *study, *tally;
    const struct job_merger *merger; /* which holds both (merger.h) */
};

struct job_kind {
    struct study_kind study;          /* what readers of studies must know; check: kind_check */
    const char *(*scalar)(size_t at); /* of one realisation: a name; NULL behind the last */
    const struct result_view *view;   /* NULL: nothing special is shown */

    /* --- a case --- */
    size_t case_size;
    /* Of a study's object of effective values, lists already replaced. Adds faults that no single
     * range shows (grid too large, alpha out of reach) and returns ERROR_INPUT; faults may be NULL:
     * the first is the error in any case. */
    int (*read)(void *study, const cJSON *parameters, struct fault_list *faults, struct error *err);
    void (*clear)(void *study); /* NULL: nothing to clear */
    void (*estimate)(const void *study, struct study_cost *out);
    /* Gives the surface that each realisation is given; NULL for kinds without surfaces. */
    const struct surface_case *(*surface)(const void *study);
    bool measures_roughness; /* itself, of each surface: realisations come without it */

    /* --- what all runners of a case can share, such as a factorised matrix; 0 and NULL: nothing.
     * Immutable once made, read by many threads. --- */
    size_t shared_size;
    int (*shared_create)(void *shared, const void *study, struct error *err);
    void (*shared_clear)(void *shared);

    /* --- what one runner works with; 0 and NULL: nothing. Borrows its arguments. --- */
    size_t workspace_size;
    int (*workspace_create)(void *workspace, const void *study, const struct surface_basis *basis,
                            const void *shared, struct error *err);
    void (*workspace_clear)(void *workspace);

    /* --- a tally: what realisations add up to, exact, so that any order of merging gives the same
     * bits. Borrows its arguments. --- */
    size_t tally_size;
    int (*tally_create)(void *tally, const void *study, const struct surface_basis *basis,
                        struct error *err);
    void (*tally_clear)(void *tally);
    /* realise may stop half way, and leave traces of its realisation in the tally that it was
     * given: a runner then gives it one of its own for each, to merge those that end. */
    bool stops_half_way;
    /* Adds a realisation, and fills scalars (as many as there are; NaN: none). */
    int (*realise)(void *workspace, const struct realisation *realisation, void *tally,
                   double *scalars, struct error *err);
    /* Fails with ERROR_MEMORY alone, and then merges nothing. */
    int (*merge)(void *into, const void *from, struct error *err);
    uint64_t format, format_version; /* marks of its bytes, between the kinds of the program */
    void (*put)(struct bytes *bytes, const void *tally);
    /* Reads into a new tally. Fails the reader for what put cannot have made. */
    void (*get)(struct byte_reader *reader, void *tally);
    /* Returns whether a tally that was read can be, and whether it is of these scalars. Either may
     * be NULL: then any tally will do. */
    bool (*adds_up)(const void *tally);
    bool (*belongs)(const void *tally, const struct block_result *result);

    /* Appends scalars, curves and notes to a result. */
    int (*result)(const void *study, const struct surface_basis *basis, const void *tally,
                  const struct realisations *realisations, struct case_result *out,
                  struct error *err);
    /* Of a case that asks for an error (study.expand): how many realisations each component is to
     * have in all, none below what is done; and what the answer is by now, with the scalar
     * "error_reached". A function of its arguments alone. NULL where expand is. */
    int (*answer)(const cJSON *parameters, size_t count, const struct target_component *components,
                  uint64_t *wanted, struct case_result *out, struct error *err);
    /* --- what differences of cases by pairs of realisations are made of --- */
    /* Finds what point `at` of a curve of the case is the mean of; false where it is not kept.
     * NULL: of no curve. */
    bool (*point_values)(const void *tally, const struct curve *curve, size_t at,
                         struct point_values *out);
    /* Finds the sums by groups of a point, where no values of single realisations are kept; false
     * where neither are. NULL: of no curve. */
    bool (*point_groups)(const void *tally, const struct curve *curve, size_t at,
                         struct point_groups *out);
    /* Fills, of each realisation in their order, the value and weight (1 before the call) whose
     * weighed mean a scalar is. NULL: plain means of the scalars of realisations. */
    int (*scalar_values)(const void *tally, const struct realisations *realisations, size_t scalar,
                         double *values, double *weights, struct error *err);

    /* Makes the theories that curves of such a case name without holding them. NULL: there are
     * none. */
    int (*complete)(const void *study, const struct surface_basis *basis,
                    struct case_result *result, struct error *err);
    /* Presses a realisation, of which the case, z and stop are looked at, to p/(E* h') > 0: the
     * gap, in the units of z, and the pressures over E* h', a value a point. NULL for kinds without
     * contact. */
    int (*press)(const struct realisation *realisation, double pressure, double *gap,
                 double *pressures, struct error *err);
    /* Writes what the case is solved on, for the surface z of its own grid, pressed to p/(E* h')
     * where that is above 0, as a VTU file. Lengths in lambda_s, pressures and stresses in E* h'.
     * Nothing is written on failure. NULL for kinds without meshes. */
    int (*write_mesh)(const char *path, const void *study, const double *z, double pressure,
                      struct error *err);
    /* Measures a measured surface, z as pieces of the surfaces of the case are cut (like_case.h),
     * in the way in which these are measured beside the realisations, and adds what it finds to the
     * object "like" of the study. Nothing where the case cuts no pieces. NULL for kinds that
     * measure nothing of them but what like_fit has. */
    int (*measure_like)(const void *study, const double *z, struct cJSON *like, struct error *err);
};

/* All kinds, in a fixed order, NULL at the end; each is the head of a struct job_kind. kinds.c
 * holds nothing but this table: a program that defines it itself has the kinds that it names there.
 */
extern const struct study_kind *const JOB_KINDS[];
/* Defines it from a list: #define LIST(KIND) KIND(STATISTICS_KIND) KIND(CONTACT_KIND) */
#define JOB_KIND_DECLARE(kind) extern const struct job_kind kind;
#define JOB_KIND_HEAD(kind) &(kind).study,
#define JOB_KIND_TABLE(LIST)                                                                       \
    LIST(JOB_KIND_DECLARE)                                                                         \
    const struct study_kind *const JOB_KINDS[] = {LIST(JOB_KIND_HEAD) NULL};

/* These return the kind of a table's entry, and that of a name: NULL for an unknown one. */
const struct job_kind *kind_of(const struct study_kind *study);
const struct job_kind *kind_find(const char *name);
/* Computes the mark of what this program computes of a kind (schema/study/study.h). */
uint64_t kind_edition(const struct job_kind *kind);
/* Reads a study of these kinds; a case may need as much memory as the machine has. */
int kind_read_study(struct study **out, const char *text, size_t size, const char *const *overrides,
                    struct fault_list *faults, struct error *err);
/* The same until stop says so (study_read_ext). */
int kind_read_study_until(struct study **out, const char *text, size_t size,
                          int (*stop)(void *context), void *context, struct fault_list *faults,
                          struct error *err);
/* Reads a case into memory of its own, zeroed and filled; kind_case_destroy accepts NULL. */
int kind_case_create(void **out, const struct job_kind *kind, const cJSON *parameters,
                     struct fault_list *faults, struct error *err);
void kind_case_destroy(const struct job_kind *kind, void **study);
/* Adds what is wrong with a case to faults (0 then too), or estimates what it costs. */
int kind_check(const struct study_kind *head, const cJSON *parameters, struct fault_list *faults,
               struct study_cost *cost, struct error *err);
/* Computes the mark of a case in its partial results (fingerprint.h). */
int kind_fingerprint(const struct job_kind *kind, const cJSON *parameters, uint64_t *out,
                     struct error *err);
/* How many scalars a realisation has, and whether these of a result are they: ERROR_INPUT. */
size_t kind_scalar_count(const struct job_kind *kind);
int kind_check_names(const struct job_kind *kind, const struct block_result *result,
                     struct error *err);

#endif
