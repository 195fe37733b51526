// Any bytes as a table of roles: no crash, and errors say file and line. A user who isn't named has no role.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include <unistd.h>

#include "ipc/wire/roles.h"
#include "tests/fuzz/require.h"

using namespace prismesh;  // NOLINT: a fuzz target is a program of its own

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto find_user = [](const std::string& name) { return name == "kiosk" ? std::optional<uid_t>(4001) : std::nullopt; };
  const Result<ipc::RoleTable> table = ipc::parse_roles(text, "roles.toml", find_user);
  if (!table) {
    require(table.error().file == "roles.toml" && table.error().line > 0 && !table.error().message.empty());
    return 0;
  }
  require(text.find("kiosk") != std::string_view::npos || table->of(4001).none() || text.find("4001") != std::string_view::npos ||
          text.find('\\') != std::string_view::npos);
  return 0;
}
