#include "drivers/display/edid.h"

#include <gtest/gtest.h>

#include <vector>

namespace prismesh::drivers::display {
namespace {

/// Builds an EDID byte by byte, as VESA E-EDID 1.4 defines it.
class EdidBytes {
 public:
  EdidBytes() : bytes_(128) {
    set(0, {0x00, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0x00});

    set(10, {0x34, 0x12});              // product 0x1234
    set(12, {0x39, 0x30, 0x00, 0x00});  // serial number 12345
    set(18, {1, 4});
    set(20, {0xA5});  // digital, 8 bits per colour, DisplayPort
    set(21, {52, 33});
    maker("EIZ");
  }
  void set(std::size_t start, std::initializer_list<unsigned> values) {
    for (const unsigned value : values) bytes_[start++] = static_cast<std::byte>(value);
  }
  void maker(const char* letters) {
    unsigned packed = 0;
    for (int i = 0; i < 3; ++i) packed = packed << 5 | static_cast<unsigned>(letters[i] - 'A' + 1);
    set(8, {packed >> 8, packed & 255});
  }
  /// 1920 x 1200, 518 x 324 mm.
  void preferred_timing() {
    set(54, {0x28, 0x3C, 0x80, 0xA0, 0x70, 0xB0, 0x23, 0x40, 0x30, 0x20, 0x36, 0x00, 0x06, 0x44, 0x21, 0x00, 0x00, 0x1A});
  }
  void text(std::size_t start, unsigned kind, const char* words) {
    set(start, {0, 0, 0, kind, 0});
    std::size_t at = start + 5;
    for (; *words != '\0'; ++words) bytes_[at++] = static_cast<std::byte>(*words);
    if (at < start + 18) bytes_[at++] = std::byte{'\n'};
    while (at < start + 18) bytes_[at++] = std::byte{' '};
  }
  void cta(unsigned flags) {
    bytes_.resize(256);
    set(126, {1});
    set(128, {0x02, 0x03, 0x04, flags});
  }
  std::vector<std::byte> done() {
    for (std::size_t block = 0; block < bytes_.size(); block += 128) {
      unsigned sum = 0;
      for (std::size_t i = 0; i < 127; ++i) sum += std::to_integer<unsigned>(bytes_[block + i]);
      bytes_[block + 127] = static_cast<std::byte>(256 - sum % 256);
    }
    return bytes_;
  }

