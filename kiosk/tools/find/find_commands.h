// Finds commands by words that are typed. Pure.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kiosk/input/command.h"

namespace prismesh::kiosk::tools::find {

/// How well a text fits the words, above 0; 0: not all of them are in it. Words at its beginning, and words that begin its words, fit
/// better than those inside. Letters of the ASCII alphabet are compared without case.
double fit_of(std::string_view words, std::string_view text);

/// Indices of the commands that fit, best first: by what they do, their menu or their key. Without words: those of `earlier` (meanings,
/// the newest last), then all others in the table's order. At most `limit`.
std::vector<std::size_t> find_commands(std::string_view words, std::span<const input::KeyBinding> commands,
                                       std::span<const std::string> earlier, std::size_t limit);

}  // namespace prismesh::kiosk::tools::find
