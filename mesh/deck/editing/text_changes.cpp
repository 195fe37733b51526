#include "mesh/deck/editing/text_changes.h"

#include <algorithm>
#include <map>
#include <set>

#include "mesh/deck/editing/card_move.h"
#include "mesh/deck/editing/carrying.h"
#include "mesh/deck/editing/descent.h"
#include "mesh/deck/editing/naming.h"
#include "mesh/deck/formats/formats.h"
#include "mesh/deck/text/number.h"
#include "mesh/deck/text/text_lines.h"
#include "mesh/model/adjacency.h"
#include "mesh/model/topology_change.h"

namespace prismesh::mesh::deck {
namespace {

constexpr std::size_t kCardsBetween = 4096;  ///< two looks at the progress

constexpr const char* kFlattened = "stands in a coordinate system that flattens it, so its place can't be written";

class Differ {
 public:
  Differ(const Deck& deck, const Model& original, const Model& model, std::vector<NodeIndex> moved, const Progress& progress)
      : deck_(deck),
        original_(original),
        model_(model),
        writer_(card_writer(deck.format)),
        moved_(std::move(moved)),
        changes_(changes_between(original, model)),
        unread_(deck),
        progress_(progress),
        by_file_(deck.files.size()) {}

  Result<TextChanges> run() {
    if (Result<void> done = nothing_else_differs(); !done) return fail(done.error());
    if (Result<void> done = removed_are_unused(); !done) return fail(done.error());
    if (Result<void> done = moved(); !done) return fail(done.error());
    if (Result<void> done = nodes(); !done) return fail(done.error());
    if (Result<void> done = shells(); !done) return fail(done.error());
    put_in_blocks();
    if (!changes_.empty()) {
      Result<Carried> carried = carry_along(deck_, original_, model_, changes_, *writer_);
      if (!carried) return fail(carried.error());
      out_.set_cards = carried->cards;
      for (auto& [file, replacement] : carried->replacements) by_file_[file].push_back(std::move(replacement));
    }
    if (Result<void> done = put_in_order(); !done) return fail(done.error());
    return std::move(out_);
  }

 private:
  std::string_view text_of(const CardRun& run) const { return deck_.files[run.file].bytes.text(); }
  tl::unexpected<Error> refuse(const CardRun& run, std::size_t offset, const std::string& message) const {
    return fail(deck_.files[run.file].path.string(), line_number(text_of(run), offset), message + "; nothing was written");
  }
  std::string node_name(NodeIndex node) const { return "node " + std::to_string(model_.node_ids[node.value]); }
  std::string shell_name(ShellIndex shell) const { return "shell " + std::to_string(model_.shell_ids[shell.value]); }

  /// Asked for each card that is made.
  bool goes_on() {
    if (!progress_ || done_++ % kCardsBetween != 0) return true;
    const std::size_t all = moved_.size() + changes_.added_nodes.size() + changes_.reshaped_shells.size() + changes_.added_shells.size();
    return progress_(static_cast<double>(done_ - 1) / static_cast<double>(all));
  }

  // --- what can't be saved at all ---

  template <class Array>
  std::optional<std::size_t> first_difference(const Array& a, const Array& b) const {
    for (std::size_t c = 0; c < std::min(a.chunk_count(), b.chunk_count()); ++c) {
      if (a.chunk_owner(c) == b.chunk_owner(c)) continue;
      const auto before = a.chunk(c), after = b.chunk(c);
      for (std::size_t i = 0; i < std::min(before.size(), after.size()); ++i)
        if (before[i] != after[i]) return c * kChunkSize + i;
    }
    return std::nullopt;
  }

  Result<void> nothing_else_differs() const {
    for (const auto& [what, at] : {std::pair("part", first_difference(original_.shell_parts, model_.shell_parts)),
                                   std::pair("thickness", first_difference(original_.shell_thickness, model_.shell_thickness))})
      if (at)
        return refuse(deck_.run_of(ShellIndex(*at)), deck_.shell_line[*at],
                      shell_name(ShellIndex(*at)) + " has another " + what + " than its card, which this version can't write");
    return {};
  }

