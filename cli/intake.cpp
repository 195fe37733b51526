// The station's side of pairing: asks the prismesh-intake on this machine for codes, and for the tokens it has given.
#include <ostream>
#include <variant>

#include "cli/commands.h"
#include "cli/describe_models.h"
#include "cli/remote_json.h"
#include "cli/report_text.h"
#include "ipc/intake/client.h"

namespace prismesh::cli {

namespace {

constexpr int kSecondsOfMinute = 60;

/// The answer of this type to a request.
template <class T>
Result<T> ask_intake(ipc::IntakeClient& client, const ipc::IntakeRequest& request) {
  Result<ipc::IntakeAnswer> answer = client.call(request);
  if (!answer) return fail(answer.error());
  auto* wanted = std::get_if<T>(&*answer);
  if (wanted == nullptr) return fail("prismesh-intake", "its answer isn't one to what was asked");
  return std::move(*wanted);
}

Result<void> make_code(ipc::IntakeClient& client, const IntakeOptions& options, const Common& common, const Context& context) {
  const Result<ipc::IntakeInfo> info = ask_intake<ipc::IntakeInfo>(client, ipc::GetIntake{});
  if (!info) return fail(info.error());
  const Result<ipc::MadePairingCode> made = ask_intake<ipc::MadePairingCode>(client, ipc::MakePairingCode{options.name, options.allow});
  if (!made) return fail(made.error());
  if (common.json)
    context.out << pairing_code_json(*made, *info) << '\n';
  else
    context.out << made->code << "\ngood for one computer, for " << made->lifetime_s / kSecondsOfMinute
                << " minutes; there: prismesh pair STATION " << made->code << "\nlistens at " << info->address
                << "; SHA-256 of the certificate: " << info->fingerprint
                << "\nin a browser: https://STATION:" << info->address.substr(info->address.rfind(':') + 1)
                << "/, after comparing that SHA-256 with the certificate's\n";
  return {};
}

Result<void> list_tokens(ipc::IntakeClient& client, const Common& common, const Context& context) {
  const Result<ipc::Tokens> tokens = ask_intake<ipc::Tokens>(client, ipc::GetTokens{});
  if (!tokens) return fail(tokens.error());
  if (common.json) {
    context.out << tokens_json(*tokens) << '\n';
    return {};
  }
  for (const ipc::TokenInfo& token : tokens->tokens) {
    context.out << printable(token.name) << ": may";
    for (const std::string& scope : token.scopes) context.out << ' ' << printable(scope);
    context.out << '\n';
  }
  if (tokens->tokens.empty()) context.out << "no computer is paired\n";
  return {};
}

}  // namespace

int intake(const IntakeOptions& options, const Common& common, const Context& context) {
  Result<ipc::IntakeClient> client = ipc::IntakeClient::connect(ipc::intake_socket_path(options.runtime_directory), "prismesh intake");
  Result<void> done;
  if (!client)
    done = fail(client.error());
  else if (options.action == IntakeOptions::Action::describe)
    return describe_models(*client, options.name, common, context);
  else if (options.action == IntakeOptions::Action::code)
    done = make_code(*client, options, common, context);
  else if (options.action == IntakeOptions::Action::tokens)
    done = list_tokens(*client, common, context);
  else if (const Result<ipc::Done> revoked = ask_intake<ipc::Done>(*client, ipc::RevokeToken{options.name}); !revoked)
    done = fail(revoked.error());
  if (!done) {
    say(context, done.error());
    return kFailed;
  }
  if (options.action != IntakeOptions::Action::revoke) return kDone;
  if (common.json)
    context.out << revoked_json(options.name) << '\n';
  else
    context.out << "revoked " << printable(options.name) << '\n';
  return kDone;
}

}  // namespace prismesh::cli
