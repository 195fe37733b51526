#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/counted.h"
#include "base/readable_number.h"
#include "mesh/connections/sheet_reach.h"
#include "mesh/connections/weld_spots.h"
#include "mesh/deck/editing/element_place.h"
#include "mesh/deck/editing/new_ids.h"
#include "mesh/deck/editing/parts_at_nodes.h"
#include "mesh/deck/editing/text_changes.h"
#include "mesh/deck/editing/tied_sets.h"
#include "mesh/deck/formats/formats.h"
#include "mesh/document/apply.h"
#include "mesh/document/deck_relations.h"
#include "mesh/document/grow_parts.h"
#include "mesh/document/grow_relations.h"
#include "mesh/document/join_sheets.h"
#include "mesh/document/part_marks.h"
#include "mesh/document/restructure.h"
#include "mesh/document/weld_places.h"
#include "mesh/model/topology_change.h"
#include "mesh/spatial/box_tree.h"

namespace prismesh::mesh::document {

namespace {

using connections::SheetAtSpot;
using connections::SpotStack;

constexpr std::size_t kMaxSpotsTold = 1000;

std::string short_words(double length) { return readable(length, 3); }

// --- what new welds are like ---

/// What the new elements get from an existing one, or from the part that is made for them.
struct WeldKind {
  ElementClass element_class = ElementClass::beam;
  PartIndex part;
  std::uint32_t example = kNoExample;  ///< as TopologyChange::element_examples
  /// The ends of the existing element, whose cards those of new nodes follow; nothing: those of the sheets.
  std::optional<std::array<NodeIndex, 2>> ends;
  std::array<PartIndex, 2> sheets;  ///< of its ends: the parts on which they lie; invalid: none
  bool joins_sets = false;          ///< new nodes join the sets of the ends
  bool tied_by_end = false;         ///< ties name its ends in sets of their own
};

/// The deck's node whose sets an end's are.
NodeIndex first_of_deck(const Model& model, NodeIndex node) {
  while (is_added(model, node)) node = origin_of(model, node).parent[0];
  return node;
}

/// Finds the sheets of the ends, and whether ties name one of the ends and not the other.
void note_ends(const Document& document, WeldKind& kind) {
  const Generation& now = document.current();
  const std::vector<NodeOnSheet>& on_sheets = now.relations->dependents.on_sheets;
  std::array<std::vector<std::uint32_t>, 2> ties;
  for (std::size_t e = 0; e < 2; ++e) {
    const NodeIndex end = (*kind.ends)[e];
    const auto at =
        std::lower_bound(on_sheets.begin(), on_sheets.end(), end, [](const NodeOnSheet& each, NodeIndex n) { return each.node < n; });
    if (at != on_sheets.end() && at->node == end) kind.sheets[e] = now.model.shell_parts[at->shell.value];
    if (kind.joins_sets) ties[e] = deck::tied_sets_of(*document.deck->references, now.model.node_ids[first_of_deck(now.model, end).value]);
  }
  kind.tied_by_end = ties[0] != ties[1];
}

Result<WeldKind> like_existing(const Document& document, const std::string& like) {
  const Model& model = document.current().model;
  const Result<NamedElement> named = parse_element(like, "weld", "a weld, as \"beam:9\"");
  if (!named) return fail(named.error());
  const Result<std::uint32_t> element = index_of_element(document, *named, "weld");
  if (!element) return fail(element.error());
  const auto c = static_cast<std::size_t>(named->element_class);
  const ElementBlock& block = *model.elements[c];
  const std::span<const NodeIndex> nodes =
      std::span(block.nodes).subspan(block.first_node[*element], block.first_node[*element + 1] - block.first_node[*element]);
  const std::string words = std::string(name(named->element_class)) + " " + std::to_string(named->id);
  const bool names_sheets = deck::card_writer(document.deck->format)->names_sheets();
  if ((named->element_class != ElementClass::beam && named->element_class != ElementClass::discrete) ||
      (nodes.size() != 2 && !names_sheets))
    return fail("", "weld: " + words + " can't be the example: this version makes welds of beams and springs with two nodes");
  if (!block.part[*element].valid()) return fail("", "weld: " + words + " can't be the example: it has no part");
  WeldKind kind;
  kind.element_class = named->element_class;
  kind.part = block.part[*element];
  kind.example = *element;
  const bool is_added = model.topology_change && *element >= model.topology_change->deck_elements[c];
  if (names_sheets) {  // the new nodes' cards follow those of the sheets, which tell what they lie on
    if (is_added) kind.example = model.topology_change->element_examples[c][*element - model.topology_change->deck_elements[c]];
    return kind;
  }
  kind.ends = {nodes[0], nodes[1]};
  kind.joins_sets = true;
  if (is_added) {
    kind.example = model.topology_change->element_examples[c][*element - model.topology_change->deck_elements[c]];
    const PlacedNode* placed = placed_node(model, nodes[0]);
    kind.joins_sets = placed != nullptr && placed->joins != kJoinsNone;
  }
  note_ends(document, kind);
  return kind;
}

/// Errors: the card of the existing element can't be found, or no other can be like it.
Result<void> can_be_example(const Document& document, const WeldKind& kind) {
  if (kind.example == kNoExample) return {};
  const std::unique_ptr<const deck::CardWriter> writer = deck::card_writer(document.deck->format);
  const Result<deck::ElementPlace> place =
      deck::place_of_element(*document.deck, document.opened->model, *writer, kind.element_class, kind.example);
  if (!place) return fail(place.error());
  deck::ElementCard card;
  card.element_class = kind.element_class;
  card.id = card.part = 1;
  card.nodes = card.sheets = {1, 2};
  const Result<deck::WrittenCard> written = writer->element_like(document.deck->files[place->file].bytes.text(), *place, card);
  return written ? Result<void>() : fail(written.error());
}

/// The beams and springs whose nodes lie on sheets: the nearest of each part, as "beam:9"; ascending by their distance from the place.
std::vector<std::string> nearest_welds(const Generation& generation, const Vec3& place) {
  const Model& model = generation.model;
  const std::vector<NodeOnSheet>& on_sheets = generation.relations->dependents.on_sheets;
  const auto lies = [&](NodeIndex node) {
    const auto at =
        std::lower_bound(on_sheets.begin(), on_sheets.end(), node, [](const NodeOnSheet& each, NodeIndex n) { return each.node < n; });
    return at != on_sheets.end() && at->node == node && !at->tied;
  };
  std::map<PartIndex, std::pair<double, std::string>> nearest;
  for (const NodeOnSheet& each : on_sheets) {
    if (each.tied) continue;
    for (const ElementUse& use : uses_at(*generation.relations, each.node)) {
      const auto& block = model.elements[static_cast<std::size_t>(use.element_class)];
      const bool is_line = use.element_class == ElementClass::beam || use.element_class == ElementClass::discrete;
      if (!is_line || block->first_node[use.element + 1] - block->first_node[use.element] != 2 || !block->part[use.element].valid())
        continue;
      const std::uint32_t first = block->first_node[use.element];
      if (!lies(block->nodes[first]) || !lies(block->nodes[first + 1])) continue;
      const double distance = (0.5 * (model.position(block->nodes[first]) + model.position(block->nodes[first + 1])) - place).norm();
      const auto [of_part, is_first] = nearest.try_emplace(block->part[use.element], distance, std::string());
      if (!is_first && !(distance < of_part->second.first)) continue;
      of_part->second = {distance, std::string(name(use.element_class)) + ":" + std::to_string(block->id[use.element])};
    }
  }
  std::vector<std::pair<double, std::string>> ordered;
  for (auto& [part, weld] : nearest) ordered.push_back(std::move(weld));
  std::sort(ordered.begin(), ordered.end());
  std::vector<std::string> welds;
  for (auto& [distance, weld] : ordered) welds.push_back(std::move(weld));
  return welds;
}

/// The nearest that can be the example. Errors: the deck has none; none can be.
Result<WeldKind> like_nearest(const Document& document, const Vec3& place, EditReport& report) {
  constexpr std::size_t kMaxTried = 20;
  std::string first;
  std::size_t tried = 0;
  for (const std::string& each : nearest_welds(document.current(), place)) {
    if (tried++ == kMaxTried) break;
    Result<WeldKind> like = like_existing(document, each);
    if (like)
      if (const Result<void> can = can_be_example(document, *like); !can) like = fail(can.error());
    if (like) {
      report.notes.push_back("like " + each + (first.empty() ? "" : ", the nearest of a part that can be the example"));
      return like;
    }
    if (first.empty()) first = like.error().message;
  }
  if (!first.empty()) return fail("", "weld: \"like\": \"nearest\": no weld of the deck can be the example; the nearest: " + first);
  return fail("",
              "weld: \"like\": \"nearest\": the deck has no beam or spring that joins sheets; \"diameter\" makes welds without an example");
}

/// Of the sheets' parts, the least stiff of a value: a weld isn't better than what it joins.
std::optional<double> least_of(const Model& model, const std::vector<PartIndex>& parts, std::optional<double> Part::*value) {
  std::optional<double> least;
  for (const PartIndex part : parts)
    if (const std::optional<double>& of_part = (*model.parts)[part.value].*value; of_part && (!least || *of_part < *least)) least = of_part;
  return least;
}

/// Errors: the diameter exceeds a sheet.
Result<void> check_diameter(const Document& document, double diameter, const std::vector<PartIndex>& parts, const Model& model) {
  std::vector<Eigen::AlignedBox3d> boxes(parts.size());
  for (std::size_t s = 0; s < model.shell_count(); ++s) {
    const auto part = std::lower_bound(parts.begin(), parts.end(), model.shell_parts[s]);
    if (part == parts.end() || *part != model.shell_parts[s] || !model.shell_nodes[s].node[0].valid()) continue;
    for (const NodeIndex node : model.shell_nodes[s].node)
      boxes[static_cast<std::size_t>(part - parts.begin())].extend(model.position(node));
  }
  for (std::size_t p = 0; p < parts.size(); ++p) {
    if (boxes[p].isEmpty()) continue;
    const double size = boxes[p].diagonal().norm();
    const std::string unit(name(document.settings.length_unit));
    if (diameter > size)
      return fail("", "weld: the diameter of " + readable(diameter, 4) + " " + unit + " is larger than the sheet " +
                          sheet_part_words(model, parts[p]) + ", which is " + readable(size, 4) + " " + unit + " long");
  }
  return {};
}

/// Makes a part for the welds, as the format has it. `parts`: of the sheets, ascending.
Result<WeldKind> make_part(const Document& document, const Weld& edit, const std::vector<PartIndex>& parts, Generation& next) {
  if (!edit.diameter)
    return fail("", "weld: \"like\" or \"diameter\" is missing: an existing weld to copy (\"beam:9\"), or the diameter of a new section");
  Model& model = next.model;
  if (Result<void> fits = check_diameter(document, *edit.diameter, parts, model); !fits) return fail(fits.error());
  deck::CardWriter::WeldPart wanted;
  wanted.diameter = *edit.diameter;
  for (const PartIndex part : parts) wanted.sheets.push_back((*model.parts)[part.value].id);
  const auto chosen = [&](const std::optional<double>& given, std::optional<double> Part::*value) {
    return given ? given : least_of(model, parts, value);
  };
  wanted.density = chosen(edit.density, &Part::density);
  wanted.youngs_modulus = chosen(edit.youngs_modulus, &Part::youngs_modulus);
  wanted.poissons_ratio = chosen(edit.poissons_ratio, &Part::poissons_ratio);
  wanted.yield_stress = edit.yield_stress;
  Result<std::pair<Part, std::string>> made = deck::card_writer(document.deck->format)->weld_part(*document.deck, model, wanted);
  if (!made) return fail("", "weld: " + made.error().text());
  WeldKind kind;
  kind.element_class = deck::card_writer(document.deck->format)->weld_class();
  kind.part = add_part(model, std::move(made->first), {std::move(made->second)});
  grow_parts(model.parts->size(), next);
  return kind;
}

// --- where ---

/// Where welds are already: the nodes and middles of beams, springs and placed nodes.
PlacesTaken welds_there(const Generation& generation, double cell) {
  PlacesTaken taken(cell);
  const Model& model = generation.model;
  for (const NodeOnSheet& each : generation.relations->dependents.on_sheets)
    if (!each.tied) taken.add(model.position(each.node));
  for (const ElementClass kind : {ElementClass::beam, ElementClass::discrete}) {
    const auto& block = model.elements[static_cast<std::size_t>(kind)];
    for (std::size_t e = 0; block && e < block->size(); ++e) {
      if (block->first_node[e + 1] - block->first_node[e] != 2) continue;
      const Vec3 &a = model.position(block->nodes[block->first_node[e]]), &b = model.position(block->nodes[block->first_node[e] + 1]);
      if ((a - b).norm() < 2 * cell) taken.add((a + b) / 2);
    }
  }
  return taken;
}

/// Welds that are nearer than this are one on the other: a hundredth of the shells' sides.
double same_place(const Model& model) {
  constexpr std::size_t kAsked = 500;
  constexpr double kShare = 0.01;
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t s = 0; s < model.shell_count(); s += model.shell_count() / kAsked + 1)
    if (const ShellIndex shell(s); !model.is_removed(shell)) {
      if (const double side = connections::mean_side(model, shell); std::isfinite(side)) sum += side, ++count;
    }
  return count > 0 ? kShare * sum / static_cast<double>(count) : 0;
}

/// A weld to be made: the sheets that it joins, in order.
struct WantedWeld {
  Vec3 at = Vec3::Zero();
  std::vector<SheetAtSpot> sheets;
};

/// The corner of the sheet's shell nearest to the spot whose shells are all of the sheet's part; nothing if none is.
std::optional<NodeOrigin> corner_of_one_part(const deck::PartsAtNodes& parts, const Model& model, const SheetAtSpot& sheet) {
  std::optional<NodeIndex> nearest;
  for (const NodeIndex node : model.shell(sheet.shell).node)
    if (parts.part_at(model, node) == model.shell_parts[sheet.shell.value] &&
        (!nearest || (model.position(node) - sheet.point).squaredNorm() < (model.position(*nearest) - sheet.point).squaredNorm()))
      nearest = node;
  if (!nearest) return std::nullopt;
  return NodeOrigin{{*nearest, NodeIndex(), NodeIndex(), NodeIndex()}, {1, 0, 0, 0}};
}

class SpotSearch {
 public:
  /// `kind`: what the welds are like; null: a part that is made for them.
  /// `named`: of formats whose cards name the parts of the sheets; else null.
  SpotSearch(const Generation& generation, const Weld& edit, const WeldKind* kind, const deck::PartsAtNodes* named, EditReport& report)
      : generation_(generation),
        named_(named),
        edit_(edit),
        kind_(kind),
        report_(report),
        there_(welds_there(generation, edit.pitch ? *edit.pitch / 2 : same_place(generation.model))),
        all_(generation.model) {
    report_.welded.emplace();
    options_.gap = edit.gap;
  }

