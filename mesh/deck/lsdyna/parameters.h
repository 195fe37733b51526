// *PARAMETER: names that stand where a number is expected.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "mesh/deck/lsdyna/keyword.h"

namespace prismesh::mesh::deck::lsdyna {

/// The parameters known at some place of the deck. A copy shares the table until one side changes it, so that every
/// block can keep the state it was read in.
class Parameters {
 public:
  /// A field's value: a number, "&name" or "-&name". nullopt: neither, or an unknown name.
  std::optional<double> real(std::string_view field) const;
  std::optional<std::int64_t> integer(std::string_view field) const;

  /// The value of a name, whatever its case; local ones hide global ones.
  std::optional<double> find(std::string_view name) const;

  /// Reads a block named PARAMETER, with any of the options _EXPRESSION and _LOCAL. A name defined again gets the new
  /// value; what can't be evaluated stays undefined.
  void read(std::string_view text, const Block& block);

  /// Back in the including file: its own local parameters count again, the global ones stay as they are.
  void leave_file(const Parameters& before) { local_ = before.local_; }

  bool operator==(const Parameters&) const = default;  ///< the same tables, not merely equal ones

 private:
  using Table = std::map<std::string, double, std::less<>>;
  using Shared = std::shared_ptr<const Table>;
  void read_definitions(std::string_view text, const Block& block, Shared& table);
  void read_expressions(std::string_view text, const Block& block, Shared& table);

  Shared global_;
  Shared local_;
};

/// Evaluates + - * / ** and parentheses over numbers, parameters and the usual functions. nullopt: it can't.
std::optional<double> evaluate(std::string_view expression, const Parameters& parameters);

}  // namespace prismesh::mesh::deck::lsdyna
