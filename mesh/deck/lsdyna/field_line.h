// Changes fields of a line in place. Columns or commas stay, and so does everything else.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mesh/deck/lsdyna/card.h"

namespace prismesh::mesh::deck::lsdyna {

class FieldLine {
 public:
  /// `widths`: in the standard layout, as in CardFields::cut. Tabs become blanks.
  FieldLine(std::string_view line, std::span<const int> widths, Columns columns);

  bool free_format() const { return commas_; }
  /// Trimmed; empty beyond the last.
  std::string_view text(std::size_t field) const;
  bool is_blank_or_zero(std::size_t field) const;
  bool by_parameter(std::size_t field) const { return text(field).find('&') != std::string_view::npos; }
  std::size_t width(std::size_t field) const;
  /// Puts a number into a field, aligned as the old text was. In columns it must fit the field.
  void set(std::size_t field, std::string_view number);
  std::string str() const;

 private:
  std::size_t begin_of(std::size_t field) const;

  bool commas_;
  std::vector<std::size_t> widths_;
  std::string line_;                 ///< columns
  std::vector<std::string> fields_;  ///< commas
};

/// One past the last character of the line at `offset`, before its end (LF or CRLF).
std::size_t end_of_line(std::string_view text, std::size_t offset);

}  // namespace prismesh::mesh::deck::lsdyna
