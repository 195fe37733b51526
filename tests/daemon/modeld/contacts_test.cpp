// Where shells touch, as clients are told it: asked for, and while a drag is under way.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/modeld/contacts_answer.h"
#include "daemon/modeld/request_handler.h"
#include "mesh/document/edit_json.h"
#include "tests/daemon/modeld/folder.h"

namespace prismesh::modeld {
namespace {

using ::testing::HasSubstr;

constexpr int kPlateSide = 6;

/// Two plates of 5 x 5 shells of 10 above each other: part 7 at z = 0, part 9 at `height`, nodes from 101 on; both are 1 thick, if
/// `thick`.
std::filesystem::path write_plates(const std::filesystem::path& path, double height, bool thick = true) {
  std::FILE* file = std::fopen(path.c_str(), "w");
  std::fprintf(file, "*KEYWORD\n*NODE\n");
  for (const int first : {1, 101})
    for (int n = 0; n < kPlateSide * kPlateSide; ++n)
      std::fprintf(file, "%8d%16.6f%16.6f%16.6f\n", first + n, 10.0 * (n % kPlateSide), 10.0 * (n / kPlateSide), first == 1 ? 0.0 : height);
  std::fprintf(file, "*ELEMENT_SHELL\n");
  for (const int first : {1, 101})
    for (int n = 0; n + kPlateSide + 1 < kPlateSide * kPlateSide; ++n)
      if (n % kPlateSide + 1 < kPlateSide)
        std::fprintf(file, "%8d%8d%8d%8d%8d%8d\n", first + n, first == 1 ? 7 : 9, first + n, first + n + 1, first + n + 1 + kPlateSide,
                     first + n + kPlateSide);
  const int section = thick ? 1 : 0;
  std::fprintf(file, "*PART\nRoof\n%10d%10d\n*PART\nRail\n%10d%10d\n", 7, section, 9, section);
  if (thick) std::fprintf(file, "*SECTION_SHELL\n%10d%10d\n%10.2f%10.2f%10.2f%10.2f\n", 1, 2, 1.0, 1.0, 1.0, 1.0);
  std::fprintf(file, "*END\n");
  std::fclose(file);
  return path;
}

class ContactsAsked : public ::testing::Test {
 protected:
  void open(const std::filesystem::path& deck) {
    ipc::Open request;
    request.path = deck.string();
    const ipc::Answer answer = handler_.open(request, {}).answer;
    ASSERT_TRUE(std::holds_alternative<ipc::DocumentState>(answer));
  }
  std::uint64_t edit(const std::string& json) {
    const ipc::Answer answer = handler_.edit(mesh::document::parse_edit(json).value()).answer;
    const auto* edited = std::get_if<ipc::Edited>(&answer);
    EXPECT_NE(edited, nullptr) << json;
    return edited != nullptr ? edited->generation : 0;
  }
  ipc::Contacts get(const ipc::GetContacts& request = {}) {
    const ipc::Answer answer = handler_.contacts(request, [](double) { return true; }).answer;
    const auto* contacts = std::get_if<ipc::Contacts>(&answer);
    EXPECT_NE(contacts, nullptr) << std::get<ipc::Failed>(answer).message;
    return contacts != nullptr ? *contacts : ipc::Contacts();
  }
  std::string refusal(const ipc::GetContacts& request) {
    const ipc::Answer answer = handler_.contacts(request, [](double) { return true; }).answer;
    const auto* failed = std::get_if<ipc::Failed>(&answer);
    return failed != nullptr ? failed->message : "accepted";
  }
  std::filesystem::path file(const char* name) const { return folder_.path() / name; }

