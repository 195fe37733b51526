// A card's text with some of its fields changed, everything else as it was; and cards written anew.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "mesh/deck/nastran/card.h"

namespace prismesh::mesh::deck::nastran {

/// "\n" or "\r\n": as the line at `offset` ends, or the one before it where that is the last.
std::string line_end_at(std::string_view text, std::size_t offset);

class CardEdit {
 public:
  /// Of the card at `offset` of a file's text.
  CardEdit(std::string_view text, std::size_t offset);

  /// How wide a number may be in that field. In free field eight columns count as well, but what stands there already may be longer.
  std::size_t width(std::size_t field) const;
  /// Puts a text into a data field, leaning to the side that the old one leans to; lines that lack are added.
  void set(std::size_t field, const std::string& value);
  /// The lines that hold none of the fields before `field` go, but for comments.
  void drop_lines_from(std::size_t field);
  std::string text() const;

 private:
  struct Row {
    std::string text;
    std::string end;       ///< its line end; of the last: none
    bool comment = false;  ///< between two lines of the card
    Layout layout = Layout::small;
    std::size_t first_field = 0;
  };
  const Row* row_of(std::size_t field) const;
  Row& make_row_of(std::size_t field);
  static void set_columns(Row& row, std::size_t slot, const std::string& value);
  static void set_commas(Row& row, std::size_t slot, const std::string& value);

  std::vector<Row> rows_;
  std::string line_end_;
};

/// How a card's numbers stand in their columns.
struct Manner {
  Layout layout = Layout::small;
  bool leans_left = false;
  std::string line_end;
};
Manner manner_of(std::string_view text, std::size_t offset);

/// A card of these fields; blanks at the end are left out.
std::string write_card(std::string_view name, const std::vector<std::string>& fields, const Manner& manner);

}  // namespace prismesh::mesh::deck::nastran
