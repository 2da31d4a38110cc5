// What a scene says as a whole: whether its parts fit each other.
#pragma once

#include <string>
#include <string_view>

#include "scene/entries.hpp"
#include "scene/scene.hpp"

namespace strata {

// A scene, what was given for its keys, and what is found to be wrong.
struct SceneChecks {
  const Scene& scene;
  const Entries& entries;
  Faults& faults;

  // Whether the keys were given, each with a value of use.
  bool usable(const auto&... paths) const { return (entries.usable(paths) && ...); }

  void refuse(std::string_view path, std::string text) const { faults.add(where_is(entries, path), std::move(text)); }

  template <class... Values>
  requires(sizeof...(Values) > 0) void refuse(std::string_view path, Message<Values...> text,
                                              const Values&... values) const {
    faults.add(where_is(entries, path), text, values...);
  }
};

/// Adds to `faults` where cells do not divide the block, interfaces or particles do not fit the cells, the fracture
/// does not lie in the block or meets itself, where the run could not end, and where keys do not go together; each with
/// what to do. What depends on a value that is itself missing or of no use is left out. Throws nothing but
/// std::bad_alloc.
void check_scene(const SceneChecks& checks);

}  // namespace strata
