#include "mesh/deck/lsdyna/include_frames.h"

#include <algorithm>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>

namespace prismesh::mesh::deck::lsdyna {
namespace {

using Eigen::Affine3d;

/// Transformations by nodes of includes that are transformed by nodes themselves. Real decks nest them less deeply.
constexpr int kMaxLookupDepth = 32;
constexpr double kMaxMatrixEntry = 1e60;
constexpr double kMaxCoordinate = 1e200;

std::uint32_t context_of(const PieceCards& cards) { return cards.node_runs.empty() ? 0 : cards.node_runs.front().frame; }

class Resolver {
 public:
  Resolver(std::span<const IncludeContext> contexts, const Transformations& transformations, std::span<PieceCards> cards,
           Warnings& warnings)
      : contexts_(contexts), transformations_(transformations), cards_(cards), warnings_(warnings), maps_(contexts.size()) {}

  std::vector<Frame> run() {
    std::vector<Frame> frames(contexts_.size());
    std::vector<bool> unusable(contexts_.size());
    for (std::uint32_t c = 1; c < contexts_.size(); ++c) {
      const std::optional<Affine3d> own = own_map(c, 0);
      const std::uint32_t parent = contexts_[c].parent;
      Affine3d& map = frames[c].to_basic;
      map = frames[parent].to_basic * own.value_or(Affine3d::Identity());
      unusable[c] = unusable[parent] || maps_[c].incomplete;
      if (map.matrix().cwiseAbs().maxCoeff() < kMaxMatrixEntry) continue;
      map = Affine3d::Identity();
      unusable[c] = true;
      warn(c, "moves things out of the range of numbers");
    }
    for (PieceCards& cards : cards_) {
      const std::uint32_t c = context_of(cards);
      if (c == 0) continue;
      cards.held |= unusable[c] || !to_card(frames[c], Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero());
      refuse_the_far(cards);
    }
    return frames;
  }

 private:
  enum class Progress : std::uint8_t { none, begun, done };
  struct IncludeMap {
    Progress progress = Progress::none;
    Affine3d own = Affine3d::Identity();  ///< from the include's system to that of the file that includes it
    bool incomplete = false;
  };
  struct PlacedNode {
    std::uint32_t context;
    Eigen::Vector3d position;
  };

  void warn(std::uint32_t c, const std::string& problem) {
    warnings_.note_each("unresolved-transformation", contexts_[c].file, contexts_[c].offset,
                        "transformation " + std::to_string(contexts_[c].transformation) + " of this include " + problem +
                            "; the include is shown without that, and its nodes can't be moved");
  }

  static void refuse_the_far(PieceCards& cards) {
    if (cards.error) return;
    for (std::size_t n = 0; n < cards.position.size(); ++n)
      if (!(cards.position[n].cwiseAbs().maxCoeff() < kMaxCoordinate)) {
        cards.error = {cards.node_offset[n], "a node of a transformed include stands too far away"};
        return;
      }
  }

  /// nullopt: it depends on itself, or too many others stand between.
  std::optional<Affine3d> own_map(std::uint32_t c, int depth) {
    IncludeMap& state = maps_[c];
    if (state.progress == Progress::done) return state.own;
    if (state.progress == Progress::begun || depth > kMaxLookupDepth) return std::nullopt;
    state.progress = Progress::begun;
    const IncludeContext& context = contexts_[c];
    Affine3d moved = Affine3d::Identity();
    if (context.transformation != 0) {
      if (const Transformation* transformation = find(context)) {
        const NodePlace place_of = [&](std::int64_t id, const Affine3d& so_far) { return place(c, id, so_far, depth); };
        ComposedTransformation composed = compose(*transformation, place_of);
        moved = composed.map;
        state.incomplete = !composed.problem.empty();
        if (state.incomplete) warn(c, composed.problem);
      } else {
        state.incomplete = true;
        warn(c, "isn't defined");
      }
    }
    state.own = moved * Eigen::Scaling(context.own_length);
    state.progress = Progress::done;
    return state.own;
  }

  /// The transformation's number counts in the including file first, then in the whole deck.
  const Transformation* find(const IncludeContext& context) const {
    const Transformation* own = transformations_.find(context.transformation + contexts_[context.parent].offsets.define);
    return own ? own : transformations_.find(context.transformation);
  }

  /// The position of a node in the system of the file that includes `c`. `so_far`: the steps before the one that names the node.
  std::optional<Eigen::Vector3d> place(std::uint32_t c, std::int64_t id, const Affine3d& so_far, int depth) {
    if (!places_) collect_places();
    const auto at = places_->find(id);
    if (at == places_->end()) return std::nullopt;
    Eigen::Vector3d position = at->second.position;
    std::uint32_t k = at->second.context;
    // Inner includes first, up to c itself, of whose transformation only `so_far` is known.
    while (k != 0 && k != c) {
      const std::optional<Affine3d> own = own_map(k, depth + 1);
      if (!own || maps_[k].incomplete) return std::nullopt;
      position = *own * position;
      k = contexts_[k].parent;
    }
    if (k == c) return so_far * (contexts_[c].own_length * position);
    std::vector<std::uint32_t> around;
    for (std::uint32_t parent = contexts_[c].parent; parent != 0; parent = contexts_[parent].parent) around.push_back(parent);
    for (auto parent = around.rbegin(); parent != around.rend(); ++parent) {
      const std::optional<Affine3d> own = own_map(*parent, depth + 1);
      if (!own) return std::nullopt;
      const std::optional<Eigen::Vector3d> inside = to_card({Frame::Kind::rectangular, *own}, position, position);
      if (!inside) return std::nullopt;
      position = *inside;
    }
    return position;
  }

  /// Holds the nodes that transformations are given by: moving one would move everything that the transformation places.
  void collect_places() {
    places_.emplace();
    for (const std::int64_t id : transformations_.nodes()) places_->emplace(id, PlacedNode{});
    std::unordered_map<std::int64_t, PlacedNode> found;
    for (PieceCards& cards : cards_)
      for (std::size_t n = 0; n < cards.node_id.size(); ++n) {
        if (!places_->contains(cards.node_id[n])) continue;
        found.emplace(cards.node_id[n], PlacedNode{context_of(cards), cards.position[n]});
        cards.holds.emplace_back(static_cast<std::uint32_t>(n), kHeldByFrame);
      }
    places_ = std::move(found);
  }

  std::span<const IncludeContext> contexts_;
  const Transformations& transformations_;
  std::span<PieceCards> cards_;
  Warnings& warnings_;
  std::vector<IncludeMap> maps_;
  std::optional<std::unordered_map<std::int64_t, PlacedNode>> places_;
};

}  // namespace

std::vector<Frame> include_frames(std::span<const IncludeContext> contexts, const Transformations& transformations,
                                  std::span<PieceCards> cards, Warnings& warnings) {
  return Resolver(contexts, transformations, cards, warnings).run();
}

}  // namespace prismesh::mesh::deck::lsdyna
