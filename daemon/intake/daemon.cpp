#include "daemon/intake/daemon.h"

#include <string>
#include <thread>
#include <utility>

#include "base/base64.h"
#include "base/log.h"
#include "daemon/common/service.h"
#include "ipc/intake/client.h"
#include "ipc/intake/messages_json.h"
#include "ipc/intake/roles.h"
#include "ipc/wire/failure.h"

namespace prismesh::intake {

namespace {

constexpr std::uint64_t kGigabyte = std::uint64_t{1} << 30;

struct BusProtocol {
  using Request = ipc::IntakeRequest;
  using Answer = ipc::IntakeAnswer;
  using Event = ipc::IntakeEvent;
  using Hello = ipc::IntakeHello;
  static constexpr int kVersion = ipc::kIntakeProtocolVersion;
  static auto decode(std::string_view line) { return ipc::decode_intake_request(line); }
  static std::string encode_answer(std::uint64_t to, const Answer& answer, std::size_t descriptors) {
    return ipc::encode_intake_answer(to, answer, descriptors);
  }
  static std::string encode_event(const Event& event) { return ipc::encode_intake_event(event); }
  static bool must_be_told(const Answer& answer) { return std::holds_alternative<ipc::MadePairingCode>(answer); }
};

}  // namespace

Result<IntakeOptions> intake_options(const drivers::settings::RemoteSettings& settings, const std::filesystem::path& state_directory) {
  if (settings.address.empty())
    return fail("prismesh-intake", "the settings don't say where to listen; set remote.listen, like \"0.0.0.0:7443\" (docs/settings.md)");
  IntakeOptions options;
  options.state_directory = state_directory;
  options.store = state_directory / "store";
  options.work = state_directory / "work";
  options.server.address = settings.address;
  options.server.port = settings.port;
  options.hosts = settings.hosts;
  options.store_limits.quota_bytes = static_cast<std::uint64_t>(settings.quota_gb) * kGigabyte;
  options.store_limits.file_bytes = static_cast<std::uint64_t>(settings.file_gb) * kGigabyte;
  options.store_limits.reserved_bytes = static_cast<std::uint64_t>(settings.reserved_gb) * kGigabyte;
  options.store_limits.upload_lifetime_s = settings.upload_hours * 3600;
  return options;
}

struct Daemon::Impl final : daemon::Service<BusProtocol> {
  Impl(std::unique_ptr<Intake> service, const IntakeOptions& given) : options(given), intake(std::move(service)) {}
  ~Impl() override { end_serving(); }

  IntakeOptions options;
  std::unique_ptr<Intake> intake;
  std::thread serving;

  bool is_well() override { return intake->is_serving(); }

  void begin_serving() {
    intake->on_change([this](const std::string& model) { post([this, model] { tell_all(ipc::CatalogueChanged{model}); }); });
    serving = std::thread([this] { intake->run(); });
  }
  void end_serving() {
    if (!serving.joinable()) return;
    intake->stop();
    serving.join();
  }

  Result<Welcomed> welcome(ipc::ClientId) override {
    return Welcomed{ipc::IntakeWelcome{ipc::kIntakeProtocolVersion, PRISMESH_VERSION}, {}};
  }

  void request(ipc::ClientId client, std::uint64_t number, Request request, std::size_t) override {
    if (const auto* work = std::get_if<ipc::PublishWork>(&request)) return publish(client, number, *work);
    if (const auto* found = std::get_if<ipc::DescribeModel>(&request)) return describe(client, number, *found);
    answer(client, number, std::visit([this](const auto& asked) { return this->answer_to(asked); }, request));
  }

  void publish(ipc::ClientId client, std::uint64_t number, const ipc::PublishWork& work) {
    const std::optional<ipc::store::ContentHash> from = ipc::store::parse_content_hash(work.derived_from);
    if (!from) return answer(client, number, ipc::Failed{"request", 0, "\"derived_from\" is no hash of a model", {}});
    intake->publish_work(work.work, *from, [this, client, number](Result<ipc::store::ContentHash> model) {
      post([this, client, number, model = std::move(model)] {
        if (model) return answer(client, number, ipc::PublishedWork{model->hex()});
        answer(client, number, ipc::failed_from(model.error()));
      });
    });
  }

  void describe(ipc::ClientId client, std::uint64_t number, const ipc::DescribeModel& found) {
    const auto malformed = [&](const char* sentence) { answer(client, number, ipc::Failed{"request", 0, sentence, {}}); };
    const std::optional<ipc::store::ContentHash> model = ipc::store::parse_content_hash(found.model);
    if (!model) return malformed("\"model\" is no hash of a model");
    const std::optional<std::vector<std::byte>> picture = base64_decode(found.thumbnail);
    if (!picture) return malformed("\"thumbnail\" must be base64");
    intake->describe(*model, {found.nodes, found.elements, found.parts, found.warn, found.fail},
                     std::string(reinterpret_cast<const char*>(picture->data()), picture->size()),
                     [this, client, number](const Result<void>& described) {
                       post([this, client, number, described] {
                         if (described) return answer(client, number, ipc::Done{});
                         answer(client, number, ipc::failed_from(described.error()));
                       });
                     });
  }

  Answer answer_to(const ipc::IntakeHello&) { return ipc::Done{}; }
  Answer answer_to(const ipc::PublishWork&) { return ipc::Done{}; }    // answered later
  Answer answer_to(const ipc::DescribeModel&) { return ipc::Done{}; }  // answered later
  Answer answer_to(const ipc::GetIntake&) {
    return ipc::IntakeInfo{options.server.address + ":" + std::to_string(intake->port()), intake->fingerprint().hex(),
                           options.store.string(), options.work.string()};
  }
  Answer answer_to(const ipc::MakePairingCode& asked) {
    const Result<Scopes> scopes = scopes_named(asked.scopes);
    if (!scopes) return ipc::failed_from(scopes.error());
    if (scopes->none()) return ipc::Failed{"request", 0, "a code needs a right: read, upload, remove or metrics", {}};
    return ipc::MadePairingCode{intake->make_pairing_code({asked.name, *scopes}), options.access_limits.code_lifetime_s};
  }
  Answer answer_to(const ipc::GetTokens&) {
    ipc::Tokens tokens;
    for (const TokenRecord& token : intake->access().tokens())
      tokens.tokens.push_back({token.name, scope_names(token.scopes), token.made_s, token.expires_s});
    return tokens;
  }
  Answer answer_to(const ipc::RevokeToken& asked) {
    if (const Result<void> revoked = intake->access().revoke(asked.name); !revoked) return ipc::failed_from(revoked.error());
    return ipc::Done{};
  }
};

Result<Daemon> Daemon::start(const DaemonOptions& options) {
  Result<std::unique_ptr<Intake>> intake = Intake::start(options.intake);
  if (!intake) return fail(intake.error());
  auto impl = std::make_unique<Impl>(std::move(*intake), options.intake);
  if (Result<void> listening = impl->listen(ipc::intake_socket_path(options.runtime_directory)); !listening) return fail(listening.error());
  logging::info("takes models at {}:{}; the certificate's SHA-256 is {}", options.intake.server.address, impl->intake->port(),
                impl->intake->fingerprint().hex());
  impl->begin_serving();
  return Daemon(std::move(impl));
}

Daemon::Daemon(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Daemon::Daemon(Daemon&&) noexcept = default;
Daemon::~Daemon() = default;
Intake& Daemon::intake() { return *impl_->intake; }
void Daemon::run() {
  impl_->run("takes models from the network");
  impl_->end_serving();
}
void Daemon::stop() { impl_->stop(); }

}  // namespace prismesh::intake
