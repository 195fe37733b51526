#include "mesh/deck/lsdyna/mesh_cards.h"

#include <algorithm>
#include <cstring>

#include "mesh/deck/lsdyna/card.h"
#include "mesh/deck/text/number.h"

namespace prismesh::mesh::deck::lsdyna {
namespace {

constexpr std::array<int, 4> kNodeWidths = {8, 16, 16, 16};
constexpr std::array<int, 10> kElementWidths = {8, 8, 8, 8, 8, 8, 8, 8, 8, 8};
constexpr std::array<int, 5> kThicknessWidths = {16, 16, 16, 16, 16};
constexpr std::array<int, 4> kMassWidths = {8, 8, 16, 8};
constexpr std::size_t kMaxElementFields = 10;
constexpr std::size_t kMinUsualLineLength = 40;

class PieceReader {
 public:
  PieceReader(std::string_view text, const std::vector<Parameters>& tables, PieceCards& out) : text_(text), tables_(tables), out_(out) {}

  bool read(const Segment& segment) {
    segment_ = &segment;
    parameters_ = &tables_[segment.parameters];
    Lines lines(text_, segment.begin, segment.end);
    lines_ = &lines;
    make_room(segment);
    if (segment.form.kind == CardKind::node) return read_nodes();
    if (segment.form.kind == CardKind::shell) out_.begin_shells(shell_style(segment.form, segment.columns), segment.frame);
    return read_elements();
  }

 private:
  /// Reserves memory, assuming that cards of a block are as long as its first: growing in steps would touch twice the memory.
  void make_room(const Segment& segment) {
    const std::string_view text = text_.substr(segment.begin, segment.end - segment.begin);
    const std::size_t line = std::max(std::min(text.find('\n'), text.size()) + 1, kMinUsualLineLength);
    const std::size_t count = text.size() / line + 1;
    const auto reserve = [&](auto& values) {
      if (values.size() + count > values.capacity()) values.reserve(std::max(values.size() + count, 2 * values.capacity()));
    };
    RawShells& shells = out_.shells;
    if (segment.form.kind == CardKind::node) reserve(out_.node_id), reserve(out_.position), reserve(out_.node_offset);
    if (segment.form.kind == CardKind::shell) reserve(shells.id), reserve(shells.part), reserve(shells.nodes), reserve(shells.offset);
  }

  bool fail_at(std::size_t offset, std::string message) {
    out_.error = {offset, std::move(message)};
    return false;
  }
  /// For a field that is no number: an unknown parameter leaves its card out; anything else is an error.
  bool refuse(const Line& line, std::string_view field, std::string_view what, std::int64_t id) {
    if (line.text.substr(0, kEncryptedBegin.size()) == kEncryptedBegin) {
      out_.encrypted = true;
      return false;
    }
    if (field.find_first_of("&<") != std::string_view::npos) {
      out_.note("undefined-parameter", line.offset, id);
      return true;
    }
    return fail_at(line.offset, "expected " + std::string(what) + " but found " + quoted(field));
  }

  bool read_nodes() {
    out_.begin_nodes(static_cast<std::uint16_t>(segment_->columns), segment_->frame);
    const auto id_width = static_cast<std::size_t>(field_width(8, segment_->columns));
    const auto width = static_cast<std::size_t>(field_width(16, segment_->columns));
    Line line;
    while (lines_->next(line)) {
      const std::string_view text = line.text;
      std::int64_t id = 0;
      Vec3 position;
      const char* begin = text.data();
      // A comma anywhere makes the card free format; inside the fields it fails to parse as columns anyway.
      const bool fixed = text.size() > id_width && text.find(',', std::min(id_width + 3 * width, text.size())) == std::string_view::npos &&
                         plain_integer(begin, begin + id_width, id) && id > 0 && parse_real(text.substr(id_width, width), position[0]) &&
                         parse_real(text.substr(std::min(id_width + width, text.size()), width), position[1]) &&
                         parse_real(text.substr(std::min(id_width + 2 * width, text.size()), width), position[2]);
      if (fixed)
        add_node(id, position, line.offset);
      else if (!read_node_slowly(line))
        return false;
    }
    return true;
  }

