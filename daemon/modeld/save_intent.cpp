#include "daemon/modeld/save_intent.h"

#include <algorithm>
#include <map>
#include <set>

#include "base/file.h"
#include "ipc/byte_stream.h"

namespace prismesh::modeld {

namespace {

using mesh::NodeIndex;
using mesh::Vec3;

constexpr std::uint64_t kMagic = 0x3145'5641'5352'5250;  // "PRRSAVE1"

struct MovedNode {
  std::uint64_t node = 0;
  std::int64_t id = 0;
  std::array<double, 3> position{};
};

struct SaveIntent {
  Hash128 deck;                          ///< content of the whole deck before
  std::map<std::string, Hash128> files;  ///< by relative name: content before, of those that will be replaced
  std::vector<MovedNode> nodes;
};

Hash128 content_of(const mesh::deck::SourceFile& file) { return hash128(file.bytes.bytes()); }

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
  const auto nodes = in.get<std::uint64_t>();
  if (in.holds(nodes, sizeof(MovedNode))) intent.nodes.reserve(static_cast<std::size_t>(nodes));
  for (std::uint64_t i = 0; i < nodes && in.ok(); ++i) intent.nodes.push_back(in.get<MovedNode>());
  if (magic != kMagic || !in.ok() || !in.at_end()) return fail(path.string(), "the record of a save that was under way is damaged");
  return intent;
}

}  // namespace

Result<void> write_save_intent(const std::filesystem::path& path, const mesh::document::Document& document) {
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
  const std::string_view content(reinterpret_cast<const char*>(out.bytes().data()), out.bytes().size());
  const PendingFile file{path, {content}};
  return replace_files(std::span(&file, 1));
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
