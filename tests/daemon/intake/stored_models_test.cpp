// A model of the store is opened in modeld, edited and saved; what was saved is a new model of the store.
#include <filesystem>
#include <fstream>
#include <optional>
#include <span>
#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/base64.h"
#include "daemon/intake/api/thumbnail.h"
#include "daemon/intake/daemon.h"
#include "daemon/modeld/request_handler.h"
#include "ipc/intake/client.h"
#include "ipc/model/snapshot_publisher.h"
#include "mesh/document/edit_json.h"
#include "mesh/document/open.h"
#include "mesh/document/prepare.h"
#include "mesh/document/save.h"
#include "tests/daemon/intake/store_rig.h"
#include "tests/daemon/modeld/folder.h"
#include "tests/support/places.h"

namespace prismesh::intake {
namespace {

namespace fs = std::filesystem;
using ::testing::Contains;
using ::testing::HasSubstr;

constexpr auto kLiftFirst = R"({"edit":"translate","by":[0,0,0.25],"on":"1"})";

class StoredModel : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_.two_files();
    deck_ = {{"main.k", test::whole_file(folder_.path() / "main.k")}, {"rest.k", test::whole_file(folder_.path() / "rest.k")}};
    StoreLimits limits;
    limits.reserved_bytes = 0;
    Result<Store> store = open_store(store_folder(), clock_, limits);
    ASSERT_TRUE(store) << store.error().text();
    const auto record = publish(*store, "ann", deck_, "main.k");
    ASSERT_TRUE(record) << record.error().error.text();
    model_ = record->model;
  }
  void TearDown() override { end_intake(); }

  fs::path store_folder() const { return folder_.path() / "store"; }
  fs::path run_folder() const { return folder_.path() / "run"; }
  void start_intake() {
    IntakeOptions options;
    options.state_directory = folder_.path() / "intake";
    options.store = store_folder();
    options.work = folder_.path() / "work";
    options.store_limits.reserved_bytes = 0;
    Result<Daemon> daemon = Daemon::start({run_folder(), options});
    ASSERT_TRUE(daemon) << daemon.error().text();
    daemon_.emplace(std::move(*daemon));
    serving_ = std::thread([this] { daemon_->run(); });
  }
  void end_intake() {
    if (!serving_.joinable()) return;
    daemon_->stop();
    serving_.join();
    daemon_.reset();
  }
  modeld::RequestHandler handler() {
    return modeld::RequestHandler(modeld::StateFolder(folder_.state()), publisher_, std::size_t{1} << 30, clock_,
                                  modeld::DeckSource({{}, test::programs_folder() / "prismesh-import"}),
                                  modeld::StoredModels(ipc::intake_socket_path(run_folder())));
  }
  ipc::store::ModelRecord record_of(const ipc::store::ContentHash& model) const {
    const auto reader = ipc::store::Reader::open(store_folder());
    const auto found = reader ? reader->find(model) : tl::unexpected(reader.error());
    EXPECT_TRUE(found) << found.error().text();
    return found ? found->record : ipc::store::ModelRecord{};
  }
  static ipc::Open stored(const std::string& hash) {
    ipc::Open open;
    open.stored = hash;
    return open;
  }
  static ipc::DocumentState state_of(const modeld::Outcome& outcome) {
    if (const auto* failed = std::get_if<ipc::Failed>(&outcome.answer)) ADD_FAILURE() << failed->message;
    const auto* state = std::get_if<ipc::DocumentState>(&outcome.answer);
    return state != nullptr ? *state : ipc::DocumentState{};
  }
  static std::string message_of(const modeld::Outcome& outcome) {
    const auto* failed = std::get_if<ipc::Failed>(&outcome.answer);
    return failed != nullptr ? failed->message : "it worked";
  }
  static ipc::Saved saved_of(const modeld::Outcome& outcome) {
    const auto* saved = std::get_if<ipc::Saved>(&outcome.answer);
    EXPECT_NE(saved, nullptr) << message_of(outcome);
    return saved != nullptr ? *saved : ipc::Saved{};
  }

  test::Folder folder_;
  ManualClock clock_;
  ipc::SnapshotPublisher publisher_{1};
  SetFiles deck_;
  ipc::store::ContentHash model_;
  std::optional<Daemon> daemon_;
  std::thread serving_;
};

