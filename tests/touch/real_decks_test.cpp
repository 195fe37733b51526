// The pen on real decks, as it runs on a station: modeld's field of the deck, the proxy of the pen's process, a hand at random. Each piece
// of the proxy's way is tested against the shells themselves by exact predicates, which neither side uses.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "drivers/haptics/proxy.h"
#include "mesh/contact/orientation.h"
#include "mesh/contact/triangle_crossing.h"
#include "mesh/field/haptic_field.h"
#include "mesh/model/adjacency.h"
#include "mesh/quality/target_size.h"
#include "mesh/spatial/box_tree.h"
#include "tests/support/real_deck.h"
#include "tests/support/seed.h"

namespace prismesh::test {
namespace {

using drivers::haptics::Proxy;
using drivers::haptics::ProxyContact;
using drivers::haptics::ProxyPath;
using mesh::Vec3;
using mesh::field::Placement;

constexpr double kEdgeMm = 10;  ///< the median edge of each deck, for the hand

/// PRISMESH_TOUCH_STEPS sets the steps of each deck; `./station soak` takes more.
long wanted_steps() {
  const char* const wanted = std::getenv("PRISMESH_TOUCH_STEPS");
  return wanted != nullptr ? std::atol(wanted) : 200'000;
}

/// A hand that goes to places about a node of the deck, through shells if they are in the way, and now and then to another node.
class HandOnDeck {
 public:
  HandOnDeck(const mesh::Model& model, const Placement& placement, unsigned seed) : model_(model), placement_(placement), random_(seed) {}

  /// False: the pen was lifted and came down elsewhere.
  bool move() {
    const bool lifts = steps_++ % 2000 == 0;
    if (lifts) {
      const mesh::ShellNodes& nodes = model_.shell(mesh::ShellIndex(below(model_.shell_count())));
      centre_ = placement_.to_pen(model_.position(nodes.node[0]));
      place_ = goal_ = centre_ + vector(6);
    }
    if (below(40) == 0) goal_ = centre_ + vector(8);
    if (below(300) == 0) speed_ = below(2) == 0 ? 1.4 : 0.2;
    const Vec3 way = goal_ - place_;
    if (way.norm() > 1e-9) place_ += way.normalized() * std::min(speed_, way.norm());
    trembling_ = place_ + vector(0.02);
    return !lifts;
  }
  const Vec3& place() const { return trembling_; }

 private:
  std::size_t below(std::size_t count) { return random_() % count; }
  Vec3 vector(double length) {
    std::uniform_real_distribution<double> within(-length, length);
    const double x = within(random_), y = within(random_);
    return {x, y, within(random_)};
  }

  const mesh::Model& model_;
  const Placement& placement_;
  std::mt19937 random_;
  Vec3 centre_ = Vec3::Zero(), place_ = Vec3::Zero(), goal_ = Vec3::Zero(), trembling_ = Vec3::Zero();
  double speed_ = 0.5;
  long steps_ = 0;
};

/// Whether a piece of a way passes through or touches a shell, exactly; in the pen's space, whose corners are rounded once.
class Shells {
 public:
  Shells(const mesh::spatial::BoxTree& tree, const Placement& placement) : tree_(tree), placement_(placement) {}
  bool are_passed(const Vec3& from_mm, const Vec3& to_mm) const {
    const Vec3 from = placement_.to_model(from_mm), to = placement_.to_model(to_mm);
    bool passed = false;
    tree_.near_box(from.cwiseMin(to), from.cwiseMax(to), 0.01 / placement_.scale, [&](mesh::ShellIndex shell, const auto&) {
      tree_.each_triangle(shell, [&](const Vec3& a, const Vec3& b, const Vec3& c, bool) {
        const mesh::contact::Triangle triangle{placement_.to_pen(a), placement_.to_pen(b), placement_.to_pen(c)};
        if (mesh::contact::on_a_line(triangle[0], triangle[1], triangle[2])) return;
        passed = passed || mesh::contact::passes_through(from_mm, to_mm, triangle);
      });
      return !passed;
    });
    return passed;
  }

