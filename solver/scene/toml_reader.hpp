// Reads a scene from TOML. Every mistake in it is reported, in one pass, with its place and what to do.
// Nothing here throws but std::bad_alloc.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/scene.hpp"

namespace strata {

// A scene, or else what is wrong with it: lines "file:line:column: what. What to do.". Notes are of a sound scene.
struct ReadResult {
  std::optional<Scene> scene;
  std::vector<std::string> errors, notes{};
};

// What is asked for, or else what is wrong, in lines.
struct Found {
  std::vector<std::string> lines, errors;
};

/// What is made of a file's text, or else why there is none. of_text: of the text and the file's name.
Found of_file(const std::filesystem::path& file, Found (*of_text)(std::string_view, const std::string&));

/// Reads a scene file and applies a variant, then settings. variant: name of one of its variants, "" for none; set:
/// texts "key.path=value" whose value is TOML or a bare word, the later ones above the earlier.
ReadResult read_scene(const std::filesystem::path& file, const std::string& variant,
                      const std::vector<std::string>& set);

/// The same from text. file_name: what messages call it.
ReadResult read_scene_text(std::string_view text, const std::string& file_name, const std::string& variant,
                           const std::vector<std::string>& set);

/// The names of a scene's variants in the order of the file; of the rest only the syntax is looked at.
Found list_variants(std::string_view text, const std::string& file_name);

/// The runs of a scene's table [sweep], none where it has none, each a table of TOML: {name, set = [settings],
/// variant}. Each run's scene is read: what is wrong with one of them ends in "[run NAME]".
Found list_sweep(std::string_view text, const std::string& file_name);

/// As read_scene(), and an error where the machine has not the memory that a run of the scene would take.
ReadResult read_scene_that_fits(const std::filesystem::path& file, const std::string& variant,
                                const std::vector<std::string>& set);

/// A scene file with all that is wrong with it, its variants and the runs of its sweep; what only a variant is guilty
/// of ends in "[variant NAME]".
ReadResult check(const std::filesystem::path& file);

}  // namespace strata