TEST_F(StoredModel, is_opened_edited_and_given_back_with_its_lineage) {
  start_intake();
  modeld::RequestHandler modeld = handler();
  const ipc::DocumentState opened = state_of(modeld.open(stored(model_.hex()), {}));
  EXPECT_EQ(opened.shells, 2u);
  EXPECT_EQ(opened.stored, model_.hex());
  EXPECT_EQ(record_of(model_).figures, (ipc::store::ModelFigures{opened.nodes, 2, opened.parts, opened.counts.warn, opened.counts.fail}));
  EXPECT_TRUE(opened.path.starts_with((folder_.path() / "work").string())) << opened.path;
  modeld.edit(mesh::document::parse_edit(kLiftFirst).value());
  const ipc::Saved saved = saved_of(modeld.save({}));
  EXPECT_THAT(saved.notes, Contains(HasSubstr("published in the store as ")));

  // What the store has now: the bytes that the edit gives without store, daemon and sandbox.
  auto document = mesh::document::open(folder_.path() / "main.k", mesh::document::OpenOptions{});
  ASSERT_TRUE(document);
  auto prepared = mesh::document::prepare(*document, mesh::document::parse_edit(kLiftFirst).value());
  ASSERT_TRUE(prepared);
  mesh::document::commit(*document, std::move(*prepared));
  const fs::path plain = folder_.path() / "plain/main.k";
  fs::create_directory(plain.parent_path());
  ASSERT_TRUE(mesh::document::save(*document, plain));
  const auto after = ipc::store::parse_content_hash(saved.notes.back().substr(saved.notes.back().size() - 64));
  ASSERT_TRUE(after) << saved.notes.back();
  EXPECT_NE(*after, model_);
  const SetFiles files = files_of(store_folder(), *after);
  EXPECT_EQ(files.at("main.k"), test::whole_file(plain));
  EXPECT_EQ(files.at("rest.k"), test::whole_file(plain.parent_path() / "rest.k"));
  EXPECT_EQ(files_of(store_folder(), model_), deck_) << "the model that came is as it came";
  const auto record = ipc::store::Reader::open(store_folder())->find(*after)->record;
  EXPECT_EQ(record.derived_from, model_);
  EXPECT_EQ(record.name, "main.k");
  EXPECT_EQ(record.who, "(station)");

  // The next save derives from that one; one without an edit publishes nothing.
  EXPECT_THAT(saved_of(modeld.save({})).notes, ::testing::Not(Contains(HasSubstr("published"))));
  modeld.edit(mesh::document::parse_edit(kLiftFirst).value());
  const ipc::Saved again = saved_of(modeld.save({}));
  const auto third = ipc::store::parse_content_hash(again.notes.back().substr(again.notes.back().size() - 64));
  ASSERT_TRUE(third) << again.notes.back();
  EXPECT_EQ(ipc::store::Reader::open(store_folder())->find(*third)->record.derived_from, *after);
}

TEST_F(StoredModel, stays_saved_where_the_store_is_away_and_is_given_back_later) {
  start_intake();
  {
    modeld::RequestHandler modeld = handler();
    state_of(modeld.open(stored(model_.hex()), {}));
    modeld.edit(mesh::document::parse_edit(kLiftFirst).value());
    end_intake();
    EXPECT_THAT(saved_of(modeld.save({})).notes, Contains(HasSubstr("in the store it isn't published")));
  }
  modeld::RequestHandler modeld = handler();  // restarted
  EXPECT_EQ(state_of(modeld.reopen({})).stored, model_.hex());
  start_intake();
  EXPECT_THAT(saved_of(modeld.save({})).notes, Contains(HasSubstr("published in the store as ")));
}

TEST_F(StoredModel, gets_a_folder_of_its_own_each_time) {
  start_intake();
  modeld::RequestHandler modeld = handler();
  const std::string first = state_of(modeld.open(stored(model_.hex()), {})).path;
  const std::string second = state_of(modeld.open(stored(model_.hex()), {})).path;
  EXPECT_NE(first, second);
  EXPECT_EQ(test::whole_file(first), test::whole_file(second));
  ipc::Save elsewhere;
  elsewhere.path = (folder_.path() / "elsewhere.k").string();
  elsewhere.becomes = true;
  fs::remove(folder_.path() / "rest.k");
  saved_of(modeld.save(elsewhere));
  EXPECT_EQ(state_of(modeld.open(
                         [&] {
                           ipc::Open same;
                           same.path = *elsewhere.path;
                           return same;
                         }(),
                         {}))
                .stored,
            "")
      << "what was saved elsewhere isn't given back";
}

TEST_F(StoredModel, that_cant_be_had_is_told_in_a_sentence) {
  modeld::RequestHandler modeld = handler();
  EXPECT_THAT(message_of(modeld.open(stored(model_.hex()), {})), HasSubstr("prismesh-intake"));
  start_intake();
  EXPECT_THAT(message_of(modeld.open(stored("../../etc/passwd"), {})), HasSubstr("is no hash of a model"));
  EXPECT_THAT(message_of(modeld.open(stored(std::string(64, 'a')), {})), HasSubstr("holds no model aaaa"));
  // Rot is found when it is laid out, and nothing is left of it.
  const std::string main = ipc::store::sha256(deck_["main.k"]).hex();
  fs::permissions(store_folder() / "sha256" / main.substr(0, 2) / main, fs::perms::owner_all);
  std::ofstream(store_folder() / "sha256" / main.substr(0, 2) / main) << std::string(deck_["main.k"].size(), 'x');
  EXPECT_NE(message_of(modeld.open(stored(model_.hex()), {})), "it worked");
  EXPECT_TRUE(fs::is_empty(folder_.path() / "work"));
}

