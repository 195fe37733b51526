// What the model server is doing, and whether this client can stop it.
#pragma once

#include <cstddef>
#include <string>

#include "ipc/model/messages.h"

namespace prismesh::kiosk::link {

class ServerProgress {
 public:
  /// For the user; empty: nothing that takes long.
  const std::string& words() const { return words_; }
  double fraction() const { return fraction_; }
  /// Requests of this client that can be stopped and aren't answered yet.
  bool works_for_us() const { return asked_ > 0; }
  /// One of them takes so long that the server tells its progress.
  bool can_stop() const { return asked_ > 0 && !words_.empty(); }

  /// This client has sent a request that can be stopped, or has its answer.
  void asked() { ++asked_; }
  void answered();
  void begin_opening(const std::string& deck);
  void heard(const ipc::Event& event);
  /// It is over.
  void clear() { words_.clear(); }
  /// The connection is lost.
  void lost();

 private:
  std::string words_;
  double fraction_ = 0;
  std::size_t asked_ = 0;
};

}  // namespace prismesh::kiosk::link