  void search(const WeldLine& line, std::vector<WantedWeld>& welds) {
    const spatial::BoxTree tree = tree_of(line.parts);
    for (const Vec3& place : line.places) search_at(line, tree, place, welds);
  }
  const std::string& first_reason() const { return first_; }

 private:
  /// Without hidden parts and, if `parts` isn't empty, all others.
  spatial::BoxTree tree_of(const std::vector<PartIndex>& parts) const {
    const Model& model = generation_.model;
    const std::vector<std::uint8_t> hidden = hidden_parts(generation_);
    spatial::BoxTree tree = all_;
    ShellSet out;
    if (hidden.empty() && parts.empty()) return tree;
    for (std::size_t s = 0; s < model.shell_count(); ++s) {
      const PartIndex part = model.shell_parts[s];
      const bool counts = parts.empty() || std::binary_search(parts.begin(), parts.end(), part);
      const bool seen = hidden.empty() || !part.valid() || hidden[part.value] == 0;
      if (!(counts && seen) && tree.contains(ShellIndex(s))) out.emplace_back(s);
    }
    tree.leave_out(out);
    return tree;
  }

  void leave(const Vec3& at, std::string why) {
    Welded& welded = *report_.welded;
    ++welded.spots_left;
    if (first_.empty()) first_ = why;
    if (welded.left_out.size() < kMaxSpotsTold) welded.left_out.push_back({{at.x(), at.y(), at.z()}, std::move(why)});
  }

