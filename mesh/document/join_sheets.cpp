#include "mesh/document/join_sheets.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "mesh/deck/editing/tied_sets.h"

namespace prismesh::mesh::document {

namespace {

/// The parts in the set of sheets among the cards of a part that was made for welds, ascending.
std::vector<std::int64_t> sheets_in_cards(const std::string& cards) {
  std::istringstream lines(cards);
  std::vector<std::int64_t> parts;
  std::string line;
  while (std::getline(lines, line) && line != "*SET_PART_LIST") {
  }
  std::getline(lines, line);  // the set's number
  while (std::getline(lines, line) && !line.starts_with('*')) {
    std::istringstream fields(line);
    for (std::int64_t part = 0; fields >> part;) parts.push_back(part);
  }
  std::sort(parts.begin(), parts.end());
  return parts;
}

}  // namespace

std::string sheet_part_words(const Model& model, PartIndex part) {
  return part.valid() ? "part:" + std::to_string((*model.parts)[part.value].id) : "a shell of no part";
}

Result<NamedElement> parse_element(const std::string& text, const std::string& who, const std::string& wanted) {
  const std::size_t colon = text.find(':');
  const std::string word = text.substr(0, colon), digits = colon == std::string::npos ? "" : text.substr(colon + 1);
  const bool is_id = !digits.empty() && digits.size() <= 18 && digits.find_first_not_of("0123456789") == std::string::npos;
  for (int c = 1; is_id && c < kElementClassCount; ++c)
    if (const auto each = static_cast<ElementClass>(c); word == name(each) || (word == "spring" && each == ElementClass::discrete))
      return NamedElement{each, std::stoll(digits)};
  return fail("", who + ": \"like\" must name an element that is " + wanted + ", not \"" + text + "\"");
}

Result<std::uint32_t> index_of_element(const Document& document, const NamedElement& wanted, const std::string& who) {
  const Model& model = document.current().model;
  const std::string words = std::string(name(wanted.element_class)) + " " + std::to_string(wanted.id);
  const auto& block = model.elements[static_cast<std::size_t>(wanted.element_class)];
  if (block)
    if (const auto at = std::find(block->id.begin(), block->id.end(), wanted.id); at != block->id.end())
      return static_cast<std::uint32_t>(at - block->id.begin());
  for (const deck::HiddenElements::Card& card : document.deck->hidden.cards)
    if (card.element_class == wanted.element_class && card.id == wanted.id)
      return fail("", who + ": " + words + " can't be the example: a node of it isn't defined");
  return fail("", who + ": there is no " + words);
}

void PlacesTaken::add(const Vec3& at) {
  if (cell_ > 0) cells_[cell_of(at)].push_back(at);
}

bool PlacesTaken::near(const Vec3& at) const {
  if (!(cell_ > 0)) return false;
  const std::array<std::int64_t, 3> middle = cell_of(at);
  for (std::int64_t x = -1; x <= 1; ++x)
    for (std::int64_t y = -1; y <= 1; ++y)
      for (std::int64_t z = -1; z <= 1; ++z)
        if (const auto cell = cells_.find({middle[0] + x, middle[1] + y, middle[2] + z}); cell != cells_.end())
          for (const Vec3& other : cell->second)
            if ((other - at).norm() < cell_) return true;
  return false;
}

std::array<std::int64_t, 3> PlacesTaken::cell_of(const Vec3& at) const {
  std::array<std::int64_t, 3> cell{};
  for (std::size_t k = 0; k < 3; ++k)
    cell[k] = static_cast<std::int64_t>(std::floor(std::clamp(at[static_cast<Eigen::Index>(k)] / cell_, -1e15, 1e15)));
  return cell;
}

Result<void> refuse_locked(const Generation& generation, const std::vector<PartIndex>& parts, const std::string& what,
                           const std::string& who) {
  for (const PartIndex part : parts)
    if ((*generation.parts)[part.value].locked)
      return fail("", who + ": " + sheet_part_words(generation.model, part) + " is locked: " + what + " would be added to it");
  return {};
}

NodeOrigin corner_origin(const Model& model, const connections::SheetAtSpot& sheet) {
  const ShellNodes& nodes = model.shell(sheet.shell);
  NodeIndex nearest = nodes.node[0];
  for (const NodeIndex node : nodes.node)
    if ((model.position(node) - sheet.point).squaredNorm() < (model.position(nearest) - sheet.point).squaredNorm()) nearest = node;
  return {{nearest, NodeIndex(), NodeIndex(), NodeIndex()}, {1, 0, 0, 0}};
}

void note_untied(const Document& document, PartIndex part, const std::vector<PartIndex>& sheets, const std::string& what,
                 EditReport& report) {
  const Model& model = document.current().model;
  const std::vector<Part>& parts = *model.parts;
  const bool is_added = model.topology_change && part.value >= model.topology_change->deck_parts;
  const std::vector<std::int64_t> tied =
      is_added ? sheets_in_cards(model.topology_change->added_parts[part.value - model.topology_change->deck_parts].cards)
               : deck::parts_tied_with(*document.deck->references, parts[part.value].id);
  if (tied.empty()) return;
  for (const PartIndex sheet : sheets)
    if (!std::binary_search(tied.begin(), tied.end(), parts[sheet.value].id))
      report.notes.push_back(sheet_part_words(model, sheet) + " isn't among the parts to which a contact ties " +
                             sheet_part_words(model, part) + ": " + what + " there don't hold unless it is added");
}

}  // namespace prismesh::mesh::document
