#include "mesh/deck/radioss/mesh_cards.h"

#include <algorithm>
#include <string>

#include "mesh/deck/text/number.h"

namespace prismesh::mesh::deck::radioss {
namespace {

constexpr auto kBeam = ElementClass::beam;
constexpr auto kSolid = ElementClass::solid;

constexpr std::array<CardForm, 18> kForms = {{
    {"NODE", CardKind::node, ElementClass::other, {}, 0},
    {"CNODE", CardKind::node, ElementClass::other, {}, 0},
    {"SHELL", CardKind::shell, ElementClass::shell, {4}, 4},
    {"SH3N", CardKind::shell, ElementClass::shell, {3}, 3},
    {"BRICK", CardKind::element, kSolid, {8}, 8},
    {"TETRA4", CardKind::element, kSolid, {4}, 4},
    {"TETRA10", CardKind::element, kSolid, {0, 10}, 10, true},
    {"BRIC20", CardKind::element, kSolid, {8, 8, 4}, 20},
    {"PENTA6", CardKind::element, kSolid, {6}, 6},
    {"SHEL16", CardKind::element, ElementClass::tshell, {8, 4, 4}, 16},
    {"BEAM", CardKind::element, kBeam, {3}, 2},
    {"TRUSS", CardKind::element, kBeam, {2}, 2},
    {"SPRING", CardKind::element, ElementClass::discrete, {6}, 2},
    {"RIVET", CardKind::element, ElementClass::other, {2}, 2},
    {"QUAD", CardKind::element, ElementClass::other, {4}, 4},
    {"TRIA", CardKind::element, ElementClass::other, {3}, 3},
    {"SPHCEL", CardKind::element, ElementClass::sph, {0}, 0},
    {"XELEM", CardKind::element, ElementClass::other, {0}, 0},
}};

constexpr std::size_t kMaxIntegers = 11;

bool is_blank(std::string_view line) { return line.find_first_not_of(" \t") == std::string_view::npos; }

class PieceReader {
 public:
  PieceReader(std::string_view text, const MeshContext& context, PieceCards& out, std::vector<Direction>& directions)
      : text_(text), context_(context), out_(out), directions_(directions) {}

  bool read(const Segment& segment) {
    segment_ = &segment;
    width_ = segment.old ? kOldField : kField;
    added_ = context_.contexts[segment.context].added;
    lines_.emplace(text_, segment.begin, segment.end);
    const Style style{segment.old, segment.form->ends == 3 && segment.form->kind == CardKind::shell};
    if (segment.form->kind == CardKind::node) {
      out_.begin_nodes(style.number(), segment.frame);
      return read_nodes();
    }
    if (segment.form->kind == CardKind::shell) out_.begin_shells(style.number(), segment.frame, segment.form->ends == 3 ? 1 : 0);
    return read_elements();
  }

 private:
  bool fail_at(std::size_t offset, std::string message) {
    out_.error = {offset, std::move(message)};
    return false;
  }
  /// For a field that is no number: an unknown parameter leaves its card out; anything else is an error.
  bool refuse(std::size_t offset, std::string_view field, const std::string& what, std::int64_t id) {
    if (field.find('&') != std::string_view::npos) {
      out_.note("undefined-parameter", offset, id);
      return true;
    }
    return fail_at(offset, "expected " + what + " but found " + quoted(field));
  }

  /// Reads the next line that isn't blank. Each tab counts as one blank.
  bool next(std::string_view& line, std::size_t& offset) {
    while (lines_->next(line, offset)) {
      if (line.find('\t') != std::string_view::npos) {
        untabbed_ = line;
        std::replace(untabbed_.begin(), untabbed_.end(), '\t', ' ');
        line = untabbed_;
      }
      if (!is_blank(line)) return true;
    }
    return false;
  }

  bool read_nodes() {
    std::string_view line;
    std::size_t offset = 0;
    while (next(line, offset)) {
      std::int64_t id = 0;
      Vec3 position;
      if (line.size() > width_ && plain_integer(line.data(), line.data() + width_, id) && id > 0 &&
          parse_real(field(line, width_, 1, 2), position[0]) && parse_real(field(line, width_, 3, 2), position[1]) &&
          parse_real(field(line, width_, 5, 2), position[2]))
        add_node(id, position, offset);
      else if (!read_node_slowly(line, offset))
        return false;
    }
    return true;
  }

  void add_node(std::int64_t id, const Vec3& position, std::size_t offset) {
    out_.node_id.push_back(id + added_.node);
    out_.position.push_back(position);
    out_.node_offset.push_back(offset);
  }

