#include <array>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "mesh/shape/weights.h"

namespace prismesh::mesh::shape {
namespace {

constexpr std::array kAll{Profile::constant, Profile::linear, Profile::smooth,         Profile::sharp,
                          Profile::root,     Profile::sphere, Profile::inverse_square, Profile::gaussian};

double at(Profile profile, double d, double flat = 0) { return evaluate({profile, flat, std::nullopt}, d); }

TEST(Profile, counts_what_is_no_number_as_the_border) {
  for (const Profile profile : kAll) EXPECT_EQ(at(profile, std::nan("")), at(profile, 0));
}

TEST(Profile, has_its_values) {
  struct Row {
    Profile profile;
    double quarter;
    double half;
    double three_quarters;
  };
  const double floor = std::exp(-4.5);
  const auto gauss = [&](double from_origin) { return (std::exp(-4.5 * from_origin * from_origin) - floor) / (1 - floor); };
  const std::array<Row, 8> rows{{{Profile::constant, 1, 1, 1},
                                 {Profile::linear, 0.25, 0.5, 0.75},
                                 {Profile::smooth, 0.15625, 0.5, 0.84375},
                                 {Profile::sharp, 0.0625, 0.25, 0.5625},
                                 {Profile::root, 0.5, std::sqrt(0.5), std::sqrt(0.75)},
                                 {Profile::sphere, std::sqrt(0.4375), std::sqrt(0.75), std::sqrt(0.9375)},
                                 {Profile::inverse_square, 0.4375, 0.75, 0.9375},
                                 {Profile::gaussian, gauss(0.75), gauss(0.5), gauss(0.25)}}};
  for (const Row& row : rows) {
    SCOPED_TRACE(name(row.profile));
    EXPECT_NEAR(at(row.profile, 0.25), row.quarter, 1e-15);
    EXPECT_NEAR(at(row.profile, 0.5), row.half, 1e-15);
    EXPECT_NEAR(at(row.profile, 0.75), row.three_quarters, 1e-15);
  }
}

TEST(Profile, ends_at_one_and_zero_and_never_turns_back) {
  for (const Profile profile : kAll) {
    SCOPED_TRACE(name(profile));
    EXPECT_EQ(at(profile, 1), 1);
    EXPECT_EQ(at(profile, 2), 1);
    EXPECT_EQ(at(profile, 0), profile == Profile::constant ? 1 : 0);
    EXPECT_EQ(at(profile, -1), at(profile, 0));
    for (int i = 0; i < 1000; ++i) EXPECT_LE(at(profile, i / 1000.0), at(profile, (i + 1) / 1000.0));
  }
}

TEST(Profile, keeps_its_flat_centre_at_one) {
  for (const Profile profile : kAll) {
    SCOPED_TRACE(name(profile));
    EXPECT_EQ(at(profile, 0.7, 0.4), 1);
    EXPECT_EQ(at(profile, 0.6, 0.4), 1);
    EXPECT_NEAR(at(profile, 0.3, 0.4), at(profile, 0.5), 1e-15);
    EXPECT_EQ(at(profile, 0, 0.4), at(profile, 0));
    EXPECT_EQ(at(profile, 1e-9, 1), 1);
    EXPECT_EQ(at(profile, 0, 1), at(profile, 0));
  }
}

TEST(Profile, is_known_by_name) {
  for (const Profile profile : kAll) EXPECT_EQ(profile_from(name(profile)), profile);
  EXPECT_EQ(name(Profile::inverse_square), "inverse_square");
  EXPECT_EQ(profile_from("Smooth"), std::nullopt);
  EXPECT_EQ(profile_from(""), std::nullopt);
}

}  // namespace
}  // namespace prismesh::mesh::shape
