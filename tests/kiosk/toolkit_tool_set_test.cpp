// What one tool or the editor asks of all tools.
#include "kiosk/toolkit/tool_set.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace prismesh::kiosk::toolkit {
namespace {

using input::TakeBackClicked;

using testing::ElementsAre;

/// Writes down what it is asked for.
class NotedTool final : public Tool, public TakesGestures, public HasMode, public TakesBack, public GuardsEdits {
 public:
  NotedTool(std::string name, std::vector<std::string>& noted) : name_(std::move(name)), noted_(noted) {}

  std::string_view name() const override { return name_; }
  void command(std::uint8_t number, const Pointer&) override { note("command " + std::to_string(number)); }
  bool gesture(const input::Gesture&) override { return note("gesture"), takes; }
  bool in_mode() const override { return mode; }
  bool leave_mode() override { return note("leave mode"), mode; }
  bool take_back() override { return note("take back"), on; }
  bool allow_edit() override { return note("allow edit"), !refuses; }
  void edit_begins() override { note("edit begins"); }
  std::string guidance() const override { return words; }

  bool takes = false, mode = false, on = false, refuses = false;
  std::string words;

 private:
  void note(const std::string& what) { noted_.push_back(name_ + ": " + what); }

  std::string name_;
  std::vector<std::string>& noted_;
};

/// Has no ability beside those of every tool.
class PlainTool final : public Tool {
 public:
  std::string_view name() const override { return "plain"; }
  std::string guidance() const override { return "plain words"; }
};

class ToolSetTest : public testing::Test {
 protected:
  ToolSetTest() : first_(add("first")), second_(add("second")) {}

  std::vector<std::string> noted_;
  ToolSet tools_;
  NotedTool& first_;
  NotedTool& second_;

 private:
  NotedTool& add(const std::string& name) {
    auto made = std::make_unique<NotedTool>(name, noted_);
    NotedTool& tool = *made;
    tools_.add(std::move(made));
    return tool;
  }
};

TEST_F(ToolSetTest, a_command_goes_to_its_owner_only) {
  EXPECT_TRUE(tools_.command({"second", 3}, std::nullopt));
  EXPECT_FALSE(tools_.command({"third", 0}, std::nullopt));
  EXPECT_THAT(noted_, ElementsAre("second: command 3"));
}

TEST_F(ToolSetTest, a_gesture_goes_to_tools_in_a_mode_first_and_ends_with_the_one_that_takes_it) {
  tools_.gesture(TakeBackClicked{});
  EXPECT_THAT(noted_, ElementsAre("first: gesture", "second: gesture"));
  noted_.clear();
  second_.mode = true;
  tools_.gesture(TakeBackClicked{});
  EXPECT_THAT(noted_, ElementsAre("second: gesture", "first: gesture"));
  noted_.clear();
  second_.takes = true;
  tools_.gesture(TakeBackClicked{});
  EXPECT_THAT(noted_, ElementsAre("second: gesture"));
}

TEST_F(ToolSetTest, only_tools_with_an_ability_are_asked_in_the_order_of_all) {
  tools_.add(std::make_unique<PlainTool>());
  EXPECT_EQ(tools_.all().size(), 3u);
  EXPECT_THAT(tools_.with<GuardsEdits>(), ElementsAre(&first_, &second_));
  EXPECT_TRUE(tools_.with<HasTab>().empty());
  tools_.edit_begins();
  EXPECT_THAT(noted_, ElementsAre("first: edit begins", "second: edit begins"));
  EXPECT_EQ(tools_.guidance(), "plain words") << "every tool may have some";
  first_.mode = true;
  first_.words = "what to click";
  EXPECT_EQ(tools_.guidance(), "what to click");
}

TEST_F(ToolSetTest, a_tool_sees_the_modes_of_the_others) {
  second_.mode = true;
  EXPECT_TRUE(tools_.in_mode());
  EXPECT_TRUE(tools_.in_mode(&first_));
  EXPECT_FALSE(tools_.in_mode(&second_));
}

TEST_F(ToolSetTest, giving_up_ends_with_the_first_tool_that_has_something) {
  first_.on = true;
  EXPECT_FALSE(tools_.leave_mode());
  EXPECT_TRUE(tools_.take_back());
  EXPECT_THAT(noted_, ElementsAre("first: leave mode", "second: leave mode", "first: take back"));
}

TEST_F(ToolSetTest, one_tool_that_refuses_stops_an_edit) {
  EXPECT_TRUE(tools_.allow_edit());
  second_.refuses = true;
  EXPECT_FALSE(tools_.allow_edit());
}

TEST_F(ToolSetTest, the_guidance_is_that_of_a_mode_or_else_of_the_first_tool_that_has_some) {
  EXPECT_EQ(tools_.guidance(), "");
  first_.words = "which state";
  second_.words = "what to click";
  EXPECT_EQ(tools_.guidance(), "which state");
  second_.mode = true;
  EXPECT_EQ(tools_.guidance(), "what to click");
}

}  // namespace
}  // namespace prismesh::kiosk::toolkit
