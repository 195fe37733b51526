// Measures every panel with as much in it as a large deck gives: one layout each, in a picture of 1920 x 1080. Limit: 2 ms.
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>
#include <imgui.h>

#include "kiosk/display/headless.h"
#include "kiosk/editor_keys.h"
#include "kiosk/input/key_table.h"
#include "kiosk/panels/document_panel.h"
#include "kiosk/panels/frame_panels.h"
#include "kiosk/panels/gui.h"
#include "kiosk/panels/key_panels.h"
#include "kiosk/panels/layout.h"
#include "kiosk/panels/message_panels.h"
#include "kiosk/panels/warnings_panel.h"
#include "kiosk/tool_list.h"
#include "kiosk/tools/contact/contact_panel.h"
#include "kiosk/tools/files/path_box.h"
#include "kiosk/tools/find/find_box.h"
#include "kiosk/tools/history/state_list.h"
#include "kiosk/tools/quality/quality_panel.h"
#include "kiosk/tools/shaping/shaping_panel.h"

namespace {

using namespace prismesh;
using namespace prismesh::kiosk;

constexpr display::PixelSize kPanelsPicture{1920, 1080};
const panels::Place kPanelsDock{0, 36, 312, 1000};
const panels::Place kPanelsView{120, 36, 1480, 960};

/// Layouts of one panel; what is measured includes beginning and ending the picture's layout.
void lay_out(benchmark::State& state, const std::function<void(panels::PanelLayout&)>& panel) {
  const auto headless = display::Headless::create();
  if (!headless) return state.SkipWithError("no OpenGL ES here");
  panels::Gui gui = std::move(*panels::Gui::create());
  (void)gui.set_type(panels::kFlatType);
  const auto once = [&] {
    panels::PanelLayout layout{kPanelsPicture};
    gui.layout(kPanelsPicture, 0.016, [&] {
      layout.places = panels::place_panels(kPanelsPicture, ImGui::GetFontSize(), {});
      panel(layout);
    });
  };
  for (int round = 0; round < 3; ++round) once();
  for (auto _ : state) once();
}

void in_dock(benchmark::State& state, const std::function<void(panels::PanelLayout&)>& panel) {
  lay_out(state, [&](panels::PanelLayout& layout) {
    panels::begin_docked("Dock", kPanelsDock);
    ImGui::BeginChild("panel");
    panel(layout);
    ImGui::EndChild();
    ImGui::End();
  });
}

void frame(benchmark::State& state) {
  const auto key = [](EditorCommand command) -> const input::KeyBinding& { return input::binding_of(key_bindings(), command_of(command)); };
  const panels::BarKeys keys{key(EditorCommand::undo), key(EditorCommand::redo), key(EditorCommand::deck_warnings),
                             &key(EditorCommand::menu), key(EditorCommand::help)};
  const std::vector<panels::RailButton> rail(8, panels::RailButton{"Select", &key(EditorCommand::undo), true});
  lay_out(state, [&](panels::PanelLayout& layout) {
    panels::bar_panel(
        {"deck.k", "/d/deck.k", true, true, true}, keys, key_bindings(), [](input::Menu) {}, layout);
    panels::rail_panel(rail, layout);
    panels::status_panel({"Pull", "node 5000766  (1 2 3) mm   shell 12   part 1 Rail", "592 nodes selected", "mm", {}}, layout);
    benchmark::DoNotOptimize(panels::borders({}, layout));
  });
}
BENCHMARK(frame)->Unit(benchmark::kMillisecond);

void all_keys(benchmark::State& state) {
  lay_out(state, [](panels::PanelLayout& layout) { panels::help_panel(key_bindings(), {}, panels::whole(layout.picture)); });
}
BENCHMARK(all_keys)->Unit(benchmark::kMillisecond);

void all_commands(benchmark::State& state) {
  lay_out(state, [](panels::PanelLayout& layout) { panels::menu_panel(key_bindings(), layout); });
}
BENCHMARK(all_commands)->Unit(benchmark::kMillisecond);

void ten_thousand_warnings(benchmark::State& state) {
  const std::vector<notices::ToldWarning> warnings(10'000,
                                                   {false, "/decks/car/include/side_panel.k:1234567",
                                                    "the section 12345 names a material that isn't defined, so its shells have no time "
                                                    "step; 17 parts use it"});
  lay_out(state, [&](panels::PanelLayout& layout) { panels::warnings_panel(warnings, "/d/deck.k", panels::whole(layout.picture)); });
}
BENCHMARK(ten_thousand_warnings)->Unit(benchmark::kMillisecond);

void longest_notice(benchmark::State& state) {
  const input::KeyBinding& list = input::binding_of(key_bindings(), command_of(EditorCommand::deck_warnings));
  const notices::Notice notice{notices::Notice::Kind::information, std::string(100'000, 'x')};
  lay_out(state, [&](panels::PanelLayout&) { panels::notice_panel({notice, 3}, kPanelsView, {990, list}); });
}
BENCHMARK(longest_notice)->Unit(benchmark::kMillisecond);

void ten_thousand_states(benchmark::State& state) {
  tools::history::StateFacts facts;
  for (std::uint64_t i = 0; i < 10'000; ++i) facts.states.push_back({i, "Select region", i % 3 == 0});
  for (std::uint64_t i = 1; i <= 1000; ++i) facts.branches.push_back({i, "2 states, from Hide", "Lift, Lock", i});
  facts.current = 5000;
  in_dock(state, [&](panels::PanelLayout& layout) { benchmark::DoNotOptimize(tools::history::state_list(facts, true, layout)); });
}
BENCHMARK(ten_thousand_states)->Unit(benchmark::kMillisecond);

void three_hundred_contacts(benchmark::State& state) {
  ipc::Contacts contacts;
  for (int i = 0; i < 300; ++i) {
    ipc::ContactRegion& region = contacts.regions.emplace_back();
    region.kind = i < 100 ? "perforation" : "penetration";
    region.a = "part:" + std::to_string(i), region.b = "part:" + std::to_string(i + 1);
    region.name_a = region.name_b = "Reinforcement of the sill";
  }
  contacts.penetrations = 300;
  in_dock(state, [&](panels::PanelLayout& layout) {
    benchmark::DoNotOptimize(tools::contact::contact_panel({&contacts, false, false, {}, "mm", 7, false}, layout));
  });
}
BENCHMARK(three_hundred_contacts)->Unit(benchmark::kMillisecond);

void five_hundred_errors(benchmark::State& state) {
  ipc::Quality quality;
  for (int m = 0; m < 12; ++m) quality.metrics.push_back({"aspect", "", 100, 20});
  for (int b = 0; b < 20; ++b) quality.bars.push_back({b * 0.1, b * 0.1 + 0.1, false, false, 100, 10, 1});
  for (std::size_t e = 0; e < 500; ++e) {
    ipc::QualityError& error = quality.errors.emplace_back();
    error.metric = "aspect";
  }
  quality.error_count = 500;
  tools::quality::QualityFacts facts;
  facts.figures = &quality;
  facts.length_unit = "mm";
  in_dock(state, [&](panels::PanelLayout& layout) { benchmark::DoNotOptimize(tools::quality::quality_panel(facts, layout)); });
}
BENCHMARK(five_hundred_errors)->Unit(benchmark::kMillisecond);

void pulling(benchmark::State& state) {
  const tools::shaping::ShapingFacts facts{{}, "mm"};
  in_dock(state, [&](panels::PanelLayout& layout) { benchmark::DoNotOptimize(tools::shaping::shaping_panel(facts, layout)); });
}
BENCHMARK(pulling)->Unit(benchmark::kMillisecond);

void found_commands(benchmark::State& state) {
  tools::find::FindFacts facts;
  for (int i = 0; i < 120; ++i) facts.rows.push_back({"Shape: the axis is the deck's x through the handle", "Shift+X"});
  tools::find::FindEntry entry;
  lay_out(state, [&](panels::PanelLayout& layout) { benchmark::DoNotOptimize(tools::find::find_box(facts, false, entry, layout)); });
}
BENCHMARK(found_commands)->Unit(benchmark::kMillisecond);

void folder_of_files(benchmark::State& state) {
  tools::files::PathFacts facts{};
  facts.dialog = tools::files::PathDialog::open;
  facts.deck = "/usr/bin/x";
  facts.opened = true;
  tools::files::PathEntry entry;
  entry.all = true;
  lay_out(state, [&](panels::PanelLayout& layout) {
    benchmark::DoNotOptimize(tools::files::path_box(facts, entry, layout));
    facts.opened = false;
  });
}
BENCHMARK(folder_of_files)->Unit(benchmark::kMillisecond);

}  // namespace
