// A store in a temporary folder, with a clock and names of its own.
#pragma once

#include <stdlib.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/intake/store/store.h"

namespace prismesh::intake {

inline ipc::store::Manifest manifest_of(const std::map<std::string, std::string>& files, const std::string& main) {
  ipc::store::Manifest manifest{main, {}};
  for (const auto& [path, text] : files) manifest.files.push_back({ipc::store::sha256(text), text.size(), path});
  return manifest;
}

/// The same at each start: runs of the fault tests must make the same calls.
inline Randomness counted_randomness(std::uint64_t seed = 1) {
  return [random = std::mt19937_64(seed)](std::span<std::byte> bytes) mutable {
    for (std::byte& byte : bytes) byte = static_cast<std::byte>(random());
  };
}

inline Result<Store> open_store(const std::filesystem::path& path, Clock& clock, const StoreLimits& limits,
                                std::vector<std::string>* notes = nullptr, std::uint64_t seed = 1) {
  std::vector<std::string> ignored;
  return Store::open(path, limits, clock, counted_randomness(seed), notes != nullptr ? *notes : ignored);
}

/// Uploads one file in chunks of `chunk` bytes.
inline Outcome<std::string> upload(Store& store, const std::string& who, const std::string& text, std::size_t chunk = 1 << 20) {
  const Outcome<UploadStatus> begun = store.begin_upload({who, text.size(), "", ipc::store::sha256(text)});
  if (!begun) return tl::unexpected(begun.error());
  for (std::size_t at = 0; at < text.size(); at += chunk) {
    const Outcome<std::uint64_t> number = store.uploads().begin_chunk(who, begun->id, at, std::nullopt);
    if (!number) return tl::unexpected(number.error());
    if (const Outcome<void> added = store.uploads().add(begun->id, *number, std::string_view(text).substr(at, chunk)); !added)
      return tl::unexpected(added.error());
    if (const Outcome<UploadStatus> ended = store.uploads().end_chunk(begun->id, *number); !ended) return tl::unexpected(ended.error());
  }
  return begun->id;
}

using SetFiles = std::map<std::string, std::string>;

inline Publication publication_of(const std::string& who, const SetFiles& files, const std::string& main) {
  return {who, ipc::store::encode_manifest(manifest_of(files, main)), "", std::nullopt, false, 1'800'000'000};
}

/// Uploads and publishes files by path.
inline Outcome<ipc::store::ModelRecord> publish(Store& store, const std::string& who, const SetFiles& files, const std::string& main) {
  for (const auto& [path, text] : files)
    if (const Outcome<std::string> sent = upload(store, who, text); !sent) return tl::unexpected(sent.error());
  return store.publish(publication_of(who, files, main));
}

/// The bytes of a model's files by path, checked; a test fails where one is damaged.
inline SetFiles files_of(const std::filesystem::path& store, const ipc::store::ContentHash& model) {
  SetFiles files;
  const auto reader = ipc::store::Reader::open(store);
  const auto found = reader->find(model);
  if (!found) return {{"", found.error().text()}};
  for (const ipc::store::SetFile& file : found->manifest.files) {
    const auto opened = reader->open_file(file);
    if (!opened) return {{"", opened.error().text()}};
    std::string text(file.bytes, '\0');
    EXPECT_EQ(ipc::store::read_at(*opened, text.data(), text.size(), 0, file.path).value(), text.size());
    EXPECT_EQ(ipc::store::sha256(text), file.hash) << file.path;
    files[file.path] = text;
  }
  return files;
}

}  // namespace prismesh::intake
