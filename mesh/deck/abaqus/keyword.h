// Abaqus input line by line: keyword lines with their parameters, comments, data lines and their fields.
// Source: Abaqus Analysis User's Guide, "Input syntax rules".
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace prismesh::mesh::deck::abaqus {

/// A keyword line with its continuation lines (after a comma at its end): "*ELEMENT, TYPE=S4, ELSET=floor".
struct Keyword {
  std::size_t begin = 0;  ///< of its line
  std::size_t end = 0;    ///< one past the end of its last line
  std::string name;       ///< in capitals, one blank between words, without the asterisk: "SHELL SECTION"
};

/// Finds the keyword lines of a text one after the other.
class Keywords {
 public:
  explicit Keywords(std::string_view text) : text_(text) {}
  bool next(Keyword& keyword);

 private:
  std::string_view text_;
  std::size_t at_ = 0;
};

/// The parameters of the keyword line in [begin, end) of a text.
class Parameters {
 public:
  Parameters(std::string_view text, std::size_t begin, std::size_t end);
  /// The value of a parameter (its name in capitals, without blanks), as written but without quotes; nullopt: it isn't there.
  /// Returns a copy, since parameters rarely live longer than one call.
  std::optional<std::string> value(std::string_view name) const;
  bool has(std::string_view name) const { return value(name).has_value(); }

 private:
  std::vector<std::pair<std::string, std::string>> entries_;
};

/// Names of sets, parts and materials as they are compared: in capitals.
std::string label(std::string_view name);

/// Data lines of [begin, end): without comments and empty lines, without their ends.
struct DataLine {
  std::string_view text;
  std::size_t offset = 0;
};
class DataLines {
 public:
  DataLines(std::string_view text, std::size_t begin, std::size_t end) : text_(text), at_(begin), end_(end) {}
  bool next(DataLine& line);

 private:
  std::string_view text_;
  std::size_t at_;
  std::size_t end_;
};

/// The fields of a data line, one at a time, trimmed.
class Fields {
 public:
  explicit Fields(std::string_view line) : rest_(line) {}
  /// False: there are no more. A comma at the line's end begins no field.
  bool next(std::string_view& field);

 private:
  std::string_view rest_;
};

/// The first fields of a line; missing ones are empty.
template <std::size_t Count>
std::array<std::string_view, Count> first_fields(std::string_view line) {
  std::array<std::string_view, Count> out;
  Fields fields(line);
  for (std::string_view& field : out)
    if (!fields.next(field)) break;
  return out;
}

}  // namespace prismesh::mesh::deck::abaqus
