#include "drivers/settings/keyboard_names.h"

#include <gtest/gtest.h>

namespace prismesh::drivers::settings {
namespace {

TEST(KeyboardNames, are_read_as_debian_writes_them) {
  const KeyboardNames names = read_keyboard_names(
      "# KEYBOARD CONFIGURATION FILE\n\nXKBMODEL=\"pc105\"\nXKBLAYOUT='de'\n XKBVARIANT=nodeadkeys # "
      "none\nXKBOPTIONS=\"\"\n\nBACKSPACE=\"guess\"\n");
  EXPECT_EQ(names, (KeyboardNames{"pc105", "de", "nodeadkeys", ""}));
  EXPECT_EQ(read_keyboard_names("XKBLAYOUT=\"us"), (KeyboardNames{"", "us", "", ""}));
  EXPECT_EQ(read_keyboard_names("XKBLAYOUT\n=\nXKBLAYOUT="), KeyboardNames());
}

}  // namespace
}  // namespace prismesh::drivers::settings
