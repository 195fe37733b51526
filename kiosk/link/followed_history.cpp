#include "kiosk/link/followed_history.h"

#include <algorithm>
#include <variant>

namespace prismesh::kiosk::link {

std::optional<std::size_t> FollowedHistory::place_of(std::uint64_t generation) const {
  const auto found = std::ranges::find(told_.generations, generation, &ipc::ListedGeneration::number);
  return found == told_.generations.end() ? std::nullopt : std::optional(static_cast<std::size_t>(found - told_.generations.begin()));
}

std::string_view FollowedHistory::maker_of(std::uint64_t generation) const {
  const auto maker_in = [&](const std::vector<ipc::ListedGeneration>& states) -> std::string_view {
    const auto found = std::ranges::find(states, generation, &ipc::ListedGeneration::number);
    return found == states.end() ? std::string_view() : found->made_by;
  };
  std::string_view maker = maker_in(told_.generations);
  for (auto branch = told_.branches.begin(); maker.empty() && branch != told_.branches.end(); ++branch)
    maker = maker_in(branch->generations);
  return maker;
}

void FollowedHistory::ask() {
  if (!stale()) return;
  stale_ = false;
  asking_ = true;
  connection_.question(ipc::GetHistory{}, [this](const ipc::Answer& answer) {
    asking_ = false;
    if (const auto* history = std::get_if<ipc::History>(&answer)) told_ = *history;
  });
}

void FollowedHistory::heard(const ipc::Event& event) {
  if (std::holds_alternative<ipc::DocumentOpened>(event) || std::holds_alternative<ipc::DocumentClosed>(event)) told_ = {};
  if (std::holds_alternative<ipc::DocumentOpened>(event) || std::holds_alternative<ipc::GenerationPublished>(event)) stale_ = true;
}

void FollowedHistory::lost() {
  told_ = {};
  stale_ = true;
  asking_ = false;
}

}  // namespace prismesh::kiosk::link
