// Reads *PARAMETER: names in place of numbers (LS-DYNA keyword manual, volume I).
#pragma once

#include <array>
#include <atomic>
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

/// A number that knows whether it is a whole one: 2/5 is 0, 2.0/5 is 0.4.
struct ParameterValue {
  double value = 0;
  bool whole = false;
};

/// A definition of a *PARAMETER card that isn't used.
struct ParameterProblem {
  std::size_t offset = 0;  ///< of the line
  std::string kind;        ///< of the warning: "duplicate-parameter", "bad-parameter"
  std::string message;
};

/// The parameters known at some place of the deck. A copy keeps its state while the original reads on. It costs a version number only:
/// all copies share one history of definitions. Only one of them may read on.
class Parameters {
 public:
  /// The value of a field: a number, "&name", "-&name" or "<expression>". nullopt: none of these, or an unknown name.
  std::optional<double> real(std::string_view field) const;
  std::optional<std::int64_t> integer(std::string_view field) const;
  /// The value of a name in any case. Local parameters hide global ones.
  std::optional<ParameterValue> find(std::string_view name) const;
  /// `text` with each "&name" replaced whose parameter is a text or a whole number.
  std::string put_into_text(std::string_view text) const;

  /// Reads a *PARAMETER block with any of its options. A name that is defined again keeps its first value, unless that was MUTABLE,
  /// *PARAMETER_DUPLICATION says otherwise, or a local one hides a global one or one of a file around. A value that can't be evaluated
  /// leaves the name undefined.
  void read(std::string_view text, const Block& block, std::vector<ParameterProblem>& problems);

  /// How often an undefined name was asked for, in all copies.
  std::size_t undefined() const { return history_->undefined; }

  /// Enters an included file. Its local parameters end with it.
  void enter_file() { ++depth_; }
  /// Returns to the including file: its local parameters apply again, global ones stay as they are. `before`: from before enter_file.
  void leave_file(const Parameters& before);

  /// Whether both are the same state of the same deck.
  bool operator==(const Parameters& other) const { return history_ == other.history_ && version_ == other.version_; }

 private:
  enum class Scope : std::uint8_t { global, local };
  struct Value {
    std::uint32_t version = 0;  ///< the first one it holds in
    bool defined = true;        ///< false: it is undefined again
    bool is_mutable = false;
    int depth = 0;  ///< of the file that defined it
    ParameterValue number;
    std::optional<std::string> text;  ///< of a text parameter
  };
  using Table = std::map<std::string, std::vector<Value>, std::less<>>;
  struct History {
    std::array<Table, 2> tables;  ///< by Scope
    std::vector<std::pair<std::uint32_t, std::string>> local_changes;
    std::uint32_t latest = 0;
    int duplication = 0;  ///< DFLAG of the first *PARAMETER_DUPLICATION; 0: none yet
    std::atomic<std::size_t> undefined = 0;
  };
  struct Definition {
    Scope scope;
    bool is_mutable;
    std::size_t offset;
    std::vector<ParameterProblem>* problems;
  };
  static const Value* find(const Table& table, std::string_view key, std::uint32_t version);
  const Value* find_value(std::string_view name) const;
  void set(Scope scope, const std::string& key, Value value);
  void define(const Definition& definition, const std::string& key, Value value);
  void define(const Definition& definition, std::string_view typed_name, std::string_view value);
  void read_definitions(std::string_view text, const Block& block, Definition definition);
  void read_expressions(std::string_view text, const Block& block, Definition definition);

  std::shared_ptr<History> history_ = std::make_shared<History>();
  std::uint32_t version_ = 0;
  int depth_ = 0;
};

/// Evaluates + - * / ** and parentheses over numbers, parameters and the usual functions. A sign binds tighter than **: -3**2 is 9.
/// nullopt: the expression can't be evaluated.
std::optional<ParameterValue> evaluate(std::string_view expression, const Parameters& parameters);

}  // namespace prismesh::mesh::deck::lsdyna
