#include "tests/cost/operations.h"

#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <memory>
#include <numbers>
#include <optional>
#include <string_view>
#include <utility>

#include "ipc/model/snapshot_publisher.h"
#include "mesh/connections/find_joined_sheets.h"
#include "mesh/deck/open.h"
#include "mesh/deck/sample.h"
#include "mesh/document/drag.h"
#include "mesh/document/edit_json.h"
#include "mesh/document/find_dependents.h"
#include "mesh/document/journal.h"
#include "mesh/document/open.h"
#include "mesh/document/prepare.h"
#include "mesh/document/save.h"
#include "mesh/model/adjacency.h"
#include "mesh/quality/report.h"
#include "mesh/quality/structure.h"
#include "mesh/select/expression.h"
#include "mesh/select/loops.h"
#include "mesh/select/outline.h"
#include "mesh/select/region.h"
#include "mesh/select/visible.h"
#include "mesh/spatial/closest_point.h"
#include "mesh/spatial/cut_patch.h"
#include "mesh/spatial/geodesic.h"
#include "tests/bench/deck_twins.h"
#include "tests/cost/models.h"
#include "tests/support/whole_model.h"

namespace prismesh::cost {
namespace {

using namespace mesh;
using document::Document;
using document::Edit;

/// The value, or the end of the program: an operation that is refused has no cost.
template <class T>
T need(Result<T> result) {
  if (!result) {
    std::cerr << "cost: " << result.error().text() << '\n';
    std::exit(1);
  }
  return std::move(*result);
}

/// Keeps the compiler from leaving out what computes a value.
template <class T>
void keep(const T& value) {
  asm volatile("" : : "g"(&value) : "memory");
}

void write(const std::filesystem::path& path, std::string_view text) { std::ofstream(path, std::ios::binary) << text; }

Edit edit_of(const std::string& fields) { return need(document::parse_edit("{" + fields + "}")); }

void do_edit(Document& document, const std::string& fields) { (void)need(document::apply(document, edit_of(fields))); }

quality::SizedCriteria criteria() { return {quality::default_criteria(), 5.0}; }

// --- opening ---

Work open_deck(const std::filesystem::path& path) {
  return [path] { keep(need(deck::open(path))); };
}

Work open_document(const Inputs& inputs) {
  const auto opened = std::make_shared<deck::OpenedDeck>(need(deck::open(inputs.folder / "sample.k")));
  return [opened, &inputs] { keep(need(document::open(inputs.folder / "sample.k", std::move(*opened), {}))); };
}

/// What depends on the sheets of the sample, which are many times as thick here. So they stand for finer meshes: where shells are smaller
/// than their thickness, welds are looked for beyond their neighbours.
Work dependents_of_thick_sheets(const Inputs& inputs) {
  constexpr double kThicker = 12;  // as thick for their size as those of the sample of some five million shells
  const auto document = std::make_shared<const Document>(inputs.sample);
  const auto model = std::make_shared<Model>(document->opened->model);
  std::vector<Part> parts = *model->parts;
  for (Part& part : parts)
    if (part.thickness) *part.thickness *= kThicker;
  model->parts = std::make_shared<const std::vector<Part>>(std::move(parts));
  return [document, model] { keep(document::find_dependents(*document->deck, *model, document->opened->relations->element_uses)); };
}

// --- selecting ---

Work region_from(const Model& model, NodeIndex node) {
  return [&model, node] {
    keep(select::region(model, select::shells_at(model, node, {}), {select::RegionBound::features, 60, {}, nullptr}));
  };
}

/// A node in the middle of the sheet, as far from a free edge as can be.
NodeIndex middle_of_sheet(const Model& sheet) {
  const auto side = static_cast<std::size_t>(std::sqrt(static_cast<double>(sheet.shell_count())));
  return NodeIndex(side / 2 * (side + 1) + side / 2);
}

Work loop_from(const Model& model, NodeIndex node) {
  return [&model, node] { keep(select::free_edge_loop(model, select::shells_at(model, node, {}), model.position(node), {})); };
}

/// The rails from above fill the picture, seen against z.
std::array<double, 16> view_of(const Model& model) {
  Vec3 low = model.positions[0], high = low;
  for (std::size_t i = 0; i < model.node_count(); ++i) {
    low = low.cwiseMin(model.positions[i]);
    high = high.cwiseMax(model.positions[i]);
  }
  const Vec3 middle = 0.5 * (low + high);
  const double x = 2 / (high.x() - low.x()), y = 2 / (high.y() - low.y()), z = -1 / (high.z() - low.z());
  return {x, 0, 0, 0, 0, y, 0, 0, 0, 0, z, 0, -x * middle.x(), -y * middle.y(), -z * middle.z(), 1};
}

/// A lasso of 256 corners with an irregular border around half of the picture.
std::vector<std::array<double, 2>> lasso() {
  std::vector<std::array<double, 2>> outline;
  for (int k = 0; k < 256; ++k) {
    const double t = 2 * std::numbers::pi * k / 256, r = 0.7 + 0.2 * std::sin(5 * t) + 0.05 * std::cos(31 * t);
    outline.push_back({r * std::cos(t), r * std::sin(t)});
  }
  return outline;
}

Work lasso_on(const Model& model) {
  return [&model, view = view_of(model), outline = lasso()] { keep(select::inside_outline(model, view, outline)); };
}

Work visible_in(const Model& model) {
  const auto view = view_of(model);
  return
      [&model, view, inside = select::inside_outline(model, view, lasso())] { keep(need(select::visible_nodes(model, view, inside, {}))); };
}

Work geodesic_on(const Model& model) {
  const auto patch = std::make_shared<const spatial::Patch>(spatial::cut_patch(model, test::all_shells(model)));
  return [patch, source = std::vector<std::uint32_t>{static_cast<std::uint32_t>(middle_of_sheet(model).value)}] {
    keep(spatial::geodesic_distance(*patch, source));
  };
}

// --- shaping ---

std::string grab_of(const Inputs& inputs) {
  const Model& model = inputs.rails.current().model;
  return R"(,"grab":)" + std::to_string(model.node_ids[middle_of_top(model).value]);
}
constexpr const char* kTranslate = R"("edit":"translate","by":[0.6,0.7,3])";
constexpr const char* kLift = R"("edit":"lift","distance":3)";
constexpr const char* kLiftEach = R"("edit":"lift","distance":3,"normals":"each")";
constexpr const char* kSlide = R"("edit":"slide","by":[0.6,2,0])";
constexpr const char* kRotate = R"("edit":"rotate","point":[200,0,0],"axis":[0.2,1,0],"degrees":2)";

document::Drag drag_on(const Document& document, const Edit& edit) {
  return need(document::Drag::begin(document.generations[document.cursor], edit));
}

Work drag_begin(const Inputs& inputs) {
  return [&inputs, edit = edit_of(kTranslate + grab_of(inputs))] { keep(drag_on(inputs.pulled, edit)); };
}

Work drag_step(const Inputs& inputs, const char* kind) {
  const Edit edit = edit_of(kind + grab_of(inputs));
  const auto drag = std::make_shared<document::Drag>(drag_on(inputs.pulled, edit));
  drag->step({});
  return [drag, displacement = displacement_of(edit)] {
    drag->step(displacement);
    keep(drag->counts());
  };
}

// --- edits ---

Work prepare_edit(const Document& document, const std::string& fields) {
  return [&document, edit = edit_of(fields)] { keep(need(document::prepare(document, edit))); };
}

/// The rails with three neighbours on the top selected, whatever the size of the model. Selecting by an expression costs the model; lifting
/// what is selected doesn't.
Document with_three_selected(const Inputs& inputs) {
  Document document = inputs.rails;
  const Model& model = document.current().model;
  const std::int64_t middle = model.node_ids[middle_of_top(model).value];
  do_edit(document, R"("edit":"select","expr":")" + std::to_string(middle - 1) + "-" + std::to_string(middle + 1) + "\"");
  return document;
}
constexpr const char* kSmallLift = R"("edit":"lift","distance":1)";

Work lift_three_nodes(const Inputs& inputs) {
  return [document = with_three_selected(inputs), edit = edit_of(kSmallLift)] { keep(need(document::prepare(document, edit))); };
}

Work undo(const Inputs& inputs) {
  const auto document = std::make_shared<Document>(inputs.pulled);
  return [document] { (void)need(document::apply(*document, Edit(document::Undo{}))); };
}

/// Splits a shell of the sample; if asked for, after all nodes were moved.
Work split(const Inputs& inputs, bool moved) {
  const auto document = std::make_shared<Document>(inputs.sample);
  if (moved) do_edit(*document, R"("edit":"translate","by":[1,0,0.3],"on":"all","falloff":{"profile":"constant"})");
  const Model& model = document->current().model;
  const Edit edit = edit_of(R"("edit":"split","at":["shell:)" + std::to_string(model.shell_ids[model.shell_count() / 2]) + "\"]");
  return [document, edit] { keep(need(document::prepare(*document, edit))); };
}

