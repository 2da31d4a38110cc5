// What follows from a scene for those who run it: where interfaces cut a path, how many points stand across a cell,
// values that the solver can compute with but that no rock, stress or fluid has (most are given in another unit), and
// how large a run is, so that one that the machine has no memory for is refused before anything is written.
// Nothing here throws but std::bad_alloc.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scene/scene.hpp"

namespace strata {

/// Least distance (m) between the segments a0 a1 and b0 b1, 0 where they cross. All points in m.
double segment_distance(const Point& a0, const Point& a1, const Point& b0, const Point& b1);

/// The first two segments of a path that cross, touch or double back, counted from 0 by their first points, or nothing.
/// path_m: points in m, no two neighbours the same; tolerance_m: distance below which segments touch.
std::optional<std::pair<std::size_t, std::size_t>> self_contact(const std::vector<Point>& path_m, double tolerance_m);

/// The ends (m) of the legs of a straight line from one place to another (m) that interfaces with a law and changes
/// of the in-situ stress cut it into, the last of them `to`: no piece of a fracture lies on both sides of one.
std::vector<Point> legs_between_interfaces(const Scene& scene, const Point& from, const Point& to);

/// The layer in which a place (m) lies, counted from 0; the first and the last go on beyond the block.
std::size_t layer_at(const Scene& scene, const Point& x);

/// Points across a cell at the start: the root of numerics.particles_per_cell, or four where that is two and a layer is
/// too thin for it or, without inertia, the path may turn.
int points_across(const Scene& scene);

/// A sentence for each value of the scene that is so far from all rocks and fluids that its unit is the likely reason;
/// the bounds' reasons are in the source. Such a scene runs, and its run is marked.
std::vector<std::string> implausible(const Scene& scene);

/// Length of a run (s of its own time) as far as the scene tells it: to the stop time or to the inlet's last pressure;
/// nothing without either.
std::optional<double> expected_duration(const Scene& scene);

/// Points of a scene as it starts: with inertia, before cells ahead of a path that may turn are divided.
double points_of(const Scene& scene);

/// Estimated memory of a run at its peak (bytes): 21 MB for the process; with inertia 1250 for each point (the copy of
/// the state that a failing run falls back on and a checkpoint included). Where equilibria are solved 800 for each
/// point (trials of growth hold states), 500 log2(n) for each of n unknowns, two a node of what is solved (a factor by
/// nested dissection fills up as n log n, George 1973), and 56 for each pair of the six jumps of a cell across the
/// fracture at its end and interfaces that are apart from the start (dense matrices). Against the peaks of 57
/// quasi-static runs of 30 to 890 MB, experiments at 1, 0.5 and 0.25 m cells and the gallery among them: 0.9 to 1.8
/// times, 1.4 in the median.
double memory_need(const Scene& scene);

/// A line on what a scene asks for, with what one that leaves keys out is easily taken to be otherwise, and what it
/// needs.
std::string announce(const Scene& scene);

/// Why the scene does not fit in `available` bytes, or nothing.
std::optional<std::string> too_large(const Scene& scene, double available);

/// A size (bytes) that a file of the system has in a line "name number kB"; `otherwise` where it has not.
double bytes_by_system(const char* file, std::string_view name, double otherwise);

/// Memory that the machine has left (bytes): MemAvailable of /proc/meminfo; infinite where there is no such file.
double available_memory();

}  // namespace strata
