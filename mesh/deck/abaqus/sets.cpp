#include "mesh/deck/abaqus/sets.h"

#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include "mesh/deck/abaqus/materials.h"
#include "mesh/deck/text/number.h"

namespace prismesh::mesh::deck::abaqus {
namespace {

struct Range {
  std::int64_t first, last, step;
};

/// A named set: blocks of *ELSET, and a group of elements that stand under its name.
struct ElementSet {
  std::vector<std::uint32_t> blocks;  ///< index into DeckOutline::kept
  std::uint32_t group = kNone;
  bool taken = false;  ///< by a section
};

/// One element's part, wherever it stands.
struct Member {
  std::int64_t id;
  std::int64_t* part;
};

class PartMaker {
 public:
  PartMaker(const DeckOutline& outline, std::span<PieceCards> cards, Warnings& warnings)
      : outline_(outline), cards_(cards), warnings_(warnings) {}

  std::vector<Part> run() {
    find_sets();
    group_part_.assign(outline_.groups.size(), 0);
    std::vector<Part> parts;
    for (Section& section : sections(outline_)) {
      section.part.id = static_cast<std::int64_t>(parts.size()) + 1;
      section.part.name = section.elset;
      section.part.defined = true;
      take(section.scope, label(section.elset), section.part.id);
      parts.push_back(std::move(section.part));
    }
    assign();
    add_undefined(parts);
    return parts;
  }

 private:
  void find_sets() {
    for (std::uint32_t g = 0; g < outline_.groups.size(); ++g)
      if (!outline_.groups[g].elset.empty()) sets_[outline_.groups[g]].group = g;
    for (std::uint32_t k = 0; k < outline_.kept.size(); ++k) {
      if (outline_.words[outline_.kept[k].word] != "ELSET") continue;
      const Parameters given = outline_.parameters(outline_.kept[k].block);
      if (const auto name = given.value("ELSET")) sets_[{outline_.kept[k].block.scope, label(*name)}].blocks.push_back(k);
    }
  }

  /// Gives the elements of a set, and of the sets in it, to a part. Each set is read once: of several sections of an element the first
  /// counts.
  void take(std::uint32_t scope, std::string name, std::int64_t part) {
    std::vector<std::string> waiting{std::move(name)};
    while (!waiting.empty()) {
      const auto at = sets_.find({scope, waiting.back()});
      waiting.pop_back();
      if (at == sets_.end() || at->second.taken) continue;
      ElementSet& set = at->second;
      set.taken = true;
      if (set.group != kNone) group_part_[set.group] = part;
      for (const std::uint32_t k : set.blocks) read_set(outline_.kept[k].block, part, waiting);
    }
  }

  void read_set(const Block& block, std::int64_t part, std::vector<std::string>& sets) {
    const bool generate = outline_.parameters(block).has("GENERATE");
    std::vector<std::pair<Range, std::int64_t>>& ranges = ranges_[block.scope];
    for (std::uint32_t s = 0; s < block.segments; ++s) {
      const Segment& where = outline_.segments[block.first_segment + s];
      DataLines lines(outline_.text(where.file), where.begin, where.end);
      for (DataLine line; lines.next(line);) {
        if (generate) {
          const auto fields = first_fields<3>(line.text);
          Range range{0, 0, 1};
          if (!parse_integer(fields[0], range.first) || !parse_integer(fields[1], range.last) || !parse_integer(fields[2], range.step))
            continue;
          if (fields[1].empty()) range.last = range.first;
          range.step = std::max<std::int64_t>(range.step, 1);
          if (range.first <= range.last) ranges.push_back({range, part});
          continue;
        }
        Fields fields(line.text);
        for (std::string_view field; fields.next(field);) {
          std::int64_t id = 0;
          if (field.empty()) continue;
          if (!parse_integer(field, id))
            sets.push_back(label(field.substr(0, 200)));
          else if (!ranges.empty() && ranges.back().second == part && ranges.back().first.step == 1 && ranges.back().first.last + 1 == id)
            ranges.back().first.last = id;
          else
            ranges.push_back({{id, id, 1}, part});
        }
      }
    }
  }

