// The stations that this user's computer is paired with, and their tokens: a folder that only the user may enter.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "ipc/remote/station_address.h"
#include "ipc/store/folder.h"
#include "ipc/store/sha256.h"

namespace prismesh::ipc::remote {

struct PairedStation {
  std::string name;  ///< its address as text: "station.example.com:7443"
  StationAddress address;
  store::ContentHash fingerprint;  ///< SHA-256 of its certificate
  std::string token;
  std::string token_name;
  std::vector<std::string> scopes;
  std::int64_t expires_s = 0;  ///< since 1970
};

class StationBook {
 public:
  /// `override`, else $XDG_CONFIG_HOME/prismesh/stations, else ~/.config/prismesh/stations; made if it is missing. Errors: there is no such
  /// place, it isn't the user's own.
  static Result<StationBook> open(const std::optional<std::filesystem::path>& override = {});

  /// By name. Errors: the file is damaged, or others may read it.
  Result<std::vector<PairedStation>> stations() const;
  /// `wanted`: an address; empty: the only one. Errors: there is none, or there are several; the sentence says which.
  Result<PairedStation> find(const std::string& wanted) const;
  /// In the place of one with that name.
  Result<void> keep(const PairedStation& station) const;
  /// Errors: there is no such station.
  Result<void> forget(const std::string& name) const;

  /// Where an upload that was begun goes on: the path that the station gave it, by what it is. Nothing: none is known.
  std::optional<std::string> upload(const store::ContentHash& what) const;
  Result<void> keep_upload(const store::ContentHash& what, const std::string& path) const;
  void forget_upload(const store::ContentHash& what) const;

 private:
  explicit StationBook(store::Folder folder) : folder_(std::move(folder)) {}
  Result<void> write(const std::vector<PairedStation>& stations) const;

  store::Folder folder_;
};

}  // namespace prismesh::ipc::remote