  void add_node(std::int64_t id, const Vec3& position, std::size_t offset) {
    out_.node_id.push_back(id);
    out_.position.push_back(position);
    out_.node_offset.push_back(offset);
  }

  bool read_node_slowly(const Line& line) {
    card_.cut(line.text, kNodeWidths, segment_->columns);
    const std::optional<std::int64_t> id = card_.integer(0, *parameters_);
    if (!id) return refuse(line, card_.text(0), "a node id", 0);
    if (*id <= 0 && trim(line.text).find_first_not_of(", \t") == std::string_view::npos) return true;
    if (*id <= 0) return fail_at(line.offset, "a node needs an id above 0, but this card has " + quoted(card_.text(0)));
    Vec3 position;
    bool by_parameter = false;
    for (int axis = 0; axis < 3; ++axis) {
      const std::string_view field = card_.text(static_cast<std::size_t>(axis) + 1);
      const std::optional<double> value = parameters_->real(field);
      if (!value) return refuse(line, field, std::string("the ") + "xyz"[axis] + " coordinate of node " + std::to_string(*id), *id);
      position[axis] = *value;
      by_parameter |= field.find_first_of("&<") != std::string_view::npos;
    }
    if (by_parameter) out_.by_parameter.push_back(static_cast<std::uint32_t>(out_.node_id.size()));
    add_node(*id, position, line.offset);
    return true;
  }

  /// Reads the integers of an element's card into fields_; missing ones are 0. False: stop (an error is noted) or leave the card out (none
  /// is noted).
  bool cut_integers(const Line& line, std::size_t wanted, bool& usable) {
    const auto width = static_cast<std::size_t>(field_width(8, segment_->columns));
    const char* at = line.text.data();
    const char* end = at + line.text.size();
    fields_.fill(0);
    usable = true;
    std::size_t f = 0;
    for (; f < wanted && at < end; ++f) {
      const char* next = at + std::min(width, static_cast<std::size_t>(end - at));
      if (!plain_integer(at, next, fields_[f])) break;
      at = next;
    }
    if (f == wanted || at >= end) return true;
    card_.cut(line.text, kElementWidths, segment_->columns);
    fields_.fill(0);
    for (f = 0; f < std::min(wanted, card_.count()); ++f) {
      const std::optional<std::int64_t> value = card_.integer(f, *parameters_);
      // After an unknown parameter the fields behind are read all the same: nodes of an element that is left out are needed.
      if (!value && usable && !refuse(line, card_.text(f), f == 0 ? "an element id" : "an id", fields_[0])) return false;
      usable &= value.has_value();
      fields_[f] = value.value_or(0);
    }
    return true;
  }

  bool read_elements() {
    Line line;
    while (pending_ ? (line = *pending_, pending_.reset(), true) : lines_->next(line)) {
      if (line.text.empty() || trim(line.text).empty()) continue;
      bool read = true;
      switch (segment_->form.kind) {
        case CardKind::shell: read = read_shell(line); break;
        case CardKind::solid: read = read_solid(line); break;
        case CardKind::mass:
        case CardKind::mass_of_set:
        case CardKind::mass_of_part:
        case CardKind::sph: read = read_point(line); break;
        default: read = read_plain(line); break;
      }
      if (!read) return false;
      Line skipped;
      for (int i = 0; i < segment_->form.extra_lines; ++i)
        if (!lines_->next(skipped)) break;
      if (segment_->form.composite && !read_layers()) return false;
    }
    return true;
  }

  bool element_id_is_bad(const Line& line) {
    if (fields_[0] > 0) return false;
    fail_at(line.offset, "an element needs an id above 0");
    return true;
  }