  /// No shell that is there, and no other element, may have a node that is gone.
  Result<void> removed_are_unused() const {
    const auto gone = [&](NodeIndex node) { return node.valid() && model_.is_removed(node); };
    const auto refuse_node = [&](NodeIndex node, const std::string& user) {
      return refuse(deck_.run_of(node), deck_.node_line[node.value], node_name(node) + " can't be removed: " + user + " has it");
    };
    const auto check_shell = [&](ShellIndex shell) -> Result<void> {
      if (model_.is_removed(shell)) return {};
      for (const NodeIndex node : model_.shell(shell).node)
        if (gone(node)) {
          if (node.value < original_.node_count()) return refuse_node(node, shell_name(shell));
          return fail(deck_.files[0].path.string(),
                      shell_name(shell) + " has " + node_name(node) + ", which was removed again; nothing was written");
        }
      return {};
    };
    for (const auto* shells : {&changes_.added_shells, &changes_.reshaped_shells})
      for (const ShellIndex shell : *shells)
        if (Result<void> fine = check_shell(shell); !fine) return fine;
    if (changes_.removed_nodes.empty()) return {};
    for (const NodeIndex node : changes_.removed_nodes)
      if (original_.adjacency)
        for (const ShellIndex shell : original_.adjacency->shells_of(node))
          if (Result<void> fine = check_shell(shell); !fine) return fine;
    for (int c = 0; c < kElementClassCount; ++c) {
      const auto& block = original_.elements[static_cast<std::size_t>(c)];
      if (!block) continue;
      for (std::size_t e = 0; e < block->size(); ++e)
        for (std::uint32_t n = block->first_node[e]; n < block->first_node[e + 1]; ++n)
          if (gone(block->nodes[n]))
            return refuse_node(block->nodes[n], std::string(name(static_cast<ElementClass>(c))) + " " + std::to_string(block->id[e]));
    }
    for (const MidsideNodes& midside : *original_.midside)
      if (!model_.is_removed(midside.shell))
        for (const NodeIndex node : midside.node)
          if (gone(node)) return refuse_node(node, shell_name(midside.shell));
    return {};
  }

  // --- nodes ---

  void note_rounding(const WrittenCard& card, const CardRun& run, std::size_t offset, const std::string& what) {
    if (card.rounded == 0) return;
    if (out_.rounding.count == 0) out_.rounding.first = place_of(deck_, run.file, offset) + " (" + what + ")";
    out_.rounding.count += static_cast<std::size_t>(card.rounded);
    out_.rounding.largest_error = std::max(out_.rounding.largest_error, card.largest_error);
  }

  void note_rounded_node(const WrittenCard& card, const CardRun& run, std::size_t offset, NodeIndex node, const std::string& what) {
    if (card.rounded == 0) return;
    note_rounding(card, run, offset, what);
    if (const std::optional<Vec3> at = writer_->node_coordinates({card.text, 0, run.style}))
      out_.rounding.nodes.emplace_back(node, to_basic(deck_.frames[run.frame], *at));
  }

  /// "is given by the parameter &name" for the first name in a card.
  std::string by_parameter(std::string_view card) const {
    const std::size_t begin = card.find('&');
    if (begin == std::string_view::npos) return "has numbers given by a parameter";
    return "has numbers given by the parameter " + std::string(card.substr(begin, card.find_first_of(" ,\t\r\n)+-*/", begin + 1) - begin));
  }

  void replace(const CardRun& run, std::size_t offset, std::size_t end, std::string text) {
    by_file_[run.file].push_back({offset, end - offset, std::move(text)});
  }

