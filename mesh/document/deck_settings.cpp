// Reads and writes the settings file beside a deck. Only this source of mesh/document includes toml++, which is slow to compile.
#include "mesh/document/deck_settings.h"

#include <algorithm>
#include <map>

#include "base/file.h"
#include "base/json/write.h"
#include "base/nearest_name.h"
#include "base/toml_text.h"
#include "mesh/document/chosen_criteria.h"
#include "mesh/select/expression.h"

#include <toml++/toml.h>

namespace prismesh::mesh::document {

namespace {

namespace fs = std::filesystem;
using KeyNames = std::vector<std::string_view>;

class DeckSettingsReader {
 public:
  explicit DeckSettingsReader(const fs::path& file) : file_(file) {}

  Result<std::vector<JudgingRule>> read(const toml::table& root) {
    if (Result<void> known = check_keys(root, {"target_size", "criteria", "parts"}, "a deck's settings file"); !known)
      return fail(std::move(known.error()));
    JudgingRule all;
    if (Result<void> done = read_choice(root, all); !done) return fail(std::move(done.error()));
    if (all.target_size || all.criteria) rules_.push_back(std::move(all));
    if (const toml::node* parts = root.get("parts"))
      if (Result<void> done = read_parts(*parts); !done) return fail(std::move(done.error()));
    return std::move(rules_);
  }

 private:
  tl::unexpected<Error> error(const toml::node& at, std::string message) const {
    return fail(file_.string(), line_of(at), std::move(message));
  }
  static long line_of(const toml::node& at) { return static_cast<long>(at.source().begin.line); }

  Result<void> check_keys(const toml::table& table, const KeyNames& known, const std::string& owner) const {
    for (const auto& [key, node] : table) {
      if (std::find(known.begin(), known.end(), key.str()) != known.end()) continue;
      return error(node, owner + " has no \"" + std::string(key.str()) + "\"; the nearest known is \"" +
                             std::string(nearest_name(key.str(), known)) + "\"");
    }
    return {};
  }

  Result<void> read_choice(const toml::table& table, JudgingRule& rule) const {
    rule.file = file_.string();
    if (const toml::node* size = table.get("target_size")) {
      rule.line = line_of(*size);
      if (Result<void> done = read_size(*size, rule); !done) return done;
    }
    if (const toml::node* criteria = table.get("criteria")) {
      rule.line = line_of(*criteria);
      const auto name = criteria->value<std::string>();
      if (!name || name->empty()) return error(*criteria, "criteria must be a name or a file, like \"strict\"");
      rule.criteria = criteria_place(*name, folder_of(file_));
    }
    return {};
  }

  Result<void> read_size(const toml::node& node, JudgingRule& rule) const {
    if (node.is_number()) {
      const TargetSize size(node.value<double>().value_or(0));
      if (Result<void> sound = check_target_size(size); !sound) return error(node, sound.error().message);
      rule.target_size = size;
      return {};
    }
    const auto word = node.value<std::string>();
    if (word == "part" || word == "deck") {
      rule.target_size = word == "part" ? SizeGuess::part : SizeGuess::deck;
      return {};
    }
    return error(node, "target_size must be a length, \"part\" (each part's median edge) or \"deck\" (the deck's)");
  }

  Result<void> read_parts(const toml::node& node) {
    const toml::array* list = node.as_array();
    if (list == nullptr) return error(node, "parts must be a list of tables, each like [[parts]]");
    for (const toml::node& each : *list) {
      const toml::table* table = each.as_table();
      if (table == nullptr) return error(each, "parts must be a list of tables, each like [[parts]]");
      if (Result<void> known = check_keys(*table, {"on", "target_size", "criteria"}, "parts"); !known) return known;
      const toml::node* on = table->get("on");
      if (on == nullptr) return error(each, "parts needs \"on\": the parts, as an expression like \"3,7\"");
      JudgingRule rule;
      rule.on = on->value<std::string>();
      if (!rule.on) return error(*on, "on must be an expression that names parts, like \"3,7\"");
      if (Result<void> done = read_choice(*table, rule); !done) return done;
      if (!rule.target_size && !rule.criteria) return error(each, "parts needs \"target_size\", \"criteria\" or both");
      rule.line = line_of(*on);
      rules_.push_back(std::move(rule));
    }
    return {};
  }

