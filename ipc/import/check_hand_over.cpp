#include "ipc/import/check_hand_over.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <set>
#include <span>

namespace prismesh::ipc {

namespace {

using mesh::NodeIndex;
using mesh::deck::CardRun;
using mesh::deck::Deck;

/// Ids have up to 18 digits; with the offsets of nested includes they may become larger. Twice this fits into 64 bits.
constexpr std::int64_t kMaxId = 2'000'000'000'000'000'000;
constexpr std::int64_t kMaxIdOffset = 100'000'000'000'000'000;

bool is_id(std::int64_t id) { return -kMaxId <= id && id <= kMaxId; }

/// Whether the name stays in its folder and is written in the one way.
bool stays_inside(const std::filesystem::path& relative) {
  if (relative.empty() || relative.is_absolute() || relative.string().find('\0') != std::string::npos) return false;
  if (!relative.has_filename() || relative.string() != relative.lexically_normal().string()) return false;
  return std::none_of(relative.begin(), relative.end(), [](const std::filesystem::path& part) { return part == ".." || part == "."; });
}

template <class Values, class Good>
bool all_of(const Values& values, const Good& good) {
  return std::all_of(values.begin(), values.end(), good);
}

template <class T, class Good>
bool all_of(const mesh::ChunkedArray<T>& values, const Good& good) {
  for (std::size_t c = 0; c < values.chunk_count(); ++c)
    if (!all_of(values.chunk(c), good)) return false;
  return true;
}

/// Whether the first indices of `size` entries begin with 0, don't fall and end with `count`.
bool divides(const std::vector<std::uint32_t>& first, std::size_t size, std::size_t count) {
  return first.size() == size + 1 && first.front() == 0 && first.back() == count && std::is_sorted(first.begin(), first.end());
}

class HandOverCheck {
 public:
  HandOverCheck(const Deck& deck, const HandedReferences& references, const mesh::Model& model)
      : deck_(deck), references_(references), model_(model) {}

  std::string fault() const {
    using Check = std::string (HandOverCheck::*)() const;
    for (const Check check : {&HandOverCheck::files, &HandOverCheck::frames, &HandOverCheck::nodes, &HandOverCheck::parts,
                              &HandOverCheck::shells, &HandOverCheck::midside_nodes, &HandOverCheck::other_elements,
                              &HandOverCheck::left_out, &HandOverCheck::numbers, &HandOverCheck::cards_that_refer})
      if (std::string fault = (this->*check)(); !fault.empty()) return fault;
    return {};
  }

 private:
  bool is_file(std::uint32_t file) const { return file < deck_.files.size(); }
  bool is_place(std::uint32_t file, std::uint64_t offset) const { return is_file(file) && offset <= deck_.files[file].bytes.text().size(); }
  bool is_node(NodeIndex node) const { return node.value < model_.node_count(); }
  bool is_node_or_none(NodeIndex node) const { return !node.valid() || is_node(node); }
  bool is_part_or_none(mesh::PartIndex part) const { return !part.valid() || part.value < model_.parts->size(); }

  std::string files() const {
    if (deck_.files.empty()) return "it has no file";
    if (deck_.files[0].relative.has_parent_path()) return "its main file isn't in the deck's folder";
    std::set<std::string> names;
    for (const mesh::deck::SourceFile& file : deck_.files)
      if (!stays_inside(file.relative) || !names.insert(file.relative.string()).second)
        return "a file has a name that leads elsewhere, or that another file has";
    for (const mesh::deck::CompanionFile& file : deck_.companions)
      if (!stays_inside(file.relative)) return "a companion file has a name that leads elsewhere";
    if (!all_of(deck_.unread_files, [&](const auto& unread) { return is_file(unread.file); })) return "an unread file has no such number";
    if (!all_of(deck_.held_files, [&](std::uint32_t file) { return is_file(file); }) ||
        !std::is_sorted(deck_.held_files.begin(), deck_.held_files.end()))
      return "its files that must not change aren't a list of files in order";
    return {};
  }

