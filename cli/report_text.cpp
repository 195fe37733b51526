#include "cli/report_text.h"
#include "base/counted.h"
#include "base/readable_number.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <ostream>
#include <vector>

namespace prismesh::cli {

std::string shortest(double value) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, value).ptr;
  return std::string(text, end);
}

std::string target_sizes(const mesh::document::Document& document) {
  const mesh::Model& model = document.current().model;
  const mesh::document::Judging& judging = *document.current().judging;
  std::vector<bool> has_shells(model.parts->size(), false);
  for (std::size_t s = 0; s < model.shell_count(); ++s)
    if (const mesh::PartIndex part = model.shell_parts[s]; part.valid()) has_shells[part.value] = true;
  double min = std::numeric_limits<double>::infinity(), max = 0;
  for (std::size_t p = 0; p < has_shells.size(); ++p) {
    if (!has_shells[p]) continue;
    const double size = judging.by_part.of(mesh::PartIndex(p)).target_size;
    min = std::min(min, size);
    max = std::max(max, size);
  }
  if (!(min <= max)) return shortest(judging.deck_size);
  if (min == max) return shortest(min);
  return shortest(min) + " to " + shortest(max);
}

std::string criteria_names(const mesh::document::Document& document) {
  std::vector<std::string> names = {document.current().judging->criteria.criteria->name};
  for (const mesh::quality::PartCriteria& each : document.current().judging->by_part.distinct)
    if (each.criteria && std::find(names.begin(), names.end(), each.criteria->name) == names.end()) names.push_back(each.criteria->name);
  std::string all = printable(names.front());
  for (std::size_t i = 1; i < names.size(); ++i) all += ", " + printable(names[i]);
  return names.size() == 1 ? all : all + " by part";
}

std::string rounded(double value) { return readable(value, 6); }

void say(const Context& context, const Error& error) { context.err << printable(error.text()) << '\n'; }

void say_warnings(const Context& context, const mesh::document::Document& document) { say_warnings(context, document.deck->warnings); }

void say_warnings(const Context& context, std::span<const mesh::deck::Warning> warnings) {
  for (const mesh::deck::Warning& warning : warnings) {
    std::string message = "warning: " + warning.message;
    if (warning.count > 1) message += " (" + std::to_string(warning.count) + " times)";
    say(context, Error{warning.file, warning.line, std::move(message)});
  }
}

void say_guesses(const Context& context, const mesh::document::Document& document) {
  const mesh::document::DocumentSettings& settings = document.settings;
  std::string guesses, options;
  const auto add = [&](bool guessed, const std::string& what, const char* option) {
    if (!guessed) return;
    if (!guesses.empty()) guesses += ", ", options += " and ";
    guesses += what;
    options += option;
  };
  add(settings.length_unit_guessed, "length unit " + std::string(name(settings.length_unit)), "--length-unit");
  const bool guessed = is_guessed(document.current().judging->target_size);
  add(guessed, "target size " + target_sizes(document) + " from the median edge", "--target-size");
  if (!guesses.empty()) say(context, Error{document.path.string(), 0, "note: guessed " + guesses + "; set with " + options});
}

void say_unit_guess(const Context& context, const mesh::document::Document& document) {
  if (document.settings.length_unit_guessed)
    say(context, Error{document.path.string(), 0,
                       "note: guessed length unit " + std::string(name(document.settings.length_unit)) + "; set with --length-unit"});
}

bool output_is_good(const Context& context) {
  context.out.flush();
  if (context.out) return true;
  say(context, Error{"standard output", 0, "can't be written"});
  return false;
}

std::string day_and_time(std::int64_t seconds) {
  const std::time_t time = static_cast<std::time_t>(seconds);
  std::tm parts{};
  std::array<char, 32> text{};
  if (::gmtime_r(&time, &parts) == nullptr || std::strftime(text.data(), text.size(), "%Y-%m-%d %H:%M", &parts) == 0) return "?";
  return text.data();
}

std::string change_words(const mesh::document::EditReport& report) {
  if (report.welded) return counted(report.welded->welds_added, "weld") + " added";
  if (report.bonded) return counted(report.bonded->solids_added, "solid") + " added";
  std::string words;
  const auto add = [&](const std::string& more) { words += (words.empty() ? "" : ", ") + more; };
  if (report.welds_mended) add(counted(report.welds_mended->mended, "weld") + " mended");
  if (report.nodes_moved > 0 || report.elements_added + report.elements_removed == 0) add(counted(report.nodes_moved, "node") + " moved");
  if (report.elements_added > 0) add(counted(report.elements_added, "element") + " added");
  if (report.elements_removed > 0) add(counted(report.elements_removed, "element") + " removed");
  return words;
}

void print_edit(std::ostream& out, const mesh::document::EditReport& report) {
  if (report.welded) {
    out << report.edit << ": " << counted(report.welded->welds_added, "weld") << " added, " << counted(report.elements_added, "element")
        << "; " << counted(report.welded->spots_left, "spot") << " left out\n";
    for (const std::string& note : report.notes) out << "  " << printable(note) << '\n';
    return;
  }
  if (report.bonded) {
    out << report.edit << ": " << counted(report.bonded->solids_added, "solid") << " added; " << report.bonded->solids_left
        << " left out\n";
    for (const std::string& note : report.notes) out << "  " << printable(note) << '\n';
    return;
  }
  out << report.edit << ": " << change_words(report) << "; warn " << report.before.warn << " -> " << report.after.warn << ", fail "
      << report.before.fail << " -> " << report.after.fail;
  if (report.clusters_before + report.clusters_after > 0)
    out << ", clusters of triangles " << report.clusters_before << " -> " << report.clusters_after;
  out << '\n';
  for (const std::string& note : report.notes) out << "  " << printable(note) << '\n';
}

}  // namespace prismesh::cli