  fs::path file_;
  std::vector<JudgingRule> rules_;
};

std::string size_text(const TargetSize& size) {
  if (const double* given = std::get_if<double>(&size)) return json::to_line(json::Json(*given));
  return std::get<SizeGuess>(size) == SizeGuess::deck ? "\"deck\"" : "\"part\"";
}

/// A criteria file relative to the folder of the settings, if it is in it or below.
std::string criteria_text(const std::string& name, const fs::path& settings_file) {
  if (quality::is_built_in_criteria(name)) return toml_quoted(name);
  std::error_code failed;
  const fs::path whole = fs::absolute(name, failed).lexically_normal();
  const fs::path folder = fs::absolute(folder_of(settings_file), failed).lexically_normal();
  const fs::path below = whole.lexically_relative(folder);
  if (below.empty() || *below.begin() == "..") return toml_quoted(whole.string());
  return toml_quoted((quality::is_built_in_criteria(below) ? "./" : "") + below.string());
}

}  // namespace

fs::path deck_settings_path(const fs::path& deck) {
  fs::path path = deck;
  path += ".prismesh.toml";
  return path;
}

Result<std::vector<JudgingRule>> parse_deck_settings(std::string_view text, const fs::path& file) {
  try {
    return DeckSettingsReader(file).read(toml::parse(text, file.string()));
  } catch (const toml::parse_error& error) {
    return fail(file.string(), static_cast<long>(error.source().begin.line), "not TOML: " + std::string(error.description()));
  }
}

Result<std::vector<JudgingRule>> read_deck_settings(const fs::path& file) {
  std::error_code failed;
  if (!fs::exists(file, failed)) return std::vector<JudgingRule>();
  const Result<FileBytes> bytes = read_file(file);
  if (!bytes) return fail(bytes.error());
  return parse_deck_settings(bytes->text(), file);
}

bool has_choices(const Generation& generation) {
  const Judging& judging = *generation.judging;
  return judging.target_size != TargetSize(SizeGuess::part) || !judging.criteria.name.empty() ||
         std::any_of(judging.parts.begin(), judging.parts.end(),
                     [](const PartChoice& choice) { return choice.target_size || choice.criteria; });
}

std::string deck_settings_text(const Generation& generation, const fs::path& file) {
  const Judging& judging = *generation.judging;
  std::string text = "# What the shells of this deck are judged by: docs/quality/criteria.md. Prismesh writes this file anew.\n";
  text += "target_size = " + size_text(judging.target_size) + "\n";
  if (!judging.criteria.name.empty()) text += "criteria = " + criteria_text(judging.criteria.name, file) + "\n";
  std::map<std::string, std::vector<std::int64_t>> parts_of;  // by the text of the choice
  for (std::size_t p = 0; p < judging.parts.size(); ++p) {
    const PartChoice& choice = judging.parts[p];
    std::string chosen;
    if (choice.target_size) chosen += "target_size = " + size_text(*choice.target_size) + "\n";
    if (choice.criteria) chosen += "criteria = " + criteria_text(choice.criteria->name, file) + "\n";
    if (!chosen.empty()) parts_of[chosen].push_back((*generation.model.parts)[p].id);
  }
  for (const auto& [chosen, ids] : parts_of) text += "\n[[parts]]\non = " + toml_quoted(select::to_expression(ids)) + "\n" + chosen;
  return text;
}

Result<void> keep_deck_settings(const Document& document, const fs::path& saved_as) {
  const bool chosen_by_edit = document.current().judging != document.opened->judging;
  if (!document.settings.has_file && !chosen_by_edit) return {};
  return write_deck_settings(document.current(), saved_as);
}

Result<void> write_deck_settings(const Generation& generation, const fs::path& deck) {
  const fs::path file = deck_settings_path(deck);
  std::error_code failed;
  if (!has_choices(generation) && !fs::exists(file, failed)) return {};
  const std::string text = deck_settings_text(generation, file);
  const std::vector<PendingFile> pending{{file, {text}}};
  return replace_files(pending);
}

}  // namespace prismesh::mesh::document
