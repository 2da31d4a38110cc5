// What a scene needs of the machine's memory, so that one that does not fit is refused before anything is written.
#pragma once

#include <optional>
#include <string>

#include "scene/scene.hpp"

namespace strata {

/// Estimated memory of a run (bytes): 260 a particle for the state and the copy of it that a failing run falls back on,
/// and without inertia the Cholesky factor, 31 n log2(n)/2 numbers of 8 bytes for n = 2 unknowns a node (nested
/// dissection of a square grid, George 1973). Of a graded grid the cells are counted as they are graded. An estimate,
/// good to a factor of two. Throws nothing.
double memory_need(const Scene& scene);

/// Why the scene does not fit in `available` bytes, or nothing. Throws nothing but std::bad_alloc.
std::optional<std::string> too_large(const Scene& scene, double available);

/// Memory that the machine has left (bytes): MemAvailable of /proc/meminfo; infinite where there is no such file.
/// Throws nothing but std::bad_alloc.
double available_memory();

}  // namespace strata