  std::string frames() const {
    if (deck_.frames.empty() || !deck_.frames[0].is_basic()) return "its first coordinate system isn't the basic one";
    const auto is_small = [](std::int64_t offset) { return -kMaxIdOffset <= offset && offset <= kMaxIdOffset; };
    for (const mesh::deck::IdOffsets& o : deck_.id_offsets)
      for (const std::int64_t each : {o.node, o.element, o.part, o.material, o.set, o.function, o.define, o.other})
        if (!is_small(each)) return "it adds " + std::to_string(each) + " to ids";
    return {};
  }

  /// `lines`: offsets of the cards.
  std::string runs(const std::vector<CardRun>& runs, const std::vector<std::uint64_t>& lines, const std::string& what) const {
    if (!lines.empty() && (runs.empty() || runs[0].first != 0)) return "the first card of its " + what + " belongs to no file";
    for (std::size_t r = 0; r < runs.size(); ++r) {
      const std::size_t end = r + 1 < runs.size() ? runs[r + 1].first : lines.size();
      if (runs[r].first >= end || end > lines.size()) return "the runs of its " + what + " aren't in order";
      if (!is_file(runs[r].file) || runs[r].frame >= deck_.frames.size()) return "a run of its " + what + " has no such file or system";
      for (std::size_t i = runs[r].first; i < end; ++i)
        if (!is_place(runs[r].file, lines[i])) return "a card of its " + what + " lies beyond the end of its file";
    }
    return {};
  }

  std::string nodes() const {
    const std::size_t count = model_.node_count();
    if (count >= NodeIndex::kNone || model_.node_ids.size() != count || model_.node_holds.size() != count ||
        deck_.node_line.size() != count)
      return "its arrays of nodes differ in length, or are too long";
    if (!all_of(model_.node_ids, is_id)) return "the id of a node has too many digits";
    if (!all_of(model_.positions, [](const mesh::Vec3& position) { return position.allFinite(); }))
      return "the position of a node isn't finite";
    if (!all_of(model_.node_holds, [](std::uint8_t holds) { return (holds & ~kHolds) == 0; }))
      return "a node is held for an unknown reason";
    return runs(deck_.node_runs, deck_.node_line, "nodes");
  }

  std::string parts() const {
    const std::vector<mesh::Part>& parts = *model_.parts;
    const auto not_less = [](const mesh::Part& a, const mesh::Part& b) { return a.id >= b.id; };
    if (parts.size() >= mesh::PartIndex::kNone || std::adjacent_find(parts.begin(), parts.end(), not_less) != parts.end())
      return "its parts aren't in the order of their ids";
    for (const mesh::Part& part : parts)
      for (const std::optional<double>& value : {part.thickness, part.density, part.youngs_modulus, part.poissons_ratio})
        if (value && !std::isfinite(*value)) return "a value of part " + std::to_string(part.id) + " isn't finite";
    return {};
  }

  std::string shells() const {
    const std::size_t count = model_.shell_count();
    if (count >= mesh::ShellIndex::kNone || model_.shell_ids.size() != count || model_.shell_parts.size() != count ||
        model_.shell_thickness.size() != count || deck_.shell_line.size() != count)
      return "its arrays of shells differ in length, or are too long";
    if (!all_of(model_.shell_ids, is_id)) return "the id of a shell has too many digits";
    if (!all_of(model_.shell_nodes,
                [&](const mesh::ShellNodes& nodes) { return all_of(nodes.node, [&](NodeIndex n) { return is_node(n); }); }))
      return "a shell has a node that isn't there";
    if (!all_of(model_.shell_parts, [&](mesh::PartIndex part) { return is_part_or_none(part); }))
      return "a shell has a part that isn't there";
    if (!all_of(model_.shell_thickness, [](float thickness) { return std::isfinite(thickness); }))
      return "the thickness of a shell isn't finite";
    return runs(deck_.shell_runs, deck_.shell_line, "shells");
  }

  std::string midside_nodes() const {
    const std::vector<mesh::MidsideNodes>& midside = *model_.midside;
    for (const mesh::MidsideNodes& each : midside)
      if (each.shell.value >= model_.shell_count() || !all_of(each.node, [&](NodeIndex node) { return is_node_or_none(node); }))
        return "mid-side nodes belong to no shell, or aren't there";
    const auto before = [](const mesh::MidsideNodes& a, const mesh::MidsideNodes& b) { return a.shell < b.shell; };
    return std::is_sorted(midside.begin(), midside.end(), before) ? "" : "its mid-side nodes aren't in the order of their shells";
  }

