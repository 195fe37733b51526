#include "drivers/haptic_pen/falcon/firmware.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/haptic_pen/falcon/simulated_falcon.h"

namespace prismesh::drivers::haptic_pen::falcon {
namespace {

TEST(FalconFirmware, that_is_whole_is_taken) {
  const std::vector<std::byte> bytes = pretended_firmware(300);
  const Result<Firmware> firmware = parse_firmware(bytes, "f.bin");
  ASSERT_TRUE(firmware) << firmware.error().text();
  EXPECT_EQ(firmware->bytes, bytes);
}

TEST(FalconFirmware, that_is_cut_at_any_byte_is_refused) {
  const std::vector<std::byte> bytes = pretended_firmware(120);
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    const Result<Firmware> firmware = parse_firmware(std::span(bytes).first(length), "f.bin");
    ASSERT_FALSE(firmware) << length;
    EXPECT_THAT(firmware.error().text(),
                testing::StartsWith("f.bin: isn't a whole Falcon firmware: it ends after " + std::to_string(length)));
  }
}

TEST(FalconFirmware, another_file_is_refused_with_what_is_wrong) {
  std::vector<std::byte> bytes = pretended_firmware(120);
  bytes.push_back(std::byte{0});
  EXPECT_EQ(parse_firmware(bytes, "f.bin").error().text(), "f.bin: isn't a Falcon firmware: 1 bytes follow its end");
  bytes[0] = std::byte{'P'};
  EXPECT_EQ(parse_firmware(bytes, "f.bin").error().text(), "f.bin: isn't a Falcon firmware: it begins with 50 08, not AA 08");
  EXPECT_EQ(parse_firmware(pretended_firmware(0), "f.bin").error().text(), "f.bin: isn't a Falcon firmware: it has no program in it");
  EXPECT_THAT(parse_firmware(std::vector<std::byte>(1'000'000), "f.bin").error().text(),
              testing::HasSubstr("which no such device can hold"));
  EXPECT_THAT(read_firmware("/nowhere/f.bin").error().text(), testing::StartsWith("/nowhere/f.bin: "));
}

}  // namespace
}  // namespace prismesh::drivers::haptic_pen::falcon
