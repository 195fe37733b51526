// The kinds of bodies.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "daemon/intake/access/access.h"
#include "daemon/intake/api/body_taker.h"
#include "daemon/intake/api/figures.h"
#include "daemon/intake/api/store_thread.h"

namespace prismesh::intake {

/// A body that is read whole before anything is done with it; its route limits its length.
class SmallBody final : public BodyTaker {
 public:
  using Use = std::function<void(std::string body, const Respond& respond)>;
  explicit SmallBody(Use use) : use_(std::move(use)) {}
  void open(GoOn go_on) override { go_on(std::nullopt); }
  void piece(std::string bytes, GoOn go_on) override {
    body_ += bytes;
    go_on(std::nullopt);
  }
  void end(Respond respond) override { use_(std::move(body_), respond); }

 private:
  Use use_;
  std::string body_;
};

/// A chunk of an upload.
class ChunkBody final : public BodyTaker {
 public:
  ChunkBody(std::shared_ptr<StoreThread> store, Access& access, Figures& figures, WallClock now, Caller caller,
            std::shared_ptr<void> permit, std::string upload, std::uint64_t offset, std::optional<Checksum> checksum);
  ~ChunkBody() override;
  void open(GoOn go_on) override;
  void piece(std::string bytes, GoOn go_on) override;
  void end(Respond respond) override;

 private:
  /// Used by the store's thread.
  struct State {
    std::string upload;
    std::optional<std::uint64_t> chunk;
  };
  std::shared_ptr<StoreThread> store_;
  Access& access_;
  Figures& figures_;
  WallClock now_;
  Caller caller_;
  std::shared_ptr<void> permit_;
  std::uint64_t offset_;
  std::optional<Checksum> checksum_;
  std::shared_ptr<State> state_;
};

}  // namespace prismesh::intake
