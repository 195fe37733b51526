// Keeps the distance field about the haptic pen: a thread that watches the pen's pose and the document's model, and publishes what
// mesh/field computes. See docs/distance-field.md.
#pragma once

#include <array>
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <thread>
#include <vector>

#include "base/clock.h"
#include "base/error.h"
#include "base/haptic_field.h"
#include "daemon/modeld/drag_session.h"
#include "ipc/model/messages.h"
#include "ipc/pen/haptic_field_page.h"
#include "ipc/pen/page.h"
#include "ipc/wire/descriptor.h"
#include "mesh/document/document.h"
#include "mesh/field/haptic_field.h"
#include "mesh/field/placement.h"
#include "mesh/spatial/box_tree.h"

namespace prismesh::modeld {

/// Errors: numbers that aren't finite or are too large, a turn that isn't a unit quaternion, a scale that isn't above 0.
Result<mesh::field::Placement> placement_of(const ipc::FollowPen& request);

/// `follow`, `leave`, `show` and `show_drag` may be called from any thread. None waits for a computation.
class PenField {
 public:
  PenField() : thread_([this](const std::stop_token& stop) { run(stop); }) {}
  /// Waits for the end of the field that is being computed.
  ~PenField() = default;
  PenField(const PenField&) = delete;
  PenField& operator=(const PenField&) = delete;

  /// Follows this pen from now on, instead of the one before. Returns the page to which fields are published; it stays the same until
  /// `leave`. Once this returns, no field of an earlier placement is published. Errors: no memory.
  Result<ipc::Descriptor> follow(ipc::PenPageReader pen, const mesh::field::Placement& placement, std::uint64_t number);
  /// Publishes nothing from now on.
  void leave();
  /// The field is of this document's current generation from now on; null: of no shells.
  void show(const std::shared_ptr<const mesh::document::Document>& document);
  /// The field is of this step of a drag of that generation from now on, and its worsening is felt as resistance; nothing: of the
  /// generation again.
  void show_drag(std::optional<DragFeel> feel);

  /// Fields that were computed.
  std::uint64_t computed() const { return computed_; }

 private:
  struct Followed {
    ipc::PenPageReader pen;
    mesh::field::Placement placement;
    std::uint64_t number = 0;  ///< of the placement
    std::shared_ptr<ipc::HapticFieldPage> page;
  };
  struct Shown {
    std::uint64_t count = 0;  ///< differs for each call of `show`
    std::shared_ptr<const mesh::document::Generation> generation;
    std::weak_ptr<const mesh::document::Generation> opened;  ///< tells documents apart
    std::optional<DragFeel> drag;                            ///< of the generation
  };
  /// What one turn of the thread works with.
  struct Turn {
    std::shared_ptr<const Followed> followed;
    Shown shown;
    std::int64_t now_ns = 0;
  };
  struct ShellState {
    mesh::spatial::BoxTree tree;
    std::uint64_t generation = 0;
  };

  void run(const std::stop_token& stop);
  void step(const Turn& turn);
  void take(const Shown& shown);
  std::shared_ptr<const mesh::Model> felt_model(const Shown& shown);
  void compute(const Turn& turn, const ipc::PenState& pen);
  bool publish(const Turn& turn, const HapticField& field);
  static HapticResistance resistance(const Turn& turn);
  const ShellState* state_of(std::uint64_t generation) const;
  void forget();

  std::mutex mutex_;  ///< of the next two, and held while a field is published
  std::shared_ptr<const Followed> followed_;
  Shown shown_;
  std::condition_variable_any wake_;
  std::atomic<std::uint64_t> computed_ = 0;

  // Of the thread.
  MonotonicClock clock_;
  std::uint64_t last_generation_ = 0;
  Shown taken_;  ///< without its generation
  /// The shells of a generation without those of hidden parts.
  struct FeltShells {
    std::uint64_t generation = 0;
    std::weak_ptr<const mesh::document::Generation> opened;
    mesh::ChunkedArray<mesh::ShellNodes> nodes;
  };
  std::optional<FeltShells> felt_shells_;
  std::shared_ptr<const mesh::Model> model_;  ///< whose shells the newest tree has; null: none
  std::vector<ShellState> states_;            ///< oldest first; the last one is the newest
  std::shared_ptr<const Followed> computed_for_;
  std::array<std::unique_ptr<HapticField>, 2> fields_;
  std::size_t front_ = 0;
  bool has_field_ = false;  ///< fields_[front_] was published, of this placement and document
  mesh::Vec3 place_mm_ = mesh::Vec3::Zero();
  mesh::spatial::FloatBox changed_;  ///< since that field
  HapticGuides guides_{};            ///< of that field

  std::jthread thread_;  ///< last member: the others must exist as long as it runs
};

}  // namespace prismesh::modeld
