// Any bytes as the manifest of a model: refused, or the one text of what was read, whose paths all stay beneath a folder.
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string_view>

#include "ipc/store/manifest.h"
#include "tests/fuzz/require.h"

using namespace prismesh;  // NOLINT: a fuzz target is a program of its own

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const Result<ipc::store::Manifest> manifest = ipc::store::decode_manifest(text);
  if (!manifest) {
    require(manifest.error().file == "manifest" && !manifest.error().message.empty());
    return 0;
  }
  require(ipc::store::encode_manifest(*manifest) == text);
  for (const ipc::store::SetFile& file : manifest->files) {
    const std::filesystem::path path(file.path);
    require(path.is_relative() && path.lexically_normal() == path && !file.path.starts_with("../") && file.path != "..");
  }
  return 0;
}
