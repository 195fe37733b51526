// The rule that edits make no contact: an arch relaxed and repaired above a plate, sheets pulled to each other. Clearances are measured by
// all pairs of triangles, without the code under test.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <nlohmann/json.hpp>

#include "mesh/deck/sample.h"
#include "mesh/document/contacts.h"
#include "mesh/document/drag.h"
#include "tests/mesh/contact/plain_clearance.h"
#include "tests/mesh/document/document_fixture.h"
#include "tests/mesh/document/journal_session.h"

namespace prismesh::mesh::document {
namespace {

using test::PlainClearance;
using testing::Contains;
using testing::HasSubstr;

/// Part 1: an arch over the y axis with a radius of 20, a row of nodes at each of these angles. Part 2: a shell 4 wide under its top,
/// at this height, or one that stands there. An edge of the arch that becomes longer comes nearer to the plate.
Model arch_over_plate(const std::vector<double>& degrees, double height, double thickness, bool stands = false) {
  std::vector<test::NodeSpec> nodes;
  std::vector<test::ShellSpec> shells;
  const auto add = [&](std::int64_t part, int columns, int rows, const auto& place) {
    const auto first = static_cast<std::int64_t>(nodes.size()) + 1, stride = std::int64_t{columns} + 1;
    for (int j = 0; j <= rows; ++j)
      for (int i = 0; i <= columns; ++i) nodes.push_back({static_cast<std::int64_t>(nodes.size()) + 1, place(i, j)});
    for (int j = 0; j < rows; ++j)
      for (int i = 0; i < columns; ++i) {
        const std::int64_t corner = first + i + j * stride;
        shells.push_back({static_cast<std::int64_t>(shells.size()) + 1, part, {corner, corner + 1, corner + stride + 1, corner + stride}});
      }
  };
  add(1, static_cast<int>(degrees.size()) - 1, 4, [&](int i, int j) {
    const double angle = degrees[static_cast<std::size_t>(i)] * std::acos(-1.0) / 180;
    return Vec3(20 * std::sin(angle), 5.0 * j, 20 * std::cos(angle));
  });
  add(2, 1, 1, [&](int i, int j) { return stands ? Vec3(0, 8 + 4.0 * j, height - 4.0 * i) : Vec3(4.0 * i - 2, 8 + 4.0 * j, height); });
  return test::with_thickness(test::make_model(nodes, shells), thickness);
}

constexpr double kThick = 0.05;
Document uneven_arch() { return make_document(arch_over_plate({-60, -41, -22, -6, 0, 6, 22, 41, 60}, 19.8, kThick)); }
constexpr double kThin = 0.002;
/// Its middle column is far too narrow. From a deck, since shells are to be added and removed.
class NarrowArch {
 public:
  NarrowArch() {
    const Model model = arch_over_plate({-60, -41, -22, -6, -0.6, 0.6, 6, 22, 41, 60}, 19.985, kThin, true);
    std::string text = "*KEYWORD\n";
    char line[200];
    const auto add = [&](const char* format, auto... values) {
      std::snprintf(line, sizeof line, format, values...);
      text += line;
    };
    for (const int part : {1, 2}) add("*PART\npart %d\n%10d%10d%10d\n", part, part, 1, 1);
    text += "*SECTION_SHELL\n         1         2\n";
    for (int corner = 0; corner < 4; ++corner) add("%10g", kThin);
    text += "\n*MAT_ELASTIC\n         1    7.9E-9    210000       0.3\n*NODE\n";
    for (std::size_t n = 0; n < model.node_count(); ++n)
      add("%8ld%16.9f%16.9f%16.9f\n", static_cast<long>(model.node_ids[n]), model.positions[n].x(), model.positions[n].y(),
          model.positions[n].z());
    text += "*ELEMENT_SHELL\n";
    for (std::size_t s = 0; s < model.shell_count(); ++s) {
      add("%8ld%8d", static_cast<long>(model.shell_ids[s]), model.shell_parts[s] == PartIndex(0u) ? 1 : 2);
      for (const NodeIndex node : model.shell_nodes[s].node) add("%8ld", static_cast<long>(model.node_ids[node.value]));
      text += "\n";
    }
    put_content(folder_ / "arch.k", text + "*END\n");
  }
  Document document() const {
    OpenOptions options;
    options.target_size = 5.0;
    options.length_unit = LengthUnit::mm;
    return open(folder_ / "arch.k", options).value();
  }

