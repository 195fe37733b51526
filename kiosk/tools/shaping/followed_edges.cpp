#include "kiosk/tools/shaping/followed_edges.h"

#include <algorithm>

#include "ipc/model/messages_json.h"

namespace prismesh::kiosk::tools::shaping {

std::vector<std::array<mesh::Vec3, 2>> lines_of(const ipc::FollowedEdges& edges, const ipc::SnapshotView& snapshot,
                                                const link::RunningDrag* drag) {
  const bool moved = drag != nullptr && drag->begun() && drag->frame().sequence > 0;
  const auto place = [&](std::uint32_t node) -> mesh::Vec3 {
    if (!moved) return snapshot.position(node);
    const auto nodes = drag->preview().nodes();
    const auto found = std::lower_bound(nodes.begin(), nodes.end(), mesh::NodeIndex(node));
    const auto at = static_cast<std::size_t>(found - nodes.begin());
    return found != nodes.end() && found->value == node && at < drag->frame().positions.size() ? drag->frame().positions[at]
                                                                                               : snapshot.position(node);
  };
  std::vector<std::array<mesh::Vec3, 2>> lines;
  for (std::size_t i = 0; i + 1 < edges.nodes.size(); i += 2)
    if (edges.nodes[i] < snapshot.node_count() && edges.nodes[i + 1] < snapshot.node_count())
      lines.push_back({place(edges.nodes[i]), place(edges.nodes[i + 1])});
  return lines;
}

void FollowedEdges::ask(const std::optional<mesh::document::Edit>& edit, std::uint64_t generation) {
  const std::string question =
      edit ? ipc::encode_request(generation, ipc::FindFollowedEdges{*edit}).value_or(std::string()) : std::string();
  if (question == asked_ && asked_on_ == connection_.number()) return;
  asked_ = question;
  asked_on_ = connection_.number();
  ++number_;
  if (!edit) return found_.reset();
  connection_.question(ipc::FindFollowedEdges{*edit}, [this, number = number_](const ipc::Answer& answer) {
    if (number != number_) return;
    const auto* found = std::get_if<ipc::FollowedEdges>(&answer);
    found_ = found != nullptr ? std::optional(*found) : std::nullopt;
  });
}

}  // namespace prismesh::kiosk::tools::shaping
