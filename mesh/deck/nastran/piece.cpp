#include "mesh/deck/nastran/piece.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "mesh/deck/nastran/elements.h"
#include "mesh/deck/nastran/replication.h"
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

inline bool starts_card(char c) { return static_cast<unsigned char>((c | 0x20) - 'a') < 26; }

constexpr std::size_t kSmall = width_of(Layout::small);
constexpr std::size_t kLarge = width_of(Layout::large);

bool is_all_digits(std::string_view text) { return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos; }

std::string too_long(std::string_view entry, std::string_view id) {
  return "the id of a " + std::string(entry) + " may have up to 18 digits, but this one has " + quoted(id);
}

class PieceReader {
 public:
  PieceReader(std::string_view text, const Piece& piece, PieceContent& out)
      : text_(text.substr(0, piece.end)), piece_(piece), out_(out.cards), facts_(out.facts) {
    out_.file = piece.file;
  }

  void run() {
    for (std::size_t at = piece_.begin; at < text_.size() && !out_.error;) {
      const Line line = line_at(text_, at);
      if (read_fast(line)) {
        at = line_next_;
        continue;
      }
      at = read_slowly(line);
    }
    facts_.references = references_.finish();
  }

 private:
  // ---- the fast way: small field grid points and shells without continuation, large field grid points of two lines ----

  /// Whether the line after begins a card of its own: continuations, comments they may hide behind, and replications are for the slow way.
  bool followed_by_card(std::size_t next) const { return next >= text_.size() || starts_card(text_[next]); }

  bool read_fast(const Line& line) {
    const std::string_view text = line.text;
    if (text.size() < kNameColumns + 2 * kSmall) return false;
    const std::uint64_t name = word(text.data());
    line_next_ = line.next;
    if (name == kGrid) return followed_by_card(line.next) && read_small_grid(text, line.offset);
    if (name == kQuad) return followed_by_card(line.next) && read_small_shell(text, line.offset, 4);
    if (name == kTria) return followed_by_card(line.next) && read_small_shell(text, line.offset, 3);
    if (name == kLargeGrid) return read_large_grid(line);
    return false;
  }

  bool read_small_grid(std::string_view text, std::size_t offset) {
    const char* p = text.data() + kNameColumns;
    std::int64_t id = 0;
    Vec3 at;
    if (!plain_integer(p, p + kSmall, id) || id <= 0 || !read_system(p + kSmall, text.data() + text.size(), kSmall)) return false;
    if (!parse_real(columns(text, 24, kSmall), at[0]) || !parse_real(columns(text, 32, kSmall), at[1]) ||
        !parse_real(columns(text, 40, kSmall), at[2]))
      return false;
    add_node(id, at, offset, Layout::small, system_);
    return true;
  }

  bool read_large_grid(const Line& line) {
    if (line.next >= text_.size() || text_[line.next] != '*') return false;
    const Line second = line_at(text_, line.next);
    if (!followed_by_card(second.next) || !same_continuation(line.text, second.text)) return false;
    const std::string_view text = line.text;
    const char* p = text.data() + kNameColumns;
    std::int64_t id = 0;
    Vec3 at;
    if (text.size() < 2 * kLarge + kNameColumns || !plain_integer(p, p + kLarge, id) || id <= 0 ||
        !read_system(p + kLarge, text.data() + text.size(), kLarge))
      return false;
    if (!parse_real(columns(text, 40, kLarge), at[0]) || !parse_real(columns(text, 56, kLarge), at[1]) ||
        !parse_real(columns(second.text, 8, kLarge), at[2]))
      return false;
    add_node(id, at, line.offset, Layout::large, system_);
    line_next_ = second.next;
    return true;
  }