  bool read_shell(const Line& line) {
    bool usable = true;
    if (!cut_integers(line, kMaxElementFields, usable)) return false;
    if (usable && element_id_is_bad(line)) return false;
    const std::array<std::int64_t, 4> midside = {fields_[6], fields_[7], fields_[8], fields_[9]};
    const bool has_midside = std::any_of(midside.begin(), midside.end(), [](std::int64_t n) { return n > 0; });
    shell_is_kept_ = usable && add_shell(line, midside, has_midside);
    if (!shell_is_kept_) out_.hide(ElementClass::shell, line.offset, fields_[0], std::span(fields_).subspan(2, 8));
    if (!segment_->form.thickness) return true;
    Line card;
    if (lines_->next(card)) read_thickness(card);
    if (has_midside) lines_->next(card);  // the thicknesses at the mid-side nodes
    return true;
  }

  bool add_shell(const Line& line, const std::array<std::int64_t, 4>& midside, bool has_midside) {
    const std::int64_t n3 = fields_[4];
    const std::int64_t n4 = fields_[5] == 0 ? n3 : fields_[5];
    const bool complete = fields_[2] > 0 && fields_[3] > 0 && n3 > 0 && n4 > 0;
    const bool is_triangle = complete && n3 == n4;
    ++out_.counts.of_shell(is_triangle, has_midside);
    if (!complete) {
      ++out_.left_out.of_shell(is_triangle, has_midside);
      out_.note("incomplete-element", line.offset, fields_[0]);
      return false;
    }
    RawShells& shells = out_.shells;
    if (has_midside) shells.midside.push_back({static_cast<std::uint32_t>(shells.id.size()), midside});
    shells.id.push_back(fields_[0]);
    shells.part.push_back(fields_[1]);
    shells.nodes.push_back({fields_[2], fields_[3], n3, n4});
    shells.offset.push_back(line.offset);
    if (!shells.thickness.empty()) shells.thickness.push_back(0);
    return true;
  }

  /// The mean of the corners that have one.
  void read_thickness(const Line& line) {
    card_.cut(line.text, kThicknessWidths, segment_->columns);
    double sum = 0;
    int given = 0;
    for (std::size_t corner = 0; corner < 4; ++corner) {
      const double value = card_.real(corner, *parameters_).value_or(0);
      if (value > 0) sum += value, ++given;
    }
    if (given > 0) set_thickness(sum / given);
  }

  void set_thickness(double thickness) {
    RawShells& shells = out_.shells;
    if (!shell_is_kept_ || shells.id.empty()) return;
    shells.thickness.resize(shells.id.size(), 0.0f);
    shells.thickness.back() = static_cast<float>(thickness);
  }

  bool looks_like_element(std::string_view line) { return lsdyna::looks_like_element(line, segment_->columns); }

  bool read_layers() {
    double thickness = 0;
    Line line;
    while (lines_->next(line)) {
      if (looks_like_element(line.text)) {
        pending_ = line;
        break;
      }
      card_.cut(line.text, segment_->columns);
      thickness += card_.real(1, *parameters_).value_or(0);
      if (!segment_->form.composite_long) thickness += card_.real(5, *parameters_).value_or(0);
    }
    if (segment_->form.kind == CardKind::shell && thickness > 0) set_thickness(thickness);
    return true;
  }

  void add_element(ElementClass element_class, const Line& line, std::int64_t id, std::int64_t part, std::span<const std::int64_t> nodes) {
    RawElements& elements = out_.elements[static_cast<std::size_t>(element_class)];
    elements.id.push_back(id);
    elements.part.push_back(part);
    elements.nodes.insert(elements.nodes.end(), nodes.begin(), nodes.end());
    elements.first_node.push_back(static_cast<std::uint32_t>(elements.nodes.size()));
    elements.offset.push_back(line.offset);
    // Masses and other elements are numbered by keyword; of the other classes each has one numbering, whatever the keyword's options.
    const bool by_keyword = element_class == ElementClass::mass || element_class == ElementClass::other;
    elements.numbering.push_back(by_keyword ? numbering_of(segment_->word) : 0);
  }

