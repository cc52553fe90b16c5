/* Counter-based random words: Philox4x64-10 (Salmon et al. 2011, from Random123).
 *
 * A realisation depends on (seed, sequence, realisation) alone. Word w of a stream equals raw word
 * w of numpy.random.Philox(key=[seed, sequence], counter=[0, stream, realisation, 0]): block w/4 +
 * 1, since NumPy counts before it draws. */
#ifndef RUGO_CORE_RANDOM_H
#define RUGO_CORE_RANDOM_H

#include <stddef.h>
#include <stdint.h>

enum random_stream {
    STREAM_PHASES = 0,
    STREAM_HEIGHTS = 1,
    STREAM_HEIGHT_PHASES = 2,
    STREAM_AMPLITUDES = 3,
    STREAM_EXTENSION = 4,
    STREAM_EXTENSION_NOISE = 5,
    STREAM_GROOVES = 6
};

enum { COUNTER_BIT = 60, SUBMAP_BIT = 59, PLATEAU_BIT = 58 };

/* Selects random numbers. Plain data that may be copied. */
struct random_key {
    uint64_t seed;
    uint64_t sequence; /* 0; or the case's number, where cases share no random numbers; with one of
                          the three highest bits, and a number from bit 40 on, for surfaces beside
                          the realisations; with the fourth highest, COUNTER_BIT, for the counter
                          faces of all these; with the fifth, SUBMAP_BIT, for surfaces of which
                          sub-maps stand for a measured one; with the sixth, PLATEAU_BIT, for the
                          plateaus of stratified faces */
    uint64_t realisation;
};

/* Fills words[0..n) with words first .. first + n - 1 of the stream. */
void random_words(struct random_key key, enum random_stream stream, uint64_t first, size_t n,
                  uint64_t *words);

/* Fills u[0..n) with uniform numbers (word >> 11) * 2^-53 in [0, 1), as NumPy's random(). */
void random_uniform(struct random_key key, enum random_stream stream, uint64_t first, size_t n,
                    double *u);

#endif
