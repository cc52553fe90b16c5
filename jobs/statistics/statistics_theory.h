/* The theory of each curve, averaged over bins, as that is what a histogram estimates. */
#ifndef RUGO_JOBS_STATISTICS_STATISTICS_THEORY_H
#define RUGO_JOBS_STATISTICS_STATISTICS_THEORY_H

#include "core/theory/nayak.h"
#include "core/theory/translated_summits.h"
#include "jobs/statistics/statistics_case.h"
#include "jobs/surface/translated_case.h"

/* Fills the prescribed height distribution: mean density of each bin; cumulative at its upper
 * edge. */
int statistics_theory_heights(const struct statistics_case *one_case, double *pdf, double *cdf,
                              struct error *err);

/* A theory of summits without a grid. That of Gaussian surfaces is called "nayak", and for profiles
 * "longuet_higgins" (Cartwright & Longuet-Higgins 1956); that of surfaces that are translated from
 * a Gaussian field "translation". */
struct summit_theory {
    const char *name;
    bool translated;                   /* else of a Gaussian surface with the reached moments */
    struct translated_surface surface; /* of a Gaussian one: the dimension and those moments */
};
/* "translation", and that of the random part beside surfaces with grooves, "random_part". */
extern const char STATISTICS_TRANSLATION[], STATISTICS_REST[];

/* The theories of a case: none where the spectrum is not isotropic, has no finite moments, or an
 * alpha of at most 3/2 (profiles: 1). A translated surface has its own. An iterated surface whose
 * heights are not Gaussian stands beside a Gaussian one, and behind that beside the translated
 * surface of its heights and its spectrum, if there is one. */
enum { SUMMIT_THEORIES_MOST = 2 };
struct summit_theories {
    size_t count;
    struct summit_theory of[SUMMIT_THEORIES_MOST];
    struct translated_case translated;
};
/* Borrows the case. Takes some tens of milliseconds beside iterated surfaces. ERROR_MEMORY alone.
 */
int summit_theories_create(struct summit_theories *out, const struct statistics_case *one_case,
                           const struct surface_basis *basis, struct error *err);
void summit_theories_clear(struct summit_theories *theories);
/* Returns the theory of the surfaces themselves, which scalars and `rugo theory` have: of Gaussian
 * surfaces that of Gaussian ones, else that of translated ones with their heights. NULL: none, as
 * beside the random part of surfaces with grooves, or where no such translation exists. Borrowed
 * from the theories. */
const struct summit_theory *summit_theories_own(const struct summit_theories *theories,
                                                const struct statistics_case *one_case);

/* pits: of the summits of the mirrored surface. */
struct summit_expectation summit_theory_expectation(const struct summit_theory *theory, bool pits);
/* Fills what bin_averages.h has of summits: by height; of each t1 bin; and height.count x
 * equivalent.count values, in which t1 runs fastest. */
void summit_theory_heights(const struct summit_theory *theory,
                           const struct statistics_case *one_case, bool pits, double *pdf,
                           double *cdf, double *curvature);
void summit_theory_equivalent(const struct summit_theory *theory,
                              const struct statistics_case *one_case, bool pits, double *pdf);
void summit_theory_joint(const struct summit_theory *theory, const struct statistics_case *one_case,
                         bool pits, double *pdf);

#endif
