#include "ipc/pen/messages_json.h"

#include <gtest/gtest.h>

#include "ipc/pen/page.h"
#include "ipc/pen/roles.h"

namespace prismesh::ipc {
namespace {

TEST(PenMessages, come_back_as_they_were) {
  const auto feel =
      decode_pen_request(encode_pen_request(5, SetFeel{.stiffness_newton_m = 300, .friction = {}, .damping_newton_s_m = 0.1}).value());
  ASSERT_TRUE(feel);
  EXPECT_EQ(feel->number, 5U);
  const SetFeel& read = std::get<SetFeel>(feel->request);
  EXPECT_EQ(read.stiffness_newton_m, 300);
  EXPECT_FALSE(read.friction);
  EXPECT_EQ(read.damping_newton_s_m, 0.1);
  const PenInfo info{"simulated", "/dev/pts/3", true, "armed", "none", 6, 500, 0.1, 0.2, 2, true};
  const auto said = decode_from_pen(encode_pen_answer(7, Pen{info}));
  ASSERT_TRUE(said);
  EXPECT_EQ(std::get<Pen>(std::get<PenAnswer>(said->message)).pen, info);
  const auto event = decode_from_pen(encode_pen_event(PenChanged{info}));
  ASSERT_TRUE(event);
  EXPECT_EQ(std::get<PenChanged>(std::get<PenEvent>(event->message)).pen, info);
}

TEST(PenMessages, are_refused_with_the_nearest_name) {
  const auto wrong = decode_pen_request(R"({"request":"amr","number":3})");
  ASSERT_FALSE(wrong);
  EXPECT_EQ(wrong.error().number, 3U);
  EXPECT_NE(wrong.error().message.find("arm"), std::string::npos);
}

TEST(PenRoles, who_watches_may_look_and_only_devices_may_move_the_hand) {
  EXPECT_EQ(role_for(PenHello{}), Role::watch);
  EXPECT_EQ(role_for(GetPen{}), Role::watch);
  EXPECT_EQ(role_for(ArmPen{}), Role::devices);
  EXPECT_EQ(role_for(DisarmPen{}), Role::devices);
  EXPECT_EQ(role_for(SetFeel{}), Role::devices);
  EXPECT_EQ(role_for(AttachField{}), Role::devices);
}

TEST(PenPages, show_what_was_written) {
  PenPage page = PenPage::create().value();
  PenPageReader reader = PenPageReader::map(page.descriptor()).value();
  EXPECT_FALSE(reader.state());
  PenState state;
  state.stage = PenStage::armed;
  state.newton = {1, 2, 3};
  page.set_state(state);
  EXPECT_EQ(reader.state()->newton[2], 3);
  EXPECT_EQ(name(reader.state()->stage), "armed");
}

}  // namespace
}  // namespace prismesh::ipc
