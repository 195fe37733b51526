// The kiosk's connection to the model server: connects again when it is lost, asks without waiting, keeps the current generation, and
// carries one drag. Holds no state of the document that would be lost with it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/clock.h"
#include "ipc/model/client.h"
#include "kiosk/notices/deck_warnings.h"
#include "kiosk/notices/notice.h"
#include "kiosk/notices/trace.h"

namespace prismesh::kiosk::link {

/// Whether an edit of this name changes the selection only.
bool is_selecting(std::string_view edit);
/// Whether it relaxes or repairs the mesh: then its report is always a notice.
bool is_mending(std::string_view edit);
/// Whether it failed because a client asked it to stop.
bool was_stopped(const ipc::Failed& failed);

/// A drag as the model server works on it.
class RemoteDrag {
 public:
  explicit RemoteDrag(mesh::document::Edit edit) : edit_(std::move(edit)) {}

  bool begun() const { return begun_.has_value(); }
  const ipc::DragBegun& facts() const { return *begun_; }
  const ipc::PreviewReader& preview() const { return *reader_; }
  /// Its newest preview frame; sequence 0: none yet.
  const ipc::PreviewFrame& frame() const { return frame_; }

 private:
  friend class ModelLink;
  enum class Wish : std::uint8_t { hold, commit, cancel };

  mesh::document::Edit edit_;
  std::optional<ipc::DragBegun> begun_;
  std::optional<ipc::PreviewReader> reader_;
  ipc::PreviewFrame frame_;
  mesh::document::Displacement wanted_;  ///< by the hand
  bool moved_ = false;                   ///< since the last step was sent
  std::uint64_t sequence_ = 0;           ///< of the last step sent
  std::int64_t sent_ns_ = 0;
  Wish wish_ = Wish::hold;
  bool end_sent_ = false;
  std::optional<std::uint64_t> made_;  ///< the generation that it made; the preview stays until that is here
};

class ModelLink {
 public:
  /// `deck`: opened as soon as there is a server, unless it has it open already.
  ModelLink(std::filesystem::path socket, std::optional<std::filesystem::path> deck, Clock& clock, notices::Trace trace);

  /// Connects when it is time to, reads what has arrived, fetches a new generation, sends the drag's next step.
  void turn();
  /// For poll(2); negative while there is no connection.
  int descriptor() const { return client_ ? client_->descriptor() : -1; }
  /// How long `turn` isn't needed unless the descriptor becomes readable, ms; negative: forever.
  int patience_ms() const;
  /// Counts up with each event that may change the picture or the panels.
  std::uint64_t changes() const { return changes_; }

  using Then = std::function<void(const ipc::Answer&)>;

  bool connected() const { return client_.has_value(); }
  const std::filesystem::path& socket() const { return socket_; }
  const std::optional<ipc::DocumentState>& state() const { return state_; }
  /// Of the deck that is open, the worst first.
  const std::vector<notices::ToldWarning>& warnings() const { return warnings_; }
  /// The current generation; null while no document is open. Stays while the server is away.
  const std::shared_ptr<const ipc::SnapshotView>& snapshot() const { return snapshot_; }
  /// Counts up each time that another document is opened.
  std::uint64_t document_number() const { return document_number_; }
  /// No newer generation is known or requested.
  bool up_to_date() const { return !stale_ && !fetching_; }
  /// The edit that made the current generation, if this client was told.
  const std::string& made_by() const { return made_by_; }
  const std::string& busy() const { return busy_; }
  double busy_fraction() const { return busy_fraction_; }

  /// What happens to unsaved edits of the document that is open: they are in the way, are dropped, or stay in their journal until that
  /// deck is opened again.
  enum class Unsaved : std::uint8_t { refuse, discard, keep };
  void open(const std::filesystem::path& deck, Unsaved unsaved = Unsaved::refuse);
  /// Closes the document and drops its unsaved edits. `then` gets the answer.
  void close(Then then);
  /// A deck that the server refused to open because of unsaved edits; each is returned once.
  std::optional<std::filesystem::path> take_refused() { return std::exchange(refused_, std::nullopt); }
  /// `remark`: added to the notice about the saving. `then` gets the answer last.
  void save(const ipc::Save& request, const std::string& remark, Then then);
  void edit(mesh::document::Edit edit);
  bool editing() const { return edits_ > 0; }
  /// A request of this client (opening, saving, an edit, a field) takes so long that the server tells its progress.
  bool can_stop() const { return long_ > 0 && !busy_.empty(); }
  /// Asks the server to stop it. A request that was stopped has no effect; with `keep`, a repair keeps what it has reached.
  void stop(bool keep = false);

