// The record of a stored model: what people are told about it. The record's file is what makes a model be there.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "ipc/store/sha256.h"

namespace prismesh::ipc::store {

/// What a reader of the deck found; the store itself reads no deck.
struct ModelFigures {
  std::uint64_t nodes = 0;
  std::uint64_t elements = 0;
  std::uint64_t parts = 0;
  std::uint64_t warn = 0;  ///< elements
  std::uint64_t fail = 0;  ///< elements
  bool operator==(const ModelFigures&) const = default;
};

struct ModelRecord {
  ContentHash model;        ///< of the manifest
  std::string name;         ///< for people; never a path
  std::string who;          ///< whose token published it
  std::int64_t when_s = 0;  ///< since 1970, by the station's clock
  std::uint64_t bytes = 0;  ///< of all files
  std::uint64_t files = 0;
  std::optional<ContentHash> derived_from;  ///< the model that this one was edited from
  std::optional<ModelFigures> figures;
  std::optional<ContentHash> thumbnail;  ///< a PNG in the store
  bool operator==(const ModelRecord&) const = default;
};

inline constexpr std::size_t kMaxNameBytes = 200;

}  // namespace prismesh::ipc::store