 private:
  std::vector<std::byte> bytes_;
};

TEST(Edid, decodes_identity_and_size) {
  EdidBytes bytes;
  bytes.preferred_timing();
  bytes.text(72, 0xFC, "CG2420");
  bytes.text(90, 0xFF, "31337A");
  const Result<Edid> edid = decode_edid(bytes.done());
  ASSERT_TRUE(edid) << edid.error().text();
  EXPECT_EQ(edid->identity, (MonitorIdentity{"EIZ", "CG2420", "31337A"}));
  EXPECT_EQ(edid->identity.text(), "EIZ CG2420 31337A");
  EXPECT_EQ(edid->native_width, 1920);
  EXPECT_EQ(edid->native_height, 1200);
  EXPECT_EQ(edid->width_mm, 518);
  EXPECT_EQ(edid->height_mm, 324);
  EXPECT_TRUE(edid->digital);
  EXPECT_FALSE(edid->takes_ycbcr_422);
}

TEST(Edid, falls_back_to_numbers_without_texts) {
  EdidBytes bytes;
  const Result<Edid> edid = decode_edid(bytes.done());
  ASSERT_TRUE(edid);
  EXPECT_EQ(edid->identity.text(), "EIZ 1234 12345");
  EXPECT_EQ(edid->width_mm, 520);
  EXPECT_EQ(edid->native_width, 0);
}

TEST(Edid, detects_a_monitor_that_accepts_halved_colours) {
  EdidBytes first_block;
  first_block.set(24, {0x10});
  EXPECT_TRUE(decode_edid(first_block.done())->takes_ycbcr_422);
  EdidBytes older;  // before 1.4 this bit encodes the type of an analogue display
  older.set(19, {3});
  older.set(24, {0x10});
  EXPECT_FALSE(decode_edid(older.done())->takes_ycbcr_422);
  EdidBytes extension;
  extension.cta(0x30);
  const Result<Edid> edid = decode_edid(extension.done());
  EXPECT_TRUE(edid->takes_ycbcr_422);
  EXPECT_TRUE(edid->takes_ycbcr_444);
}

TEST(Edid, the_first_timing_is_the_preferred_one) {
  EdidBytes bytes;
  bytes.preferred_timing();
  bytes.set(72, {0x02, 0x3A, 0x80, 0xFC, 0x71, 0x38, 0x2D, 0x40, 0x58, 0x2C, 0x45, 0x00, 0xDD, 0x0C, 0x11, 0x00, 0x00, 0x1E});  // 1080 rows
  EXPECT_EQ(decode_edid(bytes.done())->native_width, 1920);
  EXPECT_EQ(decode_edid(bytes.done())->native_height, 1200);
  EXPECT_EQ(decode_edid(bytes.done())->identity.model, "1234") << "a timing holds no name, whatever its fourth byte";
  EdidBytes name_first;
  name_first.text(54, 0xFC, "CG2420");
  EXPECT_EQ(decode_edid(name_first.done())->native_width, 0);
  EXPECT_EQ(decode_edid(name_first.done())->width_mm, 520);
}

TEST(Edid, a_name_ends_with_its_descriptor_and_is_printable) {
  EdidBytes bytes;
  bytes.text(54, 0xFC, "THIRTEEN LONG");
  bytes.set(72, {0x41, 0x42, 0x43});  // followed at once by a timing
  bytes.text(90, 0xFF,
             " a\x7F\x1B\x80"
             "b~ ");
  const Result<Edid> edid = decode_edid(bytes.done());
  ASSERT_TRUE(edid) << edid.error().text();
  EXPECT_EQ(edid->identity.model, "THIRTEEN LONG");
  EXPECT_EQ(edid->identity.serial, "ab~");
}

TEST(Edid, an_analogue_monitor_accepts_no_colour_format) {
  EdidBytes bytes;
  bytes.set(20, {0x25});
  bytes.set(24, {0x18});
  const Result<Edid> edid = decode_edid(bytes.done());
  ASSERT_TRUE(edid);
  EXPECT_FALSE(edid->digital);
  EXPECT_FALSE(edid->takes_ycbcr_422);
  EXPECT_FALSE(edid->takes_ycbcr_444);
}

TEST(Edid, skips_a_damaged_extension) {
  EdidBytes bytes;
  bytes.cta(0x30);
  std::vector<std::byte> damaged = bytes.done();
  damaged[200] ^= std::byte{1};
  const Result<Edid> edid = decode_edid(damaged);
  ASSERT_TRUE(edid);
  EXPECT_FALSE(edid->takes_ycbcr_422);
}

TEST(Edid, sizes_that_are_ratios_are_unknown) {
  EdidBytes bytes;
  bytes.set(21, {0x4F, 0});  // landscape 16:9, as EDID 1.4 encodes it
  bytes.preferred_timing();
  bytes.set(66, {16, 9, 0});
  const Result<Edid> edid = decode_edid(bytes.done());
  ASSERT_TRUE(edid);
  EXPECT_EQ(edid->width_mm, 0);
  EXPECT_EQ(edid->height_mm, 0);
}

TEST(Edid, refuses_what_is_no_edid) {
  EXPECT_FALSE(decode_edid({}));
  std::vector<std::byte> bytes = EdidBytes().done();
  EXPECT_FALSE(decode_edid(std::span(bytes).first(127)));
  bytes[3] = std::byte{0};
  EXPECT_FALSE(decode_edid(bytes));
  for (std::size_t i = 8; i < 128; ++i) {  // the checksum covers every byte
    std::vector<std::byte> damaged = EdidBytes().done();
    damaged[i] ^= std::byte{0x40};
    EXPECT_FALSE(decode_edid(damaged)) << i;
  }
}

}  // namespace
}  // namespace prismesh::drivers::display
