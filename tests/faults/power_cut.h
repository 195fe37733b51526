// What a disk may hold after the power was cut in the middle of recorded file calls. What was flushed is there. Of what wasn't, each may be
// there or not: every 512 bytes of a write by itself, lengths, and the names that a folder holds (POSIX promises no more, and file systems
// do all of it).
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "tests/faults/file_calls.h"

namespace prismesh::test {

/// Files by path, with their content; folders by path, with nothing.
struct DiskState {
  std::string root;  ///< what all of it lies below
  std::map<std::string, std::string> files;
  std::vector<std::string> folders;
  bool operator==(const DiskState&) const = default;
};

/// What lies below a folder now.
DiskState disk_state_of(const std::filesystem::path& folder);
/// Makes its folder hold that and nothing else.
void restore(const DiskState& state);

enum class Survives : std::uint8_t {
  all,       ///< a killed program: what was written is there
  flushed,   ///< nothing that wasn't flushed
  in_order,  ///< of each folder's names the first few changes, of each file some sectors
  any,       ///< any of a folder's changes that still make sense, of each file some sectors
};

/// The disk after the first `count` of the calls, which began with `before`.
DiskState after_power_cut(const DiskState& before, std::span<const FileCall> calls, std::size_t count, Survives survives,
                          std::mt19937_64& random);

}  // namespace prismesh::test
