// The files of a model as they lie on this computer, before they are sent.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "base/file.h"
#include "ipc/store/manifest.h"
#include "ipc/wire/descriptor.h"

namespace prismesh::ipc::store {

/// A file of a model and where it lies here.
struct LocalFile {
  std::filesystem::path disk;
  std::string path;                                    ///< in the model
  std::optional<FileIdentity> as_read = std::nullopt;  ///< when the deck was read; nothing: it wasn't read
};

struct OpenedFile {
  Descriptor file;
  std::uint64_t bytes = 0;
};
/// Errors: it can't be read, is no file.
Result<OpenedFile> open_local(const std::filesystem::path& path);

/// Pieces of this size are hashed at once; the last of a file is shorter.
inline constexpr std::size_t kLocalPiece = std::size_t{4} << 20;

/// A content of a model, where it lies here.
struct LocalContent {
  std::filesystem::path disk;
  SetFile is;
};

struct LocalSet {
  Manifest manifest;
  std::string text;                    ///< the manifest's
  std::vector<LocalContent> contents;  ///< each once, as the files were given
};

/// Hashes the files. `main`: the path of the main file, one of `files`. `told`: called after each piece; false: stop. `seen`: called with
/// each piece, and with the place of its file in `files`. Errors: a file can't be read, or isn't the one
/// that was read; a path that a model can't have; stopped.
Result<LocalSet> hash_local(const std::vector<LocalFile>& files, const std::string& main, const std::function<bool()>& told,
                            const std::function<void(std::size_t file, std::string_view piece)>& seen = {});

}  // namespace prismesh::ipc::store
