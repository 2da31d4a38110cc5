// Which known word was meant by one that is not known.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace strata {

/// Edit distance of two words: insertions, deletions, substitutions and swaps of neighbours, each counted 1
/// (optimal string alignment); case counts half as much as a letter would, so that "Weak" is near "weak".
/// a, b: any words, no units. Throws nothing but std::bad_alloc.
double edit_distance(std::string_view a, std::string_view b);

/// The candidate nearest to `word`, or nothing where none is near enough to be meant.
/// word: as typed; candidates: the words that would be allowed. Throws nothing but std::bad_alloc.
std::optional<std::string> nearest_word(std::string_view word, const std::vector<std::string>& candidates);

/// " Did you mean X?", or an empty text where no candidate is near; to be put behind an error.
/// word, candidates: as in nearest_word. Throws nothing but std::bad_alloc.
std::string did_you_mean(std::string_view word, const std::vector<std::string>& candidates);

/// `text`, or where it has more than `longest` bytes its beginning and its end: "abc...xyz (100000 characters)".
/// Throws nothing but std::bad_alloc.
std::string shortened(std::string_view text, std::size_t longest);

/// `text` without the spaces around it, nor what of `also_behind` is at its end. Throws nothing but std::bad_alloc.
std::string_view trimmed(std::string_view text, std::string_view also_behind = "");

}  // namespace strata