  Result<void> moved() {
    for (const NodeIndex node : moved_) {
      if (!goes_on()) return fail(cancelled());
      const CardRun& run = deck_.run_of(node);
      const std::string_view text = text_of(run);
      const std::size_t offset = deck_.node_line[node.value];
      const auto refuse_node = [&](const std::string& why) { return refuse(run, offset, node_name(node) + " " + why); };
      if (!model_.position(node).allFinite()) return refuse_node("has been moved to a place that is no number");
      const std::uint8_t held = original_.node_holds[node.value];
      if (held != 0) return refuse_node(std::string(why_held(held)) + "; it can't be moved");
      const std::optional<CardMove> move = in_card(deck_, *writer_, run, offset, original_.position(node), model_.position(node));
      if (!move) return refuse_node(kFlattened);
      const std::size_t end = writer_->node_end({text, offset, run.style});
      const std::string_view old = text.substr(offset, end - offset);
      WrittenCard card = writer_->move_node({text, offset, run.style}, move->from, move->to);
      if (card.by_parameter) return refuse_node(by_parameter(old) + "; it can't be moved");
      leave_equal_coordinates(card, run, offset, *move);
      note_rounded_node(card, run, offset, node, node_name(node));
      if (card.text == old) continue;
      ++out_.nodes_moved;
      replace(run, offset, end, std::move(card.text));
    }
    return {};
  }

  /// Where a coordinate moved by less than its field holds, its old digits stay.
  void leave_equal_coordinates(WrittenCard& card, const CardRun& run, std::size_t offset, const CardMove& move) const {
    const std::optional<Vec3> was = writer_->node_coordinates({text_of(run), offset, run.style});
    const std::optional<Vec3> is = writer_->node_coordinates({card.text, 0, run.style});
    if (!was || !is) return;
    Vec3 to = move.to;
    for (Eigen::Index axis = 0; axis < 3; ++axis)
      if ((*was)[axis] == (*is)[axis]) to[axis] = move.from[axis];
    if (to != move.to) card.text = writer_->move_node({text_of(run), offset, run.style}, move.from, to).text;
  }

  Result<void> nodes() {
    for (const NodeIndex node : changes_.added_nodes) {
      if (!goes_on()) return fail(cancelled());
      if (Result<void> done = add_node(node); !done) return done;
    }
    for (const NodeIndex node : changes_.removed_nodes) {
      const CardRun& run = deck_.run_of(node);
      const std::size_t offset = deck_.node_line[node.value];
      if (const auto held = static_cast<std::uint8_t>(original_.node_holds[node.value] & ~kHeldByParameter); held != 0)
        return refuse(run, offset, node_name(node) + " " + std::string(why_held(held)) + "; it can't be removed");
      remove_lines(run, offset, writer_->node_end({text_of(run), offset, run.style}));
      ++out_.nodes_removed;
    }
    return {};
  }

  Result<void> add_node(NodeIndex node) {
    if (!model_.position(node).allFinite())
      return fail(deck_.files[0].path.string(), node_name(node) + " is new and has a place that is no number; nothing was written");
    const NodeIndex home = home_of(model_, node);
    if (!home.valid())
      return fail(deck_.files[0].path.string(),
                  node_name(node) +
                      " would have to stand in an include that is used twice, or beside nodes that have no cards of their own; "
                      "nothing was written");
    const CardRun& run = deck_.run_of(home);
    const std::string_view text = text_of(run);
    const std::size_t offset = deck_.node_line[home.value];
    const auto refuse_node = [&](const std::string& why) { return refuse(run, offset, "the new " + node_name(node) + " " + why); };
    const std::int64_t id = model_.node_ids[node.value] - deck_.offsets_of(run).node;
    if (id < 1 || id > writer_->largest_node_id(run.style))
      return refuse_node("has an id that doesn't fit the fields of the cards beside it");
    const Frame& frame = deck_.frames[run.frame];
    Vec3 at = model_.position(node);
    if (!frame.is_basic()) {
      const std::optional<Vec3> own = to_card(frame, at, writer_->node_coordinates({text, offset, run.style}).value_or(Vec3(Vec3::Zero())));
      if (!own || !own->allFinite()) return refuse_node(kFlattened);
      at = *own;
    }
    const Result<bool> constrained = takes_constraints(node, home);
    if (!constrained) return fail(constrained.error());
    Result<WrittenCard> card = *constrained ? writer_->new_constrained_node({text, offset, run.style}, id, at)
                                            : Result<WrittenCard>(writer_->new_node({text, offset, run.style}, id, at));
    if (!card) return refuse_node(card.error().message);
    if (card->by_parameter) return refuse_node("would have its place given by a parameter");
    note_rounded_node(*card, run, offset, node, "new " + node_name(node));
    ++out_.nodes_added;
    const auto apart = *constrained ? std::nullopt : writer_->block_without_constraints({text, offset, run.style});
    if (apart)
      add_to_block(run, offset, *apart, card->text);
    else
      insert_behind(run, writer_->node_end({text, offset, run.style}), std::move(card->text));
    return {};
  }

