// What a store answers, the names of its objects, and what people write for a vault: each is refused, or what was read of it keeps its
// promises.
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "ipc/store/utf8.h"
#include "ipc/vault/address.h"
#include "ipc/vault/objects.h"
#include "ipc/vault/s3_answers.h"
#include "ipc/vault/settings.h"
#include "tests/fuzz/require.h"

using namespace prismesh;  // NOLINT: a fuzz target is a program of its own

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  if (const auto list = ipc::vault::parse_object_list(text))
    for (const ipc::vault::ListedObject& object : list->objects) require(!object.key.empty());
  const ipc::vault::S3Refusal refusal = ipc::vault::parse_refusal(text);
  require(ipc::store::is_plain_utf8(refusal.code) && ipc::store::is_plain_utf8(refusal.message));
  if (const auto record = ipc::vault::record_of_object(text)) {
    require(ipc::vault::name_object(*record) == text && ipc::store::is_plain_utf8(record->name));
  }
  if (const auto model = ipc::vault::model_of_object(text)) require(ipc::vault::model_object(*model) == text);
  for (const std::uint64_t pieces : {2, 3})
    if (const auto list = ipc::vault::decode_pieces(text, pieces * ipc::vault::kPieceBytes)) {
      require(list->size() == pieces && ipc::vault::encode_pieces(*list) == text);
    }
  if (const auto address = ipc::vault::parse_vault_address(text)) {
    const auto again = ipc::vault::parse_vault_address(address->text());
    require(again && *again == *address);
    const std::string place = "/" + address->bucket + "/" + address->folder;
    require(place.find("/../") == std::string::npos && place.find("/./") == std::string::npos && place.find("//") == std::string::npos);
    require(address->text().find('@') == std::string::npos);
  }
  if (const auto settings = ipc::vault::parse_vault_settings(text, "vault.toml")) {
    require((settings->access_key_id + settings->secret_access_key + settings->region).find_first_of("\r\n ") == std::string::npos);
  } else {
    require(settings.error().line > 0 && ipc::store::is_plain_utf8(settings.error().message));
  }
  return 0;
}