  std::string other_elements() const {
    for (std::size_t c = 0; c < mesh::kElementClassCount; ++c) {
      const mesh::ElementBlock* block = model_.elements[c].get();
      if (block == nullptr) continue;
      const std::string name(mesh::name(static_cast<mesh::ElementClass>(c)));
      if (block->part.size() != block->size() || !divides(block->first_node, block->size(), block->nodes.size()))
        return "the arrays of its elements of the class " + name + " don't fit each other";
      if (!all_of(block->id, is_id)) return "the id of an element of the class " + name + " has too many digits";
      if (!all_of(block->part, [&](mesh::PartIndex part) { return is_part_or_none(part); }) ||
          !all_of(block->nodes, [&](NodeIndex node) { return is_node(node); }))
        return "an element of the class " + name + " has a node or a part that isn't there";
    }
    return {};
  }

  std::string left_out() const {
    if (!std::is_sorted(deck_.left_out_elements.begin(), deck_.left_out_elements.end()))
      return "the elements that it leaves out aren't in the order of their ids";
    const mesh::deck::HiddenElements& hidden = deck_.hidden;
    if (!divides(hidden.first_node, hidden.size(), hidden.nodes.size()) ||
        !all_of(hidden.nodes, [&](NodeIndex node) { return is_node(node); }) ||
        !all_of(hidden.cards, [&](const auto& card) { return is_place(card.file, card.offset); }))
      return "an element that it leaves out has a node or a card that isn't there";
    const auto is_range = [](const mesh::deck::IdRange& range) {
      return range.first <= range.last && is_id(range.first) && is_id(range.last);
    };
    if (!all_of(deck_.taken.nodes, is_range) || !all_of(deck_.taken.elements, is_range)) return "a range of ids that are taken isn't one";
    return {};
  }

  std::string numbers() const {
    const auto is_finite = [](double value) { return std::isfinite(value); };
    if (!is_finite(deck_.time_step.scale) || !is_finite(deck_.time_step.mass_scaled)) return "its time step isn't finite";
    const auto is_side = [&](const mesh::ContactSide& side) { return is_finite(side.thickness) && is_finite(side.scale); };
    const mesh::ContactCards& contacts = deck_.contacts;
    if (!all_of(contacts.cards, [&](const auto& card) { return is_side(card.a) && (!card.b || is_side(*card.b)); }) ||
        !all_of(contacts.of_part, [&](const auto& of) { return is_finite(of.second.thickness) && is_finite(of.second.scale); }) ||
        !is_finite(contacts.thickness))
      return "the thickness of a contact isn't finite";
    return {};
  }

  std::string cards_that_refer() const {
    if (!all_of(references_.referrers, [&](const mesh::Referrer& r) { return r.offset <= r.end && is_place(r.file, r.end); }))
      return "a card that names entities lies beyond the end of its file";
    for (const mesh::Reference& r : references_.references) {
      if (r.referrer >= references_.referrers.size()) return "a reference belongs to no card";
      if (!is_place(references_.referrers[r.referrer].file, r.card)) return "the line of a reference lies beyond the end of its file";
      if (r.first < 1 || r.last < r.first || r.last > kMaxId || r.step < 1 || r.step > kMaxId) return "a reference names no ids";
    }
    for (const mesh::UnreadText& unread : references_.unread)
      if (unread.begin > unread.end || !is_place(unread.file, unread.end) ||
          !std::is_sorted(unread.parameter_values.begin(), unread.parameter_values.end()))
        return "a text that isn't read lies beyond the end of its file";
    return {};
  }

  static constexpr int kHolds =
      mesh::kHeldByParameter | mesh::kHeldByInclude | mesh::kHeldByMissing | mesh::kHeldByFrame | mesh::kHeldByMaking | mesh::kHeldByRepeat;

  const Deck& deck_;
  const HandedReferences& references_;
  const mesh::Model& model_;
};

}  // namespace

std::string fault_of(const Deck& deck, const HandedReferences& references, const mesh::Model& model) {
  return HandOverCheck(deck, references, model).fault();
}

}  // namespace prismesh::ipc