  /// The names that join two lines, where both are plainly the same or blank.
  static bool same_continuation(std::string_view first, std::string_view second) {
    std::string_view wanted = trim(columns(first, kDataColumns, kNameColumns));
    std::string_view found = trim(columns(second, 0, kNameColumns));
    if (!wanted.empty() && (wanted[0] == '*' || wanted[0] == '+')) wanted.remove_prefix(1);
    found.remove_prefix(1);
    return (trim(wanted).empty() || trim(found).empty() || wanted == found) && found.find(',') == std::string_view::npos;
  }

  bool read_small_shell(std::string_view text, std::size_t offset, int corners) {
    std::int64_t fields[6];
    const std::size_t wanted = static_cast<std::size_t>(corners) + 2;
    if (text.size() <= kNameColumns + (wanted - 1) * kSmall) return false;
    const char* p = text.data() + kNameColumns;
    for (std::size_t f = 0; f < wanted; ++f, p += kSmall)
      if (!plain_integer(p, std::min(p + kSmall, text.data() + text.size()), fields[f])) return false;
    if (std::any_of(fields, fields + wanted, [](std::int64_t id) { return id <= 0; })) return false;
    const std::array<std::int64_t, 4> nodes{fields[2], fields[3], fields[4], corners == 4 ? fields[5] : fields[4]};
    add_shell(fields[0], fields[1], nodes, offset, Layout::small, 0);
    if (corners == 4) {
      ++out_.counts.quad;
      ++quads_;
    } else {
      ++out_.counts.tri;
      ++trias_;
    }
    return true;
  }

  static std::string_view columns(std::string_view line, std::size_t begin, std::size_t width) {
    return begin < line.size() ? line.substr(begin, width) : std::string_view();
  }

  /// Into system_; blank means GRDSET's.
  bool read_system(const char* at, const char* end, std::size_t width) {
    end = std::min(at + width, end);
    std::int64_t id = 0;
    if (!plain_integer(at, end, id) || id > kMaxSystem) return false;
    system_ = static_cast<std::uint32_t>(id);
    if (id == 0 && std::find(at, end, '0') == end) system_ = kSystemOfGrdset;
    return true;
  }

  void add_node(std::int64_t id, const Vec3& position, std::size_t offset, Layout layout, std::uint32_t system) {
    if (!nodes_begun_ || node_layout_ != layout || node_system_ != system) {
      out_.begin_nodes(static_cast<std::uint16_t>(layout), system);
      nodes_begun_ = true;
      node_layout_ = layout;
      node_system_ = system;
    }
    out_.node_id.push_back(id);
    out_.position.push_back(position);
    out_.node_offset.push_back(offset);
  }

  void add_shell(std::int64_t id, std::int64_t part, const std::array<std::int64_t, 4>& nodes, std::size_t offset, Layout layout,
                 float thickness) {
    RawShells& shells = out_.shells;
    if (!shells_begun_ || shell_layout_ != layout) {
      out_.begin_shells(static_cast<std::uint16_t>(layout));
      shells_begun_ = true;
      shell_layout_ = layout;
    }
    shells.id.push_back(id);
    shells.part.push_back(part);
    shells.nodes.push_back(nodes);
    shells.offset.push_back(offset);
    if (thickness != 0 || !shells.thickness.empty()) {
      shells.thickness.resize(shells.id.size());
      shells.thickness.back() = thickness;
    }
  }

  // ---- every other card, in any layout ----

  /// Where the line after the card begins.
  std::size_t read_slowly(const Line& line) {
    switch (kind_of(line.text)) {
      case LineKind::comment: facts_.definitions.read_comment(line.text); return line.next;
      case LineKind::continuation:
        facts_.note("stray-continuation", line.offset, "a continuation follows no card; it is kept but means nothing");
        return line.next;
      case LineKind::replication: return replicate(line);
      case LineKind::card: break;
    }
    lines_.read(text_, line.offset);
    card_.cut(lines_);
    place_ = {piece_.file, line.offset, lines_.end};
    offset_ = line.offset;
    const bool repeated = lines_.next < text_.size() && text_[lines_.next] == '=';
    if (repeated)
      replication_.set_template(card_);
    else
      replication_.clear();
    made_ = repeated;  // moving the template would move the copies
    read_card();
    made_ = false;
    return lines_.next;
  }

