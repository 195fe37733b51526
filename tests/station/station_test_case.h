// A test on a station of its own with a small picture, which is drawn fast, and what its deck says before anything is done.
#pragma once

#include <map>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "tests/station/station.h"

namespace prismesh::test {

/// Skipped with the reason where no station can run.
class StationTestCase : public ::testing::Test {
 protected:
  void SetUp() override {
    if (const std::string missing = missing_programs(); !missing.empty())
      GTEST_SKIP() << "SKIPPED: the station can't be tested here, install " << missing;
    station_ = std::make_unique<Station>();
    station_->set_picture_size(1000, 640);
    original_ = whole_file(station_->deck());
    nodes_ = nodes_of_deck(original_);
  }
  /// What the item last said; empty if there is none.
  std::string state_of(const std::string& name) {
    const auto item = station_->item(name);
    return item ? item->state : "";
  }
  /// Whether the item comes to say these words. The whole screen has been told then: items that went are told last.
  bool says(const std::string& name, const std::string& words) {
    const std::string beginning = "item \"" + name + "\" ";
    const bool said =
        state_of(name).find(words) != std::string::npos ||
        !station_->kiosk()
             .wait_until([&](const std::string& line) { return line.starts_with(beginning) && line.find(words) != std::string::npos; })
             .empty();
    station_->settled_aim();
    return said;
  }
  std::unique_ptr<Station> station_;
  std::string original_;
  std::map<std::int64_t, Point> nodes_;
};

}  // namespace prismesh::test
