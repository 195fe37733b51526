#include "mesh/deck/abaqus/mesh_cards.h"

#include <algorithm>

#include "mesh/deck/text/number.h"

namespace prismesh::mesh::deck::abaqus {
namespace {

constexpr std::size_t kFullLine = 16;    // fields of a line that goes on in the next without a comma at its end
constexpr std::size_t kMaxNodes = 5000;  // of an element without a known number of them

/// Reads digits alone; parse_integer reads everything else.
inline bool plain_integer(std::string_view field, std::int64_t& value) {
  if (field.empty() || field.size() > 18) return false;
  std::int64_t sum = 0;
  for (const char c : field) {
    if (static_cast<unsigned char>(c - '0') >= 10) return false;
    sum = sum * 10 + (c - '0');
  }
  value = sum;
  return true;
}

class PieceReader {
 public:
  PieceReader(const DeckOutline& outline, const Piece& piece, PieceCards& out)
      : outline_(outline), text_(outline.text(piece.file)), out_(out) {}

  bool read(const MeshSegment& segment) {
    DataLines lines(text_, segment.begin, segment.end);
    lines_ = &lines;
    if (segment.nodes) {
      out_.begin_nodes(0, segment.frame);
      return read_nodes();
    }
    type_ = &outline_.types[segment.type].type;
    part_ = static_cast<std::int64_t>(segment.group) + 1;
    if (type_->element_class == ElementClass::shell)
      out_.begin_shells(static_cast<std::uint16_t>(type_->corners | (type_->has_midside() ? kStyleMidside : 0)));
    std::size_t cards = 0;
    const bool good = read_elements(cards);
    count(*type_, out_.counts, cards);
    if (cards > 0) out_.count_kind(outline_.types[segment.type].name, cards);
    return good;
  }

 private:
  bool fail_at(std::size_t offset, std::string message) {
    out_.error = {offset, std::move(message)};
    return false;
  }

  /// The value of a field that may be the name of a parameter in angle brackets.
  bool real(std::string_view field, double& value, bool& by_parameter) const {
    if (field.size() < 2 || field.front() != '<' || field.back() != '>') return parse_real(field, value);
    by_parameter = true;
    const auto at = outline_.values.find(trim(field.substr(1, field.size() - 2)));
    if (at == outline_.values.end()) return false;
    value = at->second;
    return true;
  }

  bool read_nodes() {
    DataLine line;
    while (lines_->next(line)) {
      Fields fields(line.text);
      std::string_view field;
      fields.next(field);
      std::int64_t id = 0;
      if (!plain_integer(field, id) && !parse_integer(field, id)) {
        if (field.find('<') == std::string_view::npos) return fail_at(line.offset, "expected a node number but found " + quoted(field));
        out_.note("undefined-parameter", line.offset, 0);
        continue;
      }
      if (id <= 0) {
        if (line.text.find_first_not_of(", \t") == std::string_view::npos) continue;
        return fail_at(line.offset, "a node needs a number above 0, but this line has " + quoted(field));
      }
      if (!read_position(line, fields, id)) return false;
    }
    return true;
  }

  bool read_position(const DataLine& line, Fields& fields, std::int64_t id) {
    Vec3 position = Vec3::Zero();
    std::string_view field;
    bool by_parameter = false;
    for (int axis = 0; axis < 3 && fields.next(field); ++axis) {
      if (real(field, position[axis], by_parameter)) continue;
      if (by_parameter) {
        out_.note("undefined-parameter", line.offset, id);
        return true;
      }
      return fail_at(line.offset, std::string("expected the ") + "xyz"[axis] + " coordinate of node " + std::to_string(id) + " but found " +
                                      quoted(field));
    }
    if (by_parameter) out_.by_parameter.push_back(static_cast<std::uint32_t>(out_.node_id.size()));
    out_.node_id.push_back(id);
    out_.position.push_back(position);
    out_.node_offset.push_back(line.offset);
    return true;
  }