  std::size_t replicate(const Line& line) {
    lines_.read(text_, line.offset);
    card_.cut(lines_);
    const std::size_t copies = replication_.has_template() ? replication_.read(card_) : 0;
    made_copies_ += copies;
    if (copies == 0) {
      facts_.note("unread-replication", line.offset, "a replication follows no card or isn't understood; what it makes isn't shown");
      replication_.clear();
    } else if (made_copies_ > Replication::kMaxCopies) {
      fail_at(line.offset, "the replications up to here make more than " + std::to_string(Replication::kMaxCopies) + " cards");
      return lines_.next;
    }
    place_ = {piece_.file, line.offset, lines_.end};
    offset_ = line.offset;
    made_ = true;
    for (std::size_t c = 0; c < copies && !out_.error; ++c) {
      replication_.make(card_);
      read_card();
    }
    made_ = false;
    return lines_.next;
  }

  void fail_at(std::size_t offset, std::string message) {
    if (!out_.error) out_.error = {offset, std::move(message)};
  }

  void read_card() {
    const std::string_view name = card_.name();
    if (name == "GRID") return read_grid();
    if (const ElementForm* form = element_form(name)) return read_element(*form);
    if (card_.misplaced())
      facts_.note("continuation-order", *card_.misplaced(),
                  "a continuation of the " + std::string(name) +
                      " card has another name than the line before asks for; it is taken to belong there all the same");
    if (card_.overlong() || lines_.cut_off)
      facts_.note("long-card", offset_,
                  "the " + std::string(name) + " card has more fields than a card can have; the last ones aren't read");
    read_other(name);
  }

  /// Mesh cards must be read whole: what an element is made of can't be guessed.
  bool whole(std::string_view what) {
    if (!card_.misplaced()) return true;
    fail_at(*card_.misplaced(), "the continuation of this " + std::string(what) +
                                    " has another name than the line before asks for: decks with continuations out of order aren't read; "
                                    "have the pre-processor write them in order");
    return false;
  }

  void read_grid() {
    if (!whole("GRID")) return;
    const std::optional<std::int64_t> id = card_.integer(0);
    if (!id && is_all_digits(card_.text(0))) return fail_at(offset_, too_long("GRID", card_.text(0)));
    if (!id || *id <= 0) return fail_at(offset_, "a GRID needs an id above 0, but this one has " + quoted(card_.text(0)));
    const std::optional<std::int64_t> system = card_.integer(1);
    if (!system || *system < 0 || *system > kMaxSystem)
      return fail_at(offset_, "expected the coordinate system of GRID " + std::to_string(*id) + " but found " + quoted(card_.text(1)));
    Vec3 at;
    for (int axis = 0; axis < 3; ++axis) {
      const std::optional<double> value = card_.real(static_cast<std::size_t>(axis) + 2);
      if (!value)
        return fail_at(offset_, "expected coordinate " + std::to_string(axis + 1) + " of GRID " + std::to_string(*id) + " but found " +
                                    quoted(card_.text(static_cast<std::size_t>(axis) + 2)));
      at[axis] = *value;
    }
    if (made_) out_.holds.emplace_back(static_cast<std::uint32_t>(out_.node_id.size()), kHeldByMaking);
    add_node(*id, at, offset_, card_.layout(), card_.blank(1) ? kSystemOfGrdset : static_cast<std::uint32_t>(*system));
  }

