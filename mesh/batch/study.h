// A study: a plan with all that it names as it was when the study was frozen, so that every variant is the same whenever and wherever it is
// worked.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/progress.h"
#include "mesh/batch/plan.h"
#include "mesh/batch/samples.h"
#include "mesh/batch/script.h"

namespace prismesh::mesh::batch {

struct FrozenDeck {
  std::filesystem::path path;
  std::string hash;      ///< of the deck with its includes
  std::string settings;  ///< text of the settings file beside it; empty: there is none
};

struct Study {
  std::filesystem::path plan_file;
  std::string plan_text;
  Plan plan;
  std::vector<FrozenDeck> decks;  ///< as the plan names them
  std::vector<Script> scripts;
  std::string criteria;  ///< text of the plan's criteria; empty: it names none
};

/// Reads a plan and everything that it names, and checks what can be checked before any work: decks open, parameters and scripts fit each
/// other, edits have the right fields. Errors, with file and line where there is one: those of parse_plan, deck::open, edits_with; a
/// parameter that no script names; cancelled.
Result<Study> freeze(const std::filesystem::path& plan, const Progress& progress = {});

/// One combination of a deck, a script and values.
struct Variant {
  std::size_t number = 0;  ///< from 0: by deck, then script, then values
  std::size_t deck = 0, script = 0;
  std::vector<ParameterValue> values;
};

/// The variants of a study, and what tells one from another. The study must outlive it.
class Variants {
 public:
  explicit Variants(const Study& study) : study_(study), samples_(study.plan) {}

  std::size_t count() const { return variant_count(study_.plan); }
  Variant at(std::size_t number) const;
  /// Errors: those of edits_with.
  Result<std::vector<ScriptEdit>> edits(const Variant& variant) const;
  /// What a result is kept under: a hash of the deck's content and settings, the edits with their values, the files that these name, what
  /// is measured, and the program's version. Variants that only differ in their number have the same. Errors: as above.
  Result<std::string> key(const Variant& variant) const;

 private:
  const Study& study_;
  Samples samples_;
};

}  // namespace prismesh::mesh::batch
