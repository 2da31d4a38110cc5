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

// A scene, or else what is wrong with it: lines "file:line:column: what. What to do.".
struct ReadResult {
  std::optional<Scene> scene;
  std::vector<std::string> errors;
};

// The names of a scene's variants in the order of the file, or else why it cannot be read.
struct VariantList {
  std::vector<std::string> names;
  std::vector<std::string> errors;
};

// The runs of a scene's sweep, each a table of TOML on a line, {name, set = [settings], variant}, or else what is
// wrong.
struct SweepList {
  std::vector<std::string> runs;
  std::vector<std::string> errors;
};

/// A file's text; why there is none goes to `errors`.
std::string text_of_file(const std::filesystem::path& file, std::vector<std::string>& errors);

/// Reads a scene file and applies a variant, then settings. variant: name of one of its variants, "" for none; set:
/// texts "key.path=value" whose value is TOML or a bare word, the later ones above the earlier.
ReadResult read_scene(const std::filesystem::path& file, const std::string& variant,
                      const std::vector<std::string>& set);

/// The same from text. file_name: what messages call it.
ReadResult read_scene_text(std::string_view text, const std::string& file_name, const std::string& variant,
                           const std::vector<std::string>& set);

/// The variants of a scene file; of the rest only the syntax is looked at.
VariantList list_variants(const std::filesystem::path& file);

/// The same from text. file_name: what messages call it.
VariantList list_variants_text(std::string_view text, const std::string& file_name);

/// The runs of a scene file's table [sweep], none where it has none. Each run's scene is read: what is wrong with one
/// of them ends in "[run NAME]".
SweepList list_sweep(const std::filesystem::path& file);

/// The same from text. file_name: what messages call it.
SweepList list_sweep_text(std::string_view text, const std::string& file_name);

/// As read_scene(), and an error where the machine has not the memory that a run of the scene would take.
ReadResult read_scene_that_fits(const std::filesystem::path& file, const std::string& variant,
                                const std::vector<std::string>& set);

/// All that is wrong with scene files, as lines: of each the scene itself, its variants and the runs of its sweep; what
/// only a variant is guilty of ends in "[variant NAME]". files: paths.
std::vector<std::string> check(const std::vector<std::string>& files);

}  // namespace strata