  void read_element(const ElementForm& form) {
    if (!whole(form.name)) return;
    const std::optional<std::int64_t> id = card_.integer(0);
    if (!id && is_all_digits(card_.text(0))) return fail_at(offset_, too_long(form.name, card_.text(0)));
    if (!id) return fail_at(offset_, "expected the id of a " + std::string(form.name) + " but found " + quoted(card_.text(0)));
    if (lines_.cut_off || card_.overlong())
      facts_.note("long-card", offset_,
                  "the " + std::string(form.name) + " card has more fields than a card can have; the last ones aren't read");
    out_.count_kind(form.name);
    const bool whole_element = read_nodes(card_, form, nodes_) && *id > 0;
    if (form.element_class == ElementClass::shell)
      read_shell(form, *id, whole_element);
    else
      read_other_element(form, *id, whole_element);
  }

  /// A property that the card leaves out has the element's id.
  std::int64_t part_of(const ElementForm& form, std::int64_t id) const {
    if (form.property < 0) return kNoPart;
    const auto field = static_cast<std::size_t>(form.property);
    return card_.blank(field) ? id : card_.integer_or_zero(field);
  }

  void read_other_element(const ElementForm& form, std::int64_t id, bool whole_element) {
    switch (form.element_class) {
      case ElementClass::beam: ++out_.counts.beam; break;
      case ElementClass::solid: ++out_.counts.solid; break;
      default: ++out_.counts.other; break;
    }
    if (form.fields == NodeFields::none_shown) return;
    references_.read_element(card_, form, nodes_, place_);
    if (!whole_element) return out_.note("incomplete-element", offset_, id);
    add_element(form, id, nodes_);
    if (form.fields != NodeFields::pairs || card_.integer_or_zero(4) <= 0) return;
    nodes_ = {card_.integer_or_zero(5), card_.integer_or_zero(6)};
    if (nodes_[0] > 0 && nodes_[1] > 0) add_element(form, card_.integer_or_zero(4), nodes_);
  }

  void add_element(const ElementForm& form, std::int64_t id, const std::vector<std::int64_t>& nodes) {
    RawElements& to = out_.elements[static_cast<std::size_t>(form.element_class)];
    to.id.push_back(id);
    to.part.push_back(part_of(form, id));
    to.nodes.insert(to.nodes.end(), nodes.begin(), nodes.end());
    to.first_node.push_back(static_cast<std::uint32_t>(to.nodes.size()));
    to.offset.push_back(offset_);
  }

  void read_shell(const ElementForm& form, std::int64_t id, bool whole_element) {
    const ShellFields fields = shell_fields(form.name);
    std::array<std::int64_t, 4> midside{};
    bool has_midside = false;
    for (std::size_t i = 0; i < fields.midside; ++i) {
      midside[i] = std::max<std::int64_t>(card_.integer_or_zero(form.first + fields.corners + i), 0);
      has_midside |= midside[i] > 0;
    }
    if (fields.corners == 4)
      ++(fields.midside > 0 && has_midside ? out_.counts.quad8 : out_.counts.quad);
    else
      ++(fields.midside > 0 && has_midside ? out_.counts.tri6 : out_.counts.tri);
    if (!whole_element) return out_.note("incomplete-element", offset_, id);
    std::array<std::int64_t, 4> corners{};
    for (std::size_t i = 0; i < 4; ++i) corners[i] = card_.integer_or_zero(form.first + std::min<std::size_t>(i, fields.corners - 1u));
    if (form.name == "CQUAD" && card_.integer_or_zero(10) > 0)
      facts_.note("centre-node", offset_, "the centre nodes of CQUAD elements aren't moved along with them");
    const auto index = static_cast<std::uint32_t>(out_.shells.id.size());
    add_shell(id, part_of(form, id), corners, offset_, card_.layout(), own_thickness(fields, index));
    if (has_midside) out_.shells.midside.emplace_back(index, midside);
  }

