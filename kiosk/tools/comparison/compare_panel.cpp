#include "kiosk/tools/comparison/compare_panel.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include "base/readable_number.h"
#include "kiosk/panels/text.h"
#include "kiosk/panels/widgets.h"
#include "mesh/document/field.h"

namespace prismesh::kiosk::tools::comparison {

namespace {

using panels::fact;
using panels::kPanelFlags;
using panels::metric_words;
using panels::printable;
using panels::section;

struct Choice {
  std::string words;
  std::string field;
};

std::vector<Choice> choices() {
  std::vector<Choice> all{{"other colours", ""},
                          {"node displacement", "displacement"},
                          {"distance to the surface", "distance-to-original"},
                          {"distance of two parts", "distance"},
                          {"composite quality", "composite"},
                          {"time step", "time-step"}};
  for (int m = 0; m < mesh::quality::kMetricCount; ++m) {
    const std::string metric(mesh::quality::name(static_cast<mesh::quality::Metric>(m)));
    all.push_back({metric_words(metric), "metric:" + metric});
  }
  return all;
}

std::string words_of(const CompareFacts& facts, const std::optional<std::uint64_t>& generation) {
  if (!generation) return "current";
  for (const CompareFacts::ComparableState& state : facts.states)
    if (state.number == *generation) return state.words;
  return "state " + std::to_string(*generation) + ", gone";
}

/// A list of states, the newest first. True: another was chosen.
bool choose_state(const char* label, const CompareFacts& facts, std::optional<std::uint64_t>& generation) {
  bool chosen = false;
  ImGui::SetNextItemWidth(-1);
  if (!ImGui::BeginCombo(label, printable(words_of(facts, generation)).c_str())) return false;
  if (ImGui::Selectable("current", !generation)) generation.reset(), chosen = true;
  for (auto state = facts.states.rbegin(); state != facts.states.rend(); ++state) {
    ImGui::PushID(static_cast<int>(state->number));
    if (ImGui::Selectable(printable(state->words).c_str(), generation == state->number)) generation = state->number, chosen = true;
    ImGui::PopID();
  }
  ImGui::EndCombo();
  return chosen;
}

/// A field whose text is taken when it is left, by whatever key or click.
void text_field(const char* name, const char* hint_text, std::string& typed, std::string& taken) {
  ImGui::SetNextItemWidth(-1);
  ImGui::InputTextWithHint(name, hint_text, &typed);
  if (!ImGui::IsItemActive()) taken = typed;
}

void choose_against(const CompareFacts& facts, CompareEntry& entry, CompareWish& wanted) {
  ImGui::TextDisabled("against");
  ImGui::SetNextItemWidth(-1);
  const bool deck = !wanted.against_generation && !is_state(wanted.against);
  const std::string words = wanted.against_generation     ? words_of(facts, wanted.against_generation)
                            : deck                        ? "another deck"
                            : wanted.against == "surface" ? "the surface as last shaped"
                                                          : "the deck as opened";
  if (ImGui::BeginCombo("##against", printable(words).c_str())) {
    const auto fixed = [&](const char* label, bool chosen, const std::string& against) {
      if (!ImGui::Selectable(label, chosen)) return;
      wanted.against = against;
      wanted.against_generation.reset();
    };
    const bool state = !wanted.against_generation;
    fixed("the deck as opened", state && wanted.against == "opened", "opened");
    fixed("the surface as last shaped", state && wanted.against == "surface", "surface");
    fixed("another deck", deck, entry.deck);
    for (const CompareFacts::ComparableState& each : facts.states) {
      ImGui::PushID(static_cast<int>(each.number));
      if (ImGui::Selectable(printable(each.words).c_str(), wanted.against_generation == each.number))
        wanted.against_generation = each.number;
      ImGui::PopID();
    }
    ImGui::EndCombo();
  }
  if (deck) text_field("##deck", "the deck's path", entry.deck, wanted.against);
}

void choose_field(const CompareFacts& facts, CompareEntry& entry, CompareWish& wanted) {
  section("Colours");
  const std::vector<Choice> all = choices();
  const auto now = std::find_if(all.begin(), all.end(), [&](const Choice& each) { return each.field == wanted.field; });
  ImGui::SetNextItemWidth(-1);
  if (ImGui::BeginCombo("##field", now != all.end() ? now->words.c_str() : "")) {
    for (const Choice& each : all)
      if (ImGui::Selectable(each.words.c_str(), each.field == wanted.field)) wanted.field = each.field;
    ImGui::EndCombo();
  }
  if (needs_against(wanted)) choose_against(facts, entry, wanted);
  if (wanted.field == "distance") {
    text_field("##from", "from: part:1", entry.from, wanted.from);
    text_field("##to", "to: part:2", entry.to, wanted.to);
  }
  ImGui::Checkbox("in bands", &wanted.bands);
  ImGui::SameLine();
  bool one_hue = wanted.map == render::ColourMap::blues;
  if (ImGui::Checkbox("one hue", &one_hue)) wanted.map = one_hue ? render::ColourMap::blues : render::ColourMap::crimson;
}

}  // namespace

std::optional<CompareWish> compare_panel(const CompareFacts& facts, CompareEntry& entry) {
  CompareWish wanted = facts.wish;
  choose_field(facts, entry, wanted);
  if (!facts.problem.empty()) ImGui::TextWrapped("%s", printable(facts.problem).c_str());
  section("Views");
  ImGui::Checkbox("two views, side by side", &wanted.two_views);
  if (wanted.two_views) {
    ImGui::TextDisabled("left");
    choose_state("##left", facts, wanted.beside);
    ImGui::TextDisabled("right");
  }
  choose_state("##shown", facts, wanted.shown);
  if (wanted.shown) ImGui::TextDisabled("an older state is only shown");
  if (!facts.legends.empty()) {
    section("Values");
    const LegendFacts& legend = facts.legends.front();
    fact("least", readable(legend.min, 4));
    fact("at", legend.min_at);
    fact("most", readable(legend.max, 4));
    fact("at", legend.max_at);
  }
  return wanted != facts.wish ? std::optional(wanted) : std::nullopt;
}

void view_captions(const CompareFacts& facts, int picture_width, float top) {
  for (std::size_t i = 0; i < facts.captions.size(); ++i) {
    const CompareFacts::Caption& caption = facts.captions[i];
    ImGui::SetNextWindowPos(ImVec2(std::floor(static_cast<float>(caption.centre * picture_width)), top), 0, ImVec2(0.5f, 0));
    ImGui::Begin(("View" + std::to_string(i)).c_str(), nullptr,
                 kPanelFlags | ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoInputs);
    ImGui::TextUnformatted(printable(caption.words).c_str());
    ImGui::End();
  }
}

}  // namespace prismesh::kiosk::tools::comparison
