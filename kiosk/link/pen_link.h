// The kiosk between the pen's process and modeld: connects to the pen's process, hands its state page to modeld, and modeld's page of
// distances to it. Makes each connection again when it is lost. Never waits; reading the pen's page costs no call.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "ipc/pen/client.h"
#include "kiosk/link/connection.h"

namespace prismesh::kiosk::link {

/// Where the model is in the pen's space: pen_mm = scale * turn * position + shift_mm.
struct PenPlace {
  std::array<double, 4> turn{1, 0, 0, 0};  ///< a unit quaternion, real part first
  std::array<double, 3> shift_mm{};
  double scale = 1;            ///< millimetres of the pen for one length of the deck
  std::uint64_t document = 0;  ///< FollowedDocument::number of what is there
  bool operator==(const PenPlace&) const = default;
};

class PenLink final : public ConnectionListener {
 public:
  static constexpr std::int64_t kPlacePeriodNs = 100'000'000;  ///< at least so long from one place to the next

  /// `socket`: of the pen's process.
  PenLink(const std::filesystem::path& socket, Connection& model, Clock& clock, notices::Trace trace);

  /// Connects when it is time to, reads what has arrived, and tells modeld another place.
  void turn();
  /// For poll(2); negative while there is no connection.
  int descriptor() const { return client_ != nullptr ? client_->descriptor() : -1; }
  bool is_connected() const { return client_ != nullptr; }

  /// A pen is configured. Without one modeld isn't asked for anything.
  bool has_pen() const { return info_ && !info_->kind.empty(); }
  /// The pen as its process words it; empty without that process.
  const std::optional<ipc::PenInfo>& info() const { return info_; }
  /// The page as it is now; empty without a pen.
  std::optional<ipc::PenState> state() const;
  /// Where the model is from now on. modeld follows the newest place, at most ten a second.
  void place(const PenPlace& place) { wanted_ = place; }

  void arm();
  void disarm();
  /// The newest refusal since the last call, in the words of the pen's process; empty: none.
  std::string take_refusal() { return std::exchange(refusal_, {}); }
  /// Counts up with each change of connection and words.
  std::uint64_t changes() const { return changes_; }

  void connected() override { forget_model(); }
  void lost() override { forget_model(); }

 private:
  void greet();
  void pen_lost(const Error& why);
  void take(const ipc::PenClient::Reply& reply);
  void take(const ipc::PenInfo& info);
  std::optional<std::uint64_t> send(const ipc::PenRequest& request);
  void follow();
  void followed(const ipc::Answer& answer);
  void forget_model();

  ipc::ReconnectingPenClient connection_;
  Connection& model_;
  Clock& clock_;
  notices::Trace trace_;
  ipc::PenClient* client_ = nullptr;  ///< good until the next turn
  std::size_t greeted_ = 0;           ///< connections that were asked about the pen
  std::optional<ipc::PenInfo> info_;
  std::set<std::uint64_t> arming_;  ///< requests whose refusal the user is told
  std::string refusal_;
  std::uint64_t changes_ = 0;

  std::optional<PenPlace> wanted_;
  std::optional<PenPlace> followed_;  ///< what modeld was told last, of this pen's process
  bool asking_ = false;               ///< modeld hasn't answered yet
  std::int64_t told_ns_ = 0;
  std::uint64_t number_;      ///< of the last place
  ipc::Descriptor attached_;  ///< the page that the pen's process reads; none: it has none of this modeld
};

}  // namespace prismesh::kiosk::link
