// A tick of servo and mask allocates nothing in any state: this program counts its calls of operator new.
#include <atomic>
#include <cstdlib>
#include <new>

#include <gtest/gtest.h>

#include "tests/drivers/prism_servo/mask_rig.h"

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

namespace prismesh::drivers::prism_servo {
namespace {

TEST(prism_ticks, allocate_nothing_in_any_state) {
  MaskRigSettings settings;
  settings.limits.travel_mm = settings.servo.driver.travel_mm = 0.5;
  MaskRig rig(settings);
  rig.head = [](double seconds) { return Eigen::Vector3d(200 * std::sin(seconds), 0, 650); };
  unsigned phases = 0;
  const auto run = [&](int ms) {
    for (int i = 0; i < ms / 5; ++i) {
      rig.tick();
      phases |= 1U << static_cast<unsigned>(rig.state().phase);
    }
  };
  const std::size_t one_more = allocations;
  auto* volatile proof = new int(1);
  EXPECT_EQ(allocations, one_more + 1) << "the counter counts";
  delete proof;

  const std::size_t before = allocations;
  run(10'000);
  rig.eyes = false;
  run(2'000);
  rig.eyes = true;
  rig.hold_mm = 0.1;
  run(1'000);
  rig.hold_mm.reset();
  rig.mask().raise_hardware_error(4);
  run(500);
  rig.rearm = true;
  run(4'000);
  rig.mask().jam(true);
  run(4'000);
  rig.mask().jam(false);
  rig.rearm = true;
  run(2'000);
  EXPECT_EQ(allocations, before);
  EXPECT_EQ(phases, 0x3FFU) << "every phase was there";
}

}  // namespace
}  // namespace prismesh::drivers::prism_servo
