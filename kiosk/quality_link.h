// Questions about quality and about what an edit would do, asked of the model server one at a time, and its newest answers.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "kiosk/model_link.h"

namespace prismesh::kiosk {

class QualityLink {
 public:
  explicit QualityLink(ModelLink& link) : link_(link) {}

  /// What figures are wanted of.
  struct Wish {
    std::string metric;
    bool damaged = false;
    bool operator==(const Wish&) const = default;
  };
  /// Asks for the generation's figures unless they are here or on their way. To be called again with everything that is heard.
  void want(const Wish& wish, std::uint64_t generation);
  /// Nobody looks any more.
  void forget() {
    figures_.reset();
    refused_.reset();
  }
  /// The newest that have come; possibly of another wish or generation.
  const ipc::Quality* figures() const { return figures_ ? &*figures_ : nullptr; }
  bool up_to_date(const Wish& wish, std::uint64_t generation) const {
    return figures_ && figures_of_ == wish && figures_->generation == generation;
  }

  /// Selects the shells of a bar of the histogram.
  void select(const ipc::QualityBar& bar, const Wish& wish, mesh::document::SelectMode mode);

  struct Previewed {
    std::uint64_t number = 0;  ///< counts up with each
    std::optional<ipc::EditPreviewed> would;
    std::string problem;  ///< why it can't be done
  };
  /// Asks what an edit would do; earlier questions are forgotten.
  void preview(const mesh::document::Edit& edit);
  void forget_preview();
  /// The answer, once it is here.
  const std::optional<Previewed>& previewed() const { return previewed_; }

 private:
  ModelLink& link_;
  std::optional<ipc::Quality> figures_;
  Wish figures_of_;
  std::optional<std::pair<Wish, std::uint64_t>> refused_;  ///< of which generation: asking again would change nothing
  bool asking_ = false;
  std::uint64_t asked_on_ = 0;  ///< the connection that was asked: a newer one knows nothing of it
  std::optional<Previewed> previewed_;
  std::uint64_t preview_number_ = 0;
};

}  // namespace prismesh::kiosk
