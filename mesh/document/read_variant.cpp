#include "mesh/document/read_variant.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>

#include "base/readable_number.h"
#include "mesh/deck/data/length_unit.h"

namespace prismesh::mesh::document {

namespace {

/// Sides between the points to align may differ by this factor: beyond it they aren't the same places.
constexpr double kMaxStretch = 1.5;
/// Three points lie on a line if the third is nearer to it than this share of their distance.
constexpr double kMinBend = 1e-3;

Result<void> check_whole(const deck::OpenedDeck& variant) {
  const deck::Deck& deck = *variant.deck;
  if (!deck.missing_files.empty())
    return fail(deck.files[0].path.string(), "replace_part: the variant names the include file " + deck.missing_files.front() +
                                                 ", which isn't there: its part may not be whole");
  for (const deck::HiddenElements::Card& card : deck.hidden.cards) {
    if (card.element_class != ElementClass::shell) continue;
    const std::string_view text = deck.files[card.file].bytes.text();
    const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(card.offset), '\n');
    return fail(deck.files[card.file].path.string(), static_cast<long>(line),
                "replace_part: the variant names what it doesn't bring: shell " + std::to_string(card.id) +
                    " has a node that isn't defined, or its number is defined before");
  }
  return {};
}

/// The part to take, by index.
Result<PartIndex> find_variant_part(const deck::OpenedDeck& variant, const ReplacePart& edit) {
  const Model& model = variant.model;
  std::set<PartIndex> parts;
  for (std::size_t s = 0; s < model.shell_count(); ++s)
    if (const PartIndex part = model.shell_parts[s]; part.valid()) parts.insert(part);
  std::string known;
  std::size_t named = 0;
  constexpr std::size_t kNamed = 8;
  for (const PartIndex part : parts)
    if (named++ < kNamed) known += (known.empty() ? "" : ", ") + std::to_string((*model.parts)[part.value].id);
  if (named > kNamed) known += ", ..";
  if (parts.empty()) return fail(edit.deck, "replace_part: the variant has no part with shells");
  if (!edit.with) {
    if (parts.size() == 1) return *parts.begin();
    return fail(edit.deck, "replace_part: \"with\" is missing: the variant has the parts " + known);
  }
  const PartIndex part = model.find_part(*edit.with);
  if (!part.valid()) return fail(edit.deck, "replace_part: the variant has no part " + std::to_string(*edit.with) + ", but " + known);
  if (!parts.contains(part))
    return fail(edit.deck, "replace_part: part " + std::to_string(*edit.with) + " of the variant has no shells; others have: " + known);
  return part;
}

/// Errors: the lengths of both decks have different units, as given or as far as they can be told.
Result<void> check_units(const Document& document, const deck::OpenedDeck& variant, const ReplacePart& edit) {
  const LengthUnit own = document.settings.length_unit;
  if (edit.units == "same") return {};
  if (edit.units) {
    const std::optional<LengthUnit> given = length_unit_from(*edit.units);
    if (!given) return fail("", "replace_part: \"units\" must be \"same\", \"mm\", \"m\" or \"in\", not \"" + *edit.units + "\"");
    if (*given == own) return {};
    return fail(edit.deck, "replace_part: \"units\" says that the variant's lengths are in " + std::string(name(*given)) +
                               "; the deck's are in " + std::string(name(own)) + ". Lengths aren't scaled: convert the variant first");
  }
  const LengthUnit guessed = variant.deck->length_unit.value_or(deck::guess_length_unit(variant.model));
  if (guessed == own) return {};
  return fail(edit.deck, "replace_part: the variant's lengths seem to be in " + std::string(name(guessed)) + ", the deck's are in " +
                             std::string(name(own)) +
                             ". Lengths aren't scaled: convert the variant, or give \"units\": \"same\" if both are in " +
                             std::string(name(own)));
}

std::array<double, 3> as_array(const Vec3& point) { return {point.x(), point.y(), point.z()}; }

Result<VariantMesh> mesh_of(const deck::OpenedDeck& variant, PartIndex part, const std::string& from) {
  const Model& model = variant.model;
  const std::string words = "part " + std::to_string((*model.parts)[part.value].id) + " of the variant";
  VariantMesh mesh;
  mesh.thickness = (*model.parts)[part.value].thickness;
  NodeSet nodes;
  for (std::size_t s = 0; s < model.shell_count(); ++s) {
    if (model.shell_parts[s] != part) continue;
    const ShellNodes& corners = model.shell(ShellIndex(s));
    VariantMesh::Shell shell{model.shell_ids[s], {}};
    for (std::size_t c = 0; c < 4; ++c) {
      shell.node[c] = model.node_ids[corners.node[c].value];
      nodes.push_back(corners.node[c]);
      for (std::size_t d = 0; d < c; ++d)
        if (corners.node[c] == corners.node[d] && !(c == 3 && d == 2))
          return fail(from, "replace_part: shell " + std::to_string(shell.id) + " of the variant has the node " +
                                std::to_string(shell.node[c]) + " twice");
    }
    mesh.shells.push_back(shell);
  }
  for (const MidsideNodes& midside : *model.midside)
    if (model.shell_parts[midside.shell.value] == part)
      return fail(from, "replace_part: " + words + " has shells with mid-side nodes, which this version can't take over");
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  for (const NodeIndex node : nodes) {
    if (!model.position(node).allFinite())
      return fail(from,
                  "replace_part: node " + std::to_string(model.node_ids[node.value]) + " of the variant is at a place that is no number");
    mesh.nodes.push_back({model.node_ids[node.value], as_array(model.position(node))});
  }
  return mesh;
}

Vec3 as_point(const std::array<double, 3>& at) { return {at[0], at[1], at[2]}; }

/// Puts coordinates in the place of node ids.
Result<void> resolve(const Model& model, const std::string& whose, std::vector<NodeReference>& points) {
  for (NodeReference& point : points) {
    const auto* id = std::get_if<std::int64_t>(&point);
    if (id == nullptr) continue;
    const NodeIndex node = model.find_node(*id);
    if (!node.valid()) return fail("", "replace_part: " + whose + " has no node " + std::to_string(*id) + " to align by");
    point = as_array(model.position(node));
  }
  return {};
}

/// Axes along the first side and across it in the plane of the three points.
Result<Eigen::Matrix3d> axes_of(const std::array<Vec3, 3>& point, const std::string& whose) {
  const Vec3 first = point[1] - point[0], second = point[2] - point[0], across = first.cross(second);
  if (!(across.norm() > kMinBend * first.norm() * second.norm()) || !across.allFinite())
    return fail("", "replace_part: the three points of " + whose + " lie on a line; they must span a triangle");
  Eigen::Matrix3d axes;
  axes.col(0) = first.normalized();
  axes.col(2) = across.normalized();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  return axes;
}

std::array<Vec3, 3> points_of(const std::vector<NodeReference>& references) {
  std::array<Vec3, 3> points;
  for (std::size_t p = 0; p < 3; ++p) points[p] = as_point(std::get<std::array<double, 3>>(references[p]));
  return points;
}

}  // namespace

