// A scene as text again.
#pragma once

#include <string>
#include <string_view>

#include "scene/scene.hpp"

namespace strata {

/// The scene as TOML, every key with its value, doubles to the last digit; reading it gives the same scene.
/// claims: [[claim]] tables as TOML, put at the end. Throws nothing but std::bad_alloc.
std::string resolved_toml(const Scene& scene, std::string_view claims);

}  // namespace strata
