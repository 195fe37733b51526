// The messages between prismesh-intake and its clients on the same machine, as plain structs (their JSON: messages_json.cpp), in the same
// form as modeld's. docs/protocol.md describes them.
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "ipc/wire/answers.h"

namespace prismesh::ipc {

inline constexpr int kIntakeProtocolVersion = 1;

// --- requests ---
struct IntakeHello {
  int protocol = kIntakeProtocolVersion;
  std::string program;
};
struct GetIntake {};
/// Makes a code for one pairing; an earlier one is void.
struct MakePairingCode {
  std::string name;                 ///< the token's; empty: the client says one
  std::vector<std::string> scopes;  ///< of read, upload, remove, metrics
};
struct GetTokens {};
struct RevokeToken {
  std::string name;
};
/// Publishes a model that was edited on this machine, from a folder beneath the one for such work.
struct PublishWork {
  std::string work;          ///< the folder's name
  std::string derived_from;  ///< hash of the model that was laid out there
};
/// Says what a reader found in a stored model; prismesh-intake itself reads no deck.
struct DescribeModel {
  std::string model;  ///< its hash
  std::uint64_t nodes = 0;
  std::uint64_t elements = 0;
  std::uint64_t parts = 0;
  std::uint64_t warn = 0;  ///< elements
  std::uint64_t fail = 0;  ///< elements
  std::string thumbnail;   ///< a small PNG in base64; empty: the model keeps the one it has
};
using IntakeRequest = std::variant<IntakeHello, GetIntake, MakePairingCode, GetTokens, RevokeToken, PublishWork, DescribeModel>;

// --- answers (Failed and Done: ipc/wire/answers.h) ---
struct IntakeWelcome {
  int protocol = kIntakeProtocolVersion;
  std::string version;
};
struct IntakeInfo {
  std::string address;      ///< "0.0.0.0:7443"
  std::string fingerprint;  ///< SHA-256 of the certificate, in hexadecimal digits
  std::string store;        ///< the store's folder
  std::string work;         ///< the folder whose folders PublishWork publishes
};
struct MadePairingCode {
  std::string code;  ///< with the beginning of the fingerprint and a secret
  std::int64_t lifetime_s = 0;
};
struct TokenInfo {
  std::string name;
  std::vector<std::string> scopes;
  std::int64_t made_s = 0;     ///< since 1970
  std::int64_t expires_s = 0;  ///< since 1970
};
struct Tokens {
  std::vector<TokenInfo> tokens;
};
struct PublishedWork {
  std::string model;  ///< its hash; that of `derived_from` where nothing changed
};
using IntakeAnswer = std::variant<Failed, Done, IntakeWelcome, IntakeInfo, MadePairingCode, Tokens, PublishedWork>;

// --- events ---
struct CatalogueChanged {
  std::string model;  ///< the model that was published or removed
};
using IntakeEvent = std::variant<CatalogueChanged>;

}  // namespace prismesh::ipc