  /// Elements whose group has no section get theirs by number.
  void assign() {
    std::map<std::uint32_t, std::vector<Member>> left;
    for (std::size_t p = 0; p < cards_.size(); ++p) {
      std::vector<Member>& of_scope = left[outline_.pieces[p].scope];
      const auto collect = [&](std::vector<std::int64_t>& ids, std::vector<std::int64_t>& parts) {
        for (std::size_t i = 0; i < ids.size(); ++i) {
          const auto group = static_cast<std::size_t>(parts[i] - 1);
          if (group_part_[group] > 0)
            parts[i] = group_part_[group];
          else {
            parts[i] = -parts[i];
            of_scope.push_back({ids[i], &parts[i]});
          }
        }
      };
      collect(cards_[p].shells.id, cards_[p].shells.part);
      for (RawElements& elements : cards_[p].elements) collect(elements.id, elements.part);
    }
    for (auto& [scope, members] : left)
      if (const auto at = ranges_.find(scope); at != ranges_.end() && !members.empty()) assign_by_number(members, at->second);
  }

  void assign_by_number(std::vector<Member>& members, const std::vector<std::pair<Range, std::int64_t>>& ranges) {
    const auto less = [](const Member& a, const Member& b) { return a.id < b.id; };
    if (!std::is_sorted(members.begin(), members.end(), less)) std::stable_sort(members.begin(), members.end(), less);
    // The next member without a part, from each member on: members that have one are skipped, so overlapping ranges cost little.
    std::vector<std::uint32_t> next(members.size() + 1);
    for (std::uint32_t i = 0; i < next.size(); ++i) next[i] = i;
    const auto open_from = [&](std::uint32_t i) {
      std::uint32_t root = i;
      while (next[root] != root) root = next[root];
      while (next[i] != root) i = std::exchange(next[i], root);
      return root;
    };
    // In ranges with steps none can be skipped; this limits the cost of hostile decks.
    std::size_t steps_left = 100'000'000;
    for (const auto& [range, part] : ranges) {
      auto i = static_cast<std::uint32_t>(std::lower_bound(members.begin(), members.end(), Member{range.first, nullptr}, less) -
                                          members.begin());
      for (i = open_from(i); i < members.size() && members[i].id <= range.last && steps_left > 0; i = open_from(i + 1)) {
        if (range.step > 1) --steps_left;
        if ((members[i].id - range.first) % range.step != 0) continue;
        *members[i].part = part;
        next[i] = i + 1;
      }
    }
    if (steps_left == 0)
      warnings_.note("sets-too-tangled", 0, 0, "element sets overlap so much that not every element is shown with its own section's part");
  }

  /// Parts for elements without a section.
  void add_undefined(std::vector<Part>& parts) {
    std::vector<std::int64_t> part_of(outline_.groups.size());
    const auto number = [&](std::vector<std::int64_t>& field) {
      for (std::int64_t& part : field) {
        if (part >= 0) continue;
        const auto group = static_cast<std::size_t>(-part - 1);
        if (part_of[group] == 0) {
          Part undefined;
          undefined.id = part_of[group] = static_cast<std::int64_t>(parts.size()) + 1;
          undefined.name = outline_.groups[group].elset;
          parts.push_back(undefined);
        }
        part = part_of[group];
      }
    };
    for (PieceCards& cards : cards_) {
      number(cards.shells.part);
      for (RawElements& elements : cards.elements) number(elements.part);
    }
  }

  const DeckOutline& outline_;
  std::span<PieceCards> cards_;
  Warnings& warnings_;
  std::map<Group, ElementSet> sets_;
  std::vector<std::int64_t> group_part_;
  std::map<std::uint32_t, std::vector<std::pair<Range, std::int64_t>>> ranges_;  ///< by scope
};

}  // namespace

std::vector<Part> make_parts(const DeckOutline& outline, std::span<PieceCards> cards, Warnings& warnings) {
  return PartMaker(outline, cards, warnings).run();
}

}  // namespace prismesh::mesh::deck::abaqus
