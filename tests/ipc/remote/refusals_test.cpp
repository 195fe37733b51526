// What a client refuses of a station, and what it says when a station refuses.
#include "ipc/intake/pairing_code.h"
#include "ipc/store/reading.h"
#include "tests/ipc/remote/hostile_station.h"
#include "tests/ipc/remote/remote_rig.h"

namespace prismesh::ipc::remote {
namespace {

class RemoteRefusals : public Remote {
 protected:
  /// With a place for the hostile station's key.
  RemoteRefusals() { fs::create_directories(hostile()); }
  fs::path hostile() const { return folder() / "hostile"; }
  std::string code(const std::string& name = "") {
    PairingCode made;
    const auto& fingerprint = rig_.intake->fingerprint().bytes;
    std::copy_n(fingerprint.begin(), made.fingerprint.size(), made.fingerprint.begin());
    made.secret = rig_.intake->access().make_secret({name, intake::Scopes::all()});
    return encode_pairing_code(made);
  }
  StationAddress address() const { return {"127.0.0.1", rig_.intake->port()}; }
};

TEST_F(RemoteRefusals, a_code_pairs_once) {
  const std::string good = code();
  const Result<PairedStation> paired = pair(address(), good, "bob", {});
  ASSERT_TRUE(paired) << paired.error().text();
  EXPECT_EQ(paired->token_name, "bob");
  EXPECT_EQ(paired->fingerprint, rig_.intake->fingerprint());
  EXPECT_TRUE(RemoteStation(*paired, {}, {}).models());
  EXPECT_THAT(pair(address(), good, "eve", {}).error().text(), HasSubstr("make a new one at the station"));
  EXPECT_THAT(pair(address(), "ABCD", "eve", {}).error().text(), Not(HasSubstr("status")));
  EXPECT_THAT(pair(address(), code(), "bob", {}).error().text(), HasSubstr("has a token already"));
}

TEST_F(RemoteRefusals, a_station_with_another_key_hears_nothing) {
  Result<PairingCode> other = decode_pairing_code(code());
  ASSERT_TRUE(other);
  for (std::size_t byte = 0; byte < other->fingerprint.size(); ++byte) {
    PairingCode changed = *other;
    changed.fingerprint[byte] ^= 1;
    EXPECT_THAT(pair(address(), encode_pairing_code(changed), "bob", {}).error().text(),
                HasSubstr("isn't the station that made this code"));
  }
  EXPECT_TRUE(pair(address(), encode_pairing_code(*other), "bob", {})) << "the secret wasn't spent";
  PairedStation changed = station();
  changed.fingerprint.bytes[31] ^= 1;
  int asked = 0;
  HostileStation liar(hostile(), [&](const std::string&) { return ++asked, HostileStation::ok("{}"); });
  PairedStation taken_place = liar.paired();
  taken_place.fingerprint = rig_.intake->fingerprint();
  for (const PairedStation& each : {changed, taken_place}) {
    const std::string said = push(book(), each, write({{"a.k", "text"}}), "a.k", push_options()).error().text();
    EXPECT_THAT(said, AllOf(HasSubstr("has another key"), HasSubstr("nothing was sent")));
    EXPECT_FALSE(pull(each, "a.k", pull_options("x")));
  }
  EXPECT_EQ(asked, 0);
}

TEST_F(RemoteRefusals, a_revoked_token_and_a_missing_right_say_what_to_do) {
  const std::vector<LocalFile> files = write({{"a.k", "text"}});
  PairedStation reader = station();
  intake::Scopes only_read;
  only_read.add(intake::Scope::read);
  reader.token = rig_.token("reader", only_read);
  EXPECT_THAT(push(book(), reader, files, "a.k", push_options()).error().text(),
              AllOf(HasSubstr("right 'upload'"), HasSubstr("Pair again with a code that allows it")));
  ASSERT_TRUE(rig_.intake->access().revoke("ann"));
  EXPECT_THAT(push(book(), station(), files, "a.k", push_options()).error().text(), HasSubstr("prismesh pair " + station().name + " CODE"));
  EXPECT_THAT(pull(station(), "a.k", pull_options("x")).error().text(), HasSubstr("revoked"));
}

TEST_F(RemoteRefusals, a_path_that_a_model_cannot_have_is_not_sent) {
  const fs::path disk = write({{"a.k", "text"}})[0].disk;
  for (const std::string path : {"../a.k", "/a.k", "a/../b.k", "a\nb.k", "a\\b.k", ""})
    EXPECT_THAT(push(book(), station(), {{disk, path}}, path, push_options()).error().text(), HasSubstr("can't be a model")) << path;
  EXPECT_THAT(push(book(), station(), {{folder() / "none.k", "a.k"}}, "a.k", push_options()).error().text(), HasSubstr("none.k"));
}

TEST(RemoteLimits, a_quota_is_told_with_what_to_do) {
  const intake::IntakeRig rig([](intake::IntakeOptions& options) { options.store_limits.quota_bytes = 1000; });
  Result<StationBook> book = StationBook::open(rig.root() / "book");
  ASSERT_TRUE(book);
  std::ofstream(rig.root() / "a.k") << std::string(2000, 'x');
  PairedStation station;
  station.address = {"127.0.0.1", rig.intake->port()};
  station.fingerprint = rig.intake->fingerprint();
  station.token = rig.token("ann", intake::Scopes::all());
  EXPECT_THAT(push(*book, station, {{rig.root() / "a.k", "a.k"}}, "a.k", {}).error().text(),
              AllOf(HasSubstr("may store 1000 bytes"), HasSubstr("Remove models")));
}

/// A station that lists a model with this manifest, and gives `file` out for each of its files.
std::string lying_answer(const std::string& head, const std::string& manifest, const std::string& listed_hash, const std::string& file) {
  if (head.starts_with("GET /models?"))
    return HostileStation::ok("{\"models\": [{\"model\": \"" + listed_hash +
                              "\", \"name\": \"m\", \"who\": \"w\", \"when_s\": 1, \"bytes\": 1, \"files\": 1}]}");
  if (head.find("/manifest ") != std::string::npos) return HostileStation::ok(manifest);
  return HostileStation::ok(file);
}

TEST_F(RemoteRefusals, paths_that_lead_out_are_refused) {
  const std::string hash = store::sha256("text").hex();
  for (const std::string path : {"../evil.k", "/evil.k", "a/../../evil.k", "a//evil.k", "./evil.k", "a/.", "..", "a\\..\\evil.k"}) {
    const std::string manifest = "prismesh-set 1\nmain " + path + "\n" + hash + " 4 " + path + "\n";
    HostileStation liar(hostile(),
                        [&](const std::string& head) { return lying_answer(head, manifest, store::model_hash(manifest).hex(), "text"); });
    const Result<Pulled> pulled = pull(liar.paired(), "m", pull_options("deep/x"));
    ASSERT_FALSE(pulled) << path;
    EXPECT_THAT(pulled.error().text(), HasSubstr("list of files that isn't taken")) << path;
    EXPECT_FALSE(fs::exists(folder() / "deep")) << path;
  }
}

TEST_F(RemoteRefusals, other_bytes_than_the_model_has_are_refused) {
  const std::string manifest = "prismesh-set 1\nmain a.k\n" + store::sha256("text").hex() + " 4 a.k\n";
  const std::string hash = store::model_hash(manifest).hex();
  struct Lie {
    std::string hash, file, says;
  };
  for (const Lie& lie : {Lie{hash, "tex!", "gives other bytes"}, Lie{hash, "texts", "gives more bytes"},
                         Lie{hash, "", "gives nothing of a.k"}, Lie{store::sha256("another").hex(), "text", "gives another model"}}) {
    HostileStation liar(hostile(), [&](const std::string& head) { return lying_answer(head, manifest, lie.hash, lie.file); });
    const Result<Pulled> pulled = pull(liar.paired(), "m", pull_options("x"));
    ASSERT_FALSE(pulled) << lie.says;
    EXPECT_THAT(pulled.error().text(), HasSubstr(lie.says));
    EXPECT_FALSE(fs::exists(folder() / "x"));
    fs::remove_all(folder() / "x.pulling");
  }
}

/// A station that begins uploads, and says this of a chunk, always at offset 0.
std::string contradicting_answer(const std::string& head, const std::string& of_a_chunk) {
  if (head.starts_with("POST /models")) return "HTTP/1.1 409 No\r\nContent-Length: 0\r\nConnection: close\r\n\r\n";
  if (head.starts_with("POST /uploads")) return "HTTP/1.1 201 Yes\r\nLocation: /uploads/a\r\nContent-Length: 0\r\n\r\n";
  if (head.starts_with("HEAD")) return "HTTP/1.1 200 Yes\r\nUpload-Offset: 0\r\n\r\n";
  return "HTTP/1.1 " + of_a_chunk + "\r\nUpload-Offset: 0\r\nContent-Length: 0\r\n\r\n";
}

TEST_F(RemoteRefusals, a_station_that_contradicts_itself_is_given_up) {
  for (const char* of_a_chunk : {"409 No", "404 No", "204 Yes"}) {
    int asked = 0;
    HostileStation liar(hostile(), [&](const std::string& head) { return ++asked, contradicting_answer(head, of_a_chunk); });
    EXPECT_FALSE(push(book(), liar.paired(), write({{"a.k", "text"}}), "a.k", push_options())) << of_a_chunk;
    EXPECT_LT(asked, 100) << of_a_chunk;
  }
}

TEST_F(RemoteRefusals, nonsense_is_a_sentence) {
  for (const std::string answer : {"", "garbage\r\n\r\n", "HTTP/1.1 200 OK\r\nContent-Length: 3\r\n\r\n{]}",
                                   "HTTP/1.1 500 No\r\nContent-Length: 0\r\n\r\n", "HTTP/1.1 200 OK\r\nContent-Length: 99\r\n\r\n{}"}) {
    HostileStation liar(hostile(), [&](const std::string&) { return answer; });
    RemoteOptions options;
    options.patience = std::chrono::milliseconds(0);
    options.line.silence = std::chrono::milliseconds(200);
    const Result<std::vector<ListedModel>> models = RemoteStation(liar.paired(), options, {}).models();
    ASSERT_FALSE(models) << answer;
    EXPECT_THAT(models.error().text(), HasSubstr("127.0.0.1:")) << answer;
  }
}

TEST_F(RemoteRefusals, tokens_that_others_may_read_are_not_used) {
  const StationBook kept = book();
  ASSERT_TRUE(kept.keep(station()));
  const fs::path file = folder() / "book/stations.json";
  EXPECT_EQ(fs::status(file).permissions(), fs::perms::owner_read | fs::perms::owner_write);
  EXPECT_EQ(fs::status(folder() / "book").permissions(), fs::perms::owner_all);
  ASSERT_TRUE(kept.find(""));
  EXPECT_EQ(kept.find("")->token, token_);
  EXPECT_THAT(kept.find("elsewhere").error().text(), HasSubstr("isn't paired with it"));
  fs::permissions(file, fs::perms::group_read, fs::perm_options::add);
  EXPECT_THAT(kept.find("").error().text(), HasSubstr("chmod 600"));
  fs::permissions(file, fs::perms::group_read, fs::perm_options::remove);
  std::ofstream(file) << "{";
  EXPECT_THAT(kept.find("").error().text(), HasSubstr("damaged"));
  fs::remove(file);
  EXPECT_THAT(kept.find("").error().text(), HasSubstr("prismesh pair STATION CODE"));
}

TEST(StationAddresses, are_read_as_people_write_them) {
  const auto text = [](const char* given) { return parse_station_address(given) ? parse_station_address(given)->text() : "refused"; };
  EXPECT_EQ(text("station.example"), "station.example:7443");
  EXPECT_EQ(text("10.0.0.1:80"), "10.0.0.1:80");
  EXPECT_EQ(text("[::1]:80"), "[::1]:80");
  EXPECT_EQ(text("::1"), "[::1]:7443");
  EXPECT_EQ(text("[fe80::1]"), "[fe80::1]:7443");
  for (const char* wrong : {"", ":80", "a:", "a:0", "a:65536", "a:x", "a b", "a/b", "https://a", "[::1", "[::1]80", "a\r\nb", "-a"})
    EXPECT_EQ(text(wrong), "refused") << wrong;
}

TEST(StationEvents, come_in_pieces) {
  const std::string text =
      ": hello\n\nevent: published\ndata: {\"model\": \"" + std::string(64, 'a') + "\"}\n\n: still here\n\nevent: removed\ndata: x\n\n";
  EventReader reader;
  std::vector<std::string> kinds;
  for (const char c : text) {
    ASSERT_TRUE(reader.add(std::string_view(&c, 1)));
    while (const auto event = reader.next()) kinds.push_back(event->kind + (model_of_event(*event) ? "+" : "-"));
  }
  EXPECT_EQ(kinds, (std::vector<std::string>{"published+", "removed-"}));
  EXPECT_FALSE(reader.add(std::string(70'000, 'x')));
}

}  // namespace
}  // namespace prismesh::ipc::remote
