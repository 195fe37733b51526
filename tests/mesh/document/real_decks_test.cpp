// An editing session on every LS-DYNA deck that PRISMESH_MODELS points to: saved, read again, and brought back from its journal.
#include <cstdlib>
#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "mesh/deck/save.h"
#include "mesh/document/journal.h"
#include "mesh/spatial/closest_point.h"
#include "tests/mesh/document/document_fixture.h"

namespace prismesh::mesh::document {
namespace {

namespace fs = std::filesystem;

/// A lift of a region around the middle shell, an undo, a redo, a second pull, a slide, a turn on both sides of a plane, and all locked.
std::vector<Edit> session_for(const Document& document) {
  const Model& model = document.current().model;
  const NodeIndex node = model.shell_nodes[model.shell_count() / 2].node[0];
  const Vec3& at = model.position(node);
  const double size = document.settings.target_size;
  SelectRegion region{.at = NodeReference(model.node_ids[node.value]), .angle = 30};
  Lift lift;
  lift.distance = 0.4 * size;
  lift.shaping.grab = std::array<double, 3>{at.x(), at.y(), at.z()};
  Translate pull;
  pull.by = Vec3(0.1, 0.2, -0.3) * size;
  pull.shaping.on = TargetNodes(region);
  pull.shaping.max_move = 0.2 * size;
  Slide slide;
  slide.by = Vec3(2.1, 1.3, 0.7) * size;
  slide.shaping.on = TargetNodes(region);
  Rotate rotate{at - Vec3(0, 0, 5) * size, Vec3(1, 0.2, 0), 2, {}};
  rotate.shaping.on = TargetNodes(region);
  rotate.shaping.symmetry = Symmetry{Vec3::Zero(), Vec3::UnitY()};
  return {Edit(region), Edit(lift),    Edit(Undo{}),
          Edit(Redo{}), Edit(Grow{2}), Edit(pull),
          Edit(slide),  Edit(rotate),  Edit(SetParts{VisibilityAction::lock, "all"})};
}

/// The nodes that moved, mid-side nodes left out, lie on the faces as they were.
void expect_on_faces(const Model& before, const Model& after) {
  ShellSet shells;
  for (std::size_t i = 0; i < before.shell_count(); ++i) shells.emplace_back(i);
  const spatial::ShellTree faces(before, shells);
  for (const NodeIndex node : moved_nodes(before, after)) {
    if (before.adjacency->shells_of(node).empty()) continue;
    const double size = (after.position(node) - before.position(node)).norm();
    const double coordinates = after.position(node).norm();
    ASSERT_LE(faces.closest(after.position(node))->distance, 1e-9 * size + 1e-12 * coordinates) << before.node_ids[node.value];
  }
}

/// Applies and journals; returns how many edits were done. Refusals must have words.
std::size_t run_session(Document& document, Journal& journal) {
  std::size_t done = 0;
  for (const Edit& edit : session_for(document)) {
    Result<Prepared> prepared = prepare(document, edit);
    if (!prepared) {
      EXPECT_FALSE(prepared.error().message.empty());
      continue;
    }
    EXPECT_EQ(quality::count(prepared->next->quality), prepared->next->counts);
    EXPECT_TRUE(journal.append(document, edit, *prepared));
    if (std::holds_alternative<Slide>(edit)) expect_on_faces(document.current().model, prepared->next->model);
    commit(document, std::move(*prepared));
    ++done;
  }
  return done;
}

void expect_saved_as_edited(const Document& document, const fs::path& target) {
  const Result<deck::SaveReport> saved = save(document, target);
  if (!saved) {
    EXPECT_NE(saved.error().message.find("include"), std::string::npos) << saved.error().text();
    return;
  }
  EXPECT_EQ(saved->nodes_written, moved_nodes(document.opened->model, document.current().model).size());
  const Result<Document> again = open(target, OpenOptions{});
  ASSERT_TRUE(again) << again.error().text();
  const Model& read = again->current().model;
  const Model& meant = document.current().model;
  ASSERT_EQ(read.node_count(), meant.node_count());
  for (std::size_t n = 0; n < read.node_count(); ++n) {
    // what wasn't moved is read exactly as before; what was, to the digits its columns hold
    const bool moved = document.opened->model.positions[n] != meant.positions[n];
    const double error = (read.positions[n] - meant.positions[n]).norm();
    ASSERT_LE(error, moved ? 1e-3 * document.settings.target_size : 0.0) << "node " << meant.node_ids[n];
  }
}

TEST(RealDecks, edited_saved_and_recovered) {
  const char* models = std::getenv("PRISMESH_MODELS");
  if (models == nullptr || !fs::exists(fs::path(models) / "counts.json"))
    GTEST_SKIP() << "PRISMESH_MODELS doesn't point to the real decks: EDITING THEM IS NOT TESTED";
  std::ifstream in(fs::path(models) / "counts.json");
  const nlohmann::json counts = nlohmann::json::parse(in);
  std::size_t edited = 0;
  for (const auto& [name, entry] : counts.items()) {
    if (entry["format"] != "lsdyna") continue;
    SCOPED_TRACE(name);
    const fs::path path = fs::path(models) / entry["main"].get<std::string>();
    Result<Document> document = open(path, OpenOptions{});
    if (!document || document->current().model.shell_count() == 0) continue;
    const Folder folder;
    {
      Result<Journal> journal = Journal::create(folder / "journal", *document);
      ASSERT_TRUE(journal) << journal.error().text();
      if (run_session(*document, *journal) >= 5) ++edited;
    }
    fs::create_directories(folder / "out");
    expect_saved_as_edited(*document, folder / "out" / path.filename());
    Document again = open(path, OpenOptions{}).value();
    const Result<Journal> journal = Journal::recover(folder / "journal", again);
    ASSERT_TRUE(journal) << journal.error().text();
    expect_same(again, *document);
    Document replayed = open(path, OpenOptions{}).value();
    for (const ReplayStep& step : replay(replayed, read_intents(folder / "journal").value())) EXPECT_TRUE(step.applied) << step.message;
    expect_same(replayed.current(), document->current());
  }
  EXPECT_GE(edited, 10u);
}

}  // namespace
}  // namespace prismesh::mesh::document
