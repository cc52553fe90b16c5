/* A function marked WIDE_VECTORS, whose loops are plain and element-wise, is compiled for AVX2 too;
 * the version is chosen when the program starts. Without contraction of operations (see the
 * Makefile) both give the same digits. Not available under ThreadSanitizer, which starts after that
 * choice is made. */
#ifndef RUGO_CORE_VECTORS_H
#define RUGO_CORE_VECTORS_H

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_THREAD__)
#define WIDE_VECTORS __attribute__((target_clones("avx2", "default")))
#else
#define WIDE_VECTORS
#endif

/* A function marked INLINE has its sizes as constants of its callers, and is unrolled for each of
 * them. Not so under sanitizers: clang took a minute and a half over the checks of element.c. */
#ifdef RUGO_SANITIZED
#define INLINE static inline
#else
#define INLINE static inline __attribute__((always_inline))
#endif

#endif
