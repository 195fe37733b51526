// Cuts a card into fields: by fixed columns or by commas.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "mesh/deck/data/deck.h"
#include "mesh/deck/lsdyna/keyword.h"

namespace prismesh::mesh::deck::lsdyna {

inline constexpr std::size_t kMaxFields = 24;
inline constexpr int kWideColumns = 20;

/// The width of a field in a layout: with I10 eight columns become ten, in the wide layout all fields have twenty.
constexpr int field_width(int standard_width, Columns columns) {
  if (columns == Columns::wide) return kWideColumns;
  return columns == Columns::i10 && standard_width == 8 ? 10 : standard_width;
}

/// The fields of one line. A tab counts as blanks up to the next multiple of eight columns.
class CardFields {
 public:
  /// `widths`: in the standard layout. A line with a comma is free format and ignores them.
  void cut(std::string_view line, std::span<const int> widths, Columns columns);
  /// Cuts into eight fields of ten columns.
  void cut(std::string_view line, Columns columns);

  std::size_t count() const { return count_; }
  /// Trimmed; empty beyond the last.
  std::string_view text(std::size_t field) const { return field < count_ ? fields_[field] : std::string_view(); }

 private:
  std::array<std::string_view, kMaxFields> fields_;
  std::size_t count_ = 0;
  std::string expanded_;
};

/// The line with tabs replaced by blanks.
std::string expand_tabs(std::string_view line);

}  // namespace prismesh::mesh::deck::lsdyna