 private:
  Folder folder_;
};
Document narrow_arch() {
  static const NarrowArch arch;
  return arch.document();
}

/// Part 1: 6 x 6 shells of 5; part 2: the same, 10 above it; 1 thick. Nodes 1-49 and 50-98.
Document facing_sheets(double apart = 10, std::uint64_t content = 7) {
  std::vector<test::NodeSpec> nodes;
  std::vector<test::ShellSpec> shells;
  for (const int part : {1, 2}) {
    const auto first = static_cast<std::int64_t>(nodes.size()) + 1;
    for (int j = 0; j <= 6; ++j)
      for (int i = 0; i <= 6; ++i) nodes.push_back({first + i + 7 * j, Vec3(5.0 * i, 5.0 * j, part == 1 ? 0 : apart)});
    for (int j = 0; j < 6; ++j)
      for (int i = 0; i < 6; ++i) {
        const std::int64_t corner = first + i + 7 * j;
        shells.push_back({static_cast<std::int64_t>(shells.size()) + 1, part, {corner, corner + 1, corner + 8, corner + 7}});
      }
  }
  return make_document(test::with_thickness(test::make_model(nodes, shells), 1), std::size_t{1} << 30, content);
}

double clearance_of_parts(const Document& document) {
  return PlainClearance::between(document.current().model, PartIndex(0u), PartIndex(1u));
}

/// An edit with a rule; "" is none.
std::string with_rule(const std::string& edit, const std::string& rule) {
  return edit.substr(0, edit.size() - 1) + (rule.empty() ? "}" : R"(,"contact":")" + rule + "\"}");
}

const std::string kEvenOut = R"({"edit":"relax","scope":"all"})";
const std::string kMend = R"({"edit":"repair","scope":"all"})";
const std::string kPullAtPlate =
    R"({"edit":"translate","by":[0,0,-12],"on":"50-98","grab":74,"falloff":{"profile":"smooth"},"free_ends":false})";

TEST(ContactRule, relaxing_enters_a_plate_only_without_it) {
  Document free = uneven_arch();
  ASSERT_GT(clearance_of_parts(free), kThick);
  must_apply(free, kEvenOut);
  ASSERT_EQ(clearance_of_parts(free), 0) << "relaxing evens the arch out, whose edges then cross the plate";

  Document apart = uneven_arch();
  const EditReport report = must_apply(apart, with_rule(kEvenOut, "keep_apart"));
  EXPECT_GE(clearance_of_parts(apart), 0.99 * kThick);
  EXPECT_GT(report.nodes_moved, 5u) << "nodes far from the plate are relaxed";
  EXPECT_THAT(report.notes, Contains(HasSubstr("left in place: part 1 and part 2 would cross")));

  Document refusing = uneven_arch();
  EXPECT_THAT(refusal(refusing, with_rule(kEvenOut, "refuse")), HasSubstr("relax: part 1 and part 2 would cross"));
  EXPECT_EQ(refusing.generations.size(), 1u);
  Document allowing = uneven_arch();
  must_apply(allowing, with_rule(kEvenOut, "allow"));
  EXPECT_TRUE(same_bytes(allowing.current().model.positions, free.current().model.positions));
}

TEST(ContactRule, relaxing_from_a_node_keeps_apart_too) {
  const std::string from = R"({"edit":"relax","mode":"from","at":[0,10,20],"threshold":0.01})";
  Document free = uneven_arch(), apart = uneven_arch();
  must_apply(free, from);
  EXPECT_LT(clearance_of_parts(free), 0.9 * kThick);
  must_apply(apart, with_rule(from, "keep_apart"));
  EXPECT_GE(clearance_of_parts(apart), 0.99 * kThick);
}

TEST(ContactRule, relaxing_far_from_other_parts_is_not_changed_by_it) {
  const auto arch = [] { return make_document(arch_over_plate({-60, -41, -22, -6, 0, 6, 22, 41, 60}, 15, kThick)); };
  Document free = arch(), apart = arch();
  must_apply(free, kEvenOut);
  must_apply(apart, with_rule(kEvenOut, "keep_apart"));
  EXPECT_TRUE(same_bytes(free.current().model.positions, apart.current().model.positions));
}

TEST(ContactRule, repairing_enters_a_plate_only_without_it) {
  Document free = narrow_arch();
  ASSERT_GT(clearance_of_parts(free), kThin);
  ASSERT_GT(free.current().counts.fail, 0u);
  must_apply(free, kMend);
  ASSERT_EQ(clearance_of_parts(free), 0) << "the narrow column gets wider, and its edges cross the plate";

  Document apart = narrow_arch();
  const EditReport report = must_apply(apart, with_rule(kMend, "keep_apart"));
  EXPECT_GE(clearance_of_parts(apart), 0.99 * kThin);
  EXPECT_THAT(report.notes, Contains(HasSubstr("left as they are: part 1 and part 2 would")));
  EXPECT_LE(apart.current().counts.fail, narrow_arch().current().counts.fail);

  Document refusing = narrow_arch();
  EXPECT_THAT(refusal(refusing, with_rule(kMend, "refuse")), HasSubstr("repair: part 1 and part 2 would"));
  EXPECT_EQ(refusing.generations.size(), 1u);
}

TEST(ContactRule, a_pull_stops_before_the_other_sheet) {
  Document free = facing_sheets(), apart = facing_sheets();
  must_apply(free, kPullAtPlate);
  ASSERT_EQ(clearance_of_parts(free), 0);
  const EditReport report = must_apply(apart, with_rule(kPullAtPlate, "keep_apart"));
  EXPECT_GE(clearance_of_parts(apart), 0.99);
  EXPECT_LE(clearance_of_parts(apart), 0.99 + 12.0 / 1024 + 1e-9);
  EXPECT_THAT(report.notes, Contains(HasSubstr("stopped at 75 % of the way: farther on, part 1 and part 2 would be too close")));

  Document refusing = facing_sheets();
  EXPECT_THAT(refusal(refusing, with_rule(kPullAtPlate, "refuse")), HasSubstr("translate: part 1 and part 2 would cross"));
  const std::string less = R"({"edit":"translate","by":[0,0,-8],"on":"50-98","grab":74,"contact":"refuse"})";
  EXPECT_EQ(refusal(refusing, less), "");
}

TEST(ContactRule, each_kind_of_pull_heeds_it) {
  for (const std::string edit : {R"({"edit":"lift","distance":-12,"on":"50-98","grab":74,"free_ends":false})",
                                 R"({"edit":"rotate","point":[0,15,10],"axis":[0,1,0],"degrees":40,"on":"50-98","grab":77})",
                                 R"({"edit":"move","by":[0,0,-12],"axis":[0,1,0],"degrees":5,"on":"50-98","grab":74,"free_ends":false})"}) {
    Document free = facing_sheets(), apart = facing_sheets();
    must_apply(free, edit);
    EXPECT_EQ(clearance_of_parts(free), 0) << edit;
    must_apply(apart, with_rule(edit, "keep_apart"));
    EXPECT_GE(clearance_of_parts(apart), 0.99) << edit;
    EXPECT_LE(clearance_of_parts(apart), 1.1) << edit;
  }
}

TEST(ContactRule, a_pull_without_any_free_way_is_refused) {
  Document document = facing_sheets(1);
  EXPECT_THAT(refusal(document, with_rule(kPullAtPlate, "keep_apart")),
              HasSubstr("translate: no share of the way is free: part 1 and part 2 would be too close"));
  EXPECT_EQ(document.generations.size(), 1u);
  EXPECT_EQ(refusal(document, R"({"edit":"translate","by":[0,0,5],"on":"50-98","grab":74,"contact":"keep_apart"})"), "");
}

TEST(ContactRule, sheets_that_are_too_close_may_slide_and_part_but_not_close_in) {
  Document document = facing_sheets(0.6);
  EXPECT_EQ(refusal(document, R"({"edit":"slide","by":[1.3,0.4,0],"on":"50-98","grab":74,"free_ends":false,"contact":"keep_apart"})"), "");
  EXPECT_THAT(refusal(document, R"({"edit":"translate","by":[0,0,-0.05],"on":"50-98","grab":74,"contact":"refuse"})"),
              HasSubstr("would be too close, 0.45 deep"));
  EXPECT_EQ(refusal(document, R"({"edit":"translate","by":[0,0,0.2],"on":"50-98","grab":74,"contact":"refuse"})"), "");
}

TEST(ContactRule, a_sheet_is_not_folded_into_itself) {
  // One part: a U of 1 mm whose legs are 6 apart, closed by a pull of one leg's end. Nodes in rows of 5 along y.
  std::vector<test::NodeSpec> nodes;
  std::vector<test::ShellSpec> shells;
  std::vector<Vec3> path;
  for (int i = 0; i <= 6; ++i) path.emplace_back(30 - 5.0 * i, 0, 0);
  path.emplace_back(-3, 0, 3);
  for (int i = 0; i <= 6; ++i) path.emplace_back(5.0 * i, 0, 6);
  for (std::size_t i = 0; i < path.size(); ++i)
    for (int j = 0; j < 5; ++j) nodes.push_back({static_cast<std::int64_t>(5 * i) + j + 1, path[i] + Vec3(0, 5.0 * j, 0)});
  for (std::int64_t i = 0; i + 1 < static_cast<std::int64_t>(path.size()); ++i)
    for (std::int64_t j = 1; j < 5; ++j) shells.push_back({4 * i + j, 1, {5 * i + j, 5 * i + j + 1, 5 * i + j + 6, 5 * i + j + 5}});
  const auto u_section = [&] { return make_document(test::with_thickness(test::make_model(nodes, shells), 1)); };
  const std::string all = R"({"edit":"translate","by":[0,0,-9],"on":"41-75","grab":73,"contact":")";
  Document document = u_section();
  EXPECT_THAT(refusal(document, all + "refuse\"}"), HasSubstr("two folds of part 1 would cross"));
  must_apply(document, all + "keep_apart\"}");
  EXPECT_GT((place_of(document, 73) - place_of(document, 3)).norm(), 0.9);
}

