// Rules that say what parts are judged by: from the command line, from the settings file beside the deck, or from an edit.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "mesh/document/judging.h"
#include "mesh/model/model.h"
#include "mesh/select/names.h"

namespace prismesh::mesh::document {

/// Sets the target size, the criteria, or both, of all parts or some.
struct JudgingRule {
  std::optional<std::string> on;  ///< an expression of kind part; absent: all parts, also those that an earlier rule named
  std::optional<TargetSize> target_size;
  std::optional<std::string> criteria;  ///< as load_criteria takes it
  std::string file;                     ///< where the rule stands, for errors; empty: nowhere
  long line = 0;
};

/// The parts that an expression of kind part names. Errors: those of the expression.
Result<std::vector<PartIndex>> parts_named_by(const std::string& on, const Model& model, const select::Names& names);

/// Reads a target size: a length above 0, "part" or "deck". Errors: what it is instead.
Result<TargetSize> parse_target_size(std::string_view text);
/// Errors: a length that isn't above 0 or is beyond 1e300.
Result<void> check_target_size(const TargetSize& size);

/// Applies rules in order, the last one that names a part counts. `judging` has an entry for each part of the model; it isn't settled
/// afterwards. Errors: the rule's place with those of the expression, of load_criteria, of check_target_size.
/// `unread` (optional): criteria that can't be read don't refuse their rule then, which leaves the criteria as they were; the reasons are
/// added here.
Result<void> apply_rules(const std::vector<JudgingRule>& rules, const Model& model, const select::Names& names, Judging& judging,
                         std::vector<Error>* unread = nullptr);

}  // namespace prismesh::mesh::document
