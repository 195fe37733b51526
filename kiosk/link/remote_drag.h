// A drag as the model server works on it.
#pragma once

#include <cstdint>
#include <optional>

#include "kiosk/link/followed_document.h"

namespace prismesh::kiosk::link {

/// What the server has told about a drag.
class RunningDrag {
 public:
  bool begun() const { return begun_.has_value(); }
  const ipc::DragBegun& facts() const { return *begun_; }
  const ipc::PreviewReader& preview() const { return *reader_; }
  /// Its newest preview frame; sequence 0: none yet.
  const ipc::PreviewFrame& frame() const { return frame_; }

 private:
  friend class RemoteDrag;
  std::optional<ipc::DragBegun> begun_;
  std::optional<ipc::PreviewReader> reader_;
  ipc::PreviewFrame frame_;
};

/// One drag, from taking the handle until the server has answered its end and what it made is here. Steps may be skipped while the server
/// is busy, but never the last one.
class RemoteDrag final : public ConnectionListener {
 public:
  RemoteDrag(Connection& connection, FollowedDocument& document, LinkNotices& notices, Clock& clock, notices::Trace trace);

  void begin(mesh::document::Edit edit);
  void pull(const mesh::document::Displacement& displacement);
  void commit();
  void cancel();
  /// Null: there is no drag.
  const RunningDrag* running() const { return drag_ ? &drag_->told : nullptr; }

  /// Reads the newest frame, and sends the next step or the end.
  void turn();
  /// A frame is on its way, which nothing will announce.
  bool awaits_frame() const { return drag_ && drag_->told.begun() && !drag_->end_sent && drag_->told.frame().sequence < drag_->sequence; }
  /// Counts up with each frame, and when the drag is over.
  std::uint64_t changes() const { return changes_; }

  void heard(const ipc::Event& event) override;
  void lost() override { drop("lost"); }

 private:
  enum class Wish : std::uint8_t { hold, commit, cancel };
  struct Drag {
    RunningDrag told;
    mesh::document::Edit edit;            ///< its displacement is ignored
    mesh::document::Displacement wanted;  ///< by the hand
    bool moved = false;                   ///< since the last step was sent
    std::uint64_t sequence = 0;           ///< of the last step sent
    std::int64_t sent_ns = 0;
    Wish wish = Wish::hold;
    bool end_sent = false;
    std::optional<std::uint64_t> made;  ///< the generation that it made; the preview stays until that is here
  };

  void began(const ipc::Answer& answer);
  void send_step();
  void send_commit();
  void committed(const ipc::Edited& edited);
  void fetched(std::optional<std::uint64_t> generation);
  void drop(const char* how);

  Connection& connection_;
  FollowedDocument& document_;
  LinkNotices& notices_;
  Clock& clock_;
  notices::Trace trace_;
  std::optional<Drag> drag_;
  std::uint64_t changes_ = 0;
};

}  // namespace prismesh::kiosk::link
