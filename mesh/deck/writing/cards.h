// What a format's writer (card_writer.h) takes and returns: a card in its file's text, and new text for it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace prismesh::mesh::deck {

/// A card in a file's text.
struct CardRef {
  std::string_view text;    ///< of the whole file
  std::size_t offset = 0;   ///< of the card's first line
  std::uint16_t style = 0;  ///< of its run (CardRun::style): columns, options
};

/// A card's new text, from its first character to the end of its last line, without that line's end.
struct WrittenCard {
  std::string text;
  int rounded = 0;            ///< numbers whose field can't hold them exactly
  double largest_error = 0;   ///< of those numbers
  bool turned = false;        ///< angles were changed because the first edge has turned
  bool by_parameter = false;  ///< a parameter gives what would have to change: the text isn't usable
};

/// A shell to write: a changed one, or a new one. The example is the card of the shell that it comes from.
struct ShellCard {
  std::int64_t id = 0;
  std::array<std::int64_t, 4> nodes{};  ///< corners; a triangle repeats its third
  /// share[c][k]: the weight of the example's corner k at this shell's corner c. Corner thicknesses and offsets are mixed with it.
  std::array<std::array<double, 4>, 4> share{};
  double turn_degrees = 0;  ///< from the example's first edge to this one's, about the example's normal; material angles follow it
};

/// Where the card of an element stands that is no shell: the deck keeps no places of these, they are searched.
struct ElementPlace {
  std::uint32_t file = 0;         ///< index into Deck::files
  std::uint64_t offset = 0;       ///< of its first line
  std::uint64_t end = 0;          ///< one past its last line's last character
  std::uint16_t style = 0;        ///< a number that only the format's own writer knows
  std::int64_t last_in_file = 0;  ///< the largest id of the class in the file's text
};

/// A new element that is no shell; ids as in the file's text.
struct ElementCard {
  ElementClass element_class = ElementClass::beam;
  std::int64_t id = 0;
  std::int64_t part = 0;
  std::vector<std::int64_t> nodes;
  std::vector<std::int64_t> sheets;  ///< of each node: the part on whose shells it lies, 0: none or several. For writers that ask for it
};

/// How a card that names a single node or shell (ReferenceRole::single) applies to what comes from that one: to a node between others
/// that are all named so, and to the pieces of a split shell.
enum class Inheritance : std::uint8_t {
  stays,    ///< it doesn't, it goes on applying to the one it names: a history, a concentrated force, a weld
  follows,  ///< it applies to them as well, each by a card of its own (`copy_single`): a constraint, a pressure, an initial stress
  forbids,  ///< how to divide it is unknown: the edit is refused
};

/// Text that replaces other text of one file.
struct Replacement {
  std::size_t offset = 0;
  std::size_t length = 0;
  std::string text;
};
struct FileReplacement {
  std::uint32_t file = 0;  ///< index into Deck::files
  Replacement replacement;
};

}  // namespace prismesh::mesh::deck
