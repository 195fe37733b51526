#include "kiosk/tools/exhibition/show_script.h"

#include <array>
#include <cmath>
#include <fstream>
#include <sstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "ipc/model/messages.h"
#include "kiosk/tools/exhibition/allowed_requests.h"
#include "mesh/document/edit_json.h"

namespace prismesh::kiosk::tools::exhibition {

namespace {

using nlohmann::json;

constexpr std::size_t kLargestFile = 1'000'000;
constexpr std::size_t kLongestWords = 400;

/// A number within limits, or what is wrong.
Result<double> number_of(const json& value, const char* field, double low, double high) {
  const double number = value.is_number() ? value.get<double>() : std::nan("");
  if (number >= low && number <= high) return number;
  return fail(Error{"", 0, fmt::format("\"{}\" must be a number from {} to {}", field, low, high)});
}

Result<std::string> words_of(const json& value, const char* field) {
  if (value.is_string() && value.get_ref<const std::string&>().size() <= kLongestWords) return value.get<std::string>();
  return fail(Error{"", 0, fmt::format("\"{}\" must be a text of at most {} bytes", field, kLongestWords)});
}

Result<void> take_turn(const json& value, ShowStep& step) {
  if (!value.is_array() || value.size() != 2) return fail(Error{"", 0, "\"turn\" must be two numbers: degrees to the right and up"});
  for (std::size_t i = 0; i < 2; ++i) {
    const Result<double> degrees = number_of(value[i], "turn", -3600, 3600);
    if (!degrees) return fail(degrees.error());
    (i == 0 ? step.turn_right : step.turn_up) = *degrees;
  }
  return {};
}

Result<void> take_field(const std::string& name, const json& value, ShowStep& step) {
  const auto text = [&](std::string& into) -> Result<void> {
    Result<std::string> words = words_of(value, name.c_str());
    if (!words) return fail(words.error());
    into = std::move(*words);
    return {};
  };
  const auto number = [&](double& into, double low, double high) -> Result<void> {
    const Result<double> read = number_of(value, name.c_str(), low, high);
    if (!read) return fail(read.error());
    into = *read;
    return {};
  };
  if (name == "title") return text(step.title);
  if (name == "words") return text(step.words);
  if (name == "seconds") return number(step.seconds, 0, 120);
  if (name == "zoom") return number(step.zoom, 0.01, 100);
  if (name == "turn") return take_turn(value, step);
  if (name == "fit") {
    if (value != "model" && value != "selection") return fail(Error{"", 0, "\"fit\" must be \"model\" or \"selection\""});
    step.fit = value == "model" ? ShowStep::Fit::model : ShowStep::Fit::selection;
    return {};
  }
  if (name != "edit")
    return fail(
        Error{"", 0, fmt::format("\"{}\" is no field of a step: title, words, seconds, edit, turn, zoom, fit", name.substr(0, 40))});
  Result<mesh::document::Edit> edit = mesh::document::edit_from_json(value);
  if (!edit) return fail(edit.error());
  if (!is_allowed(ipc::ApplyEdit{*edit}, {})) return fail(Error{"", 0, "this edit reads or writes a file: a show can't"});
  step.edit = std::move(*edit);
  return {};
}

Result<ShowStep> read_step(std::string_view line) {
  const json read = json::parse(line, nullptr, false);
  if (read.is_discarded()) return fail(Error{"", 0, "this isn't JSON"});
  if (!read.is_object()) return fail(Error{"", 0, "a step is an object: {\"title\": ..}"});
  ShowStep step;
  for (const auto& [name, value] : read.items())
    if (Result<void> taken = take_field(name, value, step); !taken) return fail(taken.error());
  return step;
}

}  // namespace

Result<std::vector<ShowStep>> parse_show(std::string_view text, const std::string& file) {
  std::vector<ShowStep> steps;
  long number = 0;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    ++number;
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    if (line.find_first_not_of(" \t") == std::string_view::npos || line.front() == '#') continue;
    Result<ShowStep> step = read_step(line);
    if (!step) return fail(Error{file, number, step.error().message});
    steps.push_back(std::move(*step));
  }
  if (steps.empty()) return fail(Error{file, 0, "the show has no step"});
  return steps;
}

Result<std::vector<ShowStep>> read_show(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) return fail(Error{file.string(), 0, "the show can't be read"});
  std::string text(kLargestFile + 1, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(in.gcount()));
  if (text.size() > kLargestFile) return fail(Error{file.string(), 0, "the show is larger than 1 MB"});
  return parse_show(text, file.string());
}

}  // namespace prismesh::kiosk::tools::exhibition
