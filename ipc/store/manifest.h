// The manifest of a model in the store: which files it has, under which names, and what each holds. The SHA-256 of its text is the
// model's hash, so that whoever sends a model knows its hash beforehand. docs/remote.md has the format.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "ipc/store/sha256.h"

namespace prismesh::ipc::store {

inline constexpr std::size_t kMaxManifestBytes = std::size_t{1} << 20;
inline constexpr std::size_t kMaxSetFiles = 2000;
inline constexpr std::size_t kMaxSetPath = 1024;  ///< bytes
inline constexpr std::size_t kMaxSetDepth = 32;   ///< parts of a path

struct SetFile {
  ContentHash hash;
  std::uint64_t bytes = 0;
  std::string path;  ///< relative, with slashes, as the includes name it
  bool operator==(const SetFile&) const = default;
};

struct Manifest {
  std::string main;            ///< the path of the main file, one of `files`
  std::vector<SetFile> files;  ///< by path, ascending by bytes
  bool operator==(const Manifest&) const = default;

  std::uint64_t bytes() const;
};

/// Why a path can't be one of a set's, to stand behind it ("is absolute"); empty: it can. A path is relative UTF-8 text without control
/// characters, `.`, `..`, empty parts and backslashes.
std::string path_fault(std::string_view path);

/// The one text of a manifest whose paths are sound and in order.
std::string encode_manifest(const Manifest& manifest);

/// Errors, with line: it isn't exactly what encode_manifest writes; a path is refused, comes twice, or is a folder of another; the main
/// file isn't one of the files; limits above. The sum of the sizes fits 63 bits.
Result<Manifest> decode_manifest(std::string_view text);

/// SHA-256 of the text.
ContentHash model_hash(std::string_view manifest_text);

}  // namespace prismesh::ipc::store