TEST(ContactRule, a_drag_stops_where_its_edit_does) {
  Document document = facing_sheets();
  Result<Drag> drag = Drag::begin(document.generations[0], edit_of(with_rule(kPullAtPlate, "keep_apart")));
  ASSERT_TRUE(drag) << drag.error().text();
  Displacement by;
  by.by = Vec3(0, 0, -3);
  drag->step(by);
  EXPECT_EQ(drag->share(), 1);
  by.by = Vec3(0, 0, -12);
  drag->step(by);
  EXPECT_NEAR(drag->share(), 0.75, 1e-2);
  const Edit edit = drag->edit();
  EXPECT_EQ(edit_to_json(edit).at("contact"), "keep_apart");
  ASSERT_TRUE(try_apply(document, edit));
  for (std::size_t i = 0; i < drag->nodes().size(); ++i)
    EXPECT_EQ(document.current().model.position(drag->nodes()[i]), drag->positions()[i]);
  EXPECT_GE(clearance_of_parts(document), 0.99);
}

TEST(ContactRule, gives_the_same_bits_on_any_number_of_threads) {
  for (const std::string& edit : {kEvenOut, kMend, kPullAtPlate}) {
    const auto make = [&] { return edit == kEvenOut ? uneven_arch() : edit == kMend ? narrow_arch() : facing_sheets(); };
    std::optional<Document> first;
    for (const std::size_t threads : {1u, 2u, 7u}) {
      const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
      Document document = make();
      must_apply(document, with_rule(edit, "keep_apart"));
      if (first)
        EXPECT_TRUE(same_bytes(document.current().model.positions, first->current().model.positions)) << edit << " on " << threads;
      else
        first = std::move(document);
    }
  }
}

