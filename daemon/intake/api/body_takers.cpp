#include "daemon/intake/api/body_takers.h"

#include <utility>

#include "daemon/intake/api/refusal.h"
#include "daemon/intake/api/tus.h"

namespace prismesh::intake {

namespace {

HttpResponse of_tus(HttpResponse response) {
  response.headers.emplace_back("Tus-Resumable", kTusVersion);
  return response;
}

}  // namespace

ChunkBody::ChunkBody(std::shared_ptr<StoreThread> store, Access& access, Figures& figures, WallClock now, Caller caller,
                     std::shared_ptr<void> permit, std::string upload, std::uint64_t offset, std::optional<Checksum> checksum)
    : store_(std::move(store)),
      access_(access),
      figures_(figures),
      now_(std::move(now)),
      caller_(std::move(caller)),
      permit_(std::move(permit)),
      offset_(offset),
      checksum_(std::move(checksum)),
      state_(std::make_shared<State>(State{std::move(upload), std::nullopt})) {}

ChunkBody::~ChunkBody() {
  store_->run([state = state_](Store& store) {
    if (state->chunk) store.uploads().give_up_chunk(state->upload, *state->chunk);
  });
}

void ChunkBody::open(GoOn go_on) {
  store_->run([state = state_, who = caller_.name, offset = offset_, checksum = checksum_, go_on = std::move(go_on)](Store& store) {
    const Outcome<std::uint64_t> chunk = store.uploads().begin_chunk(who, state->upload, offset, checksum);
    if (!chunk) return go_on(of_tus(refusal_response(chunk.error())));
    state->chunk = *chunk;
    go_on(std::nullopt);
  });
}

void ChunkBody::piece(std::string bytes, GoOn go_on) {
  figures_.received_bytes += bytes.size();
  store_->run([state = state_, bytes = std::move(bytes), go_on = std::move(go_on)](Store& store) {
    const Outcome<void> added = store.uploads().add(state->upload, *state->chunk, bytes);
    go_on(added ? std::nullopt : std::optional(of_tus(refusal_response(added.error()))));
  });
}

void ChunkBody::end(Respond respond) {
  store_->run([&access = access_, state = state_, caller = caller_, now_s = now_(), respond = std::move(respond)](Store& store) {
    // The right may have gone since the request began.
    if (!access.still_may(caller, Scope::upload)) return respond(unauthorised());
    const Outcome<UploadStatus> ended = store.uploads().end_chunk(state->upload, *std::exchange(state->chunk, std::nullopt));
    respond(ended ? upload_response(204, *ended, now_s) : of_tus(refusal_response(ended.error())));
  });
}

}  // namespace prismesh::intake