  bool read_node_slowly(std::string_view line, std::size_t offset) {
    const std::string_view id_field = field(line, width_, 0);
    const std::optional<std::int64_t> id = integer(id_field);
    if (!id) return refuse(offset, id_field, "a node id", 0);
    if (*id == 0 && !trim(id_field).empty()) {
      // The starter takes it, but in every card that could name it 0 means that there is no node.
      out_.note("unnamed-node", offset, 0);
      return true;
    }
    if (*id <= 0) return fail_at(offset, "a node needs an id above 0, but this card has " + quoted(id_field));
    Vec3 position;
    bool by_parameter = false;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::string_view text = field(line, width_, 1 + 2 * axis, 2);
      const std::optional<double> value = context_.parameters->real(text, context_.contexts, segment_->context);
      if (!value) return refuse(offset, text, std::string("the ") + "xyz"[axis] + " coordinate of node " + std::to_string(*id), *id);
      position[static_cast<Eigen::Index>(axis)] = *value;
      by_parameter |= text.find('&') != std::string_view::npos;
    }
    if (by_parameter) out_.by_parameter.push_back(static_cast<std::uint32_t>(out_.node_id.size()));
    add_node(*id, position, offset);
    return true;
  }

  std::optional<std::int64_t> integer(std::string_view text) const {
    return context_.parameters->integer(text, context_.contexts, segment_->context);
  }

  /// Reads the first `count` fields of a line into fields_; missing ones are 0. `element`: the line begins with its id. False: stop, an
  /// error is noted.
  bool cut_integers(std::string_view line, std::size_t offset, bool element, std::size_t count, bool& usable) {
    std::fill_n(fields_.begin(), count, 0);
    for (std::size_t f = 0; f < count; ++f) {
      const std::string_view text = field(line, width_, f);
      std::int64_t& value = fields_[f];
      if (text.empty() || plain_integer(text.data(), text.data() + text.size(), value)) continue;
      const std::optional<std::int64_t> slow = integer(text);
      if (slow) {
        value = *slow;
        continue;
      }
      // The fields behind are read all the same: nodes of an element that is left out are needed.
      if (usable || text.find('&') == std::string_view::npos) {
        usable = false;
        if (!refuse(offset, text, element && f == 0 ? "an element id" : "an id", fields_[0])) return false;
      }
    }
    return true;
  }

  bool read_elements() {
    const CardForm& form = *segment_->form;
    std::string_view line;
    std::size_t offset = 0;
    std::size_t cards = 0;
    while (next(line, offset)) {
      ++cards;
      bool usable = true;
      if (!cut_integers(line, offset, true, 1 + form.nodes[0], usable)) return false;
      if (usable && fields_[0] <= 0) return fail_at(offset, "an element needs an id above 0");
      const bool read = form.kind == CardKind::shell ? read_shell(line, offset, usable) : read_element(offset, usable);
      if (!read) return false;
    }
    out_.count_kind(form.word, cards);
    return true;
  }

  bool read_shell(std::string_view line, std::size_t offset, bool usable) {
    const bool triangle = segment_->form->ends == 3;
    const std::int64_t n3 = fields_[3];
    const std::int64_t n4 = triangle || fields_[4] == 0 ? n3 : fields_[4];
    const bool complete = usable && fields_[1] > 0 && fields_[2] > 0 && n3 > 0 && n4 > 0;
    const bool is_triangle = triangle || (complete && n3 == n4);
    ++out_.counts.of_shell(is_triangle, false);
    if (!complete) {
      ++out_.left_out.of_shell(is_triangle, false);
      if (usable) out_.note("incomplete-element", offset, fields_[0]);
      hide(ElementClass::shell, offset, fields_[0], std::span(fields_).subspan(1, triangle ? 3 : 4));
      return true;
    }
    RawShells& shells = out_.shells;
    shells.id.push_back(fields_[0] + added_.element);
    shells.part.push_back(segment_->part);
    shells.nodes.push_back({fields_[1] + added_.node, fields_[2] + added_.node, n3 + added_.node, n4 + added_.node});
    shells.offset.push_back(offset);
    if (!shells.thickness.empty()) shells.thickness.push_back(0);
    if (line.size() > 8 * width_) return read_thickness(field(line, width_, 8, 2), offset);
    return true;
  }

  void hide(ElementClass element_class, std::size_t offset, std::int64_t id, std::span<std::int64_t> nodes) {
    for (std::int64_t& node : nodes)
      if (node > 0) node += added_.node;
    out_.hide(element_class, offset, id > 0 ? id + added_.element : 0, nodes);
  }

