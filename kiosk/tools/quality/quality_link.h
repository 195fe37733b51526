// Asks the model server about quality, one question at a time, and keeps its newest answer.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "kiosk/link/model_link.h"

namespace prismesh::kiosk::tools::quality {

class QualityLink {
 public:
  /// `send`: makes an edit.
  QualityLink(link::ModelLink& link, std::function<void(mesh::document::Edit)> send) : link_(link), send_(std::move(send)) {}

  /// Which figures are wanted.
  struct Wish {
    std::string metric;
    bool damaged = false;
    bool operator==(const Wish&) const = default;
  };
  /// Asks for the generation's figures unless they are here or requested. Call it again after each message of the server.
  void want(const Wish& wish, std::uint64_t generation);
  /// Drops the figures, as the panel is closed.
  void forget() {
    figures_.reset();
    refused_.reset();
  }
  /// The newest figures; possibly of another wish or generation.
  const ipc::Quality* figures() const { return figures_ ? &*figures_ : nullptr; }
  bool up_to_date(const Wish& wish, std::uint64_t generation) const {
    return figures_ && figures_of_ == wish && figures_->generation == generation;
  }

  /// Selects the shells of a bar of the histogram.
  void select(const ipc::QualityBar& bar, const Wish& wish, mesh::document::SelectMode mode);

 private:
  link::ModelLink& link_;
  std::function<void(mesh::document::Edit)> send_;
  std::optional<ipc::Quality> figures_;
  Wish figures_of_;
  std::optional<std::pair<Wish, std::uint64_t>> refused_;  ///< of which generation: asking again would change nothing
  bool asking_ = false;
  std::uint64_t asked_on_ = 0;  ///< the connection that was asked: a newer one knows nothing of it
};

}  // namespace prismesh::kiosk::tools::quality
