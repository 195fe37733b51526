#include "drivers/port/memory_line.h"

#include <numeric>

#include <gtest/gtest.h>

#include "tests/drivers/port/allocations.h"
#include "tests/drivers/port/bytes.h"

namespace prismesh::drivers::port {
namespace {

constexpr std::int64_t kByteNs = 1'000'000;  // at 10,000 baud

MemoryLineSettings easy_line() {
  MemoryLineSettings settings;
  settings.host_baud = settings.device_baud = 10'000;
  return settings;
}

TEST(MemoryLine, a_byte_arrives_after_its_last_bit) {
  ManualClock clock;
  MemoryLine line(clock, easy_line());
  const auto host = *line.open_host();
  EXPECT_EQ(line.device().write(bytes_of("abc")).bytes, 3u);
  EXPECT_EQ(line.next_arrival_ns(Direction::to_host), kByteNs);
  clock.advance_ns(kByteNs - 1);
  EXPECT_EQ(read_text(*host), "");
  clock.advance_ns(1);
  EXPECT_EQ(read_text(*host), "a");
  clock.advance_ns(2 * kByteNs);
  EXPECT_EQ(read_text(*host), "bc");
  EXPECT_FALSE(line.next_arrival_ns(Direction::to_host));
}

TEST(MemoryLine, latency_shifts_bytes_and_keeps_their_rate) {
  ManualClock clock;
  MemoryLineSettings settings = easy_line();
  settings.latency_ns = 16'000'000;
  MemoryLine line(clock, settings);
  const auto host = *line.open_host();
  line.device().write(bytes_of("ab"));
  clock.advance_ns(17'000'000 - 1);
  EXPECT_EQ(read_text(*host), "");
  clock.advance_ns(1);
  EXPECT_EQ(read_text(*host), "a");
  clock.advance_ns(kByteNs);
  EXPECT_EQ(read_text(*host), "b");
}

TEST(MemoryLine, both_directions_run_at_once) {
  ManualClock clock;
  MemoryLine line(clock, easy_line());
  const auto host = *line.open_host();
  host->write(bytes_of("ping"));
  line.device().write(bytes_of("pong"));
  clock.advance_ns(4 * kByteNs);
  EXPECT_EQ(read_text(*host), "pong");
  EXPECT_EQ(read_text(line.device()), "ping");
}

TEST(MemoryLine, a_writer_ahead_of_the_line_gets_full) {
  ManualClock clock;
  MemoryLineSettings settings = easy_line();
  settings.queue_bytes = 4;
  MemoryLine line(clock, settings);
  const auto host = *line.open_host();
  const PortCount put = host->write(bytes_of("abcdef"));
  EXPECT_EQ(put.bytes, 4u);
  EXPECT_EQ(put.status, PortStatus::full);
  clock.advance_ns(2 * kByteNs);
  EXPECT_EQ(host->write(bytes_of("ef")).status, PortStatus::ok);
  clock.advance_ns(4 * kByteNs);
  EXPECT_EQ(read_text(line.device()), "abcdef");
}

TEST(MemoryLine, a_full_input_buffer_loses_and_counts_the_newest_bytes) {
  ManualClock clock;
  MemoryLineSettings settings = easy_line();
  settings.input_bytes = 3;
  MemoryLine line(clock, settings);
  const auto host = *line.open_host();
  line.device().write(bytes_of("abcde"));
  clock.advance_ns(5 * kByteNs);
  EXPECT_EQ(read_text(*host), "abc");
  EXPECT_EQ(line.overrun(Direction::to_host), 2u);
}

TEST(MemoryLine, different_baud_rates_scramble_bytes) {
  ManualClock clock;
  MemoryLineSettings settings = easy_line();
  settings.device_baud = 57'600;
  MemoryLine line(clock, settings);
  const auto host = *line.open_host();
  host->write(bytes_of("hello"));
  clock.advance_ns(5 * kByteNs);
  EXPECT_NE(read_text(line.device()), "hello");
  EXPECT_TRUE(host->set_baud(57'600));
  EXPECT_FALSE(host->set_baud(0));
  host->write(bytes_of("hello"));
  clock.advance_ns(5 * kByteNs);
  EXPECT_EQ(read_text(line.device()), "hello");
}

TEST(MemoryLine, opening_discards_input_and_ends_the_previous_port) {
  ManualClock clock;
  MemoryLine line(clock, easy_line());
  const auto first = *line.open_host();
  line.device().write(bytes_of("stale"));
  clock.advance_ns(5 * kByteNs);
  const auto second = *line.open_host();
  EXPECT_EQ(first->read({}).status, PortStatus::gone);
  EXPECT_EQ(read_text(*second), "");
}

TEST(MemoryLine, an_unplug_ends_the_port_for_good) {
  ManualClock clock;
  MemoryLine line(clock, easy_line());
  const auto before = *line.open_host();
  line.device().write(bytes_of("ab"));
  clock.advance_ns(kByteNs);
  line.unplug();
  EXPECT_FALSE(line.open_host());
  EXPECT_EQ(line.device().write(bytes_of("nobody hears")).status, PortStatus::ok);
  line.plug_in();
  EXPECT_EQ(before->write(bytes_of("x")).status, PortStatus::gone);
  EXPECT_FALSE(before->set_baud(9600));
  EXPECT_NE(before->last_error(), 0);
  const auto after = *line.open_host();
  clock.advance_ns(20 * kByteNs);
  EXPECT_EQ(read_text(*after), "");
  line.device().write(bytes_of("c"));
  clock.advance_ns(kByteNs);
  EXPECT_EQ(read_text(*after), "c");
}

TEST(MemoryLine, unplugs_at_any_byte_that_the_host_reads) {
  for (std::size_t count = 0; count <= 8; ++count) {
    ManualClock clock;
    MemoryLine line(clock, easy_line());
    const auto host = *line.open_host();
    line.unplug_after(Direction::to_host, count);
    line.device().write(bytes_of("12345678"));
    clock.advance_ns(8 * kByteNs);
    std::string got;
    PortCount last;
    do {
      std::array<std::byte, 3> buffer{};
      last = host->read(buffer);
      for (std::size_t i = 0; i < last.bytes; ++i) got += static_cast<char>(buffer[i]);
    } while (last.status == PortStatus::ok && last.bytes > 0);
    EXPECT_EQ(got, std::string("12345678").substr(0, count));
    EXPECT_EQ(host->read({}).status, PortStatus::gone);
    EXPECT_FALSE(line.plugged_in());
  }
}

TEST(MemoryLine, unplugs_at_any_byte_that_the_host_writes) {
  for (std::size_t count = 0; count <= 8; ++count) {
    ManualClock clock;
    MemoryLine line(clock, easy_line());
    const auto host = *line.open_host();
    line.unplug_after(Direction::to_device, count);
    const PortCount put = host->write(bytes_of("12345678"));
    EXPECT_EQ(put.bytes, count);
    EXPECT_EQ(put.status, count < 8 ? PortStatus::gone : PortStatus::ok);
    EXPECT_EQ(host->write(bytes_of("x")).status, PortStatus::gone);
    clock.advance_ns(8 * kByteNs);
    EXPECT_EQ(read_text(line.device()), std::string("12345678").substr(0, count)) << "half a message still reaches the device";
  }
}

TEST(MemoryLine, injected_noise_follows_the_bytes_in_transit) {
  ManualClock clock;
  MemoryLine line(clock, easy_line());
  const auto host = *line.open_host();
  line.device().write(bytes_of("ab"));
  line.inject(Direction::to_host, bytes_of("??"));
  line.device().write(bytes_of("cd"));
  clock.advance_ns(6 * kByteNs);
  EXPECT_EQ(read_text(*host), "ab??cd");
}

TEST(MemoryLine, noise_has_its_rate_and_repeats_with_its_seed) {
  const auto received = [](std::uint64_t seed) {
    ManualClock clock;
    MemoryLine line(clock, easy_line());
    line.set_noise(0.1, 0.05, seed);
    const auto host = *line.open_host();
    std::string text;
    for (int i = 0; i < 10; ++i) {
      line.device().write(bytes_of(std::string(1000, 'U')));
      clock.advance_ns(1000 * kByteNs);
      text += read_text(*host);
    }
    return text;
  };
  const std::string text = received(7);
  EXPECT_NEAR(static_cast<double>(text.size()), 9500, 100);
  EXPECT_NEAR(static_cast<double>(std::count(text.begin(), text.end(), 'U')), 8550, 150);
  EXPECT_EQ(text, received(7));
  EXPECT_NE(text, received(8));
}

TEST(MemoryLine, reading_and_writing_allocate_nothing) {
  ManualClock clock;
  MemoryLine line(clock, easy_line());
  const auto host = *line.open_host();
  std::array<std::byte, 64> buffer{};
  const std::uint64_t before = allocations_of_this_thread();
  for (int i = 0; i < 1000; ++i) {
    host->write(buffer);
    line.device().write(buffer);
    line.inject(Direction::to_host, std::span(buffer).first(1));
    clock.advance_ns(30 * kByteNs);
    host->read(buffer);
    line.device().read(buffer);
  }
  EXPECT_EQ(allocations_of_this_thread(), before);
}

}  // namespace
}  // namespace prismesh::drivers::port