  void search_at(const WeldLine& line, const spatial::BoxTree& tree, const Vec3& place, std::vector<WantedWeld>& welds) {
    const Model& model = generation_.model;
    if (edit_.edge_distance)
      for (const auto& sides : line.sides)
        for (const std::vector<Vec3>& side : sides)
          if (const double distance = connections::distance_to(side, place); distance < *edit_.edge_distance)
            return leave(place, "it is " + short_words(distance) + " from the flange's edge");
    const SpotStack stack = connections::stack_at(model, tree, place, options_);
    if (stack.sheets.empty())
      return leave(place, stack.nearest ? "no sheet is there; the nearest is " + short_words(*stack.nearest) + " away"
                                        : std::string("no sheet is there"));
    const auto wanted = static_cast<std::size_t>(edit_.sheets.value_or(2));
    if (stack.sheets.size() < wanted)
      return leave(place, (stack.sheets.size() == 1 ? "only a sheet of " + sheet_part_words(model, part_of(stack.sheets.front())) + " is"
                                                    : "only " + std::to_string(stack.sheets.size()) + " sheets are") +
                              " there" + thickness_words(stack));
    std::vector<SheetAtSpot> sheets = nearest_sheets(stack, place);
    Vec3 middle = Vec3::Zero();
    for (const SheetAtSpot& sheet : sheets) middle += sheet.point / static_cast<double>(sheets.size());
    if (there_.near(middle) || std::any_of(sheets.begin(), sheets.end(), [&](const SheetAtSpot& s) { return there_.near(s.point); }))
      return leave(place, edit_.pitch ? "a weld is there already, nearer than half the pitch" : "a weld is there already");
    if (kind_ != nullptr && kind_->tied_by_end)
      for (const SheetAtSpot& sheet : sheets)
        if (const PartIndex part = part_of(sheet); part != kind_->sheets[0] && part != kind_->sheets[1])
          return leave(place, "the ties of the existing weld hold " + sheet_part_words(model, kind_->sheets[0]) + " and " +
                                  sheet_part_words(model, kind_->sheets[1]) + ", not " + sheet_part_words(model, part));
    if (const std::string why = why_not_named(sheets); !why.empty()) return leave(place, why);
    for (const SheetAtSpot& sheet : sheets) there_.add(sheet.point);
    welds.push_back({place, std::move(sheets)});
  }

