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

#endif