TEST_F(StoredModel, is_published_from_its_own_folder_only) {
  start_intake();
  Result<ipc::IntakeClient> client = ipc::IntakeClient::connect(ipc::intake_socket_path(run_folder()), "test");
  ASSERT_TRUE(client);
  for (const char* work : {"..", "", "a/b", "/etc", "."}) EXPECT_FALSE(client->call(ipc::PublishWork{work, model_.hex()})) << work;
  EXPECT_FALSE(client->call(ipc::PublishWork{"absent", model_.hex()}));
  EXPECT_FALSE(client->call(ipc::PublishWork{"absent", "no hash"}));
  const fs::path work = folder_.path() / "work/mine";
  fs::create_directories(work);
  std::ofstream(work / "main.k") << deck_["main.k"];
  fs::create_symlink("/etc/hostname", work / "rest.k");
  EXPECT_FALSE(client->call(ipc::PublishWork{"mine", model_.hex()})) << "a link isn't followed";
  fs::remove(work / "rest.k");
  EXPECT_FALSE(client->call(ipc::PublishWork{"mine", model_.hex()})) << "a file is missing";
  std::ofstream(work / "rest.k") << deck_["rest.k"];
  const auto same = client->call(ipc::PublishWork{"mine", model_.hex()});
  ASSERT_TRUE(same) << same.error().text();
  EXPECT_EQ(std::get<ipc::PublishedWork>(*same).model, model_.hex()) << "nothing has changed";
}

/// A chunk of a PNG; its checksum is nobody's concern.
std::string png_chunk(const std::string& type, const std::string& bytes) {
  return std::string("\0\0\0", 3) + static_cast<char>(bytes.size()) + type + bytes + "crc.";
}
std::string png_of(int width, int height) {
  const auto side = [](int pixels) { return std::string("\0\0", 2) + static_cast<char>(pixels >> 8) + static_cast<char>(pixels & 255); };
  return "\x89PNG\r\n\x1a\n" + png_chunk("IHDR", side(width) + side(height) + std::string("\x08\x02\0\0\0", 5)) +
         png_chunk("IDAT", "points") + png_chunk("IEND", "");
}

TEST(Thumbnails, are_small_pictures_from_their_signature_to_their_end) {
  EXPECT_TRUE(is_thumbnail(png_of(320, 240)));
  EXPECT_TRUE(is_thumbnail(png_of(1024, 1)));
  const std::string good = png_of(320, 240);
  for (std::size_t size = 0; size < good.size(); ++size) EXPECT_FALSE(is_thumbnail(good.substr(0, size))) << size;
  for (const std::string& bad : {png_of(1025, 240), png_of(320, 1025), png_of(0, 1), good + "<script>", "<svg" + good,
                                 good.substr(0, 8) + png_chunk("IDAT", "") + good.substr(8), std::string("GIF89a")})
    EXPECT_FALSE(is_thumbnail(bad));
  EXPECT_FALSE(is_thumbnail(good + std::string(kMaxThumbnailBytes, '\0')));
}

TEST_F(StoredModel, is_described_by_whoever_has_read_it) {
  start_intake();
  Result<ipc::IntakeClient> client = ipc::IntakeClient::connect(ipc::intake_socket_path(run_folder()), "test");
  ASSERT_TRUE(client);
  const std::string picture = png_of(320, 240);
  const auto in_base64 = [](const std::string& bytes) { return base64_encode(std::as_bytes(std::span(bytes))); };
  for (const ipc::DescribeModel& bad : {ipc::DescribeModel{"no hash", 1, 1, 1, 0, 0, {}},
                                        {std::string(64, 'a'), 1, 1, 1, 0, 0, {}},
                                        {model_.hex(), 1, 1, 1, 0, 0, "*"},
                                        {model_.hex(), 1, 1, 1, 0, 0, in_base64("<script>")}})
    EXPECT_FALSE(client->call(bad)) << bad.model << bad.thumbnail;
  EXPECT_FALSE(record_of(model_).figures);
  const auto told = client->call(ipc::DescribeModel{model_.hex(), 6, 2, 1, 1, 0, in_base64(picture)});
  ASSERT_TRUE(told) << told.error().text();
  EXPECT_EQ(record_of(model_).figures, (ipc::store::ModelFigures{6, 2, 1, 1, 0}));
  EXPECT_EQ(record_of(model_).thumbnail, ipc::store::sha256(picture));
  ASSERT_TRUE(client->call(ipc::DescribeModel{model_.hex(), 7, 2, 1, 1, 0, {}}));
  EXPECT_EQ(record_of(model_).figures->nodes, 7u);
  EXPECT_EQ(record_of(model_).thumbnail, ipc::store::sha256(picture)) << "it keeps its picture";
}

}  // namespace
}  // namespace prismesh::intake
