// Rotate, slide and symmetric editing through a document: as edits, as drags, undone, replayed.
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <nlohmann/json.hpp>

#include "mesh/document/drag.h"
#include "mesh/document/journal.h"
#include "mesh/spatial/closest_point.h"
#include "tests/mesh/document/document_fixture.h"
#include "tests/support/seed.h"

namespace prismesh::mesh::document {
namespace {

using testing::Contains;
using testing::HasSubstr;

/// A sheet of quads, symmetric in x = 0 to the bit, that bends along y only: its faces are flat. Node (i, j) has the id 1 + i + 21 j.
Model symmetric_sheet() {
  return test::make_grid(20, 20, [](int i, int j) {
    const double side = i < 10 ? -1 : 1;
    const int out = std::abs(i - 10);
    return Vec3(side * (5.0 * out + 0.3 * (out % 3 == 1)), 5.0 * j + 0.2 * (j % 4), 0.02 * j * j);
  });
}

/// Bends every way and has mid-side nodes on every third shell; 40 x 40 quads.
Model wavy_with_midsides() {
  const Model corners = test::make_grid(40, 40, [](int i, int j) {
    return Vec3(5.0 * (i - 20) + 0.1 * ((i * 7 + j * 3) % 5), 5.0 * j + 0.1 * ((i * 5 + j) % 7),
                6 * std::cos((i - 20) / 5.0) * std::cos((j - 20) / 6.0));
  });
  std::vector<test::NodeSpec> nodes;
  std::vector<test::ShellSpec> shells;
  for (std::size_t n = 0; n < corners.node_count(); ++n) nodes.push_back({corners.node_ids[n], corners.positions[n]});
  for (std::size_t s = 0; s < corners.shell_count(); ++s) {
    test::ShellSpec shell{corners.shell_ids[s], 1, {}};
    for (const NodeIndex node : corners.shell_nodes[s].node) shell.nodes.push_back(corners.node_ids[node.value]);
    shells.push_back(shell);
  }
  std::vector<std::array<std::int64_t, 4>> middle_ids;
  for (std::size_t s = 0; s < shells.size(); s += 3) {
    std::array<std::int64_t, 4> middle{};
    for (std::size_t i = 0; i < 4; ++i) {
      const auto place = [&](std::size_t k) { return corners.positions[corners.shell_nodes[s].node[k % 4].value]; };
      middle[i] = 100'000 + static_cast<std::int64_t>(nodes.size());
      nodes.push_back({middle[i], (place(i) + place(i + 1)) / 2});
    }
    middle_ids.push_back(middle);
  }
  Model model = test::make_model(nodes, shells);
  std::vector<MidsideNodes> midside;
  for (std::size_t k = 0; k < middle_ids.size(); ++k) {
    MidsideNodes middle;
    middle.shell = ShellIndex(3 * k);
    for (std::size_t i = 0; i < 4; ++i) middle.node[i] = model.find_node(middle_ids[k][i]);
    midside.push_back(middle);
  }
  model.midside = std::make_shared<std::vector<MidsideNodes>>(std::move(midside));
  return model;
}

TEST(Shaping, a_bent_flange_keeps_its_width) {
  // the half beyond x = 50 turns up by a right angle
  Document document = make_sheet(20, 4);
  const EditReport report = must_apply(
      document,
      R"({"edit":"rotate","point":[50,0,0],"axis":[0,-3,0],"degrees":90,"on":{"edit":"select","expr":"11-21,32-42,53-63,74-84,95-105"},"falloff":{"profile":"constant"}})");
  EXPECT_EQ(report.nodes_moved, 50u);  // the nodes on the axis stay
  for (int i = 10; i <= 20; ++i) EXPECT_EQ(place_of(document, 1 + i), Vec3(50, 0, 5.0 * (i - 10)));
}

TEST(Shaping, free_ends_turn_as_a_whole) {
  // the weights of a rotation are those of a translation: the free edge follows whole, the rim stays
  Document document = make_sheet(8, 2);
  must_apply(
      document,
      R"({"edit":"rotate","point":[0,0,20],"axis":[0,1,0],"degrees":30,"on":"2-9,11-18,20-27","grab":18,"falloff":{"profile":"linear"}})");
  for (int j = 0; j <= 2; ++j)
    for (int i = 1; i <= 8; ++i) {
      const Vec3 from(5.0 * i, 5.0 * j, 0), to = place_of(document, 1 + i + 9 * j);
      const Vec3 radius_before = from - Vec3(0, from.y(), 20), radius_after = to - Vec3(0, to.y(), 20);
      EXPECT_NEAR(radius_before.norm(), radius_after.norm(), 1e-12);
      const double turned = 2 * std::asin((to - from).norm() / (2 * radius_before.norm()));
      EXPECT_NEAR(turned * 180 / M_PI, 30.0 * (i - 1) / 7, 1e-9);
    }
}

TEST(Shaping, a_rigid_motion_keeps_all_distances) {
  Document document = make_sheet(20, 4);
  must_apply(
      document,
      R"({"edit":"move","by":[3,-2,7],"point":[50,0,0],"axis":[0,-3,0],"degrees":90,"on":"11-21,32-42,53-63,74-84,95-105","falloff":{"profile":"constant"}})");
  // turned first, then moved
  for (int i = 10; i <= 20; ++i) EXPECT_LT((place_of(document, 1 + i) - Vec3(53, -2, 5.0 * (i - 10) + 7)).norm(), 1e-12);
}

TEST(Shaping, a_motion_of_one_kind_is_that_of_the_other_edits) {
  const auto same = [](const std::string& a, const std::string& b) {
    Document one = make_document(wavy_with_midsides()), two = make_document(wavy_with_midsides());
    must_apply(one, a);
    must_apply(two, b);
    for (std::size_t n = 0; n < one.current().model.node_count(); ++n)
      ASSERT_EQ(one.current().model.positions[n], two.current().model.positions[n]) << a;
  };
  const std::string rest = R"(,"on":"300-1400","grab":700,"falloff":{"profile":"sharp"}})";
  same(R"({"edit":"move","by":[1,2,3])" + rest, R"({"edit":"translate","by":[1,2,3])" + rest);
  const std::string turn = R"("point":[20,20,5],"axis":[1,2,3],"degrees":33)";
  same(R"({"edit":"move",)" + turn + rest, R"({"edit":"rotate",)" + turn + rest);
}

TEST(Shaping, the_share_of_a_motion_is_a_share_of_its_turn_and_its_way) {
  Document document = make_sheet(8, 2);
  must_apply(
      document,
      R"({"edit":"move","by":[0,0,14],"point":[0,0,0],"axis":[0,0,1],"degrees":70,"on":"2-9,11-18,20-27","grab":18,"falloff":{"profile":"linear"}})");
  for (int i = 1; i <= 8; ++i) {
    const double share = (i - 1) / 7.0;
    const Vec3 to = place_of(document, 1 + i + 9);
    EXPECT_NEAR(to.z(), 14 * share, 1e-9);
    EXPECT_NEAR(to.head<2>().norm(), Vec3(5.0 * i, 5, 0).norm(), 1e-9);
    EXPECT_NEAR(std::atan2(to.y(), to.x()) - std::atan2(5, 5.0 * i), 70 * share * M_PI / 180, 1e-9);
  }
}

TEST(Shaping, max_move_holds_a_motion_on_the_line_to_its_start) {
  Document document = make_sheet(8, 2);
  const EditReport report = must_apply(
      document,
      R"({"edit":"move","by":[0,0,30],"point":[0,0,0],"axis":[0,0,1],"degrees":20,"on":"9,18,27","falloff":{"profile":"constant"},"max_move":4})");
  for (const int id : {9, 18, 27}) EXPECT_NEAR((place_of(document, id) - Vec3(40, 5.0 * ((id - 9) / 9), 0)).norm(), 4, 1e-9);
  EXPECT_THAT(report.notes, Contains(HasSubstr("3 nodes held back by max_move")));
}

TEST(Shaping, sliding_leaves_no_face) {
  Document document = make_document(wavy_with_midsides());
  must_apply(document, R"({"edit":"slide","by":[14,9,2],"on":"300-1400","free_ends":false})");
  ShellSet shells;
  for (std::size_t i = 0; i < document.opened->model.shell_count(); ++i) shells.emplace_back(i);
  const spatial::ShellTree faces(document.opened->model, shells);
  std::size_t moved = 0;
  for (std::size_t n = 0; n < 41 * 41; ++n) {
    const Vec3& position = document.current().model.positions[n];
    moved += position != document.opened->model.positions[n] ? 1 : 0;
    EXPECT_LT(faces.closest(position)->distance, 1e-10);
  }
  EXPECT_GT(moved, 700u);
}

TEST(Shaping, both_sides_of_a_plane) {
  for (const char* text : {R"({"edit":"translate","by":[1.5,2.5,-3],"on":"36-39,57-60,78-81,99-102")",
                           R"({"edit":"translate","by":[1.5,2.5,-3],"on":"1-300","grab":100)",
                           R"({"edit":"lift","distance":4,"normals":"each","on":"22-300","grab":100)",
                           R"({"edit":"rotate","point":[20,20,5],"axis":[1,2,3],"degrees":33,"on":"22-300","grab":100)",
                           R"({"edit":"move","by":[2,3,-1],"point":[20,20,5],"axis":[1,2,3],"degrees":33,"on":"22-300","grab":100)",
                           R"({"edit":"slide","by":[6,8,1],"on":"22-300","grab":100)"}) {
    Document document = make_document(symmetric_sheet());
    must_apply(document, std::string(text) + R"(,"symmetry":{"point":[0,7,3],"normal":[2,0,0]}})");
    // sliding walks each half's own faces; all else is the same to the bit
    const double tolerance = std::string(text).find("slide") == std::string::npos ? 0 : 1e-11;
    double farthest = 0;
    for (int j = 0; j <= 20; ++j)
      for (int i = 0; i <= 20; ++i) {
        const Vec3 here = place_of(document, 1 + i + 21 * j), there = place_of(document, 1 + 20 - i + 21 * j);
        EXPECT_LE((here - Vec3(-there.x(), there.y(), there.z())).norm(), tolerance) << text << i << ' ' << j;
        farthest = std::max(farthest, (here - document.opened->model.positions[static_cast<std::size_t>(i + 21 * j)]).norm());
      }
    EXPECT_GT(farthest, 3) << text;
    EXPECT_EQ(place_of(document, 1 + 10 + 21 * 5).x(), 0);
  }
}

TEST(Shaping, nodes_without_an_image_are_counted) {
  Model model = symmetric_sheet();
  for (const std::size_t node : {2u * 21 + 3, 2u * 21 + 4}) model.positions.set(node, model.positions[node] + Vec3(0, 0, 2));
  Document document = make_document(std::move(model));
  const EditReport report = must_apply(
      document,
      R"({"edit":"translate","by":[0,0,1],"on":"57-60","falloff":{"profile":"constant"},"symmetry":{"point":[0,0,0],"normal":[1,0,0]}})");
  EXPECT_THAT(report.notes, Contains(HasSubstr("2 nodes without an image")));
  EXPECT_EQ(report.nodes_moved, 6u);
}

TEST(Shaping, a_locked_image_refuses) {
  Document document = make_document(make_assembly());
  must_apply(document, R"({"edit":"lock","on":"2"})");
  const std::string plane = R"(,"symmetry":{"point":[20,0,0],"normal":[1,0,0]}})";
  EXPECT_THAT(refusal(document, R"({"edit":"translate","by":[0,0,1],"on":"112")" + plane),
              HasSubstr("node 116 would move but belongs to the locked part 2"));
  EXPECT_EQ(document.generations.size(), 2u);
}

/// Kinds of shaping without what they act on.
const std::vector<std::string> kKinds{
    R"("edit":"translate","by":[1,2,3])",
    R"("edit":"lift","distance":1)",
    R"("edit":"lift","distance":1,"normals":"each")",
    R"("edit":"rotate","point":[3,90,-20],"axis":[0.3,1,0.2],"degrees":10)",
    R"("edit":"slide","by":[3,4,1])",
};
const std::vector<std::string> kOptions{
    "",
    R"(,"max_move":5.5)",
    R"(,"symmetry":{"point":[0.2,0,0],"normal":[1,0,0]})",
    R"(,"symmetry":{"point":[0,100,3],"normal":[0.1,1,0]},"max_move":4)",
    R"(,"falloff":{"profile":"constant"})",
};

TEST(Shaping, a_drag_shows_bit_for_bit_what_its_edit_will_do) {
  for (const std::string& kind : kKinds)
    for (const std::string& option : kOptions) {
      const std::string text = "{" + kind + R"(,"on":"500-1200")" + option + "}";
      SCOPED_TRACE(text);
      Document document = make_document(wavy_with_midsides());
      Result<Drag> drag = Drag::begin(document.generations[0], edit_of(text));
      ASSERT_TRUE(drag) << drag.error().text();
      drag->step({Vec3(9, 9, 9), 9, 90});  // what came before doesn't count
      for (const double size : {7.7, -19.1}) {
        drag->step({Vec3(0.4 * size, -size, 0.2 * size), size, 2.5 * size});
        Document after = document;
        const Result<EditReport> report = try_apply(after, parse_edit(edit_to_json(drag->edit()).dump()).value());
        ASSERT_TRUE(report) << report.error().text();
        const Generation& generation = after.current();
        for (std::size_t i = 0; i < drag->nodes().size(); ++i)
          ASSERT_EQ(std::memcmp(&drag->positions()[i], &generation.model.position(drag->nodes()[i]), sizeof(Vec3)), 0);
        for (std::size_t i = 0; i < drag->shells().size(); ++i) ASSERT_EQ(drag->states()[i], generation.quality[drag->shells()[i].value]);
        EXPECT_EQ(drag->counts(), generation.counts);
        const Vec3& grabbed = document.current().model.position(drag->grab());
        EXPECT_EQ(shaping_of(drag->edit())->grab_at, (std::array<double, 3>{grabbed.x(), grabbed.y(), grabbed.z()}));
        EXPECT_GT(report->nodes_moved, 300u);
        if (option == kOptions[1]) {
          EXPECT_THAT(report->notes, Contains(HasSubstr("held back by max_move")));
        }
        if (option.find("max_move") != std::string::npos) {
          for (std::size_t i = 0; i < drag->nodes().size(); ++i)
            ASSERT_LT((drag->positions()[i] - document.current().model.position(drag->nodes()[i])).norm(), 5.5 + 1e-12);
        }
        for (const NodeIndex moved : moved_nodes(document.current().model, generation.model))
          ASSERT_TRUE(std::binary_search(drag->nodes().begin(), drag->nodes().end(), moved));
      }
    }
}

TEST(Shaping, a_drag_passes_over_what_no_coordinate_holds) {
  Document document = make_sheet(6, 6);
  for (const std::string& kind : kKinds) {
    Result<Drag> drag = Drag::begin(document.generations[0], edit_of("{" + kind + R"(,"on":"1-49","grab":25})"));
    ASSERT_TRUE(drag);
    drag->step({Vec3(1, 1, 0), 2, 3});
    const std::vector<Vec3> positions = drag->positions();
    const double much = std::numeric_limits<double>::infinity();
    drag->step({Vec3(much, 0, 0), much, much});
    EXPECT_EQ(drag->positions(), positions) << kind;
    EXPECT_EQ(displacement_of(drag->edit()).by.allFinite(), true);
  }
}

/// Edits drawn at random, some of which can't be done.
std::vector<std::string> random_session(unsigned seed, int count) {
  std::mt19937 random(test::seed(seed));
  const auto pick = [&](int below) { return static_cast<int>(random() % static_cast<unsigned>(below)); };
  std::vector<std::string> edits;
  for (int i = 0; i < count; ++i) {
    const int from = 1 + pick(1500);
    const std::string on = std::to_string(from) + "-" + std::to_string(from + 20 + pick(400));
    switch (pick(6)) {
      case 0: edits.push_back(R"({"edit":"select","expr":")" + on + R"(","mode":"add"})"); break;
      case 1: edits.push_back(R"({"edit":"undo"})"); break;
      case 2: edits.push_back(pick(2) == 0 ? R"({"edit":"grow"})" : R"({"edit":"redo"})"); break;
      default:
        edits.push_back("{" + kKinds[static_cast<std::size_t>(pick(5))] + R"(,"on":")" + on + "\"" +
                        kOptions[static_cast<std::size_t>(pick(5))] + "}");
    }
  }
  return edits;
}

TEST(Shaping, undo_and_redo_of_any_session_are_exact) {
  for (unsigned seed = 1; seed <= 6; ++seed) {
    Document document = make_document(wavy_with_midsides());
    const Generation opened = document.current();
    for (const std::string& edit : random_session(seed, 25)) (void)try_apply(document, edit_of(edit));
    while (document.can_redo()) must_apply(document, R"({"edit":"redo"})");
    std::vector<Generation> states;
    for (const auto& generation : document.generations) states.push_back(*generation);
    ASSERT_GT(states.size(), 6u);
    while (document.can_undo()) must_apply(document, R"({"edit":"undo"})");
    expect_same(document.current(), opened);
    for (std::size_t i = 1; i < states.size(); ++i) {
      must_apply(document, R"({"edit":"redo"})");
      expect_same(document.current(), states[i]);
    }
  }
}

TEST(Shaping, the_same_bytes_with_any_number_of_threads) {
  std::vector<Document> documents;
  for (const std::size_t threads : {1u, 2u, 8u}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    documents.push_back(make_document(wavy_with_midsides()));
    for (const std::string& edit : random_session(77, 30)) (void)try_apply(documents.back(), edit_of(edit));
  }
  expect_same(documents[0], documents[1]);
  expect_same(documents[0], documents[2]);
}

TEST(Shaping, the_journal_rebuilds_every_kind) {
  const Folder folder;
  Document document = make_document(wavy_with_midsides());
  {
    Result<Journal> journal = Journal::create(folder / "a.journal", document);
    ASSERT_TRUE(journal) << journal.error().text();
    for (const std::string& text : random_session(5, 30)) {
      const Edit edit = edit_of(text);
      Result<Prepared> prepared = prepare(document, edit);
      if (!prepared) continue;
      ASSERT_TRUE(journal->append(document, edit, *prepared));
      commit(document, std::move(*prepared));
    }
  }
  // from deltas, as after a crash
  Document recovered = make_document(wavy_with_midsides());
  const Result<Journal> opened = Journal::recover(folder / "a.journal", recovered);
  ASSERT_TRUE(opened) << opened.error().text();
  expect_same(recovered.current(), document.current());
  // from intents
  const Result<JournalIntents> intents = read_intents(folder / "a.journal");
  ASSERT_TRUE(intents) << intents.error().text();
  Document replayed = make_document(wavy_with_midsides());
  for (const ReplayStep& step : replay(replayed, *intents)) EXPECT_TRUE(step.applied) << step.message;
  expect_same(replayed.current(), document.current());
}

TEST(Shaping, a_variant_is_found_by_place) {
  // the same sheet with other ids and twice as fine: what was grabbed and its image are found where they were
  Document document = make_document(symmetric_sheet());
  const std::string recipe =
      R"("on":{"edit":"select_region","at":[30,40,1]},"grab":90000,"grab_at":[30.3,51,2.2],"free_ends":false,"symmetry":{"point":[0,0,0],"normal":[1,0,0]})";
  Document fine = make_document(test::make_grid(40, 40, [](int i, int j) { return Vec3(2.5 * (i - 20), 2.5 * j, 0.005 * j * j); }));
  for (Document* each : {&document, &fine}) {
    must_apply(*each, R"({"edit":"slide","by":[0,5,0],)" + recipe + "}");
    must_apply(*each, R"({"edit":"rotate","point":[0,50,0],"axis":[1,0,0],"degrees":5,)" + recipe + "}");
    const Model& before = each->opened->model;
    const Model& after = each->current().model;
    for (const double side : {-1, 1}) {
      double most = 0;
      for (std::size_t n = 0; n < after.node_count(); ++n)
        if (side * before.positions[n].x() > 20 && std::abs(before.positions[n].y() - 51) < 4)
          most = std::max(most, (after.positions[n] - before.positions[n]).norm());
      EXPECT_GT(most, 4);
    }
  }
}

TEST(Shaping, what_makes_no_sense_is_refused_in_a_sentence) {
  Document document = make_document(make_assembly());
  const auto refuse = [&](const Edit& edit) {
    const Result<EditReport> report = try_apply(document, edit);
    return report ? "" : report.error().text();
  };
  const double nothing = std::numeric_limits<double>::quiet_NaN(), much = std::numeric_limits<double>::infinity();
  Rotate rotate{Vec3::Zero(), Vec3::UnitZ(), 10, {}};
  rotate.shaping.on = "100-148";
  const auto changed = [](auto edit, const auto& change) {
    change(edit);
    return Edit(edit);
  };
  EXPECT_EQ(refuse(changed(rotate, [](Rotate& r) { r.axis.setZero(); })),
            "rotate: the axis must be a direction of finite numbers, not all 0");
  EXPECT_THAT(refuse(changed(rotate, [&](Rotate& r) { r.axis.x() = nothing; })), HasSubstr("the axis must be a direction"));
  EXPECT_THAT(refuse(changed(rotate, [&](Rotate& r) { r.point.x() = much; })), HasSubstr("the axis's point"));
  EXPECT_THAT(refuse(changed(rotate, [&](Rotate& r) { r.degrees = nothing; })), HasSubstr("must be a finite number"));
  EXPECT_THAT(refuse(changed(rotate, [&](Rotate& r) { r.degrees = 1e12; })), HasSubstr("too large"));
  EXPECT_THAT(refuse(changed(rotate, [&](Rotate& r) { r.shaping.max_move = nothing; })), HasSubstr("max_move"));
  EXPECT_THAT(refuse(changed(rotate,
                             [&](Rotate& r) {
                               r.shaping.grab = NodeReference(std::array<double, 3>{0, nothing, 0});
                             })),
              HasSubstr("the grab's place"));
  EXPECT_THAT(refuse(changed(rotate,
                             [&](Rotate& r) {
                               r.shaping.grab_at = std::array<double, 3>{much, 0, 0};
                             })),
              HasSubstr("the grab's place"));
  Move rigid{Vec3(1, 2, 3), Vec3::Zero(), Vec3::UnitZ(), 10, {}};
  rigid.shaping.on = "100-148";
  EXPECT_THAT(refuse(changed(rigid, [](Move& m) { m.axis.setZero(); })), HasSubstr("move: the axis must be a direction"));
  EXPECT_THAT(refuse(changed(rigid, [&](Move& m) { m.point.x() = much; })), HasSubstr("the axis's point"));
  EXPECT_THAT(refuse(changed(rigid, [&](Move& m) { m.by.x() = nothing; })), HasSubstr("must be a finite number"));
  EXPECT_THAT(refuse(changed(rotate, [](Rotate& r) { r.shaping.weights.falloff.flat = 2; })), HasSubstr("flat share"));
  EXPECT_THAT(refuse(changed(rotate,
                             [](Rotate& r) {
                               r.shaping.on = "111-113,121-123,131-133";
                               r.shaping.weights.origin = shape::Origin::free_edge;
                             })),
              HasSubstr("the selection reaches none"));
  Lift lift;
  lift.shaping.on = "100-148";
  for (const double distance : {nothing, much, -much}) {
    lift.distance = distance;
    EXPECT_EQ(refuse(lift), "lift: how far it goes must be a finite number");
  }
  EXPECT_THAT(refuse(changed(rotate,
                             [&](Rotate& r) {
                               r.shaping.symmetry = Symmetry{Vec3::Zero(), Vec3::Zero()};
                             })),
              HasSubstr("symmetry: the plane's normal must be a direction"));
  EXPECT_THAT(refuse(changed(rotate,
                             [&](Rotate& r) {
                               r.shaping.symmetry = Symmetry{Vec3(much, 0, 0), Vec3::UnitX()};
                             })),
              HasSubstr("symmetry: the plane's point"));
  EXPECT_THAT(refuse(changed(rotate, [](Rotate& r) { r.shaping.on = "4711"; })), HasSubstr("no node 4711"));
  EXPECT_THAT(refuse(changed(rotate, [](Rotate& r) { r.shaping.on.reset(); })), HasSubstr("nothing is selected"));
  EXPECT_THAT(refuse(changed(rotate, [](Rotate& r) { r.shaping.grab = NodeReference(std::int64_t{900}); })),
              HasSubstr("the grabbed node 900 isn't among"));
  Slide slide{Vec3(1, 0, 0), {}};
  slide.shaping.on = "900";
  EXPECT_THAT(refuse(slide), HasSubstr("no shell touches the grabbed node 900, so there is no surface to slide on"));
  slide.shaping.on = "100-148";
  EXPECT_THAT(refuse(changed(slide, [&](Slide& s) { s.by.y() = much; })), HasSubstr("must be a finite number"));
  Translate translate{Vec3(1.7e308, 0, 0), slide.shaping};
  translate.shaping.weights.falloff.profile = shape::Profile::constant;
  EXPECT_EQ(refuse(translate), "");  // large, but a number
  must_apply(document, R"({"edit":"undo"})");
  translate.by.y() = nothing;
  EXPECT_THAT(refuse(translate), HasSubstr("must be a finite number"));
  must_apply(document, R"({"edit":"lock","on":"1"})");
  for (const char* text : {R"({"edit":"rotate","point":[0,0,0],"axis":[0,0,1],"degrees":5,"on":"100-148"})",
                           R"({"edit":"slide","by":[1,0,0],"on":"100-148"})"})
    EXPECT_THAT(refusal(document, text), HasSubstr("the locked part 1"));
  EXPECT_EQ(document.generations.size(), 2u);
  EXPECT_TRUE(same_bytes(document.current().model.positions, document.opened->model.positions));
}

}  // namespace
}  // namespace prismesh::mesh::document
