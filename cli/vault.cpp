// Models in a store that speaks S3: vault push, list, fetch, verify.
#include <ctime>
#include <ostream>

#include "base/counted.h"
#include "cli/commands.h"
#include "cli/deck_files.h"
#include "cli/progress_bar.h"
#include "cli/remote_json.h"
#include "cli/report_text.h"
#include "ipc/vault/fetch.h"
#include "ipc/vault/push.h"

namespace prismesh::cli {

namespace {

namespace keeping = ipc::vault;

constexpr std::size_t kListedDigits = 12;
constexpr std::size_t kNamedFiles = 10;

int refused(const Context& context, const Error& error) {
  say(context, error);
  return kFailed;
}

Result<keeping::Vault> open_vault(const VaultOptions& options, const Context& context) {
  const Result<keeping::VaultSettings> settings = keeping::read_vault_settings(options.credentials);
  if (!settings) return fail(settings.error());
  const std::string wanted = options.vault.empty() ? settings->vault.value_or("") : options.vault;
  if (wanted.empty()) return fail("", "no vault is named; say which: --vault s3+https://HOST/BUCKET, or set PRISMESH_VAULT");
  Result<keeping::VaultAddress> address = keeping::parse_vault_address(wanted);
  if (!address) return fail(address.error());
  if (address->is_plain && !address->is_loopback() && !options.plain_http)
    return fail(address->text(), "isn't encrypted, so all on the way could read the models; write s3+https, or allow it with --plain-http");
  const std::chrono::seconds patience(options.patience_s);
  keeping::VaultOptions how;
  how.line.silence = std::max(patience / 2, std::chrono::seconds(1));  // so that a silent line is tried twice within the patience
  how.line.connect = std::min(how.line.connect, patience);
  how.retry.whole = patience;
  return keeping::Vault(std::move(*address), *settings, how, [&context] { return context.stop(); });
}

std::string called(const ipc::store::ModelRecord& model) { return model.name.empty() ? "(no name)" : printable(model.name); }

/// A deck of somebody else may include any file of this computer, and who reads the bucket would have it.
Error sends_outside(const VaultOptions& options, const DeckFiles& files) {
  std::string named;
  for (std::size_t i = 0; i < files.outside.size() && i < kNamedFiles; ++i) named += (i == 0 ? "" : ", ") + files.outside[i].string();
  if (files.outside.size() > kNamedFiles) named += " and " + std::to_string(files.outside.size() - kNamedFiles) + " more";
  return Error{options.deck.string(), 0,
               "includes files outside its folder: " + named + "; nothing was sent. Send them too with --outside"};
}

int push_to_vault(keeping::Vault& vault, const VaultOptions& options, const Common& common, const Context& context) {
  const Result<DeckFiles> files = files_of_deck(options.deck, common, context);
  if (!files) return refused(context, files.error());
  if (!files->outside.empty() && !options.outside) return refused(context, sends_outside(options, *files));
  Result<keeping::VaultPushed> pushed = fail("", "");
  {
    MonotonicClock clock;
    ProgressBar bar(context, "sending " + options.deck.filename().string(), clock);
    keeping::VaultPushOptions how;
    how.name = options.name;
    how.now_s = std::time(nullptr);
    how.sends_all = options.resend;
    how.progress = bar.progress();
    pushed = keeping::push(vault, files->files, files->main, how);
  }
  if (!pushed) return refused(context, pushed.error());
  if (common.json)
    context.out << vault_pushed_json(vault.name(), *pushed) << '\n';
  else if (pushed->was_there)
    context.out << printable(vault.name()) << " has it already: model " << pushed->model.model.hex() << '\n';
  else
    context.out << "pushed " << called(pushed->model) << " to " << printable(vault.name()) << ": model " << pushed->model.model.hex()
                << ", " << counted(pushed->model.files, "file") << ", " << counted(pushed->model.bytes, "byte") << "; sent "
                << pushed->sent_pieces << " of " << counted(pushed->pieces, "piece") << '\n';
  return kDone;
}

int list_vault(keeping::Vault& vault, const Common& common, const Context& context) {
  const Result<std::vector<ipc::store::ModelRecord>> models = keeping::models(vault);
  if (!models) return refused(context, models.error());
  if (common.json) {
    context.out << vault_models_json(vault.name(), *models) << '\n';
    return kDone;
  }
  for (const ipc::store::ModelRecord& model : *models)
    context.out << model.model.hex().substr(0, kListedDigits) << "  " << called(model) << ": " << counted(model.files, "file") << ", "
                << counted(model.bytes, "byte") << ", " << day_and_time(model.when_s) << " UTC\n";
  if (models->empty()) context.out << printable(vault.name()) << " has no models\n";
  return kDone;
}

int fetch_from_vault(keeping::Vault& vault, const VaultOptions& options, const Common& common, const Context& context) {
  Result<keeping::VaultFetched> fetched = fail("", "");
  {
    MonotonicClock clock;
    ProgressBar bar(context, "fetching " + printable(options.model), clock);
    fetched = keeping::fetch(vault, options.model, {options.output, bar.progress()});
  }
  if (!fetched) return refused(context, fetched.error());
  if (common.json)
    context.out << vault_fetched_json(vault.name(), *fetched) << '\n';
  else
    context.out << "fetched " << called(fetched->model) << " from " << printable(vault.name()) << ": " << printable(fetched->main.string())
                << ", " << counted(fetched->model.files, "file") << ", " << counted(fetched->model.bytes, "byte") << '\n';
  return kDone;
}

int verify_vault(keeping::Vault& vault, const VaultOptions& options, const Common& common, const Context& context) {
  Result<keeping::Verified> verified = fail("", "");
  {
    MonotonicClock clock;
    ProgressBar bar(context, "reading " + vault.name(), clock);
    verified = keeping::verify(vault, options.model.empty() ? std::nullopt : std::optional(options.model), bar.progress());
  }
  if (!verified) return refused(context, verified.error());
  for (const keeping::VaultFault& fault : verified->faults)
    say(context,
        Error{vault.name(), 0,
              "model " + fault.model.hex().substr(0, kListedDigits) + (fault.file.empty() ? "" : ", " + fault.file) + ": " + fault.object +
                  (fault.object.empty() ? "the model " : " ") + fault.fault + "; push the deck again with --resend"});
  if (common.json)
    context.out << vault_verified_json(vault.name(), *verified) << '\n';
  else
    context.out << printable(vault.name()) << ": " << counted(verified->models, "model") << ", " << counted(verified->objects, "object")
                << ", " << counted(verified->bytes, "byte") << " read; " << counted(verified->faults.size(), "fault") << '\n';
  return verified->faults.empty() ? kDone : kFailed;
}

}  // namespace

int vault(const VaultOptions& options, const Common& common, const Context& context) {
  Result<keeping::Vault> opened = open_vault(options, context);
  if (!opened) return refused(context, opened.error());
  switch (options.action) {
    case VaultOptions::Action::push: return push_to_vault(*opened, options, common, context);
    case VaultOptions::Action::list: return list_vault(*opened, common, context);
    case VaultOptions::Action::fetch: return fetch_from_vault(*opened, options, common, context);
    case VaultOptions::Action::verify: return verify_vault(*opened, options, common, context);
  }
  return kFailed;
}

}  // namespace prismesh::cli