  test::Folder folder_;
  ipc::SnapshotPublisher publisher_{1};
  ManualClock clock_;
  RequestHandler handler_{StateFolder(folder_.state()), publisher_, std::size_t{1} << 30, clock_};
};

TEST_F(ContactsAsked, describe_a_penetration) {
  open(write_plates(file("near.k"), 0.75));
  const ipc::Contacts contacts = get();
  EXPECT_EQ(contacts.penetrations, 1u);
  ASSERT_EQ(contacts.regions.size(), 1u);
  const ipc::ContactRegion& region = contacts.regions[0];
  EXPECT_EQ(region.kind, "penetration");
  EXPECT_EQ(region.a + " " + region.name_a, "part:7 Roof");
  EXPECT_EQ(region.b + " " + region.name_b, "part:9 Rail");
  EXPECT_EQ(region.shells_a, 25u);
  EXPECT_EQ(region.shells.size(), 50u);
  ASSERT_TRUE(region.max_depth);
  EXPECT_NEAR(*region.max_depth, 0.25, 1e-12);
  EXPECT_FALSE(region.joined);
  EXPECT_FALSE(region.why.empty());
  EXPECT_TRUE(region.curve.empty());
  ASSERT_EQ(region.vectors.size(), 72u) << "each node of both";
  EXPECT_EQ(region.vectors[0].node, 0u);
  EXPECT_NEAR(region.vectors[0].to[2], -0.25, 1e-12) << "the lower plate must go down";
  EXPECT_NEAR(region.vectors[71].to[2], 1, 1e-12) << "the upper one up";
}

TEST_F(ContactsAsked, say_how_long_the_search_took) {
  open(write_plates(file("near.k"), 0.75));
  std::int64_t passed = 0;
  const ipc::Answer answer = handler_
                                 .contacts({},
                                           [&](double) {
                                             clock_.advance_ns(7), passed += 7;
                                             return true;
                                           })
                                 .answer;
  EXPECT_GT(passed, 0) << "it was told how far the search is";
  ASSERT_TRUE(std::holds_alternative<ipc::Contacts>(answer));
  EXPECT_EQ(std::get<ipc::Contacts>(answer).search_ns, passed);
}

TEST_F(ContactsAsked, describe_a_perforation_with_its_curve) {
  open(write_plates(file("apart.k"), 20));
  edit(R"({"edit":"rotate","point":[25,25,20],"axis":[0,1,0],"degrees":90,"on":"101-136","falloff":{"profile":"constant"}})");
  edit(R"({"edit":"translate","by":[0.5,0,0],"on":"101-136","falloff":{"profile":"constant"}})");
  const ipc::Contacts contacts = get();
  EXPECT_EQ(contacts.perforations, 1u);
  ASSERT_GE(contacts.regions.size(), 1u);
  const ipc::ContactRegion& region = contacts.regions[0];
  EXPECT_EQ(region.kind, "perforation");
  EXPECT_NEAR(region.length, 50, 1e-9);
  double length = 0;
  for (const auto& s : region.curve) length += std::hypot(s[3] - s[0], s[4] - s[1], s[5] - s[2]);
  EXPECT_NEAR(length, 50, 1e-9);
  ASSERT_TRUE(region.max_depth);
  EXPECT_NEAR(*region.max_depth, 5, 1e-9) << "20 - 25";
  ASSERT_FALSE(region.vectors.empty());
  for (const ipc::ContactVector& vector : region.vectors) EXPECT_NEAR(vector.to[2], 0, 1e-9) << "back to the sheet";
}

TEST_F(ContactsAsked, are_of_the_newest_state) {
  open(write_plates(file("near.k"), 0.75));
  EXPECT_EQ(get().penetrations, 1u);
  const std::uint64_t away = edit(R"({"edit":"translate","by":[0,0,5],"on":"101-136","falloff":{"profile":"constant"}})");
  EXPECT_EQ(get().penetrations, 0u);
  EXPECT_EQ(get().generation, away);
  edit(R"({"edit":"undo"})");
  EXPECT_EQ(get().penetrations, 1u);
  edit(R"({"edit":"translate","by":[0,0,-0.25],"on":"101-136","falloff":{"profile":"constant"}})");
  ASSERT_EQ(get().penetrations, 1u);
  EXPECT_NEAR(*get().regions[0].max_depth, 0.5, 1e-12) << "the kept tree has followed";
  ASSERT_TRUE(std::holds_alternative<ipc::Done>(handler_.close({true, false}).answer));
  open(write_plates(file("far.k"), 5));
  EXPECT_EQ(get().penetrations, 0u) << "nothing is kept of another deck";
}

TEST_F(ContactsAsked, know_the_shells_that_an_edit_makes) {
  open(write_plates(file("near.k"), 0.75));
  EXPECT_EQ(get().regions.at(0).shells_b, 25u);
  edit(R"({"edit":"split","at":["shell:101"]})");
  const ipc::Contacts contacts = get();
  ASSERT_EQ(contacts.regions.size(), 1u);
  EXPECT_EQ(contacts.regions[0].shells_b, 26u) << "two triangles in place of a quad";
  edit(R"({"edit":"undo"})");
  EXPECT_EQ(get().regions.at(0).shells_b, 25u);
}

TEST_F(ContactsAsked, take_gap_thickness_and_selection) {
  open(write_plates(file("thin.k"), 2, false));
  const ipc::Contacts plain = get();
  EXPECT_TRUE(plain.regions.empty());
  EXPECT_EQ(plain.without_thickness, (std::vector<std::int64_t>{7, 9}));
  EXPECT_EQ(get({{}, 0, 3}).penetrations, 1u);
  EXPECT_EQ(get({{}, 0.5, 1.8}).clearances, 1u);
  EXPECT_EQ(get({"shell:101", 0, 3}).regions.at(0).shells_b, 1u);
  EXPECT_THAT(refusal({"shell:9999", 0, 3}), HasSubstr("9999"));
  EXPECT_THAT(refusal({{}, -1, {}}), HasSubstr("gap"));
  EXPECT_THAT(refusal({{}, 0, 0.0}), HasSubstr("thickness"));
}

TEST_F(ContactsAsked, can_be_cancelled_and_asked_again) {
  open(write_plates(file("near.k"), 0.75));
  for (const int calls : {1, 2}) {
    int left = calls;
    const ipc::Answer answer = handler_.contacts({}, [&](double) { return --left > 0; }).answer;
    ASSERT_TRUE(std::holds_alternative<ipc::Failed>(answer)) << calls;
    EXPECT_EQ(std::get<ipc::Failed>(answer).message, "cancelled");
  }
  EXPECT_EQ(get().penetrations, 1u);
}

TEST(ContactsAnswer, leaves_out_what_is_beyond_its_limits_from_the_end) {
  mesh::document::Contacts found;
  for (int r = 0; r < 3; ++r) {
    mesh::document::ContactRegion region;
    region.shells_a = {mesh::ShellIndex(1u), mesh::ShellIndex(2u)};
    region.shells_b = {mesh::ShellIndex(3u)};
    region.curve.resize(2);
    region.vectors.resize(2);
    found.regions.push_back(region);
  }
  found.penetrations = 3;
  const ipc::Contacts answer = contacts_answer(4, found, {2, 4, 3, 1});
  EXPECT_EQ(answer.penetrations, 3u);
  ASSERT_EQ(answer.regions.size(), 2u);
  EXPECT_EQ(answer.regions[0].shells, (std::vector<std::uint32_t>{1, 2, 3}));
  EXPECT_EQ(answer.regions[1].shells, (std::vector<std::uint32_t>{1}));
  EXPECT_EQ(answer.regions[1].shells_a, 2u) << "counts are whole";
  EXPECT_EQ(answer.regions[0].curve.size(), 2u);
  EXPECT_EQ(answer.regions[1].curve.size(), 1u);
  EXPECT_EQ(answer.regions[0].vectors.size(), 1u);
  EXPECT_TRUE(answer.regions[1].vectors.empty());
}

TEST_F(ContactsAsked, a_drag_tells_what_comes_to_touch) {
  open(write_plates(file("apart.k"), 5));
  Outcome begun = handler_.begin_drag(
      3, mesh::document::parse_edit(R"({"edit":"translate","by":[0,0,0],"on":"101-136","falloff":{"profile":"constant"}})").value());
  ASSERT_TRUE(std::holds_alternative<ipc::DragBegun>(begun.answer));
  const ipc::PreviewReader preview = ipc::PreviewReader::map(begun.descriptors.at(0)).value();
  std::uint64_t sequence = 0;
  const auto step = [&](double z) {
    handler_.step_drag({3, ++sequence, {0, 0, z}, 0, 0}, false);
    ipc::PreviewFrame frame;
    EXPECT_TRUE(preview.latest(frame));
    return frame.touches;
  };
  EXPECT_EQ(step(-3.5).parts, 0u);
  const ipc::PreviewTouches touches = step(-4.2);
  EXPECT_EQ(touches.parts, 2u);
  EXPECT_TRUE(touches.watched);
  EXPECT_FALSE(touches.cross);
  EXPECT_NEAR(touches.depth, 0.2, 1e-12);
  EXPECT_EQ(touches.part_a, mesh::PartIndex(1u)) << "the moved one first";
  EXPECT_EQ(touches.part_b, mesh::PartIndex(0u));
  for (std::size_t s = 0; s < preview.shells().size(); ++s) EXPECT_TRUE(touches.touches(s)) << s;
  EXPECT_EQ(touches.others.size(), 25u);
  EXPECT_EQ(step(-1).parts, 0u) << "back again";
  handler_.cancel_drag("test");
  EXPECT_EQ(get().penetrations, 0u) << "the document is as it was";
}

}  // namespace
}  // namespace prismesh::modeld
