// Changes fields of a card's text and keeps everything else; and writes new cards.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "mesh/deck/nastran/card.h"

namespace prismesh::mesh::deck::nastran {

/// The line end behind `offset`: "\n" or "\r\n". In a last line without one, that of the line before.
std::string line_end_at(std::string_view text, std::size_t offset);

class CardEdit {
 public:
  /// Takes the card at `offset` of a file's text.
  CardEdit(std::string_view text, std::size_t offset);

  /// The maximum width of a number in a field. In free field format it is eight too, or the length of the text that stands there.
  std::size_t width(std::size_t field) const;
  /// Puts a text into a data field, aligned as the old one was. Adds missing lines.
  void set(std::size_t field, const std::string& value);
  /// Removes the lines without a field before `field`, except for comments.
  void drop_lines_from(std::size_t field);
  std::string text() const;

 private:
  struct Row {
    std::string text;
    std::string end;       ///< its line end; empty: the last row
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

/// How a card is laid out.
struct Manner {
  Layout layout = Layout::small;
  bool leans_left = false;
  std::string line_end;
};
Manner manner_of(std::string_view text, std::size_t offset);

/// Writes a card of some fields. Blank ones at the end are left out.
std::string write_card(std::string_view name, const std::vector<std::string>& fields, const Manner& manner);

}  // namespace prismesh::mesh::deck::nastran
