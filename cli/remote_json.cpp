#include "cli/remote_json.h"

#include <nlohmann/json.hpp>

#include "cli/report_text.h"

namespace prismesh::cli {

namespace {

using OrderedJson = nlohmann::ordered_json;
namespace remote = ipc::remote;

OrderedJson texts(const std::vector<std::string>& list) {
  OrderedJson array = OrderedJson::array();
  for (const std::string& each : list) array.push_back(printable(each));
  return array;
}

OrderedJson station_object(const remote::PairedStation& station) {
  return {{"station", printable(station.name)},
          {"name", printable(station.token_name)},
          {"scopes", texts(station.scopes)},
          {"expires_s", station.expires_s},
          {"fingerprint", station.fingerprint.hex()}};
}

OrderedJson model_object(const remote::ListedModel& model) {
  const ipc::store::ModelRecord& record = model.record;
  OrderedJson object{{"model", record.model.hex()}, {"name", printable(record.name)}, {"who", printable(record.who)},
                     {"when_s", record.when_s},     {"bytes", record.bytes},          {"files", record.files},
                     {"damaged", model.is_damaged}};
  object["derived_from"] = record.derived_from ? OrderedJson(record.derived_from->hex()) : OrderedJson(nullptr);
  object["figures"] = nullptr;
  if (const auto& figures = record.figures)
    object["figures"] = {{"nodes", figures->nodes},
                         {"elements", figures->elements},
                         {"parts", figures->parts},
                         {"warn", figures->warn},
                         {"fail", figures->fail}};
  return object;
}

OrderedJson vault_model_object(const ipc::store::ModelRecord& model) {
  return {{"model", model.model.hex()},
          {"name", printable(model.name)},
          {"when_s", model.when_s},
          {"bytes", model.bytes},
          {"files", model.files}};
}

}  // namespace

std::string paired_json(const remote::PairedStation& station) { return station_object(station).dump(); }

std::string stations_json(std::span<const remote::PairedStation> stations) {
  OrderedJson list = OrderedJson::array();
  for (const remote::PairedStation& station : stations) list.push_back(station_object(station));
  return OrderedJson{{"stations", std::move(list)}}.dump();
}

std::string models_json(const std::string& station, std::span<const remote::ListedModel> models) {
  OrderedJson list = OrderedJson::array();
  for (const remote::ListedModel& model : models) list.push_back(model_object(model));
  return OrderedJson{{"station", printable(station)}, {"models", std::move(list)}}.dump();
}

std::string pushed_json(const std::string& station, const remote::Pushed& pushed) {
  OrderedJson object = model_object(pushed.model);
  object["station"] = printable(station);
  object["was_there"] = pushed.was_there;
  object["sent_bytes"] = pushed.sent_bytes;
  return object.dump();
}

std::string pulled_json(const std::string& station, const remote::Pulled& pulled) {
  OrderedJson object = model_object(pulled.model);
  object["station"] = printable(station);
  object["folder"] = printable(pulled.folder.string());
  object["main"] = printable(pulled.main.string());
  object["received_bytes"] = pulled.received_bytes;
  return object.dump();
}

std::string forgotten_json(const std::string& station, bool token_is_void) {
  return OrderedJson{{"station", printable(station)}, {"token_is_void", token_is_void}}.dump();
}

std::string revoked_json(const std::string& name) { return OrderedJson{{"revoked", printable(name)}}.dump(); }

std::string described_json(const ipc::DescribeModel& told) {
  return OrderedJson{{"model", told.model}, {"nodes", told.nodes}, {"elements", told.elements},         {"parts", told.parts},
                     {"warn", told.warn},   {"fail", told.fail},   {"picture", !told.thumbnail.empty()}}
      .dump();
}

std::string event_json(const std::string& kind, const std::string& model) {
  return OrderedJson{{"event", printable(kind)}, {"model", model}}.dump();
}

std::string pairing_code_json(const ipc::MadePairingCode& made, const ipc::IntakeInfo& info) {
  return OrderedJson{{"code", made.code}, {"lifetime_s", made.lifetime_s}, {"address", info.address}, {"fingerprint", info.fingerprint}}
      .dump();
}

std::string tokens_json(const ipc::Tokens& tokens) {
  OrderedJson list = OrderedJson::array();
  for (const ipc::TokenInfo& token : tokens.tokens)
    list.push_back(
        {{"name", printable(token.name)}, {"scopes", texts(token.scopes)}, {"made_s", token.made_s}, {"expires_s", token.expires_s}});
  return OrderedJson{{"tokens", std::move(list)}}.dump();
}

std::string vault_models_json(const std::string& vault, std::span<const ipc::store::ModelRecord> models) {
  OrderedJson list = OrderedJson::array();
  for (const ipc::store::ModelRecord& model : models) list.push_back(vault_model_object(model));
  return OrderedJson{{"vault", printable(vault)}, {"models", std::move(list)}}.dump();
}

std::string vault_pushed_json(const std::string& vault, const ipc::vault::VaultPushed& pushed) {
  OrderedJson object = vault_model_object(pushed.model);
  object["vault"] = printable(vault);
  object["was_there"] = pushed.was_there;
  object["pieces"] = pushed.pieces;
  object["sent_pieces"] = pushed.sent_pieces;
  object["sent_bytes"] = pushed.sent_bytes;
  return object.dump();
}

std::string vault_fetched_json(const std::string& vault, const ipc::vault::VaultFetched& fetched) {
  OrderedJson object = vault_model_object(fetched.model);
  object["vault"] = printable(vault);
  object["folder"] = printable(fetched.folder.string());
  object["main"] = printable(fetched.main.string());
  object["received_bytes"] = fetched.received_bytes;
  return object.dump();
}

std::string vault_verified_json(const std::string& vault, const ipc::vault::Verified& verified) {
  OrderedJson faults = OrderedJson::array();
  for (const ipc::vault::VaultFault& fault : verified.faults)
    faults.push_back(
        {{"model", fault.model.hex()}, {"file", printable(fault.file)}, {"object", fault.object}, {"fault", printable(fault.fault)}});
  return OrderedJson{{"vault", printable(vault)},
                     {"models", verified.models},
                     {"objects", verified.objects},
                     {"bytes", verified.bytes},
                     {"faults", std::move(faults)}}
      .dump();
}

}  // namespace prismesh::cli
