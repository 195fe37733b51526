#include "daemon/modeld/save_intent.h"

#include <algorithm>
#include <deque>
#include <map>
#include <set>

#include "base/compression.h"
#include "base/file.h"
#include "ipc/byte_stream.h"
#include "mesh/deck/text_changes.h"
#include "mesh/model/growth.h"

namespace prismesh::modeld {

namespace {

using mesh::NodeIndex;
using mesh::Vec3;

constexpr std::uint64_t kMagic = 0x3145'5641'5352'5250;        // "PRRSAVE1": nodes that move
constexpr std::uint64_t kMagicOfText = 0x3245'5641'5352'5250;  // "PRRSAVE2": changes of the files' texts

struct MovedNode {
  std::uint64_t node = 0;
  std::int64_t id = 0;
  std::array<double, 3> position{};
};

struct SaveIntent {
  Hash128 deck;                          ///< content of the whole deck before
  std::map<std::string, Hash128> files;  ///< by relative name: content before, of those that will be replaced
  std::vector<MovedNode> nodes;
  /// By relative name, where nodes or shells come or go: a deck of which only some files were replaced has other indices than before, so
  /// what the rest is to say is kept as text.
  std::map<std::string, std::vector<mesh::deck::Replacement>> texts;
};

Hash128 content_of(const mesh::deck::SourceFile& file) { return hash128(file.bytes.bytes()); }

void read_texts(ipc::ByteReader& in, SaveIntent& intent) {
  const auto files = in.get<std::uint64_t>();
  for (std::uint64_t i = 0; i < files && in.ok(); ++i) {
    std::vector<mesh::deck::Replacement>& replacements = intent.texts[in.text()];
    const auto count = in.get<std::uint64_t>();
    for (std::uint64_t r = 0; r < count && in.ok(); ++r) {
      const auto offset = in.get<std::uint64_t>(), length = in.get<std::uint64_t>();
      replacements.push_back({static_cast<std::size_t>(offset), static_cast<std::size_t>(length), in.text()});
    }
  }
}

Result<void> write_whole(const std::filesystem::path& path, const ipc::ByteWriter& out) {
  const std::string_view content(reinterpret_cast<const char*>(out.bytes().data()), out.bytes().size());
  const PendingFile file{path, {content}};
  return replace_files(std::span(&file, 1));
}

Result<void> write_text_intent(const std::filesystem::path& path, const mesh::document::Document& document, const Progress& progress) {
  const mesh::deck::Deck& deck = *document.deck;
  const Result<mesh::deck::TextChanges> changes =
      mesh::deck::text_changes(deck, document.opened->model, document.current().model, progress);
  if (!changes) return fail(changes.error());
  std::vector<std::size_t> files;
  for (std::size_t f = 0; f < changes->by_file.size(); ++f)
    if (!changes->by_file[f].empty()) files.push_back(f);
  ipc::ByteWriter out;
  out.put(kMagicOfText);
  out.put(deck.content);
  out.put(std::uint64_t{files.size()});
  for (const std::size_t file : files) {
    out.put(deck.files[file].relative.string());
    out.put(content_of(deck.files[file]));
  }
  out.put(std::uint64_t{files.size()});
  for (const std::size_t file : files) {
    out.put(deck.files[file].relative.string());
    out.put(std::uint64_t{changes->by_file[file].size()});
    for (const mesh::deck::Replacement& replacement : changes->by_file[file]) {
      out.put(std::uint64_t{replacement.offset});
      out.put(std::uint64_t{replacement.length});
      out.put(replacement.text);
    }
  }
  return write_whole(path, out);
}

/// Writes the files that still are as they were before, includes first.
Result<SaveOutcome> finish_texts(const SaveIntent& intent, const mesh::deck::Deck& deck, const std::set<std::uint32_t>& unreplaced) {
  std::deque<std::string> packed;
  std::vector<PendingFile> pending;
  const auto add = [&](std::uint32_t f) -> Result<void> {
    const mesh::deck::SourceFile& file = deck.files[f];
    const auto known = intent.texts.find(file.relative.string());
    if (known == intent.texts.end()) return {};
    const std::string_view text = file.bytes.text();
    std::vector<std::string_view> pieces;
    std::size_t at = 0;
    for (const mesh::deck::Replacement& replacement : known->second) {
      if (replacement.offset < at || replacement.offset > text.size() || replacement.length > text.size() - replacement.offset)
        return fail(file.path.string(), "the record of a save that was under way doesn't fit this file");
      pieces.push_back(text.substr(at, replacement.offset - at));
      pieces.emplace_back(replacement.text);
      at = replacement.offset + replacement.length;
    }
    pieces.push_back(text.substr(at));
    if (file.bytes.is_packed()) {
      Result<std::string> anew = pack(pieces, file.bytes.bytes());
      if (!anew) return fail(anew.error());
      packed.push_back(std::move(*anew));
      pieces = {packed.back()};
    }
    pending.push_back({file.path, std::move(pieces)});
    return {};
  };
  for (const std::uint32_t f : unreplaced)
    if (f != 0)
      if (const Result<void> added = add(f); !added) return fail(added.error());
  if (unreplaced.contains(0))
    if (const Result<void> added = add(0); !added) return fail(added.error());
  if (const Result<void> written = replace_files(pending); !written) return fail(written.error());
  return SaveOutcome::finished;
}

Result<SaveIntent> read_intent(const std::filesystem::path& path) {
  const Result<FileBytes> bytes = read_file(path);
  if (!bytes) return fail(bytes.error());
  ipc::ByteReader in(bytes->bytes());
  SaveIntent intent;
  const auto magic = in.get<std::uint64_t>();
  intent.deck = in.get<Hash128>();
  const auto files = in.get<std::uint64_t>();
  for (std::uint64_t i = 0; i < files && in.ok(); ++i) {
    const std::string name = in.text();
    intent.files[name] = in.get<Hash128>();
  }
  if (magic == kMagicOfText) {
    read_texts(in, intent);
    if (!in.ok() || !in.at_end()) return fail(path.string(), "the record of a save that was under way is damaged");
    return intent;
  }
  const auto nodes = in.get<std::uint64_t>();
  if (in.holds(nodes, sizeof(MovedNode))) intent.nodes.reserve(static_cast<std::size_t>(nodes));
  for (std::uint64_t i = 0; i < nodes && in.ok(); ++i) intent.nodes.push_back(in.get<MovedNode>());
  if (magic != kMagic || !in.ok() || !in.at_end()) return fail(path.string(), "the record of a save that was under way is damaged");
  return intent;
}

}  // namespace

bool has_grown(const mesh::document::Document& document) {
  return !mesh::changes_between(document.opened->model, document.current().model).empty();
}

Result<void> write_save_intent(const std::filesystem::path& path, const mesh::document::Document& document, const Progress& progress) {
  if (has_grown(document)) return write_text_intent(path, document, progress);
  const mesh::deck::Deck& deck = *document.deck;
  const mesh::Model& model = document.current().model;
  const std::vector<NodeIndex> moved = mesh::moved_nodes(document.opened->model, model);
  std::set<std::uint32_t> files;
  for (const NodeIndex node : moved) files.insert(deck.run_of(node).file);

  ipc::ByteWriter out;
  out.put(kMagic);
  out.put(deck.content);
  out.put(std::uint64_t{files.size()});
  for (const std::uint32_t file : files) {
    out.put(deck.files[file].relative.string());
    out.put(content_of(deck.files[file]));
  }
  out.put(std::uint64_t{moved.size()});
  for (const NodeIndex node : moved) {
    const Vec3& position = model.position(node);
    out.put(MovedNode{node.value, model.node_ids[node.value], {position.x(), position.y(), position.z()}});
  }
  return write_whole(path, out);
}

Result<SaveOutcome> settle_save(const std::filesystem::path& path, const std::filesystem::path& deck_path,
                                const mesh::deck::OpenedDeck& opened) {
  const Result<SaveIntent> intent = read_intent(path);
  if (!intent) return fail(intent.error());
  if (intent->deck == opened.deck->content) return SaveOutcome::not_begun;

  std::set<std::uint32_t> unreplaced;
  for (std::uint32_t f = 0; f < opened.deck->files.size(); ++f) {
    const auto before = intent->files.find(opened.deck->files[f].relative.string());
    if (before != intent->files.end() && before->second == content_of(opened.deck->files[f])) unreplaced.insert(f);
  }
  if (unreplaced.empty()) return SaveOutcome::complete;
  if (!intent->texts.empty()) return finish_texts(*intent, *opened.deck, unreplaced);
  mesh::Model model = opened.model;
  for (const MovedNode& moved : intent->nodes) {
    if (moved.node >= model.node_count() || model.node_ids[static_cast<std::size_t>(moved.node)] != moved.id) return SaveOutcome::unknown;
    const NodeIndex node(static_cast<std::size_t>(moved.node));
    if (unreplaced.contains(opened.deck->run_of(node).file))
      model.positions.set(node.value, Vec3(moved.position[0], moved.position[1], moved.position[2]));
  }
  const Result<mesh::deck::SaveReport> saved = mesh::deck::save(*opened.deck, opened.model, model, deck_path);
  if (!saved) return fail(saved.error());
  return SaveOutcome::finished;
}

}  // namespace prismesh::modeld
