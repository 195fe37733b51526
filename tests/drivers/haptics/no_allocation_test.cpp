// A tick of the haptic loop allocates nothing in any state: this program counts its calls of operator new.
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <new>

#include <gtest/gtest.h>

#include "tests/drivers/haptics/haptic_rig.h"

namespace {
std::atomic<std::size_t> allocations = 0;

void* counted(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size == 0 ? 1 : size)) return memory;
  throw std::bad_alloc();
}
}  // namespace

void* operator new(std::size_t size) { return counted(size); }
void* operator new[](std::size_t size) { return counted(size); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }

namespace prismesh::drivers::haptics {
namespace {

TEST(haptic_ticks, allocate_nothing_in_any_state) {
  HapticLoop loop({}, {.max_newton = 8,
                       .max_axis_newton = Eigen::Vector3d::Constant(8),
                       .max_stiffness_newton_m = 0,
                       .damping_newton_s_m = 1,
                       .friction_newton = 0.1,
                       .quantum_mm = 0.01,
                       .delay_ns = 1'000'000,
                       .workspace_min_mm = Eigen::Vector3d::Zero(),
                       .workspace_max_mm = Eigen::Vector3d::Zero()});
  const auto still = test::make_field([](const Eigen::Vector3d& at) { return std::abs(at.z()); }, {.fine_count = 40, .coarse_count = 30});
  const auto moved = std::make_unique<HapticField>(*still);
  moved->number = 2;
  moved->mesh_generation = 2;
  moved->before_generation = 1;
  test::Triangles before = test::plane_shape(), now = before;
  for (test::Triangle& triangle : before)
    for (Eigen::Vector3d& corner : triangle) corner.z() -= 2;
  test::enter_moved(*moved, before, now);
  HapticGuides guides{};
  guides.count = 3;
  const HapticResistance resistance{.placement = 0, .time_ns = 1, .newton = 1, .direction = {0, 0, -1}};
  const std::size_t one_more = allocations;
  auto* volatile proof = new int(1);
  EXPECT_EQ(allocations, one_more + 1) << "the counter counts";
  delete proof;

  const std::size_t counted_before = allocations;
  unsigned phases = 0, states = 0;
  HapticTick tick;
  tick.now_ns = 1'000'000'000;
  tick.pen.phase = haptic_pen::PenPhase::ready;
  tick.sources.guides = &guides;
  tick.sources.resistance = &resistance;
  for (int i = 0; i < 20'000; ++i) {
    tick.now_ns += i % 700 == 699 ? 5'000'000 : i % 4000 == 3999 ? 30'000'000 : 1'000'000;
    tick.pen.fresh = i % 50 != 0;
    tick.pen.pose.measured_ns = tick.now_ns;
    tick.pen.pose.position_mm = {2 * std::sin(i * 0.003), std::cos(i * 0.002), 3 * std::cos(i * 0.005)};
    if (i % 5000 == 2500) tick.pen.pose.position_mm.x() = NAN;
    tick.pen.lost_replies = i % 6000 == 3000;
    tick.rearm = i % 100 == 0;
    tick.sources.field = i % 3000 < 100 ? nullptr : i % 900 < 450 ? still.get() : moved.get();
    const HapticAnswer answer = loop.step(tick);
    phases |= 1U << static_cast<unsigned>(answer.safety.record.phase);
    states |= (answer.contact.touching ? 1U : 0U) | (answer.contact.let_go ? 2U : 0U) | (answer.safety.damping_only ? 4U : 0U) |
              (answer.contact.attached ? 8U : 0U);
  }
  EXPECT_EQ(allocations, counted_before);
  EXPECT_EQ(phases, 7U) << "every phase was there";
  EXPECT_EQ(states, 15U);
}

}  // namespace
}  // namespace prismesh::drivers::haptics
