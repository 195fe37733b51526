// A station's settings as files beneath a root folder: what prismesh-setup reads and writes. Each function sets one thing by a rename,
// after everything is flushed to the disk: a power cut leaves the old or the new.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "base/error.h"
#include "ipc/setup/messages.h"

namespace prismesh::setup {

class StationFiles {
 public:
  /// `root`: "/" on a station.
  explicit StationFiles(std::filesystem::path root) : root_(std::move(root)) {}

  bool is_machine() const { return root_ == "/"; }
  std::filesystem::path at(std::string_view path) const { return root_ / path; }

  /// What is set. A file that can't be read counts as missing.
  ipc::StationSetup read() const;

  // Errors: the disk's; a file that somebody has written otherwise than it can be changed (says what to do).
  Result<void> set_name(const std::string& name) const;
  Result<void> set_network(const ipc::SetNetwork& network) const;
  Result<void> set_profile(const std::string& profile) const;
  /// `profile`: the text of a profile file that has passed ipc::check_calibration. Written anew from what was read of it.
  Result<void> set_calibration(const std::string& profile) const;
  Result<void> set_pairing(bool on) const;
  /// Errors also: there is no such zone.
  Result<void> set_zone(const std::string& zone) const;
  Result<void> keep_page(const std::string& page) const;
  Result<void> finish() const;

 private:
  std::filesystem::path root_;
};

/// The text of a file for systemd-networkd.
std::string network_text(const ipc::SetNetwork& network);
/// What it sets. Text that another program wrote gives what its lines of the same names say.
ipc::SetNetwork network_of(std::string_view text);
/// The text of /etc/hosts with another own name.
std::string hosts_text(std::string_view before, const std::string& name);

}  // namespace prismesh::setup