 private:
  const mesh::spatial::BoxTree& tree_;
  const Placement& placement_;
};

/// Makes the field anew where modeld would: when the pen has moved on, here by more than 4 mm of the 10 mm that the fine brick has.
class FieldOfDeck {
 public:
  FieldOfDeck(const mesh::spatial::BoxTree& tree, const Placement& placement) : tree_(tree), placement_(placement) {}
  const HapticField* about(const Vec3& pen_mm) {
    if (number_ > 0 && (pen_mm - centre_).norm() < 4) return fields_[number_ % 2].get();
    const mesh::field::EarlierField earlier{number_ > 0 ? fields_[number_ % 2].get() : nullptr, {&tree_, 1}, {}};
    HapticField& field = *fields_[++number_ % 2];
    mesh::field::fill_field({&tree_, 1}, earlier, placement_, pen_mm, field);
    field.number = number_;
    field.placement = 1;
    field.time_ns = 1;
    centre_ = pen_mm;
    return &field;
  }
  std::uint64_t made() const { return number_; }

 private:
  const mesh::spatial::BoxTree& tree_;
  const Placement& placement_;
  std::array<std::unique_ptr<HapticField>, 2> fields_{std::make_unique<HapticField>(), std::make_unique<HapticField>()};
  std::uint64_t number_ = 0;
  Vec3 centre_ = Vec3::Zero();
};

struct TouchFigures {
  long touching = 0, behind = 0, let_go = 0, pieces = 0;
};

TouchFigures touch(const mesh::Model& model, long steps, unsigned seed) {
  const mesh::spatial::BoxTree tree(model);
  Placement placement;
  placement.scale = kEdgeMm / mesh::quality::guess_target_size(model);
  placement.turn = Eigen::AngleAxisd(0.7, Vec3(1, -2, 3).normalized()).toRotationMatrix();
  placement.shift_mm = -placement.scale * (placement.turn * model.position(model.shell(mesh::ShellIndex(std::size_t{0})).node[0]));
  const Shells shells(tree, placement);
  FieldOfDeck fields(tree, placement);
  HandOnDeck hand(model, placement, seed);
  Proxy proxy;
  ProxyPath path;
  TouchFigures figures;
  for (long i = 0; i < steps; ++i) {
    if (!hand.move()) proxy.let_go();
    const ProxyContact contact = proxy.step(fields.about(hand.place()), hand.place(), i % 1000 < 500 ? 0 : 0.3, &path);
    figures.touching += contact.touching;
    figures.let_go += contact.let_go;
    if (contact.touching && i % 16 == 0) figures.behind += shells.are_passed(contact.proxy_mm, hand.place());
    for (std::size_t s = 1; s < path.count; ++s) {
      if (path.places_mm[s] == path.places_mm[s - 1]) continue;
      ++figures.pieces;
      if (!shells.are_passed(path.places_mm[s - 1], path.places_mm[s])) continue;
      ADD_FAILURE() << "the proxy passes a shell at step " << i << ", from " << path.places_mm[s - 1].transpose() << " to "
                    << path.places_mm[s].transpose();
      return figures;
    }
  }
  return figures;
}

class RealDecks : public testing::TestWithParam<const char*> {};

TEST_P(RealDecks, the_proxy_passes_no_shell) {
  const auto decks = real_decks();
  if (!decks) GTEST_SKIP() << "PRISMESH_MODELS names no folder of real decks";
  mesh::Model model = open_real(*decks, GetParam());
  ASSERT_GT(model.shell_count(), 0u);
  if (!model.adjacency) model.adjacency = std::make_shared<const mesh::Adjacency>(mesh::build_adjacency(model));
  const long steps = wanted_steps();
  const TouchFigures figures = touch(model, steps, seed(20));
  std::printf(
      "%s: %zu shells, %ld steps: %ld touch, %ld of %ld looked at have a shell between pen and proxy, %ld let go; %ld pieces of way\n",
      GetParam(), model.shell_count(), steps, figures.touching, figures.behind, figures.touching / 16, figures.let_go, figures.pieces);
  EXPECT_GT(figures.touching, steps / 20);
  EXPECT_GT(figures.behind, steps / 16 / 40) << "the pen was often behind a shell";
}

INSTANTIATE_TEST_SUITE_P(Decks, RealDecks,
                         testing::Values("hatprofile", "pillars_open_airbag_v135", "wing_ferig", "bumper_beam_rad", "crm_tailbox"),
                         [](const auto& deck) { return std::string(deck.param); });

}  // namespace
}  // namespace prismesh::test