  /// Where the card names the sheets by their parts: why it can't; else empty.
  std::string why_not_named(const std::vector<SheetAtSpot>& sheets) const {
    if (!named_) return {};
    for (std::size_t s = 0; s < sheets.size(); ++s) {
      const PartIndex part = part_of(sheets[s]);
      if (s > 0 && part == part_of(sheets[s - 1]))
        return "both sheets are of " + sheet_part_words(generation_.model, part) + ", and a weld's card names two parts";
      if (!corner_of_one_part(*named_, generation_.model, sheets[s]))
        return "the corners of the shell there belong to several parts, so that the weld's card can't name its sheet";
    }
    return {};
  }

  PartIndex part_of(const SheetAtSpot& sheet) const { return generation_.model.shell_parts[sheet.shell.value]; }

  std::string thickness_words(const SpotStack& stack) const {
    const PartIndex part = part_of(stack.sheets.front());
    const bool known = part.valid() && (*generation_.model.parts)[part.value].thickness.has_value();
    return known || edit_.gap > 0 ? "" : "; it has no thickness, so that \"gap\" must say how far apart sheets may be";
  }

  /// As many as are wanted, next to each other, about the place.
  std::vector<SheetAtSpot> nearest_sheets(const SpotStack& stack, const Vec3& place) const {
    const std::size_t wanted = edit_.sheets ? static_cast<std::size_t>(*edit_.sheets) : stack.sheets.size();
    std::size_t best = 0;
    double least = -1;
    for (std::size_t first = 0; first + wanted <= stack.sheets.size(); ++first) {
      Vec3 middle = Vec3::Zero();
      for (std::size_t i = 0; i < wanted; ++i) middle += stack.sheets[first + i].point / static_cast<double>(wanted);
      if (const double distance = (middle - place).norm(); least < 0 || distance < least) least = distance, best = first;
    }
    const auto from = stack.sheets.begin() + static_cast<std::ptrdiff_t>(best);
    return {from, from + static_cast<std::ptrdiff_t>(wanted)};
  }

