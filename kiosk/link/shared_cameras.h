// Tells the other kiosks this one's camera, and hears theirs.
#pragma once

#include <optional>
#include <utility>
#include <variant>

#include "kiosk/link/connection.h"

namespace prismesh::kiosk::link {

class SharedCameras final : public ConnectionListener {
 public:
  explicit SharedCameras(Connection& connection) : connection_(connection) { connection_.add(*this); }

  void share(const ipc::Camera& camera) { connection_.tell(ipc::ShareCamera{camera}); }
  /// The newest camera of another kiosk; each is returned once.
  std::optional<ipc::Camera> take() { return std::exchange(heard_, std::nullopt); }

  void heard(const ipc::Event& event) override {
    if (const auto* moved = std::get_if<ipc::CameraMoved>(&event)) heard_ = moved->camera;
  }

 private:
  Connection& connection_;
  std::optional<ipc::Camera> heard_;
};

}  // namespace prismesh::kiosk::link