  /// Whether all that a node comes from are constrained by their own cards, in the same way.
  Result<bool> takes_constraints(NodeIndex node, NodeIndex home) const {
    const auto constraints_of = [&](NodeIndex ancestor) {
      const CardRun& run = deck_.run_of(ancestor);
      return writer_->node_constraints({text_of(run), deck_.node_line[ancestor.value], run.style});
    };
    const std::string wanted = constraints_of(home);
    if (wanted.empty()) return false;
    bool differ = false;
    for (const NodeIndex ancestor : deck_ancestors(model_, node)) {
      const std::string own = constraints_of(ancestor);
      if (own.empty()) return false;
      differ |= own != wanted;
    }
    if (differ && !writer_->constraints_must_agree()) return false;
    if (differ)
      return refuse(deck_.run_of(home), deck_.node_line[home.value],
                    "the new " + node_name(node) + " lies between nodes whose cards constrain them in different ways");
    return true;
  }

  // --- shells ---

  Result<void> shells() {
    for (const auto* shells : {&changes_.reshaped_shells, &changes_.added_shells})
      for (const ShellIndex shell : *shells) {
        if (!goes_on()) return fail(cancelled());
        if (Result<void> done = write_shell(shell, shells == &changes_.added_shells); !done) return done;
      }
    for (const ShellIndex shell : changes_.removed_shells) {
      const CardRun& run = deck_.run_of(shell);
      const std::size_t offset = deck_.shell_line[shell.value];
      if (deck_.is_held(run.file))
        return refuse(run, offset, shell_name(shell) + " stands in an include that is used twice; it can't be removed");
      if (!writer_->stands_alone({text_of(run), offset, run.style}))
        return refuse(run, offset, shell_name(shell) + " has no card that is its alone; it can't be removed");
      remove_lines(run, offset, writer_->shell_end({text_of(run), offset, run.style}));
      ++out_.shells_removed;
    }
    return {};
  }

  Result<void> write_shell(ShellIndex shell, bool added) {
    const ShellIndex ancestor = deck_ancestor(model_, shell);
    const CardRun& run = deck_.run_of(ancestor);
    const std::string_view text = text_of(run);
    const std::size_t offset = deck_.shell_line[ancestor.value];
    const std::string what = (added ? "the new " : "") + shell_name(shell);
    const auto refuse_shell = [&](const std::string& why) { return refuse(run, offset, what + " " + why); };
    if (deck_.is_held(run.file)) return refuse_shell("stands in an include that is used twice; it can't be changed");
    if (has_midside(ancestor)) return refuse_shell("would come from a shell with mid-side nodes, which can't be divided or changed");
    ShellCard wanted = shell_card(original_, model_, shell);
    const IdOffsets offsets = deck_.offsets_of(run);
    wanted.id -= offsets.element;
    const std::int64_t largest = writer_->largest_shell_id(run.style);
    for (std::int64_t& node : wanted.nodes) {
      node -= offsets.node;
      if (node < 1 || node > largest) return refuse_shell("has a node whose id doesn't fit the fields of its card");
    }
    if (wanted.id < 1 || wanted.id > largest) return refuse_shell("has an id that doesn't fit the fields of the cards beside it");

    const bool triangle = model_.shell(shell).is_triangle();
    const bool other_kind =
        original_.shell(ancestor).is_triangle() != triangle && !writer_->holds_triangles_and_quads({text, offset, run.style});
    const std::size_t end = writer_->shell_end({text, offset, run.style});
    ShellIndex beside = ancestor;
    Result<WrittenCard> card = WrittenCard();
    if (other_kind) {
      if (const std::string why = names_other_kind(ancestor, triangle); !why.empty())
        return refuse_shell(std::string("becomes a ") + (triangle ? "triangle" : "quad") + ", but " + why);
      beside = neighbour_of_kind(ancestor, triangle);
      if (beside.valid()) {
        const CardRun& manner = deck_.run_of(beside);
        card = writer_->shell_in_manner({text, offset, run.style}, {text_of(manner), deck_.shell_line[beside.value], manner.style}, wanted);
      }
      if (!beside.valid() || !card) {
        if (const Result<void> written = write_in_new_block(run, offset, wanted, triangle); !written)
          return refuse_shell(std::string("becomes a ") + (triangle ? "triangle" : "quad") + " and " + written.error().message);
        ++(added ? out_.shells_added : out_.shells_changed);
        if (!added) remove_lines(run, offset, end);
        return {};
      }
    } else {
      card = writer_->shell({text, offset, run.style}, wanted);
    }
    if (!card) return refuse_shell(card.error().message);
    if (card->by_parameter) return refuse_shell(by_parameter(text.substr(offset, end - offset)) + "; it can't be changed");
    note_rounding(*card, run, offset, shell_name(shell));
    out_.shells_turned += card->turned;
    ++(added ? out_.shells_added : out_.shells_changed);
    if (!added && !other_kind) {
      replace(run, offset, end, std::move(card->text));
      return {};
    }
    if (!added) remove_lines(run, offset, end);
    const CardRun& there = deck_.run_of(beside);
    insert_behind(there, writer_->shell_end({text_of(there), deck_.shell_line[beside.value], there.style}), std::move(card->text));
    return {};
  }

