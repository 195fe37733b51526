// What a station answers, and what people write for its address: each is refused, or what was read of it keeps its promises.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "ipc/remote/answers.h"
#include "ipc/remote/station_address.h"
#include "ipc/store/utf8.h"
#include "tests/fuzz/require.h"

using namespace prismesh;  // NOLINT: a fuzz target is a program of its own

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  if (const auto paired = ipc::remote::parse_pair_answer(text)) require(paired->token.find_first_of("\r\n ") == std::string::npos);
  if (const auto models = ipc::remote::parse_model_list(text))
    for (const ipc::remote::ListedModel& model : *models) require(ipc::store::is_plain_utf8(model.record.name));
  if (const auto model = ipc::remote::parse_listed_model(text)) require(ipc::store::is_plain_utf8(model->record.who));
  require(ipc::store::is_plain_utf8(ipc::remote::refusal_sentence(text)));
  if (const auto address = ipc::remote::parse_station_address(text)) {
    const auto again = ipc::remote::parse_station_address(address->text());
    require(again && *again == *address);
  }
  ipc::remote::EventReader whole, halves;
  const std::size_t half = size / 2;
  if (!whole.add(text) || !halves.add(text.substr(0, half)) || !halves.add(text.substr(half))) return 0;
  for (;;) {
    const auto event = whole.next(), same = halves.next();
    require(event.has_value() == same.has_value());
    if (!event) return 0;
    require(event->kind == same->kind && event->data == same->data && event->data.find('\n') == std::string::npos);
    ipc::remote::model_of_event(*event);
  }
}
