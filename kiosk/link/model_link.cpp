#include "kiosk/link/model_link.h"

namespace prismesh::kiosk::link {

ModelLink::ModelLink(const std::filesystem::path& socket, const std::optional<std::filesystem::path>& deck_to_open, Clock& clock,
                     notices::Trace trace)
    : notices(number, trace),
      connection(socket, clock, trace, notices),
      document(connection, number, notices, trace),
      deck(deck_to_open, connection, document, number, notices, trace),
      history(connection),
      edits(connection, document, notices),
      drag(connection, document, notices, clock, trace),
      count(connection, trace),
      cameras(connection) {}

void ModelLink::turn() {
  connection.turn();
  document.turn();
  drag.turn();
}

int ModelLink::patience_ms() const {
  // Nothing announces a preview's next picture: while one is on its way, look again soon.
  return connection.connected() && drag.awaits_frame() ? 2 : connection.patience_ms();
}

}  // namespace prismesh::kiosk::link