Work append_to_journal(const Inputs& inputs) {
  const auto path = inputs.folder / "rails.journal";
  const auto journal = std::make_shared<document::Journal>(need(document::Journal::create(path, inputs.rails)));
  const Edit edit = edit_of(R"("edit":"translate","by":[0,0,1],"on":")" + top_of_first_rail(inputs.rails.current().model) + "\"");
  const auto prepared = std::make_shared<document::Prepared>(need(document::prepare(inputs.rails, edit)));
  return [journal, edit, prepared, &inputs] {
    if (const Result<void> appended = journal->append(inputs.rails, edit, *prepared); !appended) need<int>(fail(appended.error()));
  };
}

Work save_sample(const Inputs& inputs) {
  const auto document = std::make_shared<Document>(inputs.sample);
  do_edit(*document, R"("edit":"translate","by":[0.1,0.3,0],"on":"part:1","falloff":{"profile":"constant"})");
  return [document, &inputs] { keep(need(document::save(*document, inputs.folder / "out" / "sample.k"))); };
}

// --- snapshots ---

Work first_snapshot(const Inputs& inputs) {
  return [&inputs] {
    ipc::SnapshotPublisher publisher;
    keep(need(publisher.publish(inputs.rails, true)));
  };
}

Work snapshot_after_small_edit(const Inputs& inputs) {
  const auto publisher = std::make_shared<ipc::SnapshotPublisher>();
  const auto document = std::make_shared<Document>(with_three_selected(inputs));
  (void)need(publisher->publish(*document, true));
  do_edit(*document, kSmallLift);
  return [publisher, document] { keep(need(publisher->publish(*document, true))); };
}

