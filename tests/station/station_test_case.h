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
  std::unique_ptr<Station> station_;
  std::string original_;
  std::map<std::int64_t, Point> nodes_;
};

}  // namespace prismesh::test
