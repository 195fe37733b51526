// *PARAMETER: names that stand where a number is expected.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mesh/deck/lsdyna/keyword.h"

namespace prismesh::mesh::deck::lsdyna {

/// The parameters known at some place of the deck. A copy stays as it is while the original reads on, and costs no more than
/// a version number: what was defined when is kept once, for all copies. Only one of them may read on.
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
  void leave_file(const Parameters& before);

  bool operator==(const Parameters&) const = default;  ///< the same place of the same deck

 private:
  enum class Scope : std::uint8_t { global, local };
  struct Value {
    std::uint32_t version = 0;    ///< from which on it holds
    std::optional<double> value;  ///< nullopt: it is undefined again
  };
  using Table = std::map<std::string, std::vector<Value>, std::less<>>;
  struct History {
    std::array<Table, 2> tables;  ///< by Scope
    std::vector<std::pair<std::uint32_t, std::string>> local_changes;
    std::uint32_t latest = 0;
  };
  static std::optional<double> find(const Table& table, std::string_view key, std::uint32_t version);
  void define(Scope scope, const std::string& key, std::optional<double> value);
  void read_definitions(std::string_view text, const Block& block, Scope scope);
  void read_expressions(std::string_view text, const Block& block, Scope scope);

  std::shared_ptr<History> history_ = std::make_shared<History>();
  std::uint32_t version_ = 0;
};

/// Evaluates + - * / ** and parentheses over numbers, parameters and the usual functions. nullopt: it can't.
std::optional<double> evaluate(std::string_view expression, const Parameters& parameters);

}  // namespace prismesh::mesh::deck::lsdyna
