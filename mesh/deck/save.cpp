// Saving: new text for the cards of moved nodes, and the rules of which files are written where.
#include <algorithm>
#include <cstdio>
#include <mutex>

#include "mesh/deck/deck.h"
#include "mesh/deck/lsdyna/keyword.h"
#include "mesh/deck/lsdyna/writer.h"
#include "mesh/deck/on_disk.h"

namespace prismesh::mesh::deck {
namespace {

namespace fs = std::filesystem;

/// A card's new text in its file.
struct Replacement {
  std::size_t offset = 0;
  std::size_t length = 0;
  std::string text;
};

/// Coordinates that their columns can't hold to the last bit.
struct Rounding {
  std::size_t count = 0;
  double largest_error = 0;
  std::string first;
};

struct NewText {
  std::vector<std::vector<Replacement>> by_file;
  Rounding rounding;
  std::size_t nodes = 0;
  std::size_t lines = 0;
};

std::string_view line_at(std::string_view text, std::size_t offset) {
  std::string_view line = text.substr(offset, std::min(text.find('\n', offset), text.size()) - offset);
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  return line;
}

std::string place(const SourceFile& file, std::size_t offset) {
  return file.path.string() + ":" + std::to_string(lsdyna::line_number(file.bytes.text(), offset));
}

const char* why_held(std::uint8_t hold) {
  if ((hold & kHeldByParameter) != 0) return " has coordinates given by a parameter";
  if ((hold & kHeldByInclude) != 0) return " stands in an include that is used twice or transformed";
  return " belongs to an element that also names a node that isn't defined";
}

Result<NewText> new_text(const Deck& deck, const Model& original, const Model& model) {
  NewText out;
  out.by_file.resize(deck.files.size());
  const std::vector<NodeIndex> moved = moved_nodes(original, model);
  out.nodes = moved.size();
  for (const NodeIndex node : moved) {
    const NodeRun& run = deck.node_runs[deck.run_of(node)];
    const SourceFile& file = deck.files[run.file];
    const std::size_t offset = deck.node_line[node.value];
    const std::string_view line = line_at(file.bytes.text(), offset);
    if (!model.position(node).allFinite())
      return fail(
          file.path.string(), lsdyna::line_number(file.bytes.text(), offset),
          "node " + std::to_string(original.node_ids[node.value]) + " has been moved to a place that is no number; nothing was written");
    lsdyna::RewrittenCard card = lsdyna::rewrite_node_card(line, run.columns, original.position(node), model.position(node));
    const std::uint8_t hold = static_cast<std::uint8_t>(original.node_holds[node.value] | (card.by_parameter ? kHeldByParameter : 0));
    if (hold != 0)
      return fail(file.path.string(), lsdyna::line_number(file.bytes.text(), offset),
                  "node " + std::to_string(original.node_ids[node.value]) + why_held(hold) + "; it can't be moved");
    if (card.rounded > 0) {
      if (out.rounding.count == 0)
        out.rounding.first = place(file, offset) + " (node " + std::to_string(original.node_ids[node.value]) + ")";
      out.rounding.count += static_cast<std::size_t>(card.rounded);
      out.rounding.largest_error = std::max(out.rounding.largest_error, card.largest_error);
    }
    if (card.text == line) continue;
    ++out.lines;
    out.by_file[run.file].push_back({offset, line.size(), std::move(card.text)});
  }
  return out;
}

std::vector<std::string_view> content_of(const SourceFile& file, const std::vector<Replacement>& replacements) {
  const std::string_view text = file.bytes.text();
  std::vector<std::string_view> pieces;
  pieces.reserve(2 * replacements.size() + 1);
  std::size_t at = 0;
  for (const Replacement& replacement : replacements) {
    pieces.push_back(text.substr(at, replacement.offset - at));
    pieces.push_back(replacement.text);
    at = replacement.offset + replacement.length;
  }
  pieces.push_back(text.substr(at));
  return pieces;
}

bool same_file(const fs::path& a, const fs::path& b) {
  std::error_code error;
  if (fs::equivalent(a, b, error) && !error) return true;
  return fs::absolute(a, error).lexically_normal() == fs::absolute(b, error).lexically_normal();
}

/// One file that is going to be written.
struct Plan {
  std::size_t file = 0;
  fs::path target;
};

/// Files in the order they are put in place: includes first, the main file last.
std::vector<std::size_t> writing_order(const Deck& deck) {
  std::vector<std::size_t> order;
  for (std::size_t i = 1; i < deck.files.size(); ++i) order.push_back(i);
  order.push_back(0);
  return order;
}

/// Refuses unless the file on disk is still what was read or what was last saved over it.
Result<void> check_unchanged(const SourceFile& file, OnDisk::File& known) {
  const Result<FileIdentity> now = identify_file(file.path);
  if (!now) return fail(file.path.string(), "is gone from disk since it was opened; nothing was written. Save into another folder instead");
  if (*now == known.identity) return {};
  // A copy or a touch changes the file's times only; its bytes decide.
  if (now->size == known.identity.size) {
    const Result<FileBytes> bytes = read_file(file.path);
    if (!bytes) return fail(bytes.error());
    if (hash128(bytes->bytes()) == known.content) {
      known.identity = bytes->identity();
      return {};
    }
  }
  return fail(file.path.string(),
              "has changed on disk since it was opened; nothing was written. Save into another folder, or close it and open it again");
}

Result<std::vector<Plan>> plan_in_place(const Deck& deck, const NewText& text) {
  std::vector<Plan> plans;
  for (const std::size_t file : writing_order(deck)) {
    OnDisk::File& known = deck.on_disk->files[file];
    if (Result<void> unchanged = check_unchanged(deck.files[file], known); !unchanged) return fail(unchanged.error());
    if (!text.by_file[file].empty() || !known.as_read) plans.push_back({file, deck.files[file].path});
  }
  return plans;
}

/// Whether an include's name means something else, or still the old file, in another folder.
bool stays_behind(const SourceFile& include) {
  return include.relative.is_absolute() || include.relative.begin() == include.relative.end() || *include.relative.begin() == "..";
}

fs::path folder_of(const fs::path& file) { return file.has_parent_path() ? file.parent_path() : fs::path("."); }

Result<std::vector<Plan>> plan_elsewhere(const Deck& deck, const NewText& text, const fs::path& target) {
  const bool other_folder = !same_file(folder_of(target), folder_of(deck.files[0].path));
  std::vector<Plan> plans;
  for (const std::size_t file : writing_order(deck)) {
    const SourceFile& source = deck.files[file];
    if (file != 0 && other_folder && stays_behind(source))
      return fail(source.path.string(), "is an include outside the main file's folder, so the deck can't be saved into another folder");
    const fs::path to = file == 0 ? target : target.parent_path() / source.relative;
    const auto own = std::find_if(deck.files.begin(), deck.files.end(), [&](const SourceFile& other) { return same_file(other.path, to); });
    if (own == deck.files.end()) {
      plans.push_back({file, to});
    } else if (file == 0) {
      return fail(target.string(), "is a file of the deck itself; the main file can't take its place");
    } else if (!text.by_file[file].empty() || !deck.on_disk->files[file].as_read) {
      return fail(source.path.string(),
                  "is an include that has changed, and a deck saved under another name beside the old one would share it; save into "
                  "another folder");
    }
  }
  return plans;
}

/// After saving in place: what is on disk now, also where only some of the files could be replaced.
void remember_written(const Deck& deck, std::span<const PendingFile> pending, std::span<const Plan> plans, const NewText& text, bool all) {
  for (std::size_t i = 0; i < plans.size(); ++i) {
    const SourceFile& source = deck.files[plans[i].file];
    const Hash128 written = hash128(pending[i].pieces);
    Result<FileIdentity> identity = identify_file(source.path);
    if (!all) {
      const Result<FileBytes> bytes = read_file(source.path);
      if (!bytes || hash128(bytes->bytes()) != written) continue;
      identity = bytes->identity();
    }
    if (identity) deck.on_disk->files[plans[i].file] = {*identity, written, text.by_file[plans[i].file].empty()};
  }
}

std::string rounding_note(const Rounding& rounding) {
  char error[32];
  std::snprintf(error, sizeof error, "%.1e", rounding.largest_error);
  return std::to_string(rounding.count) + (rounding.count == 1 ? " coordinate was" : " coordinates were") +
         " rounded to what their columns hold, by " + error + " at most; first at " + rounding.first;
}

}  // namespace

Result<SaveReport> save(const Deck& deck, const Model& original, const Model& model, const fs::path& target) {
  const std::lock_guard lock(deck.on_disk->mutex);
  const Result<NewText> text = new_text(deck, original, model);
  if (!text) return fail(text.error());
  const bool in_place = same_file(target, deck.files[0].path);
  const Result<std::vector<Plan>> plans = in_place ? plan_in_place(deck, *text) : plan_elsewhere(deck, *text, target);
  if (!plans) return fail(plans.error());

  std::vector<PendingFile> pending;
  for (const Plan& plan : *plans) pending.push_back({plan.target, content_of(deck.files[plan.file], text->by_file[plan.file])});
  const Result<void> replaced = replace_files(pending);
  if (in_place) remember_written(deck, pending, *plans, *text, replaced.has_value());
  if (!replaced) return fail(replaced.error());

  SaveReport report;
  report.nodes_written = text->nodes;
  report.lines_changed = text->lines;
  for (const Plan& plan : *plans) report.files_written.push_back(plan.target);
  if (text->rounding.count > 0) report.notes.push_back(rounding_note(text->rounding));
  return report;
}

}  // namespace prismesh::mesh::deck
