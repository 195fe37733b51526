#include "mesh/deck/open.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "mesh/deck/assembly/assemble.h"
#include "mesh/deck/assembly/bounded_files.h"
#include "mesh/deck/assembly/file_set.h"
#include "mesh/deck/assembly/files_on_disk.h"
#include "mesh/deck/assembly/read_pieces.h"
#include "mesh/deck/data/derived.h"
#include "mesh/deck/data/on_disk.h"
#include "mesh/deck/detect.h"
#include "mesh/deck/findings.h"
#include "mesh/deck/formats/formats.h"
#include "mesh/deck/save_record.h"
#include "mesh/deck/text/number.h"
#include "mesh/model/adjacency.h"

namespace prismesh::mesh::deck {

namespace {

/// The share of unpacking in the progress.
constexpr double kUnpacked = 0.1;

/// A NUL byte among the first ones tells that a file isn't text.
constexpr std::size_t kBytesThatTell = 4096;

/// Entities are numbered with 32 bits.
constexpr std::size_t kMaxEntities = 0xfffffffeu;

/// The limit that the file passes with which the deck has too many nodes or elements.
std::optional<Error> exceeded(const DeckContents& found, const ReadingLimits& limits) {
  std::size_t nodes = 0;
  std::size_t elements = 0;
  for (const PieceCards& cards : found.cards) {
    nodes += cards.node_id.size();
    elements += cards.shells.id.size();
    for (const RawElements& of_class : cards.elements) elements += of_class.id.size();
    const auto refuse = [&](std::size_t limit, const char* what) {
      return Error{found.files[cards.file].path.string(), 0,
                   "with it the deck has more than the " + std::to_string(limit) + " " + what + " that are read of a deck here",
                   ErrorKind::over_limit};
    };
    if (nodes > limits.nodes) return refuse(limits.nodes, "nodes");
    if (elements > limits.elements) return refuse(limits.elements, "elements");
  }
  return std::nullopt;
}

std::optional<Error> first_error(const DeckContents& found) {
  std::size_t entities = 0;
  for (const PieceCards& cards : found.cards) {
    const SourceFile& file = found.files[cards.file];
    if (cards.error) return Error{file.path.string(), line_number(file.bytes.text(), cards.error->first), cards.error->second};
    entities += std::max(cards.node_id.size(), cards.shells.id.size());
  }
  if (entities >= kMaxEntities) return Error{found.files[0].path.string(), 0, "has more nodes or elements than this version can number"};
  return std::nullopt;
}

/// Warns of a deck that has no mesh because it stands in files that aren't read.
void note_mesh_elsewhere(const Deck& deck, const Model& model, Warnings& warnings) {
  if (model.node_count() > 0 || deck.unread_files.empty()) return;
  std::string names;
  for (const UnreadFile& unread : deck.unread_files)
    names += (names.empty() ? "" : ", ") + deck.files[unread.file].relative.generic_string();
  warnings.note("mesh-elsewhere", 0, 0,
                "the deck has no nodes of its own: its mesh stands in files that this version doesn't read (" + names + ")");
}

/// The model and the deck, complete, with the warnings about its saves. Errors: the first malformed card (file and line), too many
/// entities, cancelled.
Result<OpenedDeck> finish(DeckContents found, std::vector<Warning> of_saves, Watch& watch) {
  if (watch.stopped()) return fail(cancelled());
  if (std::optional<Error> error = first_error(found)) return fail(std::move(*error));

  auto deck = std::make_shared<Deck>();
  deck->format = found.format;
  deck->content = content_hash(found.files, found.hashes);
  deck->time_step = found.time_step;
  deck->contacts = std::move(found.contacts);
  deck->length_unit = found.length_unit;
  deck->frames = std::move(found.frames);
  deck->id_offsets = std::move(found.id_offsets);
  OpenedDeck opened;
  opened.model = assemble(found.cards, std::move(found.parts), *deck, found.warnings);
  if (std::optional<Error> error = first_error(found)) return fail(std::move(*error));
  deck->files = std::move(found.files);
  std::sort(deck->left_out_elements.begin(), deck->left_out_elements.end());
  deck->left_out_elements.erase(std::unique(deck->left_out_elements.begin(), deck->left_out_elements.end()), deck->left_out_elements.end());
  deck->last_ids = last_ids_of(*deck, opened.model);
  deck->on_disk = std::make_shared<OnDisk>();
  for (std::size_t i = 0; i < deck->files.size(); ++i)
    deck->on_disk->files.push_back({deck->files[i].bytes.identity(), found.hashes[i], true});
  deck->missing_files = std::move(found.missing_files);
  deck->companions = std::move(found.companions);
  deck->unread_files = std::move(found.unread_files);
  deck->taken.nodes.insert(deck->taken.nodes.end(), found.taken.nodes.begin(), found.taken.nodes.end());
  deck->taken.elements = std::move(found.taken.elements);
  unite(deck->taken.nodes);
  unite(deck->taken.elements);
  note_mesh_elsewhere(*deck, opened.model, found.warnings);
  for (const UnreadFile& unread : deck->unread_files) {
    const std::string_view text = deck->files[unread.file].bytes.text();
    const bool is_binary = text.substr(0, kBytesThatTell).find('\0') != std::string_view::npos;
    found.references.add(UnreadText{unread.keyword, unread.file, 0, text.size(), is_binary, {}});
  }
  found.references.finish();
  deck->references = std::make_shared<const References>(std::move(found.references));
  watch.tell(kAssembled);
  if (watch.stopped()) return fail(cancelled());
  opened.model.adjacency = std::make_shared<const Adjacency>(build_adjacency(opened.model));
  note_findings(*deck, opened.model, found.warnings);
  deck->warnings = found.warnings.finish(deck->files);
  deck->warnings.insert(deck->warnings.end(), std::make_move_iterator(of_saves.begin()), std::make_move_iterator(of_saves.end()));
  watch.tell(1);
  if (watch.stopped()) return fail(cancelled());
  opened.deck = std::move(deck);
  return opened;
}

/// `path`: the main file. `of_saves`: warnings about saves that were cut off.
Result<OpenedDeck> read_deck(const std::filesystem::path& path, BoundedFiles& reading, const ReadingLimits& limits,
                             const StandIns& stand_ins, std::vector<Warning> of_saves, const Progress& progress) {
  const Progress unpacking = [&](double fraction) { return !progress || progress(kUnpacked * fraction); };
  Result<FileSet> files = FileSet::begin(path, reading, stand_ins, unpacking);
  if (!files) return fail(std::move(files.error()));
  const Detected detected = detect_format(files->files[0].bytes.text());
  if (!detected.format) return fail(path.string(), "is no deck: it looks like " + detected.looks_like);
  Watch watch(progress);
  Result<DeckContents> found = read(*detected.format, std::move(*files), watch);
  if (reading.exceeded()) return fail(*reading.exceeded());
  if (!found) return fail(std::move(found.error()));
  if (std::optional<Error> error = exceeded(*found, limits)) return fail(std::move(*error));
  return finish(std::move(*found), std::move(of_saves), watch);
}

}  // namespace

Result<OpenedDeck> open(const std::filesystem::path& path, const Progress& progress, const StandIns& stand_ins) {
  if (progress && !progress(0)) return fail(cancelled());
  CutOffSave cut_off;
  if (stand_ins.empty()) {
    Result<CutOffSave> settled = settle_cut_off_save(path);
    if (!settled) return fail(std::move(settled.error()));
    cut_off = std::move(*settled);
  }
  const FilesOnDisk on_disk;
  BoundedFiles reading(on_disk, {});
  return read_deck(path, reading, {}, stand_ins.empty() ? cut_off.stand_ins : stand_ins, std::move(cut_off.warnings), progress);
}

Result<OpenedDeck> open_within(const FileAccess& files, const ReadingLimits& limits, const std::filesystem::path& path,
                               const Progress& progress, const StandIns& stand_ins) {
  if (progress && !progress(0)) return fail(cancelled());
  BoundedFiles reading(files, limits);
  return read_deck(path, reading, limits, stand_ins, {}, progress);
}

}  // namespace prismesh::mesh::deck
