/* Studies that run in a moment, for tests of everything around them. */
#ifndef RUGO_TESTS_SUPPORT_SMALL_STUDIES_H
#define RUGO_TESTS_SUPPORT_SMALL_STUDIES_H

/* Two cases, Gaussian and Weibull profiles, six blocks each (a block holds at most 1000). */
enum { SEVERAL_BLOCKS_JOBS = 12 };
#define SEVERAL_BLOCKS                                                                             \
    "{\"name\":\"blocks\",\"kind\":\"statistics\",\"seed\":7,\"realisations\":6000,\"surface\":{"  \
    "\"dimension\":1,\"hurst\":0.8,\"wavelength_ratio\":4,\"length_ratio\":4,"                     \
    "\"points_per_wavelength\":8,\"heights\":{\"distribution\":[\"gaussian\",\"weibull_max\"],"    \
    "\"shape\":2,\"max_iterations\":10}},\"statistics\":{\"bins\":{\"height\":[-4,4,20],"          \
    "\"curvature\":[-8,0,10]}}}"

/* One case of five surfaces. */
#define ONE_CASE                                                                                   \
    "{\"name\":\"one\",\"kind\":\"statistics\",\"seed\":3,\"realisations\":5,\"surface\":{"        \
    "\"hurst\":0.8,\"wavelength_ratio\":4,\"length_ratio\":4},\"statistics\":{\"bins\":{"          \
    "\"height\":[-4,4,8],\"curvature\":[-8,0,8]}}}"

#endif