  bool read_thickness(std::string_view text, std::size_t offset) {
    const std::optional<double> thickness = context_.parameters->real(text, context_.contexts, segment_->context);
    if (!thickness && text.find('&') == std::string_view::npos)
      return fail_at(offset, "expected the thickness of shell " + std::to_string(fields_[0]) + " but found " + quoted(text));
    if (!thickness || !(*thickness > 0)) return true;
    out_.shells.thickness.resize(out_.shells.id.size(), 0.0f);
    out_.shells.thickness.back() = static_cast<float>(*thickness * segment_->thickness_unit);
    return true;
  }

  bool read_element(std::size_t offset, bool usable) {
    const CardForm& form = *segment_->form;
    const std::int64_t id = fields_[0];
    nodes_.assign(fields_.begin() + 1, fields_.begin() + 1 + form.nodes[0]);
    for (std::size_t l = 1; l < form.nodes.size() && form.nodes[l] > 0; ++l) {
      std::string_view line;
      std::size_t line_offset = 0;
      if (!next(line, line_offset)) break;
      if (!cut_integers(line, line_offset, false, form.nodes[l], usable)) return false;
      nodes_.insert(nodes_.end(), fields_.begin(), fields_.begin() + form.nodes[l]);
    }
    ++out_.counts.of(form.element_class);
    if (usable) {
      add_element(offset, id);
    } else {
      ++out_.left_out.of(form.element_class);
      hide(form.element_class, offset, id, nodes_);
    }
    return true;
  }

  void add_element(std::size_t offset, std::int64_t id) {
    const CardForm& form = *segment_->form;
    // Wedges and pyramids leave corners of the brick out; mid-side nodes may be missing.
    std::size_t ends = std::min<std::size_t>(form.ends, nodes_.size());
    if (form.element_class == ElementClass::solid && form.ends == 8)
      for (std::size_t i = 4; i < ends; ++i)
        if (nodes_[i] == 0) nodes_[i] = nodes_[i - 1];
    if (form.ends > 8) {
      nodes_.erase(std::remove(nodes_.begin() + static_cast<std::ptrdiff_t>(std::min<std::size_t>(form.ends == 10 ? 4 : 8, nodes_.size())),
                               nodes_.end(), 0),
                   nodes_.end());
      ends = nodes_.size();
    }
    // A spring's second end may be the ground.
    if (form.element_class == ElementClass::discrete && ends == 2 && nodes_[1] == 0) ends = 1;
    const auto end = nodes_.begin() + static_cast<std::ptrdiff_t>(ends);
    if (std::any_of(nodes_.begin(), end, [](std::int64_t n) { return n <= 0; }) || (form.ends > 0 && ends == 0)) {
      out_.note("incomplete-element", offset, id);
      ++out_.left_out.of(form.element_class);
      hide(form.element_class, offset, id, nodes_);
      return;
    }
    for (std::int64_t& node : nodes_)
      if (node > 0) node += added_.node;
    for (std::size_t i = ends; i < nodes_.size(); ++i)
      if (nodes_[i] > 0) directions_.push_back({nodes_[i], offset, segment_->form});
    RawElements& elements = out_.elements[static_cast<std::size_t>(form.element_class)];
    elements.id.push_back(id + (form.element_class == ElementClass::sph ? added_.node : added_.element));
    elements.part.push_back(segment_->part);
    if (form.element_class == ElementClass::sph)
      elements.nodes.push_back(id + added_.node);  // a particle is a node
    else
      elements.nodes.insert(elements.nodes.end(), nodes_.begin(), end);
    elements.first_node.push_back(static_cast<std::uint32_t>(elements.nodes.size()));
    elements.offset.push_back(offset);
    // All solids have one numbering.
    elements.numbering.push_back(form.element_class == kSolid ? 0 : numbering_of(form.word));
  }

  std::string_view text_;
  const MeshContext& context_;
  PieceCards& out_;
  std::vector<Direction>& directions_;
  const Segment* segment_ = nullptr;
  std::size_t width_ = kField;
  IdOffsets added_;
  std::optional<Lines> lines_;
  std::string untabbed_;
  std::array<std::int64_t, kMaxIntegers> fields_{};
  std::vector<std::int64_t> nodes_;
};

}  // namespace

const CardForm* card_form(std::string_view word) {
  for (const CardForm& form : kForms)
    if (!word.empty() && form.word == word) return &form;
  return nullptr;
}

PieceCards read_piece(std::string_view text, const Piece& piece, const MeshContext& context, std::vector<Direction>& directions) {
  PieceCards out;
  out.file = piece.file;
  out.held = piece.held;
  PieceReader reader(text, context, out, directions);
  for (const Segment& segment : piece.segments)
    if (!reader.read(segment)) break;
  return out;
}

}  // namespace prismesh::mesh::deck::radioss
