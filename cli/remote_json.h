// The JSON of --json of the commands about stations and vaults; scripts rely on its fields. Inner to cli.
#pragma once

#include <span>
#include <string>

#include "ipc/intake/messages.h"
#include "ipc/remote/answers.h"
#include "ipc/remote/pull.h"
#include "ipc/remote/push.h"
#include "ipc/remote/station_book.h"
#include "ipc/vault/fetch.h"
#include "ipc/vault/push.h"

namespace prismesh::cli {

// Each returns one line without a line break. None has a token.
std::string paired_json(const ipc::remote::PairedStation& station);
std::string stations_json(std::span<const ipc::remote::PairedStation> stations);
std::string models_json(const std::string& station, std::span<const ipc::remote::ListedModel> models);
std::string pushed_json(const std::string& station, const ipc::remote::Pushed& pushed);
std::string pulled_json(const std::string& station, const ipc::remote::Pulled& pulled);
std::string forgotten_json(const std::string& station, bool token_is_void);
std::string described_json(const ipc::DescribeModel& told);
std::string revoked_json(const std::string& name);
std::string event_json(const std::string& kind, const std::string& model);
std::string pairing_code_json(const ipc::MadePairingCode& made, const ipc::IntakeInfo& info);
std::string tokens_json(const ipc::Tokens& tokens);

std::string vault_models_json(const std::string& vault, std::span<const ipc::store::ModelRecord> models);
std::string vault_pushed_json(const std::string& vault, const ipc::vault::VaultPushed& pushed);
std::string vault_fetched_json(const std::string& vault, const ipc::vault::VaultFetched& fetched);
std::string vault_verified_json(const std::string& vault, const ipc::vault::Verified& verified);

}  // namespace prismesh::cli
