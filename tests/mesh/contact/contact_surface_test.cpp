#include "mesh/contact/contact_surface.h"

#include <gtest/gtest.h>

#include "mesh/contact/contact_thickness.h"
#include "tests/support/make_model.h"

namespace prismesh::mesh::contact {
namespace {

/// Two quads of 10 that meet at the nodes 2 and 3, the second one `degrees` up.
Model bent(double degrees) {
  const double angle = degrees * 3.14159265358979323846 / 180;
  const Vec3 along(10 * std::cos(angle), 0, 10 * std::sin(angle));
  return test::make_model({{1, Vec3(0, 0, 0)},
                           {2, Vec3(10, 0, 0)},
                           {3, Vec3(10, 10, 0)},
                           {4, Vec3(0, 10, 0)},
                           {5, Vec3(Vec3(10, 0, 0) + along)},
                           {6, Vec3(Vec3(10, 10, 0) + along)}},
                          {{1, 1, {1, 2, 3, 4}}, {2, 1, {2, 5, 6, 3}}});
}

double distance_from_plane(const Model& before, const Model& after, int shell, NodeIndex node) {
  const ShellNodes& nodes = before.shell(ShellIndex(static_cast<std::size_t>(shell)));
  const Vec3 origin = before.position(nodes.node[0]);
  const Vec3 normal = (before.position(nodes.node[1]) - origin).cross(before.position(nodes.node[3]) - origin).normalized();
  return (after.position(node) - origin).dot(normal);
}

TEST(ContactSurface, keeps_the_distance_of_both_sides_of_a_bend) {
  for (const double degrees : {0.0, 5.0, 30.0, 90.0, 150.0, -90.0}) {
    const Model model = bent(degrees);
    const Model surface = contact_surface(model, {0.5, 0.5});
    for (const int shell : {0, 1})
      for (const NodeIndex node : model.shell(ShellIndex(static_cast<std::size_t>(shell))).node)
        EXPECT_NEAR(distance_from_plane(model, surface, shell, node), 0.5, degrees == 5.0 ? 1e-3 : 1e-12) << degrees;
  }
}

TEST(ContactSurface, goes_between_different_offsets_in_a_plane_and_leaves_the_rest) {
  const Model model = bent(0);
  const Model surface = contact_surface(model, {0, 1});
  EXPECT_EQ(surface.position(NodeIndex(std::size_t{0})), Vec3(0, 0, 0));
  EXPECT_NEAR(surface.position(NodeIndex(std::size_t{1})).z(), 0.5, 1e-12);
  EXPECT_NEAR(surface.position(NodeIndex(std::size_t{4})).z(), 1, 1e-12);
  const Model corner = contact_surface(bent(90), {0, 1});
  EXPECT_NEAR((corner.position(NodeIndex(std::size_t{1})) - Vec3(9, 0, 0)).norm(), 0, 1e-12) << "along the first shell";
}

TEST(GapRules, take_the_mean_between_limits) {
  ContactThickness thickness;
  thickness.of_shell = {1, 3, 5};
  const auto shell = [](std::size_t s) { return ShellIndex(s); };
  EXPECT_EQ(thickness.between(shell(0), shell(1)), 2);
  thickness.rules.resize(3);
  for (std::size_t s = 0; s < 3; ++s) thickness.rules[s] = {thickness.of_shell[s], 1.5, 3.5};
  EXPECT_EQ(thickness.between(shell(0), shell(1)), 2);
  EXPECT_EQ(thickness.between(shell(0), shell(0)), 1.5);
  EXPECT_EQ(thickness.between(shell(1), shell(2)), 3.5);
  thickness.rules[1].by_mesh = thickness.rules[2].by_mesh = 2.5;
  EXPECT_EQ(thickness.between(shell(1), shell(2)), 2.5);
}

}  // namespace
}  // namespace prismesh::mesh::contact
