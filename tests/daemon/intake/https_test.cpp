// prismesh-intake from outside, over TLS: uploads, publishing, fetching, events.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <random>

#include <gmock/gmock.h>

#include "base/base64.h"
#include "tests/daemon/intake/intake_rig.h"
#include "tests/daemon/intake/store_rig.h"

namespace prismesh::intake {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

std::string in_base64(const std::string& text) { return base64_encode(std::as_bytes(std::span(text.data(), text.size()))); }
std::string checksum_header(const std::string& bytes) {
  const ipc::store::ContentHash hash = ipc::store::sha256(bytes);
  return "sha256 " + in_base64(std::string(hash.bytes.begin(), hash.bytes.end()));
}

const SetFiles& car() {
  static const SetFiles kCar{{"car.k", "*INCLUDE\nparts/door.k\n"}, {"parts/door.k", std::string(100'000, 'd') + "end"}};
  return kCar;
}

class Https : public ::testing::Test {
 protected:
  IntakeRig rig_;
  std::string token_ = rig_.token("ann", Scopes::all());

  void upload(const std::string& text) {
    const std::string path = rig_.begin_upload(token_, text.size());
    const TestResponse sent = rig_.send_chunk(token_, path, 0, text);
    ASSERT_EQ(sent.status, 204u) << sent.body;
    ASSERT_EQ(sent.header("upload-offset"), std::to_string(text.size()));
  }
  TestResponse publish(const SetFiles& files, const std::string& main, TestHeaders headers = {}) {
    for (const auto& [path, text] : files) upload(text);
    headers.emplace_back("Content-Type", "application/x-prismesh-set");
    return rig_.ask("POST", "/models", rig_.with_token(token_, headers), ipc::store::encode_manifest(manifest_of(files, main)));
  }
  TestResponse get(const std::string& target, const TestHeaders& headers = {}) {
    return rig_.ask("GET", target, rig_.with_token(token_, headers));
  }
  static std::string model_of(const SetFiles& files, const std::string& main) {
    return ipc::store::model_hash(ipc::store::encode_manifest(manifest_of(files, main))).hex();
  }
};

TEST_F(Https, speaks_tls_1_3_only_with_the_certificate_of_the_fingerprint) {
  const TlsClient client = rig_.connect();
  ASSERT_TRUE(client.connected());
  EXPECT_EQ(client.version(), "TLSv1.3");
  EXPECT_EQ(client.fingerprint(), rig_.intake->fingerprint());
  EXPECT_FALSE(TlsClient(rig_.intake->port(), 0x0303).connected());
}

TEST_F(Https, keeps_its_key_to_itself_and_over_restarts) {
  const auto fingerprint = rig_.intake->fingerprint();
  const fs::path key = rig_.root() / "state/identity.pem";
  EXPECT_EQ(fs::status(key).permissions(), fs::perms::owner_read | fs::perms::owner_write);
  rig_.stop();
  rig_.start();
  EXPECT_EQ(rig_.intake->fingerprint(), fingerprint);
  EXPECT_EQ(rig_.ask("GET", "/models", rig_.with_token(token_)).status, 200u) << "tokens outlive a restart";
  rig_.stop();
  fs::permissions(key, fs::perms::group_read, fs::perm_options::add);
  EXPECT_THAT(Intake::start(rig_.options()).error().text(), HasSubstr("others may read"));
  fs::permissions(key, fs::perms::group_read, fs::perm_options::remove);
  std::ofstream(key) << "damage";
  EXPECT_THAT(Intake::start(rig_.options()).error().text(), HasSubstr("key is damaged"));
}

TEST_F(Https, takes_a_deck_of_several_files_and_gives_it_back) {
  const TestResponse published = publish(car(), "car.k", {{"Prismesh-Name", in_base64("Längs träger")}});
  ASSERT_EQ(published.status, 201u) << published.body;
  const std::string model = model_of(car(), "car.k");
  EXPECT_EQ(published.header("location"), "/models/" + model);
  EXPECT_THAT(get("/models").body, HasSubstr("Längs träger"));
  EXPECT_THAT(get("/models?name=nothing").body, ::testing::Not(HasSubstr(model)));
  EXPECT_THAT(get("/models/" + model).body, HasSubstr("parts/door.k"));
  EXPECT_EQ(ipc::store::model_hash(get("/models/" + model + "/manifest").body).hex(), model);
  for (const auto& [path, text] : car()) {
    const TestResponse file = get("/models/" + model + "/files/" + ipc::store::sha256(text).hex());
    EXPECT_EQ(file.status, 200u);
    EXPECT_EQ(file.body, text);
  }
  EXPECT_EQ(get("/models/" + model + "/thumbnail").status, 404u);
  EXPECT_EQ(files_of(rig_.options().store, *ipc::store::parse_content_hash(model)), car());
}

TEST_F(Https, gives_ranges_and_tells_what_has_not_changed) {
  ASSERT_EQ(publish(car(), "car.k").status, 201u);
  const std::string& door = car().at("parts/door.k");
  const std::string hash = ipc::store::sha256(door).hex();
  const std::string path = "/models/" + model_of(car(), "car.k") + "/files/" + hash;
  const TestResponse part = get(path, {{"Range", "bytes=99999-"}});
  EXPECT_EQ(part.status, 206u);
  EXPECT_EQ(part.body, "dend");
  EXPECT_EQ(part.header("content-range"), "bytes 99999-100002/100003");
  EXPECT_EQ(get(path, {{"Range", "bytes=0-0"}}).body, "d");
  EXPECT_EQ(get(path, {{"Range", "bytes=-3"}}).body, "end");
  EXPECT_EQ(get(path, {{"Range", "bytes=100003-"}}).status, 416u);
  EXPECT_EQ(get(path, {{"Range", "bytes=0-1,5-6"}}).body, door) << "several ranges: all of it";
  EXPECT_EQ(get(path, {{"Range", "bytes=0-0"}, {"If-Range", "\"other\""}}).status, 200u);
  EXPECT_EQ(get(path, {{"Range", "bytes=0-0"}, {"If-Range", "\"" + hash + "\""}}).status, 206u);
  EXPECT_EQ(get(path, {{"If-None-Match", "\"x\", \"" + hash + "\""}}).status, 304u);
  const TestResponse head = rig_.ask("HEAD", path, rig_.with_token(token_));
  EXPECT_EQ(head.status, 200u);
  EXPECT_EQ(head.header("content-length"), std::to_string(door.size()));
  EXPECT_EQ(head.header("etag"), "\"" + hash + "\"");
}

TEST_F(Https, gives_no_damaged_file_out_whole) {
  ASSERT_EQ(publish(car(), "car.k").status, 201u);
  const auto hash = ipc::store::sha256(car().at("parts/door.k"));
  std::string rotten = car().at("parts/door.k");
  rotten[50'000] ^= 1;
  std::ofstream(rig_.options().store / "sha256" / ipc::store::shard_of(hash) / hash.hex(), std::ios::binary) << rotten;
  EXPECT_EQ(get("/models/" + model_of(car(), "car.k") + "/files/" + hash.hex()).status, 0u) << "the connection ends before the last piece";
}

TEST_F(Https, answers_wrong_offsets_and_checksums_as_tus_says) {
  const std::string text = "0123456789";
  const std::string path = rig_.begin_upload(token_, text.size(), {{"Upload-Metadata", "filename " + in_base64("a.k")}});
  EXPECT_EQ(rig_.send_chunk(token_, path, 0, text.substr(0, 5), {{"Upload-Checksum", checksum_header("01234")}}).status, 204u);
  EXPECT_EQ(rig_.send_chunk(token_, path, 4, "4567").status, 409u);
  EXPECT_EQ(rig_.send_chunk(token_, path, 6, "6789").status, 409u);
  EXPECT_EQ(rig_.offset(token_, path), 5u);
  EXPECT_EQ(rig_.send_chunk(token_, path, 5, "5678x", {{"Upload-Checksum", checksum_header("56789")}}).status, 460u);
  EXPECT_EQ(rig_.offset(token_, path), 5u) << "the chunk is discarded";
  EXPECT_EQ(rig_.send_chunk(token_, path, 5, "56789", {{"Upload-Checksum", "md5 abcd"}}).status, 400u);
  EXPECT_EQ(rig_.send_chunk(token_, path, 5, "56789A").status, 413u);
  EXPECT_EQ(rig_.send_chunk(token_, path, 5, "56789", {{"Upload-Checksum", checksum_header("56789")}}).status, 204u);
  const TestResponse shown = rig_.ask("HEAD", path, rig_.of_tus(token_));
  EXPECT_EQ(shown.header("upload-length"), "10");
  EXPECT_EQ(shown.header("upload-metadata"), "filename " + in_base64("a.k"));
  EXPECT_NE(shown.header("upload-expires"), "");
  EXPECT_EQ(shown.header("cache-control"), "no-store");
}

TEST_F(Https, discards_a_file_that_is_not_the_one_announced) {
  const std::string path = rig_.begin_upload(token_, 5, {{"Upload-Metadata", "sha256 " + in_base64(ipc::store::sha256("right").hex())}});
  EXPECT_EQ(rig_.send_chunk(token_, path, 0, "wrong").status, 460u);
  EXPECT_EQ(rig_.ask("HEAD", path, rig_.of_tus(token_)).status, 404u);
}

TEST_F(Https, goes_on_where_the_line_was_cut) {
  const std::string text(300'000, 'x');
  const std::string path = rig_.begin_upload(token_, text.size());
  std::size_t at = 0;
  for (const std::size_t until : {100'000, 250'000}) {
    TlsClient client = rig_.connect();
    TestHeaders headers = rig_.of_tus(token_, {{"Upload-Offset", std::to_string(at)}, {"Content-Type", "application/offset+octet-stream"}});
    headers.emplace_back("Content-Length", std::to_string(text.size() - at));
    ASSERT_TRUE(client.send(rig_.request("PATCH", path, headers) + text.substr(at, until - at)));
    // Everything that was sent is taken before the line is cut.
    for (int tries = 0; tries < 1000 && rig_.offset(token_, path) + 40'000 < until; ++tries)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    client.cut();
    const std::size_t now = rig_.offset(token_, path);
    EXPECT_GT(now, at);
    at = now;
  }
  EXPECT_EQ(rig_.send_chunk(token_, path, at, text.substr(at)).status, 204u);
  const TestResponse published = rig_.ask("POST", "/models", rig_.with_token(token_, {{"Content-Type", "application/x-prismesh-set"}}),
                                          ipc::store::encode_manifest(manifest_of({{"x.k", text}}, "x.k")));
  EXPECT_EQ(published.status, 201u) << published.body;
}

TEST_F(Https, loses_no_acknowledged_byte_however_often_the_line_is_cut) {
  constexpr std::size_t kChunk = 65'536;
  std::mt19937_64 random(1);
  std::string text(3'000'000, '\0');
  for (char& c : text) c = static_cast<char>(random());
  const std::string path =
      rig_.begin_upload(token_, text.size(), {{"Upload-Metadata", "sha256 " + in_base64(ipc::store::sha256(text).hex())}});
  std::size_t offset = 0, cuts = 0, sent = 0, furthest = 0;
  while (offset < text.size()) {
    const std::string chunk = text.substr(offset, kChunk);
    TestHeaders headers =
        rig_.of_tus(token_, {{"Upload-Offset", std::to_string(offset)}, {"Content-Type", "application/offset+octet-stream"}});
    if (random() % 2 == 0) headers.emplace_back("Upload-Checksum", checksum_header(chunk));
    headers.emplace_back("Content-Length", std::to_string(chunk.size()));
    const std::size_t part = random() % 3 == 0 ? chunk.size() : random() % chunk.size();
    TlsClient client = rig_.connect();
    ASSERT_TRUE(client.send(rig_.request("PATCH", path, headers) + chunk.substr(0, part)));
    sent += part;
    furthest = std::max(furthest, offset + part);
    if (part == chunk.size()) {
      const TestResponse response = client.receive();
      // 409: bytes of a line that was cut came later than the answer to how far the upload is.
      ASSERT_TRUE(response.status == 204 || response.status == 409) << response.body;
      if (response.status == 204) offset += chunk.size();
    } else {
      client.cut();
      ++cuts;
    }
    const std::size_t now = rig_.offset(token_, path);
    ASSERT_GE(now, offset);
    ASSERT_LE(now, furthest);
    offset = now;
  }
  EXPECT_GT(cuts, 50u);
  EXPECT_LE(sent, text.size() + 2 * cuts * kChunk);
  const TestResponse published = rig_.ask("POST", "/models", rig_.with_token(token_, {{"Content-Type", "application/x-prismesh-set"}}),
                                          ipc::store::encode_manifest(manifest_of({{"x.k", text}}, "x.k")));
  EXPECT_EQ(published.status, 201u) << published.body;
}

TEST_F(Https, ends_uploads_and_removes_models) {
  const std::string path = rig_.begin_upload(token_, 5);
  EXPECT_EQ(rig_.ask("DELETE", path, rig_.of_tus(token_)).status, 204u);
  EXPECT_EQ(rig_.ask("DELETE", path, rig_.of_tus(token_)).status, 404u);
  ASSERT_EQ(publish(car(), "car.k").status, 201u);
  const std::string model = "/models/" + model_of(car(), "car.k");
  EXPECT_EQ(rig_.ask("DELETE", model, rig_.with_token(token_)).status, 204u);
  EXPECT_EQ(get(model).status, 404u);
}

TEST_F(Https, describes_its_uploads) {
  const TestResponse options = rig_.ask("OPTIONS", "/uploads", rig_.with_token(token_));
  EXPECT_EQ(options.status, 204u);
  EXPECT_EQ(options.header("tus-version"), "1.0.0");
  EXPECT_EQ(options.header("tus-extension"), "creation,expiration,checksum,termination");
  EXPECT_EQ(options.header("tus-checksum-algorithm"), "sha256,sha1");
  const TestResponse other = rig_.ask("POST", "/uploads", rig_.with_token(token_, {{"Upload-Length", "1"}, {"Tus-Resumable", "0.2.2"}}));
  EXPECT_EQ(other.status, 412u);
  EXPECT_EQ(other.header("tus-version"), "1.0.0");
}

TEST_F(Https, tells_followers_of_the_catalogue_until_their_right_is_gone) {
  TlsClient follower = rig_.connect();
  ASSERT_TRUE(follower.send(rig_.request("GET", "/events", rig_.with_token(token_))));
  EXPECT_THAT(follower.receive_until("catalogue\n\n"), HasSubstr("200 OK"));
  ASSERT_EQ(publish(car(), "car.k").status, 201u);
  EXPECT_THAT(follower.receive_until("\n\n"),
              ::testing::AllOf(HasSubstr("event: published\ndata: {"), HasSubstr(model_of(car(), "car.k"))));
}

TEST(HttpsEvents, end_when_the_token_is_revoked) {
  const IntakeRig rig([](IntakeOptions& options) { options.server.heartbeat = std::chrono::milliseconds(20); });
  const std::string token = rig.token("ann", Scopes::all());
  TlsClient follower = rig.connect();
  ASSERT_TRUE(follower.send(rig.request("GET", "/events", rig.with_token(token))));
  follower.receive_until("still here");
  ASSERT_TRUE(rig.intake->access().revoke("ann"));
  EXPECT_THAT(follower.receive_until("never comes"), ::testing::Not(HasSubstr("never comes")));
}

TEST_F(Https, shows_its_figures) {
  ASSERT_EQ(publish(car(), "car.k").status, 201u);
  const TestResponse metrics = get("/metrics");
  EXPECT_EQ(metrics.header("content-type"), "text/plain; version=0.0.4");
  EXPECT_THAT(metrics.body, HasSubstr("\nprismesh_intake_models 1\n"));
  EXPECT_THAT(metrics.body, HasSubstr("\nprismesh_intake_published_total 1\n"));
  EXPECT_EQ(rig_.ask("GET", "/health").body, "{\"status\": \"ok\"}\n");
}

TEST_F(Https, serves_several_requests_on_a_connection_and_waits_for_a_body_when_asked) {
  TlsClient client = rig_.connect();
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(client.send(rig_.request("GET", "/health")));
    EXPECT_EQ(client.receive().status, 200u);
  }
  const std::string path = rig_.begin_upload(token_, 4);
  TestHeaders headers =
      rig_.of_tus(token_, {{"Upload-Offset", "0"}, {"Content-Type", "application/offset+octet-stream"}, {"Expect", "100-continue"}});
  headers.emplace_back("Content-Length", "4");
  ASSERT_TRUE(client.send(rig_.request("PATCH", path, headers)));
  EXPECT_THAT(client.receive_until("\r\n\r\n"), HasSubstr("100 Continue"));
  ASSERT_TRUE(client.send("body"));
  EXPECT_EQ(client.receive().status, 204u);
}

}  // namespace
}  // namespace prismesh::intake
