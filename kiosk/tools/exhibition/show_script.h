// The show of an exhibition: steps with title cards, turns of the view and edits, read from a file of JSON lines.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "mesh/document/edit.h"

namespace prismesh::kiosk::tools::exhibition {

struct ShowStep {
  std::string title, words;  ///< of the card; empty: the one before stays
  double seconds = 3;        ///< 0..120; longer, if an edit takes longer
  std::optional<mesh::document::Edit> edit;
  double turn_right = 0, turn_up = 0;  ///< degrees, evenly over the step
  double zoom = 1;                     ///< factor, evenly over the step
  enum class Fit : std::uint8_t { none, model, selection } fit = Fit::none;
};

/// Reads a show's text: a JSON object a line; empty lines and lines that begin with # are skipped. Errors, with file and line: what isn't
/// JSON, an unknown field, a value out of range, an edit that can't be read or that names a file, no step at all.
Result<std::vector<ShowStep>> parse_show(std::string_view text, const std::string& file);
/// Errors also: it can't be read, or is larger than 1 MB.
Result<std::vector<ShowStep>> read_show(const std::filesystem::path& file);

}  // namespace prismesh::kiosk::tools::exhibition
