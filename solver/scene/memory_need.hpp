// What a scene needs of the machine's memory, so that one that does not fit is refused before anything is written.
#pragma once

#include <optional>
#include <string>

#include "scene/scene.hpp"

namespace strata {

/// Points of a scene as it starts, or as it ends where they are divided ahead of a path that may turn (one that goes
/// straight up): of a graded grid the cells are counted as they are graded. Throws nothing.
double points_of(const Scene& scene);

/// Estimated memory of a run at its peak (bytes), with the copy of the state that a failing run falls back on and what
/// a checkpoint takes while it is written: 24 MB for the process and 1250 a point or, without inertia, 28 MB and 330 a
/// point, 700 where the path may turn (trials of growth hold a state each) and 950 if that is through 16 a cell, and
/// 700 log2(n) for each of n unknowns, two a node of what is solved (stiffness and its factor, whose fill by nested
/// dissection grows as n log n, George 1973). Measured on the experiments at 2 to 0.25 m cells: 0 to 25 % above
/// the peak, up to 50 % where paths turn, 15 % below with two soft interfaces. Throws nothing.
double memory_need(const Scene& scene);

/// Why the scene does not fit in `available` bytes, or nothing. Throws nothing but std::bad_alloc.
std::optional<std::string> too_large(const Scene& scene, double available);

/// Memory that the machine has left (bytes): MemAvailable of /proc/meminfo; infinite where there is no such file.
/// Throws nothing but std::bad_alloc.
double available_memory();

}  // namespace strata
