// algo/wide.hpp: marks a loop to be compiled for plain x86-64, for AVX2 and for AVX-512.
//
// The loader chooses, where it can. All give the same bits: no operation is fused
// (-ffp-contract=off) and none depends on the width. The widest one pays by its masks and by twice
// as many registers.
#pragma once

// g++ alone: clang 16 does not link a member function made so.
#if defined(__x86_64__) && defined(__gnu_linux__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define TAUTLINE_WIDE __attribute__((target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4")))
#else
#define TAUTLINE_WIDE
#endif
