#include "kiosk/display/kms/card.h"

#include <algorithm>

#include <fmt/format.h>

namespace prismesh::kiosk::display::kms {

std::string Mode::text() const { return fmt::format("{}x{} at {:.2f} Hz", size.width, size.height, refresh_hz); }

std::optional<std::uint64_t> Property::value_named(const std::string& name) const {
  const auto found = std::find_if(names.begin(), names.end(), [&](const auto& named) { return named.first == name; });
  return found == names.end() ? std::nullopt : std::optional(found->second);
}

std::string Property::value_text() const {
  const auto found = std::find_if(names.begin(), names.end(), [&](const auto& named) { return named.second == value; });
  return found == names.end() ? std::to_string(value) : found->first;
}

}  // namespace prismesh::kiosk::display::kms
