// Reads /PARAMETER: names in place of numbers, as "&name".
// Source: Radioss Reference Guide, "/PARAMETER".
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "mesh/deck/radioss/block.h"
#include "mesh/deck/radioss/context.h"

namespace prismesh::mesh::deck::radioss {

class Parameters {
 public:
  /// Reads a /PARAMETER block. False: its value is an expression, which isn't evaluated, so the name stays undefined.
  bool read(std::span<const SourceFile> files, const Block& block, const Keyword& keyword);

  /// The value of a field in a context: a number, or "&name". nullopt: neither, or an unknown name.
  std::optional<double> real(std::string_view field, std::span<const Context> contexts, std::uint32_t context) const;
  std::optional<std::int64_t> integer(std::string_view field, std::span<const Context> contexts, std::uint32_t context) const;

 private:
  /// By context and name; global ones are those of context 0.
  std::map<std::pair<std::uint32_t, std::string>, double> values_;
};

}  // namespace prismesh::mesh::deck::radioss
