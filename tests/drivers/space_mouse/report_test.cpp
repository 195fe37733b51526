#include "drivers/space_mouse/report.h"

#include <vector>

#include <gtest/gtest.h>

namespace prismesh::drivers::space_mouse {
namespace {

std::vector<std::byte> report_of(std::initializer_list<int> bytes) {
  std::vector<std::byte> made;
  for (const int each : bytes) made.push_back(static_cast<std::byte>(each));
  return made;
}

TEST(SpaceMouseReports, of_a_space_navigator_come_one_after_the_other) {
  // As recorded from one: docs of the open SpaceMouse by AndunHH.
  SpaceMouseState state;
  EXPECT_EQ(take_report(report_of({0x01, 0x05, 0x00, 0x00, 0x00, 0x00, 0x00}), state), ReportKind::shift);
  EXPECT_EQ(take_report(report_of({0x02, 0x00, 0x00, 0xE2, 0xFF, 0x00, 0x00}), state), ReportKind::turn);
  EXPECT_EQ(take_report(report_of({0x03, 0x03, 0x00}), state), ReportKind::buttons);
  EXPECT_EQ(state, (SpaceMouseState{{5, 0, 0}, {0, -30, 0}, 3}));
  EXPECT_EQ(take_report(report_of({0x03, 0x02, 0x00}), state), ReportKind::buttons);
  EXPECT_EQ(state.buttons, 2u);
}

TEST(SpaceMouseReports, of_newer_models_have_six_axes) {
  SpaceMouseState state;
  EXPECT_EQ(take_report(report_of({1, 0x5E, 1, 0xA2, 0xFE, 1, 0, 2, 0, 0xFF, 0xFF, 3, 0}), state), ReportKind::shift_and_turn);
  EXPECT_EQ(state, (SpaceMouseState{{350, -350, 1}, {2, -1, 3}, 0}));
}

TEST(SpaceMouseReports, that_are_cut_or_unknown_change_nothing) {
  SpaceMouseState state{{1, 2, 3}, {4, 5, 6}, 7};
  const SpaceMouseState before = state;
  EXPECT_FALSE(take_report({}, state));
  for (const int kind : {1, 2})
    for (std::size_t length = 1; length < 7; ++length) {
      std::vector<std::byte> cut(length, std::byte{9});
      cut[0] = static_cast<std::byte>(kind);
      EXPECT_FALSE(take_report(cut, state)) << kind << " " << length;
    }
  EXPECT_FALSE(take_report(report_of({3}), state));
  EXPECT_EQ(take_report(report_of({0x17, 100, 1}), state), ReportKind::other);  // a battery's
  EXPECT_EQ(state, before);
}

TEST(SpaceMouseReports, are_cut_at_full_deflection) {
  SpaceMouseState state;
  take_report(report_of({2, 0xFF, 0x7F, 0x00, 0x80, 0x5F, 0x01}), state);
  EXPECT_EQ(state.turn, (std::array{350, -350, 350}));
}

TEST(SpaceMouseReports, of_many_buttons_are_read) {
  SpaceMouseState state;
  take_report(report_of({3, 1, 0, 0, 0x80, 0, 0, 0, 0x40, 0xFF}), state);
  EXPECT_EQ(state.buttons, 0x4000000080000001u);
}

TEST(SpaceMouseModels, are_known_by_their_numbers) {
  EXPECT_EQ(find_space_mouse(0x046D, 0xC626)->name, "SpaceNavigator");
  EXPECT_EQ(find_space_mouse(0x256F, 0xC635)->name, "SpaceMouse Compact");
  EXPECT_FALSE(find_space_mouse(0x046D, 0xC077));  // a mouse
  EXPECT_FALSE(find_space_mouse(0x256F, 0xC626));
}

}  // namespace
}  // namespace prismesh::drivers::space_mouse