  /// Which card names the shell and couldn't name it with another number of corners; empty if there is none.
  std::string names_other_kind(ShellIndex shell, bool triangle) {
    const std::int64_t id = original_.shell_ids[shell.value];
    for (const Reference& reference : deck_.references->naming(Referred::shell, id)) {
      const Referrer& card = deck_.references->referrers()[reference.referrer];
      if (!reference.takes_away && !writer_->can_name(card, triangle))
        return card_name(deck_.format, card) + " names it, which can't name one";
    }
    const UnreadText* unread = unread_.holding_all(Referred::shell, std::span(&id, 1));
    return unread != nullptr ? unread_name(deck_, *unread) : "";
  }

  /// The first of its part that has so many corners: in a block of its own, which the others join.
  Result<void> write_in_new_block(const CardRun& run, std::size_t offset, const ShellCard& wanted, bool triangle) {
    const std::string_view text = text_of(run);
    Result<CardWriter::NewBlock> block = writer_->block_of_kind({text, offset, run.style}, triangle);
    if (!block) return fail(block.error());
    const Result<WrittenCard> card = writer_->shell_in_block({text, offset, run.style}, wanted);
    if (!card) return fail(card.error());
    if (card->by_parameter) return fail("", "has a field that a parameter gives");
    add_to_block(run, offset, *block, card->text);
    return {};
  }

  /// `offset`: of a card whose line ends as those of the block are to end.
  void add_to_block(const CardRun& run, std::size_t offset, const CardWriter::NewBlock& block, const std::string& card) {
    const std::string_view text = text_of(run);
    const std::string eol(line_end(text, std::min(text.find('\n', offset), text.size())));
    std::string& cards = new_blocks_[{run.file, block.offset, block.header}];
    if (cards.empty()) cards = block.header + eol;
    cards += card + eol;
  }

  void put_in_blocks() {
    for (auto& [place, cards] : new_blocks_) {
      const auto& [file, offset, header] = place;
      const std::string_view text = deck_.files[file].bytes.text();
      const bool unended = offset == text.size() && offset > 0 && text[offset - 1] != '\n';
      by_file_[file].push_back({offset, 0, unended ? std::string(line_end(text, offset)) + cards : std::move(cards)});
    }
  }

  bool has_midside(ShellIndex shell) const {
    const auto& all = *original_.midside;
    const auto at = std::lower_bound(all.begin(), all.end(), shell, [](const MidsideNodes& m, ShellIndex s) { return m.shell < s; });
    return at != all.end() && at->shell == shell;
  }