Result<ReplacePart> with_mesh(const Document& document, const ReplacePart& edit, const Progress& progress) {
  if (edit.mesh) return edit;
  const std::filesystem::path path = document.path.parent_path() / edit.deck;
  const Result<deck::OpenedDeck> variant = document.read_variant(path, progress);
  if (!variant) return fail(variant.error());
  if (const Result<void> whole = check_whole(*variant); !whole) return fail(whole.error());
  const Result<PartIndex> part = find_variant_part(*variant, edit);
  if (!part) return fail(part.error());
  if (const Result<void> same = check_units(document, *variant, edit); !same) return fail(same.error());
  Result<VariantMesh> mesh = mesh_of(*variant, *part, edit.deck);
  if (!mesh) return fail(mesh.error());
  ReplacePart whole = edit;
  whole.with = (*variant->model.parts)[part->value].id;
  if (const Result<void> found = resolve(variant->model, "the variant", whole.align.from); !found) return fail(found.error());
  whole.mesh = std::move(*mesh);
  return whole;
}

Result<void> align_mesh(const Model& deck, const Alignment& align, VariantMesh& mesh) {
  if (align.from.empty()) return {};
  std::vector<NodeReference> wanted = align.to;
  if (const Result<void> found = resolve(deck, "the deck", wanted); !found) return found;
  std::vector<NodeReference> own_points = align.from;
  for (NodeReference& point : own_points) {
    const auto* id = std::get_if<std::int64_t>(&point);
    if (id == nullptr) continue;
    const auto node = std::ranges::find(mesh.nodes, *id, &VariantMesh::Node::id);
    if (node == mesh.nodes.end()) return fail("", "replace_part: the mesh has no node " + std::to_string(*id) + " to align by");
    point = node->at;
  }
  const std::array<Vec3, 3> from = points_of(own_points), to = points_of(wanted);
  const Result<Eigen::Matrix3d> from_axes = axes_of(from, "the variant");
  if (!from_axes) return fail(from_axes.error());
  const Result<Eigen::Matrix3d> to_axes = axes_of(to, "the deck");
  if (!to_axes) return fail(to_axes.error());
  for (std::size_t p = 0; p < 3; ++p) {
    const double own = (from[(p + 1) % 3] - from[p]).norm(), other = (to[(p + 1) % 3] - to[p]).norm();
    if (own > kMaxStretch * other || other > kMaxStretch * own)
      return fail("", "replace_part: the points to align by aren't the same places: two are " + readable(own, 4) +
                          " apart in the variant and " + readable(other, 4) + " in the deck. A variant is turned and moved, never scaled");
  }
  const Eigen::Matrix3d turn = *to_axes * from_axes->transpose();
  for (VariantMesh::Node& node : mesh.nodes) node.at = as_array(to[0] + turn * (as_point(node.at) - from[0]));
  return {};
}

}  // namespace prismesh::mesh::document
