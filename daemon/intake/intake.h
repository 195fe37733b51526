// prismesh-intake: the store, the rights and the HTTPS server together. It is the only process that faces the network; it parses no deck
// and connects to nobody.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "base/error.h"
#include "daemon/intake/access/access.h"
#include "daemon/intake/store/limits.h"
#include "daemon/intake/tls/server.h"

namespace prismesh::intake {

struct IntakeOptions {
  std::filesystem::path state_directory;  ///< of the key, tokens and audit log
  std::filesystem::path store;
  std::filesystem::path work;  ///< stored models are edited in folders beneath it
  ServerSettings server;
  StoreLimits store_limits;
  AccessLimits access_limits;
  std::vector<std::string> hosts;                 ///< names of the station, in small letters
  std::chrono::milliseconds scrub_every{10'000};  ///< one file each time
};

class Intake {
 public:
  /// Errors: another process has the folders, the key or a list is damaged, the address can't be listened at.
  static Result<std::unique_ptr<Intake>> start(const IntakeOptions& options);
  ~Intake();

  std::uint16_t port() const;
  const ipc::store::ContentHash& fingerprint() const;
  Access& access();
  /// A pairing code with the beginning of the fingerprint. An earlier one is void.
  std::string make_pairing_code(const PairingOffer& offer);
  /// Says what a reader found in a model; the catalogue's followers are told. `thumbnail`: a PNG; empty: the model keeps its own. On
  /// another thread, which then calls `then`. Errors: no such model, no thumbnail (is_thumbnail), the disk.
  void describe(const ipc::store::ContentHash& model, const ipc::store::ModelFigures& figures, std::string thumbnail,
                std::function<void(Result<void>)> then);

  /// Publishes what became of a model in a folder of `work`; on another thread, which then calls `then`. Errors: those of publish_folder.
  void publish_work(const std::string& folder, const ipc::store::ContentHash& derived_from,
                    std::function<void(Result<ipc::store::ContentHash>)> then);

  /// Called from another thread with the hash of each model that is published, described or removed. Before `run`.
  void on_change(std::function<void(const std::string& model)> told);

  /// Whether `run` has served in the last seconds. Safe to call from any thread.
  bool is_serving() const;

  /// Serves on the calling thread until `stop`, which any thread may call.
  void run();
  void stop();

 private:
  struct Impl;
  explicit Intake(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace prismesh::intake