TEST(ContactRule, comes_back_with_the_journal_and_holds_on_a_variant) {
  const Session session({with_rule(kPullAtPlate, "keep_apart"), R"({"edit":"undo"})", R"({"edit":"redo"})"}, facing_sheets());
  Document recovered = facing_sheets();
  ASSERT_TRUE(Journal::recover(session.path, recovered));
  expect_same(recovered, session.after.back());
  const Result<JournalIntents> intents = read_intents(session.path);
  ASSERT_TRUE(intents) << intents.error().text();
  Document variant = facing_sheets(7, 8);
  for (const ReplayStep& step : replay(variant, *intents)) EXPECT_TRUE(step.applied) << step.message;
  EXPECT_GE(clearance_of_parts(variant), 0.99);
  EXPECT_LE(clearance_of_parts(variant), 1.1);
}

/// The greatest depth of each kind of contact of each two parts, by the search of the whole model; of a perforation its curve's length.
std::map<std::string, double> worst_of(const Document& document) {
  ContactSearch search;
  std::map<std::string, double> worst;
  const Contacts contacts = find_contacts(document.current(), search, {}).value();
  for (const ContactRegion& region : contacts.regions) {
    double& depth = worst[region.kind + " " + region.a + " " + region.b];
    depth = std::max(depth, region.kind == "perforation" ? region.length : *region.max_depth);
  }
  return worst;
}

