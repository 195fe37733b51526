#include "ipc/model/field_page.h"

#include <cstring>
#include <vector>

namespace prismesh::ipc {

Result<Descriptor> seal_field(std::uint64_t generation, bool on_nodes, std::span<const float> values) {
  const FieldHeader header{FieldHeader::kMagic, generation, values.size(), on_nodes ? 1U : 0U};
  std::vector<std::byte> bytes(sizeof header + values.size_bytes());
  std::memcpy(bytes.data(), &header, sizeof header);
  if (!values.empty()) std::memcpy(bytes.data() + sizeof header, values.data(), values.size_bytes());
  return make_sealed_memory("prismesh-field", bytes);
}

Result<std::shared_ptr<const FieldValues>> FieldValues::map(const Descriptor& descriptor) {
  if (Result<void> sealed = check_page_seals(descriptor, "field"); !sealed) return fail(std::move(sealed.error()));
  Result<Mapping> mapping = Mapping::map(descriptor, false);
  if (!mapping) return fail(std::move(mapping.error()));
  auto field = std::make_shared<FieldValues>();
  field->mapping_ = std::move(*mapping);
  const std::span<const std::byte> bytes = field->mapping_.bytes();
  if (bytes.size() < sizeof(FieldHeader)) return fail("field", "it is too short");
  std::memcpy(&field->header_, bytes.data(), sizeof(FieldHeader));
  if (field->header_.magic != FieldHeader::kMagic) return fail("field", "this is no field");
  if (field->header_.count != (bytes.size() - sizeof(FieldHeader)) / sizeof(float) ||
      (bytes.size() - sizeof(FieldHeader)) % sizeof(float) != 0)
    return fail("field", "it doesn't hold as many values as it says");
  return std::shared_ptr<const FieldValues>(std::move(field));
}

std::span<const float> FieldValues::values() const {
  return {reinterpret_cast<const float*>(mapping_.bytes().data() + sizeof(FieldHeader)), static_cast<std::size_t>(header_.count)};
}

}  // namespace prismesh::ipc