  bool read_plain(const Line& line) {
    const CardKind kind = segment_->form.kind;
    const bool plotel = kind == CardKind::other && segment_->form.node_fields == 0;
    const std::size_t first = plotel ? 1 : 2;
    const std::size_t nodes = plotel ? 2 : static_cast<std::size_t>(segment_->form.node_fields);
    bool usable = true;
    if (!cut_integers(line, first + nodes, usable)) return false;
    if (usable && element_id_is_bad(line)) return false;
    const ElementClass element_class = kind == CardKind::beam       ? ElementClass::beam
                                       : kind == CardKind::tshell   ? ElementClass::tshell
                                       : kind == CardKind::discrete ? ElementClass::discrete
                                                                    : ElementClass::other;
    std::vector<std::int64_t>& list = nodes_;
    list.assign(fields_.begin() + static_cast<std::ptrdiff_t>(first), fields_.begin() + static_cast<std::ptrdiff_t>(first + nodes));
    if (!usable) {
      out_.hide(element_class, line.offset, fields_[0], list);
      return true;
    }
    ++out_.counts.of(element_class);
    // A spring's second end may be the ground.
    if (element_class == ElementClass::discrete) std::erase(list, 0);
    if (std::any_of(list.begin(), list.end(), [](std::int64_t n) { return n <= 0; }) || list.empty()) {
      out_.note("incomplete-element", line.offset, fields_[0]);
      ++out_.left_out.of(element_class);
      out_.hide(element_class, line.offset, fields_[0], list);
      return true;
    }
    add_element(element_class, line, fields_[0], plotel ? 0 : fields_[1], list);
    return true;
  }

  /// Ids and nodes on one card, or ids on the first and nodes on those that follow.
  bool read_solid(const Line& line) {
    bool usable = true;
    if (!cut_integers(line, kMaxElementFields, usable)) return false;
    if (usable && element_id_is_bad(line)) return false;
    const std::int64_t id = fields_[0];
    const std::int64_t part = fields_[1];
    nodes_.assign(fields_.begin() + 2, fields_.end());
    const bool ids_only = std::all_of(nodes_.begin(), nodes_.end(), [](std::int64_t n) { return n == 0; });
    const int node_lines = segment_->form.node_lines > 0 ? segment_->form.node_lines : ids_only ? 1 : 0;
    if (node_lines > 0) nodes_.clear();
    Line card;
    for (int i = 0; i < node_lines && lines_->next(card); ++i) {
      bool card_usable = true;
      if (!cut_integers(card, kMaxElementFields, card_usable)) return false;
      usable &= card_usable;
      nodes_.insert(nodes_.end(), fields_.begin(), fields_.end());
    }
    ++out_.counts.solid;
    if (usable) {
      add_solid(line, id, part);
    } else {
      ++out_.left_out.solid;
      out_.hide(ElementClass::solid, line.offset, id, nodes_);
    }
    return true;
  }

  /// Removes trailing zeros. A blank corner repeats the last one (the short forms of tetrahedra and wedges).
  void add_solid(const Line& line, std::int64_t id, std::int64_t part) {
    if (nodes_.size() > 8 && std::all_of(nodes_.begin() + 8, nodes_.end(), [](std::int64_t n) { return n == 0; })) nodes_.resize(8);
    while (nodes_.size() > 10 && nodes_.back() == 0) nodes_.pop_back();
    for (std::size_t i = 4; i < std::min<std::size_t>(nodes_.size(), 8); ++i)
      if (nodes_[i] == 0) nodes_[i] = nodes_[i - 1];
    if (nodes_.size() < 4 || std::any_of(nodes_.begin(), nodes_.end(), [](std::int64_t n) { return n <= 0; })) {
      out_.note("incomplete-element", line.offset, id);
      ++out_.left_out.solid;
      out_.hide(ElementClass::solid, line.offset, id, nodes_);
      return;
    }
    add_element(ElementClass::solid, line, id, part, nodes_);
  }

  /// Masses and particles: one node, or a set or part.
  bool read_point(const Line& line) {
    const CardKind kind = segment_->form.kind;
    card_.cut(line.text, kMassWidths, segment_->columns);
    const std::optional<std::int64_t> id = card_.integer(0, *parameters_);
    const std::optional<std::int64_t> second = kind == CardKind::mass_of_part ? 0 : card_.integer(1, *parameters_);
    if (!id) return refuse(line, card_.text(0), "an element id", 0);
    if (!second) return refuse(line, card_.text(1), "an id", *id);
    ++out_.counts.other;
    if (kind == CardKind::sph) {
      add_element(ElementClass::sph, line, *id, *second, std::array{*id});
    } else if (kind == CardKind::mass) {
      const std::int64_t part = card_.integer(3, *parameters_).value_or(0);
      add_element(ElementClass::mass, line, *id, part, std::array{*second});
    } else {
      add_element(ElementClass::mass, line, *id, 0, {});
    }
    return true;
  }

