#include "mesh/relax/relax.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "mesh/relax/quality_guard.h"
#include "tests/mesh/relax/relaxing.h"

namespace prismesh::test {

namespace {

using namespace mesh;

TEST(relax, stays_on_the_true_surface_and_makes_elements_better) {
  for (const KnownSurface& known : {cylinder(), cone(), torus()})
    for (const double jitter : {0.15, 0.3, 0.4}) {
      const Model before = sheet_on(known, 20, 16, jitter);
      const relax::Relaxed relaxed = relax_all(before);
      const Model after = moved(before, relaxed);
      double off = 0;
      for (const Vec3& position : relaxed.positions) off = std::max(off, known.off(position));
      const std::vector<float> was = composites(before), is = composites(after);
      EXPECT_LE(off, 0.1 * known.sagitta) << known.name << ", jitter " << jitter;
      EXPECT_GT(mean(is), mean(was) + 0.1) << known.name << ", jitter " << jitter;
      EXPECT_GT(least(is), least(was)) << known.name << ", jitter " << jitter;
      EXPECT_TRUE(relaxed.converged);
      EXPECT_GT(relaxed.nodes.size(), 19u * 15u);  // the border's nodes go along it as well
    }
}

TEST(relax, keeps_to_the_surface_where_nodes_have_slid_before) {
  for (const KnownSurface& known : {cylinder(), cone(), torus()}) {
    const Model regular = sheet_on(known, 20, 16, 0.1);
    const Model slid = sheet_on(known, 20, 16, 0.35);
    const relax::ReferenceSurface surface(regular, all_shells(regular), 30);
    const relax::Relaxed relaxed = relax::relax({slid, surface, criteria_of(), {}}, all_nodes(slid)).value();
    double off = 0;
    for (const Vec3& position : relaxed.positions) off = std::max(off, known.off(position));
    EXPECT_LE(off, 0.1 * known.sagitta) << known.name;
    EXPECT_GT(least(composites(moved(slid, relaxed))), least(composites(slid)));
  }
}

TEST(relax, again_moves_little) {
  for (const KnownSurface& known : {cylinder(), cone(), torus()}) {
    const Model before = sheet_on(known, 20, 16, 0.3);
    const relax::ReferenceSurface surface(before, all_shells(before), 30);
    const relax::Relaxed first = relax::relax({before, surface, criteria_of(), {}}, all_nodes(before)).value();
    const Model after = moved(before, first);
    const relax::Relaxed second = relax::relax({after, surface, criteria_of(), {}}, all_nodes(after)).value();
    EXPECT_LT(second.farthest, 0.2 * first.farthest) << known.name;
    const Model last = moved(after, second);
    const relax::Relaxed third = relax::relax({last, surface, criteria_of(), {}}, all_nodes(last)).value();
    EXPECT_LT(third.farthest, second.farthest) << known.name;
  }
}

/// A flat plate of 24 x 24 with a round hole of 32 nodes; rings of elements lead from the hole to the square.
Model plate_with_hole(double jitter) {
  constexpr int kAround = 32, kRings = 8;
  std::vector<NodeSpec> nodes;
  std::vector<ShellSpec> shells;
  for (int ring = 0; ring <= kRings; ++ring)
    for (int i = 0; i < kAround; ++i) {
      const bool inside = ring > 0 && ring < kRings;
      // nodes of the hole's own edge are out of place along it
      const double angle = 2 * kPi * (i + (ring < kRings ? jitter * noise(i, ring, 1) : 0)) / kAround;
      const double share = (ring + (inside ? jitter * noise(i, ring, 2) : 0)) / kRings;
      const Vec3 out(std::cos(angle), std::sin(angle), 0);
      const double border = 60 / std::max(std::abs(out.x()), std::abs(out.y()));
      nodes.push_back({1 + ring * kAround + i, out * ((1 - share) * 20 + share * border)});
    }
  for (int ring = 0; ring < kRings; ++ring)
    for (int i = 0; i < kAround; ++i) {
      const std::int64_t a = 1 + ring * kAround + i, b = 1 + ring * kAround + (i + 1) % kAround;
      shells.push_back({static_cast<std::int64_t>(shells.size()) + 1, 1, {a, b, b + kAround, a + kAround}});
    }
  return make_model(nodes, shells);
}

TEST(relax, keeps_a_hole_round_and_corners_where_they_are) {
  const Model before = plate_with_hole(0.25);
  const relax::Relaxed relaxed = relax_all(before);
  const Model after = moved(before, relaxed);
  int of_hole = 0;
  for (std::size_t i = 0; i < relaxed.nodes.size(); ++i) of_hole += relaxed.nodes[i].value < 32 ? 1 : 0;
  EXPECT_GT(of_hole, 20);
  const double sagitta = 20 * (1 - std::cos(kPi / 32));
  for (std::size_t n = 0; n < 32; ++n) EXPECT_NEAR(after.position(NodeIndex(n)).norm(), 20, 0.01 * sagitta);
  for (std::size_t n = 8 * 32; n < 9 * 32; ++n) {
    const Vec3 &was = before.position(NodeIndex(n)), &is = after.position(NodeIndex(n));
    EXPECT_NEAR(is.cwiseAbs().maxCoeff(), 60, 1e-9);
    if (std::abs(std::abs(was.x()) - std::abs(was.y())) < 1e-9) {
      EXPECT_EQ(is, was);
    }
  }
}

TEST(relax, keeps_a_crease_straight) {
  // an L: columns 0..9 lie flat, then it goes up; the crease at column 10
  const Model before = make_grid(20, 12, [](int i, int j) {
    const bool inside = j > 0 && j < 12;
    const double x = i == 0 || i == 10 || i == 20 ? i : i + 0.3 * noise(i, j, 1), y = j + (inside ? 0.3 * noise(i, j, 2) : 0);
    return Vec3(5 * std::min(x, 10.0), 5 * y, 5 * std::max(x - 10, 0.0));
  });
  const relax::Relaxed relaxed = relax_all(before);
  const Model after = moved(before, relaxed);
  int along = 0;
  for (int j = 0; j <= 12; ++j) {
    const NodeIndex node(static_cast<std::size_t>(10 + 21 * j));
    EXPECT_NEAR(after.position(node).x(), 50, 1e-9);
    EXPECT_NEAR(after.position(node).z(), 0, 1e-9);
    along += after.position(node) != before.position(node) ? 1 : 0;
  }
  EXPECT_GT(along, 8);
  for (std::size_t n = 0; n < after.node_count(); ++n) {  // every node on its side
    const Vec3& p = after.position(NodeIndex(n));
    EXPECT_NEAR(n % 21 <= 10 ? p.z() : p.x(), n % 21 <= 10 ? 0 : 50, 1e-9);
  }
}

TEST(relax, takes_creases_of_a_coarse_mesh_on_a_round_surface_for_none) {
  // 10 facets on 240 degrees of a tube: they meet at 24 degrees, and at 32 where the neighbours of a node that slid have slid apart
  constexpr std::array kSlid = {-0.35, 0.4, 0.35};
  const auto tube = [&](double share) {
    return make_grid(10, 8, [&](int i, int j) {
      const bool inside = i > 0 && i < 10 && j > 0 && j < 8;
      const double angle = (i + (inside ? share * kSlid[static_cast<std::size_t>(i % 3)] : 0)) * 24 * kPi / 180;
      return Vec3(20 * std::cos(angle), 20 * std::sin(angle), 8.0 * j);
    });
  };
  const Model round = tube(0), slid = tube(1);
  const std::vector<relax::Freedom> by_mesh = relax::node_freedoms(slid, all_nodes(slid), 30);
  std::size_t inside = 0;
  for (const relax::Freedom freedom : by_mesh) inside += freedom == relax::Freedom::surface ? 1 : 0;
  ASSERT_LT(inside, 9u * 7u);  // or it was no trial
  const relax::ReferenceSurface surface(round, all_shells(round), 30);
  const relax::Relaxed relaxed = relax::relax({slid, surface, criteria_of(8), {}}, all_nodes(slid)).value();
  const Model after = moved(slid, relaxed);
  for (int j = 1; j < 8; ++j)
    for (int i = 1; i < 10; ++i) {
      const NodeIndex node(static_cast<std::size_t>(i + 11 * j));
      EXPECT_LT((after.position(node) - round.position(node)).norm(), 1) << i << ' ' << j;  // slid by 3
    }
}

TEST(relax, moves_nodes_between_parts_along_the_border_only) {
  // the border is the circle at height 40: its nodes are out of place along it, all others inside in both directions
  const KnownSurface tube = cylinder();
  const Model one_part = make_grid(20, 16, [&](int i, int j) {
    const bool inside = i > 0 && j > 0 && i < 20 && j < 16;
    return tube.at(i + (inside ? 0.3 * noise(i, j, 1) : 0), j + (inside && j != 8 ? 0.3 * noise(i, j, 2) : 0));
  });
  Model two_parts = one_part;
  auto parts = std::make_shared<std::vector<Part>>(*two_parts.parts);
  parts->push_back(parts->front());
  parts->back().id = 2;
  two_parts.parts = parts;
  for (std::size_t s = 8 * 20; s < two_parts.shell_count(); ++s) two_parts.shell_parts.set(s, PartIndex(std::size_t{1}));
  const auto farthest_off = [](const Model& model) {
    double off = 0;
    for (std::size_t i = 0; i <= 20; ++i) off = std::max(off, std::abs(model.positions[8 * 21 + i].z() - 8 * kSize));
    return off;
  };
  ASSERT_GT(farthest_off(moved(one_part, relax_all(one_part))), 0.02 * kSize);  // or it was no trial
  const Model after = moved(two_parts, relax_all(two_parts));
  EXPECT_LT(farthest_off(after), 1e-9);
  int along = 0;
  for (std::size_t n = 8 * 21; n <= 8 * 21 + 20; ++n) {
    along += after.positions[n] != two_parts.positions[n] ? 1 : 0;
    EXPECT_LE(tube.off(after.positions[n]), 0.1 * tube.sagitta);
  }
  EXPECT_GT(along, 15);
}

TEST(relax, makes_nothing_fail_that_passed) {
  std::size_t held_back = 0;
  for (const double jitter : {0.2, 0.35, 0.45}) {
    const Model before = mixed_panel(jitter, 0.3);
    const relax::ReferenceSurface surface(before, all_shells(before), 30);
    const relax::Relaxed relaxed = relax::relax({before, surface, criteria_of(1), {}}, all_nodes(before)).value();
    held_back += relaxed.held_back;
    expect_nothing_worse(before, moved(before, relaxed), 1);
  }
  EXPECT_GT(held_back, 0u);  // or it had nothing to hold
}

TEST(relax, counts_as_held_back_what_is_taken_back_at_the_end) {
  const Model before = mixed_panel(0.45, 0.3);
  relax::Options options;
  options.checks_before_rest = false;  // and none has been careful before the last round
  options.max_rounds = 1;
  const relax::ReferenceSurface surface(before, all_shells(before), 30);
  const relax::Relaxed relaxed = relax::relax({before, surface, criteria_of(1), options}, all_nodes(before)).value();
  EXPECT_GT(relaxed.held_back, 0u);
  expect_nothing_worse(before, moved(before, relaxed), 1);
}

TEST(relax_guard, lets_no_shell_be_turned_over_whatever_its_shape_is_then) {
  // an equilateral triangle: with its tip mirrored in its base it has the same shape, upside down
  const Model model = make_shells({{0, 2.6, 0}, {-1.5, 0, 0}, {1.5, 0, 0}}, {{0, 1, 2, 2}});
  relax::SpringNet net;
  net.movable = 1;
  for (std::size_t n = 0; n < 3; ++n) {
    net.nodes.emplace_back(n);
    net.start.push_back(model.position(NodeIndex(n)));
  }
  net.shells = {ShellIndex(0)};
  net.corners = {{0, 1, 2, 2}};
  const relax::QualityGuard guard(model, net, criteria_of(3));
  const Vec3 mirrored(0, -2.6, 0);
  EXPECT_TRUE(guard.allows(0, net.start[0], net.start));
  EXPECT_FALSE(guard.allows(0, mirrored, net.start));
  std::vector<Vec3> places = net.start;
  places[0] = mirrored;
  const auto held = guard.hold_back(
      net.start, places, [&](std::uint32_t node, const Vec3& point) { places[node] = point; }, [] { return true; });
  ASSERT_TRUE(held.has_value());
  EXPECT_EQ(held->nodes, std::vector<std::uint32_t>{0});
  EXPECT_GT(places[0].y(), 0);
}

/// Triangles side by side that share no node, each with its tip as the only node that may move: those are the net's first nodes.
struct Tents {
  explicit Tents(const std::vector<Vec3>& tips, double thickness = 0) {
    std::vector<Vec3> points;
    std::vector<std::array<int, 4>> shells;
    const int count = static_cast<int>(tips.size());
    for (int i = 0; i < count; ++i) points.emplace_back(tips[static_cast<std::size_t>(i)] + Vec3(10 * i, 0, 0));
    for (int i = 0; i < count; ++i) {
      points.emplace_back(10 * i - 1.5, 0, 0);
      points.emplace_back(10 * i + 1.5, 0, 0);
      shells.push_back({i, count + 2 * i, count + 2 * i + 1, count + 2 * i + 1});
    }
    model = make_shells(points, shells);
    if (thickness > 0)
      for (int i = 0; i < count; ++i) model.shell_thickness.set(static_cast<std::size_t>(i), static_cast<float>(thickness));
    net.movable = tips.size();
    for (std::size_t n = 0; n < points.size(); ++n) net.nodes.emplace_back(n);
    net.start = points;
    for (std::size_t s = 0; s < tips.size(); ++s) {
      net.shells.emplace_back(s);
      const std::array<int, 4>& c = shells[s];
      net.corners.push_back({c[0], c[1], c[2], c[3]});
    }
  }
  bool allows(std::uint32_t tip, const Vec3& place, const quality::SizedCriteria& criteria) const {
    return relax::QualityGuard(model, net, criteria).allows(tip, place + Vec3(10 * tip, 0, 0), net.start);
  }
  Model model;
  relax::SpringNet net;
};

TEST(relax_guard, lets_none_become_the_new_worst_without_a_mark) {
  const Tents one({{0, 2.6, 0}});
  EXPECT_TRUE(one.allows(0, Vec3(0, 2.598, 0), criteria_of(3))) << "nearer to equilateral";
  EXPECT_FALSE(one.allows(0, Vec3(0.2, 2.6, 0), criteria_of(3)));
  const Tents two({{0, 2.6, 0}, {0.5, 2.6, 0}});
  EXPECT_TRUE(two.allows(0, Vec3(0.2, 2.6, 0), criteria_of(3))) << "the other one is worse";
  EXPECT_FALSE(two.allows(0, Vec3(0.7, 2.6, 0), criteria_of(3)));
}

TEST(relax_guard, lets_what_fails_get_better_only) {
  const Tents failing({{4, 1.2, 0}, {0, 2.6, 0}});
  EXPECT_TRUE(failing.allows(0, Vec3(3.9, 1.2, 0), criteria_of(3)));
  EXPECT_FALSE(failing.allows(0, Vec3(4.1, 1.2, 0), criteria_of(3)));
}

TEST(relax_guard, judges_by_the_sheets_thickness) {
  const quality::Criteria criteria = quality::parse_criteria("[metrics.min_length]\nfail_below_thicknesses = 1\n", "").value();
  EXPECT_TRUE(Tents({{0, 2.6, 0}}, 1).allows(0, Vec3(0, 2.7, 0), {criteria, 3}));
  EXPECT_FALSE(Tents({{0, 2.6, 0}}, 2.5).allows(0, Vec3(0, 2.3, 0), {criteria, 3}));
}

TEST(relax, gives_the_same_bits_with_any_number_of_threads) {
  const Model before = mixed_panel(0.35, 0.3);
  std::vector<relax::Relaxed> results;
  for (const std::size_t threads : {1, 2, 8}) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    const relax::ReferenceSurface surface(before, all_shells(before), 30);
    results.push_back(relax::relax({before, surface, criteria_of(1), {}}, all_nodes(before)).value());
  }
  for (const relax::Relaxed& result : results) {
    EXPECT_EQ(result.nodes, results.front().nodes);
    EXPECT_EQ(result.positions, results.front().positions);
    EXPECT_EQ(result.rounds, results.front().rounds);
  }
}

TEST(relax, moves_no_node_beyond_its_limit) {
  const Model before = sheet_on(torus(), 20, 16, 0.4);
  relax::Options options;
  options.max_move_on_surface = 0.5;
  options.max_move_on_line = 0.2;
  const relax::Relaxed relaxed = relax_all(before, options);
  EXPECT_GT(relaxed.limited, 50u);
  EXPECT_LE(relaxed.farthest, 0.5);
  for (std::size_t i = 0; i < relaxed.nodes.size(); ++i) {
    const std::size_t column = relaxed.nodes[i].value % 21, row = relaxed.nodes[i].value / 21;
    const double distance = (relaxed.positions[i] - before.position(relaxed.nodes[i])).norm();
    EXPECT_LE(distance, column == 0 || column == 20 || row == 0 || row == 16 ? 0.2 : 0.5);
  }
}

TEST(relax, counts_limits_from_where_it_is_told_to) {
  const Model before = sheet_on(torus(), 12, 10, 0.4);
  const relax::ReferenceSurface surface(before, all_shells(before), 30);
  std::vector<Vec3> home(before.node_count());
  for (std::size_t n = 0; n < home.size(); ++n) home[n] = before.position(NodeIndex(n));
  constexpr std::size_t kFree = 6 + 13 * 5;
  home[kFree] = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
  relax::Options options;
  options.max_move_on_surface = 0.3;
  options.max_move_on_line = 0.1;
  options.move_origins = &home;
  Model now = before;
  for (int time = 0; time < 3; ++time) now = moved(now, relax::relax({now, surface, criteria_of(), options}, all_nodes(now)).value());
  double farthest = 0;
  for (std::size_t n = 0; n < home.size(); ++n)
    if (n != kFree) farthest = std::max(farthest, (now.position(NodeIndex(n)) - home[n]).norm());
  EXPECT_LE(farthest, 0.3 + 1e-9);
  EXPECT_GT(farthest, 0.29);
  EXPECT_GT((now.position(NodeIndex(kFree)) - before.position(NodeIndex(kFree))).norm(), 0.35) << "without a place it has no limit";
}

TEST(relax, moves_only_what_may_move) {
  const Model before = sheet_on(cylinder(), 20, 16, 0.3);
  NodeSet movable;
  for (std::size_t n = 0; n < before.node_count(); n += 2) movable.emplace_back(n);
  const relax::ReferenceSurface surface(before, all_shells(before), 30);
  const relax::Relaxed relaxed = relax::relax({before, surface, criteria_of(), {}}, movable).value();
  EXPECT_FALSE(relaxed.nodes.empty());
  EXPECT_TRUE(std::is_sorted(relaxed.nodes.begin(), relaxed.nodes.end()));
  for (const NodeIndex node : relaxed.nodes) EXPECT_EQ(node.value % 2, 0u);
}

TEST(relax, from_a_node_goes_as_far_as_nodes_are_displaced) {
  Model before = sheet_on(cylinder(), 40, 40, 0);
  const NodeIndex pulled(std::size_t{20 * 41 + 20});
  before.positions.set(pulled.value, cylinder().at(20.45, 20.3));
  const relax::ReferenceSurface surface(before, all_shells(before), 30);
  const relax::Relaxed full = relax::relax({before, surface, criteria_of(), {}}, all_nodes(before)).value();
  const double threshold = 0.05 * kSize;
  const relax::Relaxed from = relax::relax_from({before, surface, criteria_of(), {}}, {pulled, threshold}, all_nodes(before)).value();
  EXPECT_GT(from.nodes.size(), 1u);
  EXPECT_LT(from.nodes.size(), 100u);
  const Model is = moved(before, from), would_be = moved(before, full);
  for (std::size_t n = 0; n < is.node_count(); ++n)
    EXPECT_LT((is.position(NodeIndex(n)) - would_be.position(NodeIndex(n))).norm(), 2 * threshold) << n;
  // with hardly a threshold it reaches beyond the block it begins with; it has ended once, and then
  std::vector<double> heard;
  const auto far = relax::relax_from({before, surface, criteria_of(), {}}, {pulled, 1e-4}, all_nodes(before), [&](double fraction) {
    heard.push_back(fraction);
    return true;
  });
  ASSERT_TRUE(far);
  EXPECT_GT(far->nodes.size(), 13u * 13u);
  EXPECT_TRUE(std::is_sorted(heard.begin(), heard.end()));
  EXPECT_EQ(std::count(heard.begin(), heard.end(), 1.0), 1);
}

TEST(relax, is_told_to_stop) {
  const Model before = sheet_on(cylinder(), 20, 16, 0.3);
  const relax::ReferenceSurface surface(before, all_shells(before), 30);
  double last = 0;
  int heard = 0;
  const auto whole = relax::relax({before, surface, criteria_of(), {}}, all_nodes(before), [&](double fraction) {
    EXPECT_GE(fraction, last);
    EXPECT_LE(fraction, 1);
    last = fraction;
    return ++heard > 0;
  });
  ASSERT_TRUE(whole);
  EXPECT_EQ(last, 1);
  for (int stop = 1; stop < heard; ++stop) {
    int calls = 0;
    const auto stopped =
        relax::relax({before, surface, criteria_of(), {}}, all_nodes(before), [&](double) { return ++calls != stop; });  // says it once
    ASSERT_FALSE(stopped);
    EXPECT_EQ(stopped.error().message, "cancelled");
  }
}

TEST(relax, asks_between_stretches_of_a_large_model) {
  const Model before = sheet_on(cylinder(), 60, 640, 0.3);
  const relax::ReferenceSurface surface(before, all_shells(before), 30);
  relax::Options options;
  options.max_rounds = 2;
  int while_preparing = 0, while_settling = 0;
  const auto heard = [&](double fraction) {
    ++(fraction < 0.25 ? while_preparing : while_settling);
    return true;
  };
  ASSERT_TRUE(relax::relax({before, surface, criteria_of(), options}, all_nodes(before), heard));
  EXPECT_GT(while_preparing, 20);        // 39,000 nodes are looked at, and given springs
  EXPECT_GT(while_settling, 2 * 4 + 5);  // four colours a round, and what is put back and judged at the end
}

TEST(relax, bears_bad_input) {
  Model before = sheet_on(cylinder(), 20, 16, 0.3);
  before.positions.set(45, Vec3::Constant(std::numeric_limits<double>::quiet_NaN()));
  before.positions.set(150, before.position(NodeIndex(std::size_t{151})));
  before.shell_nodes.set(
      200, {{NodeIndex(std::size_t{220}), NodeIndex(std::size_t{220}), NodeIndex(std::size_t{241}), NodeIndex(std::size_t{241})}});
  before.adjacency = std::make_shared<Adjacency>(build_adjacency(before));
  const relax::Relaxed relaxed = relax_all(before);
  EXPECT_FALSE(relaxed.nodes.empty());
  for (const Vec3& position : relaxed.positions) EXPECT_TRUE(position.allFinite());
  EXPECT_TRUE(relax_all(make_model({}, {})).nodes.empty());
}

}  // namespace

}  // namespace prismesh::test
