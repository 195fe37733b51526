// What the linked programs hold.
#include <string>

#include <gtest/gtest.h>

#include "tests/architecture/tree.h"
#include "tests/support/places.h"

namespace prismesh::architecture {
namespace {

/// Whether a program's symbols name the namespace prismesh::mesh, in the form of the Itanium C++ ABI.
bool holds_the_mesh(const std::string& program) {
  const std::string bytes = read_text(test::programs_folder() / program);
  EXPECT_NE(bytes.find("8prismesh"), std::string::npos) << program << " has no symbols: it was stripped";
  return bytes.find("8prismesh4mesh") != std::string::npos;
}

TEST(Programs, of_devices_hold_nothing_of_the_mesh) {
  EXPECT_FALSE(holds_the_mesh("prismesh-deviced")) << "what holds the ports must not be able to read a deck";
  EXPECT_TRUE(holds_the_mesh("prismesh-modeld"));
}

}  // namespace
}  // namespace prismesh::architecture
