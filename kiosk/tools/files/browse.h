// What a path that is being typed can go on with: folders and decks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace prismesh::kiosk::tools::files {

/// A folder or file that can be chosen.
struct BrowseRow {
  std::string path;    ///< what the field becomes: a folder's ends with '/'
  std::string words;   ///< name, or name and folder of a recent deck
  std::string detail;  ///< size, or counts of a recent deck
  bool folder = false;
};

struct Browsed {
  std::vector<BrowseRow> rows;
  std::size_t folders = 0, decks = 0, others = 0;  ///< in the folder; `others` aren't listed
  std::string problem;                             ///< why the folder can't be read
  bool cut = false;                                ///< it holds more than are read
};

/// The entries of the folder of `typed` whose names begin with its last piece, else hold it; letters without case. Folders first, each
/// ascending. Only decks and folders, unless `all`. Hidden ones only when the piece begins with '.'. Reads at most 20,000 entries.
Browsed browse(const std::string& typed, bool all);

/// Whether a file's name is a deck's: by its ending, packed or not.
bool is_deck_name(std::string_view name);

/// Beside a deck, the first name for a copy that isn't there yet: "car_copy.k", "car_copy_2.k". Endings of packed decks stay.
/// How many bytes of a typed text a path from the root takes the place of: those before the last "//". A path typed behind the folder that
/// stands in the field is meant so, as shells and editors do it.
std::size_t before_absolute_path(std::string_view typed);
std::string copy_name(const std::string& deck);

/// How many bytes of a typed text a path from the root takes the place of: those before the last slash of the last "//". A path typed
/// behind the folder that stands in the field is meant so, as in shells and editors.
std::size_t before_absolute_path(std::string_view typed);

/// A deck that was open before.
struct RecentDeck {
  std::string path;
  std::uint64_t shells = 0, nodes = 0, parts = 0;
  bool operator==(const RecentDeck&) const = default;
};
/// One line of the file of recent decks, and back: the counts, then the path. A line that is none gives an empty path.
std::string line_of(const RecentDeck& deck);
RecentDeck recent_from(std::string_view line);
/// From lines that were added in turn: the newest first, each deck once, at most `limit`.
std::vector<RecentDeck> recent_decks(std::span<const std::string> lines, std::size_t limit);

}  // namespace prismesh::kiosk::tools::files
