#include "kiosk/tools/files/browse.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>
#include <system_error>

#include <fmt/format.h>

#include "base/letter_case.h"
#include "kiosk/panels/text.h"

namespace prismesh::kiosk::tools::files {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxEntries = 20000;

std::string size_words(std::uintmax_t bytes) {
  if (bytes < 1000) return fmt::format("{} B", bytes);
  constexpr std::array<const char*, 4> kUnits{"kB", "MB", "GB", "TB"};
  double size = static_cast<double>(bytes) / 1000;
  std::size_t unit = 0;
  for (; size >= 1000 && unit + 1 < kUnits.size(); ++unit) size /= 1000;
  return fmt::format("{:.{}f} {}", size, size < 10 ? 1 : 0, kUnits[unit]);
}

}  // namespace

bool is_deck_name(std::string_view name) {
  std::string plain = lower(name);
  for (const std::string_view packed : {".gz", ".zst"})
    if (plain.ends_with(packed)) plain.resize(plain.size() - packed.size());
  constexpr std::array<std::string_view, 10> kEndings{".k", ".key", ".dyn", ".inp", ".bdf", ".nas", ".dat", ".fem", ".rad", ".inc"};
  return std::ranges::any_of(kEndings, [&](std::string_view ending) { return plain.ends_with(ending); });
}

std::string copy_name(const std::string& deck) {
  const fs::path path(deck);
  std::string name = path.filename().string(), ending;
  for (int endings = 0; endings < 2; ++endings) {  // ".k.gz" is one
    const std::size_t point = name.rfind('.');
    if (point == std::string::npos || point == 0) break;
    ending.insert(0, name.substr(point));
    name.resize(point);
    if (ending != ".gz" && ending != ".zst") break;
  }
  std::error_code ignored;
  for (int number = 1; number < 1000; ++number) {
    const fs::path copy = path.parent_path() / (name + "_copy" + (number > 1 ? fmt::format("_{}", number) : "") + ending);
    if (!fs::exists(copy, ignored)) return copy.string();
  }
  return deck;
}

Browsed browse(const std::string& typed, bool all) {
  const std::size_t slash = typed.rfind('/');
  const std::string folder = slash == std::string::npos ? "" : typed.substr(0, slash + 1);
  const std::string piece = lower(slash == std::string::npos ? typed : typed.substr(slash + 1));
  Browsed found;
  std::error_code error;
  std::vector<BrowseRow> holding;
  std::size_t read = 0;
  fs::directory_iterator entry(folder.empty() ? "." : folder, error);
  if (error) {
    found.problem = fmt::format("{}: {}", folder.empty() ? "." : folder, error.message());
    return found;
  }
  for (const fs::directory_iterator end; !error && entry != end; entry.increment(error)) {
    if (++read > kMaxEntries) {
      found.cut = true;
      break;
    }
    const std::string name = entry->path().filename().string(), plain = lower(name);
    if (name.starts_with('.') && !piece.starts_with('.')) continue;
    std::error_code unreadable;
    const bool is_folder = entry->is_directory(unreadable);
    const bool is_deck = !is_folder && is_deck_name(name);
    (is_folder ? found.folders : is_deck ? found.decks : found.others) += 1;
    if (!is_folder && !is_deck && !all) continue;
    BrowseRow row{folder + name + (is_folder ? "/" : ""), name + (is_folder ? "/" : ""), "", is_folder};
    if (!is_folder) {
      const std::uintmax_t size = entry->file_size(unreadable);
      row.detail = unreadable ? "" : size_words(size);
    }
    if (plain.starts_with(piece))
      found.rows.push_back(std::move(row));
    else if (plain.find(piece) != std::string::npos)
      holding.push_back(std::move(row));
  }
  if (error) found.problem = fmt::format("{}: {}", folder, error.message());
  if (found.rows.empty()) found.rows = std::move(holding);
  std::ranges::sort(found.rows, [](const BrowseRow& a, const BrowseRow& b) { return a.folder != b.folder ? a.folder : a.words < b.words; });
  return found;
}

std::string line_of(const RecentDeck& deck) { return fmt::format("{} {} {} {}", deck.shells, deck.nodes, deck.parts, deck.path); }

RecentDeck recent_from(std::string_view line) {
  RecentDeck deck;
  for (std::uint64_t* number : {&deck.shells, &deck.nodes, &deck.parts}) {
    const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), *number);
    const auto read = static_cast<std::size_t>(end - line.data());
    if (error != std::errc() || read >= line.size() || line[read] != ' ') return {};
    line.remove_prefix(read + 1);
  }
  deck.path = line;
  return deck;
}

std::vector<RecentDeck> recent_decks(std::span<const std::string> lines, std::size_t limit) {
  std::vector<RecentDeck> decks;
  for (auto line = lines.rbegin(); line != lines.rend() && decks.size() < limit; ++line) {
    RecentDeck deck = recent_from(*line);
    if (!deck.path.empty() && std::ranges::find(decks, deck.path, &RecentDeck::path) == decks.end()) decks.push_back(std::move(deck));
  }
  return decks;
}

std::size_t before_absolute_path(std::string_view typed) {
  const std::size_t slashes = typed.rfind("//");
  return slashes == std::string_view::npos ? 0 : slashes + 1;
}

}  // namespace prismesh::kiosk::tools::files
