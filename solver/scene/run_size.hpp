// How large a run is, so that one that the machine has no memory for is refused before anything is written.
#pragma once

#include <optional>
#include <string>

#include "scene/scene.hpp"

namespace strata {

/// Length of a run (s of its own time) as far as the scene tells it: to the stop time or to the inlet's last pressure;
/// nothing without either. Throws nothing.
std::optional<double> expected_duration(const Scene& scene);

/// Points of a scene as it starts, before cells ahead of a path that may turn are divided. Throws nothing but
/// std::bad_alloc.
double points_of(const Scene& scene);

/// Estimated memory of a run at its peak (bytes): 20 MB for the process; with inertia 1250 for each point (the copy of
/// the state that a failing run falls back on and a checkpoint included). Where equilibria are solved 1000 for each
/// point (trials of growth hold states), twice as many where paths turn; 820 log2(n) for each of n unknowns, two a node
/// of what is solved (a factor by nested dissection fills up as n log n, George 1973); and 28 for each pair of the six
/// jumps of a cell across the fracture at its end and interfaces that are apart from the start (dense matrices).
/// Against the peaks of all 151 runs of the experiments at 1 m cells: 0.9 to 2.3 times, and 4.3 times in explicit runs
/// of Experiment 5, which weigh no growth. Throws nothing but std::bad_alloc.
double memory_need(const Scene& scene);

/// Why the scene does not fit in `available` bytes, or nothing. Throws nothing but std::bad_alloc.
std::optional<std::string> too_large(const Scene& scene, double available);

/// Memory that the machine has left (bytes): MemAvailable of /proc/meminfo; infinite where there is no such file.
/// Throws nothing but std::bad_alloc.
double available_memory();

}  // namespace strata
