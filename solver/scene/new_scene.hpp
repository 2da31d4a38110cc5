// A scene to start from, `strata new`. Nothing here throws but std::bad_alloc.
#pragma once

#include <string>
#include <vector>

namespace strata {

/// Writes a scene to NAME.toml, whether or not `name` ends so: a fracture that meets an interface, with the other laws
/// of interface, fluid and mechanics as variants. Above each key stands what the list of keys says of it: meaning,
/// unit, bounds and default. What is wrong, as lines: a name of other characters, a file that is there or cannot be
/// written.
std::vector<std::string> write_new_scene(const std::string& name);

}  // namespace strata
