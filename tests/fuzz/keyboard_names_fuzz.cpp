// Reads any bytes as /etc/default/keyboard. A name has no line break and is never longer than the text.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "drivers/settings/keyboard_names.h"
#include "tests/fuzz/require.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const prismesh::drivers::settings::KeyboardNames names = prismesh::drivers::settings::read_keyboard_names(text);
  for (const std::string* name : {&names.model, &names.layout, &names.variant, &names.options})
    require(name->size() < text.size() + 1 && name->find('\n') == std::string::npos);
  return 0;
}
