#include <csignal>
#include <new>
#include <random>
#include <thread>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "ipc/model/preview.h"
#include "ipc/model/state_page.h"
#include "ipc/wire/seqlock.h"

namespace prismesh::ipc {
namespace {

/// Whole only if all words are equal.
struct Sample {
  std::array<std::uint64_t, 40> words{};
};
Sample sample_of(std::uint64_t value) {
  Sample sample;
  sample.words.fill(value);
  return sample;
}
bool is_whole(const Sample& sample) {
  for (const std::uint64_t word : sample.words)
    if (word != sample.words[0]) return false;
  return true;
}

TEST(Seqlock, nothing_until_the_first_write) {
  SeqlockSlot<Sample> slot;
  EXPECT_FALSE(slot.read());
  slot.write(sample_of(3));
  std::uint64_t count = 0;
  ASSERT_TRUE(slot.read(&count));
  EXPECT_EQ(count, 1u);
  EXPECT_EQ(slot.read()->words[39], 3u);
}

TEST(Seqlock, readers_never_see_half_a_value) {
  SeqlockSlot<Sample> slot;
  std::atomic<bool> done = false;
  std::atomic<std::size_t> seen = 0;
  std::uint64_t written = 0;
  std::thread writer([&] {
    // On a busy machine the reader may have its first turn late.
    while (written < 200'000 || seen == 0) slot.write(sample_of(++written));
    done = true;
  });
  std::uint64_t last = 0;
  while (!done) {
    const std::optional<Sample> sample = slot.read();
    if (!sample) continue;
    ASSERT_TRUE(is_whole(*sample));
    ASSERT_GE(sample->words[0], last);
    last = sample->words[0];
    ++seen;
  }
  writer.join();
  EXPECT_EQ(slot.read()->words[0], written);
}

TEST(Seqlock, survives_a_writer_that_is_killed) {
  const Descriptor memory = make_shared_memory("test", sizeof(SeqlockSlot<Sample>)).value();
  Mapping mapping = Mapping::map(memory, true).value();
  auto* slot = new (mapping.writable_bytes().data()) SeqlockSlot<Sample>();
  std::mt19937 random(1);
  for (int life = 0; life < 30; ++life) {
    const std::uint64_t before = slot->read() ? slot->read()->words[0] : 0;
    const pid_t writer = ::fork();
    if (writer == 0)
      for (std::uint64_t value = before + 1;; ++value) slot->write(sample_of(value));
    ::usleep(static_cast<useconds_t>(500 + random() % 2000));
    ::kill(writer, SIGKILL);
    ::waitpid(writer, nullptr, 0);
    const std::optional<Sample> left = slot->read();
    if (!left) continue;  // killed before its first write
    ASSERT_TRUE(is_whole(*left)) << "life " << life;
    ASSERT_GE(left->words[0], before);
  }
  slot->write(sample_of(1'000'000'000));
  EXPECT_EQ(slot->read()->words[0], 1'000'000'000u) << "the next writer goes on";
}

TEST(StatePage, shows_health_and_refuses_writers) {
  StatePage page = StatePage::create().value();
  const StatePageReader reader = StatePageReader::map(page.descriptor()).value();
  EXPECT_FALSE(reader.health());
  Health health;
  health.generation = 42;
  health.busy = true;
  page.set_health(health);
  ASSERT_TRUE(reader.health());
  EXPECT_EQ(reader.health()->generation, 42u);
  EXPECT_TRUE(reader.health()->busy);
  EXPECT_FALSE(Mapping::map(page.descriptor(), true)) << "a reader could write";
}

TEST(StatePage, other_memory_is_no_state_page) {
  EXPECT_FALSE(StatePageReader::map(make_shared_memory("test", 64).value()));
  EXPECT_FALSE(StatePageReader::map(make_shared_memory("test", 4096).value()));
}

TEST(Preview, carries_frames_whole) {
  std::vector<mesh::NodeIndex> nodes;
  std::vector<mesh::ShellIndex> shells;
  for (std::size_t i = 0; i < 1000; ++i) nodes.emplace_back(2 * i);
  for (std::size_t i = 0; i < 777; ++i) shells.emplace_back(i);
  PreviewWriter writer = PreviewWriter::create(5, 17, nodes, shells).value();
  const PreviewReader reader = PreviewReader::map(writer.descriptor()).value();
  EXPECT_EQ(reader.drag(), 5u);
  EXPECT_EQ(reader.base_generation(), 17u);
  EXPECT_EQ(reader.nodes()[999].value, 1998u);
  EXPECT_EQ(reader.shells().size(), 777u);
  PreviewFrame frame;
  EXPECT_FALSE(reader.latest(frame));

  std::thread publisher([&] {
    for (std::uint64_t sequence = 1; sequence <= 2000; ++sequence) {
      const std::vector<mesh::Vec3> positions(nodes.size(), mesh::Vec3::Constant(static_cast<double>(sequence)));
      const std::vector<mesh::quality::ShellState> states(shells.size(), {static_cast<std::uint16_t>(sequence), 0});
      writer.publish(sequence, positions, states, {sequence, 0, 0});
    }
  });
  while (frame.sequence < 2000) {
    if (!reader.latest(frame)) continue;
    const auto value = static_cast<double>(frame.sequence);
    ASSERT_EQ(frame.positions.front().x(), value);
    ASSERT_EQ(frame.positions.back().z(), value);
    ASSERT_EQ(frame.states.back().warn, static_cast<std::uint16_t>(frame.sequence));
    ASSERT_EQ(frame.counts.ok, frame.sequence);
  }
  publisher.join();
  EXPECT_FALSE(reader.latest(frame)) << "there is nothing newer";
  EXPECT_FALSE(Mapping::map(writer.descriptor(), true)) << "a reader could write";
}

TEST(Preview, carries_every_number_of_a_frame) {
  for (const std::size_t judged : {0u, 1u, 2u, 3u}) {  // states are half words
    const std::vector<mesh::NodeIndex> nodes{mesh::NodeIndex(7), mesh::NodeIndex(3)};
    std::vector<mesh::ShellIndex> shells;
    std::vector<mesh::quality::ShellState> states;
    for (std::size_t i = 0; i < judged; ++i) {
      shells.emplace_back(40 + i);
      states.push_back({static_cast<std::uint16_t>(10 + i), static_cast<std::uint16_t>(20 + i)});
    }
    PreviewWriter writer = PreviewWriter::create(5, 17, nodes, shells).value();
    writer.publish(1, std::vector<mesh::Vec3>{{1, 2, 3}, {4, 5, 6}}, states, {7, 8, 9});
    const PreviewReader reader = PreviewReader::map(writer.descriptor()).value();
    PreviewFrame frame;
    ASSERT_TRUE(reader.latest(frame));
    EXPECT_TRUE(std::equal(nodes.begin(), nodes.end(), reader.nodes().begin(), reader.nodes().end()));
    EXPECT_TRUE(std::equal(shells.begin(), shells.end(), reader.shells().begin(), reader.shells().end()));
    EXPECT_EQ(frame.sequence, 1u);
    EXPECT_EQ(frame.positions.at(0), mesh::Vec3(1, 2, 3));
    EXPECT_EQ(frame.positions.at(1), mesh::Vec3(4, 5, 6));
    EXPECT_EQ(frame.states, states);
    EXPECT_EQ(frame.counts, (mesh::quality::Counts{7, 8, 9}));
  }
}

TEST(Preview, carries_what_touches) {
  const std::vector<mesh::NodeIndex> nodes(1);
  const std::vector<mesh::ShellIndex> shells(130);
  PreviewWriter writer = PreviewWriter::create(5, 17, nodes, shells).value();
  const PreviewReader reader = PreviewReader::map(writer.descriptor()).value();
  const std::vector<mesh::Vec3> at(1, mesh::Vec3::Zero());
  const std::vector<mesh::quality::ShellState> states(130, {3, 4});
  PreviewTouches touches;
  touches.moved = {1, 0, 2};
  touches.others = {mesh::ShellIndex(7u), mesh::ShellIndex(9u), mesh::ShellIndex(400u)};
  touches.parts = 2;
  touches.part_a = mesh::PartIndex(5u);
  touches.part_b = mesh::PartIndex();
  touches.depth = 0.8;
  writer.publish(1, at, states, {}, touches);
  PreviewFrame frame;
  ASSERT_TRUE(reader.latest(frame));
  for (std::size_t s = 0; s < 130; ++s) EXPECT_EQ(frame.touches.touches(s), s == 0 || s == 129) << s;
  EXPECT_EQ(frame.touches.others, touches.others);
  EXPECT_EQ(frame.touches.parts, 2u);
  EXPECT_EQ(frame.touches.part_a, touches.part_a);
  EXPECT_EQ(frame.touches.part_b, touches.part_b);
  EXPECT_FALSE(frame.touches.cross);
  EXPECT_EQ(frame.touches.depth, 0.8);
  EXPECT_TRUE(frame.touches.watched);
  EXPECT_EQ(frame.states.back(), states.back());

  touches = {};
  touches.watched = false;
  touches.cross = true;
  touches.moved.assign(99, ~std::uint64_t{0});  // longer than there are shells
  touches.others.assign(kMaxTouchedOthers + 1, mesh::ShellIndex(3u));
  writer.publish(2, at, states, {}, touches);
  ASSERT_TRUE(reader.latest(frame));
  EXPECT_FALSE(frame.touches.watched);
  EXPECT_TRUE(frame.touches.cross);
  EXPECT_EQ(frame.touches.others.size(), kMaxTouchedOthers);
  EXPECT_EQ(frame.touches.moved.size(), 3u);
  EXPECT_EQ(frame.states.back(), states.back());
  writer.publish(3, at, states, {});
  ASSERT_TRUE(reader.latest(frame));
  EXPECT_EQ(frame.touches.parts, 0u);
  for (std::size_t s = 0; s < 130; ++s) EXPECT_FALSE(frame.touches.touches(s)) << "of the frame before";
  EXPECT_TRUE(frame.touches.others.empty());
}

TEST(Preview, lists_of_another_length_stay_in_their_places) {
  const std::vector<mesh::NodeIndex> nodes(3);
  const std::vector<mesh::ShellIndex> shells(3);
  PreviewWriter writer = PreviewWriter::create(5, 17, nodes, shells).value();
  const PreviewReader reader = PreviewReader::map(writer.descriptor()).value();
  const auto places = [](std::size_t count, double x) { return std::vector<mesh::Vec3>(count, mesh::Vec3(x, 0, 0)); };
  const auto states = [](std::size_t count, std::uint16_t warn) { return std::vector<mesh::quality::ShellState>(count, {warn, 0}); };
  PreviewFrame frame;
  writer.publish(1, places(3, 1), states(3, 1), {});
  // Of longer arrays, so that what lies behind a list would be seen.
  const std::vector<mesh::Vec3> twos = places(3, 2);
  const std::vector<mesh::quality::ShellState> worse = states(3, 2);
  writer.publish(2, std::span(twos).first(1), std::span(worse).first(1), {});
  ASSERT_TRUE(reader.latest(frame));
  EXPECT_EQ(frame.positions, (std::vector<mesh::Vec3>{{2, 0, 0}, {1, 0, 0}, {1, 0, 0}}));
  EXPECT_EQ(frame.states[0].warn, 2);
  EXPECT_EQ(frame.states[1].warn, 1);
  EXPECT_EQ(frame.states[2].warn, 1);
  writer.publish(3, places(4, 3), {}, {});
  ASSERT_TRUE(reader.latest(frame));
  EXPECT_EQ(frame.positions, places(3, 3));
  EXPECT_EQ(frame.states[0].warn, 2);
  EXPECT_EQ(frame.states[1].warn, 1);
  writer.publish(4, places(4, 3), states(4, 3), {});
  ASSERT_TRUE(reader.latest(frame));
  EXPECT_EQ(frame.positions, places(3, 3));
  EXPECT_EQ(frame.states.size(), 3u);
  EXPECT_EQ(frame.states[2].warn, 3);
  EXPECT_FALSE(reader.latest(frame)) << "seen already";
}

TEST(Preview, a_header_that_promises_too_much_is_refused) {
  PreviewWriter writer = PreviewWriter::create(1, 1, std::vector<mesh::NodeIndex>(10), {}).value();
  const Mapping sound = Mapping::map(writer.descriptor(), false).value();
  for (std::size_t at = 0; at < 40; at += 8) {
    std::vector<std::byte> bytes(sound.bytes().begin(), sound.bytes().end());
    bytes[at + 5] = std::byte{0x7f};
    const Result<PreviewReader> reader = PreviewReader::map(make_sealed_memory("test", bytes).value());
    // Drag and generation are only numbers; the magic and the counts aren't.
    EXPECT_EQ(reader.has_value(), at == 8 || at == 16) << at;
  }
}

}  // namespace
}  // namespace prismesh::ipc
