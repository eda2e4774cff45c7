// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

// The macros below decide how YADE lays out its objects. With a wrong one everything still compiles and links, and the program
// reads wrong numbers at run time: so refuse here. CMake's target `yade_interface` sets them all.

#if !defined(__x86_64__) || !defined(__GNUC__)
#error "pkg/yade declares the binary interface of YADE on amd64 with GCC's C++ library. On another platform build with -DYADE_SOURCE_DIR=<source tree of the installed YADE>."
#endif

#if __cplusplus < 201703L
#error "YADE 2023.02a is compiled as C++17: compile with -std=c++17."
#endif

// Without these three, Eigen aligns quaternions and matrices to 16 bytes and State is 336 bytes long instead of 320.
#if !defined(EIGEN_DONT_ALIGN) || !defined(EIGEN_DONT_VECTORIZE) || !defined(EIGEN_DISABLE_UNALIGNED_ARRAY_ASSERT)
#error "Debian's YADE is compiled with EIGEN_DONT_ALIGN, EIGEN_DONT_VECTORIZE and EIGEN_DISABLE_UNALIGNED_ARRAY_ASSERT: define all three."
#endif

#if !defined(YADE_REAL_BIT) || YADE_REAL_BIT != 64
#error "pkg/yade declares the double-precision YADE only: define YADE_REAL_BIT=64."
#endif

// Each of these adds members to Scene, Body, BodyContainer or Shape.
#if !defined(YADE_OPENMP) || !defined(_OPENMP)
#error "Debian's YADE is compiled with OpenMP: define YADE_OPENMP and compile with -fopenmp."
#endif
#if !defined(YADE_OPENGL) || !defined(YADE_MPI) || !defined(YADE_FEM)
#error "Debian's YADE is compiled with YADE_OPENGL, YADE_MPI and YADE_FEM: define all three."
#endif
#if defined(YADE_LIQMIGRATION) || defined(YADE_SPH) || defined(YADE_DEFORM) || defined(YADE_MASK_ARBITRARY) || defined(USE_TIMING_DELTAS)
#error "Debian's YADE is compiled without YADE_LIQMIGRATION, YADE_SPH, YADE_DEFORM, YADE_MASK_ARBITRARY and USE_TIMING_DELTAS: undefine them."
#endif

// The constructors of the serialisers of stock classes are not exported by YADE's libraries, so the compiler has to inline them. Without
// optimisation the plugin would link and then fail to load with an undefined symbol; so it does with -Og, which the compiler does not tell apart.
#if !defined(__OPTIMIZE__)
#error "pkg/yade needs optimisation: compile with -O1 or more (for debugging: -O1 -g), or build with -DYADE_SOURCE_DIR."
#endif
