// algo/wide.hpp: marks a loop to be compiled for plain x86-64, for AVX2 and for AVX-512.
//
// The loader chooses if it can. All versions give the same bits: no operation is fused
// (-ffp-contract=off) and none depends on the width. AVX-512 is worth including for its masks and
// for its doubled number of registers.
#pragma once

// g++ only: clang 16 does not link such a member function.
#if defined(__x86_64__) && defined(__gnu_linux__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define TAUTLINE_WIDE __attribute__((target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4")))
#else
#define TAUTLINE_WIDE
#endif