  /// The mean of the corners' own; 0 where they have none. What needs the property's thickness is noted for later.
  float own_thickness(const ShellFields& fields, std::uint32_t shell) {
    if (fields.thickness == 0) return 0;
    ThicknessFields own{shell, 0, 0, fields.corners, card_.integer_or_zero(fields.relative) == 1};
    for (std::size_t corner = 0; corner < fields.corners; ++corner) {
      const std::optional<double> value = card_.real(fields.thickness + corner);
      if (card_.blank(fields.thickness + corner) || !value) continue;
      own.sum += *value;
      ++own.given;
    }
    if (own.given == 0) return 0;
    const auto mean = static_cast<float>(own.sum / own.given);
    if (own.given == own.corners && !own.relative) return mean;
    facts_.thickness.push_back(own);
    return mean;
  }

  void read_other(std::string_view name) {
    bool bad_system = false;
    if (facts_.definitions.read(card_, offset_)) {
      return;
    } else if (read_systems(card_, offset_, facts_.systems, bad_system)) {
      for (auto system = facts_.systems.rbegin(); system != facts_.systems.rend() && system->offset == offset_; ++system)
        system->file = piece_.file;
      if (bad_system) facts_.note("bad-coordinate-system", offset_, "a coordinate system has something that is no number; it is left out");
      references_.read(card_, place_);
    } else if (name == "GRDSET") {
      const std::int64_t system = card_.integer_or_zero(1);
      facts_.grid_default.emplace_back(offset_, system < 0 || system > kMaxSystem ? 0 : system);
    } else if (name == "SPOINT" || name == "EPOINT") {
      read_scalar_points();
    } else if (is_old_element(name)) {
      const auto at = facts_.old_elements.find(name);
      ++(at != facts_.old_elements.end() ? at->second : facts_.old_elements[std::string(name)] = {offset_, 0}).second;
    } else if (is_unread_element(name)) {
      facts_.note("unread-elements", offset_, std::string(name) + " elements aren't shown in this version; they are kept as they are");
      references_.read_unread(name, place_);
    } else if (!references_.read(card_, place_)) {
      references_.read_unread(name, place_);
    }
  }

  void read_scalar_points() {
    for (std::size_t f = 0; f < card_.size(); ++f) {
      const std::int64_t id = card_.integer_or_zero(f);
      if (id <= 0) continue;
      const bool range = begins_with(card_.text(f + 1), "THRU");
      facts_.scalar_points.push_back({id, range ? card_.integer_or_zero(f + 2) : id});
      if (range) f += 2;
    }
  }

 public:
  void count_fast_kinds() {
    if (quads_ > 0) out_.count_kind("CQUAD4", quads_);
    if (trias_ > 0) out_.count_kind("CTRIA3", trias_);
  }

 private:
  std::string_view text_;
  const Piece& piece_;
  PieceCards& out_;
  PieceFacts& facts_;
  ReferenceReader references_;
  CardLines lines_;
  Card card_;
  CardPlace place_;
  std::size_t offset_ = 0;  ///< of the card being read
  bool made_ = false;       ///< by replication, or the card that is replicated
  Replication replication_;
  std::size_t made_copies_ = 0;
  std::vector<std::int64_t> nodes_;

  std::size_t line_next_ = 0;  ///< after what was read fast
  std::uint32_t system_ = 0;
  bool nodes_begun_ = false;
  Layout node_layout_ = Layout::small;
  std::uint32_t node_system_ = 0;
  bool shells_begun_ = false;
  Layout shell_layout_ = Layout::small;
  std::size_t quads_ = 0, trias_ = 0;  ///< read fast
};

}  // namespace

void PieceFacts::note(std::string_view kind, std::size_t offset, std::string message) {
  const auto at = std::find_if(notices.begin(), notices.end(), [&](const Notice& n) { return n.kind == kind && n.message == message; });
  if (at != notices.end())
    ++at->count;
  else if (notices.size() < 1000)
    notices.push_back({std::string(kind), offset, std::move(message), 1});
}

PieceContent read_piece(std::string_view text, const Piece& piece) {
  PieceContent out;
  PieceReader reader(text, piece, out);
  reader.run();
  reader.count_fast_kinds();
  return out;
}

}  // namespace prismesh::mesh::deck::nastran
