#include "mesh/deck/nastran/fast_lines.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <optional>

#include "mesh/deck/text/number.h"

namespace prismesh::mesh::deck::nastran {
namespace {

/// Eight characters as one number, to be compared at once.
inline std::uint64_t word(const char* at) {
  std::uint64_t value;
  std::memcpy(&value, at, sizeof value);
  return value;
}

constexpr std::uint64_t word_of(const char (&name)[9]) {
  std::uint64_t value = 0;
  for (std::size_t i = 8; i-- > 0;) value = value << 8 | static_cast<unsigned char>(name[i]);
  return value;
}
static_assert(std::endian::native == std::endian::little);
constexpr std::uint64_t kGrid = word_of("GRID    ");
constexpr std::uint64_t kLargeGrid = word_of("GRID*   ");
constexpr std::uint64_t kQuad = word_of("CQUAD4  ");
constexpr std::uint64_t kTria = word_of("CTRIA3  ");

constexpr std::size_t kSmall = width_of(Layout::small);
constexpr std::size_t kLarge = width_of(Layout::large);

inline bool starts_name(char c) { return static_cast<unsigned char>((c | 0x20) - 'a') < 26; }

/// Whether the line at `next` begins a card of its own: neither a continuation nor a comment, behind which a continuation may stand, nor a
/// replication.
bool followed_by_card(std::string_view text, std::size_t next) { return next >= text.size() || starts_name(text[next]); }

std::string_view columns(std::string_view line, std::size_t begin, std::size_t width) {
  return begin < line.size() ? line.substr(begin, width) : std::string_view();
}

/// The id of the coordinate system in a field that begins at `begin`; of a blank one GRDSET's.
std::optional<std::uint32_t> system_at(std::string_view line, std::size_t begin, std::size_t width) {
  const char* const at = line.data() + begin;
  const char* const end = std::min(at + width, line.data() + line.size());
  std::int64_t id = 0;
  if (!plain_integer(at, end, id) || id > kMaxSystem) return std::nullopt;
  return id == 0 && std::find(at, end, '0') == end ? kSystemOfGrdset : static_cast<std::uint32_t>(id);
}

/// The id in a whole field. False: it is no id.
bool read_id(std::string_view line, std::size_t begin, std::size_t width, std::int64_t& id) {
  const char* const at = line.data() + begin;
  return plain_integer(at, std::min(at + width, line.data() + line.size()), id) && id > 0;
}

bool read_small_grid(const Line& line, PieceEntities& entities) {
  const std::string_view text = line.text;
  GridEntry grid;
  if (!read_id(text, kNameColumns, kSmall, grid.id)) return false;
  const std::optional<std::uint32_t> system = system_at(text, kNameColumns + kSmall, kSmall);
  if (!system || !parse_real(columns(text, 24, kSmall), grid.position[0]) || !parse_real(columns(text, 32, kSmall), grid.position[1]) ||
      !parse_real(columns(text, 40, kSmall), grid.position[2]))
    return false;
  grid.offset = line.offset;
  grid.system = *system;
  entities.add(grid);
  return true;
}

/// Whether the names that join two lines are plainly the same, or one of them is blank.
bool same_continuation(std::string_view first, std::string_view second) {
  std::string_view wanted = trim(columns(first, kDataColumns, kNameColumns));
  std::string_view found = trim(columns(second, 0, kNameColumns));
  if (!wanted.empty() && (wanted[0] == '*' || wanted[0] == '+')) wanted.remove_prefix(1);
  found.remove_prefix(1);
  return (trim(wanted).empty() || trim(found).empty() || wanted == found) && found.find(',') == std::string_view::npos;
}

bool read_large_grid(const Line& first, const Line& second, PieceEntities& entities) {
  GridEntry grid;
  if (first.text.size() < 2 * kLarge + kNameColumns || !read_id(first.text, kNameColumns, kLarge, grid.id)) return false;
  const std::optional<std::uint32_t> system = system_at(first.text, kNameColumns + kLarge, kLarge);
  if (!system || !parse_real(columns(first.text, 40, kLarge), grid.position[0]) ||
      !parse_real(columns(first.text, 56, kLarge), grid.position[1]) || !parse_real(columns(second.text, 8, kLarge), grid.position[2]))
    return false;
  grid.offset = first.offset;
  grid.layout = Layout::large;
  grid.system = *system;
  entities.add(grid);
  return true;
}

bool read_small_shell(const Line& line, std::size_t corners, PieceEntities& entities) {
  std::int64_t fields[6];  // id, property, corners
  const std::size_t wanted = corners + 2;
  if (line.text.size() <= kNameColumns + (wanted - 1) * kSmall) return false;
  for (std::size_t f = 0; f < wanted; ++f)
    if (!read_id(line.text, kNameColumns + f * kSmall, kSmall, fields[f])) return false;
  entities.add(ShellEntry{
      fields[0], fields[1], {fields[2], fields[3], fields[4], corners == 4 ? fields[5] : fields[4]}, line.offset, Layout::small, 0});
  return true;
}

}  // namespace

std::size_t read_fast(std::string_view text, const Line& line, PieceEntities& entities, FastShellCounts& counts) {
  if (line.text.size() < kNameColumns + 2 * kSmall) return 0;
  const std::uint64_t name = word(line.text.data());
  if (name == kLargeGrid) {
    if (line.next >= text.size() || text[line.next] != '*') return 0;
    const Line second = line_at(text, line.next);
    if (!followed_by_card(text, second.next) || !same_continuation(line.text, second.text)) return 0;
    return read_large_grid(line, second, entities) ? second.next : 0;
  }
  if (name != kGrid && name != kQuad && name != kTria) return 0;
  if (!followed_by_card(text, line.next)) return 0;
  if (name == kGrid) return read_small_grid(line, entities) ? line.next : 0;
  if (!read_small_shell(line, name == kQuad ? 4 : 3, entities)) return 0;
  ++(name == kQuad ? counts.quads : counts.trias);
  return line.next;
}

}  // namespace prismesh::mesh::deck::nastran
