// [sweep]: many runs of one scene, by axes of keys. verification/README.md shows the form.
// Nothing here throws but std::bad_alloc.
#pragma once

#include <string>
#include <vector>

#include <toml++/toml.h>

#include "scene/messages.hpp"

namespace strata {

struct Reading;

struct SweepRun {
  std::string name;     // of its folder: its values, or its number where they are sampled or make no name
  std::string variant;  // "": none
  std::vector<Setting> set;
};

/// The runs of the table `sweep`, in order: of a product the last axis changes fastest. What is wrong with its form,
/// and with each value by itself, is a fault of the reading, in which the scene stands; there are then no runs.
std::vector<SweepRun> take_sweep(Reading& reading, const toml::node& sweep, const Where& source,
                                 const std::vector<std::string>& variants);

/// Latin hypercube (McKay, Beckman & Conover 1979): `count` points in [0, 1)^axes, shape (count, axes), of which each
/// axis has one in each of `count` equal strata. The same on every machine.
std::vector<std::vector<double>> latin_hypercube(std::size_t count, std::size_t axes, std::uint64_t seed);

}  // namespace strata
