#include "mesh/batch/study.h"

#include <algorithm>
#include <set>

#include <nlohmann/json.hpp>

#include "base/file.h"
#include "base/hash.h"
#include "base/nearest_name.h"
#include "mesh/deck/open.h"
#include "mesh/document/deck_settings.h"
#include "mesh/quality/criteria.h"

namespace prismesh::mesh::batch {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxChecked = 10'000;  ///< variants whose edits are tried before any work

Result<std::string> text_of(const fs::path& file) {
  const Result<FileBytes> bytes = read_file(file);
  if (!bytes) return fail(bytes.error());
  return std::string(bytes->text());
}

/// Empty where there is no file.
Result<std::string> settings_text(const fs::path& deck) {
  const fs::path file = document::deck_settings_path(deck);
  std::error_code failed;
  if (!fs::exists(file, failed)) return std::string();
  return text_of(file);
}

Result<void> freeze_decks(Study& study, const Progress& progress) {
  for (const fs::path& path : study.plan.decks) {
    Result<deck::OpenedDeck> opened = deck::open(path, progress);
    if (!opened && opened.error().file.empty()) opened.error().file = path.string();
    if (!opened) return fail(std::move(opened.error()));
    Result<std::string> settings = settings_text(path);
    if (!settings) return fail(settings.error());
    study.decks.push_back({path, opened->deck->content.hex(), std::move(*settings)});
  }
  return {};
}

/// Every parameter is named by a script, and every name in a script is a parameter.
Result<void> check_names(const Study& study) {
  std::set<std::string> used;
  for (const Script& script : study.scripts) {
    const Result<std::vector<std::string>> named = parameters_named(script);
    if (!named) return fail(named.error());
    used.insert(named->begin(), named->end());
  }
  for (const Parameter& parameter : study.plan.parameters)
    if (!used.contains(parameter.name))
      return fail(study.plan_file.string(), "no script names the parameter " + parameter.name + ": write \"${" + parameter.name +
                                                "}\" where its value belongs, or leave it out");
  return {};
}

Result<void> check_edits(const Study& study) {
  const Variants variants(study);
  const std::size_t step = std::max<std::size_t>(1, variants.count() / kMaxChecked);
  for (std::size_t number = 0; number < variants.count(); number += step)
    if (const auto edits = variants.edits(variants.at(number)); !edits) return fail(edits.error());
  return {};
}

/// Adds the contents of files that an edit names: another deck, a card to make welds like.
Result<void> add_named_files(const nlohmann::json& edit, std::vector<std::string>& pieces) {
  for (const char* field : {"deck", "template"}) {
    const auto found = edit.find(field);
    if (found == edit.end() || !found->is_string()) continue;
    const Result<FileBytes> bytes = read_file(fs::path(found->get<std::string>()));
    if (!bytes) return fail(bytes.error());
    pieces.push_back(hash128(bytes->bytes()).hex());
  }
  return {};
}

}  // namespace

Result<Study> freeze(const fs::path& plan, const Progress& progress) {
  Study study;
  study.plan_file = fs::absolute(plan).lexically_normal();
  Result<std::string> text = text_of(plan);
  if (!text) return fail(text.error());
  study.plan_text = std::move(*text);
  Result<Plan> parsed = parse_plan(study.plan_text, plan);
  if (!parsed) return fail(parsed.error());
  study.plan = std::move(*parsed);
  for (const fs::path& file : study.plan.scripts) {
    Result<std::string> script = text_of(file);
    if (!script) return fail(script.error());
    study.scripts.push_back({file, std::move(*script)});
  }
  if (study.plan.criteria) {
    Result<std::string> criteria = quality::criteria_text(*study.plan.criteria);
    if (!criteria) return fail(criteria.error());
    study.criteria = std::move(*criteria);
  }
  // a mistyped name is told where it stands in the script, not as a parameter that nobody names
  if (Result<void> done = check_edits(study); !done) return fail(done.error());
  if (Result<void> done = check_names(study); !done) return fail(done.error());
  if (Result<void> done = freeze_decks(study, progress); !done) return fail(done.error());
  return study;
}

Variant Variants::at(std::size_t number) const {
  const std::size_t samples = sample_count(study_.plan), scripts = study_.scripts.size();
  return {number, number / samples / scripts, number / samples % scripts, samples_.at(number % samples)};
}

Result<std::vector<ScriptEdit>> Variants::edits(const Variant& variant) const {
  return edits_with(study_.scripts[variant.script], study_.plan.parameters, variant.values);
}

Result<std::string> Variants::key(const Variant& variant) const {
  const Result<std::vector<ScriptEdit>> made = edits(variant);
  if (!made) return fail(made.error());
  const Plan& plan = study_.plan;
  const FrozenDeck& deck = study_.decks[variant.deck];
  std::string size = "none";
  if (plan.target_size) {
    const double* length = std::get_if<double>(&*plan.target_size);
    size = length != nullptr                                                               ? words(*length)
           : std::get<document::SizeGuess>(*plan.target_size) == document::SizeGuess::part ? "part"
                                                                                           : "deck";
  }
  std::vector<std::string> pieces{"prismesh batch 1",
                                  PRISMESH_VERSION,
                                  deck.path.filename().string(),
                                  deck.hash,
                                  deck.settings,
                                  study_.criteria,
                                  size,
                                  plan.length_unit ? std::string(name(*plan.length_unit)) : "none",
                                  std::to_string(int(plan.repair)),
                                  std::to_string(int(plan.penetrations)),
                                  std::to_string(int(plan.pictures))};
  for (const ScriptEdit& edit : *made) {
    pieces.push_back(edit.json);
    if (Result<void> done = add_named_files(nlohmann::json::parse(edit.json), pieces); !done)
      return fail(study_.scripts[variant.script].file.string(), edit.line, done.error().text());
  }
  // each with its length, so that no two lists run into the same bytes
  std::string all;
  for (const std::string& piece : pieces) all += std::to_string(piece.size()) + ":" + piece;
  return hash128(std::as_bytes(std::span(all.data(), all.size()))).hex();
}

}  // namespace prismesh::mesh::batch
