#pragma once

/// Before a function of loops over 16 lanes or the pixels of a row: compiled for several instruction sets,
/// chosen when the program starts. Such a function must return the same bits in each: whole numbers, or
/// operations that are correctly rounded and none contracted. GCC only: what Clang 14 compiles so cannot be
/// called from other files. Not with the address sanitizer, which is not set up yet when the choice is made.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__)
#define REEMIT_FOR_INSTRUCTION_SETS __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define REEMIT_FOR_INSTRUCTION_SETS
#endif

/// Defined where a function may be written for AVX-512 alone (__attribute__((target("avx512f")))), to be
/// called if __builtin_cpu_supports says so.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define REEMIT_HAS_AVX512_FUNCTIONS
#endif
