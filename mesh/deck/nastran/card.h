// A bulk data entry cut into fields: small (8 columns), large (16) and free (commas), mixed from line to line as Nastran allows.
// MSC Nastran Quick Reference Guide, "Format of Bulk Data Entries".
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace prismesh::mesh::deck::nastran {

/// The layout of a line. That of a card's first line is its CardRun::style.
enum class Layout : std::uint8_t { small, large, free_small, free_large };

constexpr bool is_free(Layout layout) { return layout == Layout::free_small || layout == Layout::free_large; }
constexpr bool is_large(Layout layout) { return layout == Layout::large || layout == Layout::free_large; }
/// Data fields on a line: the first and the last hold the entry's name and that of its continuation.
constexpr std::size_t fields_on(Layout layout) { return is_large(layout) ? 4 : 8; }
constexpr std::size_t width_of(Layout layout) { return is_large(layout) ? 16 : 8; }
inline constexpr std::size_t kNameColumns = 8;
inline constexpr std::size_t kDataColumns = 72;

enum class LineKind : std::uint8_t { card, continuation, replication, comment };

struct Line {
  std::string_view text;   ///< without its end
  std::size_t offset = 0;  ///< in the file
  std::size_t next = 0;    ///< where the next one begins
};

/// The line at `at`; reading stops at the end of `text`. Precondition: at < text.size().
Line line_at(std::string_view text, std::size_t at);
LineKind kind_of(std::string_view line);
/// Whether a card begins with this line; false for replications, which need the card before them.
inline bool starts_card(std::string_view line) { return kind_of(line) == LineKind::card; }
Layout layout_of(std::string_view line);
/// The line with blanks for tabs, cut off where no more columns count.
std::string without_tabs(std::string_view line);

/// The lines of the card at `at`: with its continuations and the comments between them.
struct CardLines {
  std::vector<Line> lines;  ///< without the comments
  std::size_t end = 0;      ///< one past the last character of the last line
  std::size_t next = 0;     ///< where the line after that begins
  bool cut_off = false;     ///< there are more lines than any card has; they aren't among `lines`

  void read(std::string_view text, std::size_t at);
};

/// One past the last character of the card's last line.
std::size_t end_of_card(std::string_view text, std::size_t at);

/// A card's name and data fields, counted from 0 over all its lines: eight a line, or eight each two lines of large field.
class Card {
 public:
  void cut(const CardLines& lines);
  /// Makes the card from fields, which are copied.
  void assign(std::string_view name, const std::vector<std::string>& fields, Layout layout);

  std::string_view name() const { return {name_, name_size_}; }  ///< upper case, without an asterisk
  Layout layout() const { return layout_; }
  std::size_t size() const { return fields_.size(); }
  /// Trimmed; empty beyond the last.
  std::string_view text(std::size_t field) const { return field < fields_.size() ? fields_[field] : std::string_view(); }
  bool blank(std::size_t field) const { return text(field).empty(); }
  /// Blank is 0; nullopt: it isn't such a number.
  std::optional<std::int64_t> integer(std::size_t field) const;
  std::optional<double> real(std::size_t field) const;
  /// As integer, with 0 where it is no whole number.
  std::int64_t integer_or_zero(std::size_t field) const { return integer(field).value_or(0); }

  /// Offset of a continuation whose name differs from the one that the line before gives.
  const std::optional<std::size_t>& misplaced() const { return misplaced_; }
  /// A free-field line has more fields than a line can have; they aren't read.
  bool overlong() const { return overlong_; }

 private:
  void cut_line(const Line& line, bool first);
  void cut_columns(std::string_view line, Layout layout, std::string_view& own, std::string_view& next);
  void cut_commas(std::string_view line, Layout layout, std::string_view& own, std::string_view& next);
  void set_name(std::string_view name);

  char name_[kNameColumns] = {};
  std::size_t name_size_ = 0;
  Layout layout_ = Layout::small;
  Layout last_layout_ = Layout::small;
  std::string_view next_field_;  ///< of the line before: what its continuation begins with
  std::vector<std::string_view> fields_;
  std::deque<std::string> owned_;
  std::optional<std::size_t> misplaced_;
  bool overlong_ = false;
};

/// Whether a field is written as a real number.
bool has_point(std::string_view text);
/// Whether `text` begins with `start` (upper case), in any case.
bool begins_with(std::string_view text, std::string_view start);

}  // namespace prismesh::mesh::deck::nastran
