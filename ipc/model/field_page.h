// A field's values in sealed shared memory: a float for each node or shell of one generation.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "base/error.h"
#include "ipc/wire/descriptor.h"

namespace prismesh::ipc {

/// The header before the values.
struct FieldHeader {
  static constexpr std::uint64_t kMagic = 0x646c656966736d70;  // "pmsfield"
  std::uint64_t magic = kMagic;
  std::uint64_t generation = 0;
  std::uint64_t count = 0;
  std::uint64_t on_nodes = 0;  ///< 1, or 0: on shells
};

/// Memory that is sealed against any change. Errors: no memory.
Result<Descriptor> seal_field(std::uint64_t generation, bool on_nodes, std::span<const float> values);

/// Values as a view maps them. The memory's size and seals are checked before anything is read.
class FieldValues {
 public:
  static Result<std::shared_ptr<const FieldValues>> map(const Descriptor& descriptor);

  std::uint64_t generation() const { return header_.generation; }
  bool on_nodes() const { return header_.on_nodes != 0; }
  /// By node or shell index; NaN: no value. Their number isn't checked: compare it with the model's counts.
  std::span<const float> values() const;

 private:
  Mapping mapping_;
  FieldHeader header_;
};

}  // namespace prismesh::ipc
