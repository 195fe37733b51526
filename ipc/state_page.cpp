#include "ipc/state_page.h"

#include <new>

namespace prismesh::ipc {

namespace {

constexpr std::uint64_t kMagic = 0x3145'5441'5453'5250;  // "PRSTATE1"
constexpr std::uint64_t kVersion = 1;

}  // namespace

Result<StatePage> StatePage::create() {
  Result<Descriptor> memory = make_shared_memory("prismesh-state", sizeof(StatePageLayout));
  if (!memory) return fail(std::move(memory.error()));
  Result<Mapping> mapping = Mapping::map(*memory, true);
  if (!mapping) return fail(std::move(mapping.error()));
  if (Result<void> sealed = seal_for_readers(*memory); !sealed) return fail(std::move(sealed.error()));
  StatePage page;
  page.descriptor_ = std::move(*memory);
  page.mapping_ = std::move(*mapping);
  page.layout_ = new (page.mapping_.writable_bytes().data()) StatePageLayout{kMagic, kVersion, {}};
  return page;
}

Result<StatePageReader> StatePageReader::map(const Descriptor& descriptor) {
  Result<Mapping> mapping = Mapping::map(descriptor, false);
  if (!mapping) return fail(std::move(mapping.error()));
  if (mapping->bytes().size() < sizeof(StatePageLayout)) return fail("state page", "it is too short");
  StatePageReader reader;
  reader.mapping_ = std::move(*mapping);
  reader.layout_ = reinterpret_cast<const StatePageLayout*>(reader.mapping_.bytes().data());
  if (reader.layout_->magic != kMagic || reader.layout_->version != kVersion)
    return fail("state page", "it is none, or of another version");
  return reader;
}

}  // namespace prismesh::ipc
