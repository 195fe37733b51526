#include "mesh/deck/lsdyna/reader.h"

#include <atomic>
#include <optional>
#include <thread>

#include "base/parallel_for.h"
#include "mesh/deck/lsdyna/assemble.h"
#include "mesh/deck/lsdyna/walk.h"
#include "mesh/deck/on_disk.h"
#include "mesh/model/adjacency.h"

namespace prismesh::mesh::deck::lsdyna {
namespace {

// How far each phase brings the progress: about its share of the time.
constexpr double kWalked = 0.2;
constexpr double kRead = 0.6;
constexpr double kAssembled = 0.75;

/// Entities are numbered with 32 bits.
constexpr std::size_t kMostEntities = 0xfffffffeu;

/// Tells the progress from the thread that started the work only, and remembers that it was told to stop.
class Watch {
 public:
  explicit Watch(const Progress& progress) : progress_(progress), thread_(std::this_thread::get_id()) {}
  void tell(double fraction) {
    if (progress_ && std::this_thread::get_id() == thread_ && !progress_(fraction)) stopped_ = true;
  }
  bool stopped() const { return stopped_; }

 private:
  const Progress& progress_;
  std::thread::id thread_;
  std::atomic<bool> stopped_ = false;
};

struct MeshText {
  std::vector<PieceCards> cards;
  std::vector<Hash128> hashes;  ///< of the files
};

/// Reads all pieces and hashes all files.
MeshText read_mesh(const Walk& walk, Watch& watch) {
  MeshText out;
  out.cards.resize(walk.pieces.size());
  out.hashes.resize(walk.files.size());
  std::atomic<std::size_t> done = 0;
  const std::size_t jobs = walk.files.size() + walk.pieces.size();
  parallel_for(jobs, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t job = begin; job < end && !watch.stopped(); ++job) {
      if (job < walk.files.size()) {
        out.hashes[job] = hash128(walk.files[job].bytes.bytes());
      } else {
        const Piece& piece = walk.pieces[job - walk.files.size()];
        out.cards[job - walk.files.size()] = read_piece(walk.files[piece.file].bytes.text(), piece, walk.parameter_tables);
      }
      watch.tell(kWalked + (kRead - kWalked) * static_cast<double>(++done) / static_cast<double>(jobs));
    }
  });
  return out;
}

/// One hash over all files: their bytes' hashes and their names relative to the main file.
Hash128 content_hash(const std::vector<SourceFile>& files, const std::vector<Hash128>& hashes) {
  std::string all;
  for (std::size_t i = 0; i < files.size(); ++i) {
    all += hashes[i].hex();
    // The main file may be renamed without becoming another deck.
    if (i > 0) all += files[i].relative.generic_string();
    all += '\n';
  }
  return hash128(std::as_bytes(std::span(all)));
}

std::optional<Error> first_error(const Walk& walk, const std::vector<PieceCards>& cards) {
  std::size_t entities = 0;
  for (std::size_t p = 0; p < cards.size(); ++p) {
    const SourceFile& file = walk.files[walk.pieces[p].file];
    if (cards[p].error) return Error{file.path.string(), line_number(file.bytes.text(), cards[p].error->first), cards[p].error->second};
    entities += std::max(cards[p].node_id.size(), cards[p].shells.id.size());
  }
  if (entities >= kMostEntities) return Error{walk.files[0].path.string(), 0, "has more nodes or elements than this version can number"};
  return std::nullopt;
}

/// What is read with one walk; nullopt: there is an encrypted block among the mesh, so the walk has to look for them.
std::optional<Result<OpenedDeck>> read_once(Walk& walk, Watch& watch) {
  walk.run();
  watch.tell(kWalked);
  MeshText mesh = read_mesh(walk, watch);
  if (watch.stopped()) return fail(cancelled());
  for (const PieceCards& cards : mesh.cards)
    if (cards.encrypted) return std::nullopt;
  if (std::optional<Error> error = first_error(walk, mesh.cards)) return fail(std::move(*error));

  auto deck = std::make_shared<Deck>();
  deck->format = Format::ls_dyna;
  deck->content = content_hash(walk.files, mesh.hashes);
  deck->time_step = walk.definitions.time_step();
  OpenedDeck opened;
  opened.model = assemble(walk.pieces, mesh.cards, walk.definitions.parts(), *deck, walk.warnings);
  deck->files = std::move(walk.files);
  deck->on_disk = std::make_shared<OnDisk>();
  for (std::size_t i = 0; i < deck->files.size(); ++i)
    deck->on_disk->files.push_back({deck->files[i].bytes.identity(), mesh.hashes[i], true});
  deck->missing_files = std::move(walk.missing_files);
  deck->warnings = walk.warnings.finish(deck->files);
  watch.tell(kAssembled);
  if (watch.stopped()) return fail(cancelled());
  opened.model.adjacency = std::make_shared<const Adjacency>(build_adjacency(opened.model));
  watch.tell(1);
  if (watch.stopped()) return fail(cancelled());
  opened.deck = std::move(deck);
  return opened;
}

}  // namespace

Result<OpenedDeck> read(const std::filesystem::path& path, FileBytes main, const Progress& progress) {
  Watch watch(progress);
  Walk walk(path, std::move(main), false);
  std::optional<Result<OpenedDeck>> opened = read_once(walk, watch);
  if (opened) return std::move(*opened);
  Walk careful(path, std::move(walk.files[0].bytes), true);
  opened = read_once(careful, watch);
  if (opened) return std::move(*opened);
  return fail(path.string(), "has an encrypted block that begins but doesn't end");
}

}  // namespace prismesh::mesh::deck::lsdyna
