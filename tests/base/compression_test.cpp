// Compressed files: reads what gzip and zstd write, and writes what they read. Uses the programs themselves where they are installed.
#include "base/compression.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <iostream>

#include <gtest/gtest.h>

namespace prismesh {
namespace {

namespace fs = std::filesystem;

class Packed : public ::testing::Test {
 protected:
  Packed() {
    std::string name = (fs::temp_directory_path() / "prismesh-packed-XXXXXX").string();
    folder_ = ::mkdtemp(name.data());
  }
  ~Packed() override { fs::remove_all(folder_); }

  fs::path write(const std::string& name, std::string_view text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }
  static std::string content(const fs::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  bool shell(const std::string& command) const {
    return std::system(("cd " + folder_.string() + " && " + command + " 2>/dev/null").c_str()) == 0;
  }
  static Result<FileBytes> read(const fs::path& path, const Progress& progress = {}) {
    Result<FileBytes> file = read_file(path);
    return file ? unpack(std::move(*file), path, progress) : std::move(file);
  }
  static std::string packed_as(const std::string& text, const std::string& like) {
    const std::string_view halves[] = {std::string_view(text).substr(0, text.size() / 2), std::string_view(text).substr(text.size() / 2)};
    return pack(halves, std::as_bytes(std::span(like))).value();
  }
  static std::string error_of(const fs::path& path) {
    const Result<FileBytes> file = read(path);
    return file ? "no error" : file.error().file == path.string() ? file.error().message : "another file's: " + file.error().text();
  }

  fs::path folder_;
};

/// A gzip file of "hello\n" that was called "hi", and a zstd file of the same with a checksum.
const std::string kGzip("\x1f\x8b\x08\x08\x00\x00\x00\x00\x00\x03hi\x00\xcb\x48\xcd\xc9\xc9\xe7\x02\x00\x20\x30\x3a\x36\x06\x00\x00\x00",
                        29);
const std::string kZstd("\x28\xb5\x2f\xfd\x24\x06\x31\x00\x00hello\n\x53\x88\xbd\x91", 19);

std::string long_text() {
  std::string text;
  for (int i = 0; text.size() < 1'200'000; ++i) text += std::to_string(i * 7919 % 1000003) + ", " + std::to_string(i) + ".5\n";
  return text;
}

TEST_F(Packed, knows_packings_by_their_bytes) {
  EXPECT_EQ(packing_of(std::as_bytes(std::span(kGzip))), Packing::gzip);
  EXPECT_EQ(packing_of(std::as_bytes(std::span(kZstd))), Packing::zstd);
  for (const std::string& text :
       {std::string("*KEYWORD"), std::string("\x1f"), std::string("\x1f\x8b\x07"), std::string("\x1f "), std::string()})
    EXPECT_EQ(packing_of(std::as_bytes(std::span(text))), Packing::none);
  // Cut off behind its first two bytes.
  for (const std::string& brief : {kGzip.substr(0, 2), kGzip.substr(0, 3)})
    EXPECT_EQ(packing_of(std::as_bytes(std::span(brief))), Packing::gzip);
  // A frame to be skipped may come first: 0x184D2A50 to 0x184D2A5F (RFC 8878). Each byte of each number counts.
  const std::string skipped("\x5f\x2a\x4d\x18", 4);
  EXPECT_EQ(packing_of(std::as_bytes(std::span(skipped))), Packing::zstd);
  for (const std::string& number : {kGzip.substr(0, 3), kZstd.substr(0, 4), skipped})
    for (std::size_t i = 0; i < number.size(); ++i) {
      std::string other = number + "    ";
      other[i] = static_cast<char>(other[i] ^ 0x80);
      EXPECT_EQ(packing_of(std::as_bytes(std::span(other))), Packing::none) << i;
    }
}

TEST_F(Packed, reads_gzip_whole_with_all_its_members) {
  for (const std::string& stored : {kGzip, kGzip + kGzip, kGzip + std::string(512, '\0')}) {
    const auto file = read(write("x", stored));
    ASSERT_TRUE(file) << file.error().text();
    EXPECT_EQ(file->text(), stored == kGzip + kGzip ? "hello\nhello\n" : "hello\n");
    EXPECT_TRUE(file->is_packed());
    EXPECT_EQ(std::string(reinterpret_cast<const char*>(file->bytes().data()), file->bytes().size()), stored);
  }
  const auto plain = read(write("plain", "hello"));
  ASSERT_TRUE(plain);
  EXPECT_FALSE(plain->is_packed());
  EXPECT_EQ(plain->bytes().size(), 5u);
}

TEST_F(Packed, reads_what_the_programs_write_and_they_read_what_is_written) {
  const std::string text = long_text();
  write("deck", text);
  int judged = 0;
  for (const auto& [program, packs, unpacks] : {std::tuple("gzip", "gzip -9 -c deck > packed", "gzip -dc < again"),
                                                std::tuple("zstd", "zstd -q -c deck > packed", "zstd -q -dc < again")}) {
    if (!shell(std::string(program) + " --version > version")) {
      std::cout << program << " isn't here: WHAT IT WRITES AND READS ISN'T TESTED\n";
      continue;
    }
    ++judged;
    // Twice the same, one behind the other.
    ASSERT_TRUE(shell(packs));
    const std::string one = content(folder_ / "packed");
    const auto file = read(write("two", one + one));
    ASSERT_TRUE(file) << file.error().text();
    EXPECT_TRUE(file->text() == text + text);
    write("again", packed_as(text, one));
    ASSERT_TRUE(shell(std::string(unpacks) + " > unpacked"));
    EXPECT_TRUE(content(folder_ / "unpacked") == text);
    EXPECT_LT(content(folder_ / "again").size(), one.size() * 5 / 4);
    if (std::string_view(program) == "gzip") {
      // The name and the time in the header are the old ones.
      EXPECT_EQ(content(folder_ / "again").substr(0, 15), one.substr(0, 15));
    }
  }
  EXPECT_GT(judged, 0);
}

TEST_F(Packed, packs_as_it_was_packed) {
  const std::string text = long_text();
  for (const std::string& like : {kGzip, kZstd}) {
    const std::string packed = packed_as(text, like);
    const auto file = read(write("packed", packed));
    ASSERT_TRUE(file) << file.error().text();
    EXPECT_TRUE(file->text() == text);
    EXPECT_EQ(packed, packed_as(text, like)) << "not the same bytes again";
  }
  EXPECT_NE(packed_as("x", kGzip).find(std::string("hi\0", 3)), std::string::npos);
}

TEST_F(Packed, keeps_a_zstd_frames_checksum_and_says_its_size) {
  // The descriptor behind the magic number (RFC 8878): bit 2 is the checksum, bits 6 and 7 how long the content's size is, bit 5 that
  // there is one in a byte at least.
  const auto has_checksum = [](const std::string& frame) { return (frame.at(4) & 4) != 0; };
  const auto size_follows = [](const std::string& frame) { return (frame.at(4) & 0xe0) != 0; };
  std::string without = kZstd.substr(0, kZstd.size() - 4);
  without[4] = static_cast<char>(without[4] & ~4);
  ASSERT_EQ(read(write("without", without))->text(), "hello\n");
  for (const std::string& like : {kZstd, without}) {
    const std::string packed = packed_as("hello, hello", like);
    EXPECT_EQ(has_checksum(packed), has_checksum(like));
    EXPECT_TRUE(size_follows(packed));
  }
  const std::string skipped("\x50\x2a\x4d\x18\x01\x00\x00\x00!", 9);
  EXPECT_TRUE(has_checksum(packed_as("hello", skipped + without))) << "where nobody knows it does no harm";
}

TEST_F(Packed, leaves_out_what_a_gzip_header_says_of_itself) {
  // Flags (RFC 1952): 2 is the header's own checksum, 4 an extra field, 8 the name, 16 the comment.
  const std::string body = kGzip.substr(13);
  const std::string like = std::string(
                               "\x1f\x8b\x08\x1c\x01\x02\x03\x04\x02\x03\x02\x00"
                               "ab",
                               14) +
                           std::string("hi\0note\0", 8) + body;
  ASSERT_EQ(read(write("like", like))->text(), "hello\n");
  const std::string packed = packed_as("hello", like);
  EXPECT_EQ(packed.substr(0, 18), std::string("\x1f\x8b\x08\x18\x01\x02\x03\x04\x02\x03hi\0note\0", 18));
  EXPECT_EQ(read(write("packed", packed))->text(), "hello");
  // A name or a comment that is longer than any is cut, and what follows is read all the same.
  const std::string longest =
      std::string("\x1f\x8b\x08\x18\0\0\0\0\0\x03", 10) + std::string(9000, 'n') + '\0' + std::string(9000, 'c') + '\0' + body;
  ASSERT_EQ(read(write("longest", longest))->text(), "hello\n");
  const std::string cut = packed_as("hello", longest);
  EXPECT_EQ(read(write("cut", cut))->text(), "hello");
  EXPECT_EQ(cut.find('c', 10), cut.find('\0', 10) + 1);
}

TEST_F(Packed, says_what_is_wrong_with_a_file) {
  const std::string text = long_text();
  for (const std::string& like : {kGzip, kZstd}) {
    const std::string packed = packed_as(text, like);
    EXPECT_NE(error_of(write("cut", packed.substr(0, packed.size() / 2))).find("is cut off"), std::string::npos);
    EXPECT_NE(error_of(write("cut", packed.substr(0, packed.size() - 3))).find("is cut off"), std::string::npos);
    EXPECT_NE(error_of(write("cut", packed.substr(0, 7))).find("is cut off"), std::string::npos);
    std::string damaged = packed;
    for (std::size_t i = damaged.size() / 2; i < damaged.size() / 2 + 40; ++i) damaged[i] = static_cast<char>(damaged[i] ^ 0x5a);
    EXPECT_NE(error_of(write("damaged", damaged)).find("is damaged"), std::string::npos);
  }
  EXPECT_EQ(error_of(write("behind", kGzip + "more")), "has something else behind its gzip data");
  EXPECT_NE(error_of(write("behind", kZstd + "more")).find("no zstd file all through"), std::string::npos);
}

TEST_F(Packed, refuses_bombs_as_soon_as_they_show) {
  const std::string zeros(std::size_t{16} << 20, '0');
  for (const std::string& like : {kGzip, kZstd}) {
    const std::string bomb = packed_as(zeros, like);
    ASSERT_GT(zeros.size(), max_unpacked(bomb.size()));
    // Some of it is enough, and what comes behind doesn't excuse it.
    for (const std::string& file : {bomb, bomb + bomb, bomb + packed_as(long_text(), like)}) {
      double reached = 0;
      const fs::path path = write("bomb", file);
      const Result<FileBytes> read_bomb = read(path, [&](double fraction) {
        reached = fraction;
        return true;
      });
      ASSERT_FALSE(read_bomb);
      EXPECT_EQ(read_bomb.error().message, "unpacks to more than 200 times its size, as no deck does; it isn't read");
      EXPECT_LT(reached * static_cast<double>(file.size()), 0.5 * static_cast<double>(bomb.size()));
    }
  }
}

/// The memory that the process has held at most, in bytes.
std::size_t peak_memory() {
  struct rusage usage {};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::size_t>(usage.ru_maxrss) << 10;
}

// A gigabyte of zeros, packed quickly: 4.7 MB, a ratio of 227.
TEST_F(Packed, refuses_a_gigabyte_of_zeros_without_holding_it) {
  const std::string zeros(std::size_t{1} << 20, '\0');
  const std::string member = packed_as(zeros, std::string(kGzip).replace(8, 1, "\x04"));
  ASSERT_GT(zeros.size(), 210 * member.size());
  std::string bomb;
  for (int i = 0; i < 1024; ++i) bomb += member;
  const fs::path path = write("bomb.gz", bomb);
  const std::size_t before = peak_memory();
  const std::clock_t start = std::clock();
  EXPECT_EQ(error_of(path), "unpacks to more than 200 times its size, as no deck does; it isn't read");
  EXPECT_LT(static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC, 1);
  EXPECT_LT(peak_memory() - before, std::size_t{100} << 20);
}

TEST_F(Packed, reads_no_more_than_it_may) {
  const std::string text = long_text();
  for (const std::string& like : {kGzip, kZstd}) {
    const fs::path path = write("packed", packed_as(text, like));
    const auto read_at_most = [&](std::size_t max) { return unpack(*read_file(path), path, {}, max); };
    const Result<FileBytes> just_fits = read_at_most(text.size());
    ASSERT_TRUE(just_fits) << just_fits.error().text();
    EXPECT_EQ(just_fits->text(), text);
    for (const std::size_t max : {text.size() - 1, std::size_t{1} << 20, std::size_t{0}}) {
      const Result<FileBytes> refused = read_at_most(max);
      ASSERT_FALSE(refused);
      EXPECT_EQ(refused.error().text(), path.string() + ": unpacks to more than the " + std::to_string(max >> 20) +
                                            " MB that are left for packed files of a deck; unpack it first");
    }
  }
}

TEST_F(Packed, tells_how_far_it_is_and_stops) {
  const std::string text = long_text();
  for (const std::string& like : {kGzip, kZstd}) {
    const fs::path path = write("packed", packed_as(text, like));
    double last = 0;
    int told = 0;
    ASSERT_TRUE(read(path, [&](double fraction) {
      EXPECT_GE(fraction, last);
      last = fraction;
      ++told;
      return true;
    }));
    EXPECT_GT(told, 1);
    EXPECT_GT(last, 0.5);
    EXPECT_LE(last, 1);
    const auto stopped = read(path, [](double) { return false; });
    ASSERT_FALSE(stopped);
    EXPECT_TRUE(is_cancelled(stopped.error()));
  }
}

TEST_F(Packed, packing_tells_how_far_it_is_and_stops) {
  std::string text;
  while (text.size() < 3'500'000) text += long_text();
  const std::string_view whole = text;
  for (const std::string& like : {kGzip, kZstd}) {
    std::vector<double> told;
    const auto watch = [&](std::size_t most) {
      return pack(std::span(&whole, 1), std::as_bytes(std::span(like)), [&told, most](double fraction) {
        told.push_back(fraction);
        return told.size() < most;
      });
    };
    ASSERT_TRUE(watch(1000));
    EXPECT_GE(told.size(), 3u);
    EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
    EXPECT_LE(told.back(), 1);
    told.clear();
    const Result<std::string> stopped = watch(2);
    ASSERT_FALSE(stopped);
    EXPECT_TRUE(is_cancelled(stopped.error()));
    EXPECT_EQ(told.size(), 2u);
  }
}

}  // namespace
}  // namespace prismesh
