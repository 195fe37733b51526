#include "kiosk/panels/legend.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include "base/counted.h"
#include "base/readable_number.h"
#include "kiosk/panels/sections.h"
#include "kiosk/panels/text.h"
#include "mesh/document/field.h"

namespace prismesh::kiosk::panels {

namespace {

constexpr int kBarSteps = 96;
constexpr double kDragsAcross = 300;  ///< pixels of the pointer for all of the map

ImU32 packed(const render::Colour& colour) { return ImGui::GetColorU32(ImVec4(colour.x(), colour.y(), colour.z(), 1)); }

std::string short_number(double value) { return readable(value, 4); }

bool large_is_worse(const render::FieldLook& look) { return look.full >= look.clear; }

/// The map from where it begins to the limit, and a notch where the largest value is.
void draw_bar(const LegendFacts& facts, float width) {
  const float height = 2 * kGrid;
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const render::FieldLook& look = facts.look;
  for (int i = 0; i < kBarSteps; ++i) {
    const double value = look.clear + (look.full - look.clear) * (i + 0.5) / kBarSteps;
    const float from = at.x + width * static_cast<float>(i) / kBarSteps, to = at.x + width * static_cast<float>(i + 1) / kBarSteps;
    if (const auto colour = look.colour_of(value))
      list.AddRectFilled(ImVec2(from, at.y), ImVec2(to + 0.5f, at.y + height), packed(*colour));
  }
  const double worst = large_is_worse(look) ? facts.max : facts.min;
  const auto share = static_cast<float>((worst - look.clear) / (look.full - look.clear));
  if (share > 0 && share <= 1) {
    const float x = at.x + width * share;
    list.AddTriangleFilled(ImVec2(x - 5, at.y + height + 7), ImVec2(x + 5, at.y + height + 7), ImVec2(x, at.y + height), kInk);
  }
  ImGui::Dummy(ImVec2(width, height + kGrid));
}

/// A limit that can be dragged, or typed after a double click.
bool edit_limit(const char* name, double& value, double span, float width) {
  ImGui::SetNextItemWidth(width);
  double wanted = value;
  const auto speed = static_cast<float>(std::abs(span) / kDragsAcross);
  const std::string shown = short_number(value);  // the format is the text itself: no format of C writes 0.00005
  if (!ImGui::DragScalar(name, ImGuiDataType_Double, &wanted, speed, nullptr, nullptr, shown.c_str()) || !std::isfinite(wanted))
    return false;
  value = wanted;
  return true;
}

}  // namespace

std::string worst_words(const LegendFacts& facts) {
  if (facts.min == facts.max) return short_number(facts.max) + " everywhere";
  const bool large = large_is_worse(facts.look);
  return fmt::format("{} {} at {}", large ? "most" : "least", short_number(large ? facts.max : facts.min),
                     large ? facts.max_at : facts.min_at);
}

std::vector<std::string> legend_notes(const LegendFacts& facts) {
  std::vector<std::string> notes;
  if (facts.before_pull) notes.emplace_back("As before this pull: the colours follow when you let go.");
  if (facts.new_nodes > 0) notes.push_back(counted(facts.new_nodes, "new node") + " measured from between those it was made of");
  if (facts.shells_without > 0) notes.push_back(counted(facts.shells_without, "shell") + " without a value");
  return notes;
}

DrawnLegend legend(const LegendFacts& facts, display::PixelSize picture) {
  const float font = ImGui::GetFontSize(), share = static_cast<float>(std::min(0.36, facts.widest));
  const float width = on_grid(std::min(22 * font, share * static_cast<float>(picture.width) - 3 * kGrid));
  const float limit_width = std::min(5.5f * font, 0.4f * width);
  ImGui::SetNextWindowPos(
      ImVec2(std::floor(static_cast<float>(facts.centre * picture.width)), static_cast<float>(picture.height) - kMargin), 0,
      ImVec2(0.5f, 1));
  ImGui::SetNextWindowSize(ImVec2(width + 2 * kGrid, 0));
  const std::string name = "Legend" + std::to_string(facts.pane.value_or(9));
  ImGui::Begin(name.c_str(), nullptr, kPanelFlags | ImGuiWindowFlags_AlwaysAutoResize);
  const float inner = ImGui::GetContentRegionAvail().x;
  ImGui::TextUnformatted(printable(facts.unit.empty() ? facts.title : facts.title + ", " + facts.unit).c_str());
  if (!facts.of.empty()) {
    ImGui::PushFont(small_font());
    ImGui::TextWrapped("%s", printable(facts.of).c_str());
    ImGui::PopFont();
  }
  draw_bar(facts, inner);
  DrawnLegend drawn;
  double clear = facts.look.clear, full = facts.look.full;
  if (facts.pane) {
    const bool clear_set = edit_limit("##clear", clear, full - clear, limit_width);
    ImGui::SameLine(inner - limit_width + ImGui::GetStyle().WindowPadding.x);
    const bool full_set = edit_limit("##full", full, full - clear, limit_width);
    if ((clear_set || full_set) && clear != full) drawn.wanted = SetLimits{clear, full};
  } else {
    const std::string left = short_number(clear), right = short_number(full);
    ImGui::TextUnformatted(left.c_str());
    ImGui::SameLine(inner - ImGui::CalcTextSize(right.c_str()).x + ImGui::GetStyle().WindowPadding.x);
    ImGui::TextUnformatted(right.c_str());
  }
  ImGui::PushFont(small_font());
  const std::string own = printable(fmt::format("{} {}: own colour", large_is_worse(facts.look) ? "up to" : "from", short_number(clear)));
  const std::string worst = printable(worst_words(facts));
  ImGui::TextDisabled("%s", own.c_str());
  if (ImGui::CalcTextSize((own + worst).c_str()).x + 2 * kGrid <= inner) ImGui::SameLine(0, 2 * kGrid);
  ImGui::PushTextWrapPos(0);
  ImGui::TextDisabled("%s", worst.c_str());
  ImGui::PopTextWrapPos();
  for (const std::string& note : legend_notes(facts)) ImGui::TextWrapped("%s", note.c_str());
  ImGui::PopFont();
  drawn.top = ImGui::GetWindowPos().y;
  ImGui::End();
  return drawn;
}

namespace {

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
  for (const CompareFacts::State& state : facts.states)
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

void choose_against(const CompareFacts& facts, CompareEntry& entry, tools::CompareWish& wanted) {
  ImGui::TextDisabled("against");
  ImGui::SetNextItemWidth(-1);
  const bool deck = !wanted.against_generation && !tools::is_state(wanted.against);
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
    for (const CompareFacts::State& each : facts.states) {
      ImGui::PushID(static_cast<int>(each.number));
      if (ImGui::Selectable(printable(each.words).c_str(), wanted.against_generation == each.number))
        wanted.against_generation = each.number;
      ImGui::PopID();
    }
    ImGui::EndCombo();
  }
  if (deck) text_field("##deck", "the deck's path", entry.deck, wanted.against);
}

void choose_field(const CompareFacts& facts, CompareEntry& entry, tools::CompareWish& wanted) {
  section("Colours");
  const std::vector<Choice> all = choices();
  const auto now = std::find_if(all.begin(), all.end(), [&](const Choice& each) { return each.field == wanted.field; });
  ImGui::SetNextItemWidth(-1);
  if (ImGui::BeginCombo("##field", now != all.end() ? now->words.c_str() : "")) {
    for (const Choice& each : all)
      if (ImGui::Selectable(each.words.c_str(), each.field == wanted.field)) wanted.field = each.field;
    ImGui::EndCombo();
  }
  if (tools::needs_against(wanted)) choose_against(facts, entry, wanted);
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

void compare_panel(const PanelData& data, display::PixelSize picture, CompareEntry& entry, Actions& actions) {
  const CompareFacts& facts = *data.compare;
  tools::CompareWish wanted = facts.wish;
  begin_left("Comparing", picture);
  ImGui::PushFont(title_font());
  ImGui::TextUnformatted("Comparing");
  ImGui::PopFont();
  ImGui::PushFont(small_font());
  ImGui::TextDisabled("Shift+C closes; colours and views stay");
  ImGui::PopFont();
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
    fact("least", short_number(legend.min));
    fact("at", legend.min_at);
    fact("most", short_number(legend.max));
    fact("at", legend.max_at);
  }
  ImGui::End();
  if (wanted != facts.wish) actions.emplace_back(SetCompare{wanted});
}

void view_captions(const CompareFacts& facts, display::PixelSize picture, float top) {
  for (std::size_t i = 0; i < facts.captions.size(); ++i) {
    const CompareFacts::Caption& caption = facts.captions[i];
    ImGui::SetNextWindowPos(ImVec2(std::floor(static_cast<float>(caption.centre * picture.width)), top), 0, ImVec2(0.5f, 0));
    ImGui::Begin(("View" + std::to_string(i)).c_str(), nullptr,
                 kPanelFlags | ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoInputs);
    ImGui::TextUnformatted(printable(caption.words).c_str());
    ImGui::End();
  }
}

}  // namespace prismesh::kiosk::panels