  std::string_view text_;
  const std::vector<Parameters>& tables_;
  PieceCards& out_;
  const Segment* segment_ = nullptr;
  const Parameters* parameters_ = nullptr;
  Lines* lines_ = nullptr;
  std::optional<Line> pending_;
  bool shell_is_kept_ = false;
  Card card_;
  std::array<std::int64_t, kMaxElementFields> fields_{};
  std::vector<std::int64_t> nodes_;
};

}  // namespace

namespace {

void shift(std::span<std::int64_t> ids, std::int64_t by) {
  for (std::int64_t& id : ids)
    if (id > 0) id += by;
}

/// Converts ids to those of the model and lengths to its unit. The sums can't overflow: parse_integer and read_transform limit both parts.
void transform(PieceCards& cards, const IncludeContext& context) {
  const IdOffsets& by = context.offsets;
  shift(cards.node_id, by.node);
  RawShells& shells = cards.shells;
  for (RawHiddenElement& element : cards.hidden) {
    if (element.id > 0) element.id += by.element;
    shift(element.nodes, by.node);
  }
  shift(shells.id, by.element);
  shift(shells.part, by.part);
  for (auto& nodes : shells.nodes) shift(nodes, by.node);
  for (auto& [shell, nodes] : shells.midside) shift(nodes, by.node);
  for (float& thickness : shells.thickness) thickness = static_cast<float>(thickness * context.length);
  for (std::size_t c = 0; c < cards.elements.size(); ++c) {
    RawElements& elements = cards.elements[c];
    // A particle's id is that of its node.
    shift(elements.id, c == static_cast<std::size_t>(ElementClass::sph) ? by.node : by.element);
    shift(elements.part, by.part);
    shift(elements.nodes, by.node);
  }
}

/// Finds ids that a negative offset has made 0 or less.
void refuse_ids_below_one(PieceCards& cards) {
  if (cards.error) return;
  const auto look = [&](const std::vector<std::int64_t>& ids, const std::vector<std::uint64_t>& offsets, const char* what) {
    for (std::size_t i = 0; i < ids.size() && !cards.error; ++i)
      if (ids[i] <= 0)
        cards.error = {offsets[i], std::string("the include's offset makes the id of this ") + what + " " + std::to_string(ids[i])};
  };
  look(cards.node_id, cards.node_offset, "node");
  look(cards.shells.id, cards.shells.offset, "element");
  for (const RawElements& elements : cards.elements) look(elements.id, elements.offset, "element");
}

}  // namespace

bool looks_like_element(std::string_view line, Columns columns) {
  if (line.find_first_not_of("0123456789 ,\t") != std::string_view::npos) return false;
  Card card;
  card.cut(line, kElementWidths, columns);
  for (std::size_t f = 0; f < 5; ++f) {
    std::int64_t value = 0;
    if (!parse_integer(card.text(f), value) || value <= 0) return false;
  }
  return true;
}

PieceCards read_piece(std::string_view text, const Piece& piece, const std::vector<Parameters>& parameters,
                      const std::vector<IncludeContext>& contexts) {
  PieceCards out;
  out.file = piece.file;
  out.held = piece.held;
  PieceReader reader(text, parameters, out);
  for (const Segment& segment : piece.segments) {
    const std::size_t before = out.counts.all();
    const bool read = reader.read(segment);
    if (const std::size_t count = out.counts.all() - before; count > 0) out.count_kind(segment.word, count);
    if (!read) break;
  }
  if (piece.segments.empty() || piece.segments.front().frame == 0) return out;
  transform(out, contexts[piece.segments.front().frame]);
  refuse_ids_below_one(out);
  return out;
}

}  // namespace prismesh::mesh::deck::lsdyna
