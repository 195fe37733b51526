// The objects of a vault: their names, and the lists of a large file's pieces. docs/vault.md has the format.
//
//   pieces/HASH         bytes of files, up to 4 MiB, by their SHA-256
//   lists/HASH          the pieces of a larger file, by the file's SHA-256
//   names/MODEL/..      what people call a model, and its size; only shown
//   models/HASH         a model's manifest, by its SHA-256. It is written last: from then on the model is there
//
// No object is ever written with other bytes.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "ipc/store/local_files.h"
#include "ipc/store/record.h"
#include "ipc/store/sha256.h"

namespace prismesh::ipc::vault {

inline constexpr std::size_t kPieceBytes = store::kLocalPiece;
inline constexpr std::size_t kMaxListBytes = std::size_t{16} << 20;  ///< a file of 1 TB

inline constexpr std::string_view kModels = "models/";
inline constexpr std::string_view kNames = "names/";

std::string piece_object(const store::ContentHash& piece);
std::string list_object(const store::ContentHash& file);
std::string model_object(const store::ContentHash& model);
/// The model of models/HASH; nothing: it isn't one.
std::optional<store::ContentHash> model_of_object(std::string_view object);

/// Text that people can call a model by: it can be shown, and can't be meant as a hash.
bool is_model_name(std::string_view text);
/// names/MODEL/WHEN-BYTES-FILES-NAME, the name in hexadecimal digits: its text may have any sign. A `/` stands behind 200 of them, since
/// stores on file systems take no longer parts than 255 bytes.
std::string name_object(const store::ModelRecord& record);
/// Nothing: it isn't what `name_object` writes.
std::optional<store::ModelRecord> record_of_object(std::string_view object);

/// The time of a name, to compare with others of its model. One in the future counts as 0, so that no wrong clock names a model for good.
std::int64_t name_time(const store::ModelRecord& name, std::int64_t now_s);
bool is_newer_name(const store::ModelRecord& a, const store::ModelRecord& b, std::int64_t now_s);

std::uint64_t piece_count(std::uint64_t file_bytes);
std::string encode_pieces(std::span<const store::ContentHash> pieces);
/// Errors: it isn't what `encode_pieces` writes for a file of so many bytes.
Result<std::vector<store::ContentHash>> decode_pieces(std::string_view text, std::uint64_t file_bytes);

}  // namespace prismesh::ipc::vault
