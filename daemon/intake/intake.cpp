#include "daemon/intake/intake.h"

#include <openssl/rand.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <new>
#include <utility>

#include "base/log.h"
#include "daemon/intake/api/model_answers.h"
#include "daemon/intake/api/thumbnail.h"
#include "daemon/intake/store/publish_folder.h"
#include "ipc/intake/pairing_code.h"
#include "ipc/wire/server.h"

namespace prismesh::intake {

namespace {

constexpr std::chrono::minutes kExpirePeriod{1};
constexpr std::chrono::seconds kBeatPeriod{1};
constexpr std::int64_t kMaxSilenceNs = 10'000'000'000;
/// What is edited on the station is published under this name; tokens can't have it.
constexpr const char* kStationsName = "(station)";

void fill_with_randomness(std::span<std::byte> bytes) {
  // It fails where the kernel gives none, and nothing that it is for may go on then.
  if (RAND_bytes(reinterpret_cast<unsigned char*>(bytes.data()), static_cast<int>(bytes.size())) != 1) throw std::bad_alloc();
}

std::int64_t seconds_since_1970() {
  return std::chrono::duration_cast<std::chrono::seconds>(std::chrono::system_clock::now().time_since_epoch()).count();
}

}  // namespace

struct Intake::Impl {
  Impl(ipc::Descriptor lock_of_state, Identity own, std::shared_ptr<StoreThread> thread, std::unique_ptr<Access> rights)
      : lock(std::move(lock_of_state)), identity(std::move(own)), store(std::move(thread)), access(std::move(rights)) {}
  ~Impl() {
    // The store's jobs hold connections, and connections hold what the store's thread uses.
    if (store) store->end();
  }

  ipc::Descriptor lock;
  Identity identity;
  std::filesystem::path work;
  Figures figures;
  EventHub events;
  std::shared_ptr<StoreThread> store;
  std::unique_ptr<Access> access;
  std::optional<Api> api;
  std::unique_ptr<HttpsServer> server;

  std::atomic<std::int64_t> beat_ns{0};

  void keep_house(std::chrono::milliseconds scrub_every) {
    beat_ns = MonotonicClock().now_ns();
    server->every(kBeatPeriod, [this] { beat_ns = MonotonicClock().now_ns(); });
    server->every(kExpirePeriod, [this] {
      store->run([](Store& models) {
        if (const std::size_t count = models.uploads().expire(); count > 0)
          logging::info("{} uploads got no bytes for long and are gone", count);
      });
    });
    server->every(scrub_every, [this] {
      store->run([this](Store& models) {
        bool done = false;
        const Result<std::optional<std::string>> rot = models.scrub_next(done);
        if (!rot || !*rot) return;
        ++figures.rot;
        logging::error("{}", **rot);
      });
    });
  }
};

Intake::Intake(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Intake::~Intake() = default;

Result<std::unique_ptr<Intake>> Intake::start(const IntakeOptions& options) {
  static MonotonicClock clock;  // has no state
  if (Result<void> made = ipc::make_private_folder(options.state_directory, true); !made) return fail(std::move(made.error()));
  Result<ipc::Descriptor> lock = ipc::lock_folder(options.state_directory, "intake.lock", "a daemon with this state folder");
  if (!lock) return fail(std::move(lock.error()));
  const Result<ipc::store::Folder> folder = ipc::store::Folder::open(options.state_directory);
  if (!folder) return fail(folder.error());
  Result<Identity> identity = open_identity(*folder);
  if (!identity) return fail(identity.error());
  std::vector<std::string> notes;
  Result<Store> store = Store::open(options.store, options.store_limits, clock, fill_with_randomness, notes);
  if (!store) return fail(store.error());
  Result<std::unique_ptr<Access>> access =
      Access::open(*folder, options.access_limits, clock, seconds_since_1970, fill_with_randomness, notes);
  if (!access) return fail(access.error());
  for (const std::string& note : notes) logging::warn("{}", note);
  auto impl =
      std::make_unique<Impl>(std::move(*lock), std::move(*identity), std::make_shared<StoreThread>(std::move(*store)), std::move(*access));
  impl->work = options.work;
  impl->api.emplace(impl->store, *impl->access, impl->events, impl->figures,
                    ApiSettings{options.hosts, options.store_limits.file_bytes, 16}, seconds_since_1970);
  Result<std::unique_ptr<HttpsServer>> server =
      HttpsServer::listen(options.server, impl->identity, *impl->api, *impl->access, impl->events, impl->figures, impl->store);
  if (!server) return fail(server.error());
  impl->server = std::move(*server);
  impl->keep_house(options.scrub_every);
  return std::unique_ptr<Intake>(new Intake(std::move(impl)));
}

std::uint16_t Intake::port() const { return impl_->server->port(); }
const ipc::store::ContentHash& Intake::fingerprint() const { return impl_->identity.fingerprint; }
Access& Intake::access() { return *impl_->access; }

std::string Intake::make_pairing_code(const PairingOffer& offer) {
  ipc::PairingCode code;
  std::copy_n(fingerprint().bytes.begin(), code.fingerprint.size(), code.fingerprint.begin());
  code.secret = impl_->access->make_secret(offer);
  return ipc::encode_pairing_code(code);
}

void Intake::describe(const ipc::store::ContentHash& model, const ipc::store::ModelFigures& figures, std::string thumbnail,
                      std::function<void(Result<void>)> then) {
  if (!thumbnail.empty() && !is_thumbnail(thumbnail))
    return then(fail("request", "\"thumbnail\" must be a PNG of at most " + std::to_string(kMaxThumbnailSide) + " pixels a side and " +
                                    std::to_string(kMaxThumbnailBytes >> 10) + " KB"));
  impl_->store->run([impl = impl_.get(), model, figures, thumbnail = std::move(thumbnail), then = std::move(then)](Store& store) {
    const Outcome<ipc::store::ModelRecord> record = store.describe(model, figures, thumbnail);
    if (!record) return then(fail(record.error().error));
    impl->events.tell("described", model, model_json({*record, false}));
    then({});
  });
}

void Intake::publish_work(const std::string& folder, const ipc::store::ContentHash& derived_from,
                          std::function<void(Result<ipc::store::ContentHash>)> then) {
  if (!ipc::store::is_single_name(folder)) return then(fail("request", "\"work\" is no name of a folder: " + folder));
  impl_->store->run([impl = impl_.get(), folder, derived_from, then = std::move(then)](Store& store) {
    const Outcome<ipc::store::ModelRecord> record =
        publish_folder(store, {impl->work / folder, derived_from, kStationsName, seconds_since_1970()});
    if (!record) return then(fail(record.error().error));
    impl->access->note(kStationsName, "published", record->model.hex());
    impl->events.tell("published", record->model, model_json({*record, false}));
    then(record->model);
  });
}

void Intake::on_change(std::function<void(const std::string&)> told) { impl_->events.listen(std::move(told)); }
bool Intake::is_serving() const { return MonotonicClock().now_ns() - impl_->beat_ns < kMaxSilenceNs; }
void Intake::run() { impl_->server->run(); }
void Intake::stop() { impl_->server->stop(); }

}  // namespace prismesh::intake
