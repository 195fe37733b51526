// Asks the model server what an edit would do, and keeps its newest answer.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "kiosk/link/connection.h"

namespace prismesh::kiosk::link {

class EditPreview {
 public:
  explicit EditPreview(link::Connection& connection) : connection_(connection) {}

  struct Previewed {
    std::uint64_t number = 0;  ///< counts up with each question
    std::optional<ipc::EditPreviewed> would;
    std::string problem;  ///< why it can't be done
  };
  /// Asks about an edit; earlier questions are forgotten.
  void ask(const mesh::document::Edit& edit);
  void forget();
  /// The answer; nothing until it is here.
  const std::optional<Previewed>& previewed() const { return previewed_; }

 private:
  link::Connection& connection_;
  std::optional<Previewed> previewed_;
  std::uint64_t number_ = 0;
};

}  // namespace prismesh::kiosk::link