  bool read_elements(std::size_t& cards) {
    DataLine line;
    while (lines_->next(line)) {
      numbers_.clear();
      skip_ = nullptr;
      const std::size_t offset = line.offset;
      const std::size_t wanted = type_->nodes > 0 ? type_->nodes + 1u : kMaxNodes + 1;
      if (!read_line(line)) return false;
      // A card continues in the next line if its line ends with a comma or is full.
      while (numbers_.size() < wanted && (line.text.back() == ',' || (type_->nodes > 0 && numbers_.size() % kFullLine == 0)) &&
             lines_->next(line))
        if (!read_line(line)) return false;
      if (numbers_.empty() || (numbers_[0] == 0 && numbers_.size() == 1)) continue;
      ++cards;
      if (skip_)
        leave_out(skip_, offset);
      else if (numbers_[0] <= 0)
        return fail_at(offset, "an element needs a number above 0, but this line has " + quoted(line.text));
      else
        add_element(offset);
    }
    return true;
  }

  bool read_line(const DataLine& line) {
    Fields fields(line.text);
    for (std::string_view field; fields.next(field);) {
      std::int64_t value = 0;
      if (!plain_integer(field, value) && !parse_integer(field, value)) {
        if (field.find('<') != std::string_view::npos)
          skip_ = "undefined-parameter";
        else if (!numbers_.empty() && field.find('.') != std::string_view::npos)
          skip_ = "element-between-instances";
        else
          return fail_at(line.offset,
                         std::string("expected ") + (numbers_.empty() ? "an element" : "a node") + " number but found " + quoted(field));
      }
      if (numbers_.size() <= kMaxNodes) numbers_.push_back(value);
    }
    return true;
  }

  void leave_out(const char* why, std::size_t offset) {
    out_.note(why, offset, numbers_[0]);
    count(*type_, out_.left_out, 1);
    out_.hide(type_->element_class, offset, numbers_[0], std::span(numbers_).subspan(1));
  }

  void add_element(std::size_t offset) {
    const std::size_t nodes = std::min<std::size_t>(numbers_.size() - 1, type_->nodes > 0 ? type_->nodes : kMaxNodes);
    const auto node = [&](std::size_t n) { return numbers_[n + 1]; };
    if (type_->element_class == ElementClass::shell) {
      const std::size_t corners = type_->corners;
      bool whole = nodes >= type_->nodes;
      for (std::size_t n = 0; n < std::min(nodes, corners); ++n) whole &= node(n) > 0;
      if (!whole) return leave_out("incomplete-element", offset);
      RawShells& shells = out_.shells;
      if (type_->has_midside()) {
        std::array<std::int64_t, 4> midside{};
        for (std::size_t n = 0; n < corners; ++n) midside[n] = node(corners + n);
        shells.midside.emplace_back(static_cast<std::uint32_t>(shells.id.size()), midside);
      }
      shells.id.push_back(numbers_[0]);
      shells.part.push_back(part_);
      shells.nodes.push_back({node(0), node(1), node(2), node(corners - 1)});
      shells.offset.push_back(offset);
      return;
    }
    RawElements& elements = out_.elements[static_cast<std::size_t>(type_->element_class)];
    const std::size_t before = elements.nodes.size();
    for (std::size_t n = 0; n < nodes; ++n)
      if (node(n) > 0) elements.nodes.push_back(node(n));
    if (nodes < type_->nodes || elements.nodes.size() == before) {
      elements.nodes.resize(before);
      return leave_out("incomplete-element", offset);
    }
    elements.id.push_back(numbers_[0]);
    elements.part.push_back(part_);
    elements.first_node.push_back(static_cast<std::uint32_t>(elements.nodes.size()));
    elements.offset.push_back(offset);
  }

  const DeckOutline& outline_;
  std::string_view text_;
  PieceCards& out_;
  DataLines* lines_ = nullptr;
  const ElementType* type_ = nullptr;
  std::int64_t part_ = 0;
  std::vector<std::int64_t> numbers_;  ///< of the current card: its id, then its nodes
  const char* skip_ = nullptr;         ///< why the current card is left out
};

}  // namespace

PieceCards read_piece(const DeckOutline& outline, const Piece& piece) {
  PieceCards out;
  out.file = piece.file;
  out.held = piece.held;
  PieceReader reader(outline, piece, out);
  for (const MeshSegment& segment : piece.segments)
    if (!reader.read(segment)) break;
  return out;
}

}  // namespace prismesh::mesh::deck::abaqus
