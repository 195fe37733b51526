// The device page: what was written is read, only its writer can change it, and a writer's death leaves the last whole value.
#include <array>
#include <csignal>
#include <cstring>
#include <random>
#include <vector>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include "ipc/device/page.h"

namespace prismesh::ipc {
namespace {

TEST(DevicePage, shows_what_was_written) {
  DevicePage page = DevicePage::create().value();
  const DevicePageReader reader = DevicePageReader::map(page.descriptor()).value();
  EXPECT_FALSE(reader.eyes());
  EXPECT_FALSE(reader.prism());
  EXPECT_FALSE(reader.health());

  EyesState eyes;
  eyes.measured_ns = 17;
  eyes.between_eyes_mm = {1, 2, 650};
  eyes.velocity_mm_s = {-3, 0, 4};
  eyes.toward_right = {0.6, 0.8, 0};
  eyes.phase = EyesPhase::tracking;
  eyes.times_lost = 3;
  page.set_eyes(eyes);
  PrismState prism;
  prism.position_mm = 0.25;
  prism.phase = drivers::prism_servo::MaskPhase::following;
  page.set_prism(prism);
  DeviceHealth health;
  health.ticks = 9;
  health.realtime = true;
  page.set_health(health);

  ASSERT_TRUE(reader.eyes());
  EXPECT_EQ(reader.eyes()->phase, EyesPhase::tracking);
  EXPECT_EQ(reader.eyes()->times_lost, 3u);
  const drivers::eye_tracker::HeadState head = reader.eyes()->head();
  EXPECT_EQ(head.time_ns, 17);
  EXPECT_EQ(head.between_eyes_mm, Eigen::Vector3d(1, 2, 650));
  EXPECT_EQ(head.velocity_mm_s, Eigen::Vector3d(-3, 0, 4));
  EXPECT_EQ(head.toward_right, Eigen::Vector3d(0.6, 0.8, 0));
  EXPECT_EQ(reader.prism()->position_mm, 0.25);
  EXPECT_EQ(reader.prism()->phase, drivers::prism_servo::MaskPhase::following);
  EXPECT_EQ(reader.health()->ticks, 9u);
  EXPECT_TRUE(reader.health()->realtime);
}

TEST(DevicePage, no_peer_can_shrink_grow_write_or_unseal_it) {
  DevicePage page = DevicePage::create().value();
  const Descriptor peer = page.descriptor().duplicate().value();
  EXPECT_NE(::ftruncate(peer.get(), 0), 0);
  EXPECT_NE(::ftruncate(peer.get(), 1 << 20), 0);
  EXPECT_FALSE(Mapping::map(peer, true));
  const char byte = 1;
  EXPECT_NE(::pwrite(peer.get(), &byte, 1, 0), 1);
  EXPECT_NE(::fcntl(peer.get(), F_ADD_SEALS, F_SEAL_WRITE), 0) << "a peer could stop the daemon's own writing";
  EyesState eyes;
  eyes.records = 5;
  page.set_eyes(eyes);
  EXPECT_EQ(DevicePageReader::map(peer).value().eyes()->records, 5u);
}

/// Memory that holds a good page, with these seals.
Descriptor imitation(int seals, std::size_t size = sizeof(DevicePageLayout), std::uint64_t version = DevicePageLayout::kVersion,
                     std::uint64_t magic = DevicePageLayout::kMagic) {
  Descriptor memory(::memfd_create("imitation", MFD_CLOEXEC | MFD_ALLOW_SEALING));
  std::vector<std::byte> bytes(size);
  if (size >= 2 * sizeof(std::uint64_t)) {
    const std::array<std::uint64_t, 2> head{magic, version};
    std::memcpy(bytes.data(), head.data(), sizeof head);
  }
  EXPECT_EQ(::write(memory.get(), bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
  EXPECT_EQ(::fcntl(memory.get(), F_ADD_SEALS, seals), 0);
  return memory;
}

TEST(DevicePage, a_reader_refuses_a_page_that_could_be_cut_off_or_forged) {
  constexpr int kAll = F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_FUTURE_WRITE;
  EXPECT_TRUE(DevicePageReader::map(imitation(kAll)));
  for (const int missing : {F_SEAL_SHRINK, F_SEAL_GROW, F_SEAL_FUTURE_WRITE}) {
    const Result<DevicePageReader> reader = DevicePageReader::map(imitation(kAll & ~missing));
    ASSERT_FALSE(reader) << missing;
    EXPECT_NE(reader.error().message.find("missing"), std::string::npos);
  }
  EXPECT_FALSE(DevicePageReader::map(imitation(kAll, sizeof(DevicePageLayout) - 1)));
  EXPECT_FALSE(DevicePageReader::map(imitation(kAll, sizeof(DevicePageLayout), DevicePageLayout::kVersion + 1)));
  EXPECT_FALSE(DevicePageReader::map(imitation(kAll, sizeof(DevicePageLayout), DevicePageLayout::kVersion, DevicePageLayout::kMagic + 1)));
  EXPECT_TRUE(DevicePageReader::map(imitation(F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_WRITE))) << "nobody can write it at all";
  EXPECT_FALSE(DevicePageReader::map(imitation(F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_SEAL)))
      << "that it gets no more seals is no protection";
  Descriptor pipe_ends[2];
  int ends[2] = {-1, -1};
  ASSERT_EQ(::pipe(ends), 0);
  pipe_ends[0] = Descriptor(ends[0]);
  pipe_ends[1] = Descriptor(ends[1]);
  EXPECT_FALSE(DevicePageReader::map(pipe_ends[0]));
}

TEST(DevicePage, a_writer_that_is_killed_leaves_the_last_whole_value) {
  std::mt19937 random(7);
  for (int life = 0; life < 40; ++life) {
    DevicePage page = DevicePage::create().value();
    const DevicePageReader reader = DevicePageReader::map(page.descriptor()).value();
    EyesState first;
    first.records = 1;
    page.set_eyes(first);
    const pid_t writer = ::fork();
    if (writer == 0) {
      for (std::uint64_t value = 2;; ++value) {
        EyesState eyes;
        eyes.time_ns = eyes.measured_ns = static_cast<std::int64_t>(value);
        eyes.between_eyes_mm.fill(static_cast<double>(value));
        eyes.records = eyes.bytes_skipped = eyes.resyncs = eyes.times_lost = value;
        page.set_eyes(eyes);
      }
    }
    ::usleep(static_cast<useconds_t>(500 + random() % 2000));
    ::kill(writer, SIGKILL);
    ::waitpid(writer, nullptr, 0);
    const std::optional<EyesState> left = reader.eyes();
    ASSERT_TRUE(left) << "life " << life;
    if (left->records == 1) continue;
    ASSERT_EQ(left->time_ns, static_cast<std::int64_t>(left->records));
    ASSERT_EQ(left->between_eyes_mm[2], static_cast<double>(left->records));
    ASSERT_EQ(left->times_lost, left->records);
  }
}

}  // namespace
}  // namespace prismesh::ipc