  /// The last shell of the same part and file with three or four corners before the given one, else the first after it.
  ShellIndex neighbour_of_kind(ShellIndex shell, bool triangle) {
    const std::uint32_t file = deck_.run_of(shell).file;
    const auto [known, is_new] = neighbours_.try_emplace({file, original_.shell_parts[shell.value], triangle});
    if (!is_new) return known->second;
    const auto fits = [&](std::size_t other) {
      const ShellIndex at(other);
      return original_.shell_parts[other] == original_.shell_parts[shell.value] && original_.shell(at).is_triangle() == triangle &&
             deck_.run_of(at).file == file && !has_midside(at);
    };
    for (std::size_t other = shell.value; other-- > 0 && !known->second.valid();)
      if (fits(other)) known->second = ShellIndex(other);
    for (std::size_t other = shell.value + 1; other < original_.shell_count() && !known->second.valid(); ++other)
      if (fits(other)) known->second = ShellIndex(other);
    return known->second;
  }

  // --- text ---

  /// `end`: one past the card's last character. The new lines end as that line does.
  void insert_behind(const CardRun& run, std::size_t end, std::string card) {
    const std::string_view text = text_of(run);
    const std::string_view eol = line_end(text, end);
    const std::size_t newline = text.find('\n', end);
    if (newline == std::string_view::npos)
      by_file_[run.file].push_back({text.size(), 0, std::string(eol) + card});
    else
      by_file_[run.file].push_back({newline + 1, 0, card + std::string(eol)});
  }

  void remove_lines(const CardRun& run, std::size_t begin, std::size_t end) {
    const std::string_view text = text_of(run);
    const std::size_t newline = text.find('\n', end);
    replace(run, begin, newline == std::string_view::npos ? text.size() : newline + 1, "");
  }

  Result<void> put_in_order() {
    out_.by_file.resize(by_file_.size());
    for (std::size_t file = 0; file < by_file_.size(); ++file) {
      std::vector<Replacement>& all = by_file_[file];
      const std::string_view text = deck_.files[file].bytes.text();
      // What is put in at a place stands before what is changed there.
      std::stable_sort(all.begin(), all.end(), [](const Replacement& a, const Replacement& b) {
        return a.offset != b.offset ? a.offset < b.offset : (a.length == 0 && b.length > 0);
      });
      std::size_t reached = 0;
      for (Replacement& replacement : all) {
        if (replacement.offset < reached || replacement.offset + replacement.length > text.size())
          return fail(deck_.files[file].path.string(), line_number(text, std::min(replacement.offset, text.size())),
                      "two changes meet in this line, and can't be written together; nothing was written");
        reached = replacement.offset + replacement.length;
        const std::string_view old = text.substr(replacement.offset, replacement.length);
        if (old == replacement.text) continue;
        out_.lines += lines_that_differ(old, replacement.text);
        out_.by_file[file].push_back(std::move(replacement));
      }
    }
    return {};
  }

  const Deck& deck_;
  const Model& original_;
  const Model& model_;
  const std::unique_ptr<const CardWriter> writer_;
  const std::vector<NodeIndex> moved_;
  const Changes changes_;
  UnreadNumbers unread_;
  const Progress& progress_;
  std::size_t done_ = 0;  ///< cards made
  std::vector<std::vector<Replacement>> by_file_;
  std::map<std::tuple<std::uint32_t, PartIndex, bool>, ShellIndex> neighbours_;
  std::map<std::tuple<std::uint32_t, std::size_t, std::string>, std::string> new_blocks_;  ///< by file, place and header: with their cards
  TextChanges out_;
};

}  // namespace

std::string place_of(const Deck& deck, std::uint32_t file, std::size_t offset) {
  return deck.files[file].path.string() + ":" + std::to_string(line_number(deck.files[file].bytes.text(), offset));
}

Result<TextChanges> text_changes(const Deck& deck, const Model& original, const Model& model, const Progress& progress) {
  return Differ(deck, original, model, moved_nodes(original, model), progress).run();
}

Result<void> can_restructure(const Deck& deck, const Model& original, const Model& model, std::vector<NodeIndex> moved) {
  const Result<TextChanges> changes = Differ(deck, original, model, std::move(moved), {}).run();
  if (!changes) return fail(changes.error());
  return {};
}

}  // namespace prismesh::mesh::deck