std::vector<Operation> make_operations() {
  const auto rails = [](const Inputs& inputs) -> const Model& { return inputs.rails.current().model; };
  return {
      {"open LS-DYNA", [](const Inputs& in) { return open_deck(in.folder / "sample.k"); }},
      {"open Nastran", [](const Inputs& in) { return open_deck(in.folder / "rails.bdf"); }},
      {"open Radioss", [](const Inputs& in) { return open_deck(in.folder / "rails_0000.rad"); }},
      {"open Abaqus", [](const Inputs& in) { return open_deck(in.folder / "rails.inp"); }},
      {"document of a deck", open_document},
      {"welds of thick sheets", dependents_of_thick_sheets},
      {"adjacency", [=](const Inputs& in) -> Work { return [&model = rails(in)] { keep(build_adjacency(model)); }; }},
      {"metrics", [=](const Inputs& in) -> Work { return [&model = rails(in)] { keep(quality::judge_model(model, criteria())); }; }},
      {"report", [=](const Inputs& in) -> Work { return [&model = rails(in)] { keep(quality::report(model, criteria(), {})); }; }},
      {"structure", [=](const Inputs& in) -> Work { return [&model = rails(in)] { keep(quality::check_structure(model)); }; }},
      {"welds",
       [](const Inputs& in) -> Work {
         return [&model = in.sample.current().model] { keep(connections::find_joined_sheets(model, {}, {})); };
       }},
      {"expression",
       [=](const Inputs& in) -> Work {
         return [&model = rails(in)] { keep(need(select::evaluate(model, "1-900000:3,!1-500000:20,17-5000", select::EntityKind::node))); };
       }},
      {"region on a flat sheet", [](const Inputs& in) { return region_from(in.sheet, middle_of_sheet(in.sheet)); }},
      {"region between fillets", [=](const Inputs& in) { return region_from(rails(in), middle_of_top(rails(in))); }},
      {"free edge loop", [=](const Inputs& in) { return loop_from(rails(in), middle_of_top(rails(in))); }},
      {"lasso", [=](const Inputs& in) { return lasso_on(rails(in)); }},
      {"visible nodes", [=](const Inputs& in) { return visible_in(rails(in)); }},
      {"geodesic", [](const Inputs& in) { return geodesic_on(in.sheet); }},
      {"tree",
       [=](const Inputs& in) -> Work {
         return [&model = rails(in), shells = test::all_shells(rails(in))] { keep(spatial::ShellTree(model, shells)); };
       }},
      {"begin drag", drag_begin},
      {"drag step: translate", [](const Inputs& in) { return drag_step(in, kTranslate); }},
      {"drag step: lift", [](const Inputs& in) { return drag_step(in, kLift); }},
      {"drag step: lift each", [](const Inputs& in) { return drag_step(in, kLiftEach); }},
      {"drag step: slide", [](const Inputs& in) { return drag_step(in, kSlide); }},
      {"drag step: rotate", [](const Inputs& in) { return drag_step(in, kRotate); }},
      {"lift", [](const Inputs& in) { return prepare_edit(in.pulled, kLift + grab_of(in)); }},
      {"lift three nodes", lift_three_nodes},
      {"undo", undo},
      {"split by hand", [](const Inputs& in) { return split(in, false); }},
      {"split after all moved", [](const Inputs& in) { return split(in, true); }},
      {"relax", [](const Inputs& in) { return prepare_edit(in.pulled, R"("edit":"relax")"); }},
      {"repair", [](const Inputs& in) { return prepare_edit(in.rails, R"("edit":"repair","scope":"failed")"); }},
      {"journal", append_to_journal},
      {"save", save_sample},
      {"first snapshot", first_snapshot},
      {"snapshot after three nodes", snapshot_after_small_edit},
  };
}

}  // namespace

Inputs make_inputs(const std::filesystem::path& folder, std::size_t shells) {
  const Model model = rails(shells);
  write(folder / "sample.k", deck::sample_text(shells));
  write(folder / "rails.bdf", bench::nastran_twin_text(model));
  write(folder / "rails_0000.rad", bench::radioss_twin_text(model));
  write(folder / "rails.inp", bench::abaqus_twin_text(model));
  std::filesystem::create_directory(folder / "out");
  document::OpenOptions options;
  options.target_size = 5.0;
  const Document opened = need(document::open(folder / "rails.bdf", options));
  Inputs inputs{folder, flat_sheet(shells), opened, opened, need(document::open(folder / "sample.k", {}))};
  do_edit(inputs.pulled, R"("edit":"select","expr":")" + top_of_first_rail(opened.current().model) + "\"");
  do_edit(inputs.pulled, kTranslate + grab_of(inputs));
  return inputs;
}

const std::vector<Operation>& operations() {
  static const std::vector<Operation> kAll = make_operations();
  return kAll;
}

}  // namespace prismesh::cost
