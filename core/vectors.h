/* WIDE_VECTORS in front of a plain element-wise loop: built for AVX2 too, chosen when the program
 * starts. Without contraction (see the Makefile) every width gives the same digits. Not under
 * ThreadSanitizer, which is not yet awake when the choice is made. */
#ifndef RUGO_CORE_VECTORS_H
#define RUGO_CORE_VECTORS_H

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_THREAD__)
#define WIDE_VECTORS __attribute__((target_clones("avx2", "default")))
#else
#define WIDE_VECTORS
#endif

#endif