TEST(ContactRule, holds_where_the_structure_changes) {
  const Folder folder;
  ASSERT_TRUE(deck::write_sample(folder / "sample.k", 2000));
  Result<Document> document = open(folder / "sample.k", {});
  ASSERT_TRUE(document) << document.error().text();
  must_apply(*document, R"({"edit":"select","expr":"5000104"})");
  must_apply(*document, R"({"edit":"grow","rings":2})");
  must_apply(*document, R"({"edit":"translate","by":[0.09,77.24,-0.02],"grab":5000104})");
  const std::map<std::string, double> before = worst_of(*document);
  const EditReport report = must_apply(*document, R"({"edit":"repair","scope":"all","contact":"keep_apart"})");
  EXPECT_GT(report.elements_added + report.elements_removed, 0u);
  EXPECT_LT(report.after.fail, report.before.fail);
  for (const auto& [place, depth] : worst_of(*document)) {
    const auto was = before.find(place);
    if (place.starts_with("perforation")) {
      EXPECT_NE(was, before.end()) << place;
    } else {
      EXPECT_LE(depth, (was == before.end() ? 0 : was->second) + 0.01) << place;
    }
  }
}

TEST(ContactRule, is_written_only_where_it_is_given) {
  EXPECT_FALSE(edit_to_json(edit_of(kEvenOut)).contains("contact"));
  EXPECT_FALSE(edit_to_json(edit_of(kPullAtPlate)).contains("contact"));
  for (const std::string& edit : {kEvenOut, kMend, kPullAtPlate})
    EXPECT_EQ(edit_to_json(edit_of(with_rule(edit, "keep_apart"))).at("contact"), "keep_apart");
  const Result<Edit> wrong = parse_edit(with_rule(kEvenOut, "avoid"));
  ASSERT_FALSE(wrong);
  EXPECT_THAT(wrong.error().text(), HasSubstr("keep_apart"));
}

}  // namespace
}  // namespace prismesh::mesh::document
