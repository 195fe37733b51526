#include "mesh/document/judging_rules.h"

#include <charconv>

#include "mesh/document/chosen_criteria.h"
#include "mesh/select/expression.h"

namespace prismesh::mesh::document {

namespace {

/// An error of a rule, with the rule's place; an expression's column goes into the message.
Error at_rule(Error error, const JudgingRule& rule) {
  if (rule.file.empty() || is_cancelled(error)) return error;
  if (error.file == "expression")
    error.message = "\"" + *rule.on + "\", column " + std::to_string(error.line) + ": " + error.message;
  else if (!error.file.empty())
    return error;  // the criteria file's own
  error.file = rule.file;
  error.line = rule.line;
  return error;
}

Result<void> choose_size(const TargetSize& size, const std::vector<PartIndex>* parts, Judging& judging) {
  if (Result<void> sound = check_target_size(size); !sound) return sound;
  if (parts != nullptr) {
    for (const PartIndex part : *parts) judging.parts[part.value].target_size = size;
    return {};
  }
  judging.target_size = size;
  for (PartChoice& choice : judging.parts) choice.target_size.reset();
  return {};
}

Result<void> choose_criteria(const std::string& path, const std::vector<PartIndex>* parts, Judging& judging, std::vector<Error>* unread) {
  Result<ChosenCriteria> read = load_chosen_criteria(path, judging.criteria.criteria->time_step_scale);
  if (!read && unread != nullptr) {
    unread->push_back(std::move(read.error()));
    return {};
  }
  if (!read) return fail(std::move(read.error()));
  const ChosenCriteria chosen = shared_choice(judging, std::move(*read));
  if (parts != nullptr) {
    for (const PartIndex part : *parts) judging.parts[part.value].criteria = chosen;
    return {};
  }
  judging.criteria = chosen;
  for (PartChoice& choice : judging.parts) choice.criteria.reset();
  return {};
}

Result<void> apply_rule(const JudgingRule& rule, const Model& model, const select::Names& names, Judging& judging,
                        std::vector<Error>* unread) {
  std::vector<PartIndex> parts;
  if (rule.on) {
    Result<std::vector<PartIndex>> named = parts_named_by(*rule.on, model, names);
    if (!named) return fail(std::move(named.error()));
    parts = std::move(*named);
  }
  const std::vector<PartIndex>* named = rule.on ? &parts : nullptr;
  if (rule.target_size)
    if (Result<void> done = choose_size(*rule.target_size, named, judging); !done) return done;
  if (rule.criteria)
    if (Result<void> done = choose_criteria(*rule.criteria, named, judging, unread); !done) return done;
  return {};
}

}  // namespace

Result<std::vector<PartIndex>> parts_named_by(const std::string& on, const Model& model, const select::Names& names) {
  Result<select::Chosen> chosen = select::evaluate(model, on, select::EntityKind::part, names);
  if (!chosen) return fail(std::move(chosen.error()));
  return std::move(chosen->parts);
}

Result<void> check_target_size(const TargetSize& size) {
  const double* given = std::get_if<double>(&size);
  if (given == nullptr || (*given > 0 && *given < 1e300)) return {};
  return fail("", "the target size must be greater than 0");
}

Result<TargetSize> parse_target_size(std::string_view text) {
  if (text == "part") return TargetSize(SizeGuess::part);
  if (text == "deck") return TargetSize(SizeGuess::deck);
  double value = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code != std::errc() || end != text.data() + text.size())
    return fail(
        "", "a target size is a length, \"part\" (each part's median edge) or \"deck\" (the deck's), not \"" + std::string(text) + "\"");
  const TargetSize size(value);
  if (Result<void> sound = check_target_size(size); !sound) return fail(std::move(sound.error()));
  return size;
}

Result<void> apply_rules(const std::vector<JudgingRule>& rules, const Model& model, const select::Names& names, Judging& judging,
                         std::vector<Error>* unread) {
  for (const JudgingRule& rule : rules)
    if (Result<void> done = apply_rule(rule, model, names, judging, unread); !done) return fail(at_rule(std::move(done.error()), rule));
  return {};
}

}  // namespace prismesh::mesh::document
