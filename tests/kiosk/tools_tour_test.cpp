// The tour: its words name keys that exist.
#include "kiosk/tools/tour/tour_tool.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "kiosk/tool_list.h"

namespace prismesh::kiosk::tools::tour {
namespace {

TEST(TourSteps, name_keys_of_the_tables) {
  for (const TourStep& step : tour_steps()) {
    if (step.key.empty()) continue;
    const auto bindings = key_bindings();
    EXPECT_TRUE(std::any_of(bindings.begin(), bindings.end(), [&](const auto& each) { return each.label == step.key; })) << step.key;
    EXPECT_NE(step.words.find(step.key), std::string_view::npos) << step.title;
  }
}

}  // namespace
}  // namespace prismesh::kiosk::tools::tour