  /// Sends a request that changes nothing. `then` gets the answer; never, if the connection ends before.
  void question(const ipc::Request& request, Then then);
  // Take what came with an answer to a question.
  Result<std::shared_ptr<const ipc::FieldValues>> take(const ipc::FieldMade& made) { return client_->take_field(made); }
  Result<std::shared_ptr<const ipc::SnapshotView>> take(const ipc::Snapshot& snapshot) { return client_->take_snapshot(snapshot); }
  /// For GetSnapshot: the segments that are here already.
  std::vector<std::uint64_t> segments() const { return client_ ? client_->segments() : std::vector<std::uint64_t>(); }
  /// Tells the other kiosks this one's camera.
  void share_camera(const ipc::Camera& camera);
  /// The newest camera of another kiosk; each is returned once.
  std::optional<ipc::Camera> take_camera() { return std::exchange(camera_, std::nullopt); }
  /// Counts up with each connection: questions asked on an older one get no answer.
  std::uint64_t connections() const { return connections_; }

  /// How many entities an expression names: the server's newest answer.
  struct Count {
    std::string expr;
    mesh::select::EntityKind kind = mesh::select::EntityKind::node;
    std::optional<ipc::Counted> counted;
    std::optional<ipc::Failed> failed;
  };
  /// Asks for a count. Sends one question at a time, and keeps only the newest of those that wait.
  void count(const std::string& expr, mesh::select::EntityKind kind);
  const std::optional<Count>& counted() const { return counted_; }

  /// Bytes that the states kept for undo and redo use, and their cap; 0: not known.
  std::uint64_t history_bytes() const { return history_bytes_; }
  std::uint64_t history_cap() const { return history_cap_; }

  /// A drag, from taking the handle until the server has answered its end. Steps may be skipped while the server is busy, but never the
  /// last one.
  void begin_drag(mesh::document::Edit edit);
  void pull(const mesh::document::Displacement& displacement);
  void commit_drag();
  void cancel_drag();
  const RemoteDrag* drag() const { return drag_ ? &*drag_ : nullptr; }

  std::vector<notices::Notice> take_notices() { return std::exchange(notices_, {}); }

 private:
  void try_connect();
  void lost(const Error& error);
  void ask(const ipc::Request& request, Then then);
  void read();
  void heard(const ipc::Event& event);
  void ask_state();
  void took_state(const ipc::DocumentState& state);
  void is_document(const std::string& path);
  void say_warnings();
  void say_recovered(const ipc::DocumentState& state);
  void took_opened(const ipc::Answer& answer, const std::filesystem::path& whole, const std::string& kept);
  void took_saved(const ipc::Saved& saved, bool becomes, const std::string& remark);
  void fetch_snapshot();
  void took_snapshot(const ipc::Answer& answer);
  void show(std::shared_ptr<const ipc::SnapshotView> view);
  void committed_drag(std::uint64_t generation);
  void drag_began(const ipc::Answer& answer);
  void turn_drag();
  void ask_count();
  void send_step();
  void drop_drag(const char* how);
  void say_failed(const ipc::Failed& failed, const std::string& if_stopped);
  void say_report(const mesh::document::EditReport& report);
  void say(notices::Notice::Kind kind, std::string text);

  std::filesystem::path socket_;
  std::optional<std::filesystem::path> deck_;     ///< what should be open
  bool opening_ = false;                          ///< the server was asked to open it and hasn't answered
  std::uint64_t recovered_said_ = 0;              ///< the connection whose recovered edits were announced
  std::optional<std::filesystem::path> refused_;  ///< not opened because of unsaved edits
  Clock& clock_;
  notices::Trace trace_;
  std::optional<ipc::Client> client_;
  struct Waiting {
    Then then;
    bool is_long = false;
  };
  std::map<std::uint64_t, Waiting> waiting_;
  std::int64_t next_attempt_ns_ = 0;
  std::int64_t back_off_ns_ = 0;
  std::optional<ipc::DocumentState> state_;
  std::shared_ptr<const ipc::SnapshotView> snapshot_;
  std::vector<notices::ToldWarning> warnings_;
  std::string document_path_;
  std::string becoming_;  ///< the name under which the document is being saved and will go on; empty: none
  std::uint64_t document_number_ = 0;
  std::string made_by_;
  bool stale_ = false;     ///< a newer generation exists
  bool fetching_ = false;  ///< a snapshot is requested and hasn't arrived
  bool fetched_ = false;   ///< the snapshot is of this connection
  std::string busy_;
  double busy_fraction_ = 0;
  std::optional<RemoteDrag> drag_;
  std::optional<Count> counted_;   ///< the newest answer
  std::optional<Count> to_count_;  ///< what shall be asked next
  bool counting_ = false;
  std::uint64_t history_bytes_ = 0, history_cap_ = 0;
  std::vector<notices::Notice> notices_;
  std::uint64_t changes_ = 0;
  std::uint64_t connections_ = 0;
  std::size_t edits_ = 0;  ///< that aren't answered yet
  std::size_t long_ = 0;   ///< requests that can be stopped and aren't answered yet, edits among them
  std::optional<ipc::Camera> camera_;
};

}  // namespace prismesh::kiosk::link
