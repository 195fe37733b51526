// The free edges that follow the next pull, or the one under way: asked from the model server, shown in the picture.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "ipc/model/snapshot.h"
#include "kiosk/link/remote_drag.h"
#include "mesh/document/edit.h"

namespace prismesh::kiosk::tools::shaping {

/// Of a larger selection the server isn't asked: the answer costs a pass over it.
inline constexpr std::uint64_t kMaxSelectionToAsk = 100'000;

/// The ends of edges where a snapshot has them, or where the newest frame of a drag on it has moved them. Nodes out of range are left out.
std::vector<std::array<mesh::Vec3, 2>> lines_of(const ipc::FollowedEdges& edges, const ipc::SnapshotView& snapshot,
                                                const link::RunningDrag* drag);

class FollowedEdges {
 public:
  explicit FollowedEdges(link::Connection& connection) : connection_(connection) {}

  /// Asks which edges follow this edit on this generation, unless that was the last question. Nothing: forgets the answer.
  void ask(const std::optional<mesh::document::Edit>& edit, std::uint64_t generation);
  /// The answer, if it is of this generation.
  const ipc::FollowedEdges* known(std::uint64_t generation) const {
    return found_ && found_->generation == generation ? &*found_ : nullptr;
  }

 private:
  link::Connection& connection_;
  std::string asked_;                        ///< the last question; empty: none
  std::uint64_t asked_on_ = 0;               ///< the connection
  std::uint64_t number_ = 0;                 ///< of it: older answers don't count
  std::optional<ipc::FollowedEdges> found_;  ///< the answer
};

}  // namespace prismesh::kiosk::tools::shaping