  const Generation& generation_;
  const deck::PartsAtNodes* named_;
  const Weld& edit_;
  const WeldKind* kind_;
  EditReport& report_;
  connections::SpotOptions options_;
  PlacesTaken there_;
  spatial::BoxTree all_;
  std::string first_;
};

/// The parts of the sheets, ascending.
std::vector<PartIndex> parts_joined(const Model& model, const std::vector<WantedWeld>& welds) {
  std::vector<PartIndex> parts;
  for (const WantedWeld& weld : welds)
    for (const SheetAtSpot& sheet : weld.sheets)
      if (const PartIndex part = model.shell_parts[sheet.shell.value]; part.valid()) parts.push_back(part);
  std::sort(parts.begin(), parts.end());
  parts.erase(std::unique(parts.begin(), parts.end()), parts.end());
  return parts;
}

/// What a new node's card follows: the example's end on the same part, if there is one, before the other.
NodeOrigin origin_on(const Model& model, const WeldKind& kind, const deck::PartsAtNodes* named, const SheetAtSpot& sheet) {
  if (named != nullptr)
    if (const std::optional<NodeOrigin> corner = corner_of_one_part(*named, model, sheet)) return *corner;
  if (!kind.ends) return corner_origin(model, sheet);
  const PartIndex part = model.shell_parts[sheet.shell.value];
  const auto [first, second] = *kind.ends;
  return kind.sheets[0] != part && kind.sheets[1] == part ? edge_origin(second, first) : edge_origin(first, second);
}

std::uint32_t joins_on(const Model& model, const WeldKind& kind, const SheetAtSpot& sheet) {
  if (!kind.ends || !kind.joins_sets) return kJoinsNone;
  const PartIndex part = model.shell_parts[sheet.shell.value];
  return kind.tied_by_end && (kind.sheets[0] == part || kind.sheets[1] == part) ? kJoinsTies : kJoinsCommon;
}

/// A node on each sheet, and an element between each and the next.
Result<void> add_welds(const Document& document, const WeldKind& kind, const deck::PartsAtNodes* named,
                       const std::vector<WantedWeld>& welds, Model& model) {
  deck::NewIds ids(*document.deck, model);
  for (const WantedWeld& weld : welds) {
    std::vector<NodeIndex> nodes;
    for (const SheetAtSpot& sheet : weld.sheets) {
      const NodeOrigin origin = origin_on(model, kind, named, sheet);
      const std::uint32_t joins = joins_on(model, kind, sheet);
      const Result<std::int64_t> id = ids.placed_node(origin, joins);
      if (!id) return fail(id.error());
      nodes.push_back(add_placed_node(model, *id, sheet.point, origin, joins));
    }
    for (std::size_t n = 1; n < nodes.size(); ++n) {
      const Result<std::int64_t> id = ids.element(kind.element_class, kind.example);
      if (!id) return fail(id.error());
      add_element(model, kind.element_class, *id, kind.part, std::array{nodes[n - 1], nodes[n]}, kind.example);
    }
  }
  return deck::can_restructure(*document.deck, document.opened->model, model, {});
}

/// Whether a format has the form; `like`: an existing weld is the example.
bool makes_form(deck::Format format, std::string_view form, bool like) {
  switch (format) {
    case deck::Format::ls_dyna: return form == "beam" || form == "spring";
    case deck::Format::radioss: return form == "beam" || form == "spring";
    case deck::Format::nastran: return form == "cweld" || (form == "cfast" && like);
    case deck::Format::abaqus: return form == "fastener";
    default: return false;
  }
}

/// Errors: what the edit asks for isn't made in this version, or contradicts itself.
Result<void> check_form(const Document& document, const Weld& edit) {
  constexpr std::string_view kForms[] = {"beam", "spring", "solid", "constrained", "cweld", "cfast", "fastener"};
  if (edit.as && std::find(std::begin(kForms), std::end(kForms), *edit.as) == std::end(kForms))
    return fail("", "weld: \"as\" must be \"beam\", \"spring\", \"cweld\", \"cfast\" or \"fastener\", not \"" + *edit.as + "\"");
  if (edit.as && !makes_form(document.deck->format, *edit.as, edit.like.has_value()))
    return fail("", "weld: this version makes no welds as \"" + *edit.as + "\" in " + std::string(name(document.deck->format)) +
                        " decks: it makes beams in LS-DYNA decks, springs in Radioss decks, CWELD in Nastran decks (CFAST like an existing "
                        "one) and fasteners in Abaqus decks");
  if (edit.like && edit.diameter)
    return fail("", "weld: \"diameter\" belongs to the section, which \"like\" takes from the existing weld; only one can be given");
  if (edit.like && (edit.density || edit.youngs_modulus || edit.poissons_ratio || edit.yield_stress))
    return fail("", "weld: \"like\" takes the material from the existing weld; its values can't be given too");
  if (!document.deck->references || document.deck->files.empty()) return fail("", "weld: the document has no deck");
  return {};
}

}  // namespace

