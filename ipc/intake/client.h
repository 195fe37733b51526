// A client of prismesh-intake on the same machine: what the station's user does with it.
#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "base/error.h"
#include "ipc/intake/messages.h"
#include "ipc/wire/greeting_patience.h"

namespace prismesh::ipc {

/// The intake's socket in the runtime folder.
std::filesystem::path intake_socket_path(const std::optional<std::filesystem::path>& override = {});

class IntakeClient {
 public:
  /// Connects and exchanges hellos, waiting so long for the other's. Errors: nobody listens (names the socket and says how to start), or
  /// answers; other protocol version.
  static Result<IntakeClient> connect(const std::filesystem::path& socket, const std::string& program,
                                      std::chrono::milliseconds patience = kGreetingPatience);
  IntakeClient(IntakeClient&&) noexcept;
  IntakeClient& operator=(IntakeClient&&) noexcept;
  ~IntakeClient();

  /// Sends and waits for the answer. A Failed answer is an Error.
  Result<IntakeAnswer> call(const IntakeRequest& request, std::chrono::milliseconds patience = std::chrono::seconds(10));
  /// Reads what has arrived, at most `patience` waiting for the first byte. Errors: the daemon is gone.
  Result<void> poll(std::chrono::milliseconds patience = std::chrono::milliseconds(0));
  std::optional<IntakeEvent> next_event();
  int descriptor() const;  ///< for poll(2)

 private:
  struct Impl;
  explicit IntakeClient(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace prismesh::ipc
