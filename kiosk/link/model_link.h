// The kiosk's link to the model server: its parts, which are made and turned together. Holds no state of the document that would be lost
// with it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "kiosk/link/edit_requests.h"
#include "kiosk/link/expression_count.h"
#include "kiosk/link/followed_history.h"
#include "kiosk/link/remote_drag.h"
#include "kiosk/link/shared_cameras.h"
#include "kiosk/link/wanted_deck.h"

namespace prismesh::kiosk::link {

struct ModelLink {
  /// `deck`: see WantedDeck.
  ModelLink(const std::filesystem::path& socket, const std::optional<std::filesystem::path>& deck, Clock& clock, notices::Trace trace);
  ModelLink(const ModelLink&) = delete;
  ModelLink& operator=(const ModelLink&) = delete;

  /// Connects when it is time to, reads what has arrived, fetches a new generation, sends the drag's next step.
  void turn();
  /// How long `turn` isn't needed unless the connection's descriptor becomes readable, ms; negative: forever.
  int patience_ms() const;
  /// Counts up with each event that may change the picture or the panels.
  std::uint64_t changes() const { return connection.changes() + drag.changes() + notices.changes(); }

  DocumentNumber number;
  LinkNotices notices;
  Connection connection;
  FollowedDocument document;
  WantedDeck deck;
  FollowedHistory history;
  EditRequests edits;
  RemoteDrag drag;
  ExpressionCount count;
  SharedCameras cameras;
};

}  // namespace prismesh::kiosk::link