Result<void> apply_edit(const Document& document, const Weld& edit, Generation& next, EditReport& report, const Progress& progress) {
  const Generation& before = document.current();
  if (const Result<void> sound = check_form(document, edit); !sound) return sound;
  std::optional<WeldKind> kind;
  const bool is_nearest_wanted = edit.like == "nearest";
  if (edit.like && !is_nearest_wanted) {  // before the places are looked for: a wrong name is told at once
    Result<WeldKind> like = like_existing(document, *edit.like);
    if (!like) return fail(like.error());
    kind = *like;
  }
  const Result<std::vector<WeldLine>> lines = weld_places(document, edit, progress);
  if (!lines) return fail(lines.error());
  if (is_nearest_wanted) {
    const auto first = std::find_if(lines->begin(), lines->end(), [](const WeldLine& line) { return !line.places.empty(); });
    Result<WeldKind> like = like_nearest(document, first != lines->end() ? first->places.front() : Vec3(Vec3::Zero()), report);
    if (!like) return fail(like.error());
    kind = *like;
  }
  std::vector<WantedWeld> welds;
  std::optional<deck::PartsAtNodes> parts_at_nodes;
  if (deck::card_writer(document.deck->format)->names_sheets()) parts_at_nodes.emplace(document.opened->model);
  const deck::PartsAtNodes* const named = parts_at_nodes ? &*parts_at_nodes : nullptr;
  SpotSearch search(before, edit, kind ? &*kind : nullptr, named, report);
  for (const WeldLine& line : *lines) {
    search.search(line, welds);
    if (!line.note.empty()) report.notes.push_back(line.note);
  }
  if (welds.empty())
    return fail("", "weld: no weld can be made at any of " + counted(report.welded->spots_left, "spot") + ": " + search.first_reason());
  const std::vector<PartIndex> sheets = parts_joined(before.model, welds);
  if (const Result<void> open = refuse_locked(before, sheets, "welds", "weld"); !open) return open;
  if (kind)
    if (const Result<void> open = refuse_locked(before, {kind->part}, "elements", "weld"); !open) return open;
  if (kind) note_untied(document, kind->part, sheets, "welds", report);
  if (kind && document.deck->format == deck::Format::abaqus)
    for (const PartIndex sheet : sheets)
      if (sheet != kind->sheets[0] && sheet != kind->sheets[1])
        report.notes.push_back("the existing weld doesn't join " + sheet_part_words(before.model, sheet) +
                               ": welds there hold only if the fastener's surface has it too");
  if (!kind) {
    Result<WeldKind> made = make_part(document, edit, sheets, next);
    if (!made) return fail(made.error());
    kind = *made;
  }
  if (const Result<void> added = add_welds(document, *kind, named, welds, next.model); !added) return added;

  settle_growth(before, {}, next);
  grow_relations(before.model, next);
  const Changes changes = changes_between(before.model, next.model);
  mark_parts_at(changes.added_nodes, next);
  report.welded->welds_added = welds.size();
  report.elements_added = changes.other_elements();
  report.notes.push_back(counted(welds.size(), "weld") + " added to " + sheet_part_words(next.model, kind->part));
  if (report.welded->spots_left > 0)
    report.notes.push_back(counted(report.welded->spots_left, "spot") + " left out; the first: " + search.first_reason());
  note_missing_files(document, changes, report);
  return {};
}

}  // namespace prismesh::mesh::document
