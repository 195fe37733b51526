#include "mesh/deck/staged_save.h"

#include <algorithm>
#include <cstdio>
#include <deque>
#include <mutex>

#include "base/compression.h"
#include "mesh/deck/assembly/file_set.h"
#include "mesh/deck/data/deck.h"
#include "mesh/deck/data/derived.h"
#include "mesh/deck/data/on_disk.h"
#include "mesh/deck/editing/deck_card.h"
#include "mesh/deck/editing/text_changes.h"
#include "mesh/deck/editing/text_place.h"
#include "mesh/deck/formats/formats.h"
#include "mesh/model/topology_change.h"

namespace prismesh::mesh::deck {
namespace {

namespace fs = std::filesystem;

/// Shares of the progress: making new cards takes longer than writing files, and packing many times as long as both.
constexpr double kShareOfCards = 0.8;
constexpr double kShareOfCardsWithPacking = 0.2;
constexpr double kShareOfPacking = 0.7;

/// Stands for the content of a file that can't be read: no file has it.
constexpr Hash128 kUnreadable{1, 0};

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

/// The bytes of a file on disk. A packed file is packed again with its own method; an unchanged one keeps its bytes. `packed` owns the new
/// bytes.
Result<std::vector<std::string_view>> stored_content_of(const SourceFile& file, const std::vector<Replacement>& replacements,
                                                        std::deque<std::string>& packed, const Progress& progress) {
  if (!file.bytes.is_packed()) return content_of(file, replacements);
  const std::span<const std::byte> stored = file.bytes.bytes();
  if (replacements.empty()) return std::vector{std::string_view(reinterpret_cast<const char*>(stored.data()), stored.size())};
  Result<std::string> anew = pack(content_of(file, replacements), stored, progress);
  if (!anew) return fail(is_cancelled(anew.error()) ? anew.error() : Error{file.path.string(), 0, anew.error().message});
  packed.push_back(std::move(*anew));
  return std::vector<std::string_view>{packed.back()};
}

bool same_file(const fs::path& a, const fs::path& b) {
  std::error_code error;
  if (fs::equivalent(a, b, error) && !error) return true;
  return fs::absolute(a, error).lexically_normal() == fs::absolute(b, error).lexically_normal();
}

/// One file that is going to be written.
struct FilePlan {
  std::size_t file = 0;  ///< in Deck::files; from its size on, the companions follow
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

Result<std::vector<FilePlan>> plan_in_place(const Deck& deck, const TextChanges& text) {
  std::vector<FilePlan> plans;
  for (const std::size_t file : writing_order(deck)) {
    OnDisk::File& known = deck.on_disk->files[file];
    if (Result<void> unchanged = check_unchanged(deck.files[file], known); !unchanged) return fail(unchanged.error());
    if (!text.by_file[file].empty() || !known.as_read) plans.push_back({file, deck.files[file].path});
  }
  return plans;
}

/// Whether an include's name, in another folder, would lead to the old file or to a wrong one.
bool stays_behind(const fs::path& relative) {
  return relative.is_absolute() || relative.begin() == relative.end() || *relative.begin() == "..";
}

/// Copies of the companions. One with an absolute name is found from everywhere; one that another card includes is copied as a file of the
/// deck.
Result<std::vector<FilePlan>> plan_companions(const Deck& deck, const fs::path& target) {
  std::vector<FilePlan> plans;
  for (std::size_t c = 0; c < deck.companions.size(); ++c) {
    const CompanionFile& companion = deck.companions[c];
    const bool is_of_deck =
        std::any_of(deck.files.begin(), deck.files.end(), [&](const SourceFile& file) { return same_file(file.path, companion.path); });
    if (companion.relative.is_absolute() || is_of_deck) continue;
    if (stays_behind(companion.relative))
      return fail(companion.path.string(),
                  "is a file that the deck names outside the main file's folder, so the deck can't be saved into another folder");
    const fs::path to = target.parent_path() / companion.relative;
    if (same_file(to, target))
      return fail(target.string(), "is the name of a file that the deck names itself (" + companion.relative.generic_string() +
                                       "); choose another name for the main file");
    if (!same_file(companion.path, to)) plans.push_back({deck.files.size() + c, to});
  }
  return plans;
}

Result<std::vector<FilePlan>> plan_elsewhere(const Deck& deck, const TextChanges& text, const fs::path& target) {
  const bool other_folder = !same_file(folder_of(target), folder_of(deck.files[0].path));
  std::vector<FilePlan> plans;
  if (other_folder) {
    Result<std::vector<FilePlan>> companions = plan_companions(deck, target);
    if (!companions) return companions;
    plans = std::move(*companions);
  }
  for (const std::size_t file : writing_order(deck)) {
    const SourceFile& source = deck.files[file];
    if (file != 0 && other_folder && stays_behind(source.relative))
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

Result<std::vector<FilePlan>> plan(const Deck& deck, const TextChanges& text, const fs::path& target) {
  if (!target.has_filename())
    return fail(target.string(), target.empty() ? "the name of the file to write is empty" : "names a folder; give a file's name");
  return same_file(target, deck.files[0].path) ? plan_in_place(deck, text) : plan_elsewhere(deck, text, target);
}

/// A file of the save with what is at its target now.
StagedSave::File found_before(const Deck& deck, const FilePlan& plan, const TextChanges& text, bool in_place) {
  StagedSave::File file;
  file.index = plan.file;
  file.as_read = plan.file >= deck.files.size() || text.by_file[plan.file].empty();
  if (in_place) {
    file.found = deck.on_disk->files[plan.file].identity;
    file.before = deck.on_disk->files[plan.file].content;
    return file;
  }
  if (const Result<FileIdentity> identity = identify_file(plan.target)) file.found = *identity;
  file.before = content_now(plan.target).value_or(kUnreadable);
  return file;
}

bool moves_nodes_only(const TextChanges& text) {
  const CardCounts& counts = text.counts;
  const std::size_t others = counts.nodes_added + counts.nodes_removed + counts.shells_changed + counts.shells_added +
                             counts.shells_removed + counts.elements_added + counts.shells_turned + text.set_cards;
  if (others > 0) return false;
  for (const std::vector<Replacement>& replacements : text.by_file)
    for (const Replacement& each : replacements)
      if (each.text.size() != each.length) return false;
  return true;
}

std::string rounding_note(const Rounding& rounding) {
  char error[32];
  std::snprintf(error, sizeof error, "%.1e", rounding.largest_error);
  return std::to_string(rounding.count) + (rounding.count == 1 ? " number was" : " numbers were") +
         " rounded to what their fields hold, by " + error + " at most; first at " + rounding.first;
}

/// Warns that sets in encrypted text don't get new nodes and shells.
std::string encrypted_note(const Deck& deck) {
  for (const UnreadText& unread : deck.references->unread())
    if (unread.encrypted)
      return "the encrypted text at " + place_of(deck, unread.file, unread.begin) +
             " may hold sets, which the new nodes and shells haven't joined";
  return "";
}

/// The progress of the part of the work from `begin` to `begin + share`.
Progress part_of(const Progress& progress, double begin, double share) {
  return [&progress, begin, share](double fraction) { return !progress || progress(begin + fraction * share); };
}

/// Files with their content, ready to be written. `packed` owns the bytes of packed files, `companions` those of companions.
Result<std::vector<PendingFile>> pending_files(const Deck& deck, const std::vector<FilePlan>& plans, const TextChanges& text,
                                               std::deque<std::string>& packed, std::deque<FileBytes>& companions,
                                               const Progress& progress) {
  std::vector<PendingFile> pending;
  for (const FilePlan& plan : plans) {
    const double part = 1 / static_cast<double>(plans.size());
    const Progress packing = part_of(progress, static_cast<double>(pending.size()) * part, part);
    if (plan.file >= deck.files.size()) {
      Result<FileBytes> bytes = read_file(deck.companions[plan.file - deck.files.size()].path);
      if (!bytes) return fail(bytes.error());
      companions.push_back(std::move(*bytes));
      pending.push_back({plan.target, {companions.back().text()}});
      continue;
    }
    Result<std::vector<std::string_view>> stored = stored_content_of(deck.files[plan.file], text.by_file[plan.file], packed, packing);
    if (!stored) return fail(stored.error());
    pending.push_back({plan.target, std::move(*stored)});
  }
  return pending;
}

SaveReport report_of(const Deck& deck, const TextChanges& text, const std::vector<FilePlan>& plans) {
  SaveReport report;
  report.nodes_written = text.counts.nodes_moved;
  report.nodes_added = text.counts.nodes_added;
  report.nodes_removed = text.counts.nodes_removed;
  report.shells_changed = text.counts.shells_changed;
  report.shells_added = text.counts.shells_added;
  report.shells_removed = text.counts.shells_removed;
  report.set_cards_changed = text.set_cards;
  report.lines_changed = text.lines;
  for (const FilePlan& plan : plans) report.files_written.push_back(plan.target);
  if (text.rounding.count > 0) report.notes.push_back(rounding_note(text.rounding));
  if (text.counts.shells_turned > 0)
    report.notes.push_back("the material angles of " + std::to_string(text.counts.shells_turned) +
                           (text.counts.shells_turned == 1 ? " shell" : " shells") +
                           " were turned with their first edges, to which they are taken to be relative");
  if (text.counts.nodes_added + text.counts.shells_added > 0)
    if (std::string note = encrypted_note(deck); !note.empty()) report.notes.push_back(std::move(note));
  return report;
}

}  // namespace

Result<StagedSave> StagedSave::write(const Deck& deck, const Model& original, const Model& model, const fs::path& target,
                                     const Progress& progress, const TextMaker& make_text) {
  const Result<CutOffSave> cut_off = settle_cut_off_save(target);
  if (!cut_off) return fail(cut_off.error());
  const std::lock_guard lock(deck.on_disk->mutex);
  const bool packs = std::any_of(deck.files.begin(), deck.files.end(), [](const SourceFile& file) { return file.bytes.is_packed(); });
  const double of_cards = packs ? kShareOfCardsWithPacking : kShareOfCards, before_writing = of_cards + (packs ? kShareOfPacking : 0);
  Result<TextChanges> text = make_text(deck, original, model, part_of(progress, 0, of_cards));
  if (!text) return fail(std::move(text.error()));
  StagedSave save;
  save.deck_ = &deck;
  save.target_ = target;
  save.in_place_ = same_file(target, deck.files[0].path);
  const Result<std::vector<FilePlan>> plans = plan(deck, *text, target);
  if (!plans) return fail(plans.error());

  for (const FilePlan& each : *plans) save.files_.push_back(found_before(deck, each, *text, save.in_place_));
  std::deque<std::string> packed;
  std::deque<FileBytes> companions;
  const Result<std::vector<PendingFile>> pending =
      pending_files(deck, *plans, *text, packed, companions, part_of(progress, of_cards, before_writing - of_cards));
  if (!pending) return fail(pending.error());
  Result<StagedFiles> staged = StagedFiles::write(*pending, part_of(progress, before_writing, 1 - before_writing));
  if (!staged) return fail(std::move(staged.error()));
  save.staged_ = std::move(*staged);
  for (std::size_t i = 0; i < plans->size(); ++i) save.files_[i].after = hash128((*pending)[i].pieces);
  save.report_ = report_of(deck, *text, *plans);
  save.text_ = std::move(*text);
  for (const Warning& warning : cut_off->warnings) save.add_note("of an earlier save: " + warning.message);
  return save;
}

Result<std::vector<fs::path>> StagedSave::targets(const Deck& deck, const Model& original, const Model& model, const fs::path& target,
                                                  const TextMaker& make_text) {
  const std::lock_guard lock(deck.on_disk->mutex);
  const Result<TextChanges> text = make_text(deck, original, model, {});
  if (!text) return fail(text.error());
  const Result<std::vector<FilePlan>> plans = plan(deck, *text, target);
  if (!plans) return fail(plans.error());
  std::vector<fs::path> places;
  for (const FilePlan& each : *plans) places.push_back(each.target);
  return places;
}

std::vector<std::pair<fs::path, fs::path>> StagedSave::waiting() const {
  std::vector<std::pair<fs::path, fs::path>> files;
  for (std::size_t i = staged_.in_place(); i < files_.size(); ++i)
    files.emplace_back(deck_->files[files_[i].index].path, staged_.files()[i].temporary);
  return files;
}

Result<OpenedDeck> StagedSave::open(const Progress& progress) const {
  StandIns stand_ins;
  for (auto& [file, by] : waiting()) stand_ins[canonical_name(file)] = by;
  return deck::open(deck_->files[0].path, progress, stand_ins);
}

std::optional<OpenedDeck> StagedSave::with_moved_nodes(const Model& original, const Model& model) const {
  if (!in_place_ || has_begun() || !moves_nodes_only(text_) || !changes_between(original, model).empty()) return std::nullopt;
  const OnDisk& known = *deck_->on_disk;
  for (std::size_t f = 0; f < deck_->files.size(); ++f)
    if (!known.files[f].as_read || (deck_->files[f].bytes.is_packed() && !text_.by_file[f].empty())) return std::nullopt;

  auto saved = std::make_shared<Deck>(*deck_);
  saved->on_disk = std::make_shared<OnDisk>();
  saved->on_disk->files = known.files;
  for (std::size_t i = 0; i < files_.size(); ++i) {
    const std::size_t f = files_[i].index;
    const FileIdentity& identity = staged_.files()[i].identity;
    saved->files[f].bytes = FileBytes::of_pieces(content_of(deck_->files[f], text_.by_file[f]), identity);
    saved->on_disk->files[f] = {identity, files_[i].after, true};
  }
  std::vector<Hash128> hashes;
  for (const OnDisk::File& file : saved->on_disk->files) hashes.push_back(file.content);
  saved->content = content_hash(saved->files, hashes);

  OpenedDeck opened{saved, original};
  const std::unique_ptr<const CardWriter> writer = card_writer(deck_->format);
  for (const NodeIndex node : moved_nodes(original, model)) {
    const DeckCard card = card_of(*saved, node);
    const std::optional<Vec3> at = writer->node_coordinates(card.ref());
    if (!at) return std::nullopt;
    opened.model.positions.set(node.value, to_basic(saved->frames[card.run.frame], *at));
  }
  return opened;
}

void StagedSave::tell_in_place(const Deck& saved) const {
  const std::lock_guard lock(saved.on_disk->mutex);
  for (std::size_t i = 0; i < staged_.in_place(); ++i) saved.on_disk->files[files_[i].index].identity = staged_.files()[i].identity;
}

void StagedSave::leave() {
  staged_.leave();
  record_.reset();
}

/// A single file is replaced at once; of several, a record tells whoever comes next.
Result<void> StagedSave::begin_record() {
  if (record_ || has_begun()) return {};
  if (files_.size() < 2) return SaveRecord::remove_earlier(target_);
  std::vector<ReplacedFile> replaced;
  for (std::size_t i = 0; i < files_.size(); ++i)
    replaced.push_back({staged_.files()[i].target, staged_.files()[i].temporary, files_[i].before, files_[i].after});
  Result<SaveRecord> record = SaveRecord::begin(target_, replaced);
  if (!record) return fail(std::move(record.error()));
  record_ = std::move(*record);
  return {};
}

/// Before the first file is replaced. In place, files that aren't written count as well: the deck would be no longer the one that was read.
Result<void> StagedSave::check_all() const {
  if (in_place_)
    for (std::size_t f = 0; f < deck_->files.size(); ++f)
      if (Result<void> unchanged = check_unchanged(deck_->files[f], deck_->on_disk->files[f]); !unchanged) return unchanged;
  for (std::size_t i = 0; i < files_.size(); ++i)
    if (Result<void> same = check_target(i); !same) return fail(same.error().file, same.error().message + ", and nothing was changed");
  return {};
}

Result<void> StagedSave::check_target(std::size_t at) const {
  const StagedFiles::File& place = staged_.files()[at];
  const Result<FileIdentity> now = identify_file(place.target);
  // A copy or a touch changes the times only; the bytes decide.
  if ((now && files_[at].found == *now) || content_now(place.target) == files_[at].before) return {};
  return fail(place.shown.string(), "was written by another program during the save; it isn't replaced");
}

Result<void> StagedSave::put_in_place() {
  const std::lock_guard lock(deck_->on_disk->mutex);
  if (!has_begun())
    if (Result<void> unchanged = check_all(); !unchanged) return unchanged;
  if (Result<void> begun = begin_record(); !begun) return begun;
  Result<void> placed = staged_.put_in_place([&](std::size_t at) { return check_target(at); });
  if (in_place_) remember_written();
  if (record_ && (placed || !has_begun())) {
    record_->end();
    record_.reset();
  }
  return placed;
}

Result<void> StagedSave::put_in_place_or_leave() {
  Result<void> placed = put_in_place();
  if (placed || !has_begun()) return placed;
  Error error = std::move(placed.error());
  if (in_place_ && take_back()) {
    error.message += "; the files that had been replaced were given back what they held before";
    return fail(std::move(error));
  }
  if (staged_.in_place() < files_.size()) error.message += ". The rest is put in place when the deck is opened or saved again";
  leave();
  return fail(std::move(error));
}

/// Notes the files that were replaced, which may be some of them only.
void StagedSave::remember_written() {
  for (std::size_t i = 0; i < staged_.in_place(); ++i)
    deck_->on_disk->files[files_[i].index] = {staged_.files()[i].identity, files_[i].after, files_[i].as_read};
}

Result<void> StagedSave::take_back() {
  const std::lock_guard lock(deck_->on_disk->mutex);
  std::vector<PendingFile> before;
  for (std::size_t i = staged_.in_place(); i-- > 0;) {
    const SourceFile& source = deck_->files[files_[i].index];
    const std::span<const std::byte> bytes = source.bytes.bytes();
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (hash128(bytes) != files_[i].before)
      return fail(source.path.string(), "can't be given back what it held: the deck was saved over before");
    const Result<FileIdentity> now = identify_file(source.path);
    if (!now || *now != staged_.files()[i].identity) return fail(source.path.string(), "has been changed by something else meanwhile");
    before.push_back({source.path, {text}});
  }
  if (Result<void> replaced = replace_files(before); !replaced) return replaced;
  for (std::size_t i = 0; i < staged_.in_place(); ++i) {
    const Result<FileIdentity> identity = identify_file(deck_->files[files_[i].index].path);
    if (identity) deck_->on_disk->files[files_[i].index] = {*identity, files_[i].before, true};
  }
  if (record_) record_->end();
  record_.reset();
  staged_ = {};
  return {};
}

}  // namespace prismesh::mesh::deck
