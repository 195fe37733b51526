#include "daemon/deviced/pen/weighing_line.h"

#include <vector>

#include <gtest/gtest.h>

namespace prismesh::deviced::pen {
namespace {

using drivers::haptic_pen::HapticPen;
using drivers::haptic_pen::PenCommand;
using drivers::haptic_pen::PenLimits;
using drivers::haptic_pen::PenReading;

class RecordingPen : public HapticPen {
 public:
  PenReading read(std::int64_t) override { return {}; }
  void send(std::int64_t, const PenCommand& command) override { sent.push_back(command.newton); }
  const PenLimits& limits() const override { return limits_; }
  bool gone() const override { return false; }
  bool is_stuck(std::int64_t) override { return stuck; }
  std::vector<Eigen::Vector3d> sent;
  bool stuck = false;

 private:
  PenLimits limits_;
};

class WeighingLineTest : public ::testing::Test {
 protected:
  RecordingPen pen_;
  GuardPage guard_;
  WeighingLine line_{pen_, guard_};
  const Eigen::Vector3d none_ = Eigen::Vector3d::Zero(), force_{0, 0.5, 0};
};

TEST_F(WeighingLineTest, takes_the_line_back_where_the_guard_ended_no_force) {
  EXPECT_FALSE(line_.send(0, none_));
  guard_.token = LineToken::tripped;
  EXPECT_FALSE(line_.send(1, none_));
  EXPECT_FALSE(guard_.is_tripped());
  EXPECT_FALSE(line_.send(2, force_));
  EXPECT_EQ(pen_.sent.back(), force_);
}

TEST_F(WeighingLineTest, sends_no_force_after_the_guard_ended_one) {
  EXPECT_FALSE(line_.send(0, force_));
  guard_.token = LineToken::tripped;
  EXPECT_TRUE(line_.send(1, force_));
  EXPECT_EQ(pen_.sent.back(), none_);
  EXPECT_FALSE(guard_.is_tripped()) << "the zero is sent: the line is free again";
  EXPECT_TRUE(line_.send(2, force_));
  EXPECT_EQ(pen_.sent.back(), none_) << "for good";
}

TEST_F(WeighingLineTest, a_trip_between_silence_and_a_force_ends_none) {
  line_.send(0, none_);
  guard_.token = LineToken::tripped;
  EXPECT_FALSE(line_.send(1, force_));
  EXPECT_TRUE(guard_.is_tripped()) << "the guard keeps the line until a zero was sent";
  EXPECT_TRUE(line_.send(2, force_));
  EXPECT_FALSE(guard_.is_tripped());
}

TEST_F(WeighingLineTest, a_stuck_line_has_no_heartbeat) {
  line_.send(0, none_);
  EXPECT_EQ(guard_.beats, 1U);
  pen_.stuck = true;
  line_.send(1, none_);
  EXPECT_EQ(guard_.beats, 1U);
}

}  // namespace
}  // namespace prismesh::deviced::pen
