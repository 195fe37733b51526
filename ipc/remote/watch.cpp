#include "ipc/remote/watch.h"

namespace prismesh::ipc::remote {

Result<void> watch(RemoteStation& remote, const std::function<void()>& connected, const std::function<void(const CatalogueEvent&)>& heard) {
  for (;;) {
    EventReader reader;
    bool is_first = true;
    const BodySink sink = [&](const HttpsAnswer&, std::string_view bytes) -> Result<void> {
      if (is_first) {
        is_first = false;
        remote.line_is_good();
        connected();
      }
      if (const Result<void> added = reader.add(bytes); !added) return added;
      while (const std::optional<CatalogueEvent> event = reader.next()) heard(*event);
      return {};
    };
    const LineResult<HttpsAnswer> answer = remote.ask_once({"GET", "/events", {{"Accept", "text/event-stream"}}, {}}, sink);
    if (remote.is_stopped()) return {};
    if (answer && answer->status != 200) return fail(remote.refusal(*answer, "events"));
    const LineFault ended = answer ? LineFault{Error{remote.station().name, 0, "ends the events"}, true} : answer.error();
    if (const Result<void> waited = remote.wait_after(ended); !waited) {
      if (remote.is_stopped()) return {};
      return waited;
    }
  }
}

}  // namespace prismesh::ipc::remote
